"""Documents in an editor: places, changes, and answers that are those of a fresh reading."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from seeds_kit import some

from gcxform.cli.editing.changes import actions, formatted
from gcxform.cli.editing.mentions import Kind, Symbol, of_line
from gcxform.cli.editing.navigation import definition, references
from gcxform.cli.editing.program import Program
from gcxform.cli.editing.shop import Shop, Wishes
from gcxform.cli.editing.text import Edit, Place, Span, Text
from gcxform.cli.lsp import command

assert command.name == "lsp"

PART = """%
O1000 (PART)
G21 G90 G17 G94 G40 G49 G80 G54
(ROUGHING)
T1 M6
S8000 M3
G0 X0 Y0 Z50.
G1 Z-1. F500
X10.
N100 Y10.
M98 P2000
#1=1
IF [#1 GT 2] GOTO 100
(FINISHING)
T2 M6
G1 X5. F100
M30
%
"""


def program(text: str, path: Path | str = "/nowhere/part.nc", **wishes: str) -> Program:
    return Program(str(path), Text(text), Shop(Wishes.of({"dialect": "fanuc"} | wishes)))


# --- places ---


@pytest.mark.parametrize("counts", ["utf-8", "utf-16", "utf-32"])
def test_places_are_counted_in_units(counts: str) -> None:
    text = Text("a\r\nä𝄞b\rc\n", counts)
    assert [text.line(k) for k in range(len(text))] == ["a", "ä𝄞b", "c", ""]
    units = {"utf-8": 6, "utf-16": 3, "utf-32": 2}[counts]
    assert text.place(5) == Place(1, units)
    assert text.offset(Place(1, units)) == 5
    assert text.of_bytes(1, 6) == Place(1, units)
    assert text.offset(Place(1, 99)) == 6
    assert text.offset(Place(9, 0)) == len(text.text)
    assert text.offset(Place(-1, 3)) == 0


def test_a_change_replaces_a_span() -> None:
    text = Text("one\r\ntwo\nthree")
    edit = Edit(Span(Place(0, 1), Place(2, 2)), "X")
    assert text.changed(edit).text == "oXree"
    backwards = Edit(Span(Place(2, 2), Place(0, 1)), "X")
    assert text.changed(backwards).text == "oXree"
    edits = [Edit(Span(Place(0, 0), Place(0, 3)), "1"), Edit(Span(Place(2, 0), Place(2, 5)), "3")]
    assert text.with_all(edits).text == "1\r\ntwo\n3"


# --- answers are those of a fresh reading ---

PIECES = (
    *("G1 X1. F100", "X", "G91", "(half", "\r\n", "\n", "\r", "G2 X5. Y5. R3.", "T3 M6", "M30"),
    *("%", "GOTO 100", "G43 H1", "ä", "𝄞", "G20", ";", "O77", "#1=", "\x0c", "\u2028", "F"),
)


def answers(of: Program, draw: random.Random) -> list[object]:
    line = draw.randrange(len(of.text))
    return [of.findings(), of.symbols(), line, of.explained(line), of.explained(len(of.text) - 1)]


def moves(count: int, draw: random.Random) -> str:
    return "".join(f"G1 X{draw.uniform(-9, 9):.3f} Z-1. F{k}\n" for k in range(1, count))


@pytest.mark.parametrize("seed", some(10))
def test_answers_after_changes_are_those_of_a_fresh_reading(seed: int) -> None:
    draw = random.Random(seed)
    head, tail = PART.split("X10.\n")
    given = f"{head}{moves(draw.choice((5, 2500)), draw)}{tail}".replace("M98 P2000\n", "")
    if seed % 2:  # without what is executed, so that readings are kept
        given = given.replace("#1=1\nIF [#1 GT 2] GOTO 100\n", "")
    now = program(given)
    for _ in range(6):
        at = sorted(now.text.place(draw.randrange(len(now.text.text) + 1)) for _ in range(2))
        if draw.random() < 0.8:
            at[1] = at[0]
        now = now.changed(now.text.changed(Edit(Span(*at), draw.choice(PIECES))))
        other = random.Random(seed)
        same = random.Random(seed)
        assert answers(now, other) == answers(program(now.text.text), same)


def test_a_state_that_is_kept_is_not_that_of_another_text() -> None:
    given = "G21 G90 G17 G94\n" + moves(2500, random.Random(1)) + "X1.\n"
    before = program(given)
    assert "modal G1 G17 G90" in "\n".join(before.explained(2499))
    assert before.explained(5) == program(given).explained(5)
    after = before.changed(Text(given.replace("G90", "G91")))
    assert "modal G1 G17 G91" in "\n".join(after.explained(2499))


def test_half_a_block_is_a_finding_and_no_more() -> None:
    found = program(PART.replace("X10.\n", "X10. Y\n").replace("M98 P2000\n", "")).findings()
    assert [(each.code, each.where.line) for each in found if each.where] == [("GX101", 9)]


def test_a_program_in_no_dialect_asks_for_one() -> None:
    now = Program("/nowhere/a.nc", Text("<html>\n<b>hello there</b>\n"), Shop())
    assert [each.code for each in now.findings()] == ["GX722"]
    assert now.explained(0) == []
    assert Program("/nowhere/a.nc", Text(""), Shop()).symbols() == []


# --- what is where ---


def shown(parts: list[Symbol]) -> list[object]:
    return [(each.title, each.lines, shown(each.inside)) for each in parts]


def test_parts_of_a_program() -> None:
    tools = [("T1", (4, 12), []), ("T2", (14, 18), [])]
    assert shown(program(PART).symbols())[0][0] == "1000"
    inside = program(PART).symbols()[0].inside
    assert [(s.kind, s.title) for s in inside] == [
        (Kind.SECTION, "ROUGHING"),
        (Kind.TOOL, "T1"),
        (Kind.TOOL, "T2"),
    ]
    assert [(s.title, s.lines[0]) for s in inside if s.kind == Kind.TOOL] == [
        (title, lines[0]) for title, lines, _ in tools
    ]


@pytest.mark.parametrize(
    ("line", "names"),
    [
        (b"O1000", {("PROGRAM", "1000", True)}),
        (b"N5 o<Pocket> sub", {("PROGRAM", "pocket", True)}),
        (b"o<pocket> call [1]", {("PROGRAM", "pocket", False)}),
        (b"G1 X1 M98 P00012 L2", {("PROGRAM", "12", False)}),
        (b"G65 P9810 X1", {("PROGRAM", "9810", False)}),
        (b"GOTOF END_1", {("LABEL", "end_1", False)}),
        (b"END_1: G0 X1", {("LABEL", "end_1", True)}),
        (b'7 FN 9: IF +Q1 EQU +0 GOTO LBL "UP"', {("LABEL", "up", False)}),
        (b"12 LBL 3", {("LABEL", "3", True)}),
        (b"12 CALL LBL 3 REP2", {("LABEL", "3", False)}),
        (b"(O1000 M98 P3)", {("SECTION", "O1000 M98 P3", True)}),
        (b"G1 X1 (GOTO 5)", set()),
        (b"G1 X1 Y2 Z3 F4", set()),
        (b"G1 X[#1+2.]*3", set()),
        (b"NAG01", {("PROGRAM", "nag01", False)}),
        (b"ZV100(5, X1)", {("PROGRAM", "zv100", False)}),
        (b"[AB]", {("LABEL", "ab", True)}),
        (b"7 L X+1 IY-2.5 R0 FMAX", set()),
        (b"7 L X+1 R0 FMAX M99", set()),
        (b"5 TOOL CALL 7 Z S100", {("TOOL", "7", True)}),
        (b'T="MILL_6"', {("TOOL", "mill_6", False)}),
    ],
)
def test_what_lines_name(line: bytes, names: set[object]) -> None:
    assert {(each.kind.name, each.name, each.defines) for each in of_line(line)} == names


def test_definitions_here_and_in_the_folder(tmp_path: Path) -> None:
    (tmp_path / "sub.nc").write_text("%\nO2000 (HOLES)\nM99\n%\n")
    (tmp_path / "O0300.nc").write_text("G1\nM99\n")
    now = program(PART + "M98 P300\nM98 P11112000\n", tmp_path / "part.nc")
    jump = definition(now, 12, 19)
    assert jump is not None
    assert (jump.file, jump.line) == (None, 9)
    called = definition(now, 10, 6)
    assert called is not None
    assert (called.file, called.line) == (tmp_path / "sub.nc", 1)
    by_name = definition(now, 18, 6)
    assert by_name is not None
    assert by_name.file == tmp_path / "O0300.nc"
    assert definition(now, 19, 6) == called
    assert definition(now, 7, 2) is None
    assert [each.line for each in references(now, 10, 6)] == [10, 19]


# --- edits ---


def test_formatting_is_what_text_passes_make() -> None:
    text = "%\nG21 G90   G17 G94\n\nG0  X1. Y1.  Z1.\nM30\n%\n"
    now = program(text)
    assert now.text.with_all(formatted(now)).text == "%\nG21G90G17G94\nG0X1.Y1.Z1.\nM30\n%\n"
    (edit,) = formatted(now, (3, 3))
    assert edit == Edit(Span(Place(3, 0), Place(3, 16)), "G0X1.Y1.Z1.")
    other = program(text, format="renumber")
    assert other.text.with_all(formatted(other)).text.splitlines()[1] == "N10 G21 G90   G17 G94"
    assert formatted(other, (1, 1)) == []


def test_hints_become_edits(tmp_path: Path) -> None:
    pipeline = tmp_path / "gcxform.toml"
    pipeline.write_text('format = 1\n[input]\ndialect = "fanuc"\n[[pass]]\nuse = "absolute"\n')
    now = program("%\nG21 G90 G17 G94\nG0 X1 Y1. Z1.\nM30\n%\n", tmp_path / "part.nc")
    done = actions(now, now.findings())
    (edits,) = [each.edits for each in done if 'increment = "IS-B"' in each.title]
    written = Text(pipeline.read_text()).with_all(edits[str(pipeline)]).text
    assert '[input]\nincrement = "IS-B"\ndialect' in written
    pipeline.write_text(written)
    assert now.changed(now.text).findings() == []
