"""The hot folder: what is whole, where things go, and that each is done once whatever happens."""

from __future__ import annotations

import json
import os
import random
import signal
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from cli_kit import ABSOLUTE, MODEL, PART, PIPELINE, call

from gcxform.cli import verbs
from gcxform.cli.common.several import Outcome
from gcxform.cli.common.transform import Job
from gcxform.cli.watching.folders import Folders, beside, file_away, moved
from gcxform.cli.watching.loop import waker
from gcxform.cli.watching.whole_files import Settling
from gcxform.cli.watching.work import Told, Work
from gcxform.diagnostics import FileError, InputError
from gcxform.system.alone import is_being_written
from gcxform.system.files import write_atomically

LONG = os.environ.get("HYPOTHESIS_PROFILE") == "long"
BAD = b"G21 G90\nG1 G2 X1 F100\nM2\n"
POSIX = pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not copied here")
ONCE = ("--once", "--rest", "0", "--every", "0.02")


@pytest.fixture
def hot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    folder = tmp_path / "hot"
    folder.mkdir()
    (folder / "gcxform.toml").write_text(PIPELINE)
    return folder


def tree(folder: Path) -> dict[str, bytes]:
    """Return the files of a folder, but for proofs and what is hidden."""
    files = (path for path in folder.rglob("*") if path.is_file())
    named = {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}
    ends = (".gcxform.json", "gcxform.toml", "lock")
    return {name: text for name, text in named.items() if not name.endswith(ends)}


# --- where things go ---


def test_programs_results_and_reasons_have_their_folders(hot: Path) -> None:
    (hot / "part.nc").write_bytes(PART)
    (hot / "bad.nc").write_bytes(BAD)
    (hot / "sheet.pdf").write_bytes(b"%PDF")
    (hot / "part.nc.tmp").write_bytes(PART)
    (hot / "empty.nc").write_bytes(b"")
    found = call("watch", *ONCE, "hot")
    assert found.exit_code == 3
    assert found.stderr == "pipeline hot/gcxform.toml\n"
    done, failed = sorted(found.stdout.splitlines())[::-1]
    assert done.startswith("part.nc: done   linuxcnc -> linuxcnc   6 -> 6 blocks")
    assert done.endswith("PASS")
    reason = "bad.nc:2:4: error[GX202]: G2 and G1 are of one modal group"
    assert failed == f"bad.nc: failed   {reason}"
    said = (hot / "failed" / "bad.nc.gcxform.txt").read_text()
    assert said.startswith(f"{reason}\n2 | G1 G2 X1 F100\n")
    assert tree(hot) == {
        "out/part.nc": ABSOLUTE,
        "done/part.nc": PART,
        "failed/bad.nc": BAD,
        "failed/bad.nc.gcxform.txt": said.encode(),
        "sheet.pdf": b"%PDF",
        "part.nc.tmp": PART,
        "empty.nc": b"",
    }
    proof = json.loads((hot / "done" / "part.nc.gcxform.json").read_text())
    assert (proof["verified"], proof["source"]["name"]) == (True, "part.nc")


def test_a_program_that_is_posted_again_replaces_its_result_and_loses_none(hot: Path) -> None:
    for number in range(3):
        (hot / "part.nc").write_bytes(PART.replace(b"X10", b"X1%d" % number))
        (hot / "bad.nc").write_bytes(BAD + b"%d" % number)
        call("watch", *ONCE, "hot")
    found = tree(hot)
    assert b"X12." in found["out/part.nc"]
    assert {n for n in found if n.startswith("done/")} == {
        "done/part.nc",
        "done/part.2.nc",
        "done/part.3.nc",
    }
    assert sum(n.startswith("failed/bad") and n.endswith(".nc") for n in found) == 3


def test_stamped_programs_are_left_alone(hot: Path) -> None:
    (hot / "model.toml").write_text(MODEL)
    chain = "absolute | volumetric model=hot/model.toml part-origin=10,10,10 outside=extrapolate"
    words = ("watch", *ONCE, "-x", chain, "-f", "linuxcnc", "-o", "out", "hot")
    (hot / "part.nc").write_bytes(PART)
    assert call(*words).exit_code == 0
    stamped = Path("out/part.nc").read_bytes()
    (hot / "again.nc").write_bytes(stamped)
    before = (hot / "again.nc").stat()
    found = call(*words)
    assert found.stdout == "again.nc: done already by this very pipeline, left alone\n"
    after = (hot / "again.nc").stat()
    assert (after.st_ino, after.st_mtime_ns) == (before.st_ino, before.st_mtime_ns)
    assert not Path("out/again.nc").exists()
    other = chain.replace("10,10,10", "10,10,11")
    found = call("watch", *ONCE, "-x", other, "-f", "linuxcnc", "-o", "out", "hot")
    assert "again.nc: failed" in found.stdout
    assert "GX240" in found.stdout


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("-o", "hot", "hot"), "GX751"),
        (("-o", "hot/done", "hot"), "GX751"),
        (("-o", "hot/.gcxform", "hot"), "GX751"),
        (("-o", "hot/.gcxform/claimed", "hot"), "GX751"),
        (("none",), "GX726"),
        (("-p", "hot/gcxform.toml", "none"), "GX901"),
        (("-p", "none.toml", "hot"), "GX709"),
        (("--service", "systemd", "-p", "none.toml", "hot"), "GX709"),
        (("--service", "windows", "."), "GX726"),
        (("--service", "systemd", "hot\nUser=root"), "GX726"),
    ],
)
def test_what_cannot_be_watched_is_refused_before_anything_moves(
    words: tuple[str, ...], code: str, hot: Path
) -> None:
    (hot / "part.nc").write_bytes(PART)
    found = call("watch", *ONCE, *words)
    assert found.exit_code in (2, 5), found.stdout
    assert code in found.stderr
    assert tree(hot) == {"part.nc": PART}


def test_documents_come_a_line_for_each(hot: Path) -> None:
    (hot / "part.nc").write_bytes(PART)
    (hot / "bad.nc").write_bytes(BAD)
    found = call("watch", "--json", *ONCE, "hot")
    told = [json.loads(line) for line in found.stdout.splitlines()]
    assert Counter((t["programs"][0]["state"], t["exit_code"]) for t in told) == Counter(
        [("written", 0), ("failed", 3)]
    )
    assert [f["code"] for t in told for f in t["findings"]] == ["GX202"]


@pytest.mark.parametrize(
    "name", ["-o.nc", "a b  c.nc", "new\nline.nc", b"\xff\xfe.nc", "ä" * 120 + ".nc", "x" * 255]
)
def test_any_name_will_do(name: str | bytes, hot: Path) -> None:
    file = os.fsdecode(name)
    (hot / file).write_bytes(PART)
    found = call("watch", *ONCE, "hot")
    assert (found.exit_code, found.stdout.count("\n")) == (0, 1), found.output
    assert os.listdir(hot / "out")[-1:] != []
    assert (hot / "out" / file).read_bytes() == ABSOLUTE
    (hot / file).write_bytes(BAD)
    found = call("watch", *ONCE, "hot")
    assert (found.exit_code, found.stdout.count("\n")) == (3, 1), found.output
    assert len(os.listdir(hot / "failed")) == 2


def test_links_pipes_and_folders_are_no_programs(hot: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere.nc").write_bytes(PART)
    (hot / "link.nc").symlink_to(tmp_path / "elsewhere.nc")
    (hot / "folder.nc").mkdir()
    os.mkfifo(hot / "pipe.nc")
    found = call("watch", *ONCE, "hot")
    assert (found.exit_code, found.stdout) == (0, "")
    assert (tmp_path / "elsewhere.nc").read_bytes() == PART


# --- what is whole ---


class Clock:
    """A clock that a test sets."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_file_is_whole_that_rested_and_nobody_writes(tmp_path: Path) -> None:
    clock, file = Clock(), tmp_path / "a.nc"
    settling = Settling(tmp_path, 2.0, clock)
    file.write_bytes(b"G1")
    assert settling.whole() == []
    for later, change in ((1.9, b""), (0.2, b"X1"), (1.9, b"X2"), (1.9, b"")):
        clock.now += later
        if change:
            with file.open("ab") as stream:
                stream.write(change)
            os.utime(file, ns=(0, settling.seen["a.nc"][0].written + 1))
        assert settling.whole() == (["a.nc"] if later == 0.2 and not change else [])
    clock.now += 0.2
    assert settling.whole() == ["a.nc"]
    file.rename(tmp_path / "b.nc")  # under another name it rests anew
    assert settling.whole() == []
    clock.now += 2.0
    assert settling.whole() == ["b.nc"]


def test_dates_of_files_do_not_matter(tmp_path: Path) -> None:
    """Clocks of other computers are off, and that of this one may be set."""
    clock = Clock()
    settling = Settling(tmp_path, 2.0, clock)
    for name, date in (("past.nc", 0), ("future.nc", 4_000_000_000)):
        (tmp_path / name).write_bytes(b"M2\n")
        os.utime(tmp_path / name, (date, date))
    assert settling.whole() == []
    clock.now += 2.0
    assert settling.whole() == ["past.nc", "future.nc"]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="there are no leases")
def test_a_file_that_is_open_to_be_written_waits(hot: Path) -> None:
    settling = Settling(hot, 0.0)
    with (hot / "part.nc").open("wb") as stream:
        stream.write(PART[:20])
        stream.flush()
        if not is_being_written(hot / "part.nc"):
            pytest.skip("this file system gives no leases")
        assert settling.whole() == []
        stream.write(PART[20:])
    assert settling.whole() == ["part.nc"]


# --- exactly once ---


class Stopped(BaseException):
    """The process has gone: nothing of it runs any more."""


@contextmanager
def stopping(at: int) -> Iterator[list[int]]:
    """Stop the process before a call of the system, by number; give how many there were."""
    names = ("rename", "replace", "link", "unlink", "open", "mkdir")
    kept = {name: getattr(os, name) for name in names}
    count = [0]

    def watched(name: str) -> Callable[..., Any]:
        def run(*given: Any, **more: Any) -> Any:
            count[0] += 1
            if count[0] > at:
                raise Stopped
            return kept[name](*given, **more)

        return run

    for name in names:
        setattr(os, name, watched(name))
    try:
        yield count
    finally:
        for name, function in kept.items():
            setattr(os, name, function)


class Shop:
    """Runs that take no time: a program is refused that says so, and done otherwise."""

    def __init__(self, folder: Path) -> None:
        self.folders = Folders(folder, folder / "out")
        self.folders.make()
        self.lines: list[str] = []
        self.error: Exception | None = None
        self.seen: Counter[str] = Counter()

    def work(self) -> Work:
        return Work(
            self.folders, self.run, lambda path: None, lambda done: "done", self.tell, clock=Clock()
        )

    def run(self, job: Job) -> Outcome:
        if self.error is not None:
            raise self.error
        text = Path(job.file).read_bytes()
        if b"bad" in text:
            raise InputError.one("GX202", "no")
        for name in (job.out, job.certificate):
            with write_atomically(Path(str(name))) as put:
                put(text.upper())
        return Outcome(job, "written")

    def tell(self, told: Told) -> None:
        self.lines.append(told.line)

    def consume(self) -> None:
        """Take results away, as a control does."""
        for name in os.listdir(self.folders.out):
            if not name.startswith("."):
                self.seen[name] += 1
                (self.folders.out / name).unlink()


@pytest.mark.parametrize("consumed", [False, True], ids=["results stay", "results are taken"])
@pytest.mark.parametrize("text", [b"good", b"bad"])
def test_a_watcher_may_be_stopped_at_any_moment(
    text: bytes, consumed: bool, tmp_path: Path
) -> None:
    """Before each call of the system that changes anything, and then once more in the recovery."""
    for at in range(200):
        folder = tmp_path / f"{at}"
        folder.mkdir()
        shop = Shop(folder)
        (folder / "a.nc").write_bytes(text)
        stopped = 0
        for limit in (at, at // 2):
            try:
                with stopping(limit):
                    work = shop.work()
                    work.recover()
                    for name in Settling(folder, 0.0).whole():
                        work.take(name)
            except Stopped:
                stopped += 1
            if consumed:
                shop.consume()
        work = shop.work()
        work.recover()
        for name in Settling(folder, 0.0).whole():
            work.take(name)
        shop.consume()
        left = {n for n in tree(folder) if not n.startswith(".")}
        if text == b"good":
            assert (shop.seen, left) == (Counter(["a.nc"]), {"done/a.nc"}), at
        else:
            assert (shop.seen, left) == (Counter(), {"failed/a.nc", "failed/a.nc.gcxform.txt"}), at
        hidden = [p for p in folder.rglob("*") if p.is_file() and ".gcxform" in p.parts[-2]]
        assert [p for p in hidden if p.name != "lock"] == [], at
        if not stopped:
            break
    assert 5 < at < 199


def copied(words: tuple[str, ...], log: Path) -> int:
    """Run a command line in a copy of this process; return its number."""
    number = os.fork()
    if number:
        return number
    handle = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    for stream in (1, 2):
        os.dup2(handle, stream)
    sys.stdout = sys.stderr = os.fdopen(1, "w", buffering=1)
    try:
        verbs.main(list(words), prog_name="gcxform")
    finally:
        os._exit(1)


@POSIX
def test_each_of_many_programs_is_done_once_though_the_watcher_is_killed(hot: Path) -> None:
    """Three times, at moments that are drawn, while a control takes results as they appear."""
    count, draw = (200, random.Random()) if LONG else (20, random.Random(7))
    call("watch", *ONCE, "hot")  # what is imported is so in copies as well
    words, log = ("watch", "--rest", "0.02", "--every", "0.02", "hot"), hot.parent / "log"
    taken: Counter[str] = Counter()
    texts: dict[str, bytes] = {}
    running, kills, end = copied(words, log), 3, time.monotonic() + (300 if LONG else 30)
    try:
        for number in range(count):
            (hot / f".{number}").write_bytes(PART.replace(b"X10", b"X%d" % (number + 10)))
            (hot / f".{number}").rename(hot / f"{number}.nc")
            time.sleep(0.005)
        while sum(taken.values()) < count and time.monotonic() < end:
            for name in os.listdir(hot / "out"):
                if not name.startswith("."):
                    taken[name] += 1
                    texts[name] = (hot / "out" / name).read_bytes()
                    (hot / "out" / name).unlink()
            if kills and sum(taken.values()) >= (4 - kills) * count // 5:
                time.sleep(draw.random() * 0.05)
                os.kill(running, signal.SIGKILL)
                os.waitpid(running, 0)
                running, kills = copied(words, log), kills - 1
            time.sleep(0.002)
        time.sleep(0.2)  # for what might come twice
        late = [name for name in os.listdir(hot / "out") if not name.startswith(".")]
    finally:
        os.kill(running, signal.SIGTERM)
        _, status = os.waitpid(running, 0)
    assert (kills, late) == (0, [])
    assert taken == Counter(f"{number}.nc" for number in range(count)), log.read_text()
    for number in range(count):
        wanted = ABSOLUTE.replace(b"X10.", b"X%d." % (number + 10))
        assert texts[f"{number}.nc"] == wanted
    done = {name for name in os.listdir(hot / "done") if name.endswith(".nc")}
    assert done == set(taken)
    assert os.waitstatus_to_exitcode(status) in (1, 143)
    assert not os.listdir(hot / "failed")


@POSIX
def test_a_second_watcher_of_a_folder_is_refused(hot: Path) -> None:
    call("watch", *ONCE, "hot")
    running = copied(("watch", "--rest", "0", "hot"), hot.parent / "log")
    try:
        (hot / "part.nc").write_bytes(PART)
        end = time.monotonic() + 20
        while not (hot / "out" / "part.nc").exists() and time.monotonic() < end:
            time.sleep(0.01)
        found = call("watch", *ONCE, "hot")
    finally:
        os.kill(running, signal.SIGKILL)
        os.waitpid(running, 0)
    assert (found.exit_code, "GX751" in found.stderr) == (2, True), found.output
    assert call("watch", *ONCE, "hot").exit_code == 0


# --- not now ---


def test_what_the_system_refuses_is_tried_again_and_said_once(tmp_path: Path) -> None:
    shop = Shop(tmp_path)
    (tmp_path / "a.nc").write_bytes(b"good")
    work = shop.work()
    shop.error = FileError.one("GX902", "cannot write out/a.nc: No space left on device")
    work.take("a.nc")
    clock: Any = work.clock
    for _ in range(5):
        clock.now += 100.0
        work.again()
    assert shop.lines == ["a.nc: not now   error[GX902]: cannot write out/a.nc: "
                          "No space left on device"]  # fmt: skip
    (tmp_path / "a.nc").write_bytes(b"newer")  # which waits until the first is done
    work.take("a.nc")
    shop.error = None
    clock.now += 100.0
    work.again()
    work.take("a.nc")
    shop.consume()
    assert tree(tmp_path) == {"done/a.nc": b"good", "done/a.2.nc": b"newer"}
    assert shop.lines[1:] == ["a.nc: done", "a.nc: done"]


def test_a_result_that_cannot_appear_yet_is_not_made_again(tmp_path: Path) -> None:
    shop = Shop(tmp_path)
    (tmp_path / "a.nc").write_bytes(b"good")
    (tmp_path / "out" / "a.nc").mkdir()  # in the way
    work = shop.work()
    work.take("a.nc")
    assert "not now" in shop.lines[0]
    shop.error = AssertionError("it is run again")
    (tmp_path / "out" / "a.nc").rmdir()
    again = shop.work()
    again.recover()
    assert (tmp_path / "out" / "a.nc").read_bytes() == b"GOOD"
    assert (tmp_path / "done" / "a.nc").read_bytes() == b"good"


def test_a_program_that_is_written_to_while_it_is_run_goes_back(tmp_path: Path) -> None:
    shop = Shop(tmp_path)
    (tmp_path / "a.nc").write_bytes(b"half")
    writer = (tmp_path / "a.nc").open("ab")
    real = shop.run

    def run(job: Job) -> Outcome:
        found = real(job)
        writer.write(b" and half")
        writer.close()
        return found

    shop.run = run  # type: ignore[method-assign]
    shop.work().take("a.nc")
    assert tree(tmp_path)["a.nc"] == b"half and half"
    assert not shop.lines
    shop.run = real  # type: ignore[method-assign]
    shop.work().take("a.nc")
    assert tree(tmp_path)["out/a.nc"] == b"HALF AND HALF"


def test_a_program_that_is_dropped_anew_while_it_is_run_is_another(tmp_path: Path) -> None:
    shop = Shop(tmp_path)
    (tmp_path / "a.nc").write_bytes(b"first")
    real = shop.run

    def run(job: Job) -> Outcome:
        if not (tmp_path / "a.nc").exists() and b"first" in Path(job.file).read_bytes():
            (tmp_path / "a.nc").write_bytes(b"second")
        return real(job)

    shop.run = run  # type: ignore[method-assign]
    work = shop.work()
    work.take("a.nc")
    shop.consume()
    work.take("a.nc")
    shop.consume()
    assert shop.seen == Counter({"a.nc": 2})
    assert tree(tmp_path) == {"done/a.nc": b"first", "done/a.2.nc": b"second"}


def test_nothing_is_moved_over_another_file(tmp_path: Path) -> None:
    (tmp_path / "a.nc").write_bytes(b"mine")
    (tmp_path / "done").mkdir()
    (tmp_path / "done" / "a.nc").write_bytes(b"another")
    assert not moved(tmp_path / "a.nc", tmp_path / "done" / "a.nc")
    assert file_away(tmp_path / "a.nc", tmp_path / "done") == "a.2.nc"
    assert tree(tmp_path) == {"done/a.nc": b"another", "done/a.2.nc": b"mine"}


def test_a_bug_ends_one_program_and_not_the_watcher(tmp_path: Path) -> None:
    shop = Shop(tmp_path)
    (tmp_path / "a.nc").write_bytes(b"good")
    shop.error = ZeroDivisionError("division by zero")
    work = shop.work()
    work.take("a.nc")
    assert work.exit_code == 70
    assert shop.lines[0].startswith("a.nc: failed   internal error: ZeroDivisionError")
    assert (tmp_path / "failed" / "a.nc").exists()


def test_a_pipeline_that_is_changed_counts_for_the_next_program(hot: Path) -> None:
    (hot / "a.nc").write_bytes(PART)
    call("watch", *ONCE, "hot")
    (hot / "gcxform.toml").write_text(PIPELINE.replace('"absolute"', '"renumber"'))
    (hot / "b.nc").write_bytes(PART)
    call("watch", *ONCE, "hot")
    assert b"N10" in (hot / "out" / "b.nc").read_bytes()


def test_it_looks_by_itself_where_nothing_tells_it(
    hot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "watchdog.events", None)
    with waker(hot) as wait:
        assert wait is time.sleep
    (hot / "part.nc").write_bytes(PART)
    assert call("watch", *ONCE, "hot").exit_code == 0


def test_an_event_wakes_it(hot: Path) -> None:
    pytest.importorskip("watchdog")
    with waker(hot) as wait:
        (hot / "part.nc").write_bytes(PART)
        began = time.monotonic()
        wait(60.0)
    assert time.monotonic() - began < 30.0


# --- services ---


def test_a_unit_of_systemd_runs_the_same_command(hot: Path) -> None:
    words = ("--rest", "3", "-p", "hot/gcxform.toml", "--limit", "rows=5000000")
    found = call("watch", "--service", "systemd", *words, "hot")
    lines = dict(line.split("=", 1) for line in found.stdout.splitlines() if "=" in line)
    assert lines["WorkingDirectory"] == str(hot.parent)
    quoted = " ".join(f'"{word}"' for word in ("watch", *words, "hot"))
    assert lines["ExecStart"].endswith(f'"-m" "gcxform.cli" {quoted}')


def test_a_task_of_windows_is_well_formed(hot: Path) -> None:
    odd = hot.parent / "a & b"
    odd.mkdir()
    found = call("watch", "-p", "hot/gcxform.toml", "--service=windows", "a & b")
    root = ElementTree.fromstring(found.stdout)
    space = "{http://schemas.microsoft.com/windows/2004/02/mit/task}"
    said = {each.tag.removeprefix(space): each.text for each in root.iter()}
    assert said["Command"] == sys.executable
    assert said["Arguments"] == '-m gcxform.cli watch -p hot/gcxform.toml "a & b"'
    assert said["WorkingDirectory"] == str(hot.parent)


def test_what_stands_beside_a_program_has_room_for_its_ending() -> None:
    name = "ä" * 127 + "x"
    assert len(os.fsencode(beside(name, ".gcxform.txt"))) <= 255
