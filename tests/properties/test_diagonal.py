"""Any machine without angular errors comes back from its readings, in the end-point frame."""

from __future__ import annotations

import numpy as np
import pytest
from diagonal_kit import apart, reframed, turned, values
from hypothesis import given
from hypothesis import strategies as st
from step_diagonal_kit import diagonals_csv, linear_csv, simulate_linear, simulate_step_diagonal

from gcxform.calibrate.diagonal.file import parse_diagonals, parse_linear
from gcxform.calibrate.diagonal.plain_diagonal import squareness
from gcxform.calibrate.diagonal.readings import plain_diagonals, step_diagonals
from gcxform.calibrate.diagonal.step_diagonal import Assumed, identify
from gcxform.errormodel.functions import AxisFunction, AxisFunctions

SENSES = st.tuples(*(st.tuples(st.sampled_from((1, -1)), st.just(signs)) for signs in (
    (1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1))))  # fmt: skip


@st.composite
def machines(draw):
    """Return a machine with errors of some 0.1 mm at the nodes of a volume, and the volume."""
    low = np.array([draw(st.integers(-2000, 2000)) for _ in range(3)], np.float64)
    travel = np.array([draw(st.integers(50, 3000)) for _ in range(3)], np.float64)
    steps = draw(st.integers(1, 7))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    functions = [
        AxisFunction(
            np.linspace(low[k], low[k] + travel[k], steps + 1),
            draw(st.sampled_from([0.0, 1e-3, 0.1])) * rng.standard_normal((steps + 1, 3)),
        )
        for k in range(3)
    ]
    x, y, z = functions
    return AxisFunctions((x, y, z)), low, travel, steps


@given(machine=machines(), senses=SENSES, back=st.booleans(), order=st.permutations(range(4)))
def test_noise_free_round_trip(machine, senses, back, order):
    model, low, travel, steps = machine
    lines = [
        tuple(sense * sign for sign in senses[k][1]) for k in order for sense in [senses[k][0]]
    ]
    legs = simulate_step_diagonal(model, low, travel, steps, diagonals=lines, bidirectional=back)
    found = identify(step_diagonals(legs), assumed=Assumed(free_beams=False))
    assert apart(found.model(), reframed(model)) <= 1e-10
    again = identify(
        parse_diagonals(diagonals_csv(legs)).diagonals, assumed=Assumed(free_beams=False)
    )
    assert apart(again.model(), found.model()) <= 1e-10


@given(
    machine=machines(),
    angles=st.lists(st.floats(-1e-4, 1e-4), min_size=8, max_size=8),
    axes=st.sampled_from([(0, 1), (0, 2), (1, 2), (0, 1, 2)]),
    constant=st.sampled_from([0.0, 0.25]),
)
def test_two_linear_tests_undo_misaligned_beams(machine, angles, axes, constant):
    model, low, travel, steps = machine
    beams = np.array(angles).reshape(4, 2)
    legs = simulate_step_diagonal(model, low, travel, steps, misalignment=beams)
    volume = step_diagonals(legs).volume
    tests = []
    for axis in axes:
        runs = simulate_linear(model, axis, volume.nodes(axis), low)
        runs[0].deviation[:] += constant
        tests += parse_linear(linear_csv(runs), volume).tests
    noise = 0.001  # of which nothing is there: what is left is of second order
    found = identify(step_diagonals(legs), tests, Assumed(noise))
    size = volume.diagonal
    second = 3.0 * size * (1e-4**2 + 1e-4 * float(np.abs(values(model)).max()))
    lever = size / float(travel.min())
    assert apart(found.model(), reframed(model)) <= 1e-10 + 10.0 * second * lever**2


@given(machine=machines(), turn=st.lists(st.floats(-1e-3, 1e-3), min_size=3, max_size=3))
def test_v9_a_turn_is_not_seen_in_the_frame(machine, turn):
    model, *_ = machine
    once = reframed(model)
    assert apart(reframed(turned(model, turn)), once) <= 1e-10
    assert apart(reframed(once), once) <= 1e-12
    assert values(once)[:, :, 0] == pytest.approx(np.zeros((3, 3)), abs=0.0)


@given(machine=machines(), back=st.booleans())
def test_the_squareness_of_any_machine(machine, back):
    """Four lengths give the end slopes of the frame, whatever else the machine does."""
    model, low, travel, steps = machine
    legs = simulate_step_diagonal(model, low, travel, steps, bidirectional=True)
    found = squareness(plain_diagonals(legs[1::2] if back else legs), 0.001)
    ends = values(reframed(model))[:, :, -1]
    slopes = (ends[1, 0] / travel[1], ends[2, 0] / travel[2], ends[2, 1] / travel[2])
    assert found.slopes == pytest.approx(slopes, abs=1e-12)
    scales = np.diag(ends) / travel
    assert found.mean_scale == pytest.approx(travel**2 @ scales / (travel @ travel), abs=1e-12)
