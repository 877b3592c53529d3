"""Figures and files: the style of all pictures, and bytes that are the same on every run.

SVG files have no date, and names that come from a fixed salt.
"""

from __future__ import annotations

import functools
import io
import math
import textwrap
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from gcxform.diagnostics import Location, UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Draw = TypeVar("Draw", bound=Callable[..., Any])

KINDS = (".svg", ".png")
DOTS = 150  # per inch, of PNG
LETTERS = 13  # per inch, of a title
DIVISIONS = 4  # between the centre of a polar diagram and the nominal circle
RINGS = 67.5  # degrees at which the rings of a polar diagram have their numbers
BEFORE, AFTER, MEAN, GREY = "#d55e00", "#0072b2", "#009e73", "#7f8488"
"""Colours that eyes tell apart which do not see red and green (Okabe and Ito), and a grey."""
INK = "#22272b"  # of what is written and not drawn
BAR = "#56b4e9"
MANY = (AFTER, BEFORE, MEAN, "#cc79a7", "#e69f00", INK)  # of what is more than two
STYLE: Any = {
    "svg.hashsalt": "gcxform",  # names inside the file do not change from run to run
    "svg.fonttype": "none",  # text stays text
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.grid": True,
    "grid.linewidth": 0.4,
    "lines.linewidth": 0.9,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "figure.titlesize": 10.0,
}


def check(file: str, option: str = "--plot") -> None:
    """Raise UsageError if a picture of this name, given with an option, cannot be drawn here."""
    if Path(file).suffix.lower() not in KINDS:
        message = f"{file!r} ends neither in .svg nor in .png"
        raise UsageError.one("GX737", message, Location(option))
    if find_spec("matplotlib") is None:
        raise UsageError.one(
            "GX736",
            "pictures are drawn by matplotlib, which is not installed",
            hint="pip install 'gcxform[plot]'",
        )


def styled(draw: Draw) -> Draw:
    """Return a function that draws in the style of all pictures."""

    @functools.wraps(draw)
    def drawn(*args: Any, **options: Any) -> Any:
        import matplotlib

        with matplotlib.rc_context(STYLE):
            return draw(*args, **options)

    return cast(Draw, drawn)


def figure(width: float, height: float, title: str) -> Figure:
    """Return an empty figure of a size in inches, under a title."""
    from matplotlib.figure import Figure

    made = Figure(figsize=(width, height), layout="constrained")
    made.suptitle(textwrap.fill(title, int(width * LETTERS)))
    return made


def rendered(figure: Figure, file: str | None) -> bytes:
    """Return the bytes of a picture, in the format that the name of the file says."""
    import matplotlib

    kind = Path(file or "").suffix.lower().lstrip(".")
    stream = io.BytesIO()
    with matplotlib.rc_context(STYLE):
        metadata = {"Date": None} if kind == "svg" else {}
        figure.savefig(stream, format=kind, dpi=DOTS, metadata=metadata)
    return stream.getvalue()


def nice(value: float) -> float:
    """Return the least of 1, 2, 5 times a power of ten that is not below a value above 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return next((m * power for m in (1.0, 2.0, 5.0) if m * power >= value * (1 - 1e-9)), 10 * power)


def magnified(axes: Any, most: float) -> float:
    """Lay out a polar diagram for deviations of so many um about a nominal circle, in grey.

    Return how many um a division is.
    """
    division = nice(max(most / 2.0, 1e-6))
    axes.plot(np.linspace(0.0, 2.0 * np.pi, 181), np.zeros(181), color=INK, linewidth=0.7)
    ticks = division * np.arange(-DIVISIONS, 3.5)
    axes.set_rlim(ticks[0], ticks[-1])
    axes.set_rticks(ticks[1:-1])
    axes.set_yticklabels([f"{tick:+g}" if tick else "0" for tick in ticks[1:-1]])
    axes.tick_params(axis="y", labelsize=6.0, labelcolor=INK)
    axes.set_rlabel_position(RINGS)
    for label in axes.get_yticklabels():
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8})
    return division


def empty(axes: Axes, text: str) -> None:
    """Leave a place of a grid empty but for a word."""
    axes.set_axis_off()
    axes.text(0.5, 0.5, text, ha="center", va="center", color=GREY, transform=axes.transAxes)
