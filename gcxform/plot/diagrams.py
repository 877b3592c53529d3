"""The diagrams that instruments print: polar ones of circles, lines over targets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.plot.canvas import AFTER, BEFORE, GREY, MANY, empty, figure, styled
from gcxform.plot.polar import circle_diagram
from gcxform.simulate.circles import Circles
from gcxform.simulate.figures import Positioning
from gcxform.simulate.virtual import BODY, FACES, Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm


# --- circles ---


@styled
def circles(outcome: Outcome[Circles], title: str) -> Figure:
    """Return the polar diagrams of a ballbar test: a row a plane, before beside after."""
    made = figure(7.6, 4.3 * len(outcome.before) + 0.5, title)
    grid = made.add_gridspec(len(outcome.before), 2)
    for column, (side, read) in enumerate((("before", outcome.before), ("after", outcome.after))):
        for row, (plane, found) in enumerate(read.items()):
            axes = made.add_subplot(grid[row, column], projection="polar")
            _polar(axes, found, plane, f"{plane} {side}")
    return made


def _polar(axes: Any, found: Circles, plane: str, name: str) -> None:
    """Draw the radial deviations of both senses, magnified, about the nominal circle."""
    paths = {"CW": found.cw, "CCW": found.ccw}
    division = circle_diagram(axes, paths, found.radius, plane, name)
    figures = {symbol: UM * value for symbol, value in found.figures.items()}
    rows = (("G(CW)", "G(CCW)", "G(b)"), ("Fmax(CCW)", "Fmin(CCW)", "D"))
    lines = ["  ".join(f"{symbol} {figures[symbol]:.2f}" for symbol in row) for row in rows]
    axes.set_title("\n".join([f"{name}, {division:g} um/div", lines[0], f"{lines[1]} um"]))
    axes.legend(loc="lower left", bbox_to_anchor=(-0.12, -0.1))


# --- lines ---


@styled
def positioning(outcome: Outcome[Positioning], title: str) -> Figure:
    """Return the deviations over the targets: a column an axis, before above after."""
    made = figure(4.4 * len(outcome.before), 7.6, title)
    grid = made.subplots(2, len(outcome.before), squeeze=False)
    for row, (side, read) in enumerate((("before", outcome.before), ("after", outcome.after))):
        for axes, (name, found) in zip(grid[row], read.items(), strict=True):
            _positions(axes, found, f"{name} {side}")
    return made


def _positions(axes: Axes, found: Positioning, name: str) -> None:
    """Draw every reading, the means of both directions, and the bands of 2 s about them."""
    high_up, low_up, high_down, low_down = (UM * limit for limit in found.limits())
    ways = (
        ("up", found.up, found.mean_up, low_up, high_up, ("^", AFTER, "-")),
        ("down", found.down, found.mean_down, low_down, high_down, ("v", BEFORE, (0, (4, 1.6)))),
    )
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for way, readings, mean, low, high, (mark, colour, line) in ways:
        if np.isfinite(low).all():
            band: dict[str, Any] = {"color": colour, "alpha": 0.16, "linewidth": 0.0}
            label = f"mean {way} +- 2 s"
            axes.fill_between(
                found.target, low, high, label=label, gid=f"{name} band {way}", **band
            )
            edge: dict[str, Any] = {"color": colour, "linewidth": 0.6, "linestyle": ":"}
            axes.plot(found.target, low, gid=f"{name} low {way}", **edge)
            axes.plot(found.target, high, gid=f"{name} high {way}", **edge)
        runs = np.broadcast_to(found.target[:, None], readings.shape)
        axes.plot(runs.ravel(), UM * readings.ravel(), mark, color=colour, markersize=2.2)
        style: dict[str, Any] = {"color": colour, "linestyle": line, "linewidth": 1.2}
        axes.plot(found.target, UM * mean, label=f"mean {way}", gid=f"{name} mean {way}", **style)
    axes.set_title(name)
    axes.set_xlabel("target, mm")
    axes.set_ylabel("deviation, um")
    rows = (("A", "R", "E"), ("M", "B"))
    lines = ["   ".join(_figure(found.figures, symbol) for symbol in row) for row in rows]
    place: dict[str, Any] = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.16), "ncols": 2}
    key = axes.legend(title="   ".join(lines) + " um", **place)
    key.get_title().set(weight="bold", fontsize=7.5)


def _figure(figures: Mapping[str, float], symbol: str) -> str:
    value = figures[symbol]
    return f"{symbol} -" if np.isnan(value) else f"{symbol} {UM * value:.2f}"


@styled
def diagonals(outcome: Outcome[Positioning], title: str) -> Figure:
    """Return the mean deviations along body and face diagonals, before above after."""
    made = figure(9.6, 7.6, title)
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
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    for name, colour, mark in zip(there, MANY, "o^svDx", strict=False):
        found = read[name]
        value = UM * (found.mean - found.mean[0])
        label = f"{name}  E {UM * found.figures['E']:.2f} um"
        style: dict[str, Any] = {"color": colour, "marker": mark, "markersize": 3.5}
        axes.plot(found.target, value, label=label, gid=f"{name} {title.split()[-1]}", **style)
    axes.set_title(title)
    axes.set_xlabel("way along the diagonal, mm")
    axes.set_ylabel("deviation from the start, um")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)
