"""Canned cycles as the moves that the control makes of them.

A stretch is a run of blocks in cycle mode between which nothing else moves, all in one plane and
one unit. `Cycles` fills in the words that stay in force, finds the levels of every hole and what
speaks against it, and hands the holes to `cyclesteps`. Levels do not depend on the hole before, so
that all of this is done on whole columns. What stays in force is carried to the next stretch.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from gcxform.modal.cyclerule import RESUME, CycleRule, Level
from gcxform.modal.cyclesteps import Holes, Rows, pecks_of, rows_of
from gcxform.modal.lines import fill
from gcxform.toolpath.path import Flags, Floats, Ints, Plane

UNKNOWN = 2
"""How the spindle turns where nobody knows; otherwise +1 (M3), -1 (M4), 0."""
MOST = 100_000  # moves that one block may become
DIGITS = 10  # behind the point, more than numbers of programs have
ENOUGH = 50  # refusals of one kind
STICKY = ("r", "normal", "p", "q", "i", "j", "k")


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
    other_axes   (n,) whether there are words of axes other than X, Y, Z
    inverse      (n,) G93
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
    other_axes: Flags
    inverse: Flags
    line: Ints
    position: Floats
    plane: Plane = Plane.XY
    unit: float = 1.0

    def __len__(self) -> int:
        return len(self.code)


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a call is not expanded: a sentence, and the way out."""

    call: int
    message: str
    hint: str = ""


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


@dataclass(frozen=True, slots=True)
class _Mode:
    """What stays in force between stretches; `code` 0: no cycle is in force."""

    code: int = 0
    initial: float = np.nan
    words: dict[str, float] = field(default_factory=lambda: dict.fromkeys(STICKY, np.nan))
    incremental: dict[str, bool] = field(default_factory=dict)
    plane: Plane = Plane.XY
    unit: float = 1.0
    dwell: float = 0.0


class Cycles:
    """Expands the stretches of one program in order. `mode` is immutable, so a copy is cheap.

    `peck_return` and `peck_clearance` (mm) are for controls in which they are parameters.
    """

    def __init__(
        self,
        rule: CycleRule,
        peck_return: float | None = None,
        peck_clearance: float | None = None,
    ) -> None:
        self.rule = replace(
            rule,
            peck_return=rule.peck_return if peck_return is None else peck_return,
            peck_clearance=rule.peck_clearance if peck_clearance is None else peck_clearance,
        )
        self.mode = _Mode()

    def leave(self) -> None:
        """Forget what stays in force: a block has ended cycle mode."""
        self.mode = _Mode(dwell=self.mode.dwell)

    def expand(self, calls: Calls) -> Steps:
        """Return the moves of a stretch, and what speaks against it."""
        stretch = _Stretch(calls, self.rule, self.mode)
        refusals = stretch.refusals()
        holes = stretch.holes()
        self.mode = stretch.mode_after()
        return Steps(rows_of(holes, self.rule), stretch.after, refusals)


class _Stretch:
    """The columns of one stretch: words with what stays in force, and levels."""

    def __init__(self, calls: Calls, rule: CycleRule, mode: _Mode) -> None:
        self.calls, self.rule, self.mode = calls, rule, mode
        before = np.append(mode.code, calls.code[:-1])
        self.fresh = (calls.code != before) & (not rule.keeps_words)
        self.words = {name: self._kept(name) for name in STICKY}
        self.start_level = float(mode.initial if mode.code else calls.position[2])
        self.repeats = np.where(np.isnan(calls.repeats), 1.0, calls.repeats)
        axes = np.isnan([calls.first, calls.second, calls.normal])
        self.has_axes = np.asarray(~axes.all(axis=0))
        wanted = self.has_axes | (~np.isnan(calls.r) & rule.stores)
        self.drilled = wanted & (self.repeats > 0)
        self._find_levels()
        self._find_positions()
        self.pecks = self._pecks()

    def _kept(self, name: str) -> Floats:
        """Return a word of each call, or the one that is in force."""
        word = getattr(self.calls, name)
        return np.asarray(fill(word, ~np.isnan(word) | self.fresh, self.mode.words[name]))

    def _find_levels(self) -> None:
        """Find R, the bottom, where a cycle ends and where the tool arrives over its hole."""
        calls, initial = self.calls, self.start_level
        self.clearance = self.words["r"] + np.where(calls.incremental, initial, 0.0)
        self.bottom = self.words["normal"] + np.where(calls.incremental, self.clearance, 0.0)
        self.retract = np.where(calls.initial, np.maximum(initial, self.clearance), self.clearance)
        ends = fill(self.retract, self.drilled, float(calls.position[2]))
        standing = np.append(calls.position[2], ends[:-1])
        self.rises: Flags = np.zeros(len(calls), np.bool_)
        self.level: Floats = standing
        if self.rule.rises_first:
            self.rises = initial < self.clearance
            low = np.where(calls.initial, initial, self.clearance)
            level = np.where(standing > self.clearance, standing, low)
            self.level = np.where(self.rises, self.clearance, level)
        self.ends = np.asarray(ends)

    def _find_positions(self) -> None:
        """Find where calls start and end; increments are made once for every repeat."""
        calls, columns = self.calls, []
        for word, before in zip((calls.first, calls.second), calls.position, strict=False):
            present = ~np.isnan(word) & self.drilled
            steps = present & calls.incremental
            placed = present & ~calls.incremental
            moved = np.cumsum(np.where(steps, word * self.repeats, 0.0))
            base = fill(np.where(placed, word - moved, 0.0), placed, float(before))
            columns.append(base + moved)
        self.after = np.stack([*columns, self.ends], axis=1)
        self.start = np.vstack([calls.position[:2], self.after[:-1, :2]])
        words = np.stack([calls.first, calls.second], axis=1)
        increments = ~np.isnan(words) & calls.incremental[:, None]
        self.increment = np.where(increments, words, 0.0)

    def _pecks(self) -> Ints:
        """Return in how many pecks the holes of each call are drilled."""
        calls, pecks = self.calls, np.ones(len(self.calls), np.int64)
        quantity = self._programmed(self.words["q"])
        start = self._programmed(np.full(1, self.start_level))[0]
        top = self._programmed(self.words["r"]) + np.where(calls.incremental, start, 0.0)
        bottom = self._programmed(self.words["normal"]) + np.where(calls.incremental, top, 0.0)
        possible = np.isin(calls.code, list(self.rule.pecks)) & (quantity > 0)
        few = possible & (top - bottom < MOST * quantity)
        pecks[possible] = MOST
        pecks[few] = pecks_of(top[few], bottom[few], quantity[few])
        return pecks

    def _programmed(self, lengths: Floats) -> Floats:
        """Return lengths in mm as the numbers of the program that they were."""
        unit = self.calls.unit
        return lengths if unit == 1.0 else np.asarray(np.round(lengths / unit, DIGITS))

    # --- what speaks against it ---

    def refusals(self) -> tuple[Refusal, ...]:
        """Return what speaks against calls, one thing a call, and take these calls out."""
        found: list[Refusal] = []
        wrong = np.zeros(len(self.calls), np.bool_)
        for which, message, hint in self._objections():
            for call in np.flatnonzero(which & ~wrong)[:ENOUGH].tolist():
                code = f"G{self.calls.code[call]}"
                found.append(Refusal(call, message.format(code=code), hint))
            wrong |= which
        self.drilled &= ~wrong
        return tuple(sorted(found, key=lambda refusal: refusal.call))

    def _objections(self) -> Iterator[tuple[Flags, str, str]]:
        yield from self._about_codes()
        yield from self._about_modes()
        yield from self._about_words()
        yield from self._about_levels()
        yield from self._about_spindle()

    def _with_code(self, codes: list[int]) -> Flags:
        return np.asarray(np.isin(self.calls.code, codes))

    def _listed(self, words: Mapping[int, str], letter: str) -> Flags:
        """Return the calls whose cycle has a letter in a table of words."""
        return self._with_code([code for code, letters in words.items() if letter in letters])

    def _about_codes(self) -> Iterator[tuple[Flags, str, str]]:
        for code, reason in self.rule.refused.items():
            yield self._with_code([code]), f"{{code}} is not expanded: {reason}", ""
        known = self._with_code(list(self.rule.steps))
        yield ~known, "{code} is not a cycle of this control", ""
        if self.calls.plane != Plane.XY:
            for code, reason in self.rule.xy_only.items():
                yield self._with_code([code]), f"{{code}} outside G17: {reason}", ""

    def _about_modes(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule, mode = self.calls, self.rule, self.mode
        every = np.ones(len(calls), np.bool_) & bool(mode.code)
        end = "end the cycle with G80 before, and give all words again"
        changed = every & (mode.unit != calls.unit)
        yield changed, "the unit has changed within {code}: its words would change too", end
        changed = every & (mode.plane != calls.plane) & rule.one_plane
        yield changed, "the plane has changed within {code}", end
        yield calls.other_axes, "{code} takes words of X, Y, Z alone", "move other axes before it"
        yield calls.inverse, "{code} cannot be fed in inverse time", "write G94"

    def _about_words(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule = self.calls, self.rule
        if not rule.stores:
            yield ~self.has_axes, "{code} without an axis word", "write G80 to end the cycle"
            yield self.repeats == 0, "{code} with no repeats at all", "leave out the block"
        count = rule.repeats
        placed = (self.repeats == 0) & ~(np.isnan(calls.first) & np.isnan(calls.second))
        message = f"{{code}} with {count}0: whether it goes to the place given is not certain"
        yield placed, message, "give the place in a block of its own"
        yield self.repeats != np.floor(self.repeats), f"{{code}} with a fraction in {count}", ""
        yield self.repeats < 0, f"{{code}} with a negative {count}", ""
        yield ~np.isnan(calls.repeats) & ~self._listed(rule.takes, count), *_takes_no(count)
        for letter in "PQIJK":
            name = letter.lower()
            given = ~np.isnan(getattr(calls, name))
            if letter != count:
                yield given & ~self._listed(rule.takes, letter), *_takes_no(letter)
            unset = np.isnan(self.words[name])
            open_ = f"{{code}} with {letter} in force: what it does is not known"
            yield ~unset & self._listed(rule.open_words, letter), open_, "write G80 before it"
            missing = self.drilled & unset & self._listed(rule.needs, letter)
            yield missing, f"{{code}} without {letter}", "give it in this block"
        yield calls.p < 0, "{code} with a negative P", ""
        pecks = self._with_code(list(rule.pecks)) & self.drilled
        yield pecks & (self.words["q"] <= 0), "{code} with a Q that is not above zero", ""

    def _about_levels(self) -> Iterator[tuple[Flags, str, str]]:
        calls, drilled, normal = self.calls, self.drilled, "XYZ"[self.calls.plane.axes[2]]
        for name, letter in (("r", "R"), ("normal", normal)):
            missing = drilled & np.isnan(self.words[name])
            yield missing, f"{{code}} without {letter}", "give it in this block"
            if self.rule.keeps_words:
                mixed = drilled & (self._incremental(name) != calls.incremental)
                message = f"{{code}} with {letter} in force from before a G90 or G91"
                yield mixed, message, "give it again in this block"
        unknown = drilled & np.isnan(self.start_level)
        hint = (
            f"begin with an absolute {normal}, or say start = {{{{ {normal} = ... }}}} in [input]"
        )
        yield unknown, f"{{code}}, but where {normal} stands is not known", hint.format()
        for axis, word in enumerate((calls.first, calls.second)):
            letter = "XYZ"[calls.plane.axes[axis]]
            lost = ~np.isnan(word) & calls.incremental & np.isnan(self.start[:, axis])
            yield lost & drilled, f"{letter} is incremental, but it stands nowhere known", ""
        deep = drilled & (self.bottom > self.clearance)
        yield deep, f"{{code}} with {normal} above R", ""
        if not self.rule.rises_first:
            high = drilled & (self.clearance > self.start_level)
            message = "{code} with R above the level from which the cycle began"
            yield high, message, "move up before the cycle"
        yield self._moves() > MOST, f"{{code}} would become more than {MOST} moves", ""

    def _incremental(self, name: str) -> Flags:
        """Return whether the word in force was given in G91."""
        given = ~np.isnan(getattr(self.calls, name))
        before = self.mode.incremental.get(name, False)
        return np.asarray(fill(self.calls.incremental, given, before))

    def _moves(self) -> Floats:
        """Return about how many moves a call becomes."""
        return np.asarray(self.repeats * (self.pecks * 3.0 + 2.0))

    def _about_spindle(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule = self.calls, self.rule
        for code, ways in rule.spindle.items():
            here = self._with_code([code]) & self.drilled
            hint = " or ".join("M3" if way > 0 else "M4" for way in ways) + " before it"
            yield here & (calls.spindle == 0), "{code} with the spindle stopped", hint
            other = ~np.isin(calls.spindle, [*ways, 0, UNKNOWN])
            yield here & other, "{code} with the spindle turning the wrong way", hint
            if any(RESUME in step.then for step in rule.steps[code]):
                message = "{code} starts the spindle again, but how it turned is not known"
                yield here & (calls.spindle == UNKNOWN), message, hint
        for way, name, needed in (
            ("break", "peck_return", rule.peck_return),
            ("clear", "peck_clearance", rule.peck_clearance),
        ):
            codes = [code for code, pecks in rule.pecks.items() if pecks == way]
            deep = self.drilled & self._with_code(codes) & (self.pecks > 1)
            hint = f"give {name}, the parameter of the machine"
            message = "{code}: how far it goes back between pecks is a parameter of the control"
            yield deep & (needed is None), message, hint

    # --- the holes ---

    def holes(self) -> Holes:
        """Return the holes of the calls that drill any, repeats one after the other."""
        calls = self.calls
        count = np.where(self.drilled, self.repeats, 0.0).astype(np.int64)
        call = np.repeat(np.arange(len(calls)), count)
        number = np.arange(len(call)) - (np.cumsum(count) - count)[call]
        left = (count[call] - 1 - number).astype(np.float64)
        at = self.after[call, :2] - self.increment[call] * left[:, None]
        middle = self.words["ijk"[calls.plane.axes[2]]]
        middle = middle + np.where(calls.incremental, self.bottom, 0.0)
        levels = np.stack([self.bottom, middle, self.clearance, self.retract], axis=1)
        assert len(Level) == levels.shape[1]
        shift = [self.words["ijk"[axis]] for axis in calls.plane.axes[:2]]
        return Holes(
            call,
            calls.code[call],
            at,
            self.start[call],
            self.rises[call] & (number == 0),
            np.where(number == 0, self.level[call], self.retract[call]),
            levels[call],
            np.stack(shift, axis=1)[call],
            self.words["q"][call],
            self.pecks[call],
            self._dwell()[call],
            calls.spindle[call],
            calls.line[call],
        )

    def _dwell(self) -> Floats:
        """Return how long each call dwells where its cycle does."""
        given = self.calls.p
        if self.rule.keeps_dwell:
            return np.asarray(fill(given, ~np.isnan(given), self.mode.dwell))
        return np.nan_to_num(self.words["p"])

    def mode_after(self) -> _Mode:
        """Return what stays in force after the stretch."""
        if not len(self.calls):
            return self.mode
        return _Mode(
            int(self.calls.code[-1]),
            self.start_level,
            {name: float(column[-1]) for name, column in self.words.items()},
            {name: bool(self._incremental(name)[-1]) for name in ("r", "normal")},
            self.calls.plane,
            self.calls.unit,
            float(self._dwell()[-1]),
        )


def _takes_no(letter: str) -> tuple[str, str]:
    return f"{{code}} takes no {letter}", ""
