"""LinuxCNC's stand-alone interpreter as an oracle: programs in, canonical motions out.

`rs274 -g -t TOOLS -v VARIABLES FILE OUT` writes one canon call a line, numbers with four decimals
in the units in force, to OUT, and messages to stderr. It starts at 0 on all axes, in millimetres,
G17 G90 G91.1 G94, with no motion mode, all work offsets zero and block delete off. Tool n has a
diameter of n mm (the table is in inches). It stops at
the first refusal. A comment `(gcx k)` put behind line k comes back as a canon call, so each
call is known to belong to a line.

It maps the file `.tool.mmap` of the home directory: two processes which share it crash each other
(SIGBUS), so each one gets a home of its own.

`run_many` puts many plain programs into one file with a full reset between them; where it stops,
that program is the refused one and the rest goes into the next file.

What it answered is kept by digest in the folder `.rs274` beside this file, so that it is asked
once; whoever doubts an answer deletes the folder.
"""

import hashlib
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import zlib
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from types import MappingProxyType

from oracles.canon import CALL, CanonMove, CanonProgram, Reader

__all__ = ["CanonMove", "CanonProgram", "Rejected", "available", "run", "run_many"]

MARK = re.compile(r'"gcx (\d+) (\d+)"')
NOISE = ("executing", "link (updating")
TIMEOUT = 10  # seconds of a processor: on a machine that is busy all take long, and end
WAITED = 60.0  # seconds, for one that sleeps
LIMITED = ["sh", "-c", f'ulimit -t {TIMEOUT} && exec "$@"', "sh"]
TOO_LONG = (-signal.SIGXCPU, -signal.SIGKILL)
KEPT = Path(__file__).with_name(".rs274")
KEEPS = os.environ.get("HYPOTHESIS_PROFILE", "ci") == "ci"  # other profiles do not ask it again
BATCH = 250  # programs in one file
ZERO = b"X0 Y0 Z0 A0 B0 C0"
RESET = (
    b"G80 G21 G17 G90 G91.1 G94 G40 G49 G8 G92.1 G99 M5 M9\nS0 T0\nM61 Q0\n"
    + b"".join(b"G10 L2 P%d R0 %s\n" % (n, ZERO) for n in range(1, 10))
    + b"G54\nG0 %s\nG28.1\nG30.1\n" % ZERO
    + b"G82 X0 Z0 R0 P0 F1\nG80 G94\n"  # a dwell of a cycle would stay
)
PLAIN_G = {0, 1, 2, 3, 4, 17, 18, 19, 20, 21, 40, 49, 80, 90, 91, 90.1, 91.1, 93, 94, 95}
PLAIN_G |= {*range(54, 60), 59.1, 59.2, 59.3, 52, 53, 92, 92.1, 92.2, 92.3}
PLAIN_G |= {7, 8, 10, 28, 28.1, 30, 30.1, 43, 43.1, 43.2}
PLAIN_G |= {73, 74, 98, 99, *range(81, 90)}
PLAIN_G |= {33, 33.1, 38.2, 38.3, 38.4, 38.5}
PLAIN_G |= {41, 42, 41.1, 42.1}  # where the last one is G40
PLAIN_M = {0, 1, 3, 4, 5, 6, 7, 8, 9, 60, 61}
BLOCK = re.compile(r"/?(N\d+)?(?:[A-DF-MP-TXYZ][+-]?[\d.]+)*")
END = re.compile(rb"[ \t]*([nN]\d+)?[ \t]*[mM]0*2[ \t]*")  # not taken apart by a comment
WORD = re.compile(r"([A-Z])([+-]?[\d.]+)")


class Rejected(Exception):
    """LinuxCNC refused the program; `line` is 1-based, `partial` is what it did before."""

    def __init__(self, message: str, line: int, partial: CanonProgram) -> None:
        super().__init__(f"line {line}: {message}")
        self.message = message
        self.line = line
        self.partial = partial


@dataclass
class _Output:
    """What one process said: canon calls by program and line, and the message if it stopped."""

    calls: list[list[tuple[int, str, str]]] = field(default_factory=list)
    line: int = 0
    message: str = ""


def available() -> bool:
    """Tell whether `rs274` is installed."""
    return shutil.which("rs274") is not None


def run(program: bytes, files: Mapping[str, bytes] | None = None) -> CanonProgram:
    """Interpret one program in a process of its own, beside files; raise `Rejected`."""
    marked = _marked(program, 0)
    output = _beside(marked, files) if files else _execute(marked)
    reader = Reader()
    for line, name, arguments in output.calls[0] if output.calls else []:
        reader.call(line, name, arguments)
    if output.message:
        raise Rejected(output.message, output.line, reader.program)
    return reader.program


def run_many(programs: Iterable[bytes]) -> list[CanonProgram | Rejected]:
    """Interpret many programs, as if each by itself; results in order, refusals as values."""
    sources = [_bare(program) for program in programs]
    results: list[CanonProgram | Rejected | None] = [None] * len(sources)
    plain = [i for i, source in enumerate(sources) if _is_plain(source)]
    others = sorted(set(range(len(sources))) - set(plain))
    jobs = [plain[i : i + BATCH] for i in range(0, len(plain), BATCH)] + [[i] for i in others]

    def work(job: list[int]) -> None:
        alone = len(job) == 1
        answers = [_caught(sources[job[0]])] if alone else _batch([sources[i] for i in job])
        for index, answer in zip(job, answers, strict=True):
            results[index] = answer

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(work, jobs))
    return [result for result in results if result is not None]


def taken(programs: Iterable[bytes]) -> list[bytes]:
    """Return the programs that the interpreter does not refuse."""
    listed = list(programs)
    found = zip(listed, run_many(listed), strict=True)
    return [program for program, canon in found if isinstance(canon, CanonProgram)]


def _caught(program: bytes) -> CanonProgram | Rejected:
    try:
        return run(program)
    except Rejected as refusal:
        return refusal


def _batch(programs: list[bytes]) -> list[CanonProgram | Rejected]:
    """Interpret plain programs in as few processes as their refusals allow."""
    answers: list[CanonProgram | Rejected] = []
    while len(answers) < len(programs):
        rest = programs[len(answers) :]
        output = _execute(b"".join(_reset(p, i) for i, p in enumerate(rest)) + b"M2\n")
        if output.calls and (output.message or len(output.calls) == len(rest)):
            answers += _answers(output, rest)
        else:  # it hung, or stopped without a word
            answers += map(_caught, rest)
    return answers


def _answers(output: _Output, programs: list[bytes]) -> Iterator[CanonProgram | Rejected]:
    """Yield the answers of one process; the last one may be a refusal."""
    for index, calls in enumerate(output.calls[: len(programs)]):
        reader = Reader()
        for line, name, arguments in calls:
            reader.call(line, name, arguments)
        if output.message and index == len(output.calls) - 1:
            yield Rejected(output.message, output.line, reader.program)
            return
        end = _end_line(programs[index])
        reader.call(end + 1, "PROGRAM_END", "")
        yield reader.program


def _execute(source: bytes) -> _Output:
    """Run one file, or take what LinuxCNC answered when it was asked the same before."""
    at = _kept_at(source)
    if at.is_file():
        message, _, text = zlib.decompress(at.read_bytes()).decode("latin-1").partition("\n")
        return _collect(text, message)
    try:
        text, message = _asked(source)
    except subprocess.TimeoutExpired:
        return _Output([], 0, "it did not end")
    if KEEPS:
        _keep(at, text, message)
    return _collect(text, message)


def _beside(source: bytes, files: Mapping[str, bytes]) -> _Output:
    """Run one file in a folder of others; what is asked so is not kept."""
    text, message = _asked(source, files)
    return _collect(text, message)


def _asked(source: bytes, files: Mapping[str, bytes] = MappingProxyType({})) -> tuple[str, str]:
    """Run one file; return canon calls, tagged with the line whose marker comes next, and why not.

    Raises subprocess.TimeoutExpired.
    """
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        for name, content in {**files, "in.ngc": source}.items():
            (at / name).write_bytes(content)
        (at / "tools").write_text("".join(map(_tool_line, range(1, 100))))
        command = [*LIMITED, "rs274", "-g", "-t", "tools", "-v", "var", "in.ngc", "out"]
        home = os.environ | {"HOME": folder}
        done = subprocess.run(command, cwd=at, env=home, capture_output=True, timeout=WAITED)
        text = (at / "out").read_text("latin-1") if (at / "out").exists() else ""
    if done.returncode in TOO_LONG:
        raise subprocess.TimeoutExpired(command, TIMEOUT)
    said = [s for s in done.stderr.decode("latin-1").splitlines() if not s.startswith(NOISE)]
    if done.returncode and not said:
        raise RuntimeError(f"rs274 ended with {done.returncode} and no message")
    return text, said[0] if done.returncode else ""


@cache
def _version() -> bytes:
    """Return what another installation of LinuxCNC, or other tools, would have otherwise."""
    program = Path(shutil.which("rs274") or "").resolve()
    tools = "".join(map(_tool_line, range(1, 100)))
    return f"{program.stat().st_mtime_ns} {program.stat().st_size} {tools}".encode()


def _kept_at(source: bytes) -> Path:
    """Return where the answer to a file is kept, or would be."""
    return KEPT / hashlib.sha256(_version() + b"\0" + source).hexdigest()


def _keep(at: Path, text: str, message: str) -> None:
    """Keep an answer; many processes may do so at once."""
    KEPT.mkdir(exist_ok=True)
    new = at.with_name(f"{at.name}.{os.getpid()}.{threading.get_ident()}")
    new.write_bytes(zlib.compress(f"{message}\n{text}".encode("latin-1"), 1))
    new.replace(at)


def tool(number: int) -> tuple[float, float, float]:
    """Return the vector of a tool of the table, X, Y and Z in inches."""
    x = number / 100 if number % 3 == 0 else 0.0
    y = -number / 50 if number % 4 == 0 else 0.0
    return x, y, number / 20


def _tool_line(number: int) -> str:
    x, y, z = tool(number)
    return f"T{number} P{number} X{x} Y{y} Z{z} D{number / 25.4:.12f}\n"


def _collect(text: str, message: str) -> _Output:
    """Sort canon calls by program and line. A marker with line 0 opens a program."""
    output, pending, line = _Output(message=message), [], 0
    for call in filter(None, map(CALL.match, text.splitlines())):
        name, arguments = call.groups()
        mark = MARK.fullmatch(arguments) if name == "COMMENT" else None
        if mark is None:
            pending.append((name, arguments))
            continue
        line = int(mark[2])
        if line:
            output.calls[-1] += [(line, *item) for item in pending]
        else:
            output.calls.append([])
        pending.clear()
    output.line = line + (not message.startswith("File ended"))
    if output.calls:
        output.calls[-1] += [(line + 1, *item) for item in pending]
    return output


def _marked(program: bytes, index: int) -> bytes:
    """Put a marker behind every line; a percent sign must stay the first thing in the file."""
    lines = program.split(b"\n")
    if not lines[-1]:
        lines.pop()
    first = next((i for i, line in enumerate(lines) if line.strip()), 0)
    opening = lines[: first + 1] if lines and lines[first].strip() == b"%" else []
    marked = [b"(gcx %d %d)" % (index, i) for i in range(len(opening) + 1)]
    for number, line in enumerate(lines[len(opening) :], start=len(opening) + 1):
        marked += [line, b"(gcx %d %d)" % (index, number)]
    return b"\n".join([*opening, *marked]) + b"\n"


def _reset(program: bytes, index: int) -> bytes:
    """Return a program without its end, behind a reset of everything it may have set."""
    lines = program.split(b"\n")[: _end_line(program)]
    return RESET + _marked(b"\n".join([*lines, b""]), index)


def _end_line(program: bytes) -> int:
    """Return the index of the line with M2, the last one that is not blank."""
    lines = program.split(b"\n")
    return max(i for i, line in enumerate(lines) if line.strip())


def _bare(program: bytes) -> bytes:
    """Return a program without percent signs, if they are its first and its last line."""
    lines = program.split(b"\n")
    at = [k for k, line in enumerate(lines) if line.strip()]
    if len(at) > 2 and lines[at[0]].strip() == lines[at[-1]].strip() == b"%":
        ended = END.fullmatch(lines[at[-2]])
        lines[at[0]] = lines[at[-1]] = b""
        return b"\n".join(lines) if ended else program
    return program


def _is_plain(program: bytes) -> bool:
    """Tell whether a program can leave nothing behind that the reset does not undo."""
    text = re.sub(rb"\([^()\n]*\)", b"", program).decode("latin-1").upper()
    lines = [re.sub(r"[ \t\r]|;.*", "", line) for line in text.split("\n")]
    while lines and not lines[-1]:
        lines.pop()
    sides = re.findall(r"G\+?0*4([0-2])(?![0-9])", "\n".join(lines))
    if sides and sides[-1] != "0":
        return False
    if not lines or not END.fullmatch(program.rstrip().rpartition(b"\n")[2]) or "GCX" in text:
        return False
    return all(_is_plain_block(line) for line in lines[:-1])


def _is_plain_block(line: str) -> bool:
    if not BLOCK.fullmatch(line):
        return False
    for letter, number in WORD.findall(line):
        if letter in "GM":
            code = float(number) if re.fullmatch(r"\+?(\d+\.?\d*|\.\d+)", number) else -1
            if code not in (PLAIN_G if letter == "G" else PLAIN_M):
                return False
    return True
