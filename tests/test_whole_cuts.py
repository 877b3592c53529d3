"""Windows of programs that drill: smaller ones, as a line of a canned cycle is many moves."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.pipeline.whole_cuts import PART, undivided

HEAD = "G21 G90 G94 G17 G98\nG0 X0 Y0 Z20\n"
HOLES = "G81 Z-3 R2 F100\n" + "".join(f"X{k % 90} Y{k % 70}\n" for k in range(30_000)) + "G80\n"
LINES = "".join(f"G1 X{k % 90} Y{k % 70} F100\n" for k in range(30_000))
PIPELINE = gx.Pipeline.parse("absolute", "linuxcnc")


def parts(*texts: str) -> list[bytes]:
    return list(undivided(iter([text.encode() for text in texts]), PIPELINE))


def test_a_text_that_drills_is_divided() -> None:
    found = parts(HEAD, HOLES, LINES)
    assert b"".join(found).decode() == HEAD + HOLES + LINES
    assert max(map(len, found[:-1])) <= PART
    assert found[-1].decode() == LINES
    holes = HOLES.removesuffix("G80\n")
    for text in (holes, holes.lower()):  # a cycle goes on into the next texts
        begun = parts(text, text[16:], text[16:] + "G80\n")
        assert max(map(len, begun)) <= PART


FEW = LINES + HOLES[:9000] + "G80\n" + LINES
OTHERS = {"straight": LINES, "few holes": FEW, "one long line": "G81" + "X" * PART}


@pytest.mark.parametrize("text", OTHERS.values(), ids=OTHERS)
def test_others_stay_whole(text: str) -> None:
    assert parts(text) == [text.encode()]


def test_parts_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    text = (HEAD + HOLES[:20_000] + "\nG80\nG0 X1\nM2\n").encode()
    drilled = gx.Pipeline.parse("cycles | absolute", "linuxcnc")
    whole = drilled.run(text).text
    monkeypatch.setattr("gcxform.pipeline.whole_cuts.PART", 900)
    assert drilled.run(text).text == whole
