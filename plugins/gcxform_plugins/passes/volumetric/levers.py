"""Where the tip is on the arm of a turned head, for `volumetric`.

Angular errors act on the way from the gauge point to the tip, and the head turns that way. It is a
function of the angles alone, which go in proportion along a move; so it goes along arcs, and the
error between two points of a line is no longer what the error model alone makes of it.

Where no head is turned in a window there is no lever, and nothing of this is computed. Refused are
arcs along which the head turns, cuts without a tool length, cuts at angles that are not known, and
feeds per minute where the linear axes move by little more than the correction: the control would
measure the feed along that.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

UNKNOWN = "where the tip is on the turned head is not known: "


@dataclass(frozen=True)
class Lever:
    """The ways from the gauge point to the tip, in the directions of X, Y and Z.

    `head` are the rotary axes from the base to the spindle and `gauge` (3,) is the gauge point, mm,
    both with all axes at 0; `held` (n, 3) mm are the ways of the rows with the head at 0; `begin`
    and `stop` (n, m) degrees are the angles at both ends of the rows.
    """

    head: tuple[gx.Rotary, ...]
    gauge: Floats
    held: Floats
    begin: Floats
    stop: Floats

    def at(self, rows: Ints, part: Floats) -> Floats:
        """Return the ways (n, 3) in mm at parts of rows."""
        begin, stop = self.begin[rows], self.stop[rows]
        share = part[:, None]
        return self._turned(
            self.held[rows], np.where(share == 1.0, stop, begin + share * (stop - begin))
        )

    @cached_property
    def ends(self) -> Floats:
        """The ways (n, 3) in mm at the ends of all rows."""
        return self._turned(self.held, self.stop)

    @cached_property
    def starts(self) -> Floats:
        """The ways (n, 3) in mm at the starts of all rows."""
        return self._turned(self.held, self.begin)

    def _turned(self, held: Floats, angles: Floats) -> Floats:
        """Return ways as the head carries them; where nothing is turned they stay as they are."""
        points = held + self.gauge
        for k, axis in reversed([*enumerate(self.head)]):
            points = axis.turn(points, angles[:, k])
        return np.where((angles != 0.0).any(axis=1)[:, None], points - self.gauge, held)


def lever_of(path: gx.Toolpath, context: gx.PassContext, held: Floats) -> Lever | None:
    """Return the levers of a path on the machine, or None where no head is turned in it.

    `held` (n, 3) mm are the ways from the gauge point to the tip with the head at 0. Raises
    InputError where they are not known, or the head turns while it goes along an arc.
    """
    machine = context.machine
    assert machine is not None
    check_known(path, machine.head)
    begin, stop = (_angles(path, context, ends) for ends in (_before(path), path.end))
    turned = (begin != 0.0).any(axis=1) | (stop != 0.0).any(axis=1)
    if not turned.any():
        return None
    _check_chain(path, context, turned)
    _check_tools(path, turned)
    _check_angles(path, machine.head, turned)
    turning = (begin != stop).any(axis=1)
    if (turning & path.is_arc).any():
        message = "the head turns along an arc, and the error depends on where the tip is"
        rows = np.flatnonzero(turning & path.is_arc)[:1]
        raise path.refuse("GX314", rows, message, gx.put_before("segment"))
    head = gx.chain_of(machine).head
    return Lever(head, np.array(machine.gauge_point), held, begin, stop)


def _before(path: gx.Toolpath) -> Floats:
    """Return the positions (n, axes) before the rows, those that are lost there included."""
    return np.asarray(np.vstack([path.entry, path.end[:-1]]))


def _angles(path: gx.Toolpath, context: gx.PassContext, positions: Floats) -> Floats:
    """Return the angles (n, m) of the head in degrees, 0 where they are not known."""
    machine = context.machine
    assert machine is not None
    offset = machine.work_offsets[path.first]
    found = np.zeros((len(positions), len(machine.head)))
    for k, letter in enumerate(machine.head):
        if letter in path.axes:
            column = positions[:, path.axes.index(letter)] + offset.get(letter, 0.0)
            found[:, k] = np.nan_to_num(column)
    return found


# --- what is refused ---


def check_known(path: gx.Toolpath, head: tuple[str, ...]) -> None:
    """Refuse cuts where an angle of the head is not known: that it is at 0 nothing says."""
    cuts = path.kind != gx.Kind.RAPID
    for letter in head:
        rows = np.flatnonzero(cuts & _unknown(path, letter))[:1]
        if len(rows):
            message = f"{UNKNOWN}the angle of {letter} is not"
            raise path.refuse("GX314", rows, message, f"program {letter} before")


def _unknown(path: gx.Toolpath, letter: str) -> Flags:
    """Return in which rows (n,) the angle of an axis of the head is not known."""
    if letter not in path.axes:
        return np.ones(len(path), np.bool_)
    column = path.axes.index(letter)
    from_nowhere = np.isnan(path.start[:, column]) & (path.kind != gx.Kind.RAPID)
    return np.asarray(np.isnan(path.end[:, column]) | from_nowhere)


def _check_chain(path: gx.Toolpath, context: gx.PassContext, turned: Flags) -> None:
    """Refuse a head of which no angle is known, and axes that the machine has not."""
    machine = context.machine
    assert machine is not None
    own, first = machine.table + machine.head, np.flatnonzero(turned)[:1]
    for letter in machine.head:
        if letter not in path.axes:
            message = f"{UNKNOWN}the angle of {letter} is not"
            raise path.refuse("GX314", first, message, f"program {letter} before")
    for column, letter in enumerate(path.axes):
        moved = np.nan_to_num(path.end[:, column]) != 0.0
        if letter not in ("X", "Y", "Z", *own) and moved.any():
            message = f"{UNKNOWN}the machine file has no axis {letter}"
            raise path.refuse("GX314", np.flatnonzero(moved)[:1], message, "add it there")


def _check_tools(path: gx.Toolpath, turned: Flags) -> None:
    """Refuse cuts with a turned head and without a tool length."""
    known = [frame.called and bool(np.isfinite(frame.tool).all()) for frame in path.frames]
    bare = ~np.array(known)
    rows = np.flatnonzero(turned & bare[path.frame] & (path.kind != gx.Kind.RAPID))
    if len(rows):
        message = f"{UNKNOWN}no tool length is in force"
        raise path.refuse(
            "GX314",
            rows[:1],
            message,
            "put G43 with the tool before, while it is clear of the part",
        )


def _check_angles(path: gx.Toolpath, head: tuple[str, ...], turned: Flags) -> None:
    """Refuse angles that are not known, or count from elsewhere, where the head is turned."""
    for letter in head:
        column = path.axes.index(letter)
        unknown = _unknown(path, letter)
        apart = np.array([frame.origin[column] != path.first for frame in path.frames])
        rows = np.flatnonzero(turned & (unknown | apart[path.frame]))
        if len(rows):
            message = f"{UNKNOWN}the angle of {letter} is not"
            raise path.refuse("GX314", rows[:1], message, f"program {letter} before")
