"""A program whose lines are read by their outlines becomes what it becomes line by line."""

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.modal import reader
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.shapes import ShapeTable

HEAD = "G21 G90 G17 F100\nG0 X0. Y0. Z5.\n#1=1.5\n#2=2.\n#100=3.25\n#500=1.\n"
LINES = (
    *("X#", "G1 X# Y#", "G0 Z# (lift #)", "(wall #)", "N# X# (a) Y#", "(a #) (b #)", "Y#500"),
    *("X[#1+#]", "Y[#2*#-#] (row #)", "X[-[#]] Z-#1", "G1 X[SQRT[#]+#100]"),
    *("#1=#", "#2=[#*#1]", "#100=[#/4.] (count #)", "#1=[#2+#100]", "G91", "G90", "X[SIN[#]]"),
    *("#500=# (kept)", "Y[#] (x) Z#", "M3 S[#] (on)", "G20 (inch)", "G21"),
)
RARE = (
    "X[1/[#-2.]]",
    "X[LN[#-3]]",
    "H[#]",
    "G2 X[#1] Y# I# (arc)",
    "Y[#] (x) Y#",
    "X# #1=#",
    "X#7",
)
OF_LINUXCNC = (
    "F[100.+#]",
    "; wall #",
    "X# ; wall #",
    "(MSG, row #)",
    "#<a> = [#*2.]",
    "Y#1 #1=# ; next",
)
"""`#` behind a blank, a letter or an operator is a number; `#1` and the like are parameters."""
SIZES = ("2.", "2.5", "12.25", "3.", ".125", "100.5")
CHAINS = (("absolute", ""), ("metric", ""), ("absolute | segment chord-error=5um", "fanuc"))


def program(seed: int, name: str) -> bytes:
    """Return a program of such lines."""
    pick = random.Random(seed)
    chosen = LINES + OF_LINUXCNC * (name == "linuxcnc") + RARE * (seed % 5 == 0)
    lines = []
    for _ in range(pick.randint(1, 60)):
        pieces = pick.choice(chosen).split("#")
        text = pieces[0]
        for piece in pieces[1:]:
            named = piece[:1].isdigit() or piece[:1] == "<"
            text += (
                "#" if named else ("500" if pieces[0].endswith("S[") else pick.choice(SIZES))
            ) + piece
        lines.append(text)
    return (HEAD + "\n".join(lines) + "\nM2\n").encode()


def result(text: bytes, name: str, chain: str, target: str) -> object:
    """Return what becomes of a program: its text, or what is said against it."""
    source, other = (default_registry().dialect(each) for each in (name, target or name))
    passes = gx.Pipeline.parse(chain, name).passes
    pipeline = gx.Pipeline(source, other, passes, Reading(increment="IS-B"))
    try:
        return pipeline.run(text).text
    except gx.GcxformError as error:
        return [(type(error), str(each)) for each in error.diagnostics]


@pytest.mark.parametrize(("chain", "target"), CHAINS)
@pytest.mark.parametrize("name", ["linuxcnc", "fanuc"])
@settings(max_examples=DRAWN)
@given(seed=st.integers(0, 1 << 30))
def test_outlines_change_no_program(name: str, chain: str, target: str, seed: int) -> None:
    text = program(seed, name)
    found = result(text, name, chain, target)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            reader,
            "new_table",
            lambda dialect: MeaningTable(ShapeTable(dialect.load_grammar()), dialect),
        )
        assert result(text, name, chain, target) == found


def test_a_column_is_refused_at_the_line_that_has_no_value() -> None:
    text = HEAD + "".join(f"G1 X[1/[{n}-20]] Y{n} (row {n})\n" for n in range(40)) + "M2\n"
    (finding,) = result(text.encode(), "linuxcnc", "absolute", "")  # type: ignore[misc]
    assert "divides by zero" in finding[1]
    assert f"line={HEAD.count(chr(10)) + 21}, column=6" in finding[1]


def test_what_nobody_has_set_is_not_zero() -> None:
    (finding,) = result(f"{HEAD}G20\nG1 X#7\nM2\n".encode(), "linuxcnc", "metric", "")  # type: ignore[misc]
    assert "#7 is computed by the machine" in finding[1]


def test_a_comment_that_is_executed_is_no_slot_of_one_that_is_not() -> None:
    """Lines that are alike but for what their comments say: only the message is an effect."""
    lines = ["G4 P1. (MSG, on)", "G4 P1. (on)", "X1. (wall)", "X2. (DEBUG, wall)", "X3. (wall)"]
    lines += ["X4. (debug, wall)", "X5. ( MSG, wall)"]
    path = gx.read((HEAD + "\n".join(lines) + "\nM2\n").encode(), "linuxcnc").path
    effects = [(each.line, each.what) for each in path.events if each.what.startswith("(")]
    told = [(6, "(MSG, on)"), (9, "(DEBUG, wall)"), (11, "(debug, wall)"), (12, "( MSG, wall)")]
    assert effects == told
