"""Virtual tests: closed forms, the published tables, and the chain of compensation."""

from __future__ import annotations

import math
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from simulate_kit import EXAMPLE, TRAVEL, Loose, chain_of, functions, lddm

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.simulate.positions import Chain, VirtualMachine, points_at, senses
from gcxform.simulate.programs import PLANES, circles, linear_cycles
from gcxform.simulate.virtual import (
    BODY,
    FACES,
    Ballbar,
    LinearTest,
    axis_line,
    diagonal_line,
    possible,
    ranges,
)

RIGID = EXAMPLE.parents[1] / "rigid-body" / "model.toml"
CENTRE = (200.0, 180.0, 220.0)
MIDDLE = (240.0, 165.0, 225.0)
DIALECTS = ("linuxcnc", "fanuc", "haas", "grbl")
BOX = np.array([[0.0, TRAVEL]] * 3)


# --- circles ---


@pytest.mark.parametrize(
    ("plane", "function"),
    [("XY", "EXY"), ("XY", "EYX"), ("YZ", "EYZ"), ("YZ", "EZY"), ("ZX", "EXZ"), ("ZX", "EZX")],
)
def test_squareness_makes_an_ellipse(plane, function):
    """Off by s times the other axis, the radius is r + r s/2 sin 2a: G is r s, F is half of it."""
    s, r = 5e-5, 100.0
    found = Ballbar(CENTRE, r).run(chain_of(functions(**{function: s}))).before
    for name, circle in found.items():
        wanted = r * s if name == plane else 0.0
        assert circle.figures["G(CW)"] == pytest.approx(wanted, abs=2e-7)
        assert circle.figures["G(b)"] == pytest.approx(wanted, abs=2e-7)
        assert circle.figures["Fmax(CCW)"] == pytest.approx(wanted / 2, abs=2e-7)
        assert circle.figures["Fmin(CW)"] == pytest.approx(-wanted / 2, abs=2e-7)


def test_the_long_axis_of_the_ellipse_lies_where_it_should():
    """X grows with Y, so the path is longest at 45 degrees."""
    path = Ballbar(CENTRE, 100.0, ("XY",)).run(chain_of(functions(EXY=5e-5))).before["XY"].ccw
    longest = path[np.argmax(np.hypot(*path.T))]
    assert math.degrees(math.atan2(*longest[::-1])) % 180.0 == pytest.approx(45.0, abs=0.1)


def test_scales_of_two_axes():
    """Scales a and b of two axes: G is r |a - b|, D is r (a + b) / 2, F goes from r b to r a."""
    a, b, r = 6e-5, -2e-5, 120.0
    figures = Ballbar(CENTRE, r, ("XY",)).run(chain_of(functions(EXX=a, EYY=b))).before["XY"]
    found = figures.figures
    assert found["G(CW)"] == pytest.approx(r * (a - b), abs=1e-6)
    assert found["D"] == pytest.approx(r * (a + b) / 2, abs=1e-6)
    assert (found["Fmax(CW)"], found["Fmin(CW)"]) == pytest.approx((r * a, r * b), abs=1e-6)


def test_a_machine_without_errors_draws_circles():
    outcome = Ballbar(CENTRE, 100.0).run(chain_of(functions()))
    for side in (outcome.before, outcome.after):
        for circle in side.values():
            assert max(map(abs, circle.figures.values())) < 1e-9


def test_an_error_that_is_the_same_everywhere_is_not_seen():
    """The pivot is set where the machine stands, and is off as the circle is."""
    constant = gx.AxisFunction(np.array([0.0, TRAVEL]), np.full((2, 3), 0.05))
    found = Ballbar(CENTRE, 100.0).run(chain_of(gx.AxisFunctions((constant, None, None))))
    assert all(max(map(abs, c.figures.values())) < 1e-9 for c in found.before.values())


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("tolerance", [0.0005, 0.002])
def test_compensated_circles_keep_the_tolerance(dialect, tolerance):
    """Each point of the bar and its pivot are within the tolerance, and what rounding adds."""
    chain = lddm(dialect, tolerance=tolerance, decimals=5)
    outcome = Ballbar(MIDDLE, 100.0).run(chain)
    for plane, circle in outcome.after.items():
        found = circle.figures
        assert found["G(b)"] < 2.0 * tolerance + 1e-4
        assert found["G(b)"] < outcome.before[plane].figures["G(b)"]
        assert max(found["Fmax(CW)"], -found["Fmin(CW)"]) < tolerance + 1e-4
    assert outcome.compensated.certificate.verified


def test_backlash_is_told_the_sense_of_travel_and_is_not_compensated():
    """Against the way by h/2 in X: F is h/2 cos a, by the sense; on a line B = h."""
    x = gx.AxisFunction(np.array([0.0, TRAVEL]), np.zeros((2, 3)))
    chain = chain_of(Loose((x, x, x)))
    found = LinearTest((axis_line(0, CENTRE, 0.0, TRAVEL, 5, 2.0),), runs=2).run(chain)
    for side in (found.before, found.after):
        assert side["X"].reversal == pytest.approx(-Loose.LOST, abs=1e-9)
        assert side["X"].figures["B"] == pytest.approx(Loose.LOST, abs=1e-9)
    circle = Ballbar(CENTRE, 100.0, ("XY",)).run(chain).before["XY"]
    for path, sign in ((circle.cw, 1.0), (circle.ccw, -1.0)):  # at the top, cw goes towards +X
        angle = np.degrees(np.arctan2(path[:, 1], path[:, 0])) % 360.0
        for at, way in ((45.0, 1.0), (135.0, 1.0), (225.0, -1.0), (315.0, -1.0)):
            here = np.argmin(np.abs(angle - at))
            wanted = -sign * way * Loose.LOST / 2 * math.cos(math.radians(at))
            assert circle.radial(path)[here] == pytest.approx(wanted, abs=5e-6)


def test_senses_last_until_the_axis_moves_back():
    points = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0], [1 + 1e-12, 1, 0], [0, 1, 0]])
    assert senses(points).tolist() == [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [1, -1, 0],
        [-1, -1, 0],
    ]


# --- lines ---


def test_positioning_of_a_linear_scale():
    """A scale of e: systematic deviation and accuracy are e times the way between the targets."""
    e = -4e-5
    line = axis_line(1, CENTRE, 10.0, 390.0, 9, 5.0, 2.0, seed=3)
    outcome = LinearTest((line,), runs=3).run(chain_of(functions(EYY=e)))
    found, way = outcome.before["Y"], line.targets[-1, 1] - line.targets[0, 1]
    for symbol in ("A", "A up", "A down", "E", "M"):
        assert found.figures[symbol] == pytest.approx(abs(e) * way, abs=1e-12)
    for symbol in ("R", "B"):
        assert found.figures[symbol] == pytest.approx(0.0, abs=1e-12)
    assert found.end == pytest.approx(e * way, abs=1e-12)
    assert found.up[:, 0] == pytest.approx(e * line.targets[:, 1], abs=1e-12)
    assert outcome.after["Y"].figures["A"] < 1.1e-4  # what four decimals do


def test_targets_are_scattered_and_stay_inside():
    even = axis_line(0, CENTRE, 0.0, 100.0, 6, 1.0)
    assert even.targets[:, 0] == pytest.approx([1.0, 20.6, 40.2, 59.8, 79.4, 99.0])
    uneven = axis_line(0, CENTRE, 0.0, 100.0, 6, 1.0, 2.0, seed=1)
    steps = np.diff(uneven.targets[:, 0])
    assert np.ptp(steps) > 0.5
    assert uneven.targets[0, 0] >= 1.0
    assert uneven.targets[-1, 0] <= 99.0
    assert (axis_line(0, CENTRE, 0.0, 100.0, 6, 1.0, 2.0, seed=2).targets != uneven.targets).any()


def test_noise_is_what_was_asked_for_and_the_same_in_both_runs():
    sigma = 0.002
    test = LinearTest((axis_line(0, CENTRE, 0.0, 400.0, 40, 1.0),), runs=40, noise=sigma, seed=7)
    one, again = (test.run(chain_of(functions())) for _ in range(2))
    found = one.before["X"]
    assert np.sqrt((found.s_up**2).mean()) == pytest.approx(sigma, rel=0.05)
    assert (found.up == again.before["X"].up).all()
    assert (found.up == one.after["X"].up).all()
    other = replace(test, seed=8).run(chain_of(functions())).before["X"]
    assert (found.up != other.up).all()
    assert (found.up != found.down).all()


def test_diagonals_of_the_published_tables():
    """S1: +4.254, -26.823, -27.853, -37.184 um from corner to corner, and nothing afterwards."""
    chain = lddm("fanuc", decimals=5, tolerance=0.0005)
    box = ranges(chain.model.model)
    outcome = LinearTest(tuple(diagonal_line(name, box, 11) for name in BODY)).run(chain)
    ends = [1000 * outcome.before[name].end for name in BODY]
    assert ends == pytest.approx([4.254, -26.823, -27.853, -37.184], abs=5e-4)
    for name in BODY:
        assert outcome.after[name].figures["E"] < 2.0 * 0.0005
        assert outcome.before[name].figures["E"] >= abs(outcome.before[name].end)


@pytest.mark.parametrize(("name", "sign"), [("PP0", 1.0), ("NP0", -1.0), ("0PP", 0.0)])
def test_squareness_lengthens_one_face_diagonal_and_shortens_the_other(name, sign):
    """X off by s y: the end at (X, Y) moves by s Y in X, which is s X Y / D along the diagonal."""
    s = 3e-5
    line = diagonal_line(name, BOX, 5)
    found = LinearTest((line,), runs=1).run(chain_of(functions(EXY=s))).before[name]
    wanted = sign * s * TRAVEL * TRAVEL / math.hypot(TRAVEL, TRAVEL)
    assert found.end == pytest.approx(wanted, abs=1e-12)
    assert found.figures["E"] == pytest.approx(abs(wanted), abs=1e-12)


def test_diagonals_go_where_their_names_say():
    for name in BODY + FACES:
        way = diagonal_line(name, BOX, 3).direction
        assert ["N0P"[1 + int(np.sign(round(w, 9)))] for w in way] == list(name)
    inner = diagonal_line("PPP", BOX, 3, beyond=math.sqrt(3.0))
    assert inner.targets[[0, -1]] == pytest.approx(np.array([[1.0] * 3, [399.0] * 3]))
    flat = BOX * [[1.0], [1.0], [0.0]]
    assert possible(BODY + FACES, flat) == ("PP0", "NP0")


def test_a_machine_with_angular_errors_keeps_the_tolerance():
    chain = Chain(gx.ModelFile.load(RIGID), default_registry().dialect("linuxcnc"), decimals=5)
    box = ranges(chain.model.model)
    lines = tuple(diagonal_line(name, box, 5) for name in BODY)
    outcome = LinearTest(lines, runs=1).run(chain)
    around = Ballbar((0.0, 0.0, -250.0), 150.0).run(chain)
    for name in BODY:
        assert outcome.after[name].figures["E"] < 0.002 < outcome.before[name].figures["E"]
    for plane in PLANES:
        assert around.after[plane].figures["G(b)"] < 0.0021 < around.before[plane].figures["G(b)"]


# --- programs ---


def standard(dialect, decimals=3):
    kind = default_registry().dialect(dialect)
    lines = (axis_line(0, CENTRE, 0.0, 100.0, 4, 1.0), diagonal_line("NPP", BOX, 3))
    return (
        circles(kind, decimals, CENTRE, 50.0, tuple(PLANES), 500.0),
        linear_cycles(kind, decimals, lines, 2, 500.0),
    )


@pytest.mark.parametrize("dialect", DIALECTS)
def test_standard_programs_are_read_as_they_are_meant(dialect):
    around, along = standard(dialect)
    path = gx.read(around.text, dialect).path
    assert path.is_arc.sum() == 6
    assert path.sweep[path.is_arc] == pytest.approx(2.0 * np.pi)
    for plane, (a, b, _) in {name: p.axes for name, p in PLANES.items()}.items():
        for sense, kind in (("cw", gx.Kind.ARC_CW), ("ccw", gx.Kind.ARC_CCW)):
            (row,) = np.flatnonzero(path.source == around.lines[f"{plane} {sense}"][0])
            assert path.kind[row] == kind
            assert path.centre[row] == pytest.approx(CENTRE)
            quarter = points_at(path, np.array([row]), np.array([0.25]))[0] - CENTRE
            assert quarter[a] == pytest.approx(0.0, abs=1e-9)
            assert quarter[b] == pytest.approx(50.0 if sense == "ccw" else -50.0)
    dwells = [event.values[0][1] for event in path.events if event.what == "DWELL"]
    assert set(dwells) == {2.0}
    path = gx.read(along.text, dialect).path
    ends = {int(line): end for line, end in zip(path.source, path.end[:, :3], strict=True)}
    line = axis_line(0, CENTRE, 0.0, 100.0, 4, 1.0)
    up = np.array([ends[n] for n in along.lines["X up"]])
    down = np.array([ends[n] for n in along.lines["X down"]])
    assert up == pytest.approx(np.vstack([line.targets, line.targets]))
    assert down == pytest.approx(np.vstack([line.targets[::-1], line.targets[::-1]]))
    assert ends[along.lines["X up"][3] + 2][0] == 100.0  # beyond the last target
    assert ends[along.lines["X down"][3] + 2][0] == 0.0


@pytest.mark.skipif(shutil.which("rs274") is None, reason="rs274 is not installed")
@pytest.mark.parametrize("which", [0, 1])
def test_linuxcnc_runs_the_standard_programs(which, tmp_path):
    program = standard("linuxcnc")[which]
    (tmp_path / "in.ngc").write_bytes(program.text)
    for name in ("tool.tbl", "rs.var"):
        (tmp_path / name).write_text("")
    command = ["rs274", "-g", "-t", "tool.tbl", "-v", "rs.var", "in.ngc", "out.txt"]
    environment = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin"}
    subprocess.run(
        command, cwd=tmp_path, check=True, capture_output=True, timeout=30, env=environment
    )
    said = (tmp_path / "out.txt").read_text()
    path = gx.read(program.text, "linuxcnc").path
    assert said.count("DWELL(2.0000)") == sum(e.what == "DWELL" for e in path.events)
    assert said.count("ARC_FEED") == path.is_arc.sum()
    assert said.count("STRAIGHT_FEED") == len(path) - path.is_arc.sum()


def test_the_machine_is_where_it_is_told_plus_its_error():
    machine = VirtualMachine(functions(EXX=1e-4, EZY=-2e-4), gx.Outside.CLAMP)
    told = np.array([[100.0, 200.0, 300.0], [500.0, 0.0, 0.0]])
    found = machine.actual(told, np.zeros((2, 3)))
    wanted = [[100.01, 200.0, 300.0 - 0.04], [500.0 + 0.04, 0.0, 0.0]]
    assert found == pytest.approx(np.array(wanted))


def test_what_leaves_the_model_is_refused():
    with pytest.raises(gx.UsageError, match="GX738"):
        Ballbar(CENTRE, 250.0).run(chain_of(functions()))
    chain = chain_of(functions(EXX=1e-5), outside=gx.Outside.EXTRAPOLATE)
    found = Ballbar(CENTRE, 250.0, ("XY",)).run(chain)
    assert found.before["XY"].figures["G(CW)"] == pytest.approx(250.0 * 1e-5, abs=1e-7)
    assert found.after["XY"].figures["G(CW)"] < 0.002
