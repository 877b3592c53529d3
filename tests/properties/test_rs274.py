"""LinuxCNC's own interpreter as the judge: of what gcxform reads, and of what it writes."""

from __future__ import annotations

import math
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from properties import test_laws as laws
from reference.arcs import sweep
from reference.interpreter import Move
from seeds_kit import DRAWN, shares

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.plugin.registry import default_registry
from gcxform.testing.generate import Options, program
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath

COUNT = 20 * DRAWN
CLOSE = 1e-4  # mm, degrees; beyond the rounding of the print
PRINTED = 0.5e-4  # units of the program
START = dict.fromkeys("XYZABC", 0.0)

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def drawn(seed: int, **options: Any) -> bytes:
    return program(random.Random(seed).randint, Options(**options))


# --- reading ---


@shares(COUNT, 500)
def test_gcxform_reads_what_linuxcnc_reads(seeds: range) -> None:
    sources = [drawn(seed) for seed in seeds]
    for source, canon in zip(sources, rs274.run_many(sources), strict=True):
        assert isinstance(canon, CanonProgram), (canon, source)
        problem = difference(gx.read(source, "linuxcnc", start=START).path, canon)
        assert problem == "", f"{problem}\n{source.decode('latin-1')}"


def difference(path: Toolpath, canon: CanonProgram) -> str:
    """Say how a toolpath differs from canonical moves, by line; nothing if it does not."""
    lines = set((path.source + 1).tolist())
    theirs = [m for m in canon.moves if m.line in lines or m.start != m.end or m.centre]
    if [m.line for m in theirs] != (path.source + 1).tolist():
        return f"moves on lines {(path.source + 1).tolist()}, {[m.line for m in theirs]}"
    for row, move in enumerate(theirs):
        if problem := row_difference(path, row, move):
            return f"line {move.line}: {problem} {move}"
    return ""


def row_difference(path: Toolpath, row: int, move: CanonMove) -> str:
    if KINDS[Kind(path.kind[row])] != move.kind:
        return "kind"
    end = dict(zip(path.axes, path.end[row].tolist(), strict=True))
    for axis in "XYZABC":
        near = CLOSE + PRINTED * (move.unit if axis in "XYZ" else 1.0)
        if axis in end and not abs(end[axis] - move.end[axis]) <= near:
            return f"{axis} is {end[axis]}"
    if move.kind != "RAPID" and f"G{FeedMode(path.feed_mode[row]).value}" != move.feed_mode:
        return "feed mode"
    if move.feed and move.kind != "RAPID" and move.feed_mode != "G93":
        feeds = [abs(float(path.feed[row]) - f) for f in move.feed]
        if min(feeds) > CLOSE + PRINTED * move.unit:
            return f"the feed is {path.feed[row]}"
    return arc_difference(path, row, move) if move.centre else ""


KINDS = {Kind.RAPID: "RAPID", Kind.LINE: "LINE", Kind.ARC_CW: "ARC_CW", Kind.ARC_CCW: "ARC_CCW"}


def arc_difference(path: Toolpath, row: int, move: CanonMove) -> str:
    plane = Plane(path.plane[row])
    if plane.name != move.plane:
        return f"the plane is {plane.name}"
    assert move.centre is not None
    for k in plane.axes[:2]:
        if not abs(path.centre[row, k] - move.centre[k]) <= CLOSE + PRINTED * move.unit:
            return f"the centre is {path.centre[row]}"
    turns = math.ceil(float(path.sweep[row]) / math.tau - 1e-6) - 1
    return "" if turns == move.turns else f"the sweep is {path.sweep[row]}"


# --- writing ---


def chain(choose: random.Random) -> tuple[gx.Pipeline, laws.Where]:
    """Return a random chain, and where a machine with its error is."""
    steps = [
        text
        for text in ("metric", "absolute", "plane", choose.choice(SEGMENTS))
        if choose.random() < 0.5
    ]
    made, where = laws.chain_of(" | ".join(steps)) if steps else [], laws.as_commanded
    if choose.random() < 0.5 or not made:
        model, origin = drawn_model(choose), tuple(choose.uniform(-40, 40) for _ in "XYZ")
        clamp = choose.random() < 0.5
        made.append(compensation(model, origin, clamp, choose.choice((None, 0.01))))
        where = laws.error_of(model, clamp, origin)
    return laws.pipeline(made, "linuxcnc"), where


SEGMENTS = (
    "segment chord-error=20um",
    "segment chord-error=50um max-length=20mm",
    "segment arcs=split arc-step=45deg",
    "segment arcs=split max-length=25mm",
)


def drawn_model(choose: random.Random) -> gx.AxisFunctions:
    """Return a model of nine functions on uneven nodes."""
    axes = []
    for _ in "XYZ":
        nodes = sorted(choose.sample(range(-180, 180, 3), choose.randint(2, 7)))
        values = [[choose.uniform(-0.01, 0.01) for _ in "XYZ"] for _ in nodes]
        for before, here, a, b in zip(values, values[1:], nodes, nodes[1:], strict=False):
            reach = (b - a) * 4e-4  # so far may the error change on the way
            here[:] = [
                v + max(-reach, min(reach, w - v)) for v, w in zip(before, here, strict=True)
            ]
        axes.append(gx.AxisFunction(nodes, values))  # type: ignore[arg-type]
    return gx.AxisFunctions(tuple(axes))  # type: ignore[arg-type]


def compensation(
    model: gx.AxisFunctions, origin: tuple[float, ...], clamp: bool, tolerance: float | None
) -> gx.Pass:
    return default_registry().passes["volumetric"](  # type: ignore[return-value]
        model=ModelFile(Path("drawn.toml"), model, "0" * 64),
        outside=gx.Outside.CLAMP if clamp else gx.Outside.EXTRAPOLATE,
        tolerance=tolerance,
        max_correction=10.0,
        max_extrapolation=1000.0,
        part_origin=origin,
    )


@shares(COUNT // 2, 30)
def test_linuxcnc_reads_what_gcxform_writes(seeds: range) -> None:
    """Random chains: the same events, and the machine within the budget of the program's path."""
    jobs = [job for seed in seeds if (job := written(seed)) is not None]
    before = rs274.run_many([job[1] for job in jobs])
    after = rs274.run_many([job[2].text for job in jobs])
    for job, old, new in zip(jobs, before, after, strict=True):
        assert isinstance(old, CanonProgram)
        assert isinstance(new, CanonProgram), f"{new}\n{job[1]!r}\n{job[2].text.decode()}"
        check(job, old, new)
    assert len(jobs) > 0.8 * len(seeds)  # 387 of the first 400; a share may have few


Job = tuple[gx.Pipeline, bytes, gx.Result, "laws.Where"]


def written(seed: int) -> Job | None:
    """Return what a random chain makes of a random program; None if it is refused."""
    choose = random.Random(seed)
    steps, where = chain(choose)
    source = drawn(seed, max_blocks=12)
    try:
        return steps, source, steps.run(source), where
    except gx.VerificationError as error:
        pytest.fail(f"{error}\n{source.decode('latin-1')}\n{steps.passes}")
    except gx.InputError:
        return None


def check(job: Job, old: CanonProgram, new: CanonProgram) -> None:
    steps, source, result, where = job
    lines = {line: result.source_map[line - 1] + 1 for line in {m.line for m in new.moves}}
    # The start is exactly known here; the reference knows it from the program's first block.
    before = laws.interpret(source, "linuxcnc", start=START, same_frames=True)
    said = {m.line for m in before.moves}
    pieces = [(lines[m.line], as_move(m)) for m in new.moves if is_move(m) or lines[m.line] in said]
    try:
        laws.check_path(before, pieces, where, budget(steps, result, new))
    except AssertionError as error:
        pytest.fail(f"{error}\n{source.decode('latin-1')}\n{result.text.decode('latin-1')}")
    assert [text for _, text in new.events] == [text for _, text in old.events]


def budget(steps: gx.Pipeline, result: gx.Result, canon: CanonProgram) -> float:
    """Return the budget, and what the print rounds."""
    inch = any(move.unit > 1 for move in canon.moves)
    return steps.limit(inch) + CLOSE + 2 * PRINTED * (25.4 if inch else 1.0)


def is_move(move: CanonMove) -> bool:
    return move.start != move.end or move.centre is not None


def as_move(canon: CanonMove) -> Move:
    """Return a canonical move as the oracle takes it; its feed is looked at elsewhere."""
    move = Move(canon.kind, canon.start, canon.end, canon.line, None, canon.feed_mode, canon.plane)
    if canon.centre is None:
        return move
    u, v, _ = laws.PLANES[canon.plane]
    first, last = ((end["XYZ"[u]], end["XYZ"[v]]) for end in (canon.start, canon.end))
    middle = canon.centre[u], canon.centre[v]
    angle = sweep(first, last, middle, canon.kind == "ARC_CW", 0.0)
    turned = angle + math.tau * canon.turns
    return replace(move, centre=canon.centre, turns=canon.turns, sweep=turned)
