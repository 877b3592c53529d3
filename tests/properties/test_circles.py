"""Any machine: what its circles read tells its squareness, scales and drives within deviations."""

from __future__ import annotations

import numpy as np
from circle_kit import AXES, FEED, both, fitted
from hypothesis import given
from hypothesis import strategies as st

from gcxform.simulate.drives import Drives

SMALL = st.integers(-100, 100).map(lambda n: n * 1e-6)  # mm per mm
LENGTHS = st.tuples(*[st.integers(-10, 10).map(lambda n: n * 1e-3)] * 3)


@given(
    plane=st.sampled_from([*AXES]),
    slopes=st.fixed_dictionaries({f"E{a}{b}": SMALL for a in "XYZ" for b in "XYZ"}),
    lag=LENGTHS,
    backlash=LENGTHS,
    play=LENGTHS,
    pivot=st.tuples(*[st.integers(-20, 20).map(lambda n: n * 1e-3)] * 2),
    arc=st.sampled_from([360.0, 330.0, 250.0]),
    seed=st.integers(0, 999),
)
def test_any_machine_comes_back_within_its_deviations(
    plane, slopes, lag, backlash, play, pivot, arc, seed
):
    first, second = AXES[plane]
    one, other = "XYZ"[first], "XYZ"[second]
    drives = Drives(lag=lag, backlash=backlash, play=play)
    degrees = 20.0 + np.arange(1.0, arc, 4.0)
    noise = 1e-3
    runs = both(
        plane, degrees, noise, np.random.default_rng(seed),
        slopes=slopes, drives=drives, pivot=pivot,
    )  # fmt: skip
    found = fitted(runs, plane, noise=noise)
    angle = -(slopes[f"E{one}{other}"] + slopes[f"E{other}{one}"])
    wanted = {
        "squareness": 1e6 * angle,
        "scale mismatch": 1e6 * (slopes[f"E{one}{one}"] - slopes[f"E{other}{other}"]),
        "servo mismatch": 1e3 * (lag[first] - lag[second]) / FEED,
        "centre 1": 1e3 * pivot[0],
        "centre 2": 1e3 * pivot[1],
        f"lateral play {one}": 1e3 * play[first],
        f"lateral play {other}": 1e3 * play[second],
    }
    for axis, letter in ((first, one), (second, other)):
        names = [c.name for c in found.causes if c.group == f"backlash {letter}"]
        wanted |= dict.fromkeys(names, 1e3 * backlash[axis])
    for name, value in wanted.items():
        size = found.size(name)
        assert abs(size.value - value) <= 4.5 * size.deviation + 0.01, name
