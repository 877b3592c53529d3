"""Pictures of error models: the grid of their functions, and their errors over the volume."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.errormodel.model import AXES, ErrorModel, Outside
from gcxform.errormodel.pitch import PitchTables
from gcxform.errormodel.sum import Sum
from gcxform.errormodel.thermal import ThermalScrew
from gcxform.plot.canvas import AFTER, BAR, BEFORE, GREY, INK, MEAN, figure, nice, styled
from gcxform.plot.space import frame, isometric
from gcxform.simulate.virtual import ranges
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
TURNS = "ABC"
PLACES = 5  # of the errors shown, along each axis
FINE = 41  # points of a line of the distorted volume
ENDLESS = 100.0  # mm to each side of 0 of a model that has no limits
SHOWN = 0.06  # part of the volume's diagonal that the largest error is drawn as

REVERSE = " reverse"  # behind the name of a function after travel in the negative direction

Curves = dict[str, tuple[Floats, Floats]]
"""Functions by ISO 230-1 name: position in mm, value in mm or rad."""


def curves(model: ErrorModel) -> Curves:
    """Return the functions of a model that is made of functions of one axis each; else none.

    Straightness holds squareness as the model does: in the slopes.
    """
    found: Curves = {}
    if isinstance(model, ThermalScrew):
        return _stretches(model)
    if isinstance(model, PitchTables):
        return _pitches(model)
    if isinstance(model, Sum):
        return _added(model)
    for axis, function in zip(AXES, getattr(model, "axes", ()), strict=False):
        if function is None:
            continue
        for k, value in enumerate(function.values.T):
            letter = (AXES + TURNS)[k]
            if k < 3 or value.any():
                found[f"E{letter}{axis}"] = (function.position, value)
    return found


def _stretches(model: ThermalScrew) -> Curves:
    """Return the positioning errors of warm axes, which are curved."""
    found: Curves = {}
    for axis, stretch in zip(AXES, model.axes, strict=True):
        if stretch is not None:
            position = np.linspace(stretch.position[0], stretch.position[-1], FINE)
            found[f"E{axis}{axis}"] = position, stretch.at(position)
    return found


def _pitches(model: PitchTables) -> Curves:
    """Return the positioning errors of axes, those of both directions where there is backlash."""
    found: Curves = {}
    for axis, table in zip(AXES, model.axes, strict=True):
        if table is not None:
            found[f"E{axis}{axis}"] = table.position, table.forward
        if table is not None and table.backlash:
            found[f"E{axis}{axis}{REVERSE}"] = table.position, table.reverse
    return found


def _added(model: Sum) -> Curves:
    """Return the sums of the functions of all parts, where all have functions; else none."""
    parts = [curves(part) for part in model.models]
    found: Curves = {}
    for name in dict.fromkeys(name for part in parts for name in part) if all(parts) else ():
        plain = name.removesuffix(REVERSE)
        own = [part.get(name, part.get(plain)) for part in parts]
        there = [curve for curve in own if curve is not None]
        low, high = model.range_of(AXES.index(plain[2]))
        position = np.unique(np.concatenate([curve[0] for curve in there]))
        position = position[(position >= low) & (position <= high)]
        found[name] = position, np.sum([np.interp(position, *curve) for curve in there], axis=0)
    return found


def squareness(found: Curves) -> dict[str, float]:
    """Return C0Y, B0Z and A0Z (rad) between the lines through the ends of the straightness curves.

    The angle between two axes is the sum of the slopes of one in the direction of the other
    (names of ISO 230-1:2012): C0Y turns Y about Z, so that EXY has the slope -C0Y, and so on.
    """
    pairs = {"C0Y": ("EXY", "EYX", -1.0), "B0Z": ("EXZ", "EZX", 1.0), "A0Z": ("EYZ", "EZY", -1.0)}
    return {
        name: sign * (_slope(found[one]) + _slope(found[other]))
        for name, (one, other, sign) in pairs.items()
        if one in found and other in found
    }


def _slope(curve: tuple[Floats, Floats]) -> float:
    position, value = curve
    return float((value[-1] - value[0]) / (position[-1] - position[0]))


@styled
def model(shown: ErrorModel, title: str) -> Figure:
    """Return the picture of a model: the functions it has, the squareness, and the volume.

    There are panes for functions that the model has and for no others: beside the volume where
    they are few, above it where angular errors make them many.
    """
    found = curves(shown)
    if not found:
        made = figure(8.0, 7.4, title)
        _volume(made.add_subplot(), shown)
        return made
    rows = _rows(found)
    high, columns = len(rows), max(map(len, rows))
    wide = columns > len(AXES)
    angles = squareness(found)
    if wide:
        made = figure(2.25 * columns, 1.9 * high + 5.6, title)
        both = made.add_gridspec(2, 1, height_ratios=[1.9 * high, 5.6])
    else:
        made = figure(2.6 * columns + 5.8, max(5.4, 2.5 * high), title)
        both = made.add_gridspec(1, 2, width_ratios=[2.6 * columns, 5.8])
    panes = both[0].subgridspec(high, columns)
    for row, names in enumerate(rows):
        for column, name in enumerate(names):
            _function(made.add_subplot(panes[row, column]), name, found)
    _lower(made, both[1], shown, (angles, wide))
    return made


def _rows(found: Curves) -> list[list[str]]:
    """Return the functions in rows, one an axis; few that fill no rows are one below the other."""
    every = [name for name in found if not name.endswith(REVERSE)]
    rows = [[name for name in every if name[2] == axis] for axis in AXES]
    rows = [row for row in rows if row]
    even = len({tuple(name[1] for name in row) for row in rows}) == 1
    return rows if even or len(every) > len(AXES) else [[name] for name in every]


def _lower(
    made: Figure, place: Any, shown: ErrorModel, said: tuple[Mapping[str, float], bool]
) -> None:
    """Draw the volume, and the squareness if there is any: beside it, or below."""
    angles, beside = said
    if not angles:
        _volume(made.add_subplot(place), shown)
    elif beside:
        parts = place.subgridspec(3, 2, width_ratios=[1.0, 2.4], height_ratios=[1.0, 1.6, 1.0])
        _squareness(made.add_subplot(parts[1, 0]), angles)
        _volume(made.add_subplot(parts[:, 1]), shown)
    else:
        parts = place.subgridspec(2, 1, height_ratios=[4.4, 1.0])
        _volume(made.add_subplot(parts[0]), shown)
        _squareness(made.add_subplot(parts[1]), angles)


def _function(axes: Axes, name: str, found: Curves) -> None:
    """Draw one function over the travel of its axis, in both directions where they differ."""
    scale, unit, colour = (UM, "um", AFTER) if name[1] in AXES else (1e6, "urad", MEAN)
    ways: dict[str, dict[str, Any]] = {
        name: {"color": colour, "label": "forward"},
        name + REVERSE: {"color": BEFORE, "label": "reverse", "linestyle": (0, (4, 1.6))},
    }
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for curve, style in ways.items():
        if curve not in found:
            continue
        position, value = found[curve]
        axes.plot(position, scale * value, gid=curve, **style)
        if len(position) < FINE:
            axes.plot(position, scale * value, ".", color=style["color"], markersize=2.5)
    if name + REVERSE in found:
        axes.legend()
    axes.set_title(f"{name}, {unit}")
    axes.set_xlabel(f"{name[2]}, mm", fontsize=7.0, labelpad=1.0)
    axes.tick_params(labelsize=7.0)


def _squareness(axes: Axes, angles: Mapping[str, float]) -> None:
    """Draw the angles between the axes as bars, with their numbers."""
    names = [*angles]
    values = [1e6 * angles[name] for name in names]
    most = max([1e-9, *map(abs, values)])
    axes.barh(range(len(names)), values, 0.55, color=BAR, gid="squareness")
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.set_yticks([])
    axes.invert_yaxis()
    axes.set_xlim(-2.6 * most, 2.6 * most)
    for row, (name, value) in enumerate(zip(names, values, strict=True)):
        side = "left" if value >= 0.0 else "right"
        words = f" {name} {value:+.3f} urad "
        axes.text(value, row, words, va="center", ha=side, fontsize=7.0, color=INK)
    axes.set_title("squareness, from the ends of the curves, urad")
    axes.grid(visible=False, axis="y")


# --- the volume ---


def _volume(axes: Axes, shown: ErrorModel) -> None:
    """Draw the volume as it is and, magnified, as the machine has it, with errors as arrows."""
    from matplotlib.collections import LineCollection

    box = _shown_box(shown)
    places = [np.linspace(low, high, PLACES if high > low else 1) for low, high in box.tolist()]
    points = np.stack(np.meshgrid(*places, indexing="ij"), axis=-1).reshape(-1, 3)
    error = shown.error(points, Outside.CLAMP)
    largest = float(np.linalg.norm(error, axis=1).max())
    size = float(np.linalg.norm(np.ptp(box, axis=1)))
    factor = nice(SHOWN * size / largest) if largest > 0.0 and size > 0.0 else 1.0
    lines = [line for line in _lines(places)]
    plain = [isometric(line) for line in lines]
    bent = [isometric(line + factor * shown.error(line, Outside.CLAMP)) for line in lines]
    axes.add_collection(LineCollection(plain, colors=GREY, linewidths=0.5, gid="nominal"))
    axes.add_collection(LineCollection(bent, colors=BEFORE, linewidths=0.9, gid="actual"))
    start, tip = isometric(points), isometric(points + factor * error)
    arrows: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.0026}
    axes.quiver(*start.T, *(tip - start).T, color=AFTER, gid="errors", zorder=3, **arrows)
    low, high = box.T
    frame(axes, low, high)
    _scale_bar(axes, factor, largest, box)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.05)
    axes.set_axis_off()
    axes.set_title(f"errors x {factor:g}, largest {UM * largest:.2f} um at the places shown")
    axes.legend(handles=_volume_key(), loc="upper right")


def _volume_key() -> list[Any]:
    """Return what the lines of a volume are."""
    from matplotlib.lines import Line2D

    styles = (("nominal", GREY, 0.8), ("as the machine has it", BEFORE, 1.2), ("error", AFTER, 1.6))
    return [Line2D([], [], color=c, linewidth=w, label=name) for name, c, w in styles]


def _scale_bar(axes: Axes, factor: float, largest: float, box: Floats) -> None:
    """Draw how long a round number of micrometres is, above the volume."""
    if not largest > 0.0:
        return
    length = nice(UM * largest / 2.0) / UM  # mm
    corner = isometric(np.array([box[0, 0], box[1, 0], box[2, 1]]))
    left, up = float(corner[0]), float(isometric(box[:, 1] * [0, 1, 1] + box[:, 0] * [1, 0, 0])[1])
    ends = left, left + factor * length
    axes.plot(ends, (up, up), color=AFTER, linewidth=2.4, gid="scale bar", solid_capstyle="butt")
    axes.annotate(
        f"{UM * length:g} um", (left, up), (0, 4), textcoords="offset points", color=INK, fontsize=7
    )


def _shown_box(shown: ErrorModel) -> Floats:
    """Return the volume (3, 2) in mm that is drawn: that of the model, or one if it has no end."""
    box = ranges(shown)
    return box if (box[:, 1] > box[:, 0]).any() else np.tile([-ENDLESS, ENDLESS], (3, 1))


def _lines(places: list[Floats]) -> Iterator[Floats]:
    """Yield the lines (k, 3) of the grid on the outside of the volume."""
    for axis, along in enumerate(places):
        if len(along) < 2:
            continue
        one, other = (k for k in range(3) if k != axis)
        for p in places[one]:
            for q in places[other]:
                outer = p in places[one][[0, -1]] or q in places[other][[0, -1]]
                if outer:
                    line = np.empty((FINE, 3))
                    line[:, axis] = np.linspace(along[0], along[-1], FINE)
                    line[:, one], line[:, other] = p, q
                    yield line
