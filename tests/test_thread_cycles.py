"""Threads that are cut in passes (G76): their ends are LinuxCNC's, and so is what is refused."""

from __future__ import annotations

import pytest
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram

import gcxform as gx

HEAD = "G21 G90 G94 F100 G18\nM3 S100\nG0 X10 Y1 Z5\n"
WORDS = "Z-20 P1 I-1 J.3 K1.5"
TAKEN = (
    f"G76 {WORDS}",
    f"G76 {WORDS} R1.5 Q29.5 H2 E.5 L2 F20 M8",
    f"G91 G76 {WORDS}",
    "G17 G76 Z-20 P1 I1 J.3 K1.5 L0",
    f"G7\nG76 {WORDS}\nG8",
    f"G10 L2 P1 X1 Z3\nG76 {WORDS}",
    f"G76 {WORDS}\n{WORDS}",
    "G20 G76 Z-1 P.05 I-.1 J.01 K.05",
    f"G93 G76 {WORDS}\nG94 F100",
)
REFUSED_BY_BOTH = (
    "G76 P1 I-1 J.3 K1.5",
    "G76 Z-20 I-1 J.3 K1.5",
    "G76 Z-20 P-1 I-1 J.3 K1.5",
    "G76 Z-20 P1 J.3 K1.5",
    "G76 Z-20 P1 I0 J.3 K1.5",
    "G76 Z-20 P1 I-1 K1.5",
    "G76 Z-20 P1 I-1 J-.3 K1.5",
    "G76 Z-20 P1 I-1 J.3 K.1",
    f"G76 {WORDS} A3",
    f"M5\nG76 {WORDS}",
    f"G76 {WORDS}\nX20",
    f"G42.1 D1\nG76 {WORDS}",
)
REFUSED_HERE = (
    f"G76 {WORDS} X3",
    f"G76 {WORDS} R.5",
    f"G76 {WORDS} Q90",
    f"G76 {WORDS} L5",
    f"G10 L2 P1 R30\nG0 X1 Y1 Z1\nG76 {WORDS}",
)
"""The control takes these, and does what is not told here, or what its manual forbids."""


def program(text: str) -> bytes:
    return f"{HEAD}{text}\nG91 G1 X1 Z1\nM2\n".encode()


def refused(text: str) -> bool:
    try:
        toolpaths.read(program(text))
    except gx.InputError as error:
        return {each.code for each in error.diagnostics} <= {"GX216"}
    return False


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_a_thread_ends_and_is_deepest_where_linuxcnc_says() -> None:
    for text, canon in zip(TAKEN, rs274.run_many(map(program, TAKEN)), strict=True):
        assert isinstance(canon, CanonProgram), text
        moves = [*toolpaths.moves_of(toolpaths.read(program(text)))]
        for mine, theirs in zip(moves[-2:], canon.moves[-2:], strict=True):
            for axis in "XYZ":
                near = pytest.approx(theirs.end[axis], abs=1e-4 * (theirs.unit or 1.0))
                assert mine.end[axis] == near, text
        deep = min(move.end["X"] for move in moves), max(move.end["X"] for move in moves[:-1])
        outside = "I-" in text
        xs = [move.end["X"] for move in canon.moves[:-1] if move.end["X"] is not None]
        near = pytest.approx(min(xs) if outside else max(xs), abs=1e-3)
        assert (deep[0] if outside else deep[1]) == near, text


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_what_linuxcnc_refuses_is_refused() -> None:
    assert not rs274.taken(map(program, REFUSED_BY_BOTH))
    assert [text for text in REFUSED_BY_BOTH if not refused(text)] == []


@pytest.mark.parametrize("text", REFUSED_HERE)
def test_what_is_not_certain_is_refused(text: str) -> None:
    assert refused(text)
