"""Numbers without a decimal point, on controls where that decides what they are worth.

Distances count in increments, or in units; an F has a unit of its own; so has a dwell. What is said
of the control (`Reading`) decides; what it leaves open is refused, and what is taken as custom has
it is noted as an assumption. Computed distances have no point either: they are worth what they
are, and rounded to the increment.
"""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import Diagnostic
from gcxform.dialect.dialect import ROTARY, Dialect
from gcxform.dialect.increments import INVERSE_TIME, Increments, coarse, readings, unit_of
from gcxform.modal.findings import Findings
from gcxform.modal.meaning.tables import NUMBER
from gcxform.modal.state import Reading
from gcxform.syntax.tree import COMPUTED
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import distinct

UNKNOWN = Increments("")


def hint_of(address: str, inch: bool, word: str = "X1000") -> str:
    """Return what to say of the control, with what a word of 1000 would be in each case."""
    one, other = readings(address, inch)
    return (
        f'increment = "IS-B" in [input] if {address}1000 is {one}, '
        f'increment = "calculator" in [input] if it is {other}'
    )


def hint_of_argument(address: str, inch: bool) -> str:
    """Return what to say of the control where calculator input is not known to hold."""
    one, _ = readings(address, inch)
    return f'write it with a point, or increment = "IS-B" in [input] if {address}1000 is {one}'


def hint_of_rounding(address: str, inch: bool) -> str:
    """Return what to say of the control where computed distances have to be rounded."""
    step = "0.0001 inch" if inch and address not in ROTARY else "0.001"
    return (
        f'increment = "IS-B" in [input] if {address} has steps of {step}, '
        'increment = "calculator IS-B" in [input] if X1000 is 1000 units besides'
    )


def assumed_rounding(address: str, inch: bool, said: Increments) -> str:
    """Return what is taken for the increment to which computed distances are rounded."""
    what, name = unit_of(address, inch)
    steps = said.per_unit(address, inch)
    return f"{said.said}: {what} that is computed is rounded to {1 / (steps or 1):.6g} {name}"


PLAIN_FEED = "write the feed as a number, with a point"


def why_open(address: str, value: float, decimals: int, inch: bool) -> str:
    """Return what is not known of a distance that a code takes for itself; nothing if it is.

    One that is computed is known where no increment rounds it, and lost where its value is.
    """
    if decimals == COMPUTED:
        same = coarse(value, address, inch)
        return "" if same == same or value != value else "is computed: to what it is rounded"
    return "has no decimal point: its unit" if decimals < 0 and value else ""


class Pointless:
    """Gives the numbers of a window that have no point their worth; `inch` (n,) are its blocks."""

    def __init__(
        self,
        dialect: type[Dialect],
        reading: Reading,
        findings: Findings,
        assumed: dict[str, Diagnostic | None],
    ) -> None:
        self.rule, self.reading = dialect.point_rule, reading
        self.findings, self.assumed = findings, assumed
        self.increments = reading.increments or UNKNOWN

    def _floats(self, address: str) -> bool:
        """Whether the control is said to add a point to a word that has none."""
        return self.increments.calculator and address in self.rule.calculator_words

    # --- distances ---

    def distances(
        self, address: str, value: Floats, present: Flags, decimals: Ints, inch: Flags
    ) -> Floats:
        """Return distances in units; those whose worth is not known are refused."""
        pointless = present & (decimals < 0) & (value != 0)
        if not pointless.any():
            return value
        computed = pointless & (decimals == COMPUTED)
        written = pointless & ~computed
        steps = self._steps(address, inch)
        counts = np.ones(len(value)) if self._floats(address) else self._counts(steps)
        value = value.copy()
        for n in np.flatnonzero(computed & np.isnan(steps)).tolist():
            same = coarse(float(value[n]), address, bool(inch[n]))
            computed[n] = same != same
            value[n] = value[n] if same != same else same
        unknown = (written & np.isnan(counts)) | (computed & np.isnan(steps))
        if unknown.any():
            self._refuse(address, value, unknown, computed, inch)
            return value
        self._assume(address, written, computed, inch)
        rounded = np.copysign(np.floor(np.abs(value) * steps + 0.5) / steps, value)
        return np.where(computed, rounded, np.where(written, value / counts, value))

    def _counts(self, steps: Floats) -> Floats:
        """Return how many of what is written make a unit, nan where that is not known."""
        return np.full(len(steps), np.nan) if self.increments.calculator else steps

    def _steps(self, address: str, inch: Flags) -> Floats:
        """Return how many increments a unit has on each line, nan where that is not known."""
        pair = (self.increments.per_unit(address, unit) for unit in (False, True))
        mm, inches = (np.nan if steps is None else steps for steps in pair)
        return np.where(inch, inches, mm)

    def _refuse(
        self, address: str, value: Floats, unknown: Flags, computed: Flags, inch: Flags
    ) -> None:
        lines = np.flatnonzero(unknown)
        largest = lines[np.argmax(np.abs(value[lines]))]
        for line in lines[: Findings.enough].tolist():
            why, unit = "has no decimal point: its unit", bool(inch[line])
            known = address in self.rule.calculator_words
            hint = (hint_of if known else hint_of_argument)(address, unit)
            if computed[line]:
                why = "is computed: to what it is rounded"
                hint = hint_of_rounding(address, unit)
            elif self.increments.calculator:
                hint = "write it with a point: calculator input is not known to hold for it"
            elif self.increments.said:
                said = f"{self.increments.said}, 0.001 deg"
                hint = f'increment = "{said}" in [input] if {address}1000 is 1 deg'
            else:
                hint += _evidence(address, float(value[largest]), bool(inch[largest]))
            self.findings.add(
                line, "GX205", f"{address} {why} depends on the control", address, hint
            )

    def _assume(self, address: str, written: Flags, computed: Flags, inch: Flags) -> None:
        """Note what was taken for the worth of numbers, for each unit in which there are any."""
        for unit in (False, True):
            what, name = unit_of(address, unit)
            here, steps = inch == unit, self.increments.per_unit(address, unit)
            size = "" if steps is None else f"{1 / steps:.6g} {name}"
            if (written & here).any():
                worth = f"1 {name}" if self._floats(address) else size
                said = f"{what} without a point counts {worth}"
                self.assumed[f"{self.increments.said}: {said}"] = None
            if (computed & here).any():
                self.assumed[assumed_rounding(address, unit, self.increments)] = None

    # --- feeds ---

    def feeds(
        self, value: Floats, present: Flags, decimals: Ints, mode: Small, inch: Flags
    ) -> Floats:
        """Return feeds in units; those whose unit is not known are refused."""
        odd = present & (decimals < 0) & (value != 0)
        if self.rule.feed_required:
            odd &= decimals != COMPUTED
        if not odd.any():
            return value
        computed = odd & (decimals == COMPUTED)
        counts = self._feed_counts(mode, inch)
        unknown = odd & (np.isnan(counts) | (computed & (counts != 1.0)))
        for line in np.flatnonzero(unknown)[: Findings.enough].tolist():
            message = "F has no decimal point: its unit depends on the control"
            written = not computed[line]
            hint = self._feed_hint(int(mode[line]), bool(inch[line])) if written else PLAIN_FEED
            self.findings.add(line, "GX205", message, "F", hint)
        self._assume_feeds(odd & ~unknown, counts, mode, inch)
        return np.where(odd & ~unknown, value / counts, value)

    def _feed_counts(self, mode: Small, inch: Flags) -> Floats:
        """Return how many of what is written in an F make a unit, nan where that is not known."""
        counts = np.full(len(mode), np.nan)
        said, per_minute = self.reading.feed_increment, mode == NUMBER["G94"]
        custom = not self.rule.feed_required
        if self._floats("F") or said == "calculator":
            counts[:] = 1.0
        elif custom:
            counts[per_minute & ~inch] = 1.0
            if self.increments.said in ("IS-B", "IS-C"):
                counts[mode == NUMBER["G93"]] = INVERSE_TIME
        if isinstance(said, float | int):
            counts[per_minute] = 1 / said
        elif said is not None and said in self.rule.feed_steps:
            mm, inches = self.rule.feed_steps[said]
            counts[per_minute] = np.where(inch, inches, mm)[per_minute]
        return counts

    def _feed_hint(self, mode: int, inch: bool) -> str:
        hint = "write the feed with a point"
        if mode != NUMBER["G94"]:
            return hint
        unit, steps = ("inch", "0.01") if inch else ("mm", "0.001")
        if self.rule.feed_steps:
            steps = f"{1 / self.rule.feed_steps['IS-B'][inch]:g}"
        return (
            f"{hint}, or say what 1 is worth: feed-increment = {steps} in [input] if F1 is "
            f'{steps} {unit}/min, feed-increment = "calculator" in [input] if it is 1 {unit}/min'
        )

    def _assume_feeds(self, taken: Flags, counts: Floats, mode: Small, inch: Flags) -> None:
        for code, unit in (("G94", "{}/min"), ("G95", "{}/turn"), ("G93", "/min")):
            for inches, name in ((False, "mm"), (True, "inch")):
                here = taken & (mode == NUMBER[code]) & (inch == inches)
                for count in distinct(counts[here]).tolist():
                    worth = f"{1 / count:.6g} {unit.format(name)}".replace(" /", "/")
                    self.assumed[f"an F without a point counts {worth}"] = None

    # --- dwells ---

    def dwell(self, address: str, decimals: int) -> float | None:
        """Return the seconds that 1 of a dwell word is, None where that is not known."""
        unit = self.rule.seconds(address, decimals >= 0)
        if decimals >= 0 or not self.rule.required:
            return unit
        if unit != 1.0:
            return self._counted(address, unit)
        if decimals == COMPUTED:
            return None
        if self._floats(address):
            return unit
        return None if self.increments.second is None else 1 / self.increments.second

    def _counted(self, address: str, unit: float) -> float | None:
        """Return the worth of a word that has never a point: its usual one, but in odd systems."""
        systems = self.increments.degree is not None and not self.rule.dwell_in_seconds
        if systems and self.increments.second is None:
            return None
        self.assumed[f"{address} of a dwell counts {unit:g} s"] = None
        return unit


def _evidence(address: str, largest: float, inch: bool) -> str:
    """Return what the largest number of a window would be, for who knows how large the part is."""
    unit = unit_of(address, inch)[1]
    steps = 10_000 if unit == "inch" else 1000
    return f"; {address}{largest:g} would be {largest / steps:g} or {largest:g} {unit}"
