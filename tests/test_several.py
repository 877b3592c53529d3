"""Several programs in one call, what would change, and the pipeline of a folder."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import pytest
from cli_kit import ABSOLUTE, MODEL, PART, PIPELINE, call, workplace

from gcxform.cli import verbs
from gcxform.cli.common import discovery, progress
from gcxform.cli.common.failures import guarded
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax import source

BAD = b"G21 G90\nG1 G2 X1 F100\nM2\n"
DONE = b"G21 G90\nG1 X1 F100\nM2\n"


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a pipeline of its own, programs in it and below, one of which is refused."""
    workplace(tmp_path, monkeypatch)
    (tmp_path / ".git").mkdir()
    (tmp_path / "gcxform.toml").write_text(PIPELINE)
    (tmp_path / "jobs" / "deep").mkdir(parents=True)
    (tmp_path / "jobs" / "deep" / "b.nc").write_bytes(PART)
    (tmp_path / "jobs" / "bad.nc").write_bytes(BAD)
    (tmp_path / "jobs" / "same.nc").write_bytes(DONE)
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    files = (path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("GX727", ("jobs", "-o", "jobs")),
        ("GX727", ("jobs/deep", "-o", "jobs")),
        ("GX727", ("part.nc", "jobs/same.nc", "-o", ".")),
        ("GX727", ("jobs", "-o", "linked")),
        ("GX901", ("jobs", "-o", "jobs/deep")),
    ],
)
def test_what_is_named_is_not_left_out_in_silence(
    code: str, words: tuple[str, ...], shop: Path
) -> None:
    """What lies in a folder of results is left out, unless it is named itself."""
    (shop / "linked").symlink_to("jobs")
    if code == "GX901":
        for name in ("bad.nc", "same.nc"):
            (shop / "jobs" / name).unlink()
    before = contents(shop)
    found = call("run", *words)
    assert (found.exit_code > 0, code in found.stderr) == (True, True), found.stderr
    assert contents(shop) == before


def test_certificates_may_go_beside_the_programs(shop: Path) -> None:
    """They are no programs, so nothing there is taken for an earlier result."""
    found = call("run", "jobs/same.nc", "part.nc", "-o", "out", "--certificate", "jobs")
    assert found.exit_code == 0, found.stderr
    assert {"out/same.nc", "jobs/same.nc.json", "jobs/part.nc.json"} <= contents(shop).keys()


# --- the pipeline of a folder ---


def test_the_pipeline_of_the_folder_is_enough_and_is_said(shop: Path) -> None:
    found = call("run", "part.nc")
    assert found.stdout_bytes == ABSOLUTE
    assert found.stderr.startswith("pipeline gcxform.toml\n")
    assert call("run", "-q", "part.nc").stderr == ""
    deep = call("run", "--check", "jobs/deep/b.nc")
    assert "pipeline gcxform.toml\n" in deep.stderr
    assert call("check", "part.nc").stderr == "pipeline gcxform.toml\n"
    posted = call("post", "part.nc")
    assert (posted.exit_code, posted.stderr) == (0, "pipeline gcxform.toml\n")
    assert (shop / "part.nc").read_bytes() == ABSOLUTE


def test_the_nearest_counts_and_what_is_said_goes_before(
    shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    near = shop / "jobs" / "gcxform.toml"
    near.write_text(PIPELINE.replace('"absolute"', '"renumber"'))
    assert call("run", "-q", "jobs/same.nc").stdout.startswith("N10")
    chosen = call("run", "-x", "", "-f", "linuxcnc", "part.nc")
    assert (chosen.stdout_bytes, "pipeline" in chosen.stderr) == (PART, False)
    monkeypatch.setenv("GCXFORM_PIPELINE", str(near))
    assert "N10 G90" in call("run", "-q", "part.nc").stdout


@pytest.mark.parametrize("mark", [".git", "home"])
def test_no_pipeline_is_looked_for_beyond_a_repository_or_home(
    mark: str, shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if mark == "home":
        monkeypatch.setenv("HOME", str(shop / "jobs"))
    else:
        (shop / "jobs" / mark).mkdir()
    found = call("run", "jobs/same.nc")
    assert found.exit_code == 2
    assert "GX726" in found.stderr
    assert call("run", "-q", "part.nc").exit_code == 0


def test_stdin_has_no_folder(shop: Path) -> None:
    assert "GX726" in call("run", "-", stdin=PART).stderr


def test_a_pipeline_that_somebody_else_left_is_not_taken(
    shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if os.getuid() == 0:
        os.chown(shop / "gcxform.toml", 12345, 12345)
    else:  # whose files are not those of the tests
        monkeypatch.setattr(discovery.os, "getuid", lambda: os.stat("part.nc").st_uid + 1)
    found = call("run", "-o", "out.nc", "part.nc")
    assert (found.exit_code, "GX750" in found.stderr) == (2, True)
    assert not (shop / "out.nc").exists()
    assert call("run", "-p", "gcxform.toml", "-o", "out.nc", "part.nc").exit_code == 0


def test_hints_are_for_the_file_that_was_found(shop: Path) -> None:
    (shop / "part.nc").write_bytes(b"G21 G90\nG1 X1 F100\n/G1 X2\nM2\n")
    (shop / "gcxform.toml").write_text(PIPELINE.replace("linuxcnc", "fanuc"))
    assert 'block-delete = "execute"' in call("run", "part.nc").stderr


# --- several programs ---


def test_one_that_fails_leaves_the_others_whole(shop: Path) -> None:
    found = call("run", "-o", "out", "part.nc", "jobs")
    assert found.exit_code == 3, found.stderr
    assert contents(shop / "out") == {"part.nc": ABSOLUTE, "deep/b.nc": ABSOLUTE, "same.nc": DONE}
    assert "jobs/bad.nc:2:4: error[GX202]" in found.stderr
    assert found.stderr.endswith("4 programs: 2 written, 1 as they were, 1 failed\n")
    before = contents(shop)
    again = call("run", "-o", "out", ".")  # what lies in the folder of results is no program
    assert again.stderr.endswith("4 programs: 2 written, 1 as they were, 1 failed\n")
    assert {**contents(shop), **before} == contents(shop)


def test_programs_are_replaced_where_they_are(shop: Path) -> None:
    found = call("run", "--in-place", "jobs/deep/b.nc", "part.nc", "./part.nc", "jobs/bad.nc")
    assert found.stderr.endswith("3 programs: 2 written, 1 failed\n")
    assert (shop / "part.nc").read_bytes() == (shop / "jobs/deep/b.nc").read_bytes() == ABSOLUTE
    assert (shop / "jobs/bad.nc").read_bytes() == BAD


def test_certificates_and_maps_of_several_programs_have_folders(shop: Path) -> None:
    words = ("--certificate", "proofs", "--map", "maps", "-o", "out")
    assert call("run", "-q", *words, "part.nc", "jobs/deep").exit_code == 0
    assert set(contents(shop / "proofs")) == {"part.nc.json", "b.nc.json"}
    assert set(contents(shop / "maps")) == {"part.nc.map.json", "b.nc.map.json"}


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("part.nc", "jobs"), "GX749"),
        (("-o", "job.toml", "part.nc", "jobs"), "GX749"),
        (("-o", "out", "jobs/deep/b.nc", "jobs/deep", "other/b.nc"), "GX749"),
        (("--in-place", "-o", "out", "jobs"), "GX728"),
        (("--check", "--in-place", "part.nc"), "GX728"),
        (("--diff", "-o", "out.nc", "part.nc"), "GX728"),
        (("--in-place", "-", "part.nc"), "GX728"),
        (("--check", "part.nc", "empty"), "GX901"),
        (("--check", "-p", "none.toml", "jobs"), "GX709"),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(
    words: tuple[str, ...], code: str, shop: Path
) -> None:
    (shop / "other").mkdir()
    (shop / "other" / "b.nc").write_bytes(DONE)
    (shop / "empty").mkdir()
    before = contents(shop)
    found = call("run", *words)
    assert found.exit_code in (2, 5), found.stderr
    assert code in found.stderr
    assert contents(shop) == before


def test_a_folder_is_its_programs(shop: Path) -> None:
    """No hidden files, none of other kinds, no links that lead out of it."""
    for name in (".hidden.nc", "sheet.xml", "part.nc~", "x.nc.tmp", ".cache/x.nc"):
        (shop / "jobs" / name).parent.mkdir(exist_ok=True)
        (shop / "jobs" / name).write_bytes(BAD)
    (shop / "jobs" / "out of it.nc").symlink_to(shop / "part.nc")
    found = call("run", "--check", "jobs")
    assert found.stderr.endswith("3 programs: 1 as they were, 1 would change, 1 failed\n")


@pytest.mark.parametrize(
    "name", ["-o.nc", "--diff", "a b.nc", "a\nb.nc", "a\x1b[2Jb.nc", b"\xff.nc"]
)
def test_any_name_will_do_and_commands_no_terminal(name: str | bytes, shop: Path) -> None:
    file = os.fsdecode(name)
    for folder, text in (("odd", PART), ("worse", BAD)):
        (shop / folder).mkdir()
        (shop / folder / file).write_bytes(text)
    found = call("run", "-o", "out", "odd", "worse/")
    assert found.exit_code == 2, "they would be written to one place"
    found = call("run", "--in-place", "odd", "worse")
    assert found.exit_code == 3
    assert found.stderr.count("\n") == 7
    assert "\x1b" not in found.stderr
    assert (shop / "odd" / file).read_bytes() == ABSOLUTE


@pytest.mark.parametrize("how", ["replaced", "written to", "taken away"])
def test_a_program_that_changes_before_its_result_is_there_is_kept(
    how: str, shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = Pipeline.run_stream

    def run_stream(*given: Any) -> Any:
        found = real(*given)
        if how == "replaced":
            (shop / "new.nc").write_bytes(DONE)
            (shop / "new.nc").replace(shop / "part.nc")
        elif how == "written to":
            (shop / "part.nc").write_bytes(DONE)
        else:
            (shop / "part.nc").unlink()
        return found

    monkeypatch.setattr(Pipeline, "run_stream", run_stream)
    found = call("run", "--in-place", "part.nc")
    assert (found.exit_code, "GX904" in found.stderr) == (5, True)
    left = (shop / "part.nc").read_bytes() if how != "taken away" else DONE
    assert (left, (shop / "part.nc").exists()) == (DONE, how != "taken away")


# --- what would change ---


def test_check_says_by_its_exit_code_whether_anything_would_change(shop: Path) -> None:
    before = contents(shop)
    assert call("run", "--check", "part.nc").exit_code == 1
    assert call("run", "--check", "jobs/same.nc").exit_code == 0
    assert call("run", "--check", "jobs").exit_code == 3
    assert call("run", "--diff", "part.nc").exit_code == 0
    assert call("run", "--diff", "--check", "part.nc").exit_code == 1
    assert contents(shop) == before


def test_a_diff_shows_what_changes_and_which_step_does_it(shop: Path) -> None:
    chain = "absolute | segment chord-error=1mm | renumber"
    text = b"G21 G90 G17\nG1 X0 Y0 Z0 F100\nG91 X1\nG90 X2\nG2 X6 I2 J0\nM2\n"
    (shop / "p.nc").write_bytes(text)
    found = call("run", "-q", "--diff", "-x", chain, "-f", "linuxcnc", "p.nc")
    assert "@@ -1,6 +1," in found.stdout
    assert " @@ renumber: 1-6; absolute: 3; segment: 5\n" in found.stdout
    (shop / "p.diff").write_bytes(found.stdout_bytes)
    subprocess.run(["patch", "-s", "p.nc", "p.diff"], check=True)
    (shop / "q.nc").write_bytes(text)
    call("run", "-q", "-x", chain, "-f", "linuxcnc", "-o", "made.nc", "q.nc")
    assert (shop / "p.nc").read_bytes() == (shop / "made.nc").read_bytes()


def test_lines_that_no_step_has_changed_say_so(shop: Path) -> None:
    (shop / "p.nc").write_bytes(b"G21 G90 G94\nG0 X1. Y0.\nG0 X2\nM30\n")
    words = ("run", "-q", "--diff", "-x", "", "-f", "linuxcnc", "-t", "fanuc")
    assert "@@ written for fanuc: 3\n" in call(*words, "p.nc").stdout


def test_stamps_are_told_apart(shop: Path) -> None:
    chain = "absolute | volumetric model=model.toml part-origin=10,10,10 outside=extrapolate"
    words = ("run", "-q", "-x", chain, "-f", "linuxcnc")
    found = call(*words, "--diff", "part.nc")
    assert "volumetric: " in found.stdout
    assert "stamp: " in found.stdout
    assert call(*words, "--in-place", "part.nc").exit_code == 0
    stamped = (shop / "part.nc").read_bytes()
    for how in ("--in-place", "--check", "--diff"):  # and those that were done are left alone
        again = call(*words, how, "part.nc")
        assert (again.exit_code, again.stdout) == (0, ""), again.stderr
        assert (shop / "part.nc").read_bytes() == stamped


@pytest.mark.skipif(sys.platform == "win32", reason="there are no pseudo-terminals")
def test_a_diff_is_coloured_on_a_terminal_and_commands_it_nothing(shop: Path) -> None:
    (shop / "p.nc").write_bytes(b"G21 G90\nG1 X1 F100 (\x1b[2J)\nG91 X1 (\x9b2J)\nM2\n")
    master, slave = os.openpty()
    command = [sys.executable, "-m", "gcxform.cli", "run", "-q", "--diff", "p.nc"]
    environment = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
    subprocess.run(command, stdout=slave, check=True, timeout=60, env=environment)
    os.close(slave)
    shown = os.read(master, 1 << 16)
    os.close(master)
    assert b"\x1b[31m-G91 X1 (?2J)\x1b[0m\r\n" in shown
    assert b"\x1b[2J" not in shown


# --- how far it is ---

ROOM = ("--radius", "9", "--planes", "XY", "--outside", "extrapolate")


@pytest.mark.parametrize(
    "verb",
    ["check", "compare", "calibrate circles", "calibrate plan", "simulate ballbar", "info"],
)
def test_on_a_terminal_it_is_said_what_is_being_done(
    verb: str, shop: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (shop / "model.toml").write_text(MODEL)
    (shop / "big.nc").write_bytes(b"G21 G90\nG1 X0 F100\n" + b"X1\nX0\n" * 2000 + b"M2\n")
    rows = "".join(f"XY,{s},100,1000,{5 * k},0\n" for s in ("ccw", "cw") for k in range(72))
    (shop / "c.csv").write_text(
        f"plane,sense,radius [mm],feed [mm/min],angle [deg],reading [um]\n{rows}"
    )
    machine = str(Path(__file__).parents[1] / "examples" / "rtcp-loop" / "set.toml")
    asked = {
        "check": ("-f", "linuxcnc", "big.nc"),
        "compare": ("-f", "linuxcnc", "big.nc", "big.nc"),
        "info": ("-f", "linuxcnc", "big.nc"),
        "calibrate circles": ("c.csv",),
        "calibrate plan": ("-m", machine, "--ball", "155,0,20", "--poses", "9", "-o", "p.csv"),
        "simulate ballbar": ("--model", "model.toml", *ROOM),
    }[verb]

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(progress, "PATIENCE", -1.0)
    monkeypatch.setattr(progress, "PACE", -1.0)
    monkeypatch.setattr(source, "WINDOW", 4096)
    for stream in (Terminal(), io.StringIO()):
        monkeypatch.setattr(sys, "stderr", stream)
        with redirect_stdout(io.StringIO()):
            code = guarded(verbs, "gcxform", [*verb.split(), *asked], {})
        assert code in (0, 1, 3), stream.getvalue()
        assert ("\r" in stream.getvalue()) == stream.isatty()
        assert not stream.isatty() or stream.getvalue().endswith("\r\x1b[K") or code == 3
