"""Stretches of calls of canned cycles: the words that stay in force, levels and positions.

A stretch is followed as soon as it is read, because where it ends decides where the next begins.
All that follows from its columns is done later, for many stretches at once: they are `joined`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, fields, replace
from itertools import pairwise
from typing import Any

import numpy as np

from gcxform.dialect.cycle_rule import CycleRule
from gcxform.modal.columns import fill
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.columns import constant
from gcxform.toolpath.path import Plane
from gcxform.values import dataclass

STICKY = ("r", "normal", "p", "q", "i", "j", "k")
SCALARS = ("position", "plane", "unit")


@dataclass(frozen=True, slots=True)
class Calls:
    """The blocks of one stretch; words are nan where there is none, lengths are mm.

    code         (n,) the cycle in force: 81 is G81
    first, second, normal   (n,) axis words, by the plane's axes (`Plane.axes`)
    r, q         (n,) R and Q
    p            (n,) P in seconds
    repeats      (n,) L or K
    i, j, k      (n,) I, J, K; where the control takes them as distances along X, Y, Z
    incremental  (n,) G91
    initial      (n,) G98: back to the initial level; otherwise (G99) to R
    spindle      (n,) how it turns: +1, -1, 0, or `UNKNOWN`
    turned       (n,) whether there are words of rotary axes, and the control turns them
    other_axes   (n,) whether there are words of other axes that it does not take
    inverse      (n,) G93
    lost         (n,) whether an axis of the plane is named whose value only the machine knows
    line         (n,) of the program, from 0
    position     (3,) first, second, normal before the stretch; nan where unknown
    plane        the plane of all of them
    unit         mm per unit of the program: 1 or 25.4
    """

    code: Ints
    first: Floats
    second: Floats
    normal: Floats
    r: Floats
    q: Floats
    p: Floats
    repeats: Floats
    i: Floats
    j: Floats
    k: Floats
    incremental: Flags
    initial: Flags
    spindle: Ints
    turned: Flags
    other_axes: Flags
    inverse: Flags
    lost: Flags
    line: Ints
    position: Floats
    plane: Plane = Plane.XY
    unit: float = 1.0

    def __len__(self) -> int:
        return len(self.code)


@dataclass(frozen=True, slots=True)
class Mode:
    """What stays in force between stretches; `code` 0: no cycle is in force."""

    code: int = 0
    initial: float = np.nan
    words: dict[str, float] = field(default_factory=lambda: dict.fromkeys(STICKY, np.nan))
    incremental: dict[str, bool] = field(default_factory=dict)
    plane: Plane = Plane.XY
    unit: float = 1.0
    dwell: float = 0.0


@dataclass(frozen=True, slots=True)
class Stretch:
    """The columns (n,) of a stretch, or of several of one plane and unit; lengths are mm.

    calls          its blocks
    words          the words in force, by name
    in_g91         whether the words of R and the normal axis in force were given in G91
    dwell          s
    initial        the initial level
    repeats        how often
    has_axes       whether there is an axis word
    drilled        whether it drills
    clearance, bottom, retract   levels: R, the bottom, where the cycle ends
    rises, level   whether the tool rises to R before it goes to the hole, and where it arrives
    start, after   (n, 2) and (n, 3) where the tool is before and after
    increment      (n, 2) by how much repeats are apart
    other_unit, other_plane   whether these have changed while a cycle was in force
    """

    calls: Calls
    words: dict[str, Floats]
    in_g91: dict[str, Flags]
    dwell: Floats
    initial: Floats
    repeats: Floats
    has_axes: Flags
    drilled: Flags
    clearance: Floats
    bottom: Floats
    retract: Floats
    rises: Flags
    level: Floats
    start: Floats
    after: Floats
    increment: Floats
    other_unit: Flags
    other_plane: Flags

    def mode_after(self) -> Mode:
        """Return what stays in force after the stretch."""
        return Mode(
            int(self.calls.code[-1]),
            float(self.initial[-1]),
            {name: float(column[-1]) for name, column in self.words.items()},
            {name: bool(column[-1]) for name, column in self.in_g91.items()},
            self.calls.plane,
            self.calls.unit,
            float(self.dwell[-1]),
        )


def steps_of(calls: Calls, in_g91: Mapping[str, Flags], rule: CycleRule) -> Mapping[str, Flags]:
    """Return, by name, where R counts from the level before the cycle, and Z from R.

    `in_g91` is as in `Stretch`.
    """
    return in_g91 if rule.stays.levels else dict.fromkeys(in_g91, calls.incremental)


def joined(stretches: Sequence[Stretch]) -> Stretch:
    """Return stretches of one plane and unit as one, for all that goes by columns."""
    if len(stretches) == 1:
        return stretches[0]
    calls = [stretch.calls for stretch in stretches]
    columns: dict[str, Any] = {
        f.name: np.concatenate([getattr(some, f.name) for some in calls])
        for f in fields(Calls)
        if f.name not in SCALARS
    }
    rest: dict[str, Any] = {"calls": replace(calls[0], **columns)}
    for name in ("words", "in_g91"):
        kept = [getattr(stretch, name) for stretch in stretches]
        rest[name] = {key: np.concatenate([some[key] for some in kept]) for key in kept[0]}
    for f in fields(Stretch):
        if f.name not in rest:
            rest[f.name] = np.concatenate([getattr(stretch, f.name) for stretch in stretches])
    return Stretch(**rest)


def follow(calls: Calls, rule: CycleRule, mode: Mode) -> Stretch:
    """Return the columns of a stretch, given what stays in force from before."""
    first = np.zeros(min(1, len(calls)), np.int64)
    dwells = np.array([mode.dwell])
    return _Follower(calls, rule, mode, first, calls.position[None, :], dwells).stretch()


def follow_fresh(
    calls: Calls, rule: CycleRule, starts: Ints, positions: Floats, dwells: Floats
) -> Stretch:
    """Return the columns of stretches before each of which no cycle is in force.

    `starts` (m,) are their first calls, `positions` (m, 3) where the tool is before each: first,
    second, normal; `dwells` (m,) are those in force before each, s.
    """
    return _Follower(calls, rule, Mode(), starts, positions, dwells).stretch()


class _Follower:
    """Fills in the columns of stretches, which begin at the calls `starts`."""

    def __init__(
        self,
        calls: Calls,
        rule: CycleRule,
        mode: Mode,
        starts: Ints,
        positions: Floats,
        dwells: Floats,
    ) -> None:
        self.calls, self.rule, self.mode = calls, rule, mode
        self.starts, self.positions, self.dwells = starts, positions, dwells
        self.many = len(starts) > 1
        self.fresh: Flags | None = None
        if not rule.stays.words or self.many:
            fresh = calls.code != np.append(mode.code, calls.code[:-1])
            fresh[starts[1:]] = True
            self.fresh = fresh if fresh.any() else None
        lengths = np.diff(np.append(starts, len(calls)))
        levels = np.array([mode.initial]) if mode.code else positions[:, 2]
        self.initial = np.repeat(levels[: len(starts)], lengths)

    def _filled(self, values: Floats, present: Flags, before: Floats) -> Floats:
        """Return a column filled forward; `before` (m,) is what holds before each stretch."""
        if self.many:
            absent = ~present[self.starts]
            values, present = values.copy(), present.copy()
            values[self.starts[absent]] = before[absent]
            present[self.starts] = True
        return np.asarray(fill(values, present, float(before[0])))

    def stretch(self) -> Stretch:
        """Return the columns."""
        calls, mode, rule, count = self.calls, self.mode, self.rule, len(self.calls)
        words = {name: self._kept(name) for name in STICKY}
        repeats = np.where(np.isnan(calls.repeats), 1.0, calls.repeats)
        absent = np.isnan(calls.first) & np.isnan(calls.second) & np.isnan(calls.normal)
        has_axes = ~absent | calls.lost | calls.turned
        wanted = has_axes | ~np.isnan(calls.r) if rule.stores else has_axes
        drilled = wanted & (repeats > 0)
        clearance, bottom = words["r"], words["normal"]
        in_g91 = {name: self._incremental(name) for name in ("r", "normal")}
        by_steps = steps_of(calls, in_g91, rule)
        if by_steps["r"].any() or by_steps["normal"].any():
            clearance = clearance + np.where(by_steps["r"], self.initial, 0.0)
            bottom = bottom + np.where(by_steps["normal"], clearance, 0.0)
        high = np.maximum(self.initial, clearance)
        retract = np.where(calls.initial, high, clearance)
        ends = self._filled(retract, drilled, self.positions[:, 2])
        rises, level = self._arrival(clearance, self._before(ends, self.positions[:, 2]))
        start, after, increment = self._positions(drilled, repeats, ends)
        return Stretch(
            calls,
            words,
            in_g91,
            self._dwell(words["p"]),
            self.initial,
            repeats,
            has_axes,
            drilled,
            clearance,
            bottom,
            retract,
            rises,
            level,
            start,
            after,
            increment,
            constant(bool(mode.code) and mode.unit != calls.unit, count, np.bool_),
            constant(bool(mode.code) and mode.plane != calls.plane, count, np.bool_),
        )

    def _before(self, after: Floats, first: Floats) -> Floats:
        """Return what holds before each call, given what holds after it and before stretches."""
        before = np.empty_like(after)
        before[1:] = after[:-1]
        before[self.starts] = first
        return before

    def _kept(self, name: str) -> Floats:
        """Return a word of each call, or the one that is in force."""
        word, before = getattr(self.calls, name), self.mode.words[name]
        if not word.strides[0]:  # no call of the window has one
            if before != before:
                return np.asarray(word)
            if self.fresh is None:
                return constant(before, len(word))
        present = ~np.isnan(word)
        return fill(word, present if self.fresh is None else present | self.fresh, before)

    def _incremental(self, name: str) -> Flags:
        """Return whether the word in force was given in G91."""
        before = self.mode.incremental.get(name, False)
        if not self.rule.stays.words:
            return constant(before, len(self.calls), np.bool_)
        given = ~np.isnan(getattr(self.calls, name))
        if not self.many:
            return np.asarray(fill(self.calls.incremental, given, before))
        incremental = self.calls.incremental & given
        given[self.starts] = True
        return np.asarray(fill(incremental, given, before))

    def _dwell(self, programmed: Floats) -> Floats:
        """Return how long each call dwells where its cycle does."""
        given = self.calls.p
        if self.rule.stays.dwell:
            return self._filled(given, ~np.isnan(given), self.dwells)
        return np.where(np.isnan(programmed), 0.0, programmed)

    def _arrival(self, clearance: Floats, standing: Floats) -> tuple[Flags, Floats]:
        """Return whether the tool rises before it goes to its hole, and where it arrives there."""
        if not self.rule.rises_first:
            return constant(False, len(self.calls), np.bool_), standing
        rises = self.initial < clearance
        low = np.where(self.calls.initial, self.initial, clearance)
        level = np.where(standing > clearance, standing, low)
        return rises, np.where(rises, clearance, level)

    def _summed(self, steps: Floats) -> Floats:
        """Return the sums of steps since the beginning of each stretch."""
        if not self.many:
            return np.cumsum(steps)
        for first, last in pairwise([*self.starts.tolist(), len(steps)]):
            np.cumsum(steps[first:last], out=steps[first:last])
        return steps

    def _positions(
        self, drilled: Flags, repeats: Floats, ends: Floats
    ) -> tuple[Floats, Floats, Floats]:
        """Return where calls start and end; increments are made once for every repeat."""
        calls, count = self.calls, len(self.calls)
        after, start = np.empty((3, count)).T, np.empty((2, count)).T
        increment = np.zeros((count, 2))
        steps = drilled & calls.incremental
        any_steps = steps.any()
        for axis, word in enumerate((calls.first, calls.second)):
            present, before = drilled & ~np.isnan(word), self.positions[:, axis]
            if any_steps:
                stepping = present & steps
                moved = self._summed(np.where(stepping, word * repeats, 0.0))
                placed = present & ~stepping
                base = self._filled(np.where(placed, word - moved, 0.0), placed, before)
                after[:, axis] = base + moved
                given = calls.incremental & ~np.isnan(word)
                increment[:, axis] = np.where(given, word, 0.0)
            else:
                after[:, axis] = self._filled(word, present, before)
            start[:, axis] = self._before(after[:, axis], before)
        after[:, 2] = ends
        return start, after, increment
