"""A picture of a machine: what turns what, about which axes, where they are, and the tool.

It is seen from the front right above with all rotary axes at 0. What turns the table is drawn as
bearings with a cradle between them, and the plate on which the workpiece stands, what turns the
head as joints down to the spindle. X, Y and Z stand where the tip is above the plate, as on a
machine that is about to cut. Arrows turn as a positive command does; from each pivot to the next
stand the distances in X, Y and Z, and beside the picture the numbers of the machine file.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.machine.chain import SPINDLE, Chain, Rotary
from gcxform.plot.canvas import AFTER, BEFORE, GREY, INK, MEAN, figure, styled
from gcxform.plot.space import isometric, ring, triad
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AROUND = np.linspace(0.0, 270.0, 49)  # degrees of the arrow of a positive command
SMALLEST = 100.0  # mm that are shown at least
PLATE = 0.42  # of the size, the radius of the table
STEEL = "#b8bdc1"
CLOSE = 1e-6  # mm: no distance


@styled
def chain(shown: Chain, title: str) -> Figure:
    """Return the chain with all axes at 0, from the front right above; arrows turn as + does."""
    made = figure(11.0, 7.2, title)
    axes, beside = made.subplots(1, 2, width_ratios=[2.6, 1.0])
    size = _size(shown)
    away = _above(shown, size)
    for axis in shown.table:
        _axis(axes, axis, np.zeros(3), ("table", AFTER), 0.8 * size)
    for axis in shown.head:
        _axis(axes, axis, away, ("head", BEFORE), 0.45 * size)
    _table(axes, shown, size)
    _head(axes, shown, away, size)
    _distances(axes, shown, away)
    points = [np.array(axis.point) for axis in shown.table] or [np.array(shown.tip)]
    corner = np.mean(points, axis=0) - size * np.array([1.15, 0.75, 0.4])
    triad(axes, corner, 0.25 * size)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.06)
    axes.set_axis_off()
    _numbers(beside, shown)
    return made


def _size(shown: Chain) -> float:
    """Return how large the machine is drawn, mm: as its pivots are apart, at least."""
    table = np.array([axis.point for axis in shown.table] or [shown.tip])
    head = np.array([shown.tip, *(axis.point for axis in shown.head)])
    spans = (np.ptp(table, axis=0).max(), np.ptp(head, axis=0).max(), 0.8 * _length(shown))
    return max(SMALLEST, *map(float, spans))


def _length(shown: Chain) -> float:
    """Return how long the tool is: from the tip up to the gauge point, if the tip is below it."""
    return max(0.0, -shown.tip[2])


def _above(shown: Chain, size: float) -> Floats:
    """Return by how much (3,) X, Y and Z stand off 0, so that the tip is above the table."""
    if not shown.table:
        return np.zeros(3)
    place = np.array(shown.table[-1].point) + size * np.array([0.14, 0.14, 0.24])
    return np.asarray(place - np.array(shown.tip))


# --- bodies ---


def _table(axes: Axes, shown: Chain, size: float) -> None:
    """Draw what carries the workpiece: bearings and cradles, and the plate on the last axis."""
    if not shown.table:
        floor = np.array(shown.tip) - 0.2 * size * np.array(SPINDLE)
        _body(axes, floor, np.array(SPINDLE), (PLATE * size, -0.09 * size), "table", STEEL)
        return
    *carriers, last = shown.table
    plate, up = np.array(last.point), np.array(last.direction)
    for axis in carriers:
        way, middle = np.array(axis.direction), np.array(axis.point)
        ends = middle + np.outer([-0.56 * size, 0.56 * size], way)
        below = plate - 0.16 * size * up
        corners = [ends[0], below - 0.4 * size * way, below + 0.4 * size * way, ends[1]]
        _link(axes, corners, AFTER)
        for end, outwards in zip(ends, (-way, way), strict=True):
            _body(axes, end, outwards, (0.12 * size, 0.07 * size), "bearing", AFTER)
    _body(axes, plate, up, (PLATE * size, -0.08 * size), "table", AFTER)


def _head(axes: Axes, shown: Chain, away: Floats, size: float) -> None:
    """Draw the spindle above the tool, and the joints of the head that carry it."""
    way, tip = np.array(SPINDLE), np.array(shown.tip) + away
    nose = tip + (_length(shown) or 0.25 * size) * way
    _link(axes, [*(np.array(axis.point) + away for axis in shown.head), nose], BEFORE)
    for axis in shown.head:
        around = np.array(axis.direction)
        middle = np.array(axis.point) + away - 0.05 * size * around
        _body(axes, middle, around, (0.12 * size, 0.1 * size), "joint", BEFORE)
    _body(axes, nose, way, (0.12 * size, 0.26 * size), "spindle", INK)
    _body(axes, nose, way, (0.07 * size, -0.07 * size), "holder", INK)
    _line(axes, np.array([tip, nose]), "tool", color=INK, linewidth=3.5, solid_capstyle="butt")
    across, up = isometric(tip).tolist()
    axes.plot([across], [up], "v", color=INK, markersize=6.0, gid="tip")
    _words(axes, tip, "tip", (7.0, -6.0), INK)


def _body(
    axes: Axes, middle: Floats, way: Floats, sizes: tuple[float, float], name: str, colour: str
) -> None:
    """Draw a cylinder of a radius and a length along a unit vector."""
    from matplotlib.patches import Polygon

    radius, length = sizes
    near, far = ring(middle, way, radius), ring(middle + length * way, way, radius)
    hull = _outline(np.vstack([isometric(near), isometric(far)]))
    style: dict[str, Any] = {"facecolor": colour, "edgecolor": colour, "linewidth": 0.8}
    axes.add_patch(Polygon(hull, alpha=0.18, gid=name, **style))
    for end in (near, far):
        axes.plot(*isometric(end).T, color=colour, linewidth=0.8, alpha=0.8)


def _outline(points: Floats) -> Floats:
    """Return the convex outline of points (n, 2)."""
    from scipy.spatial import ConvexHull

    return np.asarray(points[ConvexHull(points).vertices])


def _link(axes: Axes, points: list[Floats], colour: str) -> None:
    """Draw what carries what."""
    if len(points) > 1:
        _line(axes, np.array(points), "carries", color=colour, alpha=0.3, linewidth=7.0)


# --- axes ---


def _axis(axes: Axes, axis: Rotary, away: Floats, side: tuple[str, str], size: float) -> None:
    """Draw a line along an axis, its pivot, and the arrow of its positive command about it.

    `away` (3,) is how far off its place it is drawn, with X, Y and Z.
    """
    point, way = np.array(axis.point) + away, np.array(axis.direction)
    name, colour = side
    ends = point + np.outer([-size, size], way)
    _line(axes, ends, f"axis {axis.letter}", color=colour, linestyle="-.", linewidth=1.0)
    across = np.cross(way, np.eye(3)[np.argmin(np.abs(way))])
    rim = 0.92 * size * way + 0.17 * size * across / np.linalg.norm(across)
    around = axis.swing(np.broadcast_to(rim, (len(AROUND), 3)), AROUND) + point  # the sense of +
    _line(axes, around, f"{axis.letter}+", color=colour, linewidth=1.8)
    start, end = isometric(around[-3]), isometric(around[-1])
    arrow = {"arrowstyle": "-|>", "color": colour, "mutation_scale": 14.0}
    axes.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=arrow)
    words = f"{axis.letter}+ ({name})"
    upright = abs(float(way[2])) > abs(float(way[0])) and name == "table"
    offset, anchor = ((-7.0, 9.0), "right") if upright else ((6.0, 3.0), "left")
    _words(axes, ends[1], words, offset, colour, fontsize=11.0, weight="bold", ha=anchor)
    centre, up = isometric(point).tolist()
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": colour}
    axes.plot([centre], [up], "o", gid=f"pivot {axis.letter}", markersize=5.0, zorder=4, **style)


# --- distances ---


def _distances(axes: Axes, shown: Chain, away: Floats) -> None:
    """Dimension the way from pivot to pivot, and that of the head to the tip."""
    table = [np.array(axis.point) for axis in shown.table]
    head = [np.array(axis.point) + away for axis in shown.head]
    tip = np.array(shown.tip) + away
    gauge = np.add(tip, (0.0, 0.0, _length(shown)))
    last = [tip] if head or not _length(shown) else [gauge, tip]
    for chained in (table, [*head, *last]):
        for start, end in itertools.pairwise(chained):
            _steps(axes, start, end)


def _steps(axes: Axes, start: Floats, end: Floats) -> None:
    """Draw the way from a point to another along X, Y and Z, each with its length in mm."""
    place = start.copy()
    for k, letter in enumerate("XYZ"):
        length = float(end[k] - place[k])
        if abs(length) < CLOSE:
            continue
        before = place.copy()
        place[k] = end[k]
        leg = np.array([before, place])
        _line(axes, leg, "distance", color=MEAN, linewidth=0.9, marker="|", markersize=4.0)
        offset = (3.0, 2.0) if letter == "Z" else (2.0, -8.0)
        _words(axes, leg.mean(axis=0), f"{letter} {length:g}", offset, MEAN, fontsize=6.5)


def _words(
    axes: Axes, place: Floats, text: str, offset: tuple[float, float], colour: str, **style: Any
) -> None:
    across, up = isometric(place).tolist()
    axes.annotate(text, (across, up), offset, textcoords="offset points", color=colour, **style)


def _line(axes: Axes, points: Floats, name: str, **style: Any) -> None:
    across, up = isometric(points).T
    axes.plot(across, up, gid=name, **({"color": GREY} | style))


# --- numbers ---


def _numbers(axes: Axes, shown: Chain) -> None:
    """Write what the machine file says of each axis, those of the table first."""
    axes.set_axis_off()
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(max(24.0, 8.0 * len(shown.axes) + 4.0), 0.0)
    row = 1.0
    for k, axis in enumerate(shown.axes):
        turns, colour = ("table", AFTER) if k < len(shown.table) else ("head", BEFORE)
        head = f"{axis.letter}, turns the {turns}"
        axes.text(0.0, row, head, color=colour, weight="bold", fontsize=9.0, va="center")
        for line in _said(axis):
            row += 1.15
            axes.text(0.04, row, line, color=INK, fontsize=7.5, va="center")
        row += 2.2
    words = " ".join(f"{letter}{value:g}" for letter, value in zip("XYZ", shown.tip, strict=True))
    lines = [f"tip at {words}, all axes at 0"]
    lines += ["drawn with the tip above the table"] if shown.table else []
    for line in lines:
        axes.text(0.0, row, line, color=INK, fontsize=7.5, va="center")
        row += 1.15


def _said(axis: Rotary) -> list[str]:
    """Return what a machine file says of an axis, in lines."""
    point = " ".join(f"{letter}{value:g}" for letter, value in zip("XYZ", axis.point, strict=True))
    way = ", ".join(f"{value:.6g}" for value in axis.direction)
    sense = "right-handed" if axis.sign > 0 else "left-handed"
    lines = [f"pivot {point} mm", f"direction {way}", f"+ turns {sense} about it"]
    if axis.limits is not None:
        lines.append("limits {:g} to {:g} degrees".format(*axis.limits))
    if axis.wrap is not None:
        lines.append(f"a turn is {axis.wrap:g} degrees")
    return lines
