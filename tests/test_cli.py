"""The command line: help, `run` and `post`, and the parts they are made of."""

from __future__ import annotations

import hashlib
import json
import os
import resource
import shlex
import shutil
import stat
import statistics
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import pytest
from cli_kit import ABSOLUTE, PART, call, expanded, process, workplace
from hypothesis import given
from hypothesis import strategies as st

from gcxform.api import read
from gcxform.cli import VERBS
from gcxform.cli.common.failures import paint
from gcxform.cli.common.progress import Progress
from gcxform.cli.common.source_map import SourceMap
from gcxform.comparison import compare
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import Source


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


# --- help ---


def test_help_is_quick() -> None:
    def seconds(*words: str) -> float:
        """Return the time of the processor: that of the clock depends on what else is done."""
        began = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([sys.executable, *words], check=True, stdout=subprocess.DEVNULL)
        ended = resource.getrusage(resource.RUSAGE_CHILDREN)
        return ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime

    def usual(*words: str) -> float:
        return statistics.median(seconds(*words) for _ in range(5))

    wanted = max(0.15, 3 * usual("-c", "import click"))  # the latter where processors are slow
    assert usual("-m", "gcxform.cli", "--help") < wanted


def test_a_run_waits_for_no_library_of_other_verbs(tmp_path) -> None:
    (tmp_path / "in.nc").write_text("G21 G90\nG1 X1. F100.\nM30\n")
    words = [
        "run",
        str(tmp_path / "in.nc"),
        "-o",
        str(tmp_path / "out.nc"),
        "-x",
        "metric",
        "-f",
        "linuxcnc",
    ]
    code = (
        "import sys\nfrom gcxform.cli import verbs\n"
        f"try: verbs.main({words})\nexcept SystemExit as end: code = end.code\n"
        "sys.exit(code or len({'scipy', 'tomlkit', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True)
    assert (done.returncode, (tmp_path / "out.nc").exists()) == (0, True), done.stderr


def test_help_waits_for_click_alone() -> None:
    code = (
        "import sys\nfrom gcxform.cli import verbs\n"
        "try: verbs.main(['--help'])\nexcept SystemExit: pass\n"
        "heavy = {'scipy', 'tomlkit', 'matplotlib'}\n"
        "heavy |= {'numpy', 'lark', 'msgspec', 'pluggy', 'gcxform.pipeline.pipeline'}\n"
        "sys.exit(len(heavy & set(sys.modules)))"
    )
    assert (
        subprocess.run(
            [sys.executable, "-c", code], check=False, stdout=subprocess.DEVNULL
        ).returncode
        == 0
    )


def test_help_names_every_verb() -> None:
    for words in ([], ["-h"], ["--help"]):
        found = call(*words)
        assert all(verb in found.output for verb in VERBS)
    assert call("--version").output.startswith("gcxform ")


def test_a_verb_that_is_misspelt_is_proposed() -> None:
    found = call("rum", "part.nc")
    assert found.exit_code == 2
    assert "there is no verb 'rum'; did you mean 'run'?" in found.stderr
    assert "No such command 'xyzzy'" in call("xyzzy").stderr
    assert "there is no file 'part.nc'" in call("part.nc").stderr


def test_a_program_without_a_verb_is_told_what_to_type(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each line that is offered can be pasted, with a blank in the name."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "parts 1").mkdir()
    text = "N10 G21 G90 G17 G54 G64 P0.01\nN20 G0 X1 Y1 Z1\nN30 G91 X2\nN40 M2\n"
    (tmp_path / "parts 1" / "a.nc").write_text(text)
    for named, lines in (("parts 1/a.nc", 3), ("parts 1", 2)):
        found = call(named)
        assert (found.exit_code, "it looks like linuxcnc" in found.stderr) == (2, True)
        offered = [each for each in found.stderr.splitlines() if each.startswith("  gcxform ")]
        assert len(offered) == lines
        for line in offered:
            done = call(*shlex.split(line.partition("    ")[0])[1:])
            assert done.exit_code == 0, (line, done.output)
    (tmp_path / "empty").mkdir()
    assert "-f DIALECT" in call("empty").stderr
    for name in ("b.nc", "c.nc"):
        (tmp_path / "parts 1" / name).write_text("%\nO01234\nN5 G00 G17 G90\nN10 G53 Z0.\nM30\n%\n")
    assert "it looks like haas" in call("parts 1").stderr  # as most of its programs


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_completes_verbs_and_options(tmp_path: Path) -> None:
    """What the verb prints is read by a real bash, whose function then asks the command line."""
    (tmp_path / "complete.sh").write_text(call("completion", "bash").stdout)
    (tmp_path / "gcxform").write_text(f'#!/bin/sh\nexec {sys.executable} -m gcxform.cli "$@"\n')
    (tmp_path / "gcxform").chmod(0o755)
    asked = (
        "source complete.sh; COMP_WORDS=(gcxform {0}); COMP_CWORD={1}; "
        '_gcxform_completion gcxform; printf "%s\\n" "${{COMPREPLY[@]}}"'
    )
    for words, at, wanted in (("re", 1, ["resume"]), ("run --incr", 2, ["--increment"])):
        done = subprocess.run(
            ["bash", "-c", asked.format(words, at)],
            cwd=tmp_path,
            env={**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"},
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert done.stdout.split() == wanted, done.stderr


@pytest.mark.parametrize("verb", VERBS)
def test_verbs_have_help(verb: str) -> None:
    found = call(verb, "--help")
    assert found.exit_code == 0
    assert VERBS[verb] in found.output


# --- run ---


def test_stdout_holds_the_program_and_nothing_else(here: Path) -> None:
    found = call("run", "-x", "absolute", "-f", "linuxcnc", "part.nc")
    assert found.exit_code == 0, found.stderr
    assert found.stdout_bytes == ABSOLUTE
    assert "linuxcnc -> linuxcnc" in found.stderr
    assert "PASS" in found.stderr


def test_quiet_says_nothing(here: Path) -> None:
    found = call("run", "-q", "-p", "job.toml", "-o", "out.nc", "part.nc")
    assert (found.exit_code, found.output) == (0, "")
    assert (here / "out.nc").read_bytes() == ABSOLUTE
    assert (here / "part.nc").read_bytes() == PART


def test_stdin(here: Path) -> None:
    found = call("run", "-q", "-p", "job.toml", "-", stdin=PART)
    assert found.stdout_bytes == ABSOLUTE


def test_a_pipe_as_a_file(here: Path) -> None:
    os.mkfifo("pipe.nc")
    writer = threading.Thread(target=lambda: Path("pipe.nc").write_bytes(PART), daemon=True)
    writer.start()
    found = call("run", "-q", "-p", "job.toml", "pipe.nc")
    writer.join(10)
    assert found.stdout_bytes == ABSOLUTE, found.stderr


def test_the_empty_pipeline_copies(here: Path) -> None:
    found = call("run", "-x", "", "-f", "fanuc", "part.nc")
    assert found.stdout_bytes == PART


def test_the_pipeline_of_the_environment(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GCXFORM_PIPELINE", "job.toml")
    assert call("run", "-q", "part.nc").stdout_bytes == ABSOLUTE
    chosen = call("run", "-q", "-x", "", "-f", "grbl", "part.nc")
    assert chosen.stdout_bytes == PART


def test_what_the_command_line_says_goes_before_the_file(here: Path) -> None:
    (here / "part.nc").write_bytes(b"G91 G1 F100 X1\n/M8\nM2\n")
    words = ["run", "-q", "-p", "job.toml", "--start", "X=4,Y=-2 mm", "--block-delete", "skip"]
    found = call(*words, "part.nc")
    assert found.stdout_bytes.startswith(b"G90 G1 F100 X5.\n"), found.stderr
    fanuc = call(*words, "-f", "fanuc", "--increment", "1 um", "part.nc")
    assert b"X4.001" in fanuc.stdout_bytes, fanuc.stderr


def test_certificate_and_map(here: Path) -> None:
    words = ["--certificate", "c.json", "--map", "m.json", "-o", "out.nc", "part.nc"]
    found = call("run", "-x", "segment max-length=1 chord-error=1um", "-f", "linuxcnc", *words)
    assert found.exit_code == 0, found.stderr
    certificate, mapped = (json.loads((here / n).read_text()) for n in ("c.json", "m.json"))
    written = (here / "out.nc").read_bytes()
    assert certificate["output"]["sha256"] == hashlib.sha256(written).hexdigest()
    assert mapped["output"]["sha256"] == certificate["output"]["sha256"]
    assert mapped["source"]["sha256"] == hashlib.sha256(PART).hexdigest()
    assert mapped["format"] == 1
    assert len(expanded(mapped["lines"])) == written.count(b"\n")
    assert len(mapped["lines"]) < 8


def test_a_certificate_on_stdout(here: Path) -> None:
    found = call("run", "-p", "job.toml", "-o", "out.nc", "--certificate", "-", "part.nc")
    assert json.loads(found.stdout)["verified"] is True


def test_verification_can_be_switched_off(here: Path) -> None:
    words = ["run", "-p", "job.toml", "-o", "out.nc", "--certificate", "c.json"]
    assert "NOT VERIFIED" in call(*words, "--verify", "off", "part.nc").stderr
    assert json.loads((here / "c.json").read_text())["verified"] is False
    assert "PASS" in call(*words, "--verify", "full", "part.nc").stderr


def test_in_place(here: Path) -> None:
    os.chmod("part.nc", 0o640)
    os.symlink("part.nc", "link.nc")
    assert call("run", "-q", "-p", "job.toml", "--in-place", "link.nc").exit_code == 0
    assert (here / "part.nc").read_bytes() == ABSOLUTE
    assert os.path.islink("link.nc")
    assert stat.S_IMODE(os.stat("part.nc").st_mode) == 0o640
    assert sorted(os.listdir()) == ["job.toml", "link.nc", "model.toml", "part.nc"]


def test_what_is_no_file_is_written_to_and_not_replaced(here: Path) -> None:
    os.mkfifo("out")
    taken: list[bytes] = []
    reader = threading.Thread(target=lambda: taken.append(Path("out").read_bytes()), daemon=True)
    reader.start()
    found = call("run", "-q", "-p", "job.toml", "-o", "out", "part.nc")
    reader.join(10)
    assert (found.exit_code, taken) == (0, [ABSOLUTE])
    assert stat.S_ISFIFO(os.stat("out").st_mode)


# --- post ---


def test_post_edits_in_place_and_is_quiet(here: Path) -> None:
    (here / "x.gcode.pp").write_bytes(PART)
    found = process("post", "-p", "job.toml", "x.gcode.pp", stdin=subprocess.DEVNULL)
    assert (found.returncode, found.stdout, found.stderr) == (0, b"", b"")
    assert (here / "x.gcode.pp").read_bytes() == ABSOLUTE
    again = call("post", "-p", "job.toml", "--certificate", "c.json", "x.gcode.pp")
    assert again.exit_code == 0
    assert (here / "x.gcode.pp").read_bytes() == ABSOLUTE
    assert sorted(os.listdir()) == ["c.json", "job.toml", "model.toml", "part.nc", "x.gcode.pp"]


def test_post_says_no_more_than_a_box_can_show(here: Path) -> None:
    (here / "bad.nc").write_bytes(b"G91 X1 (no motion, no start)\n" * 200)
    found = call("post", "-p", "job.toml", "bad.nc")
    assert found.exit_code == 3
    assert len(found.stderr.splitlines()) <= 20
    assert found.stderr.startswith("bad.nc:1:")
    assert "more" in found.stderr.splitlines()[-1]


# --- the parts ---


class Terminal:
    """A stream that says it is a terminal."""

    def __init__(self) -> None:
        self.text = ""

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> None:
        self.text += text

    def flush(self) -> None:
        pass


def test_colours_only_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "a.nc:1:2: error[GX101]: no"
    monkeypatch.delenv("NO_COLOR", raising=False)
    stream: Any = Terminal()
    assert paint(text, stream) == "a.nc:1:2: \x1b[31;1merror[GX101]\x1b[0m: no"
    monkeypatch.setenv("NO_COLOR", "1")
    assert paint(text, stream) == text


def test_progress_waits_and_goes_away(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    stream: Any = Terminal()
    monkeypatch.setattr("sys.stderr", stream)
    monkeypatch.setattr("gcxform.cli.common.progress.time.monotonic", lambda: now[0])
    progress = Progress(1000, quiet=False)
    progress(100)
    assert stream.text == ""
    now[0] = 0.6
    progress(400)
    progress(100)
    assert stream.text.count("%") == 1
    assert " 50 %" in stream.text
    progress.close()
    assert stream.text.endswith("\r\x1b[K")
    silent = Progress(1000, quiet=True)
    now[0] = 9.0
    silent(500)
    assert stream.text.count("%") == 1


steps = st.lists(st.sampled_from([0, 0, 1, 1, 1, 2, 5]), max_size=60)


@given(st.lists(steps, max_size=4))
def test_a_source_map_loses_nothing(windows: list[list[int]]) -> None:
    taken, everything, line = SourceMap(), [], 0
    for window in windows:
        lines = [line := line + step for step in window]
        taken += lines
        everything += lines
    assert expanded(taken.runs) == everything
    assert len(taken) == 0


def test_a_source_map_of_copied_lines_is_one_run() -> None:
    taken = SourceMap()
    for first in range(0, 5000, 1000):
        taken += list(range(first, first + 1000))
    assert taken.runs == [[1, 1, 5000, 1]]


def test_a_split_block_is_one_run_also_across_windows() -> None:
    taken = SourceMap()
    taken += [5]
    taken += [5, 5]
    assert taken.runs == [[1, 6, 3, 0]]


# --- the core, as seen from here ---


@pytest.mark.parametrize(
    ("dialect", "between"), [("fanuc", "M6"), ("fanuc", "G55"), ("linuxcnc", "G55")]
)
def test_a_move_from_a_lost_position_is_not_cut(dialect: str, between: str) -> None:
    text = f"G54 G1 X0. Y0. Z0. F100.\nX10.\n{between}\nG1 X20. Y10. Z0.\n".encode()
    result = Pipeline.parse("segment max-length=3 chord-error=1um", dialect).run(text)
    assert result.text.splitlines()[-1] == b"G1 X20. Y10. Z0."


def test_a_unit_that_a_setting_decides_is_told_where_moves_are_cut(here: Path) -> None:
    (here / "part.nc").write_text("O0001\nG90 G0 X1. Y1. Z1.\nG1 X2. F10.\nM30\n")
    cut = "run", "-f", "haas", "-x", "segment max-length=0.5 arcs=split", "part.nc"
    warned = call(*cut)
    assert warned.exit_code == 0
    assert "part.nc:2:1: warning[GX235]" in warned.stderr
    assert "taken to be in mm" in warned.stderr
    for others in (("--units", "mm"), ("--units", "in")):
        assert "GX235" not in call(*cut, *others).stderr
    assert "GX235" not in call("run", "-f", "haas", "-x", "absolute", "part.nc").stderr


@pytest.mark.parametrize("block", ["/M8", "/X2"])
def test_a_block_that_is_skipped_stays_as_it_is(here: Path, block: str) -> None:
    (here / "part.nc").write_text(f"G1 F100 X0\nG91 X1\n{block}\nM2\n")
    found = call("run", "-q", "-p", "job.toml", "--block-delete", "skip", "part.nc")
    assert found.stdout.splitlines()[2] == block


def test_the_certificate_of_a_copied_program_counts_lines() -> None:
    certificate = Pipeline.parse("", "linuxcnc").run_stream(Source.of_bytes(PART), len)
    assert certificate.source["lines"] == 6


def test_the_api_reads_and_compares(here: Path) -> None:
    one = read("part.nc", "linuxcnc")
    assert one.text == PART
    assert len(one.path) == 3
    assert compare(one, read(ABSOLUTE, "linuxcnc")).same
    nothing = read(b"", "linuxcnc")
    assert len(nothing.path) == 0
    assert compare(nothing, nothing).same
