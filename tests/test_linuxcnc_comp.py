"""LinuxCNC's compensation files, both types.

The sign, in words: commanded to 100 the X axis stands at 100.005 after travel forward and at 99.997
after travel back. Its errors are +0.005 and -0.003. A file of type 0 says where it stands,
`100 100.005 99.997`; one of type 1 says what LinuxCNC adds to the command, `100 -0.005 0.003`.
"""

from __future__ import annotations

import numpy as np
import pytest
from format_kit import apart, at, cannot, nine, pitch, refusal, rigid, written
from gcxform_plugins.formats.linuxcnc_comp import LinuxCncComp
from hypothesis import given
from hypothesis import strategies as st

from gcxform.errormodel.converting import to_pitch
from gcxform.errormodel.functions import AxisFunction, AxisFunctions

TYPE0 = "0 0 0\n100 100.005 99.997\n200 200 200\n"
TYPE1 = "0 0 0\n100 -0.005 0.003\n200 0 0\n"
INCH = "0 0 0\n3.937007874016 3.937204724409 3.936889763780\n8 8 8\n"


@pytest.mark.parametrize(
    ("kind", "units", "text"), [("0", "mm", TYPE0), ("1", "mm", TYPE1), ("0", "in", INCH)]
)
def test_the_sign(tmp_path, kind, units, text):
    path = tmp_path / "screw.comp"
    path.write_text(text)
    model = LinuxCncComp(kind, units, "X").read(path)
    assert at(model, 100.0, sense=1) == pytest.approx([0.005, 0, 0], abs=1e-9)
    assert at(model, 100.0, sense=-1) == pytest.approx([-0.003, 0, 0], abs=1e-9)
    assert model.backlash.tolist() == [True, False, False]


@pytest.mark.parametrize(("kind", "text"), [("0", TYPE0), ("1", TYPE1)])
def test_what_is_written(tmp_path, kind, text):
    path = tmp_path / "screw.comp"
    path.write_text(text)
    form = LinuxCncComp(kind, "mm", "X")
    assert form.write(form.read(path)) == {"": text}


@given(st.integers(0, 10_000), st.sampled_from("01"), st.sampled_from(["mm", "in"]))
def test_there_and_back(tmp_path_factory, seed, kind, units):
    model, form = pitch(seed, "XZ"), LinuxCncComp(kind, units)
    place = written(form, model, tmp_path_factory.mktemp("comp") / "files")
    assert sorted(p.name for p in place.iterdir()) == ["x.comp", "z.comp"]
    assert LinuxCncComp.recognises(place)
    assert LinuxCncComp.recognises(place / "z.comp")
    assert apart(model, form.read(place)) < 1e-8


def test_nine_functions_that_are_pitch_alone(tmp_path):
    alone = [
        AxisFunction(f.position, f.values * (np.arange(3) == k)) for k, f in enumerate(nine(1).axes)
    ]
    functions = AxisFunctions((alone[0], alone[1], alone[2]))
    form = LinuxCncComp("1", "mm")
    again = form.read(written(form, functions, tmp_path / "files"))
    assert apart(functions, again) < 1e-8
    assert apart(to_pitch(nine(1)).model, again) < 1e-8


def test_what_it_cannot_hold():
    one = LinuxCncComp("0", "mm", "X")
    assert "E" in cannot(one, nine(1))
    assert "axis-functions" in cannot(one, rigid(1))
    assert "the axis Y in the file of X" in cannot(one, pitch(1, "XY"))
    assert "without errors of X" in cannot(one, pitch(1, ""))
    long = pitch(1, "X")
    object.__setattr__(long.axes[0], "position", [0.0] * 257)
    assert "257 positions" in cannot(one, long)


DEFECTS = {
    "header": ("nominal forward reverse\n0 0 0\n1 0 0\n", "GX419", 1, 1),
    "comment": ("0 0 0\n# 1\n2 0 0\n", "GX418", 2, 4),
    "blank": ("0 0 0\n\n2 0 0\n", "GX418", 3, 1),
    "two columns": ("0 0 0\n1 0\n", "GX418", 2, 4),
    "four columns": ("0 0 0\n1 0 0 0\n", "GX418", 2, 7),
    "falls": ("0 0 0\n2 0 0\n1 0 0\n", "GX408", 3, 1),
    "twice": ("0 0 0\n2 0 0\n2 0 0\n", "GX409", 3, 1),
    "nan": ("0 0 0\n2 0 nan\n", "GX412", 2, 5),
    "one entry": ("0 0 0\n", "GX411", 1, 1),
    "empty": ("", "GX411", 0, 1),
    "too long": ("".join(f"{k} {k} {k}\n" for k in range(257)), "GX482", 257, 1),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tmp_path, name):
    text, code, line, column = DEFECTS[name]
    found = refusal(LinuxCncComp("0", "mm", "X"), tmp_path / "x.comp", text)
    assert found.code == code, found.render()
    assert found.where is not None
    assert (found.where.line, found.where.column) == (line, column), found.render()


def test_a_file_without_axis_is_asked_for_it(tmp_path):
    assert refusal(LinuxCncComp("0", "mm"), tmp_path / "x.comp", TYPE0).code == "GX480"
