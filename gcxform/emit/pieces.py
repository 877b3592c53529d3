"""Lines become pieces: one for each row of the path, one for each block that does not move.

What each of them has to state is settled after that (`gcxform/emit/needed_modes.py`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect.cycle_rule import TAPPING
from gcxform.emit.corners import standing_corners
from gcxform.emit.fields import Role
from gcxform.emit.manner import Task
from gcxform.emit.own_blocks import over_holes, own_blocks
from gcxform.emit.tapping import Taps
from gcxform.emit.taps_in_step import TapsInStep
from gcxform.modal.meaning.tables import NURBS, NURBS_END, TAP
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import one_of
from gcxform.toolpath.path import Event, Form, Given
from gcxform.values import dataclass

Said = tuple[object, ...]

Around = Callable[[Flags], tuple[list[Event], list[Event]]]
"""What stands before and behind the moves of lines whose cycles are expanded."""
PLACES = (Form.HOME, Form.MACHINE)
"""Forms whose axis words may be converted where they stand."""


STORED = frozenset("RZPQ")
"""Words of which a cycle remembers what they say, by a block that drills nothing (K0)."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """The pieces of a window, in order.

    count     (live,) rows of each line
    expanded_line
              (live,) whether it calls a cycle, or has a control point of a spline of weights and
              knots, and is written as plain moves
    corner    (live,) whether it is written as it stands, because of a corner
    line      (pieces,) line of the window
    row       (pieces,) row of the path; only where `has_row`
    event     (pieces,) index into `events`, one of each kind, -1 for none: what a cycle does
              between its moves, blocks that the user gives, of which some are moves, and path
              modes around expanded cycles; what stands before one does not lead its line
    leads, ends
              (pieces,) whether it is the first piece of its line, or stands last in it
    role      (pieces,) `Role`
    special   (pieces,) whether it stands for all moves of a block that is written as it stands
    converted (pieces,) whether such a block, to a place of the machine, is written in another unit
    homed     (pieces,) whether it goes to a point of the machine by other words than those it has
    tap_code  (pieces,) the code of a tap that another code says, else -1; `pace`: its K or F
    tap       (pieces,) whether it is a canned cycle whose ends have moved; `apart`: one of several
              into which its repeats are taken apart
    """

    count: Ints
    expanded_line: Flags
    corner: Flags
    events: list[Event | Given]
    line: Ints
    row: Ints
    event: Ints
    has_row: Flags
    leads: Flags
    ends: Flags
    role: Small
    special: Flags
    converted: Flags
    homed: Flags
    pace: Floats
    tap_code: Small
    tap: Flags
    apart: Flags

    def of_rows(self, values: NDArray[Any], absent: object) -> NDArray[Any]:
        """Return a column over the rows as one over the pieces."""
        return _at_pieces(values, absent, self.row, self.has_row)


def pieces_of(task: Task, taps: Taps, around: Around, in_step: TapsInStep) -> Pieces:
    """Return the pieces of a window."""
    path, cycle = task.path, task.read.modes.cycle != CYCLE_OFF
    count = np.bincount(path.block, minlength=task.read.live)
    corner = standing_corners(task)
    special = _special(task, taps, in_step.rows) | _stored(task, cycle & (count == 0)) | corner
    expanded = cycle & ~special & ~taps.lines & ~_stores_taps(task, count) & _in_moves(task)
    opens, closes = around(expanded)
    over = over_holes(task, expanded)
    before, behind = own_blocks(task, count, expanded)
    expanded |= _of_nurbs(task)
    both = in_step.around()
    before, behind = [*before, *both[0]], [*both[1], *behind]
    inner = _between_moves(task, expanded & ~in_step.lines)
    between = [*opens, *before, *over, *inner, *closes, *behind]
    moves = [given for given in path.given if given.moves]
    events = {_said(each): each for each in reversed([*between, *moves])}
    number = {said: n for n, said in enumerate(events)}
    line, row, event = _in_order(task, taps, special, between, number)
    if in_step.out.any():
        stays = ~_at_pieces(in_step.out, False, row, (count[line] > 0) & (event < 0))
        line, row, event = line[stays], row[stays], event[stays]
    has_row = (count[line] > 0) & (event < 0)
    for given in moves:
        event[has_row & (row == given.row)] = number[_said(given)]
    first, ends = _first_of(line), _first_of(line[::-1])[::-1]
    opening = first & _is_one_of(event, [*opens, *before, *over], number)
    closing = ends & _is_one_of(event, [*closes, *behind], number)
    leads = (first & ~opening) | np.roll(opening, 1)
    last = (ends & ~closing) | np.roll(closing, -1)
    role = _roles(has_row, leads, last)
    if path.joined:
        role[_gone(task, count)[line]] = Role.GONE
    role[special[line]] = Role.VERBATIM
    role[event >= 0] = Role.EVENT
    places = _at_pieces(one_of(path.form, PLACES), False, row, has_row)
    other_unit = special & (path.blocks.inch != task.read.path.blocks.inch)
    tap = (taps.lines & cycle)[line] | _at_pieces(in_step.code > TAP, False, row, has_row)
    return Pieces(
        count=count,
        expanded_line=expanded,
        corner=corner,
        events=list(events.values()),
        line=line,
        row=row,
        event=event,
        has_row=has_row,
        leads=leads,
        ends=ends,
        role=role,
        special=special[line],
        converted=places & other_unit[line],
        homed=_goes_home(task)[line] & has_row,
        pace=_at_pieces(in_step.pace, np.nan, row, has_row),
        tap_code=_at_pieces(in_step.code, -1, row, has_row),
        tap=tap,
        apart=tap & (taps.count > 1)[line],
    )


def _goes_home(task: Task) -> Flags:
    """Return the lines (live,) that go home, and have become moves in the machine."""
    lines = np.zeros(task.read.live, np.bool_)
    lines[[line for line in task.read.homed]] = True
    lines[task.path.block[task.path.form != Form.PLAIN]] = False
    return lines if task.manner.crossing else np.zeros_like(lines)


def _in_moves(task: Task) -> Flags | bool:
    """Whether the cycles that lines (live,) call, if they do, have become plain moves."""
    foreign = task.manner.foreign_cycles
    if task.manner.expands or not foreign:
        return task.manner.expands
    return np.isin(task.read.modes.cycle, list(foreign))


def _stores_taps(task: Task, count: Ints) -> Flags:
    """Return the lines (live,) at which a cycle of tapping is in force and nothing moves.

    They may say where the taps behind them go (K0), which stay cycles.
    """
    if task.manner.saying.taps_in_step:
        return np.zeros(task.read.live, np.bool_)
    return np.asarray(np.isin(task.read.modes.cycle, list(TAPPING)) & (count == 0))


def _stored(task: Task, idle: Flags) -> Flags:
    """Return the lines (live,) that store by steps where a cycle drills which stays.

    They are written as they stand, or refused. `idle` lines move nothing.
    """
    if task.manner.crossing or task.manner.expands or not idle.any():
        return np.zeros_like(idle)
    says = [not STORED.isdisjoint(meaning.slots) for meaning in task.table.meanings]
    turned = task.path.blocks.incremental != task.read.path.blocks.incremental
    stores = np.array(says, np.bool_)[task.shape[: len(idle)]]
    return np.asarray(idle & turned & stores)


def _of_nurbs(task: Task) -> Flags:
    """Return the lines (live,) of splines of weights and knots that have become lines."""
    points = np.isin(task.read.modes.motion, (NURBS, NURBS_END))
    return points if task.manner.curves else np.zeros_like(points)


def _special(task: Task, taps: Taps, in_step: Flags) -> Flags:
    """Return the lines (live,) that are written as they stand, in one piece."""
    path = task.path
    own = ~path.is_free & ~in_step
    own[[given.row for given in path.given if given.moves]] = False
    special = np.zeros(task.read.live, np.bool_)
    special[path.block[own]] = True
    return special & ~taps.lines


def _between_moves(task: Task, expanded: Flags) -> list[Event | Given]:
    """Return what expanded cycles do between their moves, and what the user gives there."""
    path, acts = task.path, expanded.tolist()
    inner = [e for e in path.events if e.within and acts[e.line - path.blocks.first]]
    return [*inner, *(given for given in path.given if not given.moves)]


def _in_order(
    task: Task,
    taps: Taps,
    special: Flags,
    between: Sequence[Event | Given],
    number: Mapping[Said, int],
) -> tuple[Ints, Ints, Ints]:
    """Return line, row and event (pieces,); what stands between moves has pieces of its own."""
    path, live = task.path, task.read.live
    count = np.bincount(path.block, minlength=live)
    pieces = np.where(special, 1, np.maximum(count, 1))
    pieces = np.where(taps.lines, taps.count, pieces)
    line = np.repeat(np.arange(live), pieces)
    nth = np.arange(len(line)) - (np.cumsum(pieces) - pieces)[line]
    row = (np.cumsum(count) - count)[line] + nth
    row[taps.lines[line]] = taps.rows
    event = np.full(len(line), -1)
    if not between:
        return line, row, event
    all_lines = np.append(line, [each.line - path.blocks.first for each in between])
    order = np.lexsort((np.append(2 * row + 1, [2 * each.row for each in between]), all_lines))
    rows = np.append(row, np.zeros(len(between), np.int64))
    events = np.append(event, [number[_said(each)] for each in between])
    return all_lines[order], rows[order], events[order]


def _first_of(line: Ints) -> Flags:
    """Return which pieces have another line than the one before."""
    return np.append(True, line[1:] != line[:-1])[: len(line)]


def _roles(has_row: Flags, leads: Flags, last: Flags) -> Small:
    """Return which of the pieces of its block each is."""
    role = np.where(has_row, np.int8(Role.MIDDLE), np.int8(Role.NONE))
    role[has_row & leads] = Role.FIRST
    role[has_row & last] = Role.LAST
    role[has_row & leads & last] = Role.ONLY
    return role


def _gone(task: Task, count: Ints) -> Flags:
    """Return the lines whose moves are parts of others', and in which nothing else happens."""
    gone = np.zeros(len(count), np.bool_)
    gone[task.read.path.block] = True
    gone &= ~task.table.flag("has_events", task.shape)
    return np.asarray(gone & (count == 0))


def _at_pieces(values: NDArray[Any], absent: object, row: Ints, has_row: Flags) -> NDArray[Any]:
    """Return a column over the rows as one over the pieces."""
    if has_row.all():
        return np.asarray(values[row])
    column = np.full(len(row), absent, values.dtype)
    column[has_row] = values[row[has_row]]
    return column


def _is_one_of(event: Ints, some: list[Event | Given], number: Mapping[Said, int]) -> Flags:
    """Return which pieces (pieces,) are one of the given things between moves."""
    if not some:
        return np.zeros(len(event), np.bool_)
    return np.isin(event, list({number[_said(each)] for each in some}))


def _said(each: Event | Given) -> Said:
    """Return what is written for something between the moves."""
    return (each.text,) if isinstance(each, Given) else (each.what, each.values)
