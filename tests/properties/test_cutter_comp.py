"""`cutter-comp` against LinuxCNC, which compensates the cutter itself: the same canonical moves."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from properties.contours import contour
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.machine.machine import Machine, Tool
from gcxform.plugin.registry import default_registry

COUNT = 4 * DRAWN
CLOSE = 1.1e-4  # mm: twice the rounding of the print
REFUSED_BY_US = (
    "turns back on itself",  # LinuxCNC takes the inside or the outside of so sharp a corner
    "cannot reach",  # it looks at this only where a corner follows that is more than 0.05 rad
    "more than a turn",  # LinuxCNC cuts almost nothing of a circle that begins off its normal
    "rounded, this arc is another one",
)

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def pipeline(chain: str = "cutter-comp") -> gx.Pipeline:
    kind = default_registry().dialect("linuxcnc")
    tools = {number: Tool(radius=number / 2) for number in range(1, 100)}
    machine = Machine(file=Path("mill.toml"), tools=tools)
    passes = gx.Pipeline.parse(chain, "linuxcnc").passes
    numbers = replace(kind.numbers, mm=6, feed=6)
    return gx.Pipeline(kind, kind, passes, machine=machine, numbers=numbers)


def centre_program(source: bytes) -> bytes | str:
    """Return what the pass makes of a program, or why it refuses it."""
    try:
        return pipeline().run(source, verify="full").text
    except gx.InputError as error:
        return error.diagnostics[0].message


@shares(COUNT, 120)
def test_the_centre_path_is_that_of_linuxcnc(seeds: range) -> None:
    same = both = ours = 0
    sources = [contour(seed) for seed in seeds]
    results = [centre_program(source) for source in sources]
    texts = [made for made in results if isinstance(made, bytes)]
    others = iter(rs274.run_many(texts))
    for source, made, wanted in zip(sources, results, rs274.run_many(sources), strict=True):
        if isinstance(made, str):
            refused = isinstance(wanted, rs274.Rejected)
            both += refused
            ours += not refused
            known = any(reason in made for reason in REFUSED_BY_US)
            assert refused or known, f"{made}\n{source.decode()}"
            continue
        found = next(others)
        text = f"{source.decode()}\n{made.decode()}"
        assert not isinstance(wanted, rs274.Rejected), f"{wanted}\n{text}"
        assert not isinstance(found, rs274.Rejected), f"{found}\n{text}"
        problem = difference(wanted, found)
        assert not problem, f"{problem}\n{text}"
        same += 1
    assert same > len(seeds) / 3
    assert both > len(seeds) / 10
    assert ours < len(seeds) / 8


def executed(program: bytes) -> CanonProgram | str:
    """Return what LinuxCNC does, or why it stops."""
    try:
        return rs274.run(program)
    except rs274.Rejected as refusal:
        return refusal.message


def difference(wanted: CanonProgram, found: CanonProgram) -> str:
    """Say how two programs differ; nothing if they do the same."""
    one, other = moving(wanted), moving(found)
    if len(one) != len(other):
        return f"{len(one)} and {len(other)} moves"
    for a, b in zip(one, other, strict=True):
        if (a.kind, a.turns) != (b.kind, b.turns):
            return f"{a}\n{b}"
        points = [(a.end[axis], b.end[axis]) for axis in "XYZ"]
        points += zip(a.centre or (), b.centre or (), strict=True)
        if any(abs(p - q) > CLOSE for p, q in points):
            return f"{a}\n{b}"
        if a.kind != "RAPID" and not math.isclose(a.feed[0], b.feed[0], rel_tol=2e-4, abs_tol=1e-3):
            return f"the feeds of {a}\n{b}"
    if [text for _, text in wanted.events] != [text for _, text in found.events]:
        return f"{wanted.events}\n{found.events}"
    return ""


def moving(program: CanonProgram) -> list[CanonMove]:
    """Return the moves that move anything."""
    return [m for m in program.moves if m.centre is not None or m.start != m.end]
