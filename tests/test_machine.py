"""Machine files: what they say, and what is refused at which place."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from gcxform.catalogue import CATALOGUE
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.machine.machine import ANGLE, LENGTH, Axis, Tool, load_machine, schema

TRUNNION = """format = 1
name = "trunnion mill"
table = ["A", "C"]
head = []
gauge-point = [0.0, 0.0, "1 in"]
errors = "tables/errors.toml"
[axis.X]
limits = [-300.0, "300 mm"]
max-speed = 30000.0
[axis.Y]
[axis.Z]
[axis.A]
direction = [2.0, 0.0, 0.0]
point = [5.0, -32.0, -95.0]
sign = -1
limits = [-30.0, "110 deg"]
[axis.C]
direction = [0.0, 0.0, 1.0]
point = [5.0, -20.0, -60.0]
sign = -1
wrap = 360.0
[work-offset.G54]
X = 5.0
Y = "-20 mm"
Z = -60.0
A = "0.1 rad"
[work-offset."G59.1"]
X = 1
[tool.1]
length = "120 mm"
radius = 5.0
[tool.12]
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path


def refused(folder: Path, text: str) -> list[tuple[str, int, int, str, str]]:
    """Return code, line, column, message and hint of all that is wrong with a machine file."""
    path = folder / "machine.toml"
    path.write_text(text)
    with pytest.raises(UsageError) as caught:
        load_machine(path)
    return [_plain(d, path) for d in caught.value.diagnostics]


def _plain(found: Diagnostic, path: Path) -> tuple[str, int, int, str, str]:
    assert found.code in CATALOGUE
    assert found.where is not None
    assert found.where.file == str(path)
    return found.code, found.where.line, found.where.column, found.message, found.hint


def test_the_machine_of_the_design(folder: Path) -> None:
    path = folder / "mill.toml"
    path.write_text(TRUNNION)
    machine = load_machine(path)
    assert machine.file == path
    assert machine.name == "trunnion mill"
    assert (machine.table, machine.head) == (("A", "C"), ())
    assert machine.gauge_point == (0.0, 0.0, 25.4)
    assert machine.errors == folder / "tables" / "errors.toml"
    assert list(machine.axes) == ["X", "Y", "Z", "A", "C"]
    assert machine.axes["X"] == Axis(limits=(-300.0, 300.0), max_speed=30000.0)
    assert machine.axes["A"] == Axis(
        direction=(1.0, 0.0, 0.0), point=(5.0, -32.0, -95.0), sign=-1, limits=(-30.0, 110.0)
    )
    assert machine.axes["C"].wrap == 360.0
    assert machine.work_offsets == {
        "G54": {"X": 5.0, "Y": -20.0, "Z": -60.0, "A": pytest.approx(math.degrees(0.1))},
        "G59.1": {"X": 1.0},
    }
    assert machine.tools == {1: Tool(length=120.0, radius=5.0), 12: Tool()}


def test_a_machine_needs_only_its_format(folder: Path) -> None:
    path = folder / "small.toml"
    path.write_text("format = 1\n[work-offset.G54]\nX = 1.0\n")
    machine = load_machine(path)
    assert (machine.name, machine.errors, machine.axes) == ("small", None, {})
    assert machine.work_offsets == {"G54": {"X": 1.0}}


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "column", "message", "hint"),
    [
        ("format = 1\n", "", "GX404", 0, 1, "'format' is missing", ""),
        ("format = 1", "format = 2", "GX406", 1, 1, "format 2 of machines is not known", ""),
        ("format = 1", "format = true", "GX406", 1, 1, "format True", ""),
        ("head = []", "head = [", "GX402", 5, 1, "not TOML", ""),
        ("errors =", "error =", "GX403", 6, 1, "unknown key 'error'", "did you mean 'errors'?"),
        ("max-speed", "max-sped", "GX403", 9, 1, "'max-sped' in axis.X", "did you mean 'max-s"),
        (
            "[axis.Y]",
            "[axis.Y]\n[axis.Q]",
            "GX403",
            11,
            1,
            "unknown key 'Q' in axis",
            "known: X, Y, Z",
        ),
        ("[axis.Y]", "[axis.Y]\n[axis.XY]", "GX403", 11, 1, "unknown key 'XY' in axis", "did you"),
        ("\nX = 1\n", "\nB = 1\n", "GX403", 28, 1, "'B' in work-offset.G59.1", "known: X"),
        ('"300 mm"', '"300 deg"', "GX405", 8, 19, "limits: 'deg' is not a unit of a len", ""),
        ('"110 deg"', '"110 mm"', "GX405", 16, 18, "limits: 'mm' is not a unit of an angle", ""),
        ('"1 in"', '"1"', "GX405", 5, 26, "gauge-point: '1' has no unit: write \"1 mm\"", ""),
        ('"120 mm"', '"long"', "GX405", 30, 1, "length: 'long' is not a length", ""),
        ("30000.0", '"fast"', "GX405", 9, 1, "max-speed: expected a number", ""),
        ("30000.0", "inf", "GX405", 9, 1, "max-speed: inf is not a finite number", ""),
        ("[-300.0,", "[nan,", "GX405", 8, 11, "limits: nan is not a finite number", ""),
        ("[-300.0,", "[", "GX405", 8, 1, "limits: expected a list of length 2", ""),
        ("[-300.0,", "[301.0,", "GX431", 8, 1, "X do not ascend: 301, 300", "lower limit"),
        ("[-300.0,", "[300.0,", "GX431", 8, 1, "X do not ascend: 300, 300", "lower limit"),
        ("[2.0, 0.0, 0.0]", "[0, 0, 0.0]", "GX432", 13, 1, "direction of axis A is zero", "vec"),
        (
            "direction = [2.0, 0.0, 0.0]\n",
            "",
            "GX432",
            12,
            1,
            "direction of axis A is missing",
            "vector",
        ),
        ("sign = -1\nlim", "lim", "GX433", 12, 1, "A is missing, it has to be -1 or +1", "841"),
        ("sign = -1\nlim", "sign = 2\nlim", "GX433", 15, 1, "sign of axis A is 2", "ISO 841"),
        ("30000.0", "0.0", "GX434", 9, 1, "max-speed of axis X is 0, it has to be above 0", ""),
        ("wrap = 360.0", "wrap = -1", "GX434", 21, 1, "wrap of axis C is -1", ""),
        ("radius = 5.0", "radius = -5.0", "GX434", 31, 1, "radius of tool 1 is -5", ""),
        ('["A", "C"]', '["A", "B"]', "GX435", 3, 15, "names 'B', which is not a", "add [axis.B]"),
        ('["A", "C"]', '["A", "X"]', "GX435", 3, 15, "names 'X'", "known: A, C"),
        ("head = []", 'head = ["C"]', "GX435", 4, 9, "the axis C stands twice", ""),
        ("offset.G54]", "offset.G53]", "GX436", 22, 1, "'G53' is not a work offset", "G54 to G59"),
        ('"G59.1"', "G59.1", "GX403", 27, 1, "key '1' in work-offset.G59", "known: X"),
        ("[tool.12]", "[tool]\n2 = 5", "GX405", 33, 1, "expected a table", ""),
        ("[tool.12]", "[tool.T12]", "GX437", 32, 1, "'T12' is not a tool number", ""),
        ("[tool.12]", "[tool.01]", "GX437", 32, 1, "the tool 1 stands twice", ""),
    ],
)
def test_what_is_refused(
    folder: Path, old: str, new: str, code: str, line: int, column: int, message: str, hint: str
) -> None:
    assert old in TRUNNION
    (found,) = refused(folder, TRUNNION.replace(old, new))
    assert found[:3] == (code, line, column)
    assert message in found[3]
    assert hint in found[4]


@pytest.mark.parametrize("section", ["axis", "work-offset", "tool"])
def test_a_section_that_is_no_table(folder: Path, section: str) -> None:
    (found,) = refused(folder, f"format = 1\n{section} = 5\n")
    assert found[:3] == ("GX405", 2, 1)
    assert f"{section}: expected tables, such as [{section}." in found[3]


def test_all_that_is_wrong_is_told_at_once(folder: Path) -> None:
    text = TRUNNION.replace("[-300.0,", "[301.0,").replace("sign = -1", "sign = 0")
    assert [found[0] for found in refused(folder, text)] == ["GX431", "GX433", "GX433"]


def test_a_file_that_is_not_there(folder: Path) -> None:
    with pytest.raises(UsageError) as caught:
        load_machine(folder / "no.toml")
    assert caught.value.diagnostics[0].code == "GX401"


def test_units_are_exact() -> None:
    assert [LENGTH.parse(f"{k} um") for k in range(1000)] == [float(f"{k}e-3") for k in range(1000)]
    assert LENGTH.parse("1 in") == 25.4
    assert ANGLE.parse("1 rad") == math.degrees(1.0)


def test_the_schema_lets_strings_with_units_in() -> None:
    parts = schema()["$defs"]
    assert parts["Tool"]["properties"]["length"]["type"] == ["number", "string"]
    low, _high = parts["Axis"]["properties"]["limits"]["anyOf"][0]["prefixItems"]
    assert low["type"] == ["number", "string"]
    assert parts["Axis"]["properties"]["max-speed"]["anyOf"][0] == {"type": "number"}
    assert parts["MachineFile"]["additionalProperties"] is False
