"""`gcxform show` of error models: their functions, their squareness, the volume."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from picture_kit import assert_png, corners, drawn
from simulate_kit import EXAMPLE, functions

import gcxform as gx
from gcxform import plot
from gcxform.errormodel.model_file import load_model
from gcxform.plot.models import curves, squareness

EXAMPLES = EXAMPLE.parents[1]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_model_is_drawn_as_a_grid_of_functions_and_a_volume(here):
    assert call("show", str(EXAMPLE), "-o", "model.svg").exit_code == 0
    groups, text = drawn("model.svg")
    for name in ("EXX", "EYX", "EZX", "EXY", "EYY", "EZY", "EXZ", "EYZ", "EZZ"):
        assert corners(groups[name]) == 11, name
        assert f"{name}, um" in text
    for name in ("EAX", "ECZ"):  # and no pane for what there is not
        assert name not in groups
        assert name not in text
    assert {"frame", "scale bar", "squareness"} <= set(groups)
    assert {"X, mm", "20 um", "nominal"} <= set(text.splitlines())
    for word in ("C0Y -25.264 urad", "B0Z +34.424 urad", "A0Z -52.624 urad"):
        assert word in text
    assert {"nominal", "actual", "errors"} <= set(groups)
    assert "errors x 2000" in text
    assert call("show", str(EXAMPLE), "-o", "model.png").exit_code == 0
    assert_png(here / "model.png")


def test_squareness_is_the_angle_between_two_axes_whatever_their_frame():
    """V9: turned by a small angle about Z, both straightnesses change and C0Y does not."""
    turn = 3e-5
    plain = curves(functions(EXY=-2e-5, EYZ=1e-5))
    turned = curves(functions(EXY=-2e-5 - turn, EYX=turn, EYZ=1e-5))
    assert squareness(plain) == pytest.approx({"C0Y": 2e-5, "B0Z": 0.0, "A0Z": -1e-5})
    assert squareness(turned) == pytest.approx(squareness(plain))


def test_a_machine_of_21_parameters_fills_the_grid(here):
    assert call("show", str(EXAMPLES / "rigid-body" / "model.toml"), "-o", "all.svg").exit_code == 0
    groups, text = drawn("all.svg")
    names = [f"E{letter}{axis}" for axis in "XYZ" for letter in "XYZABC"]
    assert [name for name in names if name not in groups] == []
    assert all(f"{name}, {'um' if name[1] in 'XYZ' else 'urad'}" in text for name in names)
    assert "none" not in text


def test_what_show_refuses_is_named_as_it_was_given(here):
    found = call("show", "none.toml", "-o", "model.svg")
    assert found.exit_code == 2
    assert found.stderr.startswith("none.toml: error[GX709]")
    found = call("show", str(EXAMPLE), "-o", "model.pdf")
    assert found.stderr.startswith("-o: error[GX737]")


def test_of_a_sum_the_sums_of_the_functions_are_drawn(here):
    """A warm screw and its geometry: each function is the error along its axis, from zero on."""
    folder = EXAMPLES / "warm-screw"
    whole, parts = load_model(folder / "machine.toml"), curves(load_model(folder / "machine.toml"))
    assert call("show", str(folder / "machine.toml"), "-o", "sum.svg").exit_code == 0
    groups, _ = drawn("sum.svg")
    assert set(parts) <= set(groups)
    for name, (position, value) in parts.items():
        axis, into = "XYZ".index(name[2]), "XYZ".index(name[1])
        points = np.zeros((len(position), 3))
        points[:, axis] = position
        expected = whole.error(points)[:, into] - whole.error(np.zeros((1, 3)))[0, into]
        low = float(np.interp(0.0, position, value))
        assert value - low == pytest.approx(expected, abs=5e-5), name
    assert "EXX" in parts


def test_a_model_without_limits_is_drawn_over_a_volume(here):
    """B0Z of 200 urad is 20 um in X and C0Y of 100 urad 10 um, at 100 mm: 30 um where both add."""
    (here / "skew.toml").write_text(
        'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nB0Z = 2e-4\n'
    )
    assert call("show", "skew.toml", "-o", "skew.svg").exit_code == 0
    groups, text = drawn("skew.svg")
    assert "largest 30.00 um" in text
    assert corners(groups["actual"]) > 100


def test_both_directions_of_a_pitch_table_are_drawn(here):
    table = "position = [0, 100, 200]\nforward = [0, 0.01, 0.02]"
    (here / "pitch.toml").write_text(
        f'format = 1\nkind = "pitch"\nvalues = "error"\n[X]\n{table}\n'
        f"reverse = [-0.004, 0.007, 0.015]\n[Y]\n{table}\n"
    )
    assert call("show", "pitch.toml", "-o", "pitch.svg").exit_code == 0
    groups, text = drawn("pitch.svg")
    assert corners(groups["EXX"]) == corners(groups["EXX reverse"]) == 3
    assert "reverse" in text
    assert "EYY" in groups
    assert "EYY reverse" not in groups


class Lattice(gx.ErrorModel):
    """A model that is no function of one axis at a time."""

    kind = "lattice"
    nodes = (np.array([0.0, 50.0]),) * 3

    def lipschitz(self, reach=0.0):
        return 1e-4

    def largest(self, reach=0.0):
        return 1e-2

    def error(self, position, outside=gx.Outside.ERROR, tool=None, sense=None):
        return 1e-6 * position * position[:, ::-1]

    def range_of(self, axis_index):
        return 0.0, 50.0


def test_of_a_lattice_the_field_alone_is_drawn(here):
    picture = plot.rendered(plot.model(Lattice(), "lattice"), "out.svg")
    (here / "out.svg").write_bytes(picture)
    groups, text = drawn("out.svg")
    assert {"nominal", "actual", "errors"} <= set(groups)
    assert "EXX" not in text
