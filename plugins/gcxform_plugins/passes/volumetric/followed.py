"""Where the control follows the tip (TRAORI, M128): tips of a path as positions of axes, and back.

In rows that follow, X, Y and Z are those of the tip, and the control moves its axes to where its
kinematics bring it there (`gcxform/machine/chain.py`). The error is a function of the axes. So what
is compensated are positions of the axes, at the angles of the program, and what is written are the
tips which they stand for. With all rotary axes at 0 both are the same numbers.

Refused is what `rtcp` refuses for the same reasons: angles, tools and work offsets that are not
known, switches beside moves, and ways round that a control chooses. Arcs and cycles are moves of
their own, which a turned tip does not make in the planes of the machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.rtcp.place import TURN_BACK, Place, check_upright, turned_at
from gcxform_plugins.passes.rtcp.switches import Switches

STILL = 1e-9  # degrees; an axis that turns by less stands still


@dataclass(frozen=True)
class Followed:
    """The rows of a path in which the control follows the tip, and which of them count.

    path   of tips in these rows
    rows   (k,) the rows that follow with an axis turned, or turning
    place  where the chain is for these, in their order; None where there are none
    """

    path: gx.Toolpath
    context: gx.PassContext
    rows: Ints
    place: Place | None

    @classmethod
    def of(cls, path: gx.Toolpath, context: gx.PassContext) -> Followed:
        """Return those of a path. Raises InputError where something about them is not known."""
        following = np.array([frame.following is True for frame in path.frames])[path.frame]
        if context.keeps_tips:
            _check_switches(path, context)
        if not context.keeps_tips or not following.any():
            return cls(path, context, np.empty(0, np.int64), None)
        _check_machine(path, context, following)
        _check_known(path, context, following)
        first, last = _angles(path, context, path.start), _angles(path, context, path.end)
        turned = turned_at(first) | turned_at(last) | ~(np.abs(last - first) < STILL).all(axis=1)
        rows = np.flatnonzero(following & turned)
        if not len(rows):
            return cls(path, context, rows, None)
        return cls(path, context, rows, Place(path.take(rows), context))

    # --- tips and axes ---

    def axes(self) -> gx.Toolpath:
        """Return the path of the axes, the same in all else."""
        return self._changed(True)

    def tips(self) -> gx.Toolpath:
        """Return the path of the tips for one of axes: `path` was made of tips, and compensated."""
        return self._changed(False)

    def _changed(self, to_axes: bool) -> gx.Toolpath:
        path, place = self.path, self.place
        if place is None:
            return path
        each = np.arange(len(self.rows))
        change = place.axes_of if to_axes else place.tips_of
        end = path.end.copy(order="F")
        mine = end[self.rows]
        end[self.rows, :3] = change(mine[:, :3], place.angles(mine), each)
        new = path.replace(end=end)
        if self.rows[0] != 0:
            return new
        entry = path.entry[None, :].copy()
        entry[:, :3] = change(entry[:, :3], place.angles(entry), each[:1])
        held = None if path.held is None else path.held[None, :].copy()
        if held is not None:
            held[:, :3] = change(held[:, :3], place.angles(held), each[:1])
        return new.replace(entry=entry[0], held=None if held is None else held[0])

    @cached_property
    def turning(self) -> Flags:
        """(k,) Of `rows` those that are lines along which axes turn, from a known place."""
        assert self.place is not None
        path, rows = self.path, self.rows
        step = np.abs(self.place.angles(path.end[rows] - path.start[rows]))
        line = (path.kind[rows] == gx.Kind.LINE) & path.starts_known[rows]
        return np.asarray(line & (np.nan_to_num(step) >= STILL).any(axis=1))

    def axes_at(self, which: Ints, part: Floats) -> Floats:
        """Return the axes (n, 3) at parts of some of `rows`, `which` by their numbers, of tips."""
        assert self.place is not None
        path, rows = self.path, self.rows[which]
        start, end = path.start[rows], path.end[rows]
        here = np.where((part == 1.0)[:, None], end, start + part[:, None] * (end - start))
        return self.place.axes_of(here[:, :3], self.place.angles(here), which)

    # --- what is refused ---

    def refuse(self) -> None:
        """Refuse rows of which it is not known how the control makes them. Raises InputError."""
        if self.place is None:
            return
        path, place, rows = self.path, self.place, self.rows
        rapid, form = path.kind[rows] == gx.Kind.RAPID, path.form[rows]
        before, angles = (place.angles(each[rows]) for each in (path.start, path.end))
        step = np.abs(angles - before)
        own = np.isin(form, (gx.Form.HOME, gx.Form.MACHINE))
        message = "a move in machine coordinates, where axes are turned"
        self._refuse("GX330", own, message, TURN_BACK)
        last, first = (np.isnan(each[rows, :3]) for each in (path.end, path.start))
        unknown = np.where(rapid, last.any(axis=1) & ~last.all(axis=1), (last | first).any(axis=1))
        message = "where the axes stand is not known here, while the control follows the tip"
        hint = "after a switch with axes turned, name X, Y and Z together in a rapid"
        self._refuse("GX311", unknown, message, hint)
        message = "cutter compensation is in force while the control follows the tip"
        self._refuse("GX330", path.side[rows] != 0, message, TURN_BACK)
        message = "this is no line, and the control follows the tip with axes turned"
        curved = ~np.isin(path.kind[rows], (gx.Kind.LINE, gx.Kind.RAPID))
        self._refuse("GX330", curved, message, gx.put_before("segment"))
        message = "this is no plain move, and the control follows the tip with axes turned"
        self._refuse("GX330", form != gx.Form.PLAIN, message, gx.put_before("cycles"))
        for k, axis in enumerate(place.chain.axes):
            if axis.wrap is not None:
                message = f"{axis.letter} turns by half of its wrap or more, either way round"
                hint = "program a point on the way; or leave out wrap if the axis does not take "
                far = ~rapid & (step[:, k] >= axis.wrap / 2.0)
                self._refuse("GX330", far, message, f"{hint}the shorter way")
        self._refuse_tools(rapid, before)

    def _refuse_tools(self, rapid: Flags, before: Floats) -> None:
        """Refuse another length where axes are turned, but for a rapid, and none at all."""
        assert self.place is not None
        path, rows = self.path, self.rows
        tools = np.array([frame.tool for frame in path.frames])[path.frame]
        other = np.append(False, (np.abs(np.diff(tools, axis=0)) > STILL).any(axis=1))
        message = "the tool length changes where the axes are turned"
        hint = "call the tool length while the rotary axes are at 0"
        lost = np.isnan(path.start[rows, :3]).all(axis=1)
        leaps = rapid & (lost | (not self.context.source.tip_rule.codes))
        self._refuse("GX330", other[rows] & turned_at(before) & ~leaps, message, hint)
        message = "no tool length is in force, and the control follows the tip"
        hint = "call it before the control follows the tip, clear of the part"
        self._refuse("GX330", ~self.place.called, message, hint)

    def _refuse(self, code: str, where: Flags, message: str, hint: str | gx.Hint) -> None:
        if where.any():
            raise self.path.refuse(code, self.rows[where][:1], message, hint)


def _check_switches(path: gx.Toolpath, context: gx.PassContext) -> None:
    """Refuse codes that follow the tip, or leave it, beside moves.

    Axes turned before the first of them are refused by who reads the program.
    """
    machine = context.machine
    known = machine is not None and bool(machine.table + machine.head)
    if known and any(frame.following is not None for frame in path.frames):
        Switches(path, context).refuse_company()


def _check_machine(path: gx.Toolpath, context: gx.PassContext, following: Flags) -> None:
    """Refuse a machine of which it is not known where its rotary axes are."""
    machine = context.machine
    if machine is None or not machine.table + machine.head:
        message = "the control follows the tip, and where the rotary axes are is not known"
        hint = 'a machine file with `kinematics`, or `table` and `head`: file = "..." in [machine]'
        raise path.refuse("GX330", np.flatnonzero(following)[:1], message, hint)
    offset = machine.work_offsets.get(path.first, {})
    check_upright(path, offset, machine.table + machine.head, np.flatnonzero(following)[:1])


def _check_known(path: gx.Toolpath, context: gx.PassContext, following: Flags) -> None:
    """Refuse rows that follow with an axis at an angle that is not known."""
    last, first = _angles(path, context, path.end), _angles(path, context, path.start)
    cuts = path.kind != gx.Kind.RAPID
    unknown = np.isnan(last).any(axis=1) | (cuts & np.isnan(first).any(axis=1))
    rows = np.flatnonzero(following & unknown)[:1]
    if len(rows):
        assert context.machine is not None
        named = " and ".join(context.machine.table + context.machine.head)
        message = "the control follows the tip, and where the rotary axes stand is not known"
        raise path.refuse("GX311", rows, message, f"program {named} before")


def _angles(path: gx.Toolpath, context: gx.PassContext, positions: Floats) -> Floats:
    """Return the angles (n, m) of positions, nan of axes that the path does not have."""
    assert context.machine is not None
    letters = context.machine.table + context.machine.head
    unknown = np.full(len(positions), np.nan)
    axes = path.axes
    return np.stack(
        [positions[:, axes.index(a)] if a in axes else unknown for a in letters], axis=1
    )
