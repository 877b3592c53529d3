"""Circles through points of space, many at once: plane by singular values, centre by distances.

The plane of n points is that of their two largest singular values about the mean. In it Kasa's
circle, which is linear (2 x x0 + 2 y y0 - rho = x^2 + y^2, rho = x0^2 + y0^2 - r^2), is where the
Gauss-Newton steps on the distances to the circle begin; they converge in a few steps where there is
a circle. With the noise s of a coordinate and points all around, the centre is off by s sqrt(5 / n)
rms, whatever the radius r, and the direction by 2 s / (r sqrt n) rad.

Nothing need be known of the angles, and so nothing tests them: `rotary` uses them.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from gcxform.system.arrays import Flags, Floats
from gcxform.values import dataclass

STEPS: Final = 50
CONVERGED: Final = 1e-10
"""The last step of the centre, as a part of the radius."""
FLAT: Final = 1e-9
"""Pivots below this part of the largest are none."""


@dataclass(frozen=True, eq=False)
class Circles:
    """Circles (...): unit normals and centres (..., 3), radii (...), mm; which ones converged.

    The normal has its largest component positive. `singular` (..., 3) are the singular values of
    the points about their mean, mm. Where a circle did not converge its numbers mean nothing.
    """

    direction: Floats
    centre: Floats
    radius: Floats
    singular: Floats
    converged: Flags


def fit_circles(points: Floats) -> Circles:
    """Return the circles through points (..., n, 3) in mm, n >= 3, that are least squares."""
    mean = points.mean(axis=-2, keepdims=True)
    _, singular, axes = np.linalg.svd(points - mean, full_matrices=False)
    flat = (points - mean) @ np.swapaxes(axes[..., :2, :], -1, -2)
    with np.errstate(all="ignore"):
        inside, radius, converged = circles_in_plane(flat)
    centre = mean[..., 0, :] + np.einsum("...k,...ki->...i", inside, axes[..., :2, :])
    return Circles(upright(axes[..., 2, :]), centre, radius, singular, converged)


def spread(points: Floats, circle: Circles, noise: float) -> tuple[Floats, Floats]:
    """Return the covariance (6, 6) of centre (mm) and direction of a circle, of its radius (mm^2).

    With G the rows (cos t, sin t, 1) of the points in its plane, centre and radius have noise^2
    (G'G)^-1, and so have the slopes times the radius, and the height, of the plane.
    """
    axis = circle.direction
    first = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first /= np.linalg.norm(first)
    plane = np.array([first, np.cross(axis, first)])
    flat = (points - circle.centre) @ plane.T
    rows = np.column_stack([flat / np.linalg.norm(flat, axis=1)[:, None], np.ones(len(flat))])
    inverse = noise**2 * np.linalg.inv(rows.T @ rows)
    inside = np.hstack([plane.T, np.zeros((3, 1))])
    height = np.column_stack([np.zeros((3, 2)), axis])
    effect = np.vstack([height, -inside / circle.radius])
    both = effect @ inverse @ effect.T
    both[:3, :3] += inside @ inverse @ inside.T
    return both, np.asarray(inverse[2, 2])


def upright(vectors: Floats) -> Floats:
    """Return unit vectors (..., 3) turned around where their largest component is negative."""
    largest = np.take_along_axis(vectors, np.abs(vectors).argmax(axis=-1)[..., None], axis=-1)
    return np.asarray(np.where(largest < 0.0, -vectors, vectors) + 0.0)


def circles_in_plane(flat: Floats) -> tuple[Floats, Floats, Flags]:
    """Return centres (..., 2), radii (...) and convergence of circles of points (..., n, 2), mm."""
    ones = np.ones((*flat.shape[:-1], 1))
    start = _solve(np.concatenate([2.0 * flat, ones], axis=-1), (flat**2).sum(axis=-1))
    centre, radius = start[..., :2], np.sqrt(start[..., 2] + (start[..., :2] ** 2).sum(axis=-1))
    converged = np.zeros(radius.shape, dtype=bool)
    for _ in range(STEPS):
        away = flat - centre[..., None, :]
        distance = np.sqrt((away**2).sum(axis=-1))
        design = np.concatenate([away / distance[..., None], ones], axis=-1)
        step = _solve(design, distance - radius[..., None])
        centre, radius = centre + step[..., :2], radius + step[..., 2]
        converged = np.abs(step).max(axis=-1) <= CONVERGED * np.abs(radius)
        if converged.all():
            break
    return centre, radius, converged & np.isfinite(radius) & (radius > 0.0)


def _solve(design: Floats, wanted: Floats) -> Floats:
    """Return the least-squares solutions (..., k) of designs (..., n, k); nan if there is none."""
    finite = np.asarray(np.isfinite(design).all(axis=(-1, -2)) & np.isfinite(wanted).all(axis=-1))
    q, r = np.linalg.qr(np.where(finite[..., None, None], design, 0.0))
    diagonal = np.abs(np.diagonal(r, axis1=-2, axis2=-1))
    regular = np.asarray(finite & (diagonal.min(axis=-1) > FLAT * diagonal.max(axis=-1)))
    safe = np.where(regular[..., None, None], r, np.eye(r.shape[-1]))
    right = np.swapaxes(q, -1, -2) @ wanted[..., None]
    found = np.linalg.solve(safe, np.where(regular[..., None, None], right, np.nan))
    return np.asarray(found[..., 0])
