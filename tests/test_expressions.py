"""What expressions are worth: hand-worked values, and LinuxCNC's own on random programs."""

from __future__ import annotations

import math
from typing import Any

import pytest
from oracles import rs274
from oracles.canon import CanonProgram
from oracles.expressions import program
from seeds_kit import some

import gcxform as gx
from gcxform.modal.expressions.value import parameter_key

START = dict.fromkeys("XYZABC", 0.0)
COUNT = len(some(250))
PRINTED = 0.51e-4  # mm: rs274 prints four decimals


def read(text: str, dialect: str = "linuxcnc", **reading: Any) -> gx.Toolpath:
    return gx.read(f"{text}\nM2\n".encode(), dialect, start=START, **reading).path


def last(text: str, dialect: str = "linuxcnc", **reading: Any) -> list[float]:
    """Return where the tool is at the end of a program."""
    path = read(text, dialect, **reading)
    return [float(path.end[-1, path.axes.index(axis)]) for axis in "XYZ"]


def refusal(text: str, dialect: str = "linuxcnc", **reading: Any) -> gx.Diagnostic:
    with pytest.raises(gx.InputError) as refused:
        read(text, dialect, **reading)
    return refused.value.diagnostics[0]


# --- LinuxCNC ---


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1+2*3", 7),
        ("[1+2]*3", 9),
        ("-2**2", 4),
        ("0-2**2", -4),
        ("2**3**2", 64),
        ("2**-1", 0.5),
        ("[-8]**3", -512),
        ("0**0", 1),
        ("7 MOD 4 * 2", 6),
        ("-1 MOD 4", 3),
        ("5 MOD -3", 2),
        ("-5.5 MOD -2", 0.5),
        ("10-4-3", 3),
        ("16/4/2", 2),
        ("3--2", 5),
        ("1+2 EQ 3 AND 1", 1),
        ("1 EQ 1.00009", 1),
        ("1 EQ 1.00011", 0),
        ("1 NE 1.00009", 0),
        ("1 GE 1.00005", 0),
        ("1 LT 1.00005", 1),
        ("5 GT 3 GT 0", 1),
        ("3 XOR 2", 0),
        ("3 OR 0", 1),
        ("2 AND 0.5", 1),
        ("ABS[-2.5]", 2.5),
        ("ACOS[0.5]", 60),
        ("ASIN[-0.5]", -30),
        ("ATAN[1]/[-1]", 135),
        ("ATAN[-1]/[-1]", -135),
        ("ATAN[0]/[0]", 0),
        ("COS[60]", 0.5),
        ("EXP[0]", 1),
        ("FIX[-2.8]", -3),
        ("FIX[2.8]", 2),
        ("FUP[-2.1]", -2),
        ("FUP[2.1]", 3),
        ("LN[EXP[2]]", 2),
        ("ROUND[2.5]", 3),
        ("ROUND[-2.5]", -3),
        ("ROUND[-0.4]", 0),
        ("SIN[30]", 0.5),
        ("SQRT[2.25]", 1.5),
        ("TAN[45]", 1),
        ("EXISTS[#<never>]", 0),
    ],
)
def test_values(expression: str, value: float) -> None:
    assert last(f"#7=1 G0 X[{expression}]")[0] == pytest.approx(value, abs=1e-12)
    assert last(f"#7=1\n#8=[{expression}]\nG0 X#8")[0] == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("#1=2\n#2=5\nG0 X##1 Y#[#1-1] Z-#2", [5, 2, -5]),
        ("#1=1\n#2=2\n#1=#2 #2=#1\nG0 X#1 Y#2", [2, 1, 0]),
        ("#1=1 #1=2\nG0 X#1", [2, 0, 0]),
        ("#1=7\nG0 X#1 #1=8\nY#1", [7, 8, 0]),
        ("#< My Name >=4 #<_other>=3\nG0 X#<myname> Y#<_OTHER>", [4, 3, 0]),
        ("#1=2\n#[#1+1]=9\nG0 X#3 Y--#1 Z---#1", [9, 2, -2]),
        ("#1=2\ng0 xsin[30] y abs[-#1] zatan[1]/[1]", [0.5, 2, 45]),
        ("#1=1\n/#1=2\nG0 X#1", [1, 0, 0]),
        ("G20 #1=2\nG0 X#1", [50.8, 0, 0]),
        ("#1=3\nG0 X#1 (#1=4)\n(X#9)\nY#1", [3, 3, 0]),
        ("#1.0=3\nG0 X#1", [3, 0, 0]),
        ("#7=2 #<a>=1\nG0 X[EXISTS[#7]+EXISTS[#<A>]]", [2, 0, 0]),
    ],
)
def test_programs(text: str, place: list[float]) -> None:
    assert last(text, block_delete="skip") == pytest.approx(place, abs=1e-12)


def test_words_of_other_kinds() -> None:
    """Feed, centres, turns, spindle, tool and time are words as the others."""
    path = read("#1=10\nG0 X#1\nG2 X-#1 I-#1 P[#1/5] F[#1*60]\nS[#1*2] T[#1/2] M3\nG4 P[#1/4]")
    assert path.feed[1] == 600
    assert path.centre[1].tolist() == [0, 0, 0]
    assert path.sweep[1] == pytest.approx(3 * math.pi)
    said = {event.what: [value for _, value in event.values] for event in path.events}
    assert said == {"S": [20.0], "T": [5.0], "M3": [], "DWELL": [2.5], "M2": []}


@pytest.mark.parametrize(
    ("text", "code", "line", "column"),
    [
        ("#<a>=1\nG0 X#<b>", "GX220", 2, 5),
        ("#0=1", "GX206", 1, 1),
        ("#5003=1", "GX206", 1, 1),
        ("G0 X[2 + 1/[1-1]]", "GX221", 1, 10),
        ("G0 X[10**300*10**300]", "GX221", 1, 6),
        ("G0 X[SQRT[0-1]]", "GX221", 1, 6),
        ("G0 X[0**-1]", "GX221", 1, 6),
        ("G0 X[ACOS[1.0001]]", "GX221", 1, 6),
        ("G0 X[ROUND[3000000000]]", "GX221", 1, 6),
        ("G0 X[EXISTS[1]]", "GX221", 1, 6),
        ("T[2.5]", "GX221", 1, 1),
        ("#1=2\n#[#1+0.5]=1", "GX221", 2, 1),
        ("#1=1\nN#1 G0 X1", "GX206", 2, 1),
        ("#1=98\nM#1 P1", "GX206", 2, 1),
        ("o1 sub", "GX223", 1, 1),
    ],
)
def test_refusals(text: str, code: str, line: int, column: int) -> None:
    found = refusal(text)
    assert found.where is not None
    assert (found.code, found.where.line, found.where.column) == (code, line, column)


@pytest.mark.parametrize(
    "text", ["G0 X#1", "#1=2\nG0 X[#1+##1]", "G0 X#5061", "#1=#2 #2=1\nG0 X#1"]
)
def test_what_only_the_machine_knows_is_lost(text: str) -> None:
    x, y = last(f"G0 X1 Y2\n{text}")[:2]
    assert math.isnan(x)
    assert y == 2.0


def test_parameters_that_are_given() -> None:
    assert last("G0 X#31 Y#<depth>", parameters={"#31": 2.0, "< Depth >": 3.0})[:2] == [2, 3]
    assert math.isnan(last("G0 X#5061", parameters={"5061": 2.0})[0])
    assert [parameter_key(t) for t in ("#100", "7", "#<A b>", "<c>")] == [100, 7, "ab", "c"]
    with pytest.raises(ValueError, match="neither a number nor a name"):
        parameter_key("depth")


def test_parameters_outlive_a_window() -> None:
    """What is set goes from window to window; a window has a megabyte."""
    comment = "(" + 200 * "." + ")"
    path = read("G0 #1=0\n" + 6_000 * f"#1=[#1+1] X#1 {comment}\n" + "X#1")
    assert path.end[-2:, 0].tolist() == [5_999, 6_000]


# --- Fanuc and GRBL ---


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1+2*3", 7),
        ("7 MOD 4", 3),
        ("FIX[2.8]", 2),
        ("FUP[2.1]", 3),
        ("FIX[-3]", -3),
        ("ROUND[2.5]", 3),
        ("ROUND[0.5]", 1),
        ("ROUND[2.4]", 2),
        ("ROUND[-2.6]", -3),
        ("ATAN[1]/[-1]", 135),
        ("ASIN[0.5]", 30),
        ("ACOS[-0.5]", 120),
        ("SIN[30]", 0.5),
        ("POW[2,3]", 8),
        ("TAN[45]", 1),
    ],
)
def test_fanuc_values(expression: str, value: float) -> None:
    text = f"#100={expression}\nG0 X#100"
    assert last(text, "fanuc", increment=0.001)[0] == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("#1=FIX[-2.5]", "GX221"),
        ("#1=FIX[0.3/0.1]", "GX221"),
        ("#1=ROUND[-2.5]", "GX221"),
        ("#1=ROUND[[0.1+0.7]*10-5.5]", "GX221"),
        ("#1=5 MOD -2", "GX221"),
        ("#1=ATAN[-1]/[1]", "GX221"),
        ("#1=ASIN[-0.5]", "GX221"),
        ("#1=TAN[90]", "GX221"),
        ("#1=POW[2]", "GX221"),
        ("#1=6 OR 1", "GX206"),
        ("#1=2**2", "GX206"),
        ("#1=ADP[2]", "GX206"),
        ("#1=1. X5.", "GX206"),
        ("#1000=1", "GX206"),
        ("#34=1", "GX206"),
        ("IF [1 EQ 1] GOTO 5", "GX223"),
    ],
)
def test_fanuc_refusals(text: str, code: str) -> None:
    assert refusal(text, "fanuc", increment=0.001).code == code


def test_fanuc_rounds_what_is_computed_to_its_increment() -> None:
    text = "#100=10\n#101=#100/3\nG0 X#100 Y-#101 Z5"
    assert last(text, "fanuc", increment=0.001) == pytest.approx([10, -3.333, 0.005], abs=1e-12)
    assert refusal(text, "fanuc").code == "GX205"


def test_grbl_computes_nothing() -> None:
    assert refusal("G0 X#1", "grbl").code == "GX101"


# --- LinuxCNC's own interpreter ---

STRICTER = {
    "this divides by zero",
    "the result is too large",
    "the number is too large to be rounded",
}
"""What is refused here also inside an expression: rs274 goes on with it as "not a number"."""


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_computes_the_same() -> None:
    """Random programs: the same places, and the same line where it stops."""
    sources = [program(seed) for seed in range(COUNT)]
    same = refused = stricter = 0
    for source, canon in zip(sources, rs274.run_many(sources), strict=True):
        ours = place_or_refusal(source)
        if isinstance(ours, gx.Diagnostic) and ours.message in STRICTER:
            stricter += isinstance(canon, CanonProgram) or canon.line != ours.where.line  # type: ignore[union-attr]
        elif isinstance(canon, rs274.Rejected):
            assert isinstance(ours, gx.Diagnostic), f"{canon}\n{source.decode()}"
            assert ours.where is not None
            assert ours.where.line == canon.line, f"{ours}\n{canon}\n{source.decode()}"
            refused += 1
        else:
            assert isinstance(ours, gx.Toolpath), f"{ours}\n{source.decode()}"
            check_places(ours, canon, source)
            same += 1
    assert same > COUNT / 3
    assert refused > COUNT / 10
    assert stricter < COUNT / 10


def place_or_refusal(source: bytes) -> gx.Toolpath | gx.Diagnostic:
    try:
        return gx.read(source, "linuxcnc", start=START).path
    except gx.InputError as refused:
        return refused.diagnostics[0]


def check_places(path: gx.Toolpath, canon: CanonProgram, source: bytes) -> None:
    lines = (path.source + 1).tolist()
    moves = [move for move in canon.moves if move.line in lines]
    assert [move.line for move in moves] == lines
    for row, move in enumerate(moves):
        for axis in "XYZ":
            value = float(path.end[row, path.axes.index(axis)])
            near = PRINTED + 1e-12 * abs(value)
            assert abs(value - move.end[axis]) <= near, f"{axis}{value} {move}\n{source.decode()}"
