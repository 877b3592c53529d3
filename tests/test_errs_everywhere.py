"""A machine that errs everywhere, in plain Python: where its tool is at every move of a program.

Random programs of rapids, feed moves, G53, G28 and work offsets, from a start that is known or not,
are compensated; the machine reads source and output word by word and adds its error to wherever it
is told to be. A feed move has to be cut where the source says, from its beginning on, or refused.
"""

from __future__ import annotations

import bisect
import math
import re
from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.dialects.linuxcnc import LinuxCNC
from gcxform_plugins.passes.volumetric.volumetric import Volumetric
from hypothesis import event, given
from hypothesis import strategies as st

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.diagnostics import InputError
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading

NODES = [-300.0, -40.0, 0.0, 35.0, 80.0, 300.0]
OFFSETS = {"G54": (5.0, -8.0, 2.0), "G55": (-30.0, 20.0, 6.0)}
HOME = (0.0, 10.0, 150.0)
STEPS = 40
ALLOWED = {"GX317", "GX311", "GX207"}

Point = tuple[float | None, ...]


def named(values) -> dict[str, float]:
    return dict(zip("XYZ", values, strict=True))


MILL = Machine(
    file="machine.toml",
    work_offsets={code: named(zero) for code, zero in OFFSETS.items()},
    homes={"G28": named(HOME)},
)


def tables(seed: int) -> list[list[tuple[float, ...]]]:
    """Return the errors (mm) of each axis at its nodes, in X, Y and Z."""
    random = np.random.default_rng(seed)
    return [[tuple(row) for row in random.uniform(-0.03, 0.03, (6, 3)).tolist()] for _ in "XYZ"]


def error(errors, point) -> tuple[float, ...]:
    """Return the error at a point: that of each axis, straight between its nodes, and added up."""
    total = [0.0, 0.0, 0.0]
    for place, values in zip(point, errors, strict=True):
        k = min(max(bisect.bisect_right(NODES, place) - 1, 0), len(NODES) - 2)
        share = (place - NODES[k]) / (NODES[k + 1] - NODES[k])
        for axis in range(3):
            total[axis] += values[k][axis] * (1 - share) + values[k + 1][axis] * share
    return tuple(total)


def moves(text: str, start: Point) -> list[tuple[int, bool, Point, Point]]:
    """Return line, whether it is a feed, and both ends of all moves, as the machine counts them."""
    at, offset, feed, found = start, OFFSETS["G54"], False, []
    for line, block in enumerate(text.splitlines()):
        words = re.findall(r"([A-Z])(-?[0-9.]+)", block)
        codes = {float(value) for letter, value in words if letter == "G"}
        axes = {"XYZ".index(letter): float(value) for letter, value in words if letter in "XYZ"}
        for code in ("G54", "G55"):
            offset = OFFSETS[code] if float(code[1:]) in codes else offset
        feed = (feed or 1.0 in codes) and 0.0 not in codes
        if not axes:
            continue
        zero = (0.0, 0.0, 0.0) if 53.0 in codes else offset
        end = tuple(axes[k] + zero[k] if k in axes else at[k] for k in range(3))
        if 28.0 in codes:
            home = tuple(HOME[k] if k in axes else at[k] for k in range(3))
            found += [(line, False, at, end), (line, False, end, home)]
            at = home
        else:
            found.append((line, feed, at, end))
            at = end
    return found


def aside(point, a, b) -> float:
    """Return how far a point is from a straight way."""
    way = [q - p for p, q in zip(a, b, strict=True)]
    square = sum(w * w for w in way)
    along = sum((x - p) * w for x, p, w in zip(point, a, way, strict=True))
    part = min(max(along / square, 0.0), 1.0) if square else 0.0
    return math.dist(point, [p + part * w for p, w in zip(a, way, strict=True)])


def farthest(errors, source: str, output: str, owner: list[int], start: Point) -> float:
    """Return how far the tool is from where the source says, over all feed moves (mm)."""
    told: dict[int, list[tuple[Point, Point]]] = {}
    for line, feed, a, b in moves(output, start):
        if feed:
            told.setdefault(owner[line], []).append((a, b))
    worst = 0.0
    for line, feed, a, b in moves(source, start):
        if not feed or None in a or None in b:
            continue
        pieces = told.get(line, [])
        assert pieces or math.dist(a, b) < 1e-3
        for nth, (p, q) in enumerate(pieces):
            for step in range(STEPS + 1):
                t = step / STEPS
                command = tuple(x + t * (y - x) for x, y in zip(p, q, strict=True))
                tool = tuple(x + e for x, e in zip(command, error(errors, command), strict=True))
                worst = max(worst, aside(tool, a, b))
                if (nth, step) == (0, 0):
                    worst = max(worst, math.dist(tool, a))
        if pieces:
            worst = max(worst, math.dist(tool, b))
    return worst


@st.composite
def programs(draw) -> str:
    """Draw a program; after what is left to the machine a rapid mends it, or it does not."""
    lines = ["G21 G17 G90 G94 G54", "F300"]
    if draw(st.booleans()):
        lines.append("G0 X0 Y0 Z20")
    value = st.integers(-60, 90).map(lambda n: n / 2)

    def words(least: int) -> str:
        axes = draw(st.lists(st.sampled_from("XYZ"), min_size=least, max_size=3, unique=True))
        return " ".join(f"{axis}{draw(value):g}" for axis in sorted(axes))

    for _ in range(draw(st.integers(2, 9))):
        kind = draw(
            st.sampled_from(["G0", "G1", "G1", "G1", "G53 G0", "G28", "G55", "G54", "mend"])
        )
        if kind == "mend":
            lines.append(f"G0 {words(3)}")
        elif kind in OFFSETS:
            lines.append(kind)
        else:
            lines.append(f"{kind} {words(1)}")
    return "\n".join([*lines, "M2\n"])


@given(programs(), st.integers(0, 50), st.booleans())
def test_every_feed_move_is_cut_where_the_source_says(program, seed, known):
    errors = tables(seed)
    axes = [AxisFunction(np.array(NODES), np.array(values)) for values in errors]
    step = Volumetric(model=ModelFile(Path("m.toml"), AxisFunctions(tuple(axes)), ""))
    start: Point = (3.0, 4.0, 60.0) if known else (None, None, None)
    reading = Reading(start=dict(zip("XYZ", (3.0, 4.0, 60.0), strict=True)) if known else {})
    if known:  # given in the first work offset
        start = tuple(x + o for x, o in zip((3.0, 4.0, 60.0), OFFSETS["G54"], strict=True))
    chain = gx.Pipeline(LinuxCNC, LinuxCNC, (step,), machine=MILL, reading=reading)
    codes: set[str] = set()
    try:
        result = chain.run(program.encode())
    except InputError as refused:
        codes, result = {found.code for found in refused.diagnostics}, None
    event("proved" if result else "refused")
    if result is None:
        assert codes <= ALLOWED
        return
    off = farthest(errors, program, result.text.decode(), result.source_map, start)
    assert off <= result.certificate.budget["deviation"] + 1e-5


@pytest.mark.parametrize("line", ["G53 G0 X20", "G28 X0 Y0", "G28 Z20"])
def test_the_hint_of_the_refusal_works(line):
    """The rapid that the message names makes the program go through."""
    errors = tables(1)
    axes = [AxisFunction(np.array(NODES), np.array(values)) for values in errors]
    step = Volumetric(model=ModelFile(Path("m.toml"), AxisFunctions(tuple(axes)), ""))
    chain = gx.Pipeline(LinuxCNC, LinuxCNC, (step,), machine=MILL)
    program = f"G21 G17 G90 G94 G54\nG0 X0 Y0 Z20\n{line}\nG1 X30 Y5 F300\nM2\n"
    with pytest.raises(InputError) as refused:
        chain.run(program.encode())
    (found,) = refused.value.diagnostics
    assert found.code == "GX317"
    mended = program.replace("G1 X30", f"{found.hint.split(': ')[1]}\nG1 X30")
    result = chain.run(mended.encode())
    owner = result.source_map
    assert farthest(errors, mended, result.text.decode(), owner, (None,) * 3) <= 0.004
