"""Exact circles of a machine in its plane: positions and lengths, no columns and no first order."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gcxform.calibrate.circles.circles import Asked, Run, SetUp, fit
from gcxform.calibrate.circles.file import Given, measured
from gcxform.calibrate.csv_text import OWN, parse_csv
from gcxform.simulate.drives import STILL

AXES = {"XY": (0, 1), "YZ": (1, 2), "ZX": (2, 0)}
CENTRE = (300.0, 200.0, 100.0)
FEED = 1000.0 / 60.0  # mm/s
AROUND = np.arange(0.25, 360.0, 0.5)
ROUGH = np.arange(0.5, 360.0, 2.0)


def errors(slopes, places):
    """Return the errors (n, 3) of a machine with slopes, `EXY=1e-5` being in X by Y.

    `EXY2` is by the square of Y, 1/mm.
    """
    found = np.zeros_like(places)
    for name, slope in slopes.items():
        power = int(name[3:] or 1)
        found[:, "XYZ".index(name[1])] += slope * places[:, "XYZ".index(name[2])] ** power
    return found


def run(
    plane, sense, degrees=AROUND, *, radius=100.0, drives=STILL, slopes=None, pivot=(0.0, 0.0)
):  # fmt: skip
    """Return what a bar reads on a circle about `CENTRE`: the length from the pivot, in mm."""
    first, second = AXES[plane]
    angle = np.radians(degrees)
    flat = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    middle = np.array([CENTRE[first], CENTRE[second]])
    away = np.zeros((len(degrees), 3))
    away[:, [first, second]] = flat
    flat = flat + errors(slopes or {}, away)[:, [first, second]] - np.array(pivot)
    if sense:
        flat += drives.off(angle, sense, (first, second), (middle, radius))
    return Run(sense, np.asarray(degrees), np.hypot(*flat.T) - radius)


def both(plane, degrees=AROUND, noise=0.0, rng=None, **machine):
    """Return runs in both senses, with noise."""
    runs = [run(plane, sense, degrees, **machine) for sense in (1, -1)]
    rng = rng or np.random.default_rng(1)
    return [
        Run(r.sense, r.degrees, r.readings + noise * rng.standard_normal(len(r.readings)))
        for r in runs
    ]


def fitted(runs, plane="XY", radius=100.0, feed=FEED, name="", **asked):
    return fit(SetUp(plane, radius, feed, CENTRE, name), runs, Asked(**asked))


def read_tests(text, layout=OWN, **given):
    """Return the tests of a table, with what is said of all rows."""
    return measured(parse_csv(text, layout=layout), Given(**given)).tests


def written(name, text):
    Path(name).write_text(text)
    return name
