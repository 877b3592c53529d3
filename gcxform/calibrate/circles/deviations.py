"""The figures of circular tests by ISO 230-4, from the paths of one or both contouring senses.

Circular deviation G is the least radial separation of two concentric circles around the path, for
which the standard admits the range of radii about the least-squares circle, as instruments print it
and as it is taken here. G(b) is that range of both paths about their one circle; it does not have
what the instrument is off the centre (clause 3, and its notes). Radial deviation F is counted from
the nominal circle, positive outwards, about the centre at which the instrument was set up; D is the
radius of the least-squares circle of both paths less the nominal one. H, the hysteresis of the
first edition (1996), is the largest radial difference of both senses at one angle.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from gcxform.calibrate.rotary.circle import circles_in_plane
from gcxform.system.arrays import Floats

SENSES: Final = ("CW", "CCW")
GAP: Final = 5.0  # degrees: farther from a reading of the other sense there is no difference


def least_squares_circle(points: Floats) -> tuple[Floats, float]:
    """Return the centre (2,) and radius in mm of the circle nearest to points (n, 2) in mm.

    The sum of squares of the radial distances is least. Raises ValueError if the points are not
    around a centre.
    """
    if len(points) < 3:
        raise ValueError(f"a circle has 3 points at least, and not {len(points)}")
    mean = points.mean(axis=0)
    with np.errstate(all="ignore"):
        centre, radius, converged = circles_in_plane(points - mean)
    if not converged:
        raise ValueError("the points do not lie around a centre")
    return mean + centre, float(radius)


def circular_deviation(points: Floats) -> float:
    """Return the range of radii in mm of points (n, 2) about their least-squares centre: G."""
    centre, _ = least_squares_circle(points)
    radii = np.hypot(*(points - centre).T)
    return float(radii.max() - radii.min())


def hysteresis(one: Floats, other: Floats) -> float:
    """Return the largest radial difference in mm of two paths (n, 2), (m, 2) at one angle.

    Between readings a path is taken to be straight; nan where they have no angle in common.
    """
    angle, radius = _polar(one)
    near, between = _polar(other)
    common = _gaps(angle, near) <= np.radians(GAP)
    if not common.any():
        return float("nan")
    there = np.interp(angle, near, between, period=2.0 * np.pi)
    return float(np.abs(radius - there)[common].max())


def _gaps(angle: Floats, near: Floats) -> Floats:
    """Return how far each angle (n,) is from the nearest of others (m,), rad."""
    turn = 2.0 * np.pi
    around = np.sort(near)
    around = np.concatenate([around[-1:] - turn, around, around[:1] + turn])
    place = np.searchsorted(around, angle)
    return np.asarray(np.minimum(around[place] - angle, angle - around[place - 1]))


def _polar(path: Floats) -> tuple[Floats, Floats]:
    return np.arctan2(path[:, 1], path[:, 0]), np.hypot(path[:, 0], path[:, 1])


def figures(paths: Mapping[str, Floats], radius: float) -> dict[str, float]:
    """Return the figures in mm of paths (n, 2) about the pivot, by sense; `radius` is nominal.

    There are those of both senses only where there are two.
    """
    both = np.vstack([*paths.values()])
    found = {f"G({sense})": circular_deviation(path) for sense, path in paths.items()}
    if len(paths) > 1:
        found["G(b)"] = circular_deviation(both)
    for sense, path in paths.items():
        radial = np.hypot(path[:, 0], path[:, 1]) - radius
        found[f"Fmax({sense})"] = float(radial.max())
        found[f"Fmin({sense})"] = float(radial.min())
    found["D"] = least_squares_circle(both)[1] - radius
    if len(paths) > 1:
        one, other = paths.values()
        found["H"] = hysteresis(one, other)
    return found
