"""The polar diagram of a circular test: both senses, magnified, about their one circle.

Deviations are from the nominal radius, about the least-squares centre of all readings: what the
pivot is off its place is not in the diagram, and the band between the dotted circles is G(b). The
senses differ in colour and in line, so that they are told apart where they lie on each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from gcxform.calibrate.circles.deviations import least_squares_circle
from gcxform.plot.canvas import AFTER, BEFORE, GREY, MEAN, magnified
from gcxform.system.arrays import Floats

UM = 1000.0  # per mm
POINTS = 720  # drawn of a circle
JUMP = 10.0  # degrees: a trace is not drawn over a gap
LINES: Mapping[str, dict[str, Any]] = {
    "CCW": {"color": AFTER, "linestyle": "-", "linewidth": 1.1},
    "CW": {"color": BEFORE, "linestyle": (0, (4, 1.6)), "linewidth": 1.1},
    "probed": {"color": MEAN, "linestyle": "-", "marker": ".", "markersize": 3.0},
}


def circle_diagram(
    axes: Any, paths: Mapping[str, Floats], radius: float, letters: str, name: str
) -> float:
    """Draw paths (n, 2) in mm by their sense about the nominal radius; return um per division.

    `letters` are the axes of the plane, `name` begins the names of the curves.
    """
    centre, _ = least_squares_circle(np.vstack([*paths.values()]))
    traces = {sense: _about(path - centre, radius) for sense, path in paths.items()}
    every = np.concatenate([values for _, values in traces.values()])
    turn = np.linspace(0.0, 2.0 * np.pi, 181)
    style: dict[str, Any] = {"color": GREY, "linestyle": ":", "linewidth": 0.9}
    limits = {"least": float(np.nanmin(every)), "most": float(np.nanmax(every))}
    for which, limit in limits.items():
        label = None if which == "least" else ("G(b)" if len(paths) > 1 else "G")
        line = np.full(len(turn), limit)
        axes.plot(turn, line, label=label, gid=f"{name} {which}", **style)
    for sense in sorted(traces):
        axes.plot(*traces[sense], label=sense, gid=f"{name} {sense.lower()}", **LINES[sense])
    division = magnified(axes, float(np.nanmax(np.abs(every))))
    axes.set_xticks(np.radians(range(0, 360, 45)), _around_labels(letters))
    axes.tick_params(axis="x", pad=1.0)
    return division


def _around_labels(letters: str) -> list[str]:
    """Return what stands around a circle: its axes, the first of the plane at 0, and degrees."""
    first, second = letters[0], letters[1]
    ways = {0: f"+{first}", 90: f"+{second}", 180: f"-{first}", 270: f"-{second}"}
    return [ways.get(angle, f"{angle}°") for angle in range(0, 360, 45)]


def _about(path: Floats, radius: float) -> tuple[Floats, Floats]:
    """Return angles (rad) and deviations (um) in the order of the angle; nan where a gap is."""
    angle = np.arctan2(path[:, 1], path[:, 0])
    value = UM * (np.hypot(path[:, 0], path[:, 1]) - radius)
    order = np.argsort(angle, kind="stable")[:: max(1, len(path) // POINTS)]
    angle, value = np.append(angle[order], angle[order[0]] + 2.0 * np.pi), value[order]
    value = np.append(value, value[:1])
    gaps = np.flatnonzero(np.diff(angle) > np.radians(JUMP)) + 1
    return np.insert(angle, gaps, np.nan), np.insert(value, gaps, np.nan)
