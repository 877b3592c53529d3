"""Splines of weights and knots (G5.2, G5.3): what LinuxCNC refuses is refused, and ends agree."""

from __future__ import annotations

import pytest
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram

import gcxform as gx

HEAD = "G21 G90 G94 F100 G0 X0 Y0\n"
THREE = "X2 Y2 P1\nX3 Y0 P1\nG5.3\n"
TAKEN = (
    f"G5.2 X0 Y1 P1\n{THREE}",
    f"G5.2 P2 L4\nX0 Y1 P1\n{THREE}",
    f"G5.2 X0 Y1 P.5 F30\n(c)\n\nN7 G5.2 X5 Y5 P1\n{THREE}",
    f"G7\nG5.2 X0 Y1 P1\n{THREE}G8\n",
    f"G10 L2 P1 X1 R30\nG0 X0 Y0\nG5.2 X0 Y1 P1\n{THREE}",
    f"G20 G5.2 X0 Y1 P1\n{THREE}G5.2 X9 Y1 P1\n{THREE}",
)
REFUSED_BY_BOTH = (
    f"G5.2 X0 P1\n{THREE}",
    f"G5.2 X0 Y1 P1 L5\n{THREE}",
    f"G5.2 X0 Y1 P1 I1\n{THREE}",
    f"G5.2 X0 Y1 P1\n{THREE}X9\n",
    "G5.2 X0 Y1 P1\nG5.3\n",
    "G5.2 X0 Y1 P1\nX1 Y1 P1\nG0 X2\nG5.3\n",
    "G5.3\n",
)
REFUSED_HERE = (
    f"G5.2 X0 Y1 P0\n{THREE}",
    f"G5.2 X0 Y1\n{THREE}",
    f"G91 G5.2 X0 Y1 P1\n{THREE}",
    f"G18 G5.2 X0 Y1 P1\n{THREE}",
    f"G93 G5.2 X0 Y1 P1 F2\n{THREE}",
    f"G5.2 X0 Y1 P1 Z3\n{THREE}",
    f"G5.2 X0 Y1 P1\nG4 P1\n{THREE}",
    f"G5.2 X0 Y1 P1\nM8\n{THREE}",
    f"G5.2 X0 Y1 P1\nF20\n{THREE}",
    f"G5.2 X0 Y1 P1\nX5 Y5 P1 L4\n{THREE}",
    f"G5.2 P-1\nX0 Y1 P1\n{THREE}",
    f"G5.2 X0 Y1 P1 L2.5\n{THREE}",
    "G5.2 X0 Y1 P1\nX1 Y1 P1\n",
)
"""The control takes these: some of it is lost, or is not what it looks like."""


def program(text: str) -> bytes:
    return f"{HEAD}{text}G91 G1 X1 Y1\nM2\n".encode()


def refused(text: str) -> bool:
    try:
        toolpaths.read(program(text))
    except gx.InputError as error:
        return {each.code for each in error.diagnostics} <= {"GX203", "GX204", "GX209", "GX306"}
    return False


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_a_curve_ends_where_linuxcnc_says() -> None:
    for text, canon in zip(TAKEN, rs274.run_many(map(program, TAKEN)), strict=True):
        assert isinstance(canon, CanonProgram), text
        path = toolpaths.read(program(text))
        mine, theirs = [*toolpaths.moves_of(path)][-1], canon.moves[-1]
        unit = theirs.unit or 1.0
        for axis in "XY":
            assert mine.end[axis] == pytest.approx(theirs.end[axis], abs=1e-4 * unit), text


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_what_linuxcnc_refuses_is_refused() -> None:
    assert not rs274.taken(map(program, REFUSED_BY_BOTH))
    assert [text for text in REFUSED_BY_BOTH if not refused(text)] == []


@pytest.mark.parametrize("text", REFUSED_HERE)
def test_what_is_not_certain_is_refused(text: str) -> None:
    assert refused(text)


def test_a_spline_is_compared_as_the_curve_it_is() -> None:
    """The legs between its control points are as far from it as the polygon is."""
    program = f"{HEAD}G1 F100\nG5.2 X0 Y1 P1\n{THREE}M2\n".encode()
    made = gx.Pipeline.parse("segment chord-error=1um", "linuxcnc").run(program).text
    one, lines = gx.read(program, "linuxcnc"), gx.read(made, "linuxcnc")
    assert gx.compare(one, lines).deviation < 0.002
    moved = made.replace(b"X3. Y0.", b"X3. Y0.05")
    assert moved != made
    assert gx.compare(one, gx.read(moved, "linuxcnc")).deviation > 0.02
