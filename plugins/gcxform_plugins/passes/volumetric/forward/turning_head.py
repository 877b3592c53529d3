"""How far a turning head bends the error along a line, for where `volumetric` cuts it.

The error at the tip is E = d + R x t, where the model's d and R depend on the position c, and the
way t from the gauge point to the tip on the angles of the head. Along a line, with u from 0 to 1,

    E'' = (what the model alone bends) + 2 R' x t' + R x t''

and between two points it leaves its chord by an eighth of that at most. Nothing here is used by the
undo, which has bounds of its own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.shared.tip_bound import leaving
from gcxform_plugins.passes.volumetric.levers import Lever
from gcxform_plugins.passes.volumetric.options import VolumetricOptions


class Swing:
    """Bounds for the rows of a path.

    turning  (n,) whether the head turns in the row
    speed    (n,) mm, the largest |t'| of the row
    curved   (n,) mm, the largest |t''|
    reach    mm, how far the tip is at most from where the errors were measured
    """

    def __init__(self, step: VolumetricOptions, lever: Lever) -> None:
        model = step.model.model
        self.angle, self.slope = model.turning(step.cells)
        self.turning = (lever.begin != lever.stop).any(axis=1)
        self.curved = 8.0 * _sags(lever, self.turning)
        self.speed = np.linalg.norm(lever.ends - lever.starts, axis=1) + self.curved / 2.0
        ends = max(gx.reach_of(model, tools) for tools in (lever.starts, lever.ends))
        self.reach = ends + float(self.curved.max(initial=0.0)) / 8.0

    def bend(self, rows: Ints, way: Floats, share: Floats) -> Floats:
        """Return how far (n,) mm the head bends the error off its chord, at most.

        `way` (n, 3) mm, moduli, is how far the targets go in shares (n,) of rows. Commands go
        farther by what the head changes of the error.
        """
        speed, curved = self.speed[rows] * share, self.curved[rows] * share**2
        length = np.sqrt((way**2).sum(axis=1)) + self.angle * speed
        return np.asarray((2.0 * self.slope * length * speed + self.angle * curved) / 8.0)


def _sags(lever: Lever, turning: Flags) -> Floats:
    """Return how far (n,) mm the tip leaves the chord of its way while the head turns."""
    found = np.zeros(len(turning))
    rows = np.flatnonzero(turning)
    held, which = np.unique(lever.held[rows], axis=0, return_inverse=True)
    chain = gx.Chain((), lever.head)
    for number, way in enumerate(held):
        here = rows[which.reshape(-1) == number]
        x, y, z = (lever.gauge + way).tolist()
        still = np.zeros((len(here), 3))
        angles = lever.begin[here], lever.stop[here]
        found[here] = leaving(replace(chain, tip=(x, y, z)), (still, still), angles)
    return found
