"""A picture of a machine's kinematics: its rotary axes as lines, their senses, and the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.machine.chain import SPINDLE, Chain, Rotary
from gcxform.plot.canvas import AFTER, BEFORE, GREY, figure, isometric, styled, triad
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AROUND = np.linspace(0.0, 270.0, 49)  # degrees of the arrow of a positive command
SMALLEST = 100.0  # mm that are shown at least


@styled
def chain(shown: Chain, title: str) -> Figure:
    """Return the chain with all axes at 0, from the front right above; arrows turn as + does."""
    made = figure(7.0, 7.0, title)
    axes = made.subplots()
    tip = np.array(shown.tip)
    points = np.array([tip, *(axis.point for axis in shown.axes)])
    size = max(SMALLEST, float(np.ptp(points, axis=0).max()))
    for k, axis in enumerate(shown.axes):
        side = ("table", AFTER) if k < len(shown.table) else ("head", BEFORE)
        _axis(axes, axis, side, 0.35 * size)
    carried = [np.array(axis.point) for axis in shown.table]
    _link(axes, carried, AFTER)
    _link(axes, [*(np.array(axis.point) for axis in shown.head), tip], BEFORE)
    _line(axes, np.array([tip, tip + 0.3 * size * np.array(SPINDLE)]), "tool", linewidth=3.0)
    triad(axes, points.min(axis=0) - 0.5 * size, 0.25 * size)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.08)
    axes.set_axis_off()
    return made


def _axis(axes: Axes, axis: Rotary, side: tuple[str, str], size: float) -> None:
    """Draw a line along an axis, and the arrow of its positive command about it."""
    point, way = np.array(axis.point), np.array(axis.direction)
    name, colour = side
    ends = point + np.outer([-size, size], way)
    _line(axes, ends, f"axis {axis.letter}", color=colour, linestyle="-.")
    across = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
    rim = point + 0.7 * size * way + 0.25 * size * across / np.linalg.norm(across)
    around = axis.turn(np.broadcast_to(rim, (len(AROUND), 3)), AROUND)  # the sense of +
    _line(axes, around, f"{axis.letter}+", color=colour)
    start, end = isometric(around[-2]), isometric(around[-1])
    arrow = {"arrowstyle": "-|>", "color": colour}
    axes.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=arrow)
    place = isometric(ends[1])
    axes.annotate(f" {axis.letter}+ ({name})", xy=tuple(place), color=colour, fontsize=10.0)


def _link(axes: Axes, points: list[Floats], colour: str) -> None:
    """Draw what carries what."""
    if len(points) > 1:
        _line(axes, np.array(points), "carries", color=colour, alpha=0.35, linewidth=4.0)


def _line(axes: Axes, points: Floats, name: str, **style: Any) -> None:
    across, up = isometric(points).T
    axes.plot(across, up, gid=name, **({"color": GREY} | style))
