"""What goes wrong on the command line: its exit code, its words, and that nothing changes."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from cli_kit import PART, call, process, workplace

from gcxform.diagnostics import VerificationError
from gcxform.pipeline.pipeline import Pipeline
from gcxform.proof.verify import Verifier


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


# --- what goes wrong: exit code, first code shown, words ---

RUN = ("run", "-f", "linuxcnc", "-x", "absolute", "-o", "out.nc")
BAD: dict[str, tuple[int, str, tuple[str, ...]]] = {
    "no verb": (2, "", ("frobnicate",)),
    "no file": (2, "", ("run",)),
    "an unknown option": (2, "", ("run", "--frobnicate", "part.nc")),
    "an unknown choice": (2, "", ("run", "--verify", "perhaps", "part.nc")),
    "no pipeline": (2, "GX726", ("run", "part.nc")),
    "two pipelines": (2, "GX728", ("run", "-p", "job.toml", "-x", "absolute", "part.nc")),
    "no dialect": (2, "GX722", ("run", "-x", "absolute", "part.nc")),
    "an unknown dialect": (2, "GX703", ("run", "-x", "absolute", "-f", "fanuk", "part.nc")),
    "an unknown target": (2, "GX703", (*RUN, "-t", "fanuk", "part.nc")),
    "an unknown pass": (2, "GX704", ("run", "-x", "absolut", "-f", "grbl", "part.nc")),
    "an unknown key": (2, "GX701", ("run", "-x", "segment size=1", "-f", "grbl", "part.nc")),
    "half a chain": (2, "GX712", ("run", "-x", "absolute |", "-f", "grbl", "part.nc")),
    "no such pipeline file": (2, "GX709", ("run", "-p", "no.toml", "part.nc")),
    "a program as a pipeline": (2, "GX710", ("run", "-p", "part.nc", "part.nc")),
    "no such model": (
        2,
        "GX709",
        ("run", "-x", "volumetric model=no.toml", "-f", "grbl", "part.nc"),
    ),
    "no such machine": (2, "GX401", (*RUN, "-m", "no.toml", "part.nc")),
    "a bad start": (2, "GX702", (*RUN, "--start", "X4", "part.nc")),
    "a start of no axis": (2, "GX701", (*RUN, "--start", "Q=4", "part.nc")),
    "a bad length": (2, "GX708", (*RUN, "--increment", "5 furlongs", "part.nc")),
    "no origin": (2, "GX721", (*RUN[:4], "volumetric model=model.toml", "part.nc")),
    "input as output": (2, "GX727", (*RUN[:5], "-o", "part.nc", "part.nc")),
    "pipeline as output": (2, "GX727", ("run", "-p", "job.toml", "-o", "job.toml", "part.nc")),
    "input as certificate": (2, "GX727", (*RUN, "--certificate", "part.nc", "part.nc")),
    "one place for two": (2, "GX728", (*RUN, "--map", "out.nc", "part.nc")),
    "in place and elsewhere": (2, "GX728", (*RUN, "--in-place", "part.nc")),
    "stdin in place": (2, "GX728", (*RUN[:5], "--in-place", "-")),
    "post of stdin": (2, "GX728", ("post", "-p", "job.toml", "-")),
    "a host without a pipeline": (2, "GX726", ("hosts", "linuxcnc")),
    "a host of another dialect": (2, "GX739", ("hosts", "linuxcnc", "-p", "grbl.toml")),
    "no such program": (5, "GX901", (*RUN, "no.nc")),
    "a directory": (2, "GX749", (*RUN, ".")),
    "a directory to check": (5, "GX901", ("check", "-p", "job.toml", ".")),
    "a directory to look at": (5, "GX901", ("info", ".")),
    "nowhere to write": (5, "GX902", (*RUN[:5], "-o", "no/out.nc", "part.nc")),
    "a directory as output": (2, "GX727", (*RUN[:5], "-o", ".", "part.nc")),
    "nowhere for the certificate": (5, "GX902", (*RUN, "--certificate", "no/c.json", "part.nc")),
    "a full device": (5, "GX902", (*RUN[:5], "-o", "/dev/full", "part.nc")),
    "a binary file": (3, "GX101", (*RUN, "binary")),
    "no feed": (3, "GX204", (*RUN, "feedless.nc")),
    "unknown start": (3, "GX208", (*RUN, "lost.nc")),
    "an arc off its circle": (3, "GX301", (*RUN, "arc.nc")),
    "an impossible radius": (3, "GX302", (*RUN, "radius.nc")),
    "two codes of a group": (3, "GX202", (*RUN, "two.nc")),
    "outside the table": (
        3,
        "GX310",
        (*RUN[:3], "-x", "volumetric model=model.toml part-origin=-5,0,0", "part.nc"),
    ),
    "an unknown code": (2, "GX729", ("explain", "GX000")),
    "no code at all": (2, "GX729", ("explain", "everything")),
    "a line that is not there": (2, "GX731", ("explain", "part.nc:99", "-f", "grbl")),
    "an unknown thing": (2, "GX730", ("list", "formats", "no")),
    "a bad tolerance": (2, "GX708", ("compare", "-f", "grbl", "--tolerance", "x", "a", "b")),
    "no tolerance": (2, "GX706", ("compare", "-f", "grbl", "--tolerance", "0", "a", "b")),
    "an origin without model": (2, "GX705", ("compare", "--part-origin", "0,0,0", "a", "b")),
}
PROGRAMS = {
    "binary": bytes(range(256)) * 40,
    "feedless.nc": b"G1 X0 Y0\n",
    "lost.nc": b"G2 F100 X1 I1\n",
    "arc.nc": b"G1 F100 X0 Y0\nG2 X10 Y0 I4 J0\n",
    "radius.nc": b"G1 F100 X0 Y0\nG2 X10 Y0 R2\n",
    "two.nc": b"G0 G1 X0\n",
    "grbl.toml": b'format = 1\n[input]\ndialect = "grbl"\n[[pass]]\nuse = "absolute"\n',
}


@pytest.mark.parametrize(("code", "first", "words"), BAD.values(), ids=BAD)
def test_what_goes_wrong(here: Path, code: int, first: str, words: tuple[str, ...]) -> None:
    for name, text in PROGRAMS.items():
        (here / name).write_bytes(text)
    (here / "out.nc").write_text("as it was")
    before = {path: path.read_bytes() for path in here.iterdir()}
    found = call(*words, stdin=PART)
    assert found.exit_code == code, found.output
    assert found.stdout == ""
    assert first in found.stderr
    assert len(found.stderr) > 20
    assert "Traceback" not in found.stderr
    assert "None" not in found.stderr
    assert "\x1b" not in found.stderr
    assert {path: path.read_bytes() for path in here.iterdir()} == before


def test_links_to_the_input_are_seen_through(here: Path) -> None:
    os.symlink("part.nc", "soft.nc")
    os.link("part.nc", "hard.nc")
    (here / "sub").mkdir()
    for name in ("soft.nc", "hard.nc", "sub/../part.nc", str(here / "part.nc")):
        found = call(*RUN[:5], "-o", name, "part.nc")
        assert (found.exit_code, "GX727" in found.stderr) == (2, True), found.stderr
    assert (here / "part.nc").read_bytes() == PART


def test_a_cause_is_said_once(here: Path) -> None:
    """With the other lines that have it; codes are causes of their own."""
    (here / "a.nc").write_bytes(b"G21 G90 G94 G17\nG0 X1 Y2\nX3\n")
    words = ("run", "-f", "fanuc", "-x", "offsets", "-o", "out.nc", "a.nc")
    said = call(*words).stderr
    assert said.count("GX205") == 1
    assert "also at line 3" in said
    (here / "a.nc").write_bytes(b"G21 G90 G94 G17\nG5.5 X1.\nG44.4 X1.\n")
    assert call(*words).stderr.count("GX201") == 2


def test_an_empty_program(here: Path) -> None:
    (here / "empty.nc").write_bytes(b"")
    found = call(*RUN, "empty.nc")
    assert found.exit_code == 0, found.stderr
    assert (here / "out.nc").read_bytes() == b""
    assert call("info", "-f", "linuxcnc", "empty.nc").exit_code == 0
    assert call("check", "-f", "fanuc", "empty.nc").exit_code == 0
    assert "GX222" in call("check", "-f", "linuxcnc", "empty.nc").stderr  # as rs274 does


# --- failures on the way ---


def test_a_verification_that_fails(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise VerificationError.one("GX601", "far off")

    monkeypatch.setattr(Verifier, "check", fail)
    (here / "out.nc").write_text("as it was")
    for words in (["run", "-o", "out.nc"], ["run"], ["post"]):
        found = call(*words, "-p", "job.toml", "part.nc")
        assert found.exit_code == 4
        assert found.stdout == ""
        assert "GX601" in found.stderr
    assert (here / "out.nc").read_text() == "as it was"
    assert (here / "part.nc").read_bytes() == PART


def test_a_bug(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("of the author")

    monkeypatch.setattr(Pipeline, "run_stream", fail)
    monkeypatch.setenv("TMPDIR", str(here))
    monkeypatch.setattr("tempfile.tempdir", None)
    found = call(*RUN, "part.nc")
    assert found.exit_code == 70
    assert "ZeroDivisionError: of the author" in found.stderr
    assert "Traceback" not in found.stderr
    (report,) = here.glob("gcxform-bug-*.txt")
    assert str(report) in found.stderr
    assert "Traceback" in report.read_text()
    assert not (here / "out.nc").exists()
    for words in (("--debug", *RUN), (*RUN, "--debug")):
        assert "Traceback" in call(*words, "part.nc").stderr


def big(here: Path, lines: int = 60_000) -> None:
    text = "G21 G90\nG1 F100 X0 Y0 Z0\n" + "".join(f"X{k}.5 Y{k % 7}\n" for k in range(lines))
    (here / "big.nc").write_text(text)


def limit_files() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))


def test_a_disk_that_is_full(here: Path) -> None:
    big(here)
    (here / "out.nc").write_text("as it was")
    before = sorted(os.listdir())
    for words in (["run", "-o", "out.nc"], ["post"]):
        found = process(*words, "-p", "job.toml", "-t", "grbl", "big.nc", preexec_fn=limit_files)
        assert found.returncode == 5, found.stderr
        assert b"GX902" in found.stderr
        assert b"Traceback" not in found.stderr
    assert (here / "out.nc").read_text() == "as it was"
    assert sorted(os.listdir()) == before


def test_a_full_stdout(here: Path) -> None:
    for words in (["run", "-q", "-p", "job.toml", "part.nc"], ["list", "passes"]):
        with open("/dev/full", "wb") as full:
            found = process(*words, stdout=full)
        assert found.returncode == 5
        assert b"No space left" in found.stderr
        assert b"Traceback" not in found.stderr


def test_a_reader_that_goes_away(here: Path) -> None:
    big(here)
    command = [sys.executable, "-W", "error", "-m", "gcxform.cli", "run", "-q"]
    run = subprocess.Popen(
        [*command, "-x", "", "-f", "grbl", "big.nc"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert run.stdout is not None
    run.stdout.close()
    assert run.stderr is not None
    with run.stderr as stderr:
        assert stderr.read() == b""
    assert run.wait(60) == 5


def test_stdin_that_is_closed(here: Path) -> None:
    words = f"{sys.executable} -m gcxform.cli run -q -p job.toml - <&-"
    found = subprocess.run(words, shell=True, check=False, capture_output=True)
    assert found.returncode == 5
    assert b"GX901" in found.stderr


def test_an_interrupt(here: Path) -> None:
    os.mkfifo("slow.nc")
    (here / "out.nc").write_text("as it was")
    command = [sys.executable, "-m", "gcxform.cli", *RUN, "slow.nc"]
    run = subprocess.Popen(command, stderr=subprocess.PIPE)
    with open("slow.nc", "wb"):  # opens when the other side reads
        time.sleep(0.2)
        run.send_signal(signal.SIGINT)
        assert run.wait(60) == 130
    assert run.stderr is not None
    with run.stderr as stderr:
        assert b"Traceback" not in stderr.read()
    assert (here / "out.nc").read_text() == "as it was"
    assert not list(here.glob("*.part"))
