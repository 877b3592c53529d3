"""Pictures of error models: the grid of their functions, and their errors over the volume."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.errormodel.model import AXES, ErrorModel, Outside
from gcxform.errormodel.pitch import PitchTables
from gcxform.errormodel.sum import Sum
from gcxform.errormodel.thermal import ThermalScrew
from gcxform.plot.canvas import AFTER, BEFORE, GREY, empty, figure, isometric, nice, styled, triad
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
    """Return the picture of a model: the grid of functions, if it has any, above the volume."""
    found = curves(shown)
    if not found:
        made = figure(8.0, 7.0, title)
        _volume(made.add_subplot(), shown)
        return made
    made = figure(13.0, 13.0, title)
    grid = made.add_gridspec(4, 6, height_ratios=[1.0, 1.0, 1.0, 3.0])
    for row, axis in enumerate(AXES):
        for column, letter in enumerate(AXES + TURNS):
            _function(made.add_subplot(grid[row, column]), f"E{letter}{axis}", found)
    _squareness(made.add_subplot(grid[3, :2]), found)
    _volume(made.add_subplot(grid[3, 2:]), shown)
    return made


def _function(axes: Axes, name: str, found: Curves) -> None:
    """Draw one function over the travel of its axis."""
    if name not in found:
        empty(axes, f"{name}: none")
        return
    position, value = found[name]
    axes.plot(
        position,
        UM * value if name[1] in AXES else 1e6 * value,
        color=BEFORE if name[1] in AXES else AFTER,
        gid=name,
    )
    if name + REVERSE in found:
        position, value = found[name + REVERSE]
        axes.plot(position, UM * value, color=AFTER, gid=name + REVERSE)
        axes.legend(["forward", "reverse"])
    axes.set_title(f"{name}, {'um' if name[1] in AXES else 'urad'}")
    axes.set_xlabel(f"{name[2]}, mm")


def _squareness(axes: Axes, found: Curves) -> None:
    """Write the angles between the axes."""
    lines = [f"{name} {1e6 * value:+.3f} urad" for name, value in squareness(found).items()]
    empty(axes, "\n".join(["squareness, from the ends of the curves", *lines]))


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
    axes.add_collection(LineCollection(plain, colors=GREY, linewidths=0.4, gid="nominal"))
    axes.add_collection(LineCollection(bent, colors=BEFORE, linewidths=0.7, gid="actual"))
    start, tip = isometric(points), isometric(points + factor * error)
    arrows: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.0022}
    axes.quiver(*start.T, *(tip - start).T, color=AFTER, gid="errors", zorder=3, **arrows)
    low, high = box.T
    triad(axes, low - 0.12 * (high - low), 0.15 * size)
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.margins(0.05)
    axes.set_axis_off()
    axes.set_title(f"errors x {factor:g}, largest {UM * largest:.2f} um at the places shown")


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
