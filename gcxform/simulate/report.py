"""Outcomes of virtual tests as tables for a person and as data."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from gcxform.calibrate.circles.causes import PLANES, SetUp
from gcxform.calibrate.circles.circles import Run
from gcxform.calibrate.circles.file import circles_csv
from gcxform.simulate.circles import Circles
from gcxform.simulate.figures import Positioning
from gcxform.simulate.virtual import BODY, FACES, Ballbar, Outcome, largest
from gcxform.system.arrays import Floats

DEGREE = 360  # points of a circle in the data

Pairs = Mapping[str, tuple[float, float]]
"""Figures by name: before and after, mm."""


def circle_pairs(outcome: Outcome[Circles]) -> Iterator[tuple[str, Pairs]]:
    """Yield the plane and its figures."""
    for plane, before in outcome.before.items():
        yield plane, _paired(before.figures, outcome.after[plane].figures)


def axis_pairs(outcome: Outcome[Positioning]) -> Iterator[tuple[str, Pairs]]:
    """Yield the axis and its figures."""
    for axis, before in outcome.before.items():
        yield axis, _paired(before.figures, outcome.after[axis].figures)


def diagonal_pairs(outcome: Outcome[Positioning]) -> Iterator[tuple[str, Pairs]]:
    """Yield each diagonal with E, M, B and its length error; then the largest E and B of a kind."""
    both = (outcome.before, outcome.after)
    for name, before in outcome.before.items():
        after = outcome.after[name]
        pairs = _paired(before.figures, after.figures)
        chosen = {symbol: pairs[symbol] for symbol in ("E", "M", "B")}
        yield name, {**chosen, "end": (before.end, after.end)}
    for kind, names in (("body", BODY), ("face", FACES)):
        there = [name for name in names if name in outcome.before]
        if there:
            pairs = {
                f"{symbol}_D": (largest(both[0], there, symbol), largest(both[1], there, symbol))
                for symbol in ("E", "B")
            }
            yield kind, pairs


def _paired(before: Mapping[str, float], after: Mapping[str, float]) -> Pairs:
    return {symbol: (value, after[symbol]) for symbol, value in before.items()}


def table(rows: Iterator[tuple[str, Pairs]]) -> Iterator[str]:
    """Yield the lines of a table in micrometres; a figure that does not exist is a dash."""
    yield f"{'um':16}{'before':>10}{'after':>10}"
    for name, pairs in rows:
        for symbol, (before, after) in pairs.items():
            yield f"{name:5}{symbol:11}{_um(before):>10}{_um(after):>10}"


def _um(value: float) -> str:
    return "-" if math.isnan(value) else f"{1000.0 * value + 0.0:.3f}"


def data(rows: Iterator[tuple[str, Pairs]]) -> dict[str, dict[str, dict[str, float | None]]]:
    """Return the figures in mm by name, symbol, and before or after."""
    return {
        name: {
            symbol: {"before": _number(before), "after": _number(after)}
            for symbol, (before, after) in pairs.items()
        }
        for name, pairs in rows
    }


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value


def circle_readings(circles: Circles) -> dict[str, Any]:
    """Return the radial deviations F in mm at whole degrees, and the least-squares centre."""
    angle = np.arange(DEGREE) * (360.0 / DEGREE)
    found: dict[str, Any] = {"angle": angle.tolist(), "centre": circles.centre.tolist()}
    for sense, path in (("cw", circles.cw), ("ccw", circles.ccw)):
        found[sense] = _around(path, circles.radial(path), np.radians(angle)).tolist()
    return found


def _around(path: Floats, values: Floats, angle: Floats) -> Floats:
    return np.interp(angle, np.arctan2(path[:, 1], path[:, 0]), values, period=2.0 * np.pi)


def circles_table(test: Ballbar, read: Mapping[str, Circles], count: int) -> str:
    """Return the readings of circles, so many a run, as `gcxform calibrate circles` reads them."""
    tests = []
    for plane, circles in read.items():
        setup = SetUp(plane, test.radius, test.feed / 60.0, test.centre)
        paths = {1: circles.ccw, -1: circles.cw}
        pivot = np.array(test.pivot)[list(PLANES[plane])]
        runs = [_run(sense, circles, path, (count, pivot)) for sense, path in paths.items()]
        tests.append((setup, runs))
    return circles_csv(tests)


def _run(sense: int, circles: Circles, path: Floats, said: tuple[int, Floats]) -> Run:
    """Return so many readings of a path about its pivot (2,), in the order of travel.

    Angles are those of where the machine is, whatever the pivot: the instrument has them by time.
    """
    count, pivot = said
    step = len(path) / count
    rows = ((np.arange(count) + 0.5) * step).astype(np.int64)
    place = path[rows] + pivot
    degrees = np.degrees(np.arctan2(place[:, 1], place[:, 0])) % 360.0
    return Run(sense, degrees.round(6), circles.radial(path)[rows].round(9))


def line_readings(line: Positioning) -> dict[str, Any]:
    """Return targets and deviations in mm, one list a target."""
    return {
        "target": line.target.tolist(),
        "up": line.up.tolist(),
        "down": line.down.tolist(),
    }
