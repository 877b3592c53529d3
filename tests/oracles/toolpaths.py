"""Toolpaths beside LinuxCNC's canonical moves, where no call says which line it came from.

Order is all there is: moves are paired one after the other. A motion that moves nothing may be
missing on either side (LinuxCNC reports one for a bare G1), and events must stand between the same
pairs of moves that move something.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from oracles.canon import CanonMove, CanonProgram
from oracles.compare import move_difference
from reference.model import Move

import gcxform as gx
from gcxform.contract.passes import PassContext
from gcxform.dialect.dialect import INCH
from gcxform.machine.machine import Tool
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import FeedMode, Form, Kind, Plane, Toolpath

KINDS = {Kind.RAPID: "RAPID", Kind.LINE: "LINE", Kind.ARC_CW: "ARC_CW", Kind.ARC_CCW: "ARC_CCW"}
FORMS = {Form.PROBE: "PROBE", Form.SPLINE: "SPLINE", Form.NURBS: "NURBS", Form.TILTED: "TILTED"}
COMPARED = {f"M{n}" for n in (0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 19, 30, 60)} | {"S", "T"}
ORIENTS = {"R", "P"}
"""An M19 without any of these words says nothing to the spindle of `rs274`."""
LOST = "?"
"""What the name of a value ends with that only the machine knows: any other is as good."""
HALF = 0.51e-4
STILL = 1.001e-4  # units of the program: a move that the print shows as none
START = dict.fromkeys("XYZABCUVW", 0.0)
OFFSETS = {f"G{n}": START for n in (54, 55, 56, 57, 58, 59)} | {
    f"G59.{n}": START for n in (1, 2, 3)
}
HOMES = {"G28": START, "G30": START}
OWN_TOOLS = {
    number: Tool(length=length * INCH, radius=diameter * INCH / 2)
    for number, length, diameter in ((1, 0.511, 0.125), (2, 0.1, 0.0625), (3, 1.273, 0.201))
}
"""The tools that `rs274` has when it is given no table."""


def read(text: bytes, tools: Mapping[int, Tool] = OWN_TOOLS) -> Toolpath:
    """Read a program as `rs274` does, with its tools. Raises InputError.

    It starts from zero, with all offsets zero, and executes blocks with a slash.
    """
    told: dict[str, Any] = {"work_offsets": OFFSETS, "homes": HOMES, "tools": tools}
    path = gx.read(text, "linuxcnc", start=START, block_delete="execute", **told).path
    return resolved(path) if path.side.any() else path


def resolved(path: Toolpath) -> Toolpath:
    """Return the path of the tool's centre, which is what `rs274` prints. Raises InputError."""
    dialect = default_registry().dialect("linuxcnc")
    step: Any = default_registry().passes["cutter-comp"]()
    return step.apply(path, PassContext(dialect, dialect, dialect.numbers))  # type: ignore[no-any-return]


def programmed(path: Toolpath) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return start, end (n, axes) and centre (n, 3) in the active program coordinates."""
    return path.local(path.start), path.local(path.end), path.local(path.centre)


def moves_of(path: Toolpath) -> Iterator[Move]:
    """Yield the moves of a path as the reference has them."""
    start, end, centre = (column.tolist() for column in programmed(path))
    sweep = path.sweep.tolist()
    for row, (kind, mode, plane) in enumerate(
        zip(path.kind.tolist(), path.feed_mode.tolist(), path.plane.tolist(), strict=True)
    ):
        arc = kind >= Kind.ARC_CW
        yield Move(
            FORMS.get(Form(path.form[row]), KINDS[Kind(kind)]),
            _known(path.axes, start[row]),
            _known(path.axes, end[row]),
            int(path.source[row]) + 1,
            None if kind == Kind.RAPID else float(path.feed[row]),
            f"G{FeedMode(mode).value}",
            Plane(plane).name,
            tuple(centre[row]) if arc else None,
            math.ceil(sweep[row] / math.tau - 1e-6) - 1 if arc else 0,
            sweep[row],
        )


def _known(axes: str, at: list[float]) -> dict[str, float]:
    return {a: v for a, v in zip(axes, at, strict=True) if v == v and a in "XYZABCE"}


def events_of(path: Toolpath) -> list[tuple[int, str, int]]:
    """Return row, text and line of the events that LinuxCNC prints as well."""
    found = []
    for event in path.events:
        name, value = event.values[0] if event.values else ("", 0.0)
        if name.endswith(LOST) and event.what in (*COMPARED, "DWELL"):
            found.append((event.row, event.what + LOST, event.line + 1))
        elif event.what == "DWELL":
            found.append((event.row, f"DWELL {value:.4f}", event.line + 1))
        elif event.what == "M19" and not event.within and not ORIENTS & dict(event.values).keys():
            continue
        elif event.what == "G96" and name == "S":  # LinuxCNC says S before the spindle turns
            turns = found[-1:] and found[-1][1] in ("M3", "M4") and found[-1][2] == event.line + 1
            found.insert(len(found) - bool(turns), (event.row, f"S{value:.10g}", event.line + 1))
        elif event.what in COMPARED:
            words = f"{event.what}{value:.10g}" if event.what in "ST" else event.what
            found.append((event.row, words, event.line + 1))
    return found


def difference(path: Toolpath, canon: CanonProgram) -> str:
    """Return the first difference in words, with its line; nothing if there is none."""
    ours, theirs = list(moves_of(path)), [*_there_and_back(canon.moves)]
    pairs, problem = _paired(ours, theirs)
    if problem:
        return problem
    extra = np.append(0, np.cumsum([move.kind == "TAP" for move in canon.moves]))
    events = [(at + int(extra[at]), text) for at, text in canon.events]
    return _events_differ(events_of(path), events, pairs)


def _there_and_back(moves: list[CanonMove]) -> Iterator[CanonMove]:
    """Yield the moves with two lines in the place of each tap."""
    for move in moves:
        if move.kind == "TAP":
            yield replace(move, kind="LINE")
            yield replace(move, kind="LINE", start=move.end, end=move.start)
        else:
            yield move


def _paired(ours: list[Move], theirs: list[CanonMove]) -> tuple[list[tuple[int, int]], str]:
    """Return the pairs of moves that move something, and where the first has no partner."""
    pairs: list[tuple[int, int]] = []
    row = other = 0
    while row < len(ours) and other < len(theirs):
        curves = ours[row].kind == theirs[other].kind == "SPLINE"  # printed without numbers
        if ours[row].kind == "NURBS" and theirs[other].kind == "SPLINE":
            pairs.append((row, other))  # one curve, printed without numbers; ours are its legs
            row, other = _behind_legs(ours, row), other + 1
            continue
        if ours[row].kind == "TILTED":  # one arc, of which ours are the legs
            last = _last_leg(ours, row)
            if not theirs[other].kind.startswith("ARC") or _ends_apart(ours[last], theirs[other]):
                return pairs, f"line {ours[row].line}: {ours[last]}\n  {theirs[other]}"
            pairs.append((row, other))
            row, other = last + 1, other + 1
            continue
        problem = "" if curves else move_difference(ours[row], theirs[other])
        if not problem:
            pairs += [] if _stands_still(theirs[other]) else [(row, other)]
            row, other = row + 1, other + 1
        elif _stands_still(theirs[other]):
            other += 1
        elif ours[row].centre is None and _stands_still(ours[row], theirs[other].unit):
            row += 1
        else:
            return pairs, f"line {ours[row].line}: {problem}\n  {ours[row]}\n  {theirs[other]}"
    lone = [m for m in theirs[other:] if not _stands_still(m)]
    if lone:
        return pairs, f"after the last line: {lone[0]}"
    late = [m for m in ours[row:] if not _stands_still(m)]
    return pairs, f"line {late[0].line}: LinuxCNC has no such move: {late[0]}" if late else ""


def _behind_legs(ours: list[Move], row: int) -> int:
    """Return the row behind the legs of a curve."""
    while row < len(ours) and ours[row].kind == "NURBS":
        row += 1
    return row


def _last_leg(ours: list[Move], row: int) -> int:
    """Return the last row of the line of an arc that has legs."""
    line = ours[row].line
    return max(
        k for k in range(row, len(ours)) if ours[k].line == line and ours[k].kind == "TILTED"
    )


def _ends_apart(move: Move, canon: CanonMove) -> bool:
    return any(abs(v - canon.end.get(a, math.inf)) > HALF * canon.unit for a, v in move.end.items())


def _stands_still(move: Move | CanonMove, unit: float = 0.0) -> bool:
    if move.centre is not None or move.kind in ("PROBE", "TAP", "SPLINE", "NURBS"):
        return False
    near = STILL * (getattr(move, "unit", unit) or 1.0)
    return all(abs(v - move.start.get(a, math.inf)) <= near for a, v in move.end.items())


def _events_differ(
    ours: list[tuple[int, str, int]],
    theirs: list[tuple[int, str]],
    pairs: list[tuple[int, int]],
) -> str:
    """Compare events, and between which pairs of moves they stand."""
    rows, others = [row for row, _ in pairs], [other for _, other in pairs]
    first = second = 0
    while first < len(ours) or second < len(theirs):
        mine = ours[first] if first < len(ours) else None
        their = theirs[second] if second < len(theirs) else None
        if mine is not None and their is not None and _alike(mine[1], their[1]):
            if int(np.searchsorted(rows, mine[0])) != int(np.searchsorted(others, their[0])):
                return f"line {mine[2]}: {mine[1]} stands elsewhere"
            first, second = first + 1, second + 1
        elif mine is not None and _says_again(mine[1], theirs[:second]):
            first += 1
        elif their is not None and _says_again(their[1], theirs[:second]):
            second += 1
        else:
            return f"line {mine[2] if mine else 0}: event {mine} for {their}"
    return ""


def _says_again(name: str, before: list[tuple[int, str]]) -> bool:
    """Whether an event is an S that says the speed again that LinuxCNC has, as far as is printed.

    Where M72 brings a speed back that is that of before but for rounding, or that only the machine
    knows in between, one of both may say it.
    """
    said = [each for _, each in before if each.startswith("S")]
    return (
        bool(said) and name.startswith("S") and not name.endswith(LOST) and _alike(name, said[-1])
    )


def _alike(ours: str, theirs: str) -> bool:
    """Whether an event is what LinuxCNC printed, to half of its last decimal."""
    if ours.endswith(LOST):
        return theirs.startswith(ours.removesuffix(LOST))
    for name in ("DWELL ", "S"):
        if ours.startswith(name) and theirs.startswith(name):
            return abs(float(ours.removeprefix(name)) - float(theirs.removeprefix(name))) <= HALF
    return ours == theirs
