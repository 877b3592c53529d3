"""Whether the residuals of step diagonals have the pattern that angular errors leave.

The method takes an axis to have the same three errors wherever the others stand. The angle of an
axis A works on a lever along an axis B, so that its error depends on both:

    E_d = f(a) b,   a and b: the positions on A and B, from -1 to 1 over the volume

with d the direction of the error, and not B, for a turn moves nothing along its own lever. Such
fields are read along the diagonals as the errors of the axes are, step by step, and joined to the
unknowns: once f linear (nine fields, for a b is the same of either axis), once with f of Legendre
up to the third degree. What chi square gains is held against what is left, by the distribution of
their ratio (F). So a noise that was stated too small alarms no more often. Where linear tests stood
is not known: each axis that was tested may have a polynomial of its own there.

A step of an axis is read four times and has three errors, so that of all that angles do only one
number of each step shows, and with linear tests a little more. What is fitted is the least field
that explains the residuals: the machine may have more.
It is a test of what was identified, and changes nothing in it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.polynomial.legendre import legval

from gcxform.calibrate.diagonal.equations import equations, increments
from gcxform.calibrate.diagonal.readings import Diagonals, beam
from gcxform.calibrate.diagonal.step_diagonal import Identified
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

DEGREES: Final = (1, 3)  # of f: each is a test
RATE: Final = 0.01  # of false alarms, of all tests together
_LEAST: Final = 4  # degrees of freedom that have to be left: with fewer nothing is told
_WEAK: Final = 0.25  # of what the residuals tell best: what they tell worse is mostly noise
_UNSEEN: Final = 0.1  # of the readings of a field: less of it is left in the residuals
_GRID: Final = 9  # places of an axis at which the size of a field is looked for


class Field(NamedTuple):
    """E_d = P(a) b: axes A and B, the direction d, the degree of P (Legendre)."""

    axis: int
    lever: int
    direction: int
    degree: int

    def error(self, place: Floats) -> Floats:
        """Return the error (n, 3), at most 1, at places (n, 3) of -1 to 1 over the volume."""
        found = np.zeros_like(place)
        shape = legval(place[:, self.axis], [0.0] * self.degree + [1.0])
        found[:, self.direction] = shape * place[:, self.lever]
        return found

    @property
    def words(self) -> str:
        """Return it for a person, such as `EX with X and Y`."""
        return f"E{AXES[self.direction]} with {AXES[self.axis]} and {AXES[self.lever]}"


def fields(degree: int) -> list[Field]:
    """Return all fields up to a degree."""
    pairs = [(a, b) for a in range(3) for b in range(3) if a != b]
    linear = [Field(a, b, d, 1) for a, b in pairs if a < b for d in range(3)]
    bent = range(2, degree + 1)
    return linear + [Field(a, b, d, n) for n in bent for a, b in pairs for d in range(3) if d != b]


@dataclass(frozen=True, eq=False)
class Pattern:
    """What fields up to a degree make of the residuals.

    `gain` is what they take off chi square with `gained` degrees of freedom, `left` and `freedom`
    are what is left; `size` (mm) is the largest error in the volume of the least that explain it.
    """

    degree: int
    gain: float
    gained: int
    left: float
    freedom: int
    size: float

    @property
    def testable(self) -> bool:
        """Whether enough readings are left to tell a pattern from noise."""
        return self.gained > 0 and self.freedom >= _LEAST

    @property
    def times(self) -> float:
        """The gain over what noise takes off, the stated one or that of what is left; F."""
        mean: float = self.gain / self.gained
        return mean / max(1.0, self.left / self.freedom)

    @property
    def significant(self) -> bool:
        """Whether it is more than chance."""
        from scipy.special import fdtrc

        chance = fdtrc(self.gained, self.freedom, self.times) if self.testable else 1.0
        return bool(chance < RATE / len(DEGREES))


@dataclass(frozen=True, eq=False)
class Angles:
    """The tests of what was identified for angular errors."""

    found: Identified

    @cached_property
    def patterns(self) -> tuple[Pattern, ...]:
        """One for each of `DEGREES`."""
        return tuple(_pattern(self.found, degree) for degree in DEGREES)

    @property
    def significant(self) -> Pattern | None:
        """The first pattern that is more than chance."""
        return next((one for one in self.patterns if one.significant), None)

    @property
    def testable(self) -> bool:
        """Whether any of the tests can say something."""
        return any(one.testable for one in self.patterns)

    @cached_property
    def unseen(self) -> tuple[Field, ...]:
        """The linear fields that leave hardly anything in the residuals, each by itself."""
        every = fields(1)
        read, left = _read(self.found, every), _left(self.found, every)
        of = len(every)
        size, rest = (np.linalg.norm(part[:, :of], axis=0) for part in (read, left))
        return tuple(f for f, a, b in zip(every, size, rest, strict=True) if b <= _UNSEEN * a)

    @property
    def warnings(self) -> Iterator[str]:
        """What whoever takes the model has to know."""
        yield from self.found.scatter.warnings
        if (one := self.significant) is not None:
            yield (
                "the residuals have the pattern of angular errors, which this model does not have: "
                f"chi square {one.gain:.4g} of {one.gain + one.left:.4g} in {one.gained} degrees "
                f"of freedom, {one.times:.3g} times what noise takes. The least that explain it "
                f"are {1e3 * one.size:.2g} um in the volume; the model leaves them, and its "
                "deviations do not hold them. Measure the angles of the axes, and give a model "
                "with angular functions"
            )
        elif not self.found.scatter.plausible:
            yield (
                "angular errors that change from step to step look like noise here: the model "
                "would leave them"
            )

    @property
    def words(self) -> str:
        """One sentence for the head of a model."""
        if not self.testable:
            return "Angular errors were not measured; there are too few steps to test for them."
        if self.significant is not None:
            return "Angular errors were not measured and are taken to be none, against the warning."
        blind = ", ".join(f.words for f in self.unseen)
        hidden = f" No reading tells errors {blind}." if blind else ""
        return (
            "Angular errors were not measured and are taken to be none; the residuals show no "
            f"pattern of them, beyond what {1e3 * self.found.scatter.effective:.3g} um of noise "
            f"hides.{hidden}"
        )

    def report(self) -> dict[str, Any]:
        """Return the tests as plain values, mm."""
        return {
            "false-alarms": RATE,
            "found": None if not self.testable else self.significant is not None,
            "tests": [
                {
                    "degree": one.degree,
                    "chi-square": one.gain,
                    "degrees-of-freedom": one.gained,
                    "left": one.left,
                    "left-degrees-of-freedom": one.freedom,
                    "significant": one.significant if one.testable else None,
                    "least-size": one.size,
                }
                for one in self.patterns
            ],
            "unseen": [f.words for f in self.unseen],
        }


def _pattern(found: Identified, degree: int) -> Pattern:
    """Return what fields (and polynomials of linear tests) take of the residuals."""
    every, before = fields(degree), found.solution
    left, size, right = np.linalg.svd(_left(found, every), full_matrices=False)
    strong = size > _WEAK * size[0] if size[0] > 0.0 else np.zeros(len(size), np.bool_)
    told = left[:, strong].T @ before.residual
    amount = (told / size[strong]) @ right[strong]
    gain, gained = float(told @ told), int(np.count_nonzero(strong))
    rest = max(before.chi_square - gain, 0.0)
    largest = _size(every, amount[: len(every)])
    return Pattern(degree, gain, gained, rest, before.redundancy - gained, largest)


def _left(found: Identified, every: list[Field]) -> Floats:
    """Return what of the readings of fields the unknowns of the method do not take (m, k)."""
    assumed = found.assumed
    system = equations(
        found.diagonals, found.linear, assumed.noise, assumed.of_linear, assumed.free_beams
    )
    read, basis = _read(found, every) / system.deviation[:, None], found.solution.basis
    rest = np.asarray(read - basis @ (basis.T @ read))
    rest[np.abs(rest) < 1e-9 * np.abs(read).max(initial=0.0)] = 0.0
    return rest


def _read(found: Identified, every: list[Field]) -> Floats:
    """Return what is read of fields of 1 mm, then of a polynomial of each linear test (m, k)."""
    diagonals, degree = found.diagonals, max(field.degree for field in every)
    columns = [increments(_measuring(diagonals, field)).mean.ravel() for field in every]
    count = sum(len(test.position) for test in found.linear)
    beside = np.zeros((len(columns[0]) + count, 3 * degree))
    first = len(columns[0])
    for test in found.linear:
        rows = slice(first, first + len(test.position))
        place = _place(diagonals, test.position[:, None], slice(test.axis, test.axis + 1))[:, 0]
        for power in range(degree):
            beside[rows, 3 * power + test.axis] = place ** (power + 1)
        first = rows.stop
    return np.hstack([np.pad(np.array(columns).T, ((0, count), (0, 0))), beside])


def _measuring(diagonals: Diagonals, field: Field) -> Diagonals:
    """Return the same diagonals with what they read of a field."""
    travel = diagonals.volume.travel
    legs = (
        replace(
            leg,
            deviation=field.error(_place(diagonals, leg.position)) @ beam(leg.signs, travel),
        )
        for leg in diagonals.legs
    )
    return replace(diagonals, legs=tuple(legs))


def _place(diagonals: Diagonals, position: Floats, axes: slice = slice(None)) -> Floats:
    """Return positions (n, k) in mm as -1 to 1 over the volume."""
    volume = diagonals.volume
    return np.asarray(2.0 * (position - volume.low[axes]) / volume.travel[axes] - 1.0)


def _size(every: list[Field], amount: Floats) -> float:
    """Return the largest error in the volume of fields with amounts (k,) in mm."""
    line = np.linspace(-1.0, 1.0, _GRID)
    places = np.stack(np.meshgrid(line, line, line), axis=-1).reshape(-1, 3)
    total = sum(
        (a * field.error(places) for a, field in zip(amount, every, strict=True)),
        np.zeros_like(places),
    )
    return float(np.sqrt((total**2).sum(axis=1)).max())
