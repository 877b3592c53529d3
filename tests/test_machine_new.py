"""`gcxform machine new`: what the programs of a shop need, in files that are filled in."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_kit import call, workplace

from gcxform.cli.program.machine_needs import used_by
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

PECKS = "%\nO0001\nG90 G21 G94 G54 G0 X10 Y10.\nG43 H3 Z50.\nG73 Z-9. R2. Q2. F99.\nG80\nM30\n%\n"
OFFSETS = """%
O0002
G21 G90 G94 G54 G0 X10. Y10.
G43 H3 Z50.
G41 D3 G1 X0 Y0 F100.
Y20.
G40 X30. Y30.
G55 G0 X10. Y10. Z5.
G91 G28 Z0
M30
%
"""
START = "%\nO0003\nG21 G94 G91 G0 X1. Y2.\nG90 G2 X9. Y9. R99. F9.\nM21\nM30\n%\n"
NEW = ("machine", "new", "-f", "fanuc", "shop", "-o", "m.toml", "-p", "p.toml")


@pytest.fixture
def shop(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    here = workplace(tmp_path, monkeypatch) / "shop"
    here.mkdir()
    for name, text in (("pecks.nc", PECKS), ("offsets.nc", OFFSETS), ("start.nc", START)):
        (here / name).write_text(text)
    (here / "drawing.pdf").write_bytes(b"%PDF-1.4")
    return here


def fill_in(file: Path, **answers: str) -> None:
    """Put values in the place of "?", by key; 1.0 for others."""
    lines = []
    for line in file.read_text().splitlines():
        key = line.partition(" ")[0]
        lines.append(line.replace('"?"', answers.get(key.replace("-", "_"), "1.0")))
    file.write_text("\n".join(lines) + "\n")


def filled(shop: Path) -> None:
    fill_in(shop.parent / "m.toml", inert_m="[21]")
    fill_in(shop.parent / "p.toml", increment='"IS-B"')


def test_a_machine_file_says_what_is_needed_and_by_how_many(shop: Path) -> None:
    assert call(*NEW).exit_code == 0
    text = (shop.parent / "m.toml").read_text()
    for line in (
        '# fanuc: parameter 5114\n# needed by 1 of 3 programs, e.g. pecks.nc:5\npeck-return = "?"',
        '# used: M21 by 1 of 3 programs, e.g. start.nc:5\ninert-m = "?"',
        "[tool.3]\n# from the gauge point of the spindle to the tip, mm: what H calls\n"
        '# used by 2 of 3 programs, e.g. offsets.nc:4\nlength = "?"',
        'radius = "?"',
        "[work-offset.G55]",
        "[home.G28]\n# the reference point in the machine, mm or degrees\n"
        '# used by 1 of 3 programs, e.g. offsets.nc:9\nZ = "?"\n',
    ):
        assert line in text
    assert "peck-clearance" not in text
    text = (shop.parent / "p.toml").read_text()
    assert '# needed by 1 of 3 programs, e.g. pecks.nc:3\nincrement = "?"' in text
    assert 'start = { X = "?", Y = "?" }' in text
    assert 'file = "m.toml"' in text


def test_filled_in_all_programs_go_through(shop: Path) -> None:
    call(*NEW)
    for program in ("pecks.nc", "start.nc"):
        found = call("run", "-p", "p.toml", f"shop/{program}")
        assert (found.exit_code, 'still "?"' in found.stderr) == (3, True)
    assert call("run", "-q", "-p", "p.toml", "shop/offsets.nc").exit_code == 0  # needs none of it
    filled(shop)
    for program in ("pecks.nc", "start.nc", "offsets.nc"):
        found = call("check", "-p", "p.toml", f"shop/{program}")
        assert (found.exit_code, found.stderr) == (0, "")
        found = call("run", "-p", "p.toml", f"shop/{program}")
        assert (found.exit_code, "PASS" in found.stderr) == (0, True)


def test_again_it_adds_what_is_new_and_keeps_the_rest(shop: Path) -> None:
    call(*NEW)
    filled(shop)
    files = [shop.parent / name for name in ("m.toml", "p.toml")]
    for file in files:
        file.write_text(file.read_text().replace("[tool.3]\n", "[tool.3] # a drill\n# mine\n"))
    before = [file.read_text() for file in files]
    assert call(*NEW).exit_code == 0
    assert [file.read_text() for file in files] == before
    (shop / "more.nc").write_text(
        "%\nO0004\nG91 G21 G94 G54 G0 X1. Z2.\n/X2.\nG81 Z-3. R-1. F9.\nG80\n"
        "G90 G43 H3 Z5.\nG43 H12 Z5.\nM30\n%\n"
    )
    call(*NEW)
    machine, pipeline = (file.read_text() for file in files)
    assert machine.startswith(before[0].rstrip("\n"))
    assert machine.endswith('# used by 1 of 4 programs, e.g. more.nc:8\nlength = "?"\n')
    assert 'start = { X = 1.0, Y = 1.0, Z = "?" }' in pipeline
    assert 'block-delete = "?"\n\n[machine]' in pipeline
    (shop / "evenmore.nc").write_text("%\nO0004\n/X2.\nM30\n%\n")
    call(*NEW)
    assert "# needed by 2 of 5 programs, e.g. evenmore.nc:3\nblock" in files[1].read_text()


def test_subprograms_by_themselves_are_no_programs(shop: Path) -> None:
    (shop / "O9001").write_text("%\nO9001\nG43 H44\nM99\n%\n")
    found = call(*NEW)
    assert "3 programs in fanuc, 1 subprograms" in found.stderr
    assert "tool.44" not in (shop.parent / "m.toml").read_text()
    (shop / "main.nc").write_text("%\nO0005\nG21 G94 G90 G54 G0 X0 Y0 Z0\nM98 P9001\nM30\n%\n")
    call(*NEW)
    assert "[tool.44]" in (shop.parent / "m.toml").read_text()


def test_the_dialect_is_guessed_from_all_programs(shop: Path) -> None:
    for name in ("pecks.nc", "start.nc", "offsets.nc"):
        (shop / name).unlink()
    (shop / "a.ngc").write_text("G90 G0 X1 Y1\no100 sub\nG1 X2 F9\no100 endsub\no100 call\nM2\n")
    found = call("machine", "new", "shop")
    assert found.exit_code == 0
    assert "1 program in linuxcnc" in found.stderr
    assert "not read, for no dialect fits" not in found.stderr
    (shop / "a.ngc").write_text("G0 X1. Y1.\n")
    found = call("machine", "new", "shop")
    assert (found.exit_code, "GX722" in found.stderr) == (2, True)


def test_no_program_is_overwritten(shop: Path) -> None:
    found = call("machine", "new", "-f", "fanuc", "shop", "-o", "shop/pecks.nc")
    assert (found.exit_code, "GX727" in found.stderr) == (2, True)
    assert (shop / "pecks.nc").read_text() == PECKS


def test_line_ends_stay(shop: Path) -> None:
    (shop.parent / "m.toml").write_bytes(b"\xef\xbb\xbfformat = 1\r\n[tool.3]\r\nlength = 9.0\r\n")
    call(*NEW)
    text = (shop.parent / "m.toml").read_bytes()
    assert text.startswith(b"\xef\xbb\xbfformat = 1\r\n[tool.3]\r\nlength = 9.0\r\n# mm: what D")
    assert text.count(b"\n") == text.count(b"\r\n")


def test_a_table_that_cannot_be_added_to_is_refused(shop: Path) -> None:
    (shop.parent / "m.toml").write_text('format = 1\ncontrol.g52 = "fanuc"\n')
    found = call(*NEW)
    assert (found.exit_code, "GX435" in found.stderr) == (2, True)
    assert (shop.parent / "m.toml").read_text() == 'format = 1\ncontrol.g52 = "fanuc"\n'


CALLS = """%
O1
G21 G90 G94 G17 G54 G0 X0. Y0. Z5.
G100 T1
G65 P9832
X60.
M30
%
"""


def test_calls_and_codes_that_cannot_be_looked_up_are_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is asked may be pasted, left open, and filled in."""
    here = workplace(tmp_path, monkeypatch)
    (here / "calls.nc").write_text(CALLS)
    new = ("machine", "new", "-f", "fanuc", "calls.nc", "-o", "m.toml")
    assert call(*new).exit_code == 0
    text = (here / "m.toml").read_text()
    asked = '# where axes are behind it: "unchanged", "unknown" or "at XYZ"\n'
    assert f"[control.macro.G100]\n{asked}" in text
    assert f"[control.macro.P9832]\n{asked}" in text
    check = ("check", "-f", "fanuc", "-x", "absolute", "-m", "m.toml", "calls.nc")
    assert call(*check).exit_code != 0
    fill_in(here / "m.toml", ends='"unknown"')
    assert call(*check).exit_code == 0


ALONE = """%
O1
G21 G94 G17 G54 G90 G0 X0. Y0. Z50.
G43 H1
G91 Z-1.
G1 X9. F100.
M30
%
"""
KEPT = ALONE.replace("G43 H1\nG91 Z-1.\nG1 X9.", "G65 P9832\nG90 G21 G94 G1 X9. Y0. Z5.")
MODEL = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"


@pytest.mark.parametrize(
    ("program", "asked"),
    [
        (ALONE, 'tool-length-alone = "?"'),
        (KEPT, '[control.macro.P9832]\n# where axes are behind it: "unchanged"'),
    ],
)
def test_a_compensation_asks_where_things_are_before_any_file_says_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: str, asked: str
) -> None:
    here = workplace(tmp_path, monkeypatch)
    (here / "part.nc").write_text(program)
    chain = f"volumetric model={MODEL} outside=clamp"
    new = call("machine", "new", "-f", "fanuc", "-x", chain, "part.nc", "-o", "m.toml")
    assert new.exit_code == 0, new.stderr
    text = (here / "m.toml").read_text()
    assert asked in text
    assert "[work-offset.G54]" in text
    fill_in(here / "m.toml", tool_length_alone='"shifts"', ends='"unchanged"')
    done = call("run", "-q", "-f", "fanuc", "-m", "m.toml", "-x", chain, "part.nc")
    assert done.exit_code == 0, done.stderr


def test_the_radius_of_the_tool_in_the_spindle_is_asked_for() -> None:
    """G41 without D takes it in LinuxCNC, and no other; a Fanuc has a D in force, or none."""
    program = b"G21\nT3\nT7 M6\nT4\nG41 X10.\nG40 X20.\nT9 M6\nG42 D2 X3.\n"
    for dialect, tools in (("linuxcnc", {"7", "2"}), ("fanuc", {"2"})):
        kind = default_registry().dialect(dialect)
        assert {*used_by(Source.of_bytes(program), kind, Reading()).radii} == tools
