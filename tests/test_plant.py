"""`gcxform batch`: each program once whatever happens, the bytes of `run`, and a true table."""

from __future__ import annotations

import csv
import json
import os
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest
from cli_kit import ABSOLUTE, MODEL, PART, PIPELINE, call
from plant_kit import LETHAL, ONCE, dying

from gcxform.cli.common.request import Asked
from gcxform.cli.plant.pools import here, scheduled
from gcxform.cli.plant.rows import Row
from gcxform.cli.plant.stores import LocalStore, Store, store_of
from gcxform.cli.plant.tasks import Task
from gcxform.cli.plant.work import RECEIPTS, STAGED, done, finished
from gcxform.system.limits import Limits

LONG = os.environ.get("HYPOTHESIS_PROFILE") == "long"
BAD = b"G21 G90\nG1 G2 X1 F100\nM2\n"
CALLER = b"G21 G90\nG0 X0 Y0 Z0\nG91\nO<side> call\nG90\nM2\n"
SIDE = b"O<side> sub\nG0 X1\nO<side> endsub\n"


@pytest.fixture
def plant(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Go to a folder with two programs that come through, one that is refused, and a pipeline."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    (tmp_path / "job.toml").write_text(PIPELINE)
    folder = tmp_path / "programs" / "deep"
    folder.mkdir(parents=True)
    (tmp_path / "programs" / "a.nc").write_bytes(PART)
    (folder / "b.nc").write_bytes(PART.replace(b"Y5", b"Y6"))
    (folder / "bad.nc").write_bytes(BAD)
    return tmp_path


@pytest.fixture(autouse=True)
def _no_processes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Do the work of calls in this process: that processes do the same is shown by itself."""
    monkeypatch.setattr(
        "gcxform.cli.batch.here", lambda tasks, count: ((each, done(each)) for each in tasks)
    )


def batch(*words: str) -> dict[str, object]:
    """Return the answer about programs that are done again by the same words, but for these."""
    found = json.loads(call("batch", "--json", "-p", "job.toml", "-o", "out", *words).stdout)
    said: dict[str, object] = found["batch"]
    return said


def table(*columns: str) -> list[tuple[object, ...]]:
    base = sqlite3.connect("out/results.sqlite")
    try:
        return base.execute(f"SELECT {', '.join(columns)} FROM results ORDER BY program").fetchall()
    finally:
        base.close()


def files(folder: Path) -> dict[str, bytes]:
    """Return the results in a folder."""
    found = (path for path in folder.rglob("*.nc") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in found}


# --- what is done, and what is not done again ---


def test_results_lie_below_as_programs_do_and_are_those_of_run(plant: Path) -> None:
    assert batch("programs") == {
        "done": 3,
        "states": {"written": 2, "refused": 1},
        "codes": {"GX202": 1},
    }
    assert sorted(files(plant / "out")) == ["job/a.nc", "job/deep/b.nc"]
    call("run", "-q", "-p", "job.toml", "-o", "one.nc", "programs/deep/b.nc")
    assert (plant / "out/job/deep/b.nc").read_bytes() == Path("one.nc").read_bytes()
    assert (plant / "out/job/a.nc").read_bytes() == ABSOLUTE
    rows = table("program", "state", "codes", "place", "verified", "exit_code")
    assert rows == [
        ("programs/a.nc", "written", "", "", 1, 0),
        ("programs/deep/b.nc", "written", "", "", 1, 0),
        ("programs/deep/bad.nc", "refused", "GX202", "programs/deep/bad.nc:2:4", 0, 3),
    ]
    assert not os.listdir("out/.gcxform/staged")
    assert not os.listdir("out/.gcxform/receipts")


@pytest.mark.parametrize(
    ("change", "again"),
    [
        (lambda: None, 0),
        (lambda: Path("programs/a.nc").write_bytes(PART.replace(b"Y5", b"Y7")), 1),
        (lambda: os.utime("programs/a.nc"), 0),
        (lambda: Path("job.toml").write_text(PIPELINE + "[budget]\ndeviation = '1 um'\n"), 3),
        (lambda: Path("out/job/a.nc").unlink(), 1),
        (lambda: Path("out/job/a.nc").write_bytes(PART), 1),
        (lambda: Path("programs/deep/bad.nc").write_bytes(PART), 1),
        (lambda: Path("programs/new.nc").write_bytes(PART), 1),
    ],
)
def test_only_what_changed_is_done_again(plant: Path, change: object, again: int) -> None:
    batch("programs")
    assert callable(change)
    change()
    assert batch("programs")["done"] == again
    assert batch("programs")["done"] == 0


def test_a_subprogram_that_changes_or_appears_is_a_change_of_its_callers(plant: Path) -> None:
    (plant / "programs" / "caller.ngc").write_bytes(CALLER)
    assert batch("programs")["codes"] != {"GX202": 1}  # it is not there
    (plant / "programs" / "other.ngc").write_bytes(SIDE.replace(b"side", b"other"))
    assert batch("programs")["done"] == 1  # the new file, and nobody looked for it
    (plant / "programs" / "side.ngc").write_bytes(SIDE)
    assert batch("programs")["done"] == 2
    assert batch("programs")["codes"] == {"GX202": 1}
    (plant / "programs" / "side.ngc").write_bytes(SIDE.replace(b"X1", b"X2"))
    assert batch("programs")["done"] == 2
    assert batch("programs")["done"] == 0


def test_what_is_refused_now_leaves_no_result_of_before(plant: Path) -> None:
    batch("programs")
    (plant / "programs" / "a.nc").write_bytes(BAD)
    batch("programs")
    assert sorted(files(plant / "out")) == ["job/deep/b.nc"]
    (plant / "programs" / "deep" / "b.nc").write_bytes(BAD)
    (plant / "out" / "job" / "deep" / "b.nc").write_bytes(b"edited by hand\n")
    batch("programs")
    assert sorted(files(plant / "out")) == ["job/deep/b.nc"]  # not ours to take away


def test_a_manifest_says_lists_of_programs(plant: Path) -> None:
    (plant / "other.toml").write_text(PIPELINE.replace("absolute", "metric"))
    (plant / "lists").mkdir()
    (plant / "lists" / "plant.toml").write_text(
        'format = 1\n[[batch]]\nprograms = ["../programs"]\n'
        'pipelines = ["../job.toml", "../other.toml"]\nname = "all"\n'
        '[[batch]]\nprograms = ["../programs/a.nc"]\nchain = "absolute"\ndialect = "grbl"\n'
    )
    found = call("batch", "--manifest", "lists/plant.toml", "-o", "out", "--json")
    assert json.loads(found.stdout)["batch"]["done"] == 7
    assert sorted(files(plant / "out")) == [
        "a.nc",
        "all/job/a.nc",
        "all/job/deep/b.nc",
        "all/other/a.nc",
        "all/other/deep/b.nc",
    ]


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("-o", "out"), "GX700"),
        (("-o", "out", "programs"), "GX726"),
        (("-o", "out", "-p", "none.toml", "programs"), "GX709"),
        (("-o", "programs", "-x", "absolute", "-f", "grbl", "programs"), "GX727"),
        (("-o", "out", "-x", "absolute", "-f", "grbl", "programs/a.nc", "a.nc"), "GX749"),
        (("-o", "out", "--manifest", "job.toml", "programs"), "GX728"),
        (("-o", "out", "--manifest", "job.toml"), "GX701"),
        (("-o", "out", "-x", "absolute", "-f", "grbl", "none"), "GX901"),
        (("-o", "nothing://out", "-x", "absolute", "-f", "grbl", "programs"), "GX702"),
        (("-o", "out", "-x", "absolute", "-f", "grbl", "nothing://programs"), "GX752"),
    ],
)
def test_what_cannot_be_is_said_before_anything_is_done(
    plant: Path, words: tuple[str, ...], code: str
) -> None:
    (plant / "a.nc").write_bytes(PART)
    found = call("batch", *words)
    assert code in found.stderr
    assert not files(plant / "out")


def test_what_the_command_line_allows_holds_for_processes(plant: Path) -> None:
    few = task("programs/a.nc", plant / "out")
    assert done(replace(few, limits=Limits(line=10))).codes == "GX761"
    assert done(few).state == "written"
    (plant / "far").mkdir()
    (plant / "far" / "model.toml").write_text(MODEL)
    (plant / "pipes").mkdir()
    text = PIPELINE.replace("absolute", "volumetric").replace("[input]", "[input]\nstart = {X = 0}")
    text += 'model = "../far/model.toml"\npart-origin = [1, 1, 1]\noutside = "extrapolate"\n'
    (plant / "pipes" / "job.toml").write_text(text)
    found = Task("programs/a.nc", "c.nc", "out", Asked(pipeline="pipes/job.toml"))
    os.chdir(plant / "pipes")
    found = replace(found, program="../programs/a.nc", asked=Asked(pipeline="job.toml"))
    assert done(found).codes == "GX760"
    assert done(replace(found, anywhere=True)).codes != "GX760"


# --- tables and pages ---


def test_tables_and_the_page_say_the_same_and_what_programs_say_is_no_markup(plant: Path) -> None:
    name = "=<script>alert(1)</script>.nc".replace("/", "")
    (plant / name).write_bytes(BAD)
    words = ("programs", name, "--table", "t.csv", "--report", "r.html")
    batch(*words)
    with open("t.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["state"] for row in rows] == ["written", "written", "refused", "refused"]
    assert rows[3]["program"] == f"'{name}"
    assert float(rows[0]["deviation"]) <= float(rows[0]["budget"])
    page = Path("r.html").read_text()
    assert "2 of 4 programs came through" in page
    assert "<script" not in page
    assert "GX202" in page


def test_a_table_for_pandas_has_the_rows(plant: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    batch("programs", "--table", "t.parquet")
    found = pandas.read_parquet("t.parquet")
    assert list(found["state"]) == ["written", "written", "refused"]
    assert found["verified"].sum() == 2


# --- once, whatever happens ---


def task(name: str, root: Path, chain: str = "absolute") -> Task:
    return Task(
        str(Path(name).resolve()), Path(name).name, str(root), Asked(chain=chain, dialect="grbl")
    )


class Dying(LocalStore):
    """A store whose process is ended before its n-th change."""

    left = 0

    @contextmanager
    def staging(self, name: str) -> Iterator[str]:
        with super().staging(name) as place:
            yield place
            self._step()

    def _step(self) -> None:
        type(self).left -= 1
        if not type(self).left:
            raise KeyboardInterrupt

    def write(self, name: str, data: bytes) -> None:
        self._step()
        super().write(name, data)

    def move(self, name: str, to: str) -> None:
        self._step()
        super().move(name, to)


@pytest.mark.parametrize("step", range(1, 5))
def test_whoever_is_ended_leaves_what_the_next_one_finishes(
    plant: Path, step: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    todo, dying_store = task("programs/a.nc", plant / "out"), Dying(plant / "out")
    Dying.left = step
    monkeypatch.setattr("gcxform.cli.plant.work.store_of", lambda root: dying_store)
    if step < 4:
        with pytest.raises(KeyboardInterrupt):
            done(todo)
    else:
        done(todo)
    monkeypatch.undo()
    store = LocalStore(plant / "out")
    published = files(plant / "out")
    assert published in ({}, {"a.nc": ABSOLUTE})
    assert bool(store.names(RECEIPTS)) == (step > 2)
    row = finished(store, todo.key) or done(todo)
    assert (row.state, files(plant / "out")) == ("written", {"a.nc": ABSOLUTE})
    assert done(todo) == row


def test_a_receipt_of_a_result_that_is_gone_is_none(plant: Path) -> None:
    todo, store = task("programs/a.nc", plant / "out"), LocalStore(plant / "out")
    done(todo)
    (plant / "out" / "a.nc").write_bytes(b"half")
    assert finished(store, todo.key) is None
    assert not store.names(RECEIPTS)
    assert done(todo).state == "written"
    assert (plant / "out" / "a.nc").read_bytes() == ABSOLUTE
    assert not store.names(STAGED)


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no process is killed here")
def test_a_process_that_dies_costs_nothing_but_its_own_program(plant: Path) -> None:
    names = [*(f"p{n}.nc" for n in range(3)), *([LETHAL] if LONG else []), ONCE]
    for name in names:
        (plant / name).write_bytes(PART)
    found = dict(here([task(name, plant / "out") for name in names], 2, dying))
    states = {each.below: row.state for each, row in found.items()}
    assert sorted(states) == sorted(names)
    assert states.pop(LETHAL, "failed") == "failed"
    assert set(states.values()) == {"written"}
    assert sorted(files(plant / "out")) == sorted(states)


def inodes(folder: Path) -> dict[str, int]:
    return {path.name: path.stat().st_ino for path in folder.glob("*.nc")}


@pytest.mark.skipif(not LONG, reason="a batch that is killed three times: in the long profile")
def test_a_batch_that_is_killed_goes_on_where_it_was(plant: Path) -> None:
    (plant / "many").mkdir()
    for n in range(400):
        (plant / "many" / f"p{n}.nc").write_bytes(PART)
    words = [sys.executable, "-m", "gcxform.cli", "batch", "-p", "job.toml", "-o", "out", "many"]
    seen: dict[str, int] = {}
    for share in (1, 2, 3):
        running = subprocess.Popen(words, stderr=subprocess.DEVNULL, process_group=0)
        while len(found := inodes(plant / "out" / "job")) < 80 * share:
            assert running.poll() is None
            time.sleep(0.01)
        running.kill()  # its processes end with it
        running.wait()
        time.sleep(0.5)
        assert {name: found[name] for name in seen} == seen
        seen = inodes(plant / "out" / "job")
    assert batch("many")["states"] == {"written": 400}
    found = inodes(plant / "out" / "job")
    assert {name: found[name] for name in seen} == seen  # nothing was done twice
    assert files(plant / "out" / "job") == {f"p{n}.nc": ABSOLUTE for n in range(400)}


# --- elsewhere ---


def test_programs_and_results_of_urls(plant: Path) -> None:
    pytest.importorskip("fsspec")
    (plant / "programs" / "caller.ngc").write_bytes(CALLER)
    (plant / "programs" / "side.ngc").write_bytes(SIDE)
    there, results = f"file://{plant}/programs", ("--results", "out/results.sqlite")
    words = ("batch", "-p", "job.toml", *results, there, "--json", "-o")
    os.makedirs("out")
    first = json.loads(call(*words, f"file://{plant}/far").stdout)["batch"]
    assert first == {
        "done": 5,
        "states": {"written": 3, "unchanged": 1, "refused": 1},
        "codes": {"GX202": 1},
    }
    assert json.loads(call(*words, f"file://{plant}/far").stdout)["batch"]["done"] == 0
    batch("programs")
    assert files(plant / "far" / "job") == files(plant / "out" / "job")
    (plant / "programs" / "side.ngc").write_bytes(SIDE.replace(b"X1", b"X2"))
    assert json.loads(call(*words, f"file://{plant}/far").stdout)["batch"]["done"] == 2


def test_stores_do_the_same(tmp_path: Path) -> None:
    pytest.importorskip("fsspec")
    for store in (store_of(str(tmp_path / "x")), store_of("memory://plant")):
        assert isinstance(store, Store)
        store.write("a/b", b"1")
        store.write("a/b", b"2")
        store.write("a/c", b"3")
        store.move("a/c", "d/e")
        store.drop("a/none")
        assert (store.read("a/b"), store.read("d/e"), store.names("a")) == (b"2", b"3", ["b"])
        store.drop("a/b")
        assert store.names("a") == store.names("none") == []
        with pytest.raises(FileNotFoundError):
            store.read("a/b")


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Give the address of a scheduler that is a process, and it with its workers."""
    kept = folder / "scheduler.json"
    words = ["--scheduler-file", str(kept)]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    begin = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    ports = ["--port", "0", "--dashboard-address", ":0"]
    running = [subprocess.Popen([*begin, *words, *ports], **quiet)]  # type: ignore[call-overload]
    try:
        while not kept.exists() or not kept.read_text().strip():
            assert running[0].poll() is None
            time.sleep(0.05)
        worker = [sys.executable, "-m", "distributed.cli.dask_worker", *words, "--no-nanny"]
        for _ in range(workers):
            running.append(subprocess.Popen([*worker, "--nthreads", "1"], **quiet))  # type: ignore[call-overload]
        yield json.loads(kept.read_text())["address"], running
    finally:
        for each in running:
            each.kill()
            each.wait()


@pytest.mark.skipif(not LONG, reason="a scheduler and its workers: in the long profile")
def test_workers_of_a_scheduler_do_the_same_and_one_is_killed(plant: Path) -> None:
    pytest.importorskip("distributed")
    names = [f"p{n}.nc" for n in range(60)]
    for name in names:
        (plant / name).write_bytes(PART)
    with cluster(plant, 2) as (address, running):
        rows: dict[str, Row] = {}
        for each, row in scheduled([task(name, plant / "out") for name in names], address):
            rows[each.below] = row
            if len(rows) == 10:
                running[1].kill()
    assert {row.state for row in rows.values()} == {"written"}
    assert files(plant / "out") == dict.fromkeys(names, ABSOLUTE)
