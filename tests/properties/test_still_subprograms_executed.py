"""What stays under compensation goes, wherever it is called, to the same points of the machine.

LinuxCNC's interpreter executes drawn subprograms from two callers that stand elsewhere, in other
coordinates. An axis that one moves which is kept stands at one place behind it, and gets there in a
rapid; each other stays where its caller has left it.
"""

from __future__ import annotations

import random

import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from seeds_kit import shares

from gcxform.flow.subprogram_file import Still
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")

CALLERS = (
    "G21 G90 G17 G54\nG0 X1 Y2 Z3\n",
    "G21 G90 G17 G55\nG10 L2 P2 X10 Y20 Z30\nG0 X50 Y60 Z70\nG92 X7 Z8\nG1 Y61 F100\n",
)
LINES = (
    "M5",
    "G54",
    "G4 P0.1",
    "G90",
    "G91",
    "G0",
    "#1=3",
    "G53 G0 Z4",
    "G0 G53 X5 Y#1",
    "G53 G0 X[#1+1]",
    "G28",
    "G30",
    "G91 G28 Z0",
    "G28 G91 X0 Y0",
    "G28 Z0",
    "G91 G28 Z1",
    "G53 G1 X2 F100",
    "G53 X3",
    "X9",
    "G0 Z9",
    "G92.1",
    "G92 X0",
    "G10 L20 P1 Z0",
    "G49",
    "G43.1 Z2",
    "#1=#5420",
    "o1 if [#1 GT 1]\nG53 G0 Z1\no1 endif",
    "o2 repeat [2]\nG91 G28 Y0\no2 endrepeat",
)
AXES = "XYZ"


def body_of(seed: int) -> str:
    """Return a body; that of the first seeds has each line alone."""
    rng = random.Random(seed)
    if seed < len(LINES):
        return LINES[seed]
    return "\n".join(rng.sample(LINES, rng.randint(2, 4)))


def behind(canon: CanonProgram, caller: str) -> tuple[list[CanonMove], dict[str, float]]:
    """Return the moves behind those of a caller, and where it has left the axes in the machine."""
    own = sum(line.split()[0] in ("G0", "G1") for line in caller.splitlines())
    return canon.moves[own:], canon.moves[own - 1].machine[1]


@shares(200, 50)
def test_the_same_points_of_the_machine(seeds: range) -> None:
    """Every body that is kept is executed; those that LinuxCNC refuses say nothing."""
    still = Still(default_registry().dialect("linuxcnc"), rapids=True)
    bodies = {seed: f"o<a> sub\n{body_of(seed)}\no<a> endsub\n" for seed in seeds}
    kept = [body for body in bodies.values() if _stays(still, body)]
    programs = [f"{body}{caller}o<a> call\nM2\n" for body in kept for caller in CALLERS]
    found = rs274.run_many([each.encode() for each in programs])
    pairs = [pair for pair in zip(found[::2], found[1::2], strict=True)]
    done = [pair for pair in pairs if all(isinstance(each, CanonProgram) for each in pair)]
    assert done
    for pair in done:
        (one, from_one), (other, from_other) = map(behind, pair, CALLERS)
        assert {move.kind for move in (*one, *other)} <= {"RAPID"}
        assert len(one) == len(other)
        for move, twin in zip(one, other, strict=True):
            at, there = move.machine[1], twin.machine[1]
            for axis in AXES:
                stayed = (at[axis], there[axis]) == (from_one[axis], from_other[axis])
                assert stayed or at[axis] == pytest.approx(there[axis], abs=1e-3), (axis, move)


def _stays(still: Still, body: str) -> bool:
    return still.but_for(Source.of_bytes(f"{body}M2\n".encode())) is not None
