"""Programs in another language, read through the blocks that they stand for.

A small language with a verb of each kind stands in for the real ones, which have tests of their
own.
"""

from __future__ import annotations

import re

import pytest

import gcxform as gx
from gcxform import vocabulary as v
from gcxform.flow import line_shapes
from gcxform.flow.translated import translated
from gcxform.flow.tree_shapes import SLOT
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.system.limits import Limits, in_force

LARK = """
start: block_delete? item*
?item: word | go | named | comment
block_delete: BLOCK_DELETE
word: ADDRESS NUMBER
go: GO NUMBER
named: NAME
comment: COMMENT
BLOCK_DELETE: "/"
GO.2: /GO/
NAME.2: /[a-z][a-z0-9]*/
ADDRESS: /[GXYZF]/
NUMBER: /[+-]?[0-9]+(?:\\.[0-9]*)?/
COMMENT: /\\([^()]*\\)|;.*/
%ignore /[ \\t]+/
"""


class Walk(gx.Translator):
    """`GO 3` carries on at the line 3 lines on, a name says its own name in a comment."""

    grammar = ("small", "walk")
    number = re.compile(r"[+-]?[0-9]+(?:\.[0-9]*)?")
    signs = re.compile(rb"GO")
    asked = 0

    def blocks(self, items):
        Walk.asked += 1
        (first, *_) = items
        if first.kind == "go":
            self.at = self.line + int(first.value)
            return []
        if first.kind == "named":
            if first.name.startswith("BAD"):
                self.refuse(f"{first.name} is not resolved", first)
            return [f"({first.name})"]
        for item in items:
            if item.numbers == ("9",):
                self.refuse("nine", item)
        if [item.name for item in items].count("X") > 1:
            self.refuse("X again", items[-1])
        return [" ".join(item.name + item.numbers[0] for item in items)]


class Plainly(Walk):
    """The same; plain words are a block as they stand."""

    def plain(self, items):
        names = {item.name for item in items if item.kind == "word"}
        return len(names) == len(items)


@pytest.fixture(autouse=True)
def _language(monkeypatch):
    from lark import Lark

    made = Lark(LARK, parser="lalr", propagate_positions=True, maybe_placeholders=False)
    monkeypatch.setattr(line_shapes.kept, "grammar", lambda *_: made)
    monkeypatch.setattr(Walk, "asked", 0)


class Small(gx.Dialect):
    """A control that reads the small language."""

    name = "small"
    codes = v.ISO
    translator = Walk


def read(text, kind=Walk, **said):
    """Return the blocks of a program, and the line of each."""
    dialect = type("Small", (Small,), {"translator": kind})
    source = translated(Source.of_bytes(text, "p.txt"), dialect, Reading(**said))
    blocks = b"".join(source.windows()).decode("latin-1").split("\n")[:-1]
    return blocks, [source.line_of(line + 1) for line in range(len(blocks))]


def refused(text, kind=Walk):
    with pytest.raises(gx.InputError) as error:
        read(text, kind)
    (found,) = error.value.diagnostics
    return found


both = pytest.mark.parametrize("kind", [Walk, Plainly])


@both
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
@pytest.mark.parametrize("last", [True, False])
def test_lines_end_as_they_do_elsewhere(kind, end, last):
    text = end.join([b"G1 X1", b"", b"  ", b"X2.50"]) + (end if last else b"")
    cr = "\r" if end == b"\r\n" else ""
    assert read(text, kind) == ([f"G1 X1{cr}", f"X2.50{cr}"], [1, 4])


@both
def test_numbers_keep_their_digits(kind):
    text = b"G01X+1.Y-0.500\nG0X-007.Y1\n"
    assert read(text, kind)[0] == ["G01 X+1. Y-0.500", "G0 X-007. Y1"]


@both
def test_comments_are_kept_with_what_they_say(kind):
    text = (
        b"X1 (a 1)\nX2 (a 22)\nX3 (a)\nX4 (a)\n(b%s 5)\n(b)\nX5;c (d) ; 6\nX6;\nX7 (\xe9\xff)(e)\n"
    )
    assert read(text, kind)[0] == [
        *("X1 (a 1)", "X2 (a 22)", "X3 (a)", "X4 (a)", "(b%s 5)", "(b)"),
        *("X5 (c [d] ; 6)", "X6 ()", "X7 (\xe9\xff)(e)"),
    ]


@both
def test_a_comment_with_a_percent_sign_is_no_template(kind):
    assert read(b"X1 (100)\nX1 (%s)\nX2 (%s)\nX3 (%)\n", kind)[0][1:] == [
        *("X1 (%s)", "X2 (%s)", "X3 (%)"),
    ]


@both
def test_names_with_numbers_are_themselves(kind):
    assert read(b"a1\na2\na1\nb\n", kind)[0] == ["(A1)", "(A2)", "(A1)", "(B)"]


@both
@pytest.mark.parametrize("sign", ["#", SLOT, "\0", "?"], ids=["hash", "slot", "null", "question"])
def test_no_sign_of_a_program_is_taken_for_a_number(kind, sign):
    """A shape has something in the place of numbers; a program cannot write it."""
    found = refused(f"X1\nX{sign}\n".encode(), kind)
    assert (found.code, found.where.line, found.where.column) == ("GX101", 2, 2)


@both
def test_what_is_refused_is_shown_where_it_stands(kind):
    found = refused(b"X1 X2\n", kind)
    assert (found.where.column, found.where.width) == (4, 2)
    text = b"G1 X1\nX1 Y1\nG0 X2\n\t X100.000   Y5 X2\n"
    found = refused(text, kind)
    assert (found.where.line, found.where.column, found.where.width) == (4, 17, 2)
    assert found.where.text == "\t X100.000   Y5 X2"
    found = refused(b"X1\nX1   X1 ; again\n", kind)
    assert (found.where.column, found.where.width) == (6, 2)
    found = refused(b"(a 1) bad\n(a 22) bad\n", kind)
    assert (found.where.line, found.where.column) == (1, 7)
    found = refused(b"/GO 2\nX1\n", kind)
    assert (found.code, found.where.column, found.where.width) == ("GX211", 1, 1)


def test_a_later_line_of_a_shape_has_places_of_its_own():
    found = refused(b"X1   Y2\nX100.25   Y9\n")
    assert (found.where.line, found.where.column, found.where.width) == (2, 11, 2)


@both
def test_a_line_may_be_skipped_with_its_comment(kind):
    text = b"/X1 (a)\nX2\n/\n"
    assert read(text, kind, block_delete="skip") == (["X2"], [2])
    assert read(text, kind, block_delete="execute") == (["X1 (a)", "X2"], [1, 2])


@both
def test_jumps_and_the_lines_of_what_is_executed(kind):
    text = b"GO 3\nX1\nGO 2\nGO -2\nX2\n"
    assert read(text, kind) == (["X1", "X2"], [2, 5])


@both
def test_a_loop_without_an_end(kind):
    with in_force(Limits(steps=12)):
        found = refused(b"X1\nGO -1\n", kind)
        assert (found.code, found.where.line) == ("GX224", 1)
        assert "--limit steps=120" in found.hint
        assert len(read(b"X1\n" * 200, kind)[0]) == 200  # a long program is no loop


@both
def test_leader_and_byte_order_mark_are_none_of_the_program(kind):
    text = b"\xef\xbb\xbfX1\n\0\0\x7f\nX2\n\0\0"
    assert read(text, kind) == (["X1", "X2"], [1, 3])
    found = refused(b"\xef\xbb\xbfX1 ?\n", kind)
    assert (found.where.line, found.where.column) == (1, 4)


@both
def test_long_lines_and_noise(kind):
    blocks, _ = read(b"X1" + b" " * 100_000 + b"Y2\n" + b"; " + b"x" * 100_000, kind)
    assert blocks[0] == "X1 Y2"
    assert len(blocks[1]) == 100_002
    for noise in (b"\x80\x81", b"X\0" * 9, bytes(range(256)), b"X1 (a"):
        assert refused(b"X1\n" + noise, kind).code == "GX101"


def test_plain_lines_need_no_translator():
    text = b"G1 X1 Y2 (a)\nX2 Y3\nX4 Y5\nX6 Y7\nX1 X2\n"
    with pytest.raises(gx.InputError):
        read(text, Plainly)
    assert Walk.asked == 1


def test_a_translator_may_ask_for_all_lines():
    class Asking(Plainly):
        def blocks(self, items):
            self.plainly = items[0].kind != "go"
            return super().blocks(items)

    read(b"X1\nX2\nGO 1\nX1\nX2\n", Asking)
    assert Walk.asked == 2  # GO 1, and the line behind it
    Walk.asked = 0
    read(b"X1\nX2\n", Asking)
    assert Walk.asked == 0


def test_empty_programs():
    for text in (b"", b"\n", b"\r\n\r\n", b" "):
        assert read(text) == ([], [])


def test_the_registry_has_translators_whose_numbers_have_no_groups():
    for dialect in default_registry().dialects.values():
        if dialect.translator is not None:
            assert dialect.translator.number.groups == 0
