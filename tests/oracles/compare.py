"""Does the reference interpreter say what LinuxCNC says? The first difference, in words."""

import math
from typing import Any

from oracles.canon import CanonMove, CanonProgram

SLACK = 1e-6  # mm, deg; beyond the rounding of the print
PRINTED = 0.5e-4  # units of the program
PLANE_AXES = {"XY": "XYZ", "ZX": "ZXY", "YZ": "YZX"}
LEAST_RATE = 0.1  # units per minute: LinuxCNC's lower bound for the rate of a G93 block


def difference(program: Any, canon: CanonProgram) -> str | None:
    """Compare a reference program (moves and events) with canon; None if they agree.

    LinuxCNC also reports motions without axis words, which move nothing; these are left out.
    """
    theirs, null_before = _without_null_moves(program, canon)
    if [m.line for m in program.moves] != [m.line for m in theirs]:
        return f"moves on lines {[m.line for m in program.moves]}, {[m.line for m in theirs]}"
    for ours, move in zip(program.moves, theirs, strict=True):
        if problem := move_difference(ours, move):
            return f"line {move.line}: {problem}\n  {ours}\n  {move}"
    events = [(index - null_before[index], text) for index, text in canon.events]
    if list(program.events) != events:
        return f"events {program.events}, {events}"
    return None


def _without_null_moves(program: Any, canon: CanonProgram) -> tuple[list[CanonMove], list[int]]:
    """Drop motions which no axis word asked for; also count those before each index."""
    lines = {move.line for move in program.moves}
    kept, null_before = [], [0]
    for move in canon.moves:
        null = move.line not in lines and move.start == move.end and move.centre is None
        kept += [] if null else [move]
        null_before.append(null_before[-1] + null)
    return kept, null_before


def move_difference(ours: Any, theirs: CanonMove) -> str | None:
    if (ours.kind, ours.plane) != (theirs.kind, theirs.plane):
        return "kind or plane"
    for axis, value in ours.end.items():
        if abs(value - theirs.end[axis]) > _close(theirs, axis):
            return f"end {axis}"
    if (ours.centre is None) != (theirs.centre is None) or ours.turns != theirs.turns:
        return "centre or turns"
    if ours.centre is not None and theirs.centre is not None:
        for axis in set(PLANE_AXES[ours.plane][:2]):
            at = "XYZ".index(axis)
            if abs(ours.centre[at] - theirs.centre[at]) > _close(theirs, axis):
                return "centre"
        if not 0 < ours.sweep - math.tau * ours.turns <= math.tau + 1e-5:
            return "sweep"
    return feed_difference(ours, theirs)


def _close(move: CanonMove, axis: str) -> float:
    return SLACK + PRINTED * (move.unit if axis in "XYZ" else 1.0)


def feed_difference(ours: Any, theirs: CanonMove) -> str | None:
    """Compare feeds; LinuxCNC has turned that of G93 into a rate along the path."""
    if ours.feed is None or theirs.feed is None:
        return None if ours.feed is theirs.feed else "feed"
    if ours.feed_mode != theirs.feed_mode:
        return "feed mode"
    if ours.feed != ours.feed:  # only the machine knows it: any other is as good
        return None
    linear, rotary = lengths(ours)
    alone = bool(rotary and not linear)  # only rotary axes move
    unit = 1.0 if alone else theirs.unit
    expected, slack = [ours.feed], SLACK + PRINTED * 25.4
    if ours.feed_mode == "G93":
        known = ours.start.keys() & ours.end.keys()
        if not theirs.end.keys() <= known:  # how far it goes only the machine knows
            return None
        ways = [rotary] if alone else [linear, *_circle_lost(ours)]
        expected = [max(way * ours.feed, LEAST_RATE * unit) for way in ways]
        slack += 1e-6 * expected[0]
    if any(abs(rate - theirs.feed[alone]) <= slack for rate in expected):
        return None
    return f"feed, expected {expected}"


def _circle_lost(move: Any) -> list[float]:
    """Return the path without the first turn, for a circle whose ends differ by a last bit.

    LinuxCNC moves along the whole circle all the same, but takes the rate from this length.
    """
    if move.centre is None or abs(move.sweep - math.tau * (move.turns + 1)) > 1e-9:
        return []
    rise = _rise(move)
    return [math.hypot(_radius(move) * math.tau * move.turns, rise)]


def lengths(move: Any) -> tuple[float, float]:
    """Return the path of the linear axes in mm, and that of the rotary ones in degrees."""
    delta = {a: v - move.start.get(a, 0.0) for a, v in move.end.items()}
    rotary = math.hypot(*(delta.get(a, 0.0) for a in "ABC"))
    if move.centre is None:
        linear = math.hypot(*(delta.get(a, 0.0) for a in "XYZ"))
        return (0.0 if linear < 1e-7 else linear), rotary
    return math.hypot(_radius(move) * move.sweep, _rise(move)), rotary


def _rise(move: Any) -> float:
    normal = PLANE_AXES[move.plane][2]
    return move.end.get(normal, 0.0) - move.start.get(normal, 0.0)


def _radius(move: Any) -> float:
    at = dict(zip("XYZ", move.centre, strict=True))
    return math.hypot(*(move.start[axis] - at[axis] for axis in PLANE_AXES[move.plane][:2]))
