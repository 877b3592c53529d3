"""What happens beside a run: files that must not be overwritten, that change, signals that end it.

Whatever it is, the destination is as it was or complete, and nothing is proved of a mixture.
"""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from cli_kit import MODEL, PART, PIPELINE, call, workplace

import gcxform as gx
from gcxform.syntax.source import Source
from gcxform.system import inputs

SUM = 'format = 1\nkind = "sum"\nmodels = ["model.toml"]\n'
MACHINE = 'format = 1\ntool-table = "tool.tbl"\ntool-table-units = "mm"\n'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


# --- what is overwritten ---


def test_nothing_that_is_read_is_overwritten(here: Path) -> None:
    """The parts of models too, and what only a file names."""
    (here / "sum.toml").write_text(SUM)
    (here / "tool.tbl").write_text("T1 Z100\n")
    (here / "mill.toml").write_text(MACHINE)
    (here / "job.toml").write_text(PIPELINE + '[machine]\nfile = "mill.toml"\n')
    chain = "absolute | volumetric model=sum.toml part-origin=10,10,10 outside=extrapolate"
    os.link(here / "model.toml", here / "same.toml")
    before = {path: path.read_bytes() for path in here.iterdir()}
    for name in ("model.toml", "sum.toml", "same.toml"):
        for option in ("-o", "--certificate", "--map"):
            found = call("run", "-f", "linuxcnc", "-x", chain, option, name, "part.nc")
            assert (found.exit_code, "GX727" in found.stderr) == (2, True), found.output
    for name in ("mill.toml", "tool.tbl"):
        found = call("run", "-p", "job.toml", "--certificate", name, "part.nc")
        assert (found.exit_code, "GX727" in found.stderr) == (2, True), found.output
    assert {path: path.read_bytes() for path in here.iterdir()} == before


def test_a_file_that_may_not_be_written_to_stays(here: Path) -> None:
    (here / "part.nc").chmod(0o444)
    found = call("post", "-p", "job.toml", "part.nc")
    assert (found.exit_code, "GX902" in found.stderr) == (5, True), found.output
    assert (here / "part.nc").read_bytes() == PART
    (here / "part.nc").chmod(0o4755)
    assert call("post", "-p", "job.toml", "part.nc").exit_code == 0
    assert stat.S_IMODE((here / "part.nc").stat().st_mode) == 0o755


@pytest.mark.parametrize("letter", ["a", "\u00e4"])
def test_names_as_long_as_they_may_be(here: Path, letter: str) -> None:
    name = letter * (250 // len(letter.encode())) + ".nc"
    assert call("run", "-p", "job.toml", "-o", name, "part.nc").exit_code == 0
    assert b"G90 X10." in (here / name).read_bytes()


def test_stdout_that_is_closed(here: Path) -> None:
    words = f"{sys.executable} -m gcxform.cli run -q -p job.toml part.nc >&-"
    found = subprocess.run(words, shell=True, check=False, capture_output=True)
    assert (found.returncode, b"GX902" in found.stderr) == (5, True), found.stderr


# --- input that changes ---


@pytest.mark.parametrize("change", ["truncate", "rewrite", "append"])
def test_a_program_that_changes_while_it_is_read(here: Path, change: str) -> None:
    """Whatever a writer does between two readings: all of them are of one copy."""
    path = here / "part.nc"
    path.write_bytes(PART + b"(x)\n" * 3_000_000)
    made: list[int] = []

    class Meddling:
        """A stream beside which somebody writes into the file."""

        def __init__(self, stream: object) -> None:
            self.stream = stream

        def fileno(self) -> int:
            return self.stream.fileno()  # type: ignore[attr-defined, no-any-return]

        def read(self, size: int) -> bytes:
            chunk: bytes = self.stream.read(size)  # type: ignore[attr-defined]
            if not made:
                made.append(1)
                with path.open("ab" if change == "append" else "r+b") as other:
                    if change == "truncate":
                        other.truncate(100)
                    else:
                        other.write(b"G1 X9\n")
            return chunk

    with path.open("rb") as stream, pytest.raises(gx.FileError, match="GX904"):
        Source.copied(Meddling(stream), "part.nc")  # type: ignore[arg-type]
    assert made


def test_a_program_that_is_written_all_the_time(here: Path) -> None:
    """Whoever wins: the result is of one of the texts that the file has had, or there is none."""
    path = here / "part.nc"
    texts = [PART.replace(b"X10", b"X%d" % k) for k in (11, 22)]
    ended = threading.Event()

    def write() -> None:
        k = 0
        while not ended.is_set():
            k += 1
            with path.open("r+b") as file:
                file.write(texts[k % 2])

    writer = threading.Thread(target=write)
    path.write_bytes(texts[0])
    wanted = {call("run", "-p", "job.toml", "-", stdin=text).stdout_bytes for text in texts}
    writer.start()
    try:
        for _ in range(30):
            found = call("run", "-p", "job.toml", "part.nc")
            assert found.exit_code == 5 or found.stdout_bytes in wanted, found.output
    finally:
        ended.set()
        writer.join()


@pytest.mark.parametrize("kind", [gx.ModelFile, gx.KinematicsFile])
def test_a_file_that_changes_between_two_readings(
    here: Path, monkeypatch: pytest.MonkeyPatch, kind: type[gx.ModelFile]
) -> None:
    """What it says would not be what its hash in the certificate says."""
    (here / "model.toml").write_text(MODEL if kind is gx.ModelFile else "format = 1\n")
    assert kind.load(here / "model.toml").sha256
    read = inputs.read

    def written_after(path: Path) -> bytes:
        data = read(path)
        path.write_bytes(data + b"# another\n")
        return data

    monkeypatch.setattr(inputs, "read", written_after)
    with pytest.raises(gx.FileError, match="GX904"):
        kind.load(here / "model.toml")


# --- runs that are ended ---


def slow(here: Path) -> Path:
    """Return a program whose lines go to lark one by one."""
    lines = (f"G1 X{k % 90}.5 (line {k})\n" for k in range(150_000))
    (here / "slow.nc").write_text("G21 G90\nG1 F100 X0 Y0 Z0\n" + "".join(lines) + "M2\n")
    return here / "slow.nc"


WORKERS = 3  # that of the program, that of what was written, and the proof


def begun(here: Path, program: Path) -> tuple[subprocess.Popen[bytes], list[int]]:
    """Start a run; return it, and its workers once there are any."""
    command = [sys.executable, "-m", "gcxform.cli", "run", "-q", "-p", "job.toml", "-o", "out.nc"]
    run = subprocess.Popen([*command, str(program)], stderr=subprocess.PIPE, process_group=0)
    children = Path(f"/proc/{run.pid}/task/{run.pid}/children")
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline and run.poll() is None:
        found = [int(pid) for pid in children.read_text().split()]
        if len(found) == WORKERS:
            time.sleep(0.3)  # they are at work
            return run, found
        time.sleep(0.01)
    raise AssertionError("the run has no workers")


def gone(pids: list[int]) -> bool:
    deadline = time.monotonic() + 5
    while any(Path(f"/proc/{pid}/cmdline").exists() for pid in pids):
        if all(_is_dead(pid) for pid in pids):
            return True
        if time.monotonic() > deadline:
            return False
        time.sleep(0.01)
    return True


def _is_dead(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] in "ZX"
    except OSError:
        return True


@pytest.mark.skipif(sys.platform != "linux", reason="workers are processes on Linux alone")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT", "SIGKILL"])
def test_a_run_that_is_ended_leaves_nothing(here: Path, name: str) -> None:
    """Nothing beside the destination, which is as it was, and no worker; SIGKILL leaves a file."""
    (here / "out.nc").write_text("as it was")
    number = getattr(signal, name)
    run, workers = begun(here, slow(here))
    run.send_signal(number)
    _, said = run.communicate(timeout=10)
    killed = number == signal.SIGKILL
    assert run.returncode == (-number if killed else 128 + number), said
    assert said.count(b"\n") == (not killed)
    assert gone(workers)
    assert (here / "out.nc").read_text() == "as it was"
    assert len(list(here.glob(".*.part"))) == killed


@pytest.mark.skipif(sys.platform != "linux", reason="workers are processes on Linux alone")
def test_a_worker_ends_with_the_one_that_waits_whatever_it_is_at(here: Path) -> None:
    code = (
        "import os, signal, time; from gcxform.system.worker import worker; "
        "one = worker(lambda: time.sleep(20), True); one.begin(); "
        "print(one.process.pid, flush=True); time.sleep(0.5); os.kill(os.getpid(), signal.SIGKILL)"
    )
    command = [sys.executable, "-c", code]
    run = subprocess.Popen(command, stdout=subprocess.PIPE, process_group=0)
    assert run.stdout is not None
    with run.stdout as stdout:
        pid = int(stdout.readline())
    assert run.wait(20) == -signal.SIGKILL
    assert gone([pid])


def test_an_interrupt_at_any_time_shows_no_traceback(here: Path) -> None:
    """From the first import of the command line on; before it the interpreter says so itself."""
    watch = "import sys; sys.argv[0] = '-m'; sys.orig_argv[1:] = ['-m', 'gcxform.cli', 'x']; "
    code = (
        "import signal, gcxform.cli; "
        "print(signal.getsignal(signal.SIGINT) == signal.SIG_DFL, flush=True); "
        "signal.raise_signal(signal.SIGINT)"
    )
    found = subprocess.run([sys.executable, "-c", watch + code], check=False, capture_output=True)
    assert (found.returncode, found.stdout, found.stderr) == (-signal.SIGINT, b"True\n", b"")
    plain = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True)
    assert b"KeyboardInterrupt" in plain.stderr
