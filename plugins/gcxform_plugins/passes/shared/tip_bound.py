"""How far the tip leaves its line while all axes move in proportion: an upper bound.

The axes that keep the tip on its line follow a curve f(u), 0 <= u <= 1, and the control follows its
chord, which is at most max |f''| / 8 away. In the middle f'' is computed, and from there it changes
by no more than max |f'''| / 2. A rotation about c by w u takes y to r = R (y - c), and

    y'   = w d x r + R v
    y''  = w^2 d x (d x r) + 2 w d x R v + R a
    y''' <= w^3 |d x r| + 3 w^2 |v| + 3 w |a| + |b|

with v, a, b the derivatives before it, in the order of the chain.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats


@dataclass
class _Point:
    """A point in the middle of n pieces, with its derivatives, and bounds along the pieces.

    `place`, `speed`, `bend` (n, 3); `fast`, `curved`, `twisted` (n,) bound the first, second and
    third derivative.
    """

    place: Floats
    speed: Floats
    bend: Floats
    fast: Floats
    curved: Floats
    twisted: Floats

    def turn(self, axis: gx.Rotary, degrees: Floats, step: Floats) -> None:
        """Let an axis carry the point: it stands at `degrees` (n,) and turns by `step` (n,)."""
        w = np.radians(axis.sign * step)
        d = np.array(axis.direction)
        self.place = axis.turn(self.place, degrees)
        across = np.cross(d, self.place - np.array(axis.point))
        speed = axis.swing(self.speed, degrees)
        bend = axis.swing(self.bend, degrees)
        self.speed = w[:, None] * across + speed
        self.bend = (w**2)[:, None] * np.cross(d, across)
        self.bend += 2.0 * w[:, None] * np.cross(d, speed) + bend
        w = np.abs(w)
        far = np.linalg.norm(across, axis=1) + self.fast / 2.0
        self.twisted = w**3 * far + 3.0 * w**2 * self.fast + 3.0 * w * self.curved + self.twisted
        self.curved = w**2 * far + 2.0 * w * self.fast + self.curved
        self.fast = w * far + self.fast


def leaving(chain: gx.Chain, tips: tuple[Floats, Floats], angles: tuple[Floats, Floats]) -> Floats:
    """Return how far (n,) mm the tip can be from the line between tips (n, 3) on the workpiece.

    `angles` (n, m) degrees are those of the axes at both ends.
    """
    middle, step = (angles[0] + angles[1]) / 2.0, angles[1] - angles[0]
    way = tips[1] - tips[0]
    length = np.linalg.norm(way, axis=1)
    none, zero = np.zeros_like(way), np.zeros_like(length)
    tip = _Point((tips[0] + tips[1]) / 2.0, way, none, length, zero, zero)
    for k in reversed(range(len(chain.table))):
        tip.turn(chain.table[k], middle[:, k], step[:, k])
    arm = _Point(np.broadcast_to(np.array(chain.tip), way.shape), none, none, zero, zero, zero)
    for k in reversed(range(len(chain.table), len(chain.axes))):
        arm.turn(chain.axes[k], middle[:, k], step[:, k])
    bend = np.linalg.norm(tip.bend - arm.bend, axis=1)
    return np.asarray((bend + (tip.twisted + arm.twisted) / 2.0) / 8.0)
