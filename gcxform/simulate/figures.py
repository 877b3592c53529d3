"""Positioning along a line: the statistics of ISO 230-2:2014, clause 3, also used by ISO 230-6.

With the deviations x_ij (actual less target position) of target i and run j, for each direction of
approach: the mean, the standard uncertainty s_i with n - 1, and of both directions

    B_i = mean up - mean down              reversal error, B = max |B_i|
    R_i = max(2 s_i up + 2 s_i down + |B_i|; 4 s_i up; 4 s_i down)      repeatability, R = max R_i
    E   = max(means) - min(means)          systematic deviation of positioning
    M   = max - min of the means of both directions
    A   = max(mean + 2 s) - min(mean - 2 s)         accuracy of positioning

where E, A and their values for one direction alone are over all targets and the directions named.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from gcxform.system.arrays import Floats
from gcxform.values import dataclass

COVERAGE = 2.0  # the standard's factor for limits: mean plus and minus 2 s


@dataclass(frozen=True, eq=False)
class Positioning:
    """Deviations in mm of a line: `target` (m,), `up` and `down` (m, n) of n runs.

    With one run there is no standard uncertainty: s, R and A are nan.
    """

    target: Floats
    up: Floats
    down: Floats

    @cached_property
    def mean_up(self) -> Floats:
        """The mean deviations (m,) of the approaches upwards, mm."""
        return np.asarray(self.up.mean(axis=1))

    @cached_property
    def mean_down(self) -> Floats:
        """The same downwards."""
        return np.asarray(self.down.mean(axis=1))

    @property
    def mean(self) -> Floats:
        """The mean bidirectional deviations (m,), mm."""
        return (self.mean_up + self.mean_down) / 2.0

    @property
    def reversal(self) -> Floats:
        """The reversal errors B_i (m,), mm."""
        return self.mean_up - self.mean_down

    @cached_property
    def s_up(self) -> Floats:
        """The standard uncertainties (m,) of the approaches upwards, mm."""
        return _spread(self.up)

    @cached_property
    def s_down(self) -> Floats:
        """The same downwards."""
        return _spread(self.down)

    def limits(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Return mean + 2 s upwards, mean - 2 s upwards, and the same downwards, (m,) mm."""
        up, down = COVERAGE * self.s_up, COVERAGE * self.s_down
        return self.mean_up + up, self.mean_up - up, self.mean_down + down, self.mean_down - down

    @cached_property
    def figures(self) -> Mapping[str, float]:
        """The figures of the axis in mm, by their symbols."""
        up, down = 2 * COVERAGE * self.s_up, 2 * COVERAGE * self.s_down
        both = np.maximum.reduce([(up + down) / 2 + np.abs(self.reversal), up, down])
        high_up, low_up, high_down, low_down = self.limits()
        return {
            "A": float(max(high_up.max(), high_down.max()) - min(low_up.min(), low_down.min())),
            "A up": float(high_up.max() - low_up.min()),
            "A down": float(high_down.max() - low_down.min()),
            "R": float(both.max()),
            "R up": float(up.max()),
            "R down": float(down.max()),
            "E": float(np.ptp(np.append(self.mean_up, self.mean_down))),
            "E up": float(np.ptp(self.mean_up)),
            "E down": float(np.ptp(self.mean_down)),
            "M": float(np.ptp(self.mean)),
            "B": float(np.abs(self.reversal).max()),
            "mean B": float(self.reversal.mean()),
        }

    @property
    def end(self) -> float:
        """The mean deviation at the last target less that at the first, mm."""
        return float(self.mean[-1] - self.mean[0])


def _spread(deviations: Floats) -> Floats:
    """Return the standard uncertainty (m,) of deviations (m, n); nan for one run."""
    if deviations.shape[1] < 2:
        return np.full(len(deviations), np.nan)
    return np.asarray(deviations.std(axis=1, ddof=1))
