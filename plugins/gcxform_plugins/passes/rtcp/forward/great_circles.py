"""Tool axes on great circles between blocks."""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.rtcp.forward.choice import LEAP
from gcxform_plugins.passes.rtcp.forward.moving import STILL, Moving
from gcxform_plugins.passes.shared.tip_bound import leaving

SOON = 1e-6  # part of a block in which an axis turns by a leap, if it ever does at its ends
SOON_LESS = 0.02  # of a leap within the block
TRIED = 64  # places of a block that are looked at for leaps


class OnCircles(Moving):
    """Of tips the axes of the same machine, the tool axis on great circles between blocks."""

    _drives = False

    def _vectors(self, row: Ints) -> tuple[Floats, Floats]:
        """Return the tool axes (n, 3) before rows and at their ends."""
        chain = self.place.chain
        one, other = (
            chain.tool_axis(self.place.angles(side[row])) for side in (self.start, self.end)
        )
        return one, other

    def _tips(self, positions: Floats, row: Ints) -> Floats:
        return positions[:, :3]

    def _axis(self, positions: Floats, row: Ints, part: Floats) -> Floats:
        one, other = self._vectors(row)
        lines = self.cuts[row] & np.isfinite(one).all(axis=1)
        return np.where(lines[:, None], on_circle(one, other, part), other)

    def _far(self, source: tuple[Floats, ...], target: tuple[Floats, ...], row: Ints) -> Floats:
        """Return how far (n,) mm the tip leaves its line, and in proportion the tool axis."""
        one, other = (self.target.angles(side) for side in target)
        share = np.degrees(self._aside(other - one)) / self.options.axis_tolerance
        far = self._off_line(source, target, row)
        return np.asarray(np.maximum(far, share * self.options.tolerance))

    def _off_line(
        self, source: tuple[Floats, ...], target: tuple[Floats, ...], row: Ints
    ) -> Floats:
        """Return how far (n,) mm the tip leaves its line."""
        far = np.zeros(len(row))
        sides = [self.target.angles(side) for side in target]
        for chain, here in self.target.chains(row):
            one, other = (self.target.on_workpiece(side[here, :3], chain) for side in source)
            far[here] = leaving(chain, (one, other), (sides[0][here], sides[1][here]))
        return far

    def _aside(self, step: Floats) -> Floats:
        """Return how far (n,) rad the tool axis leaves its circle while axes turn by steps (n, m).

        It is an eighth of the second derivative aside: of the product of both turns, and of the
        turn about the tool itself; and a little more, as circles bend. The proof has the last word.
        """
        chain = self.target.chain
        first = max(len(chain.table) - 1, 0)
        other = chain.axes[1 - first]
        one, two = (np.abs(np.radians(step[:, k])) for k in (first, 1 - first))
        spin = one + two * abs(other.direction[2])
        return np.asarray(1.05 * (one * two + spin * (one + two)) / 8.0)

    def _refuse_leaps(self, rows: Ints) -> None:
        """Refuse rows of cuts along whose circles an axis would have to leap."""
        rows = rows[self.known[rows]]
        part = np.append(np.arange(TRIED) / TRIED, [1.0 - SOON, 1.0])
        part = np.insert(part, 1, SOON)
        row, along = np.repeat(rows, len(part)), np.tile(part, len(rows))[:, None]
        places = (1.0 - along) * self.start[row] + along * self.end[row]
        self._check_reached(places, row, along[:, 0])
        angles = self._angles(places, row, along[:, 0]).reshape(len(rows), len(part), 2)
        most = np.where(np.diff(part) <= SOON, LEAP * SOON_LESS, LEAP)[:, None]
        leaps = (np.abs(np.diff(angles, axis=1)) > most).any(axis=(1, 2))
        far = np.zeros(len(self.path), np.bool_)
        far[rows[leaps]] = True
        message = "on a great circle the tool axis would have to leap"
        hint = "program points on the way, or turn the axes in proportion"
        self._refuse("GX333", far, message, hint)

    def _check_reached(self, places: Floats, row: Ints, part: Floats) -> None:
        """Refuse circles that lead through tool axes which no angles give.

        They are seen where the nearest attitude is farther than half of what it may be.
        """
        miss = gx.attitudes(self.target.chain, self._axis(places, row, part)).miss
        far = np.zeros(len(self.path), np.bool_)
        far[row[miss > self.options.axis_tolerance / 2.0]] = True
        message = "no angles give the tool axes of the great circle"
        hint = "program points on the way, or turn the axes in proportion"
        self._refuse("GX332", far, message, hint)


class Circling(OnCircles):
    """The same, where the program says the angles at the ends of blocks."""

    def _entered(self, entry: Floats) -> Floats:
        return self.target.written(self.place.angles(entry))

    def _choose(self) -> None:
        """Refuse circles that do not lead from angle to angle."""
        self._refuse_leaps(self._turning())

    def _guess(self, positions: Floats, row: Ints, part: Floats, after: bool = False) -> Floats:
        return self.place.angles(positions)

    def _mixed(self, angles: Floats, positions: Floats, row: Ints) -> Floats:
        """Return the angles; where the program says them, they are its own to the last bit."""
        said = self.place.angles(positions)
        return np.where(np.abs(angles - said) < STILL, said, angles)


def on_circle(one: Floats, other: Floats, part: Floats) -> Floats:
    """Return unit vectors (n, 3) at parts (n,) of the great circles between two."""
    angle = np.arctan2(
        np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other)
    )
    short = np.sin(angle) < 1e-12
    whole = np.where(short, 1.0, np.sin(angle))
    left = np.where(short, 1.0 - part, np.sin((1.0 - part) * angle) / whole)
    right = np.where(short, part, np.sin(part * angle) / whole)
    return np.asarray(left[:, None] * one + right[:, None] * other)
