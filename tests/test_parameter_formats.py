"""ISG CSV and ETALON exchange files: functions and squareness by their ISO 230-1 names.

The signs, in words. Commanded to X 100 the tool stands 5 um farther, EXX = +0.005 mm, and 2 um too
far in Y, EYX = +0.002 mm. Y is out of square by C0Y = +20 urad, a right-handed turn about Z: its
far end leans towards minus X, so at Y 100 the tool is 2 um too far in minus X. A yaw of X, ECX =
+30 urad, turns what Y carries right-handed about Z: at Y 100 the tool is 3 um too far in minus X.
"""

from __future__ import annotations

import pytest
from format_kit import apart, at, cannot, nine, pitch, refusal, rigid, written
from gcxform_plugins.formats.etalon import Etalon
from gcxform_plugins.formats.isg_csv import IsgCsv
from hypothesis import given
from hypothesis import strategies as st

from gcxform.errormodel.functions import AxisFunctions
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.rigid import RigidBody

ISG = """\
// machine 4711, measured at 20 degC
C0Y   // squareness
0.00002
#
X EXX EYX ECX
0.0   0.0   0.0   0.0
100.0 0.005 0.002 0.00003   // far end
#
Y EYY
0 0
100 0
"""
ETALON = """\
// Vendor variant
[C0Y]
VALUE = 0.000020000000
[EXX]
Gridpoints = {
    0.0 0.000000
  100.0 0.005000
}  // end of EXX
[EYX]
Gridpoints = {
   0 0
  50 0.001
 100 0.002
}
[ECX]
Gridpoints = {
 0 0
 100 0.00003
}
[EYY]
Gridpoints = {
 0 0
 100 0
}
"""
FORMS = {IsgCsv: ISG, Etalon: ETALON}
both = pytest.mark.parametrize("kind", FORMS, ids=lambda kind: kind.name)


@both
def test_the_signs(tmp_path, kind):
    path = tmp_path / "machine.txt"
    path.write_text(FORMS[kind])
    assert kind.recognises(path)
    model = kind("error", "XYZ", (0.0, 0.0, 0.0)).read(path)
    assert isinstance(model, RigidBody)
    assert at(model, 100.0) == pytest.approx([0.005, 0.002, 0], abs=1e-12)
    assert at(model, 0.0, 100.0) == pytest.approx([-0.002, 0, 0], abs=1e-12)
    assert at(model, 100.0, 100.0) == pytest.approx([0.0, 0.002, 0], abs=1e-12)


NATIVE = """\
format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
[Y]
position = [0, 100]
EXY = [0, 0]
EYY = [0, 0]
EZY = [0, 0]
[Z]
position = [-50, 100]
EXZ = [0, 0.001]
EYZ = [0, 0]
EZZ = [0, 0]
[squareness]
C0Y = 1e-5
B0Z = 2e-5
A0Z = -4e-5
"""
SQUARE = {
    IsgCsv: """\
C0Y B0Z A0Z
1e-5 2e-5 -4e-5
#
Y EYY
0 0
100 0
#
Z EXZ
-50 0
100 0.001
""",
    Etalon: """\
[C0Y]
VALUE=1e-5
[B0Z]
VALUE=2e-5
[A0Z]
VALUE=-4e-5
[EYY]
Gridpoints = {
0 0
100 0
}
[EXZ]
Gridpoints = {
-50 0
100 0.001
}
""",
}


@both
def test_squareness_is_that_of_the_native_file(tmp_path, kind):
    (tmp_path / "native.toml").write_text(NATIVE)
    (tmp_path / "table").write_text(SQUARE[kind])
    native = load_model(tmp_path / "native.toml")
    assert apart(native, kind("error").read(tmp_path / "table")) < 1e-15


@both
def test_corrections_are_negated(tmp_path, kind):
    path = tmp_path / "machine.txt"
    path.write_text(FORMS[kind].replace("0.00002\n", "0\n").replace("0.000020000000", "0"))
    model = kind("correction", "XYZ", (0.0, 0.0, 0.0)).read(path)
    assert at(model, 100.0) == pytest.approx([-0.005, -0.002, 0], abs=1e-12)
    path.write_text(FORMS[kind])
    assert refusal(kind("correction", "XYZ", (0.0, 0.0, 0.0)), path, FORMS[kind]).code == "GX420"


@given(st.integers(0, 10_000), st.sampled_from(["error", "correction"]))
@both
def test_there_and_back(tmp_path_factory, kind, seed, values):
    path = tmp_path_factory.mktemp("table") / "machine.txt"
    model = rigid(seed, "YXZ")
    moved = RigidBody(model.axes, "YXZ", ((5.0, 6.0, 7.0),) * 3, model.measured)
    form = kind(values, "YXZ", model.measured)
    for each in (model, moved):
        assert apart(each, form.read(written(form, each, path))) < 1e-8
    form = kind(values)
    again = form.read(written(form, nine(seed), path))
    assert isinstance(again, AxisFunctions)
    assert apart(nine(seed), again) < 1e-8
    assert kind.recognises(path)


def test_what_isg_writes(tmp_path):
    path = tmp_path / "machine.csv"
    path.write_text(ISG)
    form = IsgCsv("error", "XYZ", (0.0, 0.0, 0.0))
    assert form.write(form.read(path))[""].splitlines() == [
        "X EXX EYX EZX EAX EBX ECX",
        "0 0 0 0 0 0 0",
        "100 0.005 0.002 0 0 0 0.00003",
        "#",
        "Y EXY EYY EZY EAY EBY ECY",
        "0 0 0 0 0 0 0",
        "100 -0.002 0 0 0 0 0",
    ]


@both
def test_what_they_cannot_hold(kind):
    assert "'pitch'" in cannot(kind("error"), pitch(1))
    assert "order" in cannot(kind("error"), rigid(1))
    assert "order" in cannot(kind("error", "XYZ", (0.0, 0.0, 0.0)), rigid(1))


ISG_DEFECTS = {
    "empty": ("// nothing\n", "GX417", 0, 1),
    "rotary": ("C0B\n1e-5\n", "GX482", 1, 1),
    "two arguments": ("Z X EXX\n0 0 0\n", "GX482", 1, 3),
    "of another axis": ("X EXY\n0 0\n1 0\n", "GX482", 1, 3),
    "squareness over X": ("X C0Y\n0 0\n1 0\n", "GX482", 1, 3),
    "no argument": ("EXX\n0\n", "GX417", 1, 1),
    "twice": ("X EXX\n0 0\n1 0\n#\nX EXX\n0 0\n1 0\n", "GX417", 5, 3),
    "two rows of squareness": ("C0Y\n1e-5\n1e-5\n", "GX418", 1, 1),
    "short": ("X EXX\n0 0\n1\n", "GX418", 3, 2),
    "word": ("X EXX\n0 0\n1 0,5\n", "GX419", 3, 3),
    "falls": ("X EXX\n1 0\n0 0\n", "GX408", 3, 1),
    "nan": ("X EXX\n0 0\n1 nan\n", "GX412", 3, 3),
    "one row": ("X EXX\n0 0\n", "GX411", 2, 1),
    "no rows": ("X EXX\n", "GX411", 1, 1),
    "squareness without travel": ("C0Y\n1e-5\n#\nX EXX\n0 0\n1 0\n", "GX420", 1, 1),
    "squareness alone": ("C0Y\n0\n", "GX422", 1, 1),
    "other travel": ("X EXX\n0 0\n1 0\n#\nX EYX\n0 0\n2 0\n", "GX482", 5, 1),
    "angular": ("X EXX EAX\n0 0 0\n1 0 1e-6\n", "GX480", 1, 1),
}
ETALON_DEFECTS = {
    "empty": ("", "GX417", 0, 1),
    "rotary": ("[C0B]\nVALUE = 1e-5\n", "GX482", 1, 1),
    "no block": ("VALUE = 1\n", "GX417", 1, 1),
    "nothing in it": ("[EXX]\n", "GX418", 1, 1),
    "value of a function": ("[EXX]\nVALUE = 1\n", "GX417", 2, 1),
    "points of squareness": ("[C0Y]\nGridpoints = {\n0 0\n1 0\n}\n", "GX482", 2, 1),
    "other key": ("[EXX]\nPoints = {\n", "GX417", 2, 1),
    "not a number": ("[C0Y]\nVALUE = x\n", "GX419", 2, 9),
    "open": ("[EXX]\nGridpoints = {\n0 0\n1 0\n", "GX418", 2, 14),
    "short": ("[EXX]\nGridpoints = {\n0 0\n1\n}\n", "GX418", 4, 2),
    "falls": ("[EXX]\nGridpoints = {\n1 0\n0 0\n}\n", "GX408", 4, 1),
    "no points": ("[EXX]\nGridpoints = {\n}\n", "GX411", 3, 1),
}
CASES = [(IsgCsv, name, *case) for name, case in ISG_DEFECTS.items()]
CASES += [(Etalon, name, *case) for name, case in ETALON_DEFECTS.items()]


@pytest.mark.parametrize(
    ("kind", "name", "text", "code", "line", "column"), CASES, ids=lambda v: str(v)[:20]
)
def test_defects(tmp_path, kind, name, text, code, line, column):
    found = refusal(kind("error"), tmp_path / "machine.txt", text)
    assert found.code == code, found.render()
    assert found.where is not None
    assert (found.where.line, found.where.column) == (line, column), found.render()
