"""The diagrams that instruments print: polar ones of circles, lines over targets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.plot.canvas import AFTER, BEFORE, empty, figure, magnified, styled
from gcxform.simulate.circles import Circles
from gcxform.simulate.figures import Positioning
from gcxform.simulate.virtual import BODY, FACES, Outcome
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
POINTS = 720  # drawn of a circle


# --- circles ---


@styled
def circles(outcome: Outcome[Circles], title: str) -> Figure:
    """Return the polar diagrams of a ballbar test: a column a plane, before above after."""
    made = figure(3.6 * len(outcome.before), 8.0, title)
    sides = {"before": outcome.before, "after": outcome.after}
    places = iter(range(1, 1 + 2 * len(outcome.before)))
    for side, read in sides.items():
        for plane, found in read.items():
            axes = made.add_subplot(2, len(read), next(places), projection="polar")
            _polar(axes, found, f"{plane} {side}")
    return made


def _polar(axes: Any, found: Circles, name: str) -> None:
    """Draw the radial deviations of both senses, magnified, about the nominal circle."""
    paths = {"cw": (found.cw, BEFORE), "ccw": (found.ccw, AFTER)}
    most = max(float(np.abs(found.radial(path)).max()) for path, _ in paths.values())
    for sense, (path, colour) in paths.items():
        angle, value = _around(path, UM * found.radial(path))
        axes.plot(angle, value, color=colour, label=sense.upper(), gid=f"{name} {sense}")
    division = magnified(axes, UM * most)
    figures = {symbol: UM * value for symbol, value in found.figures.items()}
    lines = [
        f"{name}, {division:g} um/div",
        "  ".join(f"{s} {figures[s]:.2f}" for s in ("G(CW)", "G(CCW)", "G(b)")),
        "  ".join(f"{s} {figures[s]:.2f}" for s in ("Fmax(CCW)", "Fmin(CCW)")) + " um",
    ]
    axes.set_title("\n".join(lines))
    axes.set_xticks(np.radians(range(0, 360, 45)), _around_labels(name))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.1, -0.1))


def _around_labels(plane: str) -> list[str]:
    """Return what stands around a circle: its axes, the first of the plane at 0, and degrees."""
    ways = {0: f"+{plane[0]}", 90: f"+{plane[1]}", 180: f"-{plane[0]}", 270: f"-{plane[1]}"}
    return [ways.get(angle, f"{angle}°") for angle in range(0, 360, 45)]


def _around(path: Floats, value: Floats) -> tuple[Floats, Floats]:
    """Return angles (rad) and values of a closed path, in the order of the angle, not too many."""
    angle = np.arctan2(path[:, 1], path[:, 0])
    order = np.argsort(angle, kind="stable")[:: max(1, len(path) // POINTS)]
    order = np.append(order, order[:1])
    return angle[order], value[order]


# --- lines ---


@styled
def positioning(outcome: Outcome[Positioning], title: str) -> Figure:
    """Return the deviations over the targets: a column an axis, before above after."""
    made = figure(4.2 * len(outcome.before), 6.4, title)
    grid = made.subplots(2, len(outcome.before), squeeze=False)
    for row, (side, read) in enumerate((("before", outcome.before), ("after", outcome.after))):
        for axes, (name, found) in zip(grid[row], read.items(), strict=True):
            _positions(axes, found, f"{name} {side}")
    return made


def _positions(axes: Axes, found: Positioning, name: str) -> None:
    """Draw every reading, the means of both directions, and the limits of 2 s about them."""
    high_up, low_up, high_down, low_down = (UM * limit for limit in found.limits())
    ways = (
        ("up", found.up, found.mean_up, low_up, high_up, BEFORE),
        ("down", found.down, found.mean_down, low_down, high_down, AFTER),
    )
    for way, readings, mean, low, high, colour in ways:
        runs = np.broadcast_to(found.target[:, None], readings.shape)
        axes.plot(runs.ravel(), UM * readings.ravel(), ".", color=colour, markersize=2.0)
        axes.plot(
            found.target, UM * mean, color=colour, label=f"mean {way}", gid=f"{name} mean {way}"
        )
        if np.isfinite(low).all():
            band: dict[str, Any] = {"color": colour, "linewidth": 0.6, "linestyle": ":"}
            axes.plot(found.target, low, gid=f"{name} low {way}", **band)
            axes.plot(found.target, high, gid=f"{name} high {way}", **band)
    figures = "  ".join(_figure(found.figures, s) for s in ("A", "R", "E", "M", "B"))
    axes.set_title(f"{name}\n{figures} um")
    axes.set_xlabel("target, mm")
    axes.set_ylabel("deviation, um")
    axes.legend(loc="best")


def _figure(figures: Mapping[str, float], symbol: str) -> str:
    value = figures[symbol]
    return f"{symbol} -" if np.isnan(value) else f"{symbol} {UM * value:.2f}"


@styled
def diagonals(outcome: Outcome[Positioning], title: str) -> Figure:
    """Return the mean deviations along body and face diagonals, before above after."""
    made = figure(9.6, 6.4, title)
    grid = made.subplots(2, 2, squeeze=False)
    for row, (side, read) in enumerate((("before", outcome.before), ("after", outcome.after))):
        for column, (kind, names) in enumerate((("body", BODY), ("face", FACES))):
            _diagonals(grid[row][column], read, names, f"{kind} diagonals {side}")
    return made


def _diagonals(
    axes: Axes, read: Mapping[str, Positioning], names: Sequence[str], title: str
) -> None:
    """Draw the mean deviation of each diagonal from that at its start."""
    there = [name for name in names if name in read]
    if not there:
        empty(axes, f"{title}: none")
        return
    for name in there:
        found = read[name]
        value = UM * (found.mean - found.mean[0])
        label = f"{name}  E {UM * found.figures['E']:.2f} um"
        axes.plot(found.target, value, ".-", label=label, gid=f"{name} {title.split()[-1]}")
    axes.set_title(title)
    axes.set_xlabel("way along the diagonal, mm")
    axes.set_ylabel("deviation from the start, um")
    axes.legend(loc="best")
