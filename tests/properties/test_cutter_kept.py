"""Programs that stay under G41 and G42, through passes that move nothing, against LinuxCNC.

LinuxCNC compensates the source and the output itself. Where both centre paths go is compared by
points of the one and whole moves of the other, which shares no code with the proof of the run.
"""

from __future__ import annotations

import math
import random
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from oracles import rs274
from oracles.canon import CanonMove, CanonProgram
from properties.contours import contour
from properties.test_cutter_comp import REFUSED_BY_US, centre_program, executed
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.machine.machine import Machine, Tool
from gcxform.plugin.registry import default_registry

COUNT = DRAWN
STEPS = (
    "absolute",
    "offsets",
    "metric",
    "plane",
    "offsets | absolute",
    "absolute | renumber",
    "offsets | absolute | metric",
)
PRINTED = 0.7e-4  # units: both coordinates of a point, as the print rounds them
KNOWN = ("GX321", "GX322", "GX350", "GX351", "GX501", "GX504", "GX505", "GX506")

pytestmark = pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")


def drawn(seed: int) -> tuple[bytes, gx.Pipeline]:
    """Return a program, in inches now and then, and a chain that moves nothing."""
    choose = random.Random(seed)
    source = contour(seed)
    if choose.random() < 0.3:
        source = source.replace(b"G21", b"G20", 1)
    if choose.random() < 0.6:
        source = source.replace(b"G1 X0 Y0 Z0\n", b"G1 X0 Y0 Z0\nG92 X1.5 Y-2.25\n", 1)
    kind = default_registry().dialect("linuxcnc")
    tools = {number: Tool(radius=number / 2) for number in range(1, 100)}
    passes = gx.Pipeline.parse(choose.choice(STEPS), "linuxcnc").passes
    decimals = choose.choice((2, 3, 4))
    numbers = replace(kind.numbers, mm=decimals, inch=decimals + 1, feed=6)
    budget = choose.choice((None, None, 0.05))
    machine = Machine(file=Path("mill.toml"), tools=tools)
    return source, gx.Pipeline(
        kind, kind, passes, machine=machine, numbers=numbers, budget=budget, words="changed"
    )


def test_the_centre_goes_where_the_certificate_says() -> None:
    with ThreadPoolExecutor(2) as pool:
        pairs = [drawn(seed) for seed in range(COUNT)]
        before = pool.map(executed, (source for source, _ in pairs))
        made = [transformed(*pair) for pair in pairs]
        after = pool.map(executed, [m[0] if isinstance(m, tuple) else b"M2\n" for m in made])
        told = [judged(*each) for each in zip(pairs, before, made, after, strict=True)]
    assert told.count("same") > COUNT / 4
    assert told.count("rounded") < COUNT / 10
    assert told.count("stops") > COUNT / 10
    assert told.count("kept") < COUNT / 10


def transformed(source: bytes, pipeline: gx.Pipeline) -> tuple[bytes, float] | str:
    """Return the output and its budget, or why it is refused; GX601 fails the test."""
    try:
        result = pipeline.run(source)
    except gx.InputError as error:
        return error.diagnostics[0].code
    deviation = result.certificate.budget["deviation"]
    assert isinstance(deviation, float)
    return result.text, deviation


def judged(
    pair: tuple[bytes, gx.Pipeline],
    wanted: CanonProgram | str,
    made: tuple[bytes, float] | str,
    found: CanonProgram | str,
) -> str:
    """Return what became of a program, after checking that it is right."""
    text = pair[0].decode() + str(pair[1].passes)
    if isinstance(made, str):
        assert made in KNOWN, f"{made}\n{text}"
        return "stops" if isinstance(wanted, str) else "rounded" if made == "GX351" else "refused"
    said = f"{text}\n{made[0].decode()}"
    if isinstance(wanted, str):  # what is certain of the first corner is not certain of the next
        why = centre_program(pair[0])
        assert found == wanted, said
        inches = b"G20" in pair[0]  # of arcs in inches it stops at more than in mm
        assert inches or any(reason in str(why) for reason in REFUSED_BY_US), said
        return "kept"
    assert not isinstance(found, str), f"{found}\n{said}"
    one, other = moving(wanted), moving(found)
    unit = max(m.unit for m in one + other)
    apart = max(farthest(one, other), farthest(other, one))
    assert apart <= made[1] + 2 * PRINTED * unit, f"{apart} of {made[1]}\n{said}"
    return "same"


def moving(program: CanonProgram) -> list[CanonMove]:
    return [m for m in program.moves if m.centre is not None or m.start != m.end]


def farthest(one: list[CanonMove], other: list[CanonMove]) -> float:
    """Return how far any of some points of a path is from the nearest move of another one."""
    points = np.concatenate([points_of(move) for move in one])
    return float(np.min([distances(points, move) for move in other], axis=0).max())


def points_of(move: CanonMove) -> np.ndarray:
    """Return points (n, 3) of a move, its end among them."""
    part = np.linspace(0.0, 1.0, 33)[1:, None]
    start, end = (np.array([p[axis] for axis in "XYZ"]) for p in move.machine[:2])
    points = start + part * (end - start)
    if move.centre is None:
        return points
    u, v, centre, first, sweep = circle(move)
    size = sizes(move, part[:, 0])
    points[:, u] = centre[u] + size * np.cos(first + part[:, 0] * sweep)
    points[:, v] = centre[v] + size * np.sin(first + part[:, 0] * sweep)
    return points


def sizes(move: CanonMove, part: np.ndarray) -> np.ndarray:
    """Return the radius (n,) at parts of an arc: its ends may be a little apart in it."""
    u, v, centre, _, _ = circle(move)
    first, last = (
        math.hypot(p["XYZ"[u]] - centre[u], p["XYZ"[v]] - centre[v]) for p in move.machine[:2]
    )
    return np.asarray(first + part * (last - first))


def circle(move: CanonMove) -> tuple[int, int, np.ndarray, float, float]:
    """Return the axes of an arc's plane, its centre, first angle and sweep (rad, with its sign)."""
    assert move.centre is not None
    u, v = {"XY": (0, 1), "ZX": (2, 0), "YZ": (1, 2)}[move.plane]
    start, end = (np.array([p[axis] for axis in "XYZ"]) for p in move.machine[:2])
    centre = np.array([move.machine[2][axis] for axis in "XYZ"])
    first = math.atan2(start[v] - centre[v], start[u] - centre[u])
    last = math.atan2(end[v] - centre[v], end[u] - centre[u])
    sense = 1 if move.kind == "ARC_CCW" else -1
    sweep = sense * (last - first) % math.tau
    if sweep < 1e-6:
        sweep = math.tau
    return u, v, centre, first, sense * (sweep + math.tau * move.turns)


def distances(points: np.ndarray, move: CanonMove) -> np.ndarray:
    """Return the distances (n,) of points from a move."""
    start, end = (np.array([p[axis] for axis in "XYZ"]) for p in move.machine[:2])
    if move.centre is None:
        way = end - start
        part = np.clip((points - start) @ way / max(way @ way, 1e-30), 0.0, 1.0)
        return np.linalg.norm(points - start - part[:, None] * way, axis=1)
    u, v, centre, first, sweep = circle(move)
    normal = 3 - u - v
    angle = np.arctan2(points[:, v] - centre[v], points[:, u] - centre[u])
    turned = (np.sign(sweep) * (angle - first)) % math.tau
    best = np.full(len(points), np.inf)
    rise = end[normal] - start[normal]
    for turn in range(int(abs(sweep) // math.tau) + 1):
        part = (turned + turn * math.tau) / abs(sweep)
        part = np.where(part <= 1, part, np.where(turned > math.pi + abs(sweep) / 2, 0.0, 1.0))
        height = np.clip((points[:, normal] - start[normal]) / rise, 0, 1) if rise else part
        for share in np.linspace(0.0, 1.0, 17 if rise else 1):  # of a helix, what is between both
            at = part + share * (height - part)
            near, size = np.empty_like(points), sizes(move, at)
            near[:, u] = centre[u] + size * np.cos(first + at * sweep)
            near[:, v] = centre[v] + size * np.sin(first + at * sweep)
            near[:, normal] = start[normal] + at * rise
            best = np.minimum(best, np.linalg.norm(points - near, axis=1))
    return best
