"""Points of height maps (UGS, bCNC), bCNC's probe files, Klipper's meshes and skews.

The sign of heights, in words: at X 10, Y 20 the probe touches 0.3 mm above nominal. A tool at Z 0
is 0.3 mm too low relative to the surface there, so its error in Z is -0.3 mm, and it is raised.

The sign of skew, in words: with xy_skew = +0.01 Klipper commands X 99 for X 100, Y 100, because
the machine itself goes 1 mm too far in X there: the error in X is +1 mm.
"""

from __future__ import annotations

import numpy as np
import pytest
from format_kit import apart, at, cannot, nine, refusal, written
from gcxform_plugins.formats.bcnc import BcncProbe
from gcxform_plugins.formats.klipper import KlipperMesh, KlipperSkew
from gcxform_plugins.formats.xyz import Xyz
from hypothesis import given
from hypothesis import strategies as st

from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.linear import Linear
from gcxform.errormodel.model import compensate

XYZ = "0 0 0\n10 0 0.1\n0 20 0\n10 20 0.3\n0 40 0\n10 40 0\n"
PROBE = "0 10 2\n0 40 3\n-5 2 100\n\n" + XYZ
CFG = """\
[printer]
kinematics = cartesian
[bed_mesh]
speed: 120
[gcode_macro START]
gcode:
  G28

#*# <---------------------- SAVE_CONFIG ---------------------->
#*# DO NOT EDIT THIS BLOCK OR BELOW. The contents are auto-generated.
#*#
#*# [bed_mesh default]
#*# version = 1
#*# points =
#*# 	  0.000000, 0.100000
#*# 	  0.000000, 0.300000
#*# 	  0.000000, 0.000000
#*# tension = 0.2
#*# min_x = 0.0
#*# algo = lagrange
#*# y_count = 3
#*# mesh_y_pps = 2
#*# min_y = 0.0
#*# x_count = 2
#*# max_y = 40.0
#*# mesh_x_pps = 2
#*# max_x = 10.0
"""
SKEW = "[skew_correction CaliFlower]\nxy_skew = 0.01\nxz_skew = 0.002\nyz_skew = -0.003\n"
FORMS = {
    "xyz": (Xyz("mm"), "map.xyz", XYZ),
    "probe": (BcncProbe("mm"), "map.probe", PROBE),
    "klipper": (KlipperMesh(), "printer.cfg", CFG),
}


@pytest.mark.parametrize("name", FORMS)
def test_the_sign_of_heights(tmp_path, name):
    form, file, text = FORMS[name]
    path = tmp_path / file
    path.write_text(text)
    assert form.recognises(path)
    model = form.read(path)
    assert at(model, 10.0, 20.0) == pytest.approx([0, 0, -0.3], abs=1e-12)
    assert at(model, 10.0, 0.0) == pytest.approx([0, 0, -0.1], abs=1e-12)
    assert at(model, 5.0, 20.0) == pytest.approx([0, 0, -0.15], abs=1e-12)
    assert compensate(model, np.array([[10.0, 20.0, 0.0]])).position[0, 2] == pytest.approx(0.3)


@pytest.mark.parametrize("kind", [Xyz, BcncProbe])
def test_inches(tmp_path, kind):
    path = tmp_path / "map"
    path.write_text(XYZ if kind is Xyz else PROBE)
    assert at(kind("in").read(path), 254.0, 508.0)[2] == pytest.approx(-0.3 * 25.4)


def surface(seed, even=True):
    rng = np.random.default_rng(seed)
    count = rng.integers(2, 9, 2)
    x, y = (
        np.cumsum(np.full(n, s) if even else rng.uniform(5, 20, n)) - 40
        for n, s in zip(count, rng.integers(5, 40, 2), strict=True)
    )
    values = np.zeros((len(x), len(y), 1, 3))
    values[..., 2] = rng.integers(-900, 900, (len(x), len(y), 1)) / 1e4
    return Lattice((x, y, np.zeros(1)), values)


@given(st.integers(0, 10_000), st.sampled_from(["mm", "in"]))
def test_there_and_back(tmp_path_factory, seed, units):
    folder = tmp_path_factory.mktemp("map")
    model = surface(seed)
    for form in (Xyz(units), BcncProbe(units, -5.0, 2.0, 100.0), KlipperMesh("a")):
        assert apart(model, form.read(written(form, model, folder / "map"))) < 1e-8
    model = surface(seed, even=False)
    assert apart(model, Xyz(units).read(written(Xyz(units), model, folder / "map"))) < 1e-8


def test_what_is_written(tmp_path):
    path = tmp_path / "map"
    path.write_text(PROBE)
    form = BcncProbe("mm", -5.0, 2.0, 100.0)
    model = form.read(path)
    rows = XYZ.splitlines()
    expected = ["0 10 2", "0 40 3", "-5 2 100", "", *rows[:2], "", *rows[2:4], "", *rows[4:]]
    assert form.write(model)[""].splitlines() == expected
    assert Xyz("mm").write(model)[""] == XYZ
    assert "algo = direct" in KlipperMesh().write(model)[""]


def test_points_in_any_order_and_not_quite_on_the_grid(tmp_path):
    path = tmp_path / "map.xyz"
    rows = XYZ.replace("10 40 0", "10.000004 39.99999 0").splitlines()
    path.write_text("\n".join(reversed(rows)))
    assert at(Xyz("mm").read(path), 10.0, 20.0)[2] == pytest.approx(-0.3, abs=1e-6)


def test_how_bcnc_probes_the_next_time_in_inches(tmp_path):
    """Depth and feed are lengths as everywhere, mm and mm/min, and the file is in inches."""
    (tmp_path / "map.xyz").write_text(XYZ)
    model = Xyz("mm").read(tmp_path / "map.xyz")
    text = BcncProbe("in", -2.54, 5.08, 101.6).write(model)[""]
    assert text.splitlines()[2] == "-0.1 0.2 4"


def test_what_they_cannot_hold():
    form = Xyz("mm")
    assert "'axis-functions'" in cannot(form, nine(1))
    model = surface(1)
    turned = Lattice(model.grid, model.values, model.values * 1e-3, (0.0, 0.0, 0.0))
    assert "angular" in cannot(form, turned)
    x, y, _ = model.grid
    twice = np.concatenate([model.values, model.values], axis=2)
    assert "depend on Z" in cannot(form, Lattice((x, y, np.array([0.0, 1.0])), twice))
    sideways = np.roll(model.values, 1, axis=-1)
    assert "errors in X" in cannot(form, Lattice(model.grid, sideways))
    line = Lattice((x, y[:1], np.zeros(1)), model.values[:, :1])
    assert "along a line" in cannot(form, line)
    uneven = Lattice(
        (np.array([0.0, 1, 3]), np.array([0.0, 1]), np.zeros(1)), np.ones((3, 2, 1, 3)) * [0, 0, 1]
    )
    for form in (KlipperMesh(), BcncProbe("mm", -1.0, 1.0, 1.0)):
        assert "equally spaced" in cannot(form, uneven)
    assert "depth and feed" in cannot(BcncProbe("mm"), model)


# --- skew ---


def test_the_sign_of_skew(tmp_path):
    path = tmp_path / "printer.cfg"
    path.write_text(SKEW)
    assert KlipperSkew.recognises(path)
    assert not KlipperMesh.recognises(path)
    model = KlipperSkew().read(path)
    assert at(model, 100.0, 100.0)[0] == pytest.approx(1.0)


def test_the_command_is_klippers(tmp_path):
    """What the model compensates is what Klipper commands: users.md 6, read from its source."""
    path = tmp_path / "printer.cfg"
    path.write_text(SKEW)
    model = KlipperSkew().read(path)
    xy, xz, yz = 0.01, 0.002, -0.003
    targets = np.random.default_rng(1).uniform(-200, 200, (50, 3))
    x, y, z = targets.T
    expected = np.stack([x - y * xy - z * (xz - xy * yz), y - z * yz, z], axis=1)
    assert np.abs(compensate(model, targets).position - expected).max() < 1e-9
    again = KlipperSkew("b").read(written(KlipperSkew("b"), model, path))
    assert np.array_equal(again.matrix, model.matrix)


def test_what_a_skew_cannot_hold():
    square = np.array([[0, 1e-3, 0], [0, 0, 0], [0, 0, 0]])
    assert "scale" in cannot(KlipperSkew(), Linear(np.eye(3) * 1e-3, np.zeros(3)))
    assert "origin" in cannot(KlipperSkew(), Linear(square, np.ones(3)))
    assert "'axis-functions'" in cannot(KlipperSkew(), nine(1))


# --- defects ---

MM = Xyz("mm")
BC = BcncProbe("mm")
MESH = KlipperMesh()
PART = CFG[CFG.index("#*# [bed") :]
DEFECTS = {
    "no points": (MM, "", "GX411", 0, 1),
    "a header": (MM, "x y z\n" + XYZ, "GX419", 1, 1),
    "a line of points": (MM, "0 0 0\n1 0 0\n2 0 0\n", "GX411", 3, 1),
    "two columns": (MM, XYZ + "1 2\n", "GX418", 7, 4),
    "missing": (MM, XYZ.replace("0 20 0\n", "", 1), "GX483", 5, 1),
    "double": (MM, XYZ + "10 20 0\n", "GX483", 7, 1),
    "nan": (MM, XYZ.replace("0.3", "nan"), "GX412", 4, 7),
    "short file": (BC, "0 10 2\n0 40 3\n", "GX417", 2, 1),
    "one position": (BC, PROBE.replace("0 10 2", "0 10 1"), "GX417", 1, 6),
    "falls": (BC, PROBE.replace("0 40 3", "40 0 3"), "GX408", 2, 4),
    "beside": (BC, PROBE.replace("10 20 0.3", "10 21 0.3"), "GX483", 8, 4),
    "no height": (BC, PROBE.replace("10 20 0.3\n", ""), "GX483", 9, 1),
    "word": (BC, PROBE.replace("0.3", "probe"), "GX419", 8, 7),
    "no profile": (MESH, "[bed_mesh]\nspeed = 3\n", "GX480", 0, 1),
    "two profiles": (MESH, CFG + PART.replace("default", "b"), "GX480", 0, 1),
    "version": (MESH, CFG.replace("version = 1", "version = 2"), "GX482", 13, 1),
    "no count": (MESH, CFG.replace("#*# x_count = 2\n", ""), "GX417", 12, 5),
    "bad count": (MESH, CFG.replace("x_count = 2", "x_count = 1"), "GX417", 24, 15),
    "row lost": (MESH, CFG.replace("#*# 	  0.000000, 0.300000\n", ""), "GX483", 14, 5),
    "short row": (MESH, CFG.replace("0.000000, 0.3", "0.3"), "GX418", 16, 16),
    "nan point": (MESH, CFG.replace("0.300000", "nan"), "GX412", 16, 18),
    "key without number": (MESH, CFG.replace("min_x = 0.0", "min_x ="), "GX418", 19, 12),
    "mesh falls": (MESH, CFG.replace("max_x = 10.0", "max_x = -1"), "GX408", 27, 13),
    "no skew": (KlipperSkew(), SKEW.replace("xz_skew = 0.002\n", ""), "GX417", 1, 1),
    "skew of words": (KlipperSkew(), SKEW.replace("0.002", "small"), "GX419", 3, 11),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tmp_path, name):
    form, text, code, line, column = DEFECTS[name]
    found = refusal(form, tmp_path / "map", text)
    assert found.code == code, found.render()
    assert found.where is not None
    assert (found.where.line, found.where.column) == (line, column), found.render()


def test_a_profile_by_its_name(tmp_path):
    path = tmp_path / "printer.cfg"
    path.write_text(CFG + PART.replace("default", "hot").replace("0.3", "0.4"))
    assert at(KlipperMesh("hot").read(path), 10.0, 20.0)[2] == pytest.approx(-0.4)
    assert at(KlipperMesh("default").read(path), 10.0, 20.0)[2] == pytest.approx(-0.3)
