"""The moves of canned cycles whose levels are known: many holes at once, as whole arrays."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter

import numpy as np

from gcxform.dialect.cycle_rule import DWELL, RESUME, TAPPING, CycleRule, Level
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import distinct
from gcxform.toolpath.columns import column_major
from gcxform.toolpath.path import Event, Kind
from gcxform.values import dataclass

CODES = 100  # canned cycles have numbers below
SAME_DEPTH = 1e-9  # part of a peck
SAME_LEVEL = 1e-9  # mm; closer levels differ by the noise of sums


@dataclass(frozen=True, slots=True)
class Holes:
    """One value per hole that is drilled, mm in the coordinates of the program.

    call       (n,) which call drills it
    number     (n,) which of its call, from 0
    code       (n,) of the cycle: 81 is G81
    at         (n, 2) first and second axis of the hole
    start      (n, 2) where the tool stands before it
    rises      (n,) whether the tool rises from there to R before it goes to the hole
    level      (n,) along the normal axis, at which the tool arrives over the hole
    levels     (n, 4) of the ends of the steps, by `Level`
    shift      (n, 2) by which shifted steps are beside the hole
    peck       (n,) depth of a peck
    pecks      (n,) how many there are; 1 for cycles without
    dwell      (n,) s
    spindle    (n,) +1 or -1: how the spindle turns before
    line       (n,) of the program, from 0

    A tap has always its move down to R, also where it stands there already: written again with R a
    little elsewhere, it has as many moves.
    """

    call: Ints
    number: Ints
    code: Ints
    at: Floats
    start: Floats
    rises: Flags
    level: Floats
    levels: Floats
    shift: Floats
    peck: Floats
    pecks: Ints
    dwell: Floats
    spindle: Ints
    line: Ints


@dataclass(frozen=True, slots=True)
class Rows:
    """Moves in the order in which they are made.

    call          (n,) which call a move belongs to
    hole          (n,) which hole of it, from 1; 0 before the tool goes to the first
    kind          (n,) `Kind`, RAPID or LINE
    end           (n, 3) mm: first, second and normal axis of the plane
    synchronised  (n,) whether the move is tied to the spindle (tapping)
    events        what is done between the moves; one may stand behind the last
    """

    call: Ints
    hole: Ints
    kind: Small
    end: Floats
    synchronised: Flags
    events: tuple[Event, ...]


class _Table:
    """The steps of all cycles as arrays: by code, and by number of the step."""

    def __init__(self, rule: CycleRule) -> None:
        longest = max(len(cycle.steps) for cycle in rule.cycles.values())
        self.count = np.zeros(CODES, np.int64)
        self.feeds = np.zeros((CODES, longest), np.bool_)
        self.level = np.zeros((CODES, longest), np.int64)
        self.shifted = np.zeros((CODES, longest), np.bool_)
        self.between = np.zeros(CODES, np.int64)  # moves of a peck but the last
        for code, cycle in rule.cycles.items():
            steps = cycle.steps
            self.count[code] = len(steps)
            self.feeds[code, : len(steps)] = [step.feeds for step in steps]
            self.level[code, : len(steps)] = [step.level for step in steps]
            self.shifted[code, : len(steps)] = [step.shifted for step in steps]
            self.between[code] = {"": 0, "break": 2, "clear": 3}[cycle.pecks]


def rows_of(holes: Holes, rule: CycleRule) -> Rows:
    """Return the moves that drill holes, in their order."""
    table = _Table(rule)
    taps = np.isin(holes.code, list(TAPPING))
    down = taps | ~(np.abs(holes.level - holes.levels[:, Level.CLEARANCE]) <= SAME_LEVEL)
    approach = holes.rises + 1 + down
    pecking = table.between[holes.code] * (holes.pecks - 1)
    count = approach + pecking + table.count[holes.code]
    first = np.cumsum(count) - count
    hole = np.repeat(np.arange(len(count)), count)
    at = np.arange(len(hole)) - first[hole]
    behind = at - (approach + pecking)[hole]  # number of the step, once pecks are made

    end, kind = _steps(holes, table, hole, np.maximum(behind, 0))
    _approach(holes, hole, at, approach, end, kind)
    pecks = np.flatnonzero((at >= approach[hole]) & (behind < 0))
    if len(pecks):
        number = at[pecks] - approach[hole[pecks]]
        _pecks(holes, rule, table, hole[pecks], number, (pecks, end, kind))
    synchronised = taps[hole] & (kind == Kind.LINE)
    behind_steps = first + approach + pecking
    events = tuple(sorted(_events(holes, rule, behind_steps), key=attrgetter("row")))
    begun = holes.number[hole] + (at >= holes.rises[hole])
    return Rows(holes.call[hole], begun, kind, end, synchronised, events)


def _steps(holes: Holes, table: _Table, hole: Ints, step: Ints) -> tuple[Floats, Small]:
    """Return ends and kinds of rows, as if each were a step of its hole's cycle."""
    end = column_major(len(hole), 3)
    code = holes.code[hole]
    shifted = table.shifted[code, step]
    for axis in (0, 1):
        end[:, axis] = holes.at[hole, axis]
        if shifted.any():
            end[shifted, axis] += holes.shift[hole[shifted], axis]
    end[:, 2] = holes.levels[hole, table.level[code, step]]
    return end, np.where(table.feeds[code, step], Kind.LINE, Kind.RAPID).astype(np.int8)


def _approach(holes: Holes, hole: Ints, at: Ints, approach: Ints, end: Floats, kind: Small) -> None:
    """Set the rows before the first step: up to R if need be, over the hole, down to R."""
    rows = np.flatnonzero(at < approach[hole])
    kind[rows] = Kind.RAPID
    end[rows, :2] = holes.at[hole[rows]]
    end[rows, 2] = holes.levels[hole[rows], Level.CLEARANCE]
    over = rows[at[rows] == holes.rises[hole[rows]]]
    end[over, 2] = holes.level[hole[over]]
    rising = rows[at[rows] < holes.rises[hole[rows]]]
    end[rising, :2] = holes.start[hole[rising]]


def _pecks(
    holes: Holes,
    rule: CycleRule,
    table: _Table,
    hole: Ints,
    number: Ints,
    rows: tuple[Ints, Floats, Small],
) -> None:
    """Set the rows of all pecks but the last, which is a step of the cycle."""
    at, end, kind = rows
    between = table.between[holes.code[hole]]
    peck, part = number // between, number % between
    top = holes.levels[hole, Level.CLEARANCE]
    depth = top - (peck + 1) * holes.peck[hole]
    clears = between == 3
    above = np.nan if rule.peck_clearance is None else rule.peck_clearance
    up = np.nan if rule.peck_return is None else rule.peck_return
    back = np.where(clears, above, up)
    normal = np.where(part == 0, depth, depth + back)
    end[at, 2] = np.where(clears & (part == 1), top, normal)
    end[at, :2] = holes.at[hole]
    kind[at] = np.where(part == 0, Kind.LINE, Kind.RAPID)


def _events(holes: Holes, rule: CycleRule, first: Ints) -> Iterator[Event]:
    """Yield what is done after steps; `first` are the rows of the first steps of holes."""
    for code in distinct(holes.code).tolist():
        chosen = np.flatnonzero(holes.code == code)
        values = (first, holes.dwell, holes.spindle, holes.line)
        columns = [column[chosen].tolist() for column in values]
        for number, step in enumerate(rule.cycles[code].steps):
            for row, dwell, spindle, line in zip(*columns, strict=True) if step.then else ():
                for what in step.then:
                    timed = (("seconds", dwell),) if what == DWELL else ()
                    name = ("M3" if spindle > 0 else "M4") if what == RESUME else what
                    yield Event(row + number + 1, name, timed, line)


def pecks_of(top: Floats, bottom: Floats, peck: Floats) -> Ints:
    """Return in how many pecks holes are drilled, at least one; lengths in the program's unit.

    A control takes a peck off the depth again and again until it is at the bottom or below. Where
    the depth is a multiple of the peck the rounding of these sums decides whether a last, empty
    peck is made, so there they are repeated.
    """
    ratio = np.maximum((top - bottom) / peck, 0.0)
    count = np.maximum(np.ceil(ratio), 1).astype(np.int64)
    near = np.abs(ratio - np.round(ratio)) < SAME_DEPTH * np.maximum(ratio, 1.0)
    doubtful = np.flatnonzero(near & (ratio > 0.5))
    if len(doubtful):
        columns = np.stack([top, bottom, peck])[:, doubtful]
        kinds, which = np.unique(columns, axis=1, return_inverse=True)
        counts = np.array([_counted(*one) for one in kinds.T.tolist()], np.int64)
        count[doubtful] = counts[which.reshape(-1)]
    return count


def _counted(top: float, bottom: float, peck: float) -> int:
    """Return the number of pecks by taking them off one after the other."""
    steps = np.full(round((top - bottom) / peck) + 2, -peck)
    steps[0] = top
    return int(np.count_nonzero(np.add.accumulate(steps)[1:] > bottom)) + 1
