"""Machine files: what they say, and what is refused at which place."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from gcxform.catalogue import CATALOGUE
from gcxform.config.quantities import ANGLE, LENGTH
from gcxform.diagnostics import Diagnostic, FileError, UsageError
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Axis, Machine, Tool
from gcxform.machine.schema import schema
from gcxform.plugin.registry import default_registry

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
        ("offset.G54]", "offset.G505]\n[work-offset.G58]", "GX436", 22, 1, "are one work", ""),
        ("[work-offset.G54]", "[home.G82]", "GX436", 22, 1, "'G82' is not a home", "G28, G30"),
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


def test_a_machine_has_linear_axes_of_which_its_file_says_nothing(folder: Path) -> None:
    """So what `gcxform machine new` writes and `kinematics` can stand in one file."""
    path = folder / "machine.toml"
    axes = "[axis.A]\npoint = [0, 0, 0]\n[axis.C]\npoint = [0, 0, 0]\n"
    offsets = "[work-offset.G54]\nX = 1.0\nC = 2.0\n[home.G28]\nZ = 0.0\n"
    path.write_text(f'format = 1\nkinematics = "ac-trunnion"\n{axes}{offsets}')
    machine = load_machine(path, default_registry().machines)
    assert machine.work_offsets == {"G54": {"X": 1.0, "C": 2.0}}
    assert machine.homes == {"G28": {"Z": 0.0}}


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
    limits = parts["Axis"]["properties"]["limits"]
    assert limits["items"]["type"] == ["number", "string"]
    assert limits["minItems"] == limits["maxItems"] == 2
    assert parts["Axis"]["properties"]["max-speed"]["type"] == "number"
    assert parts["MachineFile"]["additionalProperties"] is False


# --- a tool table of LinuxCNC ---

TABLE = "T1 P1 D50.0 ;face mill\n\n; nothing\nt2 p2 X1.5 Y-2 Z+100.25 I0 J0 Q0\nT7 P3 A0 Z.5\n"


def machine_with(folder: Path, table: str, unit: str = '"mm"', more: str = "") -> Path:
    (folder / "tool.tbl").write_text(table, encoding="latin-1")
    file = folder / "machine.toml"
    head = f'format = 1\ntool-table = "tool.tbl"\ntool-table-units = {unit}\n'
    file.write_text(head + more, encoding="utf-8")
    return file


def loaded(file: Path) -> Machine:
    return load_machine(file, default_registry().machines)


def test_a_tool_table_gives_the_tools(tmp_path: Path) -> None:
    machine = loaded(machine_with(tmp_path, TABLE, more="[tool.3]\nlength = 5.0\n"))
    assert machine.tools == {
        1: Tool(length=0.0, radius=25.0),
        2: Tool(length=100.25, radius=0.0, x=1.5, y=-2.0),
        3: Tool(length=5.0),
        7: Tool(length=0.5, radius=0.0),
    }


def test_a_tool_table_in_inches(tmp_path: Path) -> None:
    tool = loaded(machine_with(tmp_path, "T4 Z1 D.5 X-2 Y3\n", '"in"')).tools[4]
    assert tool.vector == pytest.approx((-50.8, 76.2, 25.4))
    assert tool.radius == pytest.approx(6.35)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("P1 Z5", "no T word"),
        ("T1 Z5 Z6", "Z stands here twice"),
        ("T1.5 Z5", "T is not a whole number"),
        ("T-1 Z5", "T is not a whole number"),
        ("T1 Z", "'Z' is not a letter with a number"),
        ("T1 Z5mm", "'Z5mm' is not"),
        ("T1 D-5", "negative diameter"),
        ("T1 W5", "offset of W"),
        ("T1 R5", "no word R"),
        ("T9 Z5", "the tool 9 stands twice"),
    ],
)
def test_a_bad_line_of_a_tool_table(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(UsageError, match=said) as caught:
        loaded(machine_with(tmp_path, f"T9 Z1\n{line} ; a comment\n"))
    (found,) = caught.value.diagnostics
    assert found.code == "GX438"
    assert found.where is not None
    assert (found.where.line, Path(found.where.file).name) == (2, "tool.tbl")


def test_the_unit_of_a_tool_table_has_to_be_said(tmp_path: Path) -> None:
    file = machine_with(tmp_path, TABLE)
    file.write_text('format = 1\ntool-table = "tool.tbl"\n', encoding="utf-8")
    with pytest.raises(UsageError, match="unit of the tool table is missing"):
        loaded(file)
    with pytest.raises(UsageError, match="tool-table-units"):
        loaded(machine_with(tmp_path, TABLE, '"cm"'))


@pytest.mark.parametrize("name", ["linuxcn", "fanuc"])
def test_whose_tool_table_it_is(tmp_path: Path, name: str) -> None:
    """A control that is known, and has tool tables that are read."""
    file = machine_with(tmp_path, TABLE, more=f'tool-table-control = "{name}"\n')
    with pytest.raises(UsageError, match=f"no control '{name}' whose tool tables") as caught:
        loaded(file)
    (found,) = caught.value.diagnostics
    assert (found.code, found.where.line, found.where.column) == ("GX405", 4, 1)
    assert "linuxcnc" in found.hint
    file.write_text(file.read_text().replace(name, "linuxcnc"))
    assert sorted(loaded(file).tools) == [1, 2, 7]


def test_a_tool_stands_in_one_of_the_two(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"the tool 2 stands in tool\.tbl as well"):
        loaded(machine_with(tmp_path, TABLE, more="[tool.2]\nlength = 5.0\n"))


def test_a_tool_table_that_is_not_there(tmp_path: Path) -> None:
    file = machine_with(tmp_path, TABLE)
    (tmp_path / "tool.tbl").unlink()
    with pytest.raises(FileError, match="cannot read"):
        loaded(file)


@pytest.mark.parametrize(
    ("said", "message"),
    [("2", "a list of whole"), ("[-2]", "a whole"), ("[2, 2]", "each number once")],
)
def test_a_list_of_numbers(tmp_path, said, message):
    """Such as the presets of a TNC: each of them is one place of its list."""
    file = tmp_path / "m.toml"
    file.write_text("format = 1\n[control]\npresets = [20, 22]\n")
    assert default_registry().dialects["heidenhain"].settings  # which declare it
    assert load_machine(file).control == {"presets 20": 0, "presets 22": 1}
    file.write_text(f"format = 1\n[control]\npresets = {said}\n")
    with pytest.raises(UsageError, match=rf"GX405.*presets: expected {message}"):
        load_machine(file)
