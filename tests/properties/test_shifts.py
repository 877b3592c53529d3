"""LinuxCNC as the judge of programs that shift and turn coordinates: read, refused, written."""

from __future__ import annotations

import random
import re
from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import replace

import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from oracles.toolpaths import HOMES, OFFSETS, START, difference, read
from seeds_kit import DRAWN, shares, some

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source
from gcxform.testing.generate import Options
from gcxform.testing.shifts import ShiftingBuilder

INCH = 25.4
COUNT = 20 * DRAWN
CHORD = 0.02  # mm
CLOSE = 0.012  # mm; what is printed is rounded in inches, and read back from that

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def vector(number: int) -> tuple[float, float, float]:
    """Return the vector of a tool, mm."""
    x, y, z = rs274.tool(number)
    return x * INCH, y * INCH, z * INCH


TOOLS = {
    number: Tool(x=vector(number)[0], y=vector(number)[1], length=vector(number)[2])
    for number in range(1, 100)
}
READING = Reading(start=START, work_offsets=OFFSETS, homes=HOMES, tools=TOOLS)


def drawn(seed: int, blocks: int = 30) -> bytes:
    options = Options(max_blocks=blocks)
    return ShiftingBuilder(random.Random(seed).randint, options, vector).build()


# --- reading ---


@shares(COUNT, 500)
def test_gcxform_reads_shifts_as_linuxcnc_does(seeds: range) -> None:
    sources = [drawn(seed) for seed in seeds]
    for source, canon in zip(sources, rs274.run_many(sources), strict=True):
        assert isinstance(canon, CanonProgram), (canon, source.decode("latin-1"))
        problem = difference(read(source, TOOLS), canon)
        assert problem == "", f"{problem}\n{source.decode('latin-1')}"


def test_the_programs_shift() -> None:
    """What the test above looks at does occur, each code many times."""
    text = b"\n".join(drawn(seed) for seed in range(300)).decode("latin-1").upper()
    count = Counter(re.findall(r"G0*(\d+(?:\.\d)?)", re.sub(r"[ \t]", "", text)))
    for code in (7, 10, 28, 28.1, 30, 30.1, 43, 43.1, 43.2, 49, 52, 53, 55, 59.3, 92, 92.1, 92.3):
        assert count[f"{code}"] > 10, code


REFUSED = (
    "G91 G53 G0 X1",
    "G80\nG53 X1",
    "G53 G2 X1 R5 F10",
    "G92",
    "G52",
    "G0 G92 X1",
    "G52 X1 G1",
    "G10 L2 P10 X1",
    "G10 L2 P-1 X1",
    "G10 L2 X1",
    "G10 P1 X1",
    "G10 L3 P1 X1",
    "G10 L20 P10 X1",
    "G10 L20 P1 R5 X1",
    "G10 L2 P1 X1 I5",
    "G10 L2 P1 X1 G0",
    "G43 H500",
    "G43 H-1",
    "G43.2",
    "G49\nG43.2 H1 X1",
    "G43.1 H5 Z1",
    "G54 P2",
    "G54.1 P1",
    "G55 G56",
    "G59.4",
    "G28 G0 X1",
    "G28.1 G28 X1",
    "G92 G52 X1",
    "G7 G8",
    "G43 G49",
    "G68 X0 Y0 R30",
    "G51 X0",
    "G16",
    "G80\nG92.1 X5",
    "G80\nG55 X5",
    "G49\nG41.1 D5 G1 X200 F100\nG92 X1",
)


@pytest.mark.parametrize("block", REFUSED)
def test_what_linuxcnc_refuses_is_refused(block: str) -> None:
    """Wherever a program stands when the block comes."""
    sources = []
    for seed in some(12):
        *lines, end = drawn(seed, 12).decode("latin-1").rstrip("\r\n%").splitlines()
        sources.append("\n".join([*lines, "G90 G49", block, end, ""]).replace("%\n", "").encode())
    for source, canon in zip(sources, rs274.run_many(sources), strict=True):
        assert not isinstance(canon, CanonProgram), source.decode("latin-1")
        with pytest.raises(gx.InputError):
            read(source, TOOLS)


# --- writing ---

CHAINS = (
    "offsets",
    "offsets | absolute",
    "absolute | offsets",
    "metric | offsets",
    "offsets | metric | absolute",
    f"offsets | segment chord-error={CHORD}mm",
    f"offsets | segment chord-error={CHORD}mm max-length=20mm | absolute",
    f"segment chord-error={CHORD}mm",
    "absolute",
    "metric",
)
GONE = frozenset({"G52", "G92", "G10", "G7", "G55", "G59.3"})


def written(chain: str, source: bytes, window: int) -> tuple[bytes, list[int]]:
    """Return what a chain makes of a program read in small windows, and the line map."""
    pipeline = replace(gx.Pipeline.parse(chain, "linuxcnc"), reading=READING)
    parts: list[bytes] = []
    lines: list[int] = []
    run = Run(pipeline, Source.of_bytes(source), "full")
    run.over(Output(parts.append, lines), lambda size: None, window)
    return b"".join(parts), lines


@shares(COUNT // 4, 125)
def test_the_machine_goes_where_it_went(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    """Machine coordinates after each line are the same, as LinuxCNC tells its offsets."""
    jobs, refused = [], 0
    for seed in seeds:
        choose = random.Random(seed)
        monkeypatch.setattr(
            "gcxform.system.worker.LINUX", seed % 10 == 0
        )  # few are read by processes
        chain, source = choose.choice(CHAINS), drawn(seed, 20)
        try:
            text, lines = written(chain, source, choose.choice((30, 60, 100, 1 << 20)))
        except gx.VerificationError as error:
            pytest.fail(f"{chain}: {error}\n{source.decode('latin-1')}")
        except gx.InputError:
            refused += 1
            continue
        jobs.append((chain, source, text, lines))
    before = rs274.run_many([job[1] for job in jobs])
    after = rs274.run_many([job[2] for job in jobs])
    for (chain, source, text, lines), old, new in zip(jobs, before, after, strict=True):
        context = f"{chain}\n{source.decode('latin-1')}\n{text.decode('latin-1')}"
        assert isinstance(old, CanonProgram), context
        assert isinstance(new, CanonProgram), f"{new}\n{context}"
        close = CLOSE + (CHORD if "segment" in chain else 0.0)
        assert gone_elsewhere(old, new, lines, close) == "", context
        if "offsets" in chain:
            codes = {event.what for event in read(text, TOOLS).events}
            assert not codes & GONE, context
    assert len(jobs) > 3 * refused


def gone_elsewhere(old: CanonProgram, new: CanonProgram, lines: list[int], close: float) -> str:
    """Say after which line of the source the machine stands elsewhere."""
    places = places_by_line(old, lambda move: move.line)
    others = places_by_line(new, lambda move: lines[move.line - 1] + 1)
    place = other = dict.fromkeys("XYZABC", 0.0)
    for line in sorted(places | others):
        place, other = places.get(line, place), others.get(line, other)
        for axis, value in place.items():
            if not abs(value - other[axis]) <= close:
                return f"line {line}: {axis} is at {other[axis]:.4f} instead of {value:.4f}"
    return ""


def places_by_line(
    program: CanonProgram, line_of: Callable[[CanonMove], int]
) -> dict[int, dict[str, float]]:
    """Return where the machine stands after each line that moves."""
    found: dict[int, dict[str, float]] = defaultdict(dict)
    for move in program.moves:
        found[line_of(move)] = move.machine[1]
    return found
