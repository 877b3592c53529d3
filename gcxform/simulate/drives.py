"""What the drives of a machine do besides its geometry, along a circle: for virtual ballbars.

It is added to where the machine stands, axis by axis, and the instrument reads what comes of it:
nothing here is to the first order, and nothing shares code with what takes circles apart.
"""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Triple = tuple[float, float, float]
NONE: Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Drives:
    """What X, Y and Z do, in mm.

    lag       how far an axis is behind its command at the feed
    backlash  what is lost where an axis turns back
    play      how far an axis jumps aside, along the other of the plane, where it turns back
    stick     the way along the circle during which an axis stands where it turned back
    cyclic    the amplitude of an error with the `pitch`, a cosine of the position in the machine
    """

    lag: Triple = NONE
    backlash: Triple = NONE
    play: Triple = NONE
    stick: Triple = NONE
    cyclic: Triple = NONE
    pitch: float = 10.0

    def off(
        self, angle: Floats, sense: int, axes: tuple[int, int], circle: tuple[Floats, float]
    ) -> Floats:
        """Return by how much (n, 2) in mm both axes are off their commands at angles (n,), rad.

        `sense` is +1 from the first axis towards the second. `circle` is its centre (2,) and its
        radius in mm.
        """
        centre, radius = circle
        command = np.column_stack([np.cos(angle), np.sin(angle)])
        velocity = sense * np.column_stack([-np.sin(angle), np.cos(angle)])
        found = np.zeros_like(command)
        for k, axis in enumerate(axes):
            way = np.sign(velocity[:, k])
            found[:, k] -= self.lag[axis] * velocity[:, k] + self.backlash[axis] / 2.0 * way
            found[:, 1 - k] -= self.play[axis] / 2.0 * way
            found[:, k] += self._stuck(command[:, k], velocity[:, k], axis, radius)
            place = centre[k] + radius * command[:, k]
            found[:, k] += self.cyclic[axis] * np.cos(2.0 * np.pi * place / self.pitch)
        return found

    def _stuck(self, command: Floats, velocity: Floats, axis: int, radius: float) -> Floats:
        """Return what an axis is off while it still stands where it turned back."""
        behind = np.arccos(np.clip(np.abs(command), 0.0, 1.0)) * radius
        inwards = command * velocity < 0.0
        stands = inwards & (behind < self.stick[axis])
        return np.where(stands, np.sign(command) * radius - radius * command, 0.0)


STILL = Drives()
