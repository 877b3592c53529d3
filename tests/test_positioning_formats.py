"""Positioning tests: ISO 230-2 as CSV, and Renishaw's .rtl.

The sign, in words: sent to 100 the axis stands at 100.005 when it comes from below, on average of
two runs, and at 99.997 when it comes from above. The deviations are +5 um and -3 um, and so are the
errors, forward and reverse.
"""

from __future__ import annotations

import re

import pytest
from format_kit import at, cannot, pitch, refusal
from gcxform_plugins.formats.iso230_csv import Iso230Csv
from gcxform_plugins.formats.renishaw_rtl import RenishawRtl

LONG = """\
axis,target_mm,run,direction,deviation_um,temp_C
# laser, 20 degC
X,0,1,+,0,20.1
X,100,1,+,4.0,20.1
X,200,1,+,1.0,20.1
X,200,1,-,0,20.1
X,100,1,-,-3.5,20.2
X,0,1,-,0.5,20.2
X,0,2,+,0,20.2
X,100,2,+,6.0,20.2
X,200,2,+,1.0,20.3
X,200,2,-,0,20.3
X,100,2,-,-2.5,20.3
X,0,2,-,0.5,20.3
"""
WIDE = """\
axis;target_mm;1+;1-;2+;2-
X;0;0;0.5;0;0.5
X;100;4.0;-3.5;6.0;-2.5
X;200;1.0;0;1.0;0
"""
RTL = """\
HEADER::
File type  : rtl
Owner      : Linear
Version no : V20.02.02

TARGET DATA::
Filetype  : ISO
Target-count: 3
Targets :
         0.0000       100.0000
       200.0000
Flags: 0 0 2 0

USER-TEXT::
Machine: VMC 4711
Serial No: 1
Date:2024-03-01 10:00:00
By:
Axis:X
Location:
TITLE:

RUNS::
Run-count: 4

DEVIATIONS::
Run Target Data:
1   1      0
1   2      4.0
1   3      1.0
2   3      0
2   2      -3.5
2   1      0.5
3   1      0
3   2      6.0
3   3      1.0
4   3      0
4   2      -2.5
4   1      0.5

ENVIRONMENT::
Air temp : 20.1

EOF::
"""
UM = RenishawRtl("um")
TESTS = {
    "long": (Iso230Csv(), "test.csv", LONG),
    "wide": (Iso230Csv(), "test.csv", WIDE),
    "rtl": (UM, "test.rtl", RTL),
}


@pytest.mark.parametrize("name", TESTS)
def test_the_sign(tmp_path, name):
    form, file, text = TESTS[name]
    path = tmp_path / file
    path.write_text(text)
    assert form.recognises(path)
    model = form.read(path)
    assert at(model, 100.0, sense=1) == pytest.approx([0.005, 0, 0])
    assert at(model, 100.0, sense=-1) == pytest.approx([-0.003, 0, 0])
    assert at(model, 0.0, sense=-1) == pytest.approx([0.0005, 0, 0])
    assert model.nodes[0].tolist() == [0.0, 100.0, 200.0]


def test_targets_from_the_far_end(tmp_path):
    """The first run then goes in the negative direction."""
    path = tmp_path / "test.rtl"
    turned = RTL.replace("0.0000       100.0000", "200.0000 100.0000").replace(
        "       200.0000\n", "0\n"
    )
    path.write_text(turned)
    model = UM.read(path)
    assert at(model, 100.0, sense=-1) == pytest.approx([0.005, 0, 0])
    assert at(model, 200.0, sense=1) == pytest.approx([0.0005, 0, 0])


def test_one_direction_is_both(tmp_path):
    path = tmp_path / "test.csv"
    path.write_text("".join(line for line in LONG.splitlines(True) if ",-," not in line))
    model = Iso230Csv().read(path)
    assert not model.backlash.any()
    assert at(model, 100.0, sense=-1) == pytest.approx([0.005, 0, 0])
    path.write_text(RTL.replace("Flags: 0 0 2 0", "Flags: 0 1 2 0"))
    model = UM.read(path)
    assert at(model, 100.0) == pytest.approx([0.001, 0, 0])
    assert not model.backlash.any()


def test_two_axes(tmp_path):
    path = tmp_path / "test.csv"
    path.write_text(WIDE + WIDE.partition("\n")[2].replace("X;", "Z;"))
    model = Iso230Csv().read(path)
    assert at(model, 100.0, 0.0, 100.0, sense=1) == pytest.approx([0.005, 0, 0.005])


def test_the_axis_is_said_or_in_the_file(tmp_path):
    path = tmp_path / "test.rtl"
    path.write_text(RTL.replace("Axis:X", "Axis:"))
    assert at(RenishawRtl("um", "Y").read(path), 0.0, 100.0, sense=1)[1] == pytest.approx(0.005)
    path.write_text(RTL.replace("Axis:X", "Axis: y axis"))
    assert at(UM.read(path), 0.0, 100.0, sense=1)[1] == pytest.approx(0.005)


def scaled(factor):
    """Return the .rtl file with all deviations times a factor."""
    row = re.compile(r"^([1-4]   [1-3]) +(\S+)$", re.M)
    return row.sub(lambda m: f"{m[1]} {float(m[2]) * factor:.9f}", RTL)


def test_millimetres(tmp_path):
    path = tmp_path / "test.rtl"
    path.write_text(scaled(1e-3))
    assert at(RenishawRtl("mm").read(path), 100.0, sense=1)[0] == pytest.approx(0.005)


def test_they_are_only_read():
    for form in (Iso230Csv(), UM):
        assert "only read" in cannot(form, pitch(1))


ISO = Iso230Csv()
DEFECTS = {
    "empty": (ISO, "", "GX411", 0, 1),
    "header alone": (ISO, WIDE[:27], "GX411", 1, 1),
    "other header": (ISO, LONG.replace("run", "cycle"), "GX417", 1, 16),
    "a run twice": (ISO, WIDE.replace("2-", "1-"), "GX417", 1, 25),
    "no run": (ISO, "axis,target_mm\nX,0\n", "GX417", 1, 15),
    "short": (ISO, WIDE.replace("X;200;1.0;0;1.0;0", "X;200;1.0;0;1.0"), "GX418", 4, 16),
    "axis": (ISO, WIDE.replace("X;200", "A;200"), "GX482", 4, 1),
    "direction": (ISO, LONG.replace("1,+,4.0", "1,up,4.0"), "GX419", 4, 9),
    "word": (ISO, LONG.replace("4.0", "four"), "GX419", 4, 11),
    "nan": (ISO, LONG.replace("4.0", "nan"), "GX412", 4, 11),
    "target of nan": (ISO, WIDE.replace("X;0;", "X;nan;"), "GX412", 2, 3),
    "double": (ISO, LONG + "X,0,2,-,0.5,20.3\n", "GX483", 15, 1),
    "one way back": (
        ISO,
        "".join(LONG.splitlines(True)[:-1]).replace("X,0,1,-", "X,100,9,-"),
        "GX483",
        13,
        1,
    ),
    "a reading lost": (ISO, LONG.replace("X,100,2,-,-2.5,20.3\n", ""), "GX483", 13, 1),
    "cut off": (UM, RTL[: RTL.index("4   2 ")], "GX483", 37, 1),
    "a run cut off": (UM, RTL[: RTL.index("4   3 ")], "GX483", 24, 1),
    "one target": (ISO, "axis,target_mm,1+\nX,0,1\n", "GX411", 2, 1),
    "in metres": (ISO, WIDE.replace("4.0", "4000"), "GX485", 4, 1),
    "no targets": (UM, RTL.replace("TARGET DATA::", "TARGETS::"), "GX417", 0, 1),
    "no flags": (UM, RTL.replace("Flags: 0 0 2 0\n", ""), "GX417", 6, 1),
    "other flags": (UM, RTL.replace("Flags: 0 0", "Flags: 3 0"), "GX482", 12, 1),
    "count": (UM, RTL.replace("count: 3", "count: 4"), "GX483", 6, 1),
    "target of words": (UM, RTL.replace("100.0000", "100,0000"), "GX419", 10, 23),
    "target 4": (UM, RTL.replace("4   3      0", "4   4      0"), "GX483", 37, 5),
    "run 0": (UM, RTL.replace("1   1      0\n", "0   1      0\n", 1), "GX419", 28, 1),
    "two columns": (UM, RTL.replace("1   2      4.0", "1   2"), "GX418", 29, 6),
    "no deviations": (UM, RTL[: RTL.index("1   1 ")], "GX411", 26, 1),
    "no axis": (UM, RTL.replace("Axis:X", "Axis:longitudinal"), "GX480", 0, 1),
    "another axis": (RenishawRtl("um", "Y"), RTL, "GX482", 19, 1),
    "millimetres said": (RenishawRtl("mm"), RTL, "GX485", 39, 1),
    "in metres said": (UM, scaled(1e-6), "GX485", 39, 1),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_defects(tmp_path, name):
    form, text, code, line, column = DEFECTS[name]
    found = refusal(form, tmp_path / "test.rtl", text)
    assert found.code == code, found.render()
    assert found.where is not None
    assert (found.where.line, found.where.column) == (line, column), found.render()
