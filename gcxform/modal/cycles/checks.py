"""What speaks against calls of canned cycles."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from gcxform.catalogue.remedies import leave_out_block
from gcxform.dialect.cycle_rule import RESUME, Cycle, CycleRule
from gcxform.modal.cycles.stretch import Stretch
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.path import Plane
from gcxform.values import dataclass

UNKNOWN = 2
"""How the spindle turns where nobody knows; otherwise +1 (M3), -1 (M4), 0."""
MOST = 100_000  # moves that one block may become
ENOUGH = 50  # refusals of one kind
LEVELS_STAY = 'cycle-levels = "stay" in [control] of the machine file'
SAME = 1e-9  # mm; levels nearer than that are one, less the last digits of a work offset


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a call is not expanded: a sentence, and the way out."""

    call: int
    message: str
    hint: str = ""


class Checks:
    """Looks at the columns of stretches; `pecks` (n,): in how many pecks holes are drilled.

    `open_pecks`: where the tool goes between them need not be known, nor when it rises to an R
    above the level from which the cycle began. Over the hole, or once at R, that is the same. Nor
    how long it dwells, where the control dwells without P as well.
    `open_ways`: nor how it gets out of the hole, of a cycle of which that is refused.
    """

    def __init__(
        self,
        stretch: Stretch,
        rule: CycleRule,
        pecks: Ints,
        open_pecks: bool = False,
        open_ways: bool = False,
    ) -> None:
        self.stretch, self.rule, self.pecks, self.cycles = stretch, rule, pecks, rule.cycles
        self.open_pecks, self.open_ways = open_pecks, open_ways
        self.calls, self.drilled, self.words = stretch.calls, stretch.drilled, stretch.words
        self.codes = set(distinct(self.calls.code).tolist())

    def refusals(self) -> tuple[tuple[Refusal, ...], Flags]:
        """Return what speaks against calls, one thing a call, and which calls (n,) are wrong."""
        found: list[Refusal] = []
        wrong = np.zeros(len(self.calls), np.bool_)
        for which, message, hint in self._objections():
            for call in np.flatnonzero(which & ~wrong)[:ENOUGH].tolist():
                code = f"G{self.calls.code[call]}"
                found.append(Refusal(call, message.format(code=code), hint))
            wrong |= which
        return tuple(sorted(found, key=lambda refusal: refusal.call)), wrong

    def _objections(self) -> Iterator[tuple[Flags, str, str]]:
        yield from self._about_codes()
        yield from self._about_modes()
        yield from self._about_words()
        yield from self._about_levels()
        yield from self._about_spindle()

    def _with_code(self, codes: list[int]) -> Flags:
        here = self.codes.intersection(codes)
        if not here:
            return np.zeros(len(self.calls), np.bool_)
        return np.asarray(np.isin(self.calls.code, list(here)))

    def _listed(self, of: Callable[[Cycle], str], word: str) -> Flags:
        """Return the calls whose cycle has a word in what is said of it."""
        return self._with_code([code for code, one in self.cycles.items() if word in of(one)])

    def _about_codes(self) -> Iterator[tuple[Flags, str, str]]:
        for code, one in self.cycles.items():
            if one.refused and not (one.steps and self.open_ways):
                yield self._with_code([code]), f"{{code}} is not expanded: {one.refused}", ""
        known = self._with_code([code for code, one in self.cycles.items() if one.steps])
        yield ~known, "{code} is not a cycle of this control", ""
        if self.calls.plane != Plane.XY:
            for code, reason in {n: c.xy_only for n, c in self.cycles.items() if c.xy_only}.items():
                yield self._with_code([code]), f"{{code}} outside G17: {reason}", ""

    def _about_modes(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule = self.calls, self.rule
        end = "end the cycle with G80 before, and give all words again"
        changed = self.stretch.other_unit
        yield changed, "the unit has changed within {code}: its words would change too", end
        changed = self.stretch.other_plane & rule.one_plane
        yield changed, "the plane has changed within {code}", end
        yield calls.other_axes, "{code} takes words of X, Y, Z alone", "move other axes before it"
        yield calls.inverse, "{code} cannot be fed in inverse time", "write G94"

    def _about_words(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule, repeats = self.calls, self.rule, self.stretch.repeats
        if not rule.stores:
            yield (
                ~self.stretch.has_axes,
                "{code} without an axis word",
                "write G80 to end the cycle",
            )
            yield repeats == 0, "{code} with no repeats at all", leave_out_block()
        count = rule.repeats
        nowhere = np.isnan(calls.first) & np.isnan(calls.second) & ~calls.turned
        placed = (repeats == 0) & ~nowhere
        message = f"{{code}} with {count}0: whether it goes to the place given is not certain"
        yield placed, message, "give the place in a block of its own"
        yield repeats != np.floor(repeats), f"{{code}} with a fraction in {count}", ""
        yield repeats < 0, f"{{code}} with a negative {count}", ""
        taken = self._listed(lambda one: one.takes, count)
        yield ~np.isnan(calls.repeats) & ~taken, *_takes_no(count)
        for letter in "PQIJK":
            name = letter.lower()
            given = ~np.isnan(getattr(calls, name))
            if letter != count:
                yield given & ~self._listed(lambda one: one.takes, letter), *_takes_no(letter)
            unset = np.isnan(self.words[name])
            open_ = f"{{code}} with {letter} in force: what it does is not known"
            left_open = self._listed(lambda one: one.open_words, letter) & ~self._stays()
            by_q = "peck by Q alone" if letter in "IJK" else "write G80 before it"
            yield ~unset & left_open, open_, by_q
            missing = self.drilled & unset & self._listed(lambda one: one.needs, letter)
            if letter == "Q":  # some controls peck by I, J and K as well
                others = self._listed(lambda one: one.open_words, "I")
                missing &= np.isnan(self.words["i"]) | ~others
            missing &= not (letter == "P" and rule.stays.words and self.open_pecks)
            yield missing, f"{{code}} without {letter}", "give it in this block"
        yield calls.p < 0, "{code} with a negative P", ""
        pecks = self._with_code([code for code, one in self.cycles.items() if one.pecks])
        pecks &= self.drilled & (self.words["q"] <= 0)
        yield pecks, "{code} with a Q that is not above zero", ""

    def _stays(self) -> Flags:
        """Return the calls whose pecks may be of any kind: their blocks stay as they are."""
        if not self.open_pecks:
            return np.zeros(len(self.calls), np.bool_)
        return self._with_code([code for code, one in self.cycles.items() if one.pecks])

    def _about_levels(self) -> Iterator[tuple[Flags, str, str]]:
        calls, drilled, stretch = self.calls, self.drilled, self.stretch
        normal = "XYZ"[calls.plane.axes[2]]
        for name, letter in (("r", "R"), ("normal", normal)):
            missing = drilled & np.isnan(self.words[name])
            yield missing, f"{{code}} without {letter}", "give it in this block"
            if self.rule.stays.words:
                mixed = drilled & (stretch.in_g91[name] != calls.incremental)
                message = f"{{code}} with {letter} in force from before a G90 or G91"
                again = "give it again in this block"
                yield mixed & ~calls.incremental, message, again
                if not self.rule.stays.levels:
                    yield mixed, message, f"{again}, or say {LEVELS_STAY}"
        unknown = drilled & np.isnan(stretch.initial)
        hint = (
            f"begin with an absolute {normal}, or say start = {{{{ {normal} = ... }}}} in [input]"
        )
        yield unknown, f"{{code}}, but where {normal} stands is not known", hint.format()
        for axis, word in enumerate((calls.first, calls.second)):
            letter = "XYZ"[calls.plane.axes[axis]]
            lost = ~np.isnan(word) & calls.incremental & np.isnan(stretch.start[:, axis])
            yield lost & drilled, f"{letter} is incremental, but it stands nowhere known", ""
        deep = drilled & (stretch.bottom > stretch.clearance)
        yield deep, f"{{code}} with {normal} above R", ""
        if not self.rule.rises_first:
            high = drilled & (stretch.clearance - stretch.initial > SAME)
            open_way = self._from_below_r() & (not self.open_pecks)
            high &= calls.initial | open_way  # G99 ends at R on every control
            message = "{code} with R above the level from which the cycle began"
            yield high, message, "move up before the cycle"
        yield self._moves() > MOST, f"{{code}} would become more than {MOST} moves", ""

    def _from_below_r(self) -> Flags:
        """Return which calls go aside to their holes from below R: when they rise is not known."""
        stretch = self.stretch
        there = (stretch.after[:, :2] == stretch.start).all(axis=1) & ~self.calls.lost
        return np.asarray(~there & ~(stretch.level >= stretch.clearance))

    def _moves(self) -> Floats:
        """Return about how many moves a call becomes."""
        return np.asarray(self.stretch.repeats * (self.pecks * 3.0 + 2.0))

    def _about_spindle(self) -> Iterator[tuple[Flags, str, str]]:
        calls, rule = self.calls, self.rule
        turning = {code: one for code, one in self.cycles.items() if one.spindle}
        for code, cycle in turning.items():
            ways, here = cycle.spindle, self._with_code([code]) & self.drilled
            hint = " or ".join("M3" if way > 0 else "M4" for way in ways) + " before it"
            yield here & (calls.spindle == 0), "{code} with the spindle stopped", hint
            other = ~np.isin(calls.spindle, [*ways, 0, UNKNOWN])
            yield here & other, "{code} with the spindle turning the wrong way", hint
            if any(RESUME in step.then for step in cycle.steps):
                message = "{code} starts the spindle again, but how it turned is not known"
                yield here & (calls.spindle == UNKNOWN), message, hint
        for way, name, needed in (
            ("break", "peck_return", rule.peck_return),
            ("clear", "peck_clearance", rule.peck_clearance),
        ):
            here = self._listed(lambda one: one.pecks, way)
            deep = self.drilled & here & (self.pecks > 1)
            key = name.replace("_", "-")
            hint = f'{key} = "0.5 mm" in [control] of the machine file, as the machine has it'
            message = "{code}: how far it goes back between pecks is a parameter of the control"
            yield deep & (needed is None and not self.open_pecks), message, hint


def _takes_no(letter: str) -> tuple[str, str]:
    return f"{{code}} takes no {letter}", ""
