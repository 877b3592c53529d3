"""Deviations along the path of a program as colours, before and after compensation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.plot.canvas import AFTER, GREY, INK, empty, figure, styled
from gcxform.plot.space import frame, isometric
from gcxform.simulate.heat import Heat
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
AS_LINES = 20_000  # pieces; more are drawn as an image within an SVG
PALE, DARK = 0.08, 1.0  # the part of the colours that is seen on paper
WORST = "#c2185b"


@styled
def heat(before: Heat, after: Heat, title: str) -> Figure:
    """Return both paths from the front right above, in colours of one scale."""
    made = figure(13.0, 6.2, title)
    grid = made.subplots(1, 2)
    most = UM * max(before.largest, after.largest) or 1.0
    ends = np.vstack([before.start, before.end, after.start, after.end])
    drawn = None
    for axes, found, name in zip(grid, (before, after), ("before", "after"), strict=True):
        if found.worst is None:
            empty(axes, f"{name}: nothing but rapids")
            continue
        frame(axes, ends.min(axis=0), ends.max(axis=0))
        drawn = _path(axes, found, name, most)
    if drawn is not None:
        bar = made.colorbar(
            drawn, ax=list(grid), label="distance from the programmed path, um", shrink=0.8
        )
        for found, name in ((before, "before"), (after, "after")):
            bar.ax.axhline(UM * found.largest, color=INK, linewidth=0.8)
            bar.ax.annotate(
                f" {name}",
                (1.0, UM * found.largest),
                fontsize=6.5,
                color=INK,
                xycoords=("axes fraction", "data"),
                va="bottom",
                annotation_clip=False,
            )
    return made


def _path(axes: Axes, found: Heat, name: str, most: float) -> Any:
    """Draw one path, the worst pieces on top; return what the colours are of."""
    drawn = _pieces(axes, found, name, most)
    _marks(axes, found, name)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.06)
    axes.set_axis_off()
    axes.set_title(f"{name}: at most {UM * found.largest:.2f} um")
    axes.legend(loc="lower center", ncols=4, bbox_to_anchor=(0.5, -0.06))
    return drawn


def _pieces(axes: Axes, found: Heat, name: str, most: float) -> Any:
    """Draw rapids dotted, and feeds in colours upon grey, so that pale ones are seen as well."""
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection
    from matplotlib.colors import ListedColormap

    lines = np.stack([isometric(found.start), isometric(found.end)], axis=1)
    many = len(lines) > AS_LINES
    style: dict[str, Any] = {"rasterized": many, "capstyle": "round"}
    if found.rapid.any():
        dotted = LineCollection(
            list(lines[found.rapid]), colors=GREY, linewidths=0.5, linestyles=":", rasterized=many
        )
        dotted.set_label("rapid")
        axes.add_collection(dotted)
    feeds = np.flatnonzero(~found.rapid)
    order = feeds[np.argsort(found.deviation[feeds], kind="stable")]
    axes.add_collection(LineCollection(list(lines[order]), colors=GREY, linewidths=2.4, **style))
    colours = ListedColormap(colormaps["viridis_r"](np.linspace(PALE, DARK, 256)))
    drawn = LineCollection(list(lines[order]), cmap=colours, linewidths=1.7, gid=name, **style)
    drawn.set_array(UM * found.deviation[order])
    drawn.set_clim(0.0, most)
    axes.add_collection(drawn)
    return drawn


def _marks(axes: Axes, found: Heat, name: str) -> None:
    """Mark where the path begins and ends, and the worst place with the line it is in."""
    _mark(axes, found.start[0], "o", "start", f"{name} start", AFTER, 10.0)
    _mark(axes, found.end[-1], "s", "end", f"{name} end", INK, 5.0)
    k = found.worst
    assert k is not None
    place = (found.start[k] + found.end[k]) / 2.0
    words = f"{UM * found.deviation[k]:.2f} um, {found.worst_at}".rstrip(", ")
    _mark(axes, place, "D", f"worst: {words}", f"{name} worst", WORST, 6.0)
    across, up = isometric(place).tolist()
    axes.annotate(
        words,
        xy=(across, up),
        xytext=(-14.0, 16.0),
        textcoords="offset points",
        ha="right",
        color=WORST,
        weight="bold",
        arrowprops={"arrowstyle": "-", "color": WORST, "linewidth": 0.8},
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
    )


def _mark(
    axes: Axes, place: Floats, shape: str, label: str, name: str, colour: str, size: float
) -> None:
    across, up = isometric(place).tolist()
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": colour}
    axes.plot(
        [across], [up], shape, label=label, gid=name, markersize=size, markeredgewidth=1.4, **style
    )
