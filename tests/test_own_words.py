"""Codes that take axis words for themselves, in every frame, through every pass that changes words.

LinuxCNC executes the source and the output: every move ends at the same place of the machine and
every move is of the same kind, or the program is refused by name. Nothing here is a failed proof.
"""

from __future__ import annotations

import itertools
import os
from dataclasses import replace
from pathlib import Path

import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram

import gcxform as gx
from gcxform.machine.machine import Machine

FRAMES = {
    "plain": "",
    "G92": "G92 X1 Y-1 Z2",
    "G52": "G52 X1 Y2 Z3",
    "G55": "G10 L2 P2 X5 Y6 Z7\nG55",
    "one axis": "G92 X3",
    "L20": "G10 L20 P1 X3 Y4 Z5",
    "turned": "G10 L2 P1 R30",
    "length": "G43.1 Z1.5",
}
CODES = {
    "G53": "G53 G0 X5 Y5 Z5",
    "G53 cutting": "G53 G1 X5 Y5",
    "G28": "G28",
    "G28 by a point": "G28 Z6",
    "G28 in G91": "G91 G28 Z0\nG90",
    "G30": "G30 X2 Y2 Z4",
    "G28.1": "G28.1\nG0 X9 Y9 Z9\nG28 X1",
    "G92": "G92 X0 Y0",
    "G92 again": "G92 Z0\nG0 Z3\nG92.1",
    "G92.2": "G92 Y5\nG92.2\nG0 Y1\nG92.3",
    "G10 L2": "G10 L2 P1 X1",
    "G10 L20": "G10 L20 P1 Y2",
    "G38.2": "G38.2 Z-2",
    "G38.3": "G38.3 X-2 Y3",
    "G38.5": "G38.5 Y12",
    "G33": "S100 M3\nG33 Z-2 K1",
    "G33.1": "S100 M3\nG33.1 Z-2 K1",
    "G5": "G5 I0 J3 P0 Q-3 X10 Y10",
    "G5.1": "G5.1 X10 Y10 I2 J5",
    "G81": "G81 X1 Y2 Z-2 R1\nX4\nG80",
    "G83": "G98 G83 X1 Z-2 R1 Q1\nG80",
    "G84": "S100 M3\nG84 X1 Y1 Z-2 R1\nG80",
    "G85": "G85 X1 Z-2 R1\nG91 X2 L2\nG80 G90",
    "G2": "G2 X4 Y4 I2 J2",
    "G2 by R": "G2 X6 Y6 R5",
    "G18 G3": "G18 G3 X6 Z6 I1.5 K1.5\nG17",
    "G43.1": "G43.1 Z2\nG0 Z7",
    "G41.1": "G41.1 D.5 G1 X5 Y5\nX9\nY9\nG40 X0",
}
CHAINS = (
    "offsets",
    "absolute",
    "metric",
    "plane",
    "cycles | offsets",
    "offsets | absolute | metric",
)
BEFORE = ("G90", "G91")
UNITS = ("G21", "G20")
CLOSE = 2e-4  # units of the program: what the prints of both add up to, and the rounding of 5
ALL = tuple(itertools.product(CODES, FRAMES, CHAINS, BEFORE, UNITS))
EVERY = 1 if os.environ.get("HYPOTHESIS_PROFILE") == "long" else 61  # prime to all counts
START = dict.fromkeys("XYZ", 0.0)
OFFSETS = {"G54": START, "G55": START}
MACHINE = Machine(file=Path("m.toml"), homes={"G28": START, "G30": START}, work_offsets=OFFSETS)

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def program(code: str, frame: str, distance: str, unit: str) -> bytes:
    body = CODES[code]
    lines = [f"{unit} G90 G17 G94 G54 F100", "G0 X0 Y0 Z0", "G0 X3 Y3 Z3", FRAMES[frame], distance]
    lines += [body, distance, "G0 X1 Y1 Z1", "G1 X2 Y3", "M2", ""]
    return "\n".join(line for line in lines if line).encode() + b"\n"


def transformed(source: bytes, chain: str) -> bytes | str:
    """Return the output, or the code of the refusal."""
    kind = gx.Pipeline.parse(chain, "linuxcnc")
    numbers = replace(kind.target.numbers, mm=5, inch=6)
    made = replace(kind, machine=MACHINE, numbers=numbers)
    try:
        return made.run(source).text
    except gx.InputError as error:
        return error.diagnostics[0].code


def test_own_words_lead_to_the_same_place() -> None:
    cases = ALL[::EVERY]
    sources = [program(code, frame, distance, unit) for code, frame, _, distance, unit in cases]
    made = [transformed(source, case[2]) for source, case in zip(sources, cases, strict=True)]
    kept = [k for k, text in enumerate(made) if isinstance(text, bytes)]
    wanted = rs274.run_many([sources[k] for k in kept])
    found = rs274.run_many([text for text in made if isinstance(text, bytes)])
    for k, one, other in zip(kept, wanted, found, strict=True):
        said = f"{cases[k]}\n{sources[k].decode()}\n{made[k]!r}"
        if isinstance(one, CanonProgram):
            assert isinstance(other, CanonProgram), f"{other}\n{said}"
            problem = difference(one, other)
            assert not problem, f"{problem}\n{said}"
    assert len(kept) > len(cases) / 2


def difference(one: CanonProgram, other: CanonProgram) -> str:
    """Say how two programs move differently on the machine; nothing if they do not."""
    here, there = moving(one), moving(other)
    if len(here) != len(there):
        return f"{len(here)} and {len(there)} moves"
    for a, b in zip(here, there, strict=True):
        near = CLOSE * max(a.unit, b.unit)
        gaps = [abs(p[x] - q[x]) for p, q in zip(a.machine, b.machine, strict=True) for x in "XYZ"]
        if (a.kind, a.turns) != (b.kind, b.turns) or max(gaps) > near:
            return f"{a}\n{b}"
    return ""


def moving(program: CanonProgram) -> list[CanonMove]:
    """Return the moves that move anything, beyond what the prints of both their ends round."""

    def goes(move: CanonMove) -> bool:
        start, end = move.machine[:2]
        return any(abs(start[axis] - end[axis]) > CLOSE * move.unit for axis in "XYZ")

    return [m for m in program.moves if m.centre is not None or goes(m)]
