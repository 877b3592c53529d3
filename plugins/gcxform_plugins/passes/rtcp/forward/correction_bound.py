"""How far the axes of a nearly equal machine are from moving in proportion: an upper bound.

A program in axes of one machine keeps its tip on another, if X, Y and Z are corrected by some c(u)
while the axes turn in proportion to u, 0 <= u <= 1. The control corrects along the chord of c,
which is at most max |c''| / 8 away. Let an axis N turn by w u and the one in its place C by as
much; d are their directions, with signs. What C puts on top of N taken back, E = C N^-1, is nearly
nothing: with D how far the two lines are apart,

    |E - 1| <= 2 |dC - dN|      |E'| <= w |dC - dN|      |E''| <= 2 w^2 |dC - dN|

for vectors, and a point on the line of N moves by up to 2 |D|, at w |D|, bent by w^2 |D|. Of
several axes the corrections add up, each turned by the axes before it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats


class Curve(NamedTuple):
    """Bounds of a vector along n pieces, and of its first and second derivative, (n,) each."""

    size: Floats
    first: Floats
    second: Floats

    def plus(self, other: Curve) -> Curve:
        """Return the bounds of a sum."""
        return Curve(*(a + b for a, b in zip(self, other, strict=True)))

    def turned(self, step: Floats) -> Curve:
        """Return the bounds while an axis turns the vector by a step (n,) rad."""
        size, first, second = self
        return Curve(size, step * size + first, step**2 * size + 2.0 * step * first + second)


def _signed(axis: gx.Rotary) -> Floats:
    return axis.sign * np.array(axis.direction)


class Slip(NamedTuple):
    """By how much, at most, one axis turns besides the other, and how much that changes; rad."""

    size: Floats
    step: Floats


def _mended(nominal: gx.Rotary, other: gx.Rotary, step: Floats, slip: Slip, point: Curve) -> Curve:
    """Return the bounds of E p - p of a point p, which is known from the point of the axis.

    What C turns besides N is turned after E, about the line of C.
    """
    mended = _of_lines(nominal, other, step, point)
    apart = float(np.linalg.norm(np.array(nominal.point) - np.array(other.point)))
    far, fast, bent = point.plus(mended)
    far = far + apart
    size, first, second = slip.size, slip.step, slip.step**2
    turned = Curve(
        size * far,
        first * far + size * fast,
        second * far + 2.0 * first * fast + size * bent,
    )
    return mended.plus(turned)


def _of_lines(nominal: gx.Rotary, other: gx.Rotary, step: Floats, point: Curve) -> Curve:
    """Return the bounds of E p - p while both axes turn by the same."""
    lean = float(np.linalg.norm(_signed(other) - _signed(nominal)))
    apart = np.array(nominal.point) - np.array(other.point)
    aside = float(np.linalg.norm(np.cross(apart, other.direction)))
    far, fast, bent = point
    size, first, second = 2.0 * lean, step * lean, 2.0 * step**2 * lean
    return Curve(
        size * far + 2.0 * aside,
        first * far + size * fast + step * aside,
        second * far + 2.0 * first * fast + size * bent + step**2 * aside,
    )


def bend_of_correction(
    chains: tuple[gx.Chain, gx.Chain],
    linear: tuple[Floats, Floats],
    angles: tuple[Floats, Floats],
    slips: tuple[Floats, Floats] | None = None,
) -> Floats:
    """Return how far (n,) mm corrections in proportion are from what keeps the tip.

    `chains` are the machine of the program and the one that is corrected for, of the same axes and
    the same tip; `linear` (n, 3) mm are X, Y and Z in the first at both ends, `angles` (n, m)
    degrees are those in the first, to which `slips` are added in the second.
    """
    one, other = chains
    steps = np.abs(np.radians(angles[1] - angles[0]))
    slip = _slips(slips, steps)
    tables, zero = len(one.table), np.zeros(len(steps))
    held, moved = _of_head(one, other, steps, slip)
    way = np.linalg.norm(linear[1] - linear[0], axis=1)
    ends = tuple(x + one.arm(a) for x, a in zip(linear, angles, strict=True))
    tip = Curve(zero, way + held.first, held.second)
    total = moved
    for k in range(tables):
        point = _seen_from(np.array(one.table[k].point), ends, tip)
        mended = _mended(one.table[k], other.table[k], steps[:, k], slip[k], point)
        for outer in reversed(range(k)):
            mended = mended.turned(steps[:, outer] + slip[outer].step)
        total = total.plus(mended)
        ends = tuple(one.table[k].turn(p, -a[:, k]) for p, a in zip(ends, angles, strict=True))
        tip = point.turned(steps[:, k])
    return np.asarray(total.second / 8.0)


def _seen_from(place: Floats, ends: tuple[Floats, ...], tip: Curve) -> Curve:
    """Return the bounds of a point, whose ends (n, 3) are known, as the way from a place to it."""
    far = np.max([np.linalg.norm(end - place, axis=1) for end in ends], axis=0)
    return Curve(far + tip.first / 2.0, tip.first, tip.second)


def _slips(slips: tuple[Floats, Floats] | None, steps: Floats) -> list[Slip]:
    """Return the slips of the axes."""
    if slips is None:
        return [Slip(*np.zeros((2, len(steps)))) for _ in steps.T]
    one, other = (np.radians(side) for side in slips)
    sizes = np.maximum(np.abs(one), np.abs(other))
    return [Slip(*pair) for pair in zip(sizes.T, np.abs(other - one).T, strict=True)]


def _of_head(
    one: gx.Chain, other: gx.Chain, steps: Floats, slips: list[Slip]
) -> tuple[Curve, Curve]:
    """Return the bounds of the arm, and of what a head puts on top of it."""
    zero = np.zeros(len(steps))
    arm, total = Curve(zero, zero, zero), Curve(zero, zero, zero)
    reach, place = zero, np.array(one.tip)
    for k in reversed(range(len(one.head))):
        column = len(one.table) + k
        step, slip = steps[:, column], slips[column]
        point = np.array(one.head[k].point)
        reach, place = reach + np.linalg.norm(place - point), point
        arm = Curve(reach, arm.first, arm.second).turned(step)
        total = total.turned(step + slip.step)
        total = total.plus(_mended(one.head[k], other.head[k], step, slip, arm))
    return arm, total
