"""The language server over its protocol: an editor opens, types, asks, and is told."""

from __future__ import annotations

import random
import statistics
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("pygls", reason="pygls is not installed")

from lsp_kit import Editor, put
from seeds_kit import LONG

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))

import lsp

TEXT = """%
O1000 (ÄÖ𝄞)
G21 G90 G17 G94
T1 M6
G0 X0 Y0 Z5.
G1 X1. F100
M98 P2000
G0  X2. Y
M30
%
"""
SUB = "%\nO2000\nM99\n%\n"
PIPELINE = 'format = 1\n[input]\ndialect = "fanuc"\n[[pass]]\nuse = "absolute"\n'


@pytest.fixture(scope="module")
def editor(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Editor]:
    folder = tmp_path_factory.mktemp("shop")
    (folder / "sub.nc").write_text(SUB)
    (folder / "gcxform.toml").write_text(PIPELINE)
    found = Editor(folder, format="strip comments=false | renumber")
    yield found
    assert found.close() == 0


def span(line: int, first: int, last: int) -> dict[str, Any]:
    ends = [{"line": line, "character": column} for column in (first, last)]
    return {"start": ends[0], "end": ends[1]}


def test_what_is_wrong_is_told_and_changes_as_one_types(editor: Editor) -> None:
    uri = editor.open("a.nc", TEXT.replace("M98 P2000\n", ""))
    (wrong,) = editor.findings(uri)
    assert (wrong["code"], wrong["severity"], wrong["source"]) == ("GX101", 1, "gcxform")
    assert wrong["range"]["start"] == {"line": 6, "character": 8}
    editor.change(uri, 2, put(6, 9, " 3."))
    assert editor.findings(uri, 2) == []
    assert editor.findings(uri, 2) == []  # of the whole check
    editor.change(uri, 3, {"text": "G1 X\r\n"})
    assert [each["code"] for each in editor.findings(uri, 3)] == ["GX101"]
    editor.tell("textDocument/didClose", textDocument={"uri": uri})
    assert editor.findings(uri, 3) == []


def test_findings_of_the_whole_check_come_later(editor: Editor) -> None:
    """Where a move starts is no matter of reading; the pass asks for it."""
    (editor.folder / "time").mkdir()
    pipeline = PIPELINE.replace('"absolute"', '"feed"\nmode = "inverse-time"')
    (editor.folder / "time" / "gcxform.toml").write_text(pipeline)
    uri = editor.open("time/b.nc", "%\nG21 G90 G17 G94\nG1 X5. F100\nM30\n%\n")
    assert editor.findings(uri) == []
    (later,) = editor.findings(uri)
    assert (later["code"], later["range"]["start"]["line"]) == ("GX320", 2)


def test_hover_says_what_a_block_does(editor: Editor) -> None:
    uri = editor.open("c.nc", TEXT.replace("Y\nM30", "Y2.\nM30").replace("M98 P2000\n", ""))
    said = editor.at("hover", uri, 5, 3)
    text = said["contents"]["value"]
    assert "modal G0 G17 G90" in text
    assert "line at 100 mm/min" in text
    assert "to   X1 Y0 Z5" in text
    assert said["range"] == span(5, 0, 11)
    assert editor.at("hover", uri, 99) is None


def test_parts_definitions_and_references(editor: Editor) -> None:
    uri = editor.open("d.nc", TEXT)
    (part,) = editor.about("documentSymbol", uri)
    assert (part["name"], [each["name"] for each in part["children"]]) == ("1000", ["T1"])
    assert part["selectionRange"] == span(1, 1, 5)
    assert editor.at("definition", uri, 6, 6) == {
        "uri": editor.uri("sub.nc"),
        "range": span(1, 0, 0),
    }
    assert editor.at("definition", uri, 5, 1) is None
    named = editor.at("references", uri, 6, 6, context={"includeDeclaration": True})
    assert [each["range"]["start"]["line"] for each in named] == [6]
    folds = editor.about("foldingRange", uri)
    assert (folds[0]["startLine"], folds[1]["startLine"]) == (1, 3)


def test_formatting_the_whole_and_some_lines(editor: Editor) -> None:
    text = "%\r\nG21 G90  G17 G94\r\nG0  X1. Y1.  Z1.\r\nM30\r\n%\r\n"
    uri = editor.open("e.nc", text)
    options = {"tabSize": 4, "insertSpaces": True}
    edits = editor.about("formatting", uri, options=options)
    assert [each["newText"] for each in edits] == ["N10G21G90G17G94", "N20G0X1.Y1.Z1.", "N30M30"]
    (one,) = editor.about("rangeFormatting", uri, range=span(2, 0, 3), options=options)
    assert one == {"range": span(2, 0, 16), "newText": "G0X1.Y1.Z1."}


def test_hints_are_offered(editor: Editor) -> None:
    uri = editor.open("f.nc", "%\nG21 G90 G17 G94\nG0 X1 Y1. Z1.\nM30\n%\n")
    (wrong,) = editor.findings(uri)
    context = {"diagnostics": [wrong]}
    found = editor.about("codeAction", uri, range=wrong["range"], context=context)
    (offer,) = [each for each in found if "IS-B" in each["title"]]
    (file, edits) = next(iter(offer["edit"]["changes"].items()))
    assert file == editor.uri("gcxform.toml")
    assert edits[0]["newText"].startswith('increment = "IS-B')
    assert offer["diagnostics"][0]["code"] == wrong["code"]


def test_our_files_are_looked_at_when_they_are_saved(editor: Editor) -> None:
    path = editor.folder / "gcxform.toml"
    program = editor.open("g.nc", TEXT.replace("Y\nM30", "Y2.\nM30").replace("M98 P2000\n", ""))
    assert editor.findings(program) == []
    uri = editor.open("gcxform.toml")
    assert editor.findings(uri) == []
    path.write_text(PIPELINE.replace("absolute", "absolut"))
    editor.tell("textDocument/didSave", textDocument={"uri": uri})
    (wrong,) = editor.findings(uri)
    assert (wrong["code"], wrong["range"]["start"]["line"]) == ("GX704", 4)
    path.write_text(PIPELINE)
    editor.tell("textDocument/didSave", textDocument={"uri": uri})
    assert editor.findings(uri) == []


def test_an_editor_that_prefers_bytes_is_answered_in_bytes(tmp_path: Path) -> None:
    editor = Editor(
        tmp_path,
        dialect="fanuc",
        capabilities={"general": {"positionEncodings": ["utf-8", "utf-16"]}},
    )
    uri = editor.open("a.nc", "%\nG21 (ÄÖ𝄞) X Y1.\nM30\n%\n")
    assert editor.findings(uri)[0]["range"]["start"] == {"line": 1, "character": 17}
    editor.change(uri, 2, put(1, 16, "1."))
    editor.about("documentSymbol", uri)
    assert all(each["code"] != "GX101" for each in editor.findings(uri, 2))
    assert editor.close() == 0


def test_bad_questions_do_not_end_it(editor: Editor) -> None:
    """Places that are not there, documents that are not open, texts that are no program."""
    uri = editor.open("h.nc", "\x00\x01<html>\n" * 5 + "G1 X\ud7ff\u2028\x0c\x85 Y\n")
    for line, column in ((0, 0), (2, 999), (10**6, 10**6)):
        for method in ("hover", "definition"):
            editor.at(method, uri, line, column)
            assert editor.at(method, editor.uri("nowhere.nc"), line, column) is None
    editor.change(uri, 2, put(5, 3, "", (99, 99)), put(99, 0, "G1 X1.\n"), put(0, 0, "%"))
    editor.change(editor.uri("nowhere.nc"), 2, put(0, 0, "G1"))
    editor.about("formatting", uri, options={"tabSize": 4, "insertSpaces": True})
    assert editor.about("documentSymbol", editor.uri("nowhere.nc")) == []
    editor.findings(uri, 2)


@pytest.mark.parametrize("name", [*lsp.PROGRAMS][:-1] if LONG else ["flow"])
def test_a_key_in_ten_thousand_lines_is_answered_in_time(name: str) -> None:
    """What the processor takes: `benchmarks/lsp.py` has the clock, the bar, and more programs.

    Other tests share caches and memory with this one: it looks for a cliff, which is ten times it.
    """
    make, pipeline = lsp.PROGRAMS[name]
    lines = make(10_000, random.Random(17))
    kinds = () if LONG else ("a key in the middle", "half a block")
    took = {
        f"{what}: {answer}": statistics.median(cpu for _, cpu in times)
        for what, answer, times in lsp.answered(lines, pipeline, 1, kinds)
    }
    assert len(took) == 3 * (len(kinds) or 6)
    assert {what: each for what, each in took.items() if each > 4 * lsp.BAR} == {}
