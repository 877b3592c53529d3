"""Siemens' compensation files: EEC for the axis itself, CEC for one axis over another.

The sign of EEC, in words (function manual K3): commanded to X 100 the axis stands at 100.010, an
error of +0.010. A positive compensation value moves the axis in the negative direction, so the
value that takes it back is +0.010.

The sign of CEC, in words: at Y 200 the tool is 4 um too far in X. What takes it back moves X by
-4 um: the value is +0.004 on a control where a positive value moves the axis in the negative
direction, and -0.004 where it moves it in the positive one.
"""

from __future__ import annotations

import numpy as np
import pytest
from format_kit import apart, at, cannot, nine, pitch, refusal, rigid, written
from gcxform_plugins.formats.siemens_cec import SiemensCec
from gcxform_plugins.formats.siemens_eec import SiemensEec
from hypothesis import given, settings
from hypothesis import strategies as st

from gcxform.errormodel.functions import AxisFunction, AxisFunctions

EEC = """\
%_N_AX_EEC_INI
CHANDATA(1)
$AA_ENC_COMP[0,0,X1]=0.0 ; first value
$AA_ENC_COMP[0,1,X1]=0.010 ; +10 um
$AA_ENC_COMP[0,2,X1]=0.012
$AA_ENC_COMP_STEP[0,X1]=100.0 ; distance of the points
$AA_ENC_COMP_MIN[0,X1]=0.0
$AA_ENC_COMP_MAX[0,X1]=200.0
$AA_ENC_COMP_IS_MODULO[0,X1]=0
M17
"""
CEC = """\
%_N_NC_CEC_INI
CHANDATA(1)
$AN_CEC [0,0] =0 ; first value
$AN_CEC[0,1]=0.004
$AN_CEC_INPUT_AXIS[0]=(AX2) ; Y
$AN_CEC_OUTPUT_AXIS[0]=(AX1) ; X
$AN_CEC_STEP[0]=200.0
$AN_CEC_MIN[0]=0.0
$AN_CEC_MAX[0]=200.0
$AN_CEC_DIRECTION[0]=0
$AN_CEC_MULT_BY_TABLE[0]=0
$AN_CEC_IS_MODULO[0]=0
M17
"""
AXES = "AX1,AX2,AX3"
PLUS, MINUS = (SiemensCec("mm", AXES, way) for way in ("plus", "minus"))


@pytest.mark.parametrize(("units", "mm"), [("mm", 1.0), ("in", 25.4)])
def test_the_sign_of_eec(tmp_path, units, mm):
    path = tmp_path / "eec.ini"
    path.write_text(EEC)
    assert SiemensEec.recognises(path)
    assert not SiemensCec.recognises(path)
    model = SiemensEec(units).read(path)
    assert at(model, 100.0 * mm) == pytest.approx([0.010 * mm, 0, 0])
    assert at(model, 150.0 * mm) == pytest.approx([0.011 * mm, 0, 0])


@pytest.mark.parametrize(("form", "error"), [(MINUS, 0.004), (PLUS, -0.004)])
def test_the_sign_of_cec(tmp_path, form, error):
    path = tmp_path / "cec.ini"
    path.write_text(CEC)
    assert SiemensCec.recognises(path)
    assert not SiemensEec.recognises(path)
    assert at(form.read(path), 0.0, 200.0) == pytest.approx([error, 0, 0])


def test_what_eec_writes(tmp_path):
    path = tmp_path / "eec.ini"
    path.write_text(EEC)
    lines = SiemensEec("mm").write(SiemensEec("mm").read(path))[""].splitlines()
    plain = [line.partition(" ;")[0] for line in EEC.splitlines()]
    numbers = {"0.0": "0", "0.010": "0.01", "100.0": "100", "200.0": "200"}
    for k, line in enumerate(plain):
        name, equals, value = line.partition("=")
        plain[k] = name + equals + numbers.get(value, value)
    assert lines == plain


def test_what_cec_writes(tmp_path):
    path = tmp_path / "cec.ini"
    path.write_text(CEC)
    text = MINUS.write(MINUS.read(path))[""]
    assert "$AN_CEC[0,1]=0.004\n$AN_CEC_INPUT_AXIS[0]=(AX2)\n$AN_CEC_OUTPUT_AXIS[0]=(AX1)\n" in text
    assert "$AN_CEC[0,1]=-0.004\n" in PLUS.write(MINUS.read(path))[""]


def positioning(seed):
    model = pitch(seed, "XZ", 37.5, backlash=False)
    axes = []
    for k, table in enumerate(model.axes):
        values = None if table is None else table.forward[:, None] * (np.arange(3) == k)
        axes.append(None if table is None else AxisFunction(table.position, values))
    return AxisFunctions((axes[0], axes[1], axes[2]))


@settings(max_examples=20)
@given(st.integers(0, 10_000), st.sampled_from(["mm", "in"]))
def test_eec_there_and_back(tmp_path_factory, seed, units):
    form = SiemensEec(units, "MX,MY,MZ")
    path = tmp_path_factory.mktemp("eec") / "eec.ini"
    for model in (positioning(seed), pitch(seed, "XYZ", 12.5, backlash=False)):
        assert apart(model, form.read(written(form, model, path))) < 1e-8


@pytest.mark.parametrize("way", ["plus", "minus"])
@settings(max_examples=settings.default.max_examples // 15)
@given(seed=st.integers(0, 10_000), units=st.sampled_from(["mm", "in"]))
def test_cec_there_and_back(tmp_path_factory, seed, units, way):
    form = SiemensCec(units, AXES, way, points=500, tables=9)
    path = tmp_path_factory.mktemp("cec") / "cec.ini"
    for model in (nine(seed, 20.0), pitch(seed, "XZ", 12.5)):
        assert apart(model, form.read(written(form, model, path))) < 1e-8
    assert form.read(path).backlash.tolist() == pitch(seed, "XZ").backlash.tolist()


@pytest.mark.parametrize("way", ["plus", "minus"])
@settings(max_examples=max(settings.default.max_examples // 75, 1))
@given(seed=st.integers(0, 10_000), units=st.sampled_from(["mm", "in"]))
def test_cec_of_uneven_steps(tmp_path_factory, seed, units, way):
    """Its points are a millimetre apart then, and are compared in three dimensions."""
    form = SiemensCec(units, AXES, way, points=500, tables=9)
    path = tmp_path_factory.mktemp("cec") / "cec.ini"
    assert apart(nine(seed), form.read(written(form, nine(seed), path))) < 1e-8


def test_positions_become_equal_steps(tmp_path):
    position = np.array([0.0, 7.5, 17.5, 50.0])
    values = np.outer([0, 1e-3, 0, 2e-3], [1, 0, 0])
    model = AxisFunctions((AxisFunction(position, values), None, None))
    form = SiemensEec("mm")
    again = form.read(written(form, model, tmp_path / "eec.ini"))
    assert np.array_equal(again.nodes[0], np.arange(0, 51, 2.5))
    assert apart(model, again) < 1e-9
    assert "need 21 points" in cannot(SiemensEec("mm", points=20), model)


def test_what_they_cannot_hold():
    eec = SiemensEec("mm", points=10_000)
    assert "the backlash of X" in cannot(eec, pitch(1))
    assert "E" in cannot(eec, nine(1))
    assert "angular functions" in cannot(MINUS, rigid(1))
    assert "9 tables" in cannot(MINUS, nine(1))


@pytest.mark.parametrize("names", ["X1,Y1", "X1,X1,Z1", ""])
def test_names_of_axes_are_three(names):
    with pytest.raises(ValueError, match="three names"):
        SiemensEec("mm", names)


DEFECTS = {
    "no table": (MINUS, "%_N_NC_CEC_INI\nM17\n", "GX417", 0, 1),
    "a block": (MINUS, "G1 X4\n" + CEC, "GX482", 1, 1),
    "another variable": (MINUS, "$AA_ENC_COMP[0,0,X1]=1\n", "GX482", 1, 1),
    "no index": (MINUS, CEC.replace("[0,1]=0.004", "[1]=0.004"), "GX418", 4, 1),
    "two values": (MINUS, CEC.replace("=0.004", "=0.004=1"), "GX418", 4, 1),
    "negative index": (MINUS, CEC.replace("[0,1]", "[0,-1]"), "GX419", 4, 11),
    "not a number": (MINUS, CEC.replace("0.004", "0,004"), "GX418", 4, 1),
    "a word": (MINUS, CEC.replace("0.004", "R1"), "GX419", 4, 14),
    "inf": (MINUS, CEC.replace("0.004", "inf"), "GX412", 4, 14),
    "unknown axis": (MINUS, CEC.replace("AX2", "AX4"), "GX482", 5, 23),
    "product": (MINUS, CEC.replace("TABLE[0]=0", "TABLE[0]=1"), "GX482", 11, 1),
    "modulo": (MINUS, CEC.replace("MODULO[0]=0", "MODULO[0]=1"), "GX482", 12, 1),
    "direction 2": (MINUS, CEC.replace("DIRECTION[0]=0", "DIRECTION[0]=2"), "GX482", 10, 22),
    "direction of another": (MINUS, CEC.replace("TION[0]=0", "TION[0]=1"), "GX482", 6, 1),
    "no step": (MINUS, CEC.replace("$AN_CEC_STEP[0]=200.0\n", ""), "GX417", 11, 1),
    "step": (MINUS, CEC.replace("STEP[0]=200.0", "STEP[0]=0"), "GX408", 7, 1),
    "step does not fit": (MINUS, CEC.replace("STEP[0]=200.0", "STEP[0]=150"), "GX483", 7, 1),
    "value lost": (MINUS, CEC.replace("STEP[0]=200.0", "STEP[0]=100"), "GX483", 7, 1),
    "too many": (MINUS, CEC.replace("M17", "$AN_CEC[0,2]=1\nM17"), "GX483", 7, 1),
    "value twice": (MINUS, CEC.replace("M17", "$AN_CEC[0,1]=1\nM17"), "GX483", 13, 1),
    "step twice": (MINUS, CEC.replace("M17", "$AN_CEC_STEP[0]=1\nM17"), "GX483", 13, 1),
    "no input": (MINUS, CEC.replace("$AN_CEC_INPUT_AXIS[0]=(AX2) ; Y\n", ""), "GX417", 11, 1),
    "other travel": (
        MINUS,
        CEC.replace("M17\n", CEC.replace("[0", "[1").replace("200.0", "100.0")),
        "GX482",
        8,
        1,
    ),
    "second encoder": (SiemensEec("mm"), EEC.replace("COMP[0,0", "COMP[1,0"), "GX482", 3, 14),
    "axis of eec": (SiemensEec("mm"), EEC.replace("X1", "C1"), "GX482", 3, 18),
    "modulo of eec": (SiemensEec("mm"), EEC.replace("DULO[0,X1]=0", "DULO[0,X1]=1"), "GX482", 9, 1),
    "no eec": (SiemensEec("mm"), "M17\n", "GX417", 0, 1),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tmp_path, name):
    form, text, code, line, column = DEFECTS[name]
    found = refusal(form, tmp_path / "table.ini", text)
    assert found.code == code, found.render()
    assert found.where is not None
    assert (found.where.line, found.where.column) == (line, column), found.render()
