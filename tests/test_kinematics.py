"""Chains of rotary axes, forward and inverse; the numbers K1, K2, ... are acceptance checks."""

from __future__ import annotations

import csv
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from kinematics_kit import POSES, PRESETS, apart, leaning, preset, skewed, tool

from gcxform.diagnostics import UsageError
from gcxform.machine.chain import Chain, Rotary
from gcxform.machine.inverse import State, attitudes, inverse, turns

HERE = Path(__file__).parent
TABLES = {"two tables": 2, "table and head": 1, "two heads": 0}


def rng():
    return np.random.default_rng(20)


def check_pose(chain, linear, angles, tip, axis, solutions):
    """Check a pose, and that each of its solutions (angles, linear) is among the branches."""
    found, ahead = chain.forward(np.array([linear]), np.array([angles]))
    assert np.abs(found - tip).max() <= 1e-8
    assert np.abs(ahead - axis).max() <= 1e-10
    poses = inverse(chain, np.array([tip]), np.array([axis]))
    assert poses.attitudes.state == State.REACHED
    for wanted, place in solutions:
        off = np.abs(poses.linear[0] - place).max(axis=-1)
        off += apart(poses.angle[0], np.array(wanted)).max(axis=-1)
        assert off.min() <= 1e-6


# --- poses from elsewhere ---


def of_shared(text):
    """Return the chain of a definition in the published vectors."""
    sides = {"T": [], "H": []}
    for letter, side, v, t, sign in re.findall(
        r"(\w):(\w) v=\((\S+)\) t=\((\S+)\) sign=([+-]1)", text
    ):
        line = (tuple(map(float, part.split(","))) for part in (v, t))
        sides[side].append(Rotary(letter, *line, int(sign)))
    tip = tuple(map(float, re.search(r"tip0=(\S+)", text)[1].split(",")))
    return Chain(tuple(sides["T"]), tuple(sides["H"]), tip)


def test_published_poses(shared):
    """K1: every row; tip <= 1e-8 mm, axis <= 1e-10, every branch."""
    file = shared / "data" / "kinematics" / "vectors.csv"
    rows = [*csv.DictReader(file.read_text("utf-8").splitlines())]
    assert len({row["topology"] for row in rows}) == 11
    for row in rows:
        linear, tip, axis = (
            [float(row[name]) for name in names.split()]
            for names in ("X Y Z", "px py pz", "ax ay az")
        )
        solutions = [
            [[*map(float, part.split())] for part in branch.split(";")]
            for branch in row["solutions_rotary_deg_;_XYZ"].split("|")
        ]
        chain = of_shared(row["definition"])
        assert chain.letters == tuple(row["rotary_names"].split())
        check_pose(chain, linear, [*map(float, row["rotary_deg"].split())], tip, axis, solutions)


def of_own(row):
    sides = {"T": [], "H": []}
    for text in row["axes"].split("|"):
        letter, side, *numbers, sign = text.split()
        values = np.array(numbers, float)
        way = values[:3] / np.linalg.norm(values[:3])
        sides[side].append(Rotary(letter, tuple(way), tuple(values[3:]), int(sign)))
    return Chain(tuple(sides["T"]), tuple(sides["H"]), tuple(map(float, row["tip"].split())))


def test_poses_by_quaternions():
    """K1, for the file of the oracle in quaternions.py."""
    for row in csv.DictReader((HERE / "poses.csv").read_text("utf-8").splitlines()):
        names = ("linear", "angles", "point", "axis")
        pose = [[*map(float, row[name].split())] for name in names]
        found = [[*map(float, branch.split())] for branch in row["attitudes"].split("|")]
        assert len(found) == 2
        check_pose(of_own(row), *pose, [(numbers[:2], numbers[2:]) for numbers in found])


def test_the_file_is_what_the_oracle_writes():
    done = subprocess.run(
        [sys.executable, HERE / "quaternions.py"], capture_output=True, text=True, check=True
    )
    written = (HERE / "poses.csv").read_text("utf-8")
    for one, other in zip(done.stdout.splitlines(), written.splitlines(), strict=True):
        numbers = [
            [float(n) for n in re.findall(r"-?\d+\.\d+(?:e-?\d+)?", line)] for line in (one, other)
        ]
        assert numbers[0] == pytest.approx(numbers[1], abs=1e-9)


# --- there and back ---


def check_there_and_back(chain, angles):
    """K2: forward(inverse) <= 1e-9 mm on random poses, by the matrices of scipy."""
    linear = rng().uniform(-400.0, 400.0, (len(angles), 3))
    tip, axis = chain.forward(linear, angles)
    wanted = tool(chain, linear, angles)
    assert np.abs(tip - wanted[0]).max() <= 1e-9
    assert np.abs(axis - wanted[1]).max() <= 1e-12
    poses = inverse(chain, tip, axis)
    assert poses.allowed.all()
    for branch in range(2):
        back, ahead = tool(chain, poses.linear[:, branch], poses.angle[:, branch])
        assert np.abs(back - tip).max() <= 1e-9
        assert np.abs(ahead - axis).max() <= 1e-12
    off = apart(poses.angle, angles[:, None, :]).max(axis=-1).min(axis=-1)
    assert np.quantile(off, 0.99) <= 1e-9  # near the pole angles say less than tool axes do


def random_angles(count=POSES):
    return rng().uniform(-360.0, 360.0, (count, 2))


@pytest.mark.parametrize("name", PRESETS)
def test_there_and_back_by_kind(name):
    """K2 for each kind of machines."""
    check_there_and_back(preset(name, rng()), random_angles())


@pytest.mark.parametrize("inclination", [20.0, 50.0, 90.0])
def test_there_and_back_with_nutating_axes(inclination):
    """K2 for any angle of a nutating axis."""
    for name in ("nutating-head", "nutating-table"):
        check_there_and_back(preset(name, rng(), inclination), random_angles(POSES // 10))


@pytest.mark.parametrize("tables", TABLES.values(), ids=TABLES)
def test_there_and_back_with_axes_square_to_nothing(tables):
    """K2 for calibrated machines, and ones whose axes point anywhere."""
    draw = rng()
    for _ in range(20):
        check_there_and_back(skewed(draw, tables), random_angles(POSES // 20))


# --- closed forms ---


def test_trunnions_and_forks_by_their_closed_forms():
    """A = +-acos(kz), C = atan2(kx, -ky), and B likewise, with the signs of ISO 841."""
    axis = leaning(np.linspace(1.0, 179.0, 90), np.linspace(-170.0, 500.0, 90))
    kx, ky, kz = axis.T
    tilt = np.degrees(np.arccos(kz))
    for name, azimuth, other in (
        ("ac-trunnion", np.arctan2(kx, -ky), np.arctan2(-kx, ky)),
        ("ca-fork", np.arctan2(kx, -ky), np.arctan2(-kx, ky)),
        ("bc-trunnion", np.arctan2(ky, kx), np.arctan2(-ky, -kx)),
        ("cb-fork", np.arctan2(ky, kx), np.arctan2(-ky, -kx)),
        ("c-table-b-head", np.arctan2(ky, kx), np.arctan2(-ky, -kx)),
    ):
        chain = preset(name, rng())
        found = attitudes(chain, axis).angle
        turning = chain.letters.index("C")
        assert found[:, 0, 1 - turning] == pytest.approx(tilt, abs=1e-10)
        assert found[:, 1, 1 - turning] == pytest.approx(-tilt, abs=1e-10)
        assert apart(found[:, 0, turning], np.degrees(azimuth)).max() < 1e-10
        assert apart(found[:, 1, turning], np.degrees(other)).max() < 1e-10


@pytest.mark.parametrize("inclination", [30.0, 45.0, 60.0])
def test_nutating_heads_by_their_closed_form(inclination):
    """cos B = (kz - K^2) / S^2, C = atan2(ky, kx) - atan2(S K (1 - cos B), S sin B)."""
    axis = leaning(np.linspace(1.0, 2 * inclination - 1, 50), np.linspace(-170.0, 500.0, 50))
    kx, ky, kz = axis.T
    s, k = np.sin(np.radians(inclination)), np.cos(np.radians(inclination))
    found = attitudes(preset("nutating-head", rng(), inclination), axis).angle
    for branch, sign in enumerate((1.0, -1.0)):
        b = sign * np.arccos((kz - k**2) / s**2)
        c = np.arctan2(ky, kx) - np.arctan2(s * k * (1 - np.cos(b)), s * np.sin(b))
        assert found[:, branch, 1] == pytest.approx(np.degrees(b), abs=1e-9)
        assert apart(found[:, branch, 0], np.degrees(c)).max() < 1e-9


# --- pole, border, out of reach (K3) ---


def test_at_the_pole_the_angle_next_to_the_workpiece_is_free():
    """K3: C is free where the tool stands along it, and is 0."""
    for name in ("ac-trunnion", "ca-fork", "bc-trunnion", "c-table-b-head", "nutating-head"):
        chain = preset(name, rng())
        found = attitudes(chain, np.array([[0.0, 0.0, 2.0]]))
        assert found.state == State.POLE
        assert found.free is not None
        assert chain.letters[found.free] == "C"
        assert found.angle == pytest.approx(np.zeros((1, 2, 2)), abs=1e-12)
        angles = np.array([[40.0, 40.0]])
        angles[0, 1 - found.free] = 0.0
        assert chain.tool_axis(angles) == pytest.approx(np.array([[0.0, 0.0, 1.0]]), abs=1e-15)


def test_a_free_angle_keeps_within_its_limits():
    one, two = preset("ac-trunnion", rng()).table
    for limits, wanted in (((-90.0, 90.0), 0.0), ((30.0, 90.0), 30.0), ((-90.0, -20.0), -20.0)):
        chain = Chain((one, Rotary("C", two.direction, two.point, -1, limits)))
        poses = inverse(chain, np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]))
        assert poses.allowed.all()
        assert poses.angle[..., 1] == pytest.approx(np.full((1, 2), wanted))


@pytest.mark.parametrize("name", ["ac-trunnion", "ca-fork", "nutating-head"])
def test_the_tool_axis_is_right_however_near_the_pole(name):
    """K3: no digits are lost on the way to the pole, and there is no NaN."""
    tilts = 10.0 ** np.arange(1.0, -17.0, -0.25)
    axis = leaning(tilts, np.full(len(tilts), 33.0))
    chain = preset(name, rng())
    found = attitudes(chain, axis)
    for branch in range(2):
        assert np.abs(chain.tool_axis(found.angle[:, branch]) - axis).max() < 4e-11
    assert (found.state == np.where(tilts > 1e-9, State.REACHED, State.POLE)).all()
    assert found.tilt == pytest.approx(tilts, rel=1e-6)


@pytest.mark.parametrize("inclination", [30.0, 45.0, 60.0])
def test_the_border_of_reach_of_nutating_axes(inclination):
    """K3: the reach is 2 nu; there both branches are one, and beyond it nothing is found."""
    beyond = np.array([-1.0, -1e-3, 0.0, 1e-3, 1.0, 20.0])
    axis = leaning(2 * inclination + beyond, np.full(6, 70.0))
    chain = preset("nutating-head", rng(), inclination)
    poses = inverse(chain, np.zeros((6, 3)), axis)
    states = [State.REACHED] * 2 + [State.BORDER] + [State.UNREACHABLE] * 3
    assert poses.attitudes.state.tolist() == states
    assert poses.attitudes.miss == pytest.approx(np.maximum(beyond, 0.0), abs=1e-12)
    assert poses.allowed.all(axis=1).tolist() == [True] * 3 + [False] * 3
    assert apart(poses.angle[2, 0], poses.angle[2, 1]).max() < 1e-6
    nearest = chain.tool_axis(poses.angle)
    wanted = leaning(np.full(4, 2 * inclination), np.full(4, 70.0))
    assert nearest[2:, 0] == pytest.approx(wanted, abs=1e-12)


def test_what_is_beyond_the_border_by_less_than_the_tolerance_is_reached():
    """K3: a tool axis of a few decimals may lie just outside."""
    axis = leaning([90.0004], [10.0])
    chain = preset("nutating-head", rng())
    assert attitudes(chain, axis).state == State.UNREACHABLE
    assert attitudes(chain, axis, tolerance=0.001).state != State.UNREACHABLE


def test_the_hole_at_the_pole_of_a_calibrated_machine():
    """K3: a machine whose axes are not square cannot reach all about its pole."""
    ways = [(1.0, 0.0, 0.01), (0.0, 0.0, 1.0)]
    lines = [tuple(np.array(way) / np.linalg.norm(way)) for way in ways]
    chain = Chain(
        (Rotary("A", lines[0], (0.0, 0.0, 0.0), -1), Rotary("C", lines[1], (0.0, 0.0, 0.0), -1)),
    )
    found = attitudes(chain, np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    least = 180.0 - 2.0 * np.degrees(np.arctan2(1.0, 0.01))
    assert found.state.tolist() == [State.POLE, State.UNREACHABLE]
    assert found.miss == pytest.approx([0.0, least])


@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from([0, 1, 2]),
    st.lists(st.integers(-1, 1), min_size=3, max_size=3).filter(any),
)
@example(2, 2, [1, 0, -1])  # the angles of its axes are more than half a turn together
def test_no_machine_gives_nan_for_any_tool_axis(seed, tables, vector):
    """K3, and of what cannot be reached, the attitude that is nearest."""
    chain = skewed(np.random.default_rng(seed), tables)
    axis = np.array([vector], float) / np.linalg.norm(vector)
    poses = inverse(chain, np.zeros((1, 3)), axis)
    assert np.isfinite(poses.linear).all()
    assert np.isfinite(poses.angle).all()
    reached = chain.tool_axis(poses.angle)[0]
    off = np.degrees(2 * np.arcsin(np.linalg.norm(reached - axis, axis=-1) / 2))
    assert off == pytest.approx(np.full(2, poses.attitudes.miss[0]), abs=1e-7)
    angles = np.random.default_rng(seed).uniform(-180, 180, (200, 2))
    tried = np.linalg.norm(chain.tool_axis(angles) - axis, axis=-1).min()
    assert np.degrees(2 * np.arcsin(tried / 2)) >= poses.attitudes.miss[0] - 1e-7


@pytest.mark.parametrize("vector", [[0.0, 0.0, 0.0], [np.nan, 0.0, 1.0], [np.inf, 0.0, 1.0]])
def test_a_tool_axis_needs_a_length(vector):
    with pytest.raises(ValueError, match="length"):
        attitudes(preset("ac-trunnion", rng()), np.array([vector]))


# --- fewer axes, and others ---


def test_one_rotary_axis_reaches_a_cone():
    line = Rotary("A", (1.0, 0.0, 0.0), (0.0, 5.0, 9.0), -1)
    axis = np.array([[0.0, -1.0, 1.0], [0.0, 0.0, 1.0], [0.2, 0.0, 1.0], [1.0, 0.0, 0.0]])
    found = attitudes(Chain((line,)), axis)
    assert found.angle[:, 0, 0] == pytest.approx([45.0, 0.0, 0.0, 0.0])
    assert found.state.tolist() == [State.REACHED] * 2 + [State.UNREACHABLE] * 2
    assert found.miss == pytest.approx([0.0, 0.0, np.degrees(np.arctan(0.2)), 90.0])


def test_a_table_that_turns_about_the_spindle_does_not_tilt():
    line = Rotary("C", (0.0, 0.0, 1.0), (0.0, 5.0, 9.0), -1)
    found = attitudes(Chain((line,)), np.array([[0.0, 0.0, 1.0], [0.0, 0.6, 0.8]]))
    assert found.state.tolist() == [State.POLE, State.UNREACHABLE]
    assert found.free == 0


def test_no_rotary_axis():
    poses = inverse(Chain(), np.array([[1.0, 2.0, 3.0]] * 2), np.array([[0, 0, 1.0], [0, 1, 1.0]]))
    assert poses.attitudes.state.tolist() == [State.REACHED, State.UNREACHABLE]
    assert poses.attitudes.miss == pytest.approx([0.0, 45.0])
    assert poses.linear[:, 0].tolist() == [[1.0, 2.0, 3.0]] * 2


def test_three_axes_go_forward_but_not_back():
    kinds = [(1.0, 0.0, 0.0), (0.0, 0.6, 0.8), (0.0, 0.0, 1.0)]
    axes = [Rotary(a, v, (1.0, 2.0, 3.0), 1) for a, v in zip("ABC", kinds, strict=True)]
    chain = Chain((axes[0],), (axes[2], axes[1]), (0.0, 0.0, -9.0))
    linear, angles = rng().uniform(-9, 9, (50, 3)), rng().uniform(-180, 180, (50, 3))
    tip, axis = chain.forward(linear, angles)
    for one, other in zip((tip, axis), tool(chain, linear, angles), strict=True):
        assert one == pytest.approx(other, abs=1e-12)
    assert chain.linear(tip, angles) == pytest.approx(linear, abs=1e-12)
    with pytest.raises(UsageError, match="the 3 axes A, C, B") as caught:
        attitudes(chain, axis)
    assert caught.value.diagnostics[0].code == "GX453"


@pytest.mark.parametrize("ways", [((1.0, 0, 0), (-1.0, 0, 0)), ((1.0, 0, 0), (0, 0, 1.0))])
def test_axes_that_do_the_same_are_refused(ways):
    axes = tuple(Rotary(a, v, (0, 0, 0), 1) for a, v in zip("AC", ways, strict=True))
    with pytest.raises(UsageError, match="parallel to the next, or to the tool") as caught:
        attitudes(Chain((), axes), np.array([[0.0, 0.0, 1.0]]))
    assert caught.value.diagnostics[0].code == "GX453"


# --- limits ---


def by_counting(angle, limits):
    return {round(angle + 360 * k, 6) for k in range(-9, 9) if within(angle + 360 * k, limits)}


def within(angle, limits):
    return limits[0] - 1e-9 <= angle <= limits[1] + 1e-9


@given(
    st.tuples(*[st.integers(-400, 400)] * 2).map(sorted).filter(lambda s: s[0] < s[1]),
    st.tuples(*[st.integers(-900, 900)] * 2).map(sorted).filter(lambda s: s[0] < s[1]),
    st.lists(st.integers(-180, 180), min_size=2, max_size=2),
)
def test_all_turns_within_the_limits_are_found(one, two, angles):
    line = ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 1)
    chain = Chain((), (Rotary("C", *line, tuple(one)), Rotary("A", *line, tuple(two))))
    found, allowed = turns(chain, np.array([[angles]], float))
    wanted = {(a, b) for a in by_counting(angles[0], one) for b in by_counting(angles[1], two)}
    assert {tuple(np.round(row, 6)) for row in found[allowed].tolist()} == wanted
    assert len(found[allowed]) == len(wanted)


def test_rounding_does_not_push_an_angle_over_its_limit():
    line = Rotary("A", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), -1, (-30.0, 110.0))
    angles = np.array([[[110.0 + 1e-13]], [[-30.0 - 1e-13]], [[110.001]]])
    found, allowed = turns(Chain((line,)), angles)
    assert allowed[:, 0].tolist() == [True, True, False]
    assert found[:2, 0, 0].tolist() == [110.0, -30.0]


def test_an_axis_without_limits_has_one_angle():
    line = Rotary("A", (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), -1, None, 360.0)
    found, allowed = turns(Chain((line,)), np.array([[[-170.0]]]))
    assert found.tolist() == [[[-170.0]]]
    assert allowed.all()


def test_angles_as_the_display_has_them():
    angles = np.array([0.0, 359.5, 360.0, -90.0, 725.0, -1e-17])
    line = ("C", (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), -1, None)
    assert Rotary(*line, 360.0).shown(angles).tolist() == [0.0, 359.5, 0.0, 270.0, 5.0, 0.0]
    assert Rotary(*line).shown(angles).tolist() == angles.tolist()


def test_travel_rules_candidates_out():
    one, two = preset("ac-trunnion", rng()).table
    everywhere = (-np.inf, np.inf)
    tip, axis = np.array([[100.0, 0.0, 0.0]]), leaning([30.0], [0.0])
    free = inverse(Chain((one, two)), tip, axis).linear[0]
    least, most = sorted(free[:, 0])
    assert most - least > 1.0
    chain = Chain((one, two), travel=((least, (least + most) / 2), everywhere, everywhere))
    allowed = inverse(chain, tip, axis).allowed[0]
    assert allowed.tolist() == (free[:, 0] == least).tolist()
