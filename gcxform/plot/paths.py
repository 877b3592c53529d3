"""Deviations along the path of a program as colours, before and after compensation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.plot.canvas import GREY, empty, figure, isometric, styled, triad
from gcxform.simulate.heat import Heat

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
AS_LINES = 20_000  # pieces; more are drawn as an image within an SVG


@styled
def heat(before: Heat, after: Heat, title: str) -> Figure:
    """Return both paths from the front right above, in colours of one scale."""
    made = figure(12.0, 6.0, title)
    grid = made.subplots(1, 2)
    most = UM * max(before.largest, after.largest) or 1.0
    drawn = None
    for axes, found, name in zip(grid, (before, after), ("before", "after"), strict=True):
        drawn = _path(axes, found, name, most) or drawn
    if drawn is not None:
        made.colorbar(
            drawn, ax=list(grid), label="distance from the programmed path, um", shrink=0.8
        )
    return made


def _path(axes: Axes, found: Heat, name: str, most: float) -> Any:
    """Draw one path, the worst pieces on top; return what the colours are of."""
    from matplotlib.collections import LineCollection

    feeds = np.flatnonzero(~found.rapid)
    if not len(feeds):
        empty(axes, f"{name}: nothing but rapids")
        return None
    order = feeds[np.argsort(found.deviation[feeds], kind="stable")]
    lines = np.stack([isometric(found.start), isometric(found.end)], axis=1)
    many = len(lines) > AS_LINES
    rapids = list(lines[found.rapid])
    axes.add_collection(
        LineCollection(rapids, colors=GREY, linewidths=0.3, linestyles=":", rasterized=many)
    )
    drawn = LineCollection(
        list(lines[order]), cmap="turbo", linewidths=1.4, gid=name, rasterized=many
    )
    drawn.set_array(UM * found.deviation[order])
    drawn.set_clim(0.0, most)
    axes.add_collection(drawn)
    both = np.vstack([found.start, found.end])
    low, high = both.min(axis=0), both.max(axis=0)
    size = float(np.linalg.norm(high - low))
    triad(axes, low - 0.05 * size, 0.12 * size)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.05)
    axes.set_axis_off()
    axes.set_title(f"{name}: at most {UM * found.largest:.2f} um")
    return drawn
