"""How far `volumetric` may go beyond the tables, forward and back."""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.options import VolumetricOptions

BORDER = 1e-9  # mm
CURVED_CELLS = 1.0  # the bounds of a curved field hold for one cell beyond the table


def check_inside(
    step: VolumetricOptions, path: gx.Toolpath, offset: Floats, rows: Ints, margin: float = 0.0
) -> None:
    """Refuse rows that go beyond the tables, or too far beyond them, by more than `margin` (mm).

    `offset` (n or 1, 3) is table position minus program position.
    """
    points, rows = _points(path, offset, rows)
    check_points(step, path, points, rows, margin)


def check_points(
    step: VolumetricOptions, path: gx.Toolpath, points: Floats, rows: Ints, margin: float = 0.0
) -> None:
    """Refuse points (n, 3) of rows (n,), in the table, as `check_inside` does."""
    beyond = beyond_tables(step, points, margin)
    if beyond.any():
        first = int(np.argmax(beyond))
        _refuse(step, path, int(rows[first]), points[first])


def beyond_tables(step: VolumetricOptions, points: Floats, margin: float = 0.0) -> Flags:
    """Return which points (n, 3), in the table, are farther beyond the tables than is allowed."""
    found = np.zeros(len(points), np.bool_)
    if step.outside in (gx.Outside.ERROR, gx.Outside.EXTRAPOLATE):
        for axis, (low, high) in enumerate(_allowed(step)):
            found |= points[:, axis] < low - margin - BORDER
            found |= points[:, axis] > high + margin + BORDER
    return found


def leaves(step: VolumetricOptions, start: Floats, end: Floats, near: Floats) -> Flags:
    """Return which ways (n,) may go beyond the tables, as far as they are near to a box of ends."""
    low, high = np.minimum(start, end) - near[:, None], np.maximum(start, end) + near[:, None]
    ranges = np.array([step.model.model.range_of(axis) for axis in range(3)])
    return np.asarray(((low < ranges[:, 0]) | (high > ranges[:, 1])).any(axis=1))


def crosses(step: VolumetricOptions, start: Floats, end: Floats, near: Floats) -> Flags:
    """Return which ways (n,) may cross a border of the tables, as far as they are near as well."""
    low, high = np.minimum(start, end) - near[:, None], np.maximum(start, end) + near[:, None]
    ranges = [step.model.model.range_of(axis) for axis in range(3)]
    borders = np.array(ranges).T  # (2, 3)
    return np.asarray(((low < borders[:, None]) & (high > borders[:, None])).any(axis=(0, 2)))


def _allowed(step: VolumetricOptions) -> list[tuple[float, float]]:
    """Return the lowest and the highest position of each axis."""
    cells = _cells(step)
    return [step.model.model.extended(axis, cells) for axis in range(3)]


def beyond(
    step: VolumetricOptions, path: gx.Toolpath, offset: Floats, rows: Ints, more: Floats
) -> dict[str, float]:
    """Return by how much (mm) rows go beyond the tables at most, by what the certificate calls it.

    `offset` is as in `check_inside`; `more` (n, 3) are points in the table besides.
    """
    points = np.vstack([_points(path, offset, rows)[0], more])
    found = {}
    for axis, letter in enumerate("XYZ"):
        low, high = step.model.model.range_of(axis)
        off = np.nan_to_num(np.maximum(low - points[:, axis], points[:, axis] - high))
        if (most := float(off.max(initial=0.0))) > BORDER:
            found[f"{letter} beyond the error table ({step.outside}), mm"] = most
    return found


def _cells(step: VolumetricOptions) -> float:
    """Return by how many cells the tables may be extrapolated."""
    if step.outside is gx.Outside.ERROR:
        return 0.0
    curved = bool(step.model.model.curvature(1.0).any())
    return min(step.max_extrapolation, CURVED_CELLS) if curved else step.max_extrapolation


def _points(path: gx.Toolpath, offset: Floats, rows: Ints) -> tuple[Floats, Ints]:
    """Return the ends of rows and what their arcs reach (n, 3), in the table, with their rows."""
    points = path.end[rows, :3] + (offset if len(offset) == 1 else offset[rows])
    if path.has_arcs:
        more, owners = gx.arc_extremes(path)
        points = np.vstack([points, more + (offset if len(offset) == 1 else offset[owners])])
        rows = np.append(rows, owners)
    return points, rows


def _refuse(step: VolumetricOptions, path: gx.Toolpath, row: int, point: Floats) -> None:
    model, cells = step.model.model, _cells(step)
    pairs = zip(point.tolist(), _allowed(step), strict=True)
    off = [max(low - x, x - high) for x, (low, high) in pairs]
    axis = int(np.argmax(np.array(off) > BORDER))
    low, high = model.range_of(axis)
    value = float(point[axis])
    limit = low if value < low else high
    more = f", by more than {cells:g} cell{'s' * (cells != 1)}" if cells else ""
    raise path.refuse(
        "GX310",
        np.array([row]),
        f"{'XYZ'[axis]} {value:.3f} is outside the error table, which ends at {limit:g}{more}",
        'outside = "clamp" or "extrapolate" goes beyond, or measure a larger volume',
    )
