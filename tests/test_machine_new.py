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
    comp = {"cutter_comp_corners": '"arc"', "cutter_comp_entry": '"own"'}
    fill_in(shop.parent / "m.toml", inert_m="[21]", **comp)
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


def test_a_language_of_its_own_is_asked_for_the_lengths_that_it_calls(shop: Path) -> None:
    """To the same control D1 stays as it stands, and says nothing of its length."""
    (shop / "a.mpf").write_text("G710 G17 G90 G94 G54\nT5 M6\nD1\nG0 X0 Y0 Z5\nM30\n")
    found = call("machine", "new", "-f", "siemens", "shop/a.mpf")
    assert "[tool.5]" in found.stdout


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
    assert "not read" not in found.stderr
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


def test_the_length_of_a_tip_that_is_followed_is_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = workplace(tmp_path, monkeypatch)
    program = "G21 G90 G94 G17 G54\nG0 X0. Y0. Z50. A0.\nG43.4 H2 Z9.\nG49\nM30\n"
    assert "[tool.2]" in asked_of(here, "fanuc", program)


def asked_of(here: Path, dialect: str, program: str, chain: str | None = None) -> str:
    """Return what a machine file for one program asks, and what is said beside it."""
    (here / "part.nc").write_text(program)
    words = [] if chain is None else ["-x", chain]
    done = call("machine", "new", "-f", dialect, *words, "part.nc")
    assert done.exit_code == 0, done.stderr
    return done.stdout + done.stderr


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


VOLUMETRIC = f"volumetric model={MODEL} outside=clamp"


def test_a_tool_by_its_name_is_no_number_of_a_machine_file(here: Path) -> None:
    """What the control calls by its name has no number; and whole numbers have no exponent."""
    program = 'G710 G17 G90 G94\nT="MILL" M6\nG54\nS100 M3\nG0 X0 Y0\nD1 Z50\nM30\n'
    assert "[tool." not in asked_of(here, "siemens", program, VOLUMETRIC)
    assert "[tool.1234567]" in asked_of(here, "fanuc", "G21 G90 G54\nG43 H1234567 Z9.\nM30\n")


HEAD = "%\nO1\nG21 G90 G94 G17 G54\n"


def test_an_extruder_has_no_place_in_a_machine(here: Path) -> None:
    asked = asked_of(here, "marlin", "G21\nG90\nM82\nG28\nG29\nG1 X9 Y9 E1 F99\nG28 X\n")
    assert "[home.G28]\n" in asked
    assert "E =" not in asked
    assert "G29" not in asked
    (here / "m.toml").write_text(asked[: asked.index("1 program in")].replace('"?"', "0.0"))
    done = call("check", "-f", "marlin", "-x", "absolute", "-m", "m.toml", "part.nc")
    assert done.exit_code == 0, done.stderr


def test_letters_of_words_are_no_axes(here: Path) -> None:
    loop = "#1=0\nWHILE [#1 LT 3] DO1\nG0 X#1\n#1=#1+1\nEND1\nG91 G28 Z0\nM30\n%\n"
    assert "W =" not in asked_of(here, "fanuc", HEAD + loop)
    subs = "G21 G90\no1 sub\nG0 X#1\no1 endsub\no1 call [3]\nG28\nM2\n"
    assert "U =" not in asked_of(here, "linuxcnc", subs)
    assert "W =" not in asked_of(here, "linuxcnc", "G21 G90\n#<w>=5\nG0 X#<w>\nM2\n")
    assert 'W = "?"' in asked_of(here, "fanuc", HEAD + loop.replace("X#1", "W#1"))


@pytest.mark.parametrize("dialect", ["masso", "uccnc"])
def test_where_a_cycle_that_stays_ends_is_no_question(here: Path, dialect: str) -> None:
    cycle = "G0 X0 Y0 Z9\nG83 X1 Y1 Z-9 R2 Q3 F99\nG80\nG1 X5\nG2 X7 Y3 R4\nM30\n"
    asked = asked_of(here, dialect, "G21 G90 G94 G17 G54\n" + cycle)
    assert "macro" not in asked


def test_a_program_without_signs_of_a_language_is_in_the_one_that_is_said(here: Path) -> None:
    program = "N10 G90 G71 G17 G54\nN20 G0 X0 Y0 Z10\nN30 G1 X10 F100\nN40 M30\n"
    assert "1 program in fagor" in asked_of(here, "fagor", program)
    asked = asked_of(here, "fanuc", "what is this\n")
    assert "GX101 by 1 of 1 program" in asked


def test_codes_that_move_nothing_are_asked_for_where_they_help(here: Path) -> None:
    lost = "T1 M6 X1.\nM21\nG1 X2. Y5. F99.\nM30\n%\n"
    modes = "G0 X0 Y0 Z9.\nG91 G1 X1. F99.\nM21\nX1.\nM22\nX1.\nM30\n%\n"
    for program, chain, codes in (
        (HEAD + "G0 X0 Y0 Z9.\n" + lost, VOLUMETRIC, "[6, 21]"),
        (HEAD + modes, "absolute", "[21, 22]"),
    ):
        asked = asked_of(here, "fanuc", program, chain)
        assert "no setting" not in asked
        for code in codes.strip("[]").split(", "):
            assert f"M{code} by 1 of 1 program" in asked
        call("machine", "new", "-f", "fanuc", "-x", chain, "part.nc", "-o", f"{codes}.toml")
        fill_in(here / f"{codes}.toml", inert_m=codes)
        done = call("check", "-f", "fanuc", "-x", chain, "-m", f"{codes}.toml", "part.nc")
        assert done.exit_code == 0, done.stderr


def test_several_things_that_lose_a_position_are_asked_for_together(here: Path) -> None:
    program = HEAD + "G0 X0 Y0 Z9.\nG91 G28 Z0\nM21\nG90 G1 X2. Y5. F99.\nM30\n%\n"
    asked = asked_of(here, "fanuc", program, VOLUMETRIC)
    assert "no setting" not in asked
    assert "[home.G28]" in asked
    other = program.replace("G0 X0", "T1 M6\nG0 X0").replace("M21\n", "")
    assert "inert-m" not in asked_of(here, "fanuc", other, VOLUMETRIC)


def test_the_tool_in_the_spindle_has_the_length_of_a_code_without_a_number(here: Path) -> None:
    program = "G21 G90 G94 G17 G54\nT7\nT5 M6\nG43\nG0 X0 Y0 Z9\nM2\n"
    for chain in (None, VOLUMETRIC):
        asked = asked_of(here, "linuxcnc", program, chain)
        assert "[tool.5]" in asked
        assert "no setting" not in asked
    assert "[tool." not in asked_of(here, "fanuc", program)


def test_a_work_offset_that_is_in_force_by_itself_is_used(here: Path) -> None:
    program = "%\nO1\nG21 G90 G94 G17\nG0 X0 Y0 Z9.\nM30\n%\n"
    asked = asked_of(here, "fanuc", program)
    assert "[work-offset.G54]" in asked
    assert "e.g. part.nc:4\n" in asked
    assert "[work-offset.G54]" not in asked_of(here, "fanuc", program.replace("G0 X0", "G55 X0"))


def test_a_work_offset_is_called_as_its_control_does_too(here: Path) -> None:
    (here / "part.mpf").write_text("G710 G17 G90 G94 G505\nG0 X0 Y0 Z9\nM30\n")
    again = ("machine", "new", "-f", "siemens", "-o", "m.toml", "part.mpf")
    assert call(*again).exit_code == 0
    file = here / "m.toml"
    assert "# siemens: G505, as which this table may be called too" in file.read_text()
    file.write_text(file.read_text().replace("work-offset.G58", "work-offset.G505"))
    before = file.read_text()
    assert call(*again).exit_code == 0
    assert file.read_text() == before


CONTOUR = HEAD + "G0 X-10. Y0 Z9.\nG41 D1 G1 X0 F99.\nY20.\nX20.\nG40 Y30.\nM30\n%\n"


@pytest.mark.parametrize("chain", [None, "cutter-comp"])
def test_how_a_contour_is_resolved_is_asked_with_the_radius(here: Path, chain: str | None) -> None:
    asked = asked_of(here, "fanuc", CONTOUR, chain)
    assert 'cutter-comp-corners = "?"' in asked
    assert 'cutter-comp-entry = "?"' in asked
    assert 'radius = "?"' in asked
    assert "no setting" not in asked
    assert "cutter-comp" not in asked_of(here, "linuxcnc", CONTOUR)
    call("machine", "new", "-f", "fanuc", "part.nc", "-o", "m.toml")
    said = {"cutter_comp_corners": '"linear"', "cutter_comp_entry": '"next"'}
    fill_in(here / "m.toml", **said)
    words = ("run", "-q", "-f", "fanuc", "--no-stamp", "part.nc")
    done = call(*words, "-m", "m.toml", "-x", "cutter-comp")
    same = call(*words, "-m", "m.toml", "-x", "cutter-comp corners=linear entry=next")
    other = call(*words, "-m", "m.toml", "-x", "cutter-comp corners=arc entry=own")
    assert done.exit_code == same.exit_code == 0, done.stderr
    assert done.stdout == same.stdout != other.stdout


def test_what_is_used_asks_for_more_once_it_is_known(here: Path) -> None:
    """With a zero that is known it counts how far it is from the first, which nobody names."""
    moves = "G90 G55 G40 G0 X2. Y0 Z50.\nG43 H3 Z39.\nG1 X9. F39\nG28 Z39.\nG0 Y-49.\nG91 G1 Z-1.\n"
    (here / "part.nc").write_text("%\nO1\nG21 G94 G17\n" + moves + "M30\n%\n")
    new = ("machine", "new", "-f", "fanuc", "part.nc", "-o", "m.toml")
    call(*new)
    fill_in(here / "m.toml")
    before = (here / "m.toml").read_text()
    call(*new)
    assert (here / "m.toml").read_text() == before
    done = call("run", "-q", "-f", "fanuc", "-m", "m.toml", "-x", "absolute", "part.nc")
    assert done.exit_code == 0, done.stderr


def test_a_macro_that_is_not_at_hand_has_the_number_of_its_call(here: Path) -> None:
    """A code that a machine file declares has none, and G65 without P is refused as such."""
    (here / "m.toml").write_text('format = 1\n[control.macro.G38]\nends = "unknown"\n')
    (here / "part.nc").write_text(HEAD + "G0 X1. Y2. Z3.\nG65\nG38\nM30\n%\n")
    done = call("machine", "new", "-f", "fanuc", "part.nc", "-o", "m.toml")
    assert done.exit_code == 0, done.stderr
    assert "a call takes a number in P" in done.stderr


HOUSING = """%
O2001 (HOUSING)
G90 G94 G17 G49 G40 G80 G21
G28 G91 Z0.
G90
T1 M6
G54 G0 X-10. Y0.
G43 Z10. H1
G1 Z-0.5 F300.
G28 G91 Z0.
T5 M6
G90 G55 G0 X10. Y10.
G43 Z10. H5
G28 G91 Z0.
M30
%
"""


@pytest.mark.parametrize("target", ["haas", "linuxcnc", "siemens"])
def test_what_a_translation_needs_is_asked_for_at_once(shop: Path, target: str) -> None:
    """Ways home become G53: that takes home, the work offsets and the lengths of the tools."""
    (shop / "housing.nc").write_text(HOUSING)
    new = ("machine", "new", "-f", "fanuc", "-t", target, "shop/housing.nc", "-o", "h.toml")
    assert call(*new, "-p", "q.toml").exit_code == 0
    text = (shop.parent / "h.toml").read_text()
    for section in ("home.G28", "work-offset.G54", "work-offset.G55", "tool.1", "tool.5"):
        assert f"[{section}]" in text
    assert f'[output]\ndialect = "{target}"' in (shop.parent / "q.toml").read_text()
    fill_in(shop.parent / "h.toml", inert_m='"?"')
    done = call("run", "-p", "q.toml", "shop/housing.nc", "-o", "out.nc")
    assert done.exit_code == 0, done.output


def test_a_way_home_says_what_it_takes_for_another_control(shop: Path) -> None:
    """And no more than that: what the file says already is not asked for again."""
    (shop / "housing.nc").write_text(HOUSING)
    (shop.parent / "h.toml").write_text(
        "format = 1\n[home.G28]\nZ = 0.0\n[work-offset.G54]\nX = 1.0\nY = 1.0\nZ = 1.0\n"
    )
    run = ("run", "-f", "fanuc", "-t", "linuxcnc", "-x", "", "shop/housing.nc", "-o", "out.nc")
    said = call(*run).output
    assert "Z = ... in [home.G28], Z = ... in [work-offset.G54]" in said
    said = call(*run, "-m", "h.toml").output
    assert "give a machine file with length = ... in [tool.1]" in said
    assert "home" not in said.partition("hint")[2]
