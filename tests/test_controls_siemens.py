"""Kinematics taken over from a SINUMERIK: its machine data and its swivel data."""

from __future__ import annotations

import pytest
from cli_kit import call
from gcxform_plugins.controls.siemens import SiemensFiles

from gcxform.diagnostics import UsageError
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Axis
from gcxform.machine.text import to_toml

SWIVEL = """; two tables
$TC_CARR4[1]=5.0
$TC_CARR5[1]=-32.0
$TC_CARR6[1]=-95.0
$TC_CARR7[1]=-1.0
$TC_CARR8[1]=0.00011
$TC_CARR12[1]=-1.0
$TC_CARR16[1]=12.0
$TC_CARR17[1]=35.0
$TC_CARR18[1]=-5.0
$TC_CARR19[1]=20.0
$TC_CARR20[1]=60.0
$TC_CARR23[1]="P"
$TC_CARR24[1]=0
"""
DATA = """N24100 $MC_TRAFO_TYPE_1=40
N24500 $MC_TRAFO5_PART_OFFSET_1[0]=-5
N24500 $MC_TRAFO5_PART_OFFSET_1[1]=20
N24500 $MC_TRAFO5_PART_OFFSET_1[2]=60
N24510 $MC_TRAFO5_ROT_AX_OFFSET_1[0]=0
N24520 $MC_TRAFO5_ROT_SIGN_IS_PLUS_1[0]=TRUE
N24550 $MC_TRAFO5_BASE_TOOL_1[0]=5
N24550 $MC_TRAFO5_BASE_TOOL_1[1]=-32
N24550 $MC_TRAFO5_BASE_TOOL_1[2]=-95
N24558 $MC_TRAFO5_JOINT_OFFSET_PART_1[1]=12
N24558 $MC_TRAFO5_JOINT_OFFSET_PART_1[2]=35
N24570 $MC_TRAFO5_AXIS1_1[0]=-1
N24570 $MC_TRAFO5_AXIS1_1[1]=0.00011
N24572 $MC_TRAFO5_AXIS2_1[2]=-1
"""


def siemens(folder, text, axes="A,C"):
    """Return the machine of some data, through the machine file that is written."""
    (folder / "data.mpf").write_text(text)
    machine = SiemensFiles(axes).kinematics(folder / "data.mpf")
    (folder / "siemens.toml").write_text(to_toml(machine))
    return load_machine(folder / "siemens.toml")


@pytest.mark.parametrize("text", [SWIVEL, DATA])
def test_two_tables_of_a_sinumerik(tmp_path, text):
    """The vectors of tables are entered reversed: the signs are those of ISO 841."""
    machine = siemens(tmp_path, text)
    assert (machine.table, machine.head) == (("A", "C"), ())
    a, c = machine.axes["A"], machine.axes["C"]
    assert a.direction == pytest.approx((1.0, -0.00011, 0.0), abs=1e-8)
    assert (a.point, a.sign) == ((5.0, -32.0, -95.0), -1)
    assert (c.direction, c.point, c.sign) == ((0.0, 0.0, 1.0), (5.0, -20.0, -60.0), -1)


def test_two_axes_in_the_head_of_a_sinumerik(tmp_path):
    """From the gauge point up to A by I3, from there to C by I2."""
    text = "$TC_CARR23[2]=T\n$TC_CARR9[2]=1\n$TC_CARR10[2]=1\n"
    text += "$TC_CARR17[2]=150\n$TC_CARR5[2]=2.5\n$TC_CARR6[2]=60\n"
    text += "$TC_CARR2[2]=-2.5\n$TC_CARR3[2]=-210\n"
    machine = siemens(tmp_path, text, "C,A")
    assert (machine.table, machine.head) == ((), ("C", "A"))
    assert machine.axes["A"] == Axis(direction=(1.0, 0, 0), point=(0.0, 0.0, 150.0), sign=1)
    assert machine.axes["C"] == Axis(direction=(0, 0, 1.0), point=(0.0, 2.5, 210.0), sign=1)


def test_one_axis_each_of_a_sinumerik(tmp_path):
    """The first axis is that of the tool."""
    text = "$MC_TRAFO_TYPE_1=56\n$MC_TRAFO5_AXIS1_1[1]=1\n$MC_TRAFO5_AXIS2_1[2]=-1\n"
    text += "$MC_TRAFO5_BASE_TOOL_1[2]=170\n$MC_TRAFO5_JOINT_OFFSET_1[2]=-170\n"
    text += "$MC_TRAFO5_JOINT_OFFSET_PART_1[0]=1.5\n$MC_TRAFO5_PART_OFFSET_1[0]=-1.5\n"
    machine = siemens(tmp_path, text, "B,C")
    assert (machine.table, machine.head) == (("C",), ("B",))
    assert machine.axes["B"] == Axis(direction=(0, 1.0, 0), point=(0.0, 0.0, 170.0), sign=1)
    assert machine.axes["C"] == Axis(direction=(0, 0, 1.0), point=(1.5, 0.0, 0.0), sign=-1)


@pytest.mark.parametrize(
    ("text", "old", "new", "message"),
    [
        (SWIVEL, '"P"', '"X"', "no $TC_CARR23 of T, P or M"),
        (SWIVEL, '"P"', '"M"', "the vectors I4 + I3 are not 0"),
        (SWIVEL, "=-32.0", "=-31.0", "the vectors I4 + I2 + I3 are not 0"),
        (SWIVEL, "24[1]=0", "24[1]=90", "$TC_CARR24 is not 0"),
        (SWIVEL, "24[1]=0", "41[1]=0.01", "$TC_CARR41 is not 0"),
        (SWIVEL, "24[1]=0", "1[2]=0", "more than one swivel data set"),
        (SWIVEL, "12[1]=-1.0", "12[1]=0", "the vector V2 of an axis is zero"),
        (SWIVEL, "=5.0", "=R1", "$TC_CARR4: 'R1' is not a number"),
        (DATA, "TYPE_1=40", "TYPE_1=72", "no $MC_TRAFO_TYPE_1 of 24, 40 or 56"),
        (DATA, "=TRUE", "=FALSE", "ROT_SIGN_IS_PLUS is not TRUE"),
        (DATA, "AX_OFFSET_1[0]=0", "AX_OFFSET_1[0]=45", "ROT_AX_OFFSET is not followed"),
        (DATA, "JOINT_OFFSET_PART_1[1]", "JOINT_OFFSET_1[1]", "JOINT_OFFSET is not followed"),
    ],
)
def test_siemens_data_that_is_refused(tmp_path, text, old, new, message):
    assert old in text
    with pytest.raises(UsageError) as caught:
        siemens(tmp_path, text.replace(old, new))
    assert {found.code for found in caught.value.diagnostics} == {"GX454"}
    assert message in "; ".join(found.message for found in caught.value.diagnostics)


def test_letters_of_siemens_axes(tmp_path):
    for axes in ("A,A", "A,X"):
        with pytest.raises(UsageError, match="not two of the axes A, B and C"):
            siemens(tmp_path, SWIVEL, axes)


def test_import_of_a_sinumerik_on_the_command_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.mpf").write_text(SWIVEL)
    done = call("machine", "import", "siemens", "--axes", "a, c", "s.mpf")
    assert 'table = ["A", "C"]' in done.stdout
    assert "GX707" in call("machine", "import", "siemens", "--axes", "A", "s.mpf").stderr
