"""From what to what positions are converted, and how far that is from being linear.

Between two machines both agree where all rotary axes are at 0, where the work offset is taken. The
correction is then nearly constant, so only long turns are cut (`correction_bound.py`). The tool
axis stays off by what the axes lean: nothing at the tip, and the certificate tells how much at a
tool's length.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.rtcp.forward.correction_bound import bend_of_correction
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.shared.tip_bound import leaving


class Way(Protocol):
    """A conversion of positions: of tips to axes, of axes to tips, or to axes of another machine.

    `axes` is the place of the axes whose limits count.
    """

    @property
    def axes(self) -> Place:
        """The place of the axes that are written, or read where tips are."""
        ...

    def converted(self, positions: Floats, rows: Ints) -> Floats:
        """Return the positions (n, 3) for positions (n, axes) of rows."""
        ...

    def leaving(self, sides: tuple[Floats, Floats], rows: Ints) -> Floats:
        """Return how far (n,) mm pieces of rows, from one side (n, axes) to the other, are off."""
        ...


@dataclass(frozen=True)
class Between:
    """Of tips to axes, or the reverse, of one machine."""

    axes: Place
    to_axes: bool

    def converted(self, positions: Floats, rows: Ints) -> Floats:
        """Return where the axes bring tips, or the reverse."""
        change = self.axes.axes_of if self.to_axes else self.axes.tips_of
        return change(positions[:, :3], self.axes.angles(positions), rows)

    def leaving(self, sides: tuple[Floats, Floats], rows: Ints) -> Floats:
        """Return how far the tip leaves its line."""
        place, far = self.axes, np.zeros(len(rows))
        for chain, here in place.chains(rows):
            held = tuple(side[here] for side in sides)
            if self.to_axes:
                tips = [side[:, :3] for side in held]
            else:
                tips = [self.converted(side, rows[here]) for side in held]
            one, other = (place.on_workpiece(tip, chain) for tip in tips)
            first, last = (place.angles(side) for side in held)
            far[here] = leaving(chain, (one, other), (first, last))
        return far


@dataclass(frozen=True)
class Corrected:
    """Of axes of one machine to those of another of the same axes, at the same angles."""

    nominal: Place
    axes: Place

    def converted(self, positions: Floats, rows: Ints) -> Floats:
        """Return where the axes of the other machine bring the tip to the same place."""
        angles = self.axes.angles(positions)
        tips = self.nominal.tips_of(positions[:, :3], angles, rows)
        return self.axes.axes_of(tips, angles, rows)

    def leaving(self, sides: tuple[Floats, Floats], rows: Ints) -> Floats:
        """Return how far the tip leaves the way that it has on the machine of the program."""
        far = np.zeros(len(rows))
        for (one, here), (other, _) in zip(
            self.nominal.chains(rows), self.axes.chains(rows), strict=True
        ):
            ends = [(side[here, :3] + self.nominal.zero) for side in sides]
            first, last = (self.nominal.angles(side[here]) for side in sides)
            far[here] = bend_of_correction((one, other), (ends[0], ends[1]), (first, last))
        return far
