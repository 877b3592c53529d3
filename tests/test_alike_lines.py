"""Lines whose form was spelled before become what they become word by word."""

from __future__ import annotations

from decimal import Decimal
from pathlib import Path
from random import Random

import pytest
from test_refolded import compensating

from gcxform.emit.alike_lines import AlikeLines, Form
from gcxform.emit.own_lines import OwnLines
from gcxform.flow.block_words import Worded

PLACES = ("X{}", "X{} Y{}", "Y{} Z{}", "Z{}", "X{} Y{} Z{}", "x{} Y{}")
BETWEEN = (
    *(
        "TRANS X{}\nX3 Y3 Z3",
        "TRANS\nX2 Y2 Z2",
        "ROT RPL=90\nX{}\nROT\nX2 Y2 Z2",
        "G91\nX{} Z{}\nX{}\nG90",
        "R1={}",
        "X=R1",
    ),
    *("X=IC({})", 'MSG("T{}")', "G2 X{} Y{} CR=900\nG1 Z{}", "G17", "F{}", "M8", "G4 F1", "G0 Z{}"),
    *("G1 X{}", "S{}"),
)


def drawn(random: Random, count: int) -> str:
    """Return a program in which most lines are like others."""
    lines = ["G710 G17 G90 G54 G94", "R1=1 G0 X1 Y1 Z50", "G1 X2 F500"]
    for k in range(count):
        few = random.random() < 0.1
        text = random.choice(BETWEEN if few else PLACES)
        while "{}" in text:
            number = f"{random.uniform(1, 90):.{random.randrange(4)}f}"
            text = text.replace("{}", random.choice(("", "", "-", "+")) + number, 1)
            text = text.replace("F-", "F").replace("F+", "F").replace("S-", "S").replace("S+", "S")
        code = random.choice(("", "", "G0 ", "G1 ")) if not few else ""
        number = random.choice(("", f"N{k} ", f"N{k}  ")) if not few else ""
        lines.append(
            number + code + text + random.choice(("", "", f" ; LINE {k}", " ; X9 Y-8", "  "))
        )
    return "\n".join([*lines, "M30", ""])


@pytest.mark.parametrize("seed", range(12))
def test_what_is_alike_is_spelled_as_word_by_word(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = drawn(Random(seed), 120).encode()
    pipeline = compensating(tmp_path)
    quick = pipeline.run(text).text
    monkeypatch.setattr(OwnLines, "_counts_alike", lambda *_: False)
    assert pipeline.run(text).text == quick


def test_most_lines_are_alike(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    slow = []
    word_by_word = OwnLines._worded
    monkeypatch.setattr(
        OwnLines, "_worded", lambda *given: slow.append(given[1]) or word_by_word(*given)
    )
    text = (
        "G710 G17 G90 G54 G94\nG0 X1 Y1 Z50\nG1 X2 F500\n" + "X1.5 Y2.5 ; A\nX4 Y3\n" * 50 + "M30\n"
    )
    found = compensating(tmp_path).run(text.encode())
    assert found.text.count(b" ; A") == 50
    assert len(slow) < 10


def test_a_form_is_filled_and_told() -> None:
    known = AlikeLines(Worded())
    known.learn("X1 X2", "X2", "X3", "X1 X3")
    assert known.spelled("X1 X2", "X2", "X3") is None
    known.learn("N1 G1 X1", "G1 X1.", "G1 X1.5 Y2.", "N1 G1 X1.5 Y2")
    assert known.forms["N% G1 X%", "G1 X%", "G1 X% Y%"] == Form("N%s G1 X%s Y%s", "NXY")
    assert known.spelled("N20 G1 X+7", "G1 X7.", "G1 X7. Y-2.50") == "N20 G1 X+7 Y-2.5"
    assert known.spelled("N20 G1 X+7", "G0 X7.", "G1 X7. Y-2.50") is None
    before, now = {"X": Decimal(1), "Z": Decimal(9)}, {"X": Decimal(1)}
    known.settle(before, now)
    assert before == {"X": 7, "Z": 9}
    assert now == {"X": 7, "Y": Decimal("-2.5")}


@pytest.mark.parametrize("comment", ["; X{}", "(X{})", "(X{} "])
def test_words_of_a_comment_are_none(comment: str) -> None:
    one, other = comment.format(9), comment.format(8)
    known = AlikeLines(Worded())
    known.learn(f"X5 {one}", "X5 (X9)", "X5 Y3. (X9)", f"X5 Y3 {one}")
    assert known.spelled(f"X7 {other}", "X7 (X8)", "X7 Y3. (X8)") == f"X7 Y3 {other}"
    before, now = dict[str, Decimal](), dict[str, Decimal]()
    known.settle(before, now)
    assert (before, now) == ({"X": 7}, {"X": 7, "Y": 3})


def test_words_behind_a_comment_are_not_taken_for_it() -> None:
    known = AlikeLines(Worded())
    known.learn("Z5 (A) X1", "X1 Z5 (A)", "X1 Z6. (A)", "Z6 (A) X1")
    assert known.spelled("Z5 (A) X2", "X2 Z5 (A)", "X3 Z6. (A)") is None
