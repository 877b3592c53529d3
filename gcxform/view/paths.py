"""The columns of a toolpath as packed whole numbers, with what the page needs to draw them."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.path import Kind, Plane, Toolpath
from gcxform.view.packing import Section, Store

STEPS: Final = (1e-3, 1e-4)  # mm or degrees that are tried as the unit of a column, coarse first
ON_STEP: Final = 1e-7  # mm; a column of which all positions are so near to steps is on them
ANGLE: Final = 1e-6  # rad, the unit of sweeps
FEED: Final = 1e-3  # mm/min and the like
VECTOR: Final = 1e-4
PLANES: Final = [list(plane.axes) for plane in Plane]


def packed(path: Toolpath, store: Store) -> dict[str, Any]:
    """Add a path to a store; return what its columns are and where they are."""
    end, unknown = _filled(path)
    found: dict[str, Any] = {
        "moves": len(path),
        "axes": path.axes,
        "linear": [axis in LINEAR for axis in path.axes],
        "entry": np.nan_to_num(path.entry, posinf=0.0, neginf=0.0).tolist(),
        "entryUnknown": [not known for known in np.isfinite(path.entry).tolist()],
        "planes": PLANES,
        "kind": store.ints(path.kind),
        "form": store.ints(path.form),
        "unknown": store.ints(unknown),
        "block": store.ints(path.source),
        "frame": store.ints(path.frame),
        "feed": store.lengths(path.feed, FEED),
        "mode": store.ints(path.feed_mode),
        "ends": [store.lengths(column, step_of(column)) for column in end.T],
    }
    if path.has_arcs:
        found["arcs"] = _arcs(path, end, store)
    if path.has_splines:
        rows = np.flatnonzero(path.is_spline)
        control = path.control[rows].reshape(len(rows), 6)
        found["splines"] = [store.lengths(column, STEPS[-1]) for column in control.T]
    if np.isfinite(path.tool).any():
        found["vectors"] = [store.lengths(column, VECTOR) for column in path.tool.T]
    return found


def _filled(path: Toolpath) -> tuple[Floats, Ints]:
    """Return ends with what is not known as it was last, and the axes (bits) not known there.

    A position that was lost before a move is not known at its start: bit k + 16 stands for axis k.
    """
    end = np.array(path.end)
    known = np.isfinite(end)
    here = np.arange(len(end))
    bits = np.zeros(len(end), np.int64)
    for axis in range(end.shape[1]):
        if not known[:, axis].all():
            last = np.maximum.accumulate(np.where(known[:, axis], here, -1))
            entry = path.entry[axis] if np.isfinite(path.entry[axis]) else 0.0
            end[:, axis] = np.where(last >= 0, end[np.maximum(last, 0), axis], entry)
            bits |= np.where(known[:, axis], 0, 1 << axis)
    return end, bits | (path.lost << 16)


def step_of(column: Floats) -> float:
    """Return the coarsest step on which all values are; the finest where they are on none."""
    known = column[np.isfinite(column)]
    for step in STEPS:
        if not (np.abs(known - np.round(known / step) * step) > ON_STEP).any():
            return step
    return STEPS[-1]


def _arcs(path: Toolpath, end: Floats, store: Store) -> dict[str, Section]:
    """Add plane, centre from the end, and sweep of the arcs."""
    rows = np.flatnonzero(path.kind >= Kind.ARC_CW)
    axes = np.array([plane.axes[:2] for plane in Plane])[path.plane[rows]]
    away = np.stack([path.centre[rows, axes[:, k]] - end[rows, axes[:, k]] for k in (0, 1)])
    return {
        "plane": store.ints(path.plane[rows]),
        "first": store.lengths(away[0], STEPS[-1]),
        "second": store.lengths(away[1], STEPS[-1]),
        "sweep": store.lengths(path.sweep[rows], ANGLE),
    }
