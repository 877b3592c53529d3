"""Canned cycles as the moves that the control makes of them.

A stretch is a run of blocks in cycle mode between which nothing else moves, all in one plane and
one unit. `Cycles` fills in the words that stay in force, finds the levels of every hole and what
speaks against it, and hands the holes to `steps.py`. Levels do not depend on the hole before, so
that all of this is done on whole columns. What stays in force is carried to the next stretch.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from gcxform.dialect.cycle_rule import CycleRule, Level
from gcxform.modal.cycles.checks import MOST, UNKNOWN, Checks, Refusal
from gcxform.modal.cycles.steps import Holes, Rows, pecks_of, rows_of
from gcxform.modal.cycles.stretch import (
    Calls,
    Mode,
    Stretch,
    follow,
    follow_fresh,
    joined,
    steps_of,
)
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.values import dataclass

__all__ = ["MOST", "UNKNOWN", "Calls", "Cycles", "Refusal", "Steps"]

DIGITS = 10  # behind the point, more than numbers of programs have


@dataclass(frozen=True, slots=True)
class Steps:
    """What a stretch becomes.

    rows      the moves; calls that are refused have none
    after     (n, 3) where the control takes the tool to be after each call: first, second, normal.
              That is where the last move ended, but for G88, out of which the operator moves it
    refusals  what speaks against calls, in their order
    """

    rows: Rows
    after: Floats
    refusals: tuple[Refusal, ...]


class Cycles:
    """Expands the stretches of one program in order. `mode` is immutable, so a copy is cheap.

    `zero` is from where levels counted in the last stretch. `peck_return` and `peck_clearance` (mm)
    are for controls in which they are parameters; with `open_pecks` what they leave open is nan.
    With `open_ways` a cycle is read of which is refused how the tool gets out of the hole.
    """

    def __init__(
        self,
        rule: CycleRule,
        peck_return: float | None = None,
        peck_clearance: float | None = None,
        open_pecks: bool = False,
        open_ways: bool = False,
    ) -> None:
        self.rule = replace(
            rule,
            peck_return=rule.peck_return if peck_return is None else peck_return,
            peck_clearance=rule.peck_clearance if peck_clearance is None else peck_clearance,
        )
        self.open_pecks, self.open_ways = open_pecks, open_ways
        self.mode = Mode()
        self.zero: object = None

    def leave(self) -> None:
        """Forget what stays in force: a block has ended cycle mode."""
        if self.mode.code:
            self.mode = Mode(dwell=self.mode.dwell)

    def follow(self, calls: Calls) -> Stretch:
        """Read a stretch, and take over what stays in force after it."""
        stretch = follow(calls, self.rule, self.mode)
        if len(calls):
            self.mode = stretch.mode_after()
        return stretch

    def follow_fresh(
        self, calls: Calls, starts: Ints, positions: Floats, dwells: Floats
    ) -> Stretch:
        """Read stretches before and after each of which no cycle is in force."""
        return follow_fresh(calls, self.rule, starts, positions, dwells)

    def steps(self, stretches: Sequence[Stretch]) -> Steps:
        """Return the moves of stretches of one plane and unit, and what speaks against them."""
        stretch = joined(stretches)
        pecks = _pecks(stretch, self.rule)
        checks = Checks(stretch, self.rule, pecks, self.open_pecks, self.open_ways)
        refusals, wrong = checks.refusals()
        holes = holes_of(stretch, stretch.drilled & ~wrong, pecks)
        return Steps(rows_of(holes, self.rule), stretch.after, refusals)

    def expand(self, calls: Calls) -> Steps:
        """Return the moves of a stretch, and what speaks against it."""
        return self.steps([self.follow(calls)])


def _pecks(stretch: Stretch, rule: CycleRule) -> Ints:
    """Return in how many pecks the holes of each call are drilled."""
    calls, pecks = stretch.calls, np.ones(len(stretch.calls), np.int64)

    def programmed(lengths: Floats) -> Floats:
        """Return lengths in mm as the numbers of the program that they were."""
        return lengths if calls.unit == 1.0 else np.asarray(np.round(lengths / calls.unit, DIGITS))

    pecking = np.isin(calls.code, [code for code, cycle in rule.cycles.items() if cycle.pecks])
    if not pecking.any():
        return pecks
    quantity = programmed(stretch.words["q"])
    start = programmed(stretch.initial)
    by_steps = steps_of(calls, stretch.in_g91, rule)
    top = programmed(stretch.words["r"]) + np.where(by_steps["r"], start, 0.0)
    bottom = programmed(stretch.words["normal"]) + np.where(by_steps["normal"], top, 0.0)
    possible = pecking & (quantity > 0)
    few = possible & (top - bottom < MOST * quantity)
    pecks[possible] = MOST
    pecks[few] = pecks_of(top[few], bottom[few], quantity[few])
    return pecks


def holes_of(stretch: Stretch, drilled: Flags, pecks: Ints) -> Holes:
    """Return the holes of the calls that drill any, repeats one after the other."""
    calls = stretch.calls
    count = np.where(drilled, stretch.repeats, 0.0).astype(np.int64)
    call = np.repeat(np.arange(len(calls)), count)
    number = np.arange(len(call)) - (np.cumsum(count) - count)[call]
    left = (count[call] - 1 - number).astype(np.float64)
    at = stretch.after[call, :2] - stretch.increment[call] * left[:, None]
    middle = stretch.words["ijk"[calls.plane.axes[2]]]
    middle = middle + np.where(calls.incremental, stretch.bottom, 0.0)
    levels = np.stack([stretch.bottom, middle, stretch.clearance, stretch.retract], axis=1)
    assert len(Level) == levels.shape[1]
    shift = [stretch.words["ijk"[axis]] for axis in calls.plane.axes[:2]]
    return Holes(
        call,
        number,
        calls.code[call],
        at,
        stretch.start[call],
        stretch.rises[call] & (number == 0),
        np.where(number == 0, stretch.level[call], stretch.retract[call]),
        levels[call],
        np.stack(shift, axis=1)[call],
        stretch.words["q"][call],
        pecks[call],
        stretch.dwell[call],
        calls.spindle[call],
        calls.line[call],
    )
