"""Space on paper: the isometric view from the front right above, with axes in millimetres."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.plot.canvas import GREY, INK
from gcxform.system.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RIGHT = np.array([1.0, 1.0, 0.0]) / math.sqrt(2.0)
UP = np.array([-1.0, 1.0, 2.0]) / math.sqrt(6.0)
TICKS = 4  # along the longest side of a box; fewer along shorter ones
AWAY = {"X": (0.0, -1.0, 0.0), "Y": (1.0, 0.0, 0.0), "Z": (-0.7, -0.7, 0.0)}
"""In which direction of the machine the numbers of an axis stand beside it."""
ROUND = np.linspace(0.0, 2.0 * np.pi, 73)


def isometric(points: Floats) -> Floats:
    """Return points (..., 3) as they are seen from the front right above, (..., 2)."""
    return np.stack([points @ RIGHT, points @ UP], axis=-1)


def triad(axes: Axes, corner: Floats, length: float) -> None:
    """Draw the directions of X, Y and Z, from a point (3,) in mm."""
    start = isometric(corner)
    for k, letter in enumerate("XYZ"):
        way = np.zeros(3)
        way[k] = length
        end = isometric(corner + way)
        axes.update_datalim([tuple(start.tolist()), tuple(end.tolist())])
        axes.annotate(
            letter,
            xy=(float(start[0]), float(start[1])),
            xytext=(float(end[0]), float(end[1])),
            arrowprops={"arrowstyle": "<-", "color": INK},
            ha="center",
            va="center",
        )


def frame(axes: Axes, low: Floats, high: Floats) -> None:
    """Draw a box from a low to a high corner (3,) in mm: three edges have numbers, as axes do."""
    size = float(np.linalg.norm(high - low)) or 1.0
    _edges(axes, low, high)
    corner = {"X": low, "Y": np.array([high[0], low[1], low[2]]), "Z": low}
    for k, letter in enumerate("XYZ"):
        if high[k] - low[k] > 1e-6 * size:
            _axis(axes, letter, corner[letter], (float(low[k]), float(high[k])), size)


def _edges(axes: Axes, low: Floats, high: Floats) -> None:
    """Draw the edges of a box: those with numbers dark, those behind light."""
    from matplotlib.collections import LineCollection

    corners = np.array([low, high])
    dark: list[Floats] = []
    light: list[Floats] = []
    for k in range(3):
        one, other = (j for j in range(3) if j != k)
        for a in (0, 1):
            for b in (0, 1):
                ends = np.zeros((2, 3))
                ends[:, k] = corners[:, k]
                ends[:, one], ends[:, other] = corners[a, one], corners[b, other]
                numbered = {0: (0, 0), 1: (1, 0), 2: (0, 0)}[k] == (a, b)
                (dark if numbered else light).append(isometric(ends))
    axes.add_collection(LineCollection(light, colors=GREY, linewidths=0.35, alpha=0.6))
    axes.add_collection(LineCollection(dark, colors=INK, linewidths=0.8, gid="frame"))


def _axis(axes: Axes, letter: str, corner: Floats, ends: tuple[float, float], size: float) -> None:
    """Write the numbers along an edge of a box, and its name."""
    k = "XYZ".index(letter)
    away = np.array(AWAY[letter])
    side = {"X": ("right", "top"), "Y": ("left", "top"), "Z": ("right", "center")}[letter]
    for value in ticks(*ends, size):
        place = np.array(corner, np.float64)
        place[k] = value
        mark = isometric(np.array([place, place + 0.012 * size * away]))
        axes.plot(*mark.T, color=INK, linewidth=0.6)
        _write(axes, place + 0.02 * size * away, f"{value:g}", side, fontsize=6.5)
    middle = np.array(corner, np.float64)
    middle[k] = sum(ends) / 2.0
    _write(axes, middle + 0.11 * size * away, f"{letter}, mm", side, fontsize=8.0)


def _write(axes: Axes, place: Floats, text: str, side: Sequence[str], **style: Any) -> None:
    across, up = isometric(place).tolist()
    axes.update_datalim([(across, up)])
    axes.text(across, up, text, ha=side[0], va=side[1], color=INK, **style)


def ticks(low: float, high: float, size: float) -> list[float]:
    """Return round numbers between two, fewer along the short sides of a box of a size."""
    from matplotlib.ticker import MaxNLocator

    count = max(1, round(TICKS * min(1.0, 1.6 * (high - low) / size)))
    values = MaxNLocator(count, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    slack = 1e-3 * (high - low)
    return [float(v) + 0.0 for v in values if low - slack <= v <= high + slack]


def ring(centre: Floats, normal: Floats, radius: float) -> Floats:
    """Return a circle (n, 3) about a point, square to a unit vector, mm."""
    first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    first = first / np.linalg.norm(first)
    second = np.cross(normal, first)
    return np.asarray(
        centre + radius * (np.outer(np.cos(ROUND), first) + np.outer(np.sin(ROUND), second))
    )
