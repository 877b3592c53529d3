"""The sheet of circular tests, as service engineers read it: diagram, figures, causes, the rest.

A row for each test: the polar diagram, the table of what makes it not round, the largest first and
each with its share of the circular deviation, and the residuals over the angle.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.calibrate.circles.circles import Fitted
from gcxform.calibrate.circles.machine import Identified
from gcxform.calibrate.circles.report import machine, share_words, sheet
from gcxform.plot.canvas import BAR, GREY, INK, figure, styled
from gcxform.plot.polar import LINES, circle_diagram

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
WIDE, HIGH = 11.0, 4.9  # inches, of a test
COLUMNS = (0.0, 0.21, 0.755, 0.78)  # name, sizes, effect (its right end), bar
PANEL = 0.10  # of the width, for the number of a share
LINE = 0.2  # inches, of a line about the machine
LEAST = 0.5  # the share for which a bar is as long as can be, at least
ROWS = 14.0  # for which a table has room


@styled
def sheets(found: Identified, title: str) -> Figure:
    """Return the sheet of all tests, with what they tell of the machine under its title."""
    count = len(found.tests)
    words = [*machine(found)] or ["nothing that a model by position could hold"]
    high = LINE * (1 + (len(words) + 1) // 2)
    made = figure(WIDE, HIGH * count + high + 0.4, title)
    ratios = [high, *[0.76 * HIGH, 0.24 * HIGH] * count]
    grid = made.add_gridspec(2 * count + 1, 2, width_ratios=[1.0, 1.35], height_ratios=ratios)
    _machine(made.add_subplot(grid[0, :]), words)
    for k, test in enumerate(found.tests):
        name, row = f"test {k + 1}", 2 * k + 1
        polar = made.add_subplot(grid[row : row + 2, 0], projection="polar")
        _diagram(polar, test, name)
        _table(made.add_subplot(grid[row, 1]), test, name)
        _residuals(made.add_subplot(grid[row + 1, 1]), test, name)
    return made


def _machine(axes: Axes, words: list[str]) -> None:
    """Write what the tests tell of the machine, in two columns."""
    axes.set_axis_off()
    half = (len(words) + 1) // 2
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(half, -1.0)
    axes.text(0.02, -0.6, "the machine", color=GREY, fontsize=7.0, va="center")
    for k, text in enumerate(words):
        place = (0.02 + 0.49 * (k // half), 0.4 + k % half)
        axes.text(*place, text, color=INK, fontsize=8.0, va="center", weight="bold")


def _diagram(axes: Any, test: Fitted, name: str) -> None:
    setup = test.setup
    letters = "".join(setup.letters)
    division = circle_diagram(axes, test.paths, setup.radius, letters, name)
    feed = f", {60.0 * setup.feed:.6g} mm/min" if setup.feed else ""
    axes.set_title(
        f"{name}: {setup.plane}, radius {setup.radius:.6g} mm{feed}\n{division:g} um/div"
    )
    axes.legend(loc="lower left", bbox_to_anchor=(-0.12, -0.08))


def _table(axes: Axes, test: Fitted, name: str) -> None:
    """Write the figures, and a row for each cause with a bar of its share."""
    axes.set_axis_off()
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(ROWS, 0.0)
    lines = sheet(test)
    for row, words in enumerate(_figures(test)):
        axes.text(0.0, 0.3 + 0.95 * row, words, va="center", color=INK, weight="bold", fontsize=7.5)
    whole = "G(b)" if "G(b)" in test.figures else next(iter(test.figures))
    heads = ("cause", "size", "effect, um", f"share of {whole}")
    top = 2.6
    for column, (place, head) in enumerate(zip(COLUMNS, heads, strict=True)):
        side = "right" if column == 2 else "left"
        axes.text(place, top, head, va="center", ha=side, color=GREY, fontsize=7.0)
    step = min(0.95, (ROWS - top - 0.6) / max(1, len(lines)))
    shares = np.nan_to_num([line.share for line in lines])
    widest = max(LEAST, float(shares.max(initial=0.0)))
    for row, line in enumerate(lines):
        y = top + 0.9 + step * row
        write: dict[str, Any] = {"va": "center", "fontsize": 7.0, "color": INK}
        axes.text(COLUMNS[0], y, line.group, **write)
        axes.text(COLUMNS[1], y, line.sizes, **write)
        axes.text(COLUMNS[2], y, f"{UM * line.effect:.2f}", ha="right", **write)
        width = (1.0 - PANEL - COLUMNS[3]) * float(shares[row]) / widest
        bar = axes.barh(y, width, 0.62 * step, COLUMNS[3], color=BAR)
        bar[0].set_gid(f"{name} share {line.group}")
        axes.text(COLUMNS[3] + width + 0.01, y, share_words(line.share), **write)


def _figures(test: Fitted) -> list[str]:
    """Return the figures in two lines: G, D and H, then F."""
    written = {name: f"{name} {UM * value:.2f}" for name, value in test.figures.items()}
    radial = [text for name, text in written.items() if name[0] == "F"]
    other = [text for name, text in written.items() if name[0] != "F"]
    return ["   ".join(other) + " um", "   ".join(radial) + " um"]


def _residuals(axes: Axes, test: Fitted, name: str) -> None:
    """Draw what is left of the readings, with those that were no part of the fit."""
    left = test.by_run(UM * test.residuals)
    for run, values in zip(test.runs, left, strict=True):
        order = np.argsort(run.degrees % 360.0)
        style = LINES[run.name] | {"linewidth": 0.7}
        label = f"{name} residual {run.name.lower()}"
        axes.plot((run.degrees % 360.0)[order], values[order], gid=label, **style)
    axes.set_xlim(0.0, 360.0)
    axes.set_xticks(range(0, 361, 45))
    axes.set_xlabel("angle, degrees")
    axes.set_ylabel("left, um")
    axes.set_title(f"not explained: {UM * test.scatter.observed:.2f} um rms", fontsize=7.5)
