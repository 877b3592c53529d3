"""Reading loses nothing, and reading by shapes is reading by the grammar."""

import math
import re
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from lark import Token

import gcxform as gx
from gcxform.flow.by_itself import SIGNS
from gcxform.pipeline.cutter_comp import CODE
from gcxform.plugin.registry import default_registry
from gcxform.proof.verify import WindowReader
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import Shape, instantiate, slots_of
from gcxform.syntax.source import Source, has_sign
from gcxform.syntax.tree import (
    COMPUTED,
    Block,
    Comment,
    Expression,
    Number,
    Statement,
    Word,
    print_block,
)
from gcxform.testing.strategies import lines_of_bytes, programs

NAN = math.nan
DIALECTS = ("fanuc", "grbl", "haas", "linuxcnc")
in_every_dialect = pytest.mark.parametrize("name", DIALECTS)


def dialect_of(name: str) -> type[gx.Dialect]:
    return default_registry().dialect(name)


def described(block: Block) -> list[tuple[object, ...]]:
    """Return all that a tree says, with the trees of expressions as text."""
    items: list[tuple[object, ...]] = [(block.text, block.error)]
    for item in block.items:
        span = (type(item).__name__, item.start, item.end)
        if isinstance(item, Word) and isinstance(item.value, Expression):
            value = item.value
            items.append((*span, item.address, value.start, value.end, str(value.tree)))
        elif isinstance(item, Statement):
            items.append((*span, item.kind, str(item.tree)))
        else:
            items.append((*span, repr(item)))
    return items


def spans_of(window: Window, line: int, shape: Shape) -> list[tuple[int, int]]:
    """Return where the slots of a line stand in it, by the number columns."""
    first, start = int(window.first_number[line]), int(window.start[line])
    return [
        (int(window.number_start[n]) - start, int(window.number_end[n]) - start)
        for n in range(first, first + len(shape.slots))
    ]


def check_line(window: Window, line: int, reader: WindowReader) -> None:
    """Compare a line of a window with what the grammar alone says."""
    text = window.line(line).decode("latin-1")
    alone = reader.shapes.grammar.parse(text)
    assert print_block(alone) == text
    shape = reader.shapes.shapes[int(window.shape[line])]
    if shape.layout is not None:
        check_outline(window, line, shape, alone)
        return
    assert described(instantiate(shape, text, spans_of(window, line, shape))) == described(alone)
    first = int(window.first_number[line])
    for number, slot in enumerate(slots_of(alone), first):
        assert float(window.value[number]).hex() == slot.value.hex(), (text, slot)
        assert int(window.decimals[number]) == slot.decimals, (text, slot)


def check_outline(window: Window, line: int, shape: Shape, alone: Block) -> None:
    """Compare a line that has an outline with its own tree: its items, and what is in its slots."""
    assert outlined(shape.block) == outlined(alone)
    slots: list[tuple[int, int, float, int]] = [
        (slot.start, slot.end, slot.value, slot.decimals) for slot in slots_of(alone)
    ]
    slots += [(i.start, i.end, NAN, COMPUTED) for i in alone.items if isinstance(i, Comment)]
    for token in operands_of(alone):
        number = Number(token.start_pos, token.end_pos, str(token))
        slots.append((number.start, number.end, number.value, number.decimals))
    slots += [(i.start, i.end, NAN, COMPUTED) for i in alone.items if isinstance(i, Statement)]
    first, start = int(window.first_number[line]), int(window.start[line])
    assert len(slots) == len(shape.layout or ())
    for number, (begin, end, value, decimals) in enumerate(slots, first):
        assert (window.number_start[number] - start, window.number_end[number] - start) == (
            begin,
            end,
        )
        assert float(window.value[number]).hex() == value.hex(), (alone.text, value)
        assert int(window.decimals[number]) == decimals


def outlined(block: Block) -> list[tuple[object, ...]]:
    """Return what a tree says, but for the numbers that may differ and the texts of comments."""
    items: list[tuple[object, ...]] = [(block.error,)]
    for item in block.items:
        if isinstance(item, Word) and isinstance(item.value, Expression):
            items.append((item.address, structure(item.value.tree)))
        elif isinstance(item, Word):
            code = (
                float(item.value.value)
                if item.address in "GMO"
                else math.copysign(1.0, item.value.value)
            )
            items.append((item.address, code))
        elif isinstance(item, Statement):
            items.append((item.kind, structure(item.tree)))
        else:
            begin = block.text[item.start] if isinstance(item, Comment) else ""
            items.append((type(item).__name__, getattr(item, "kind", begin)))
    return items


def structure(node: Any, named: bool = False) -> object:
    """Return a tree without the numbers that are no names of parameters."""
    if isinstance(node, Token):
        return "number" if node.type.endswith("NUMBER") and not named else str(node)
    name = str(node.data)
    return name, *(structure(child, name.endswith("parameter")) for child in node.children)


def operands_of(block: Block) -> list[Token]:
    """Return the numbers in the expressions of a block that are no names of parameters."""
    trees = [word.value.tree for word in block.words if isinstance(word.value, Expression)]
    trees += [item.tree for item in block.items if isinstance(item, Statement)]

    def numbers(node: Any, named: bool) -> Iterator[Token]:
        if isinstance(node, Token):
            if node.type.endswith("NUMBER") and not named:
                yield node
            return
        for child in node.children:
            yield from numbers(child, str(node.data).endswith("parameter"))

    return [token for tree in trees for token in numbers(tree, False)]


def check_program(program: bytes, name: str) -> None:
    reader = WindowReader(dialect_of(name))
    window = reader.read(program)
    whole = [window.text[a:b] for a, b in zip(window.start, window.next, strict=True)]
    assert b"".join(whole) == program
    for line in range(len(window)):
        check_line(window, line, reader)


A_REFUSED_LINE_BEFORE = example(b"A0A\nG1 X10 Y-2.5 F100\n")


@in_every_dialect
@given(program=lines_of_bytes())
@A_REFUSED_LINE_BEFORE
def test_shapes_say_what_the_grammar_says_of_any_bytes(name: str, program: bytes) -> None:
    check_program(program, name)


@in_every_dialect
@given(data=st.data())
def test_shapes_say_what_the_grammar_says_of_programs(name: str, data: st.DataObject) -> None:
    check_program(data.draw(programs(name)), name)


COMPUTING = (
    *(
        "G1",
        "G01",
        "m3",
        "X1",
        "Y-2.5",
        "Z+.5",
        "F100",
        "N10",
        "P1 2",
        "X 3",
        "G 1",
        "O1",
        "/",
        "%",
    ),
    *(
        "X#1",
        "Y-#2",
        "Z#<a>",
        "Z-#<b 1>",
        "X[#1+2.5]",
        "Y[-[3*#2]]",
        "A[2**-.5]",
        "X#[1+1]",
        "X##1",
    ),
    *("#1=2", "#2 = -[#1/4.]", "#<a>=[1 LT 2.5]", "#<b2>=SIN[30]", "#3=ATAN[1]/[2]", "#4=#5"),
    *("(wall 3)", "(a (b)", "()", "(MSG, hello 3)", "( debug,#1)", ";tail 5", "; (odd", "(\xe9 7)"),
    *("[", "]", "(", ")", "#", "=", "<", ">", "1", ".", "123456789", "1.2.3", "o1 if [1]", "G#1"),
)
"""Pieces of lines with comments, parameters and expressions, and what breaks them."""


@in_every_dialect
@given(lines=st.lists(st.lists(st.sampled_from(COMPUTING), max_size=5), min_size=1, max_size=8))
@example([["X[#1+2.5]", "(wall 3)"], ["X[#1+12.]", "(w)"], [";tail 5"], ["(wall 3)"]])
@example([["X1.5"], ["X1.2.3"]])
@example([["X[#1+0.30000000000000004]"], ["X[#1+.123456789]"], ["X[#1+1.5]", "N123456789"]])
@example([["Y-0.30000000000000004", "(wall 3)"], ["Y-1.5", "(wall 3)"]])
@pytest.mark.parametrize("gap", ["", " "])
def test_outlines_say_what_the_grammar_says(name: str, gap: str, lines: list[list[str]]) -> None:
    check_program("\n".join(gap.join(line) for line in lines).encode("latin-1"), name)


@in_every_dialect
@given(digits=st.from_regex(r"[+-]?([0-9]{1,25}\.?[0-9]{0,25}|\.[0-9]{1,25})", fullmatch=True))
@example("-0")
@example("-.0")
@example("00000000.00000001")
@example("9007199254740993")
@example("0.1")
@example("99999999.99999999")
@example("-0.30000000000000004")
@example("-.000000000")
@example("+123456789")
@example("1" * 21 + "." + "1" * 19)
def test_numbers_are_those_of_python(name: str, digits: str) -> None:
    window = WindowReader(dialect_of(name)).read(f"G1 X{digits}\n".encode())
    first = int(window.first_number[0])
    assert float(window.value[first]).hex() == float(digits).hex()
    assert int(window.decimals[first]) == (len(digits.partition(".")[2]) if "." in digits else -1)


@given(program=lines_of_bytes(), size=st.integers(1, 60))
@example(b"G0\r\nG1\rG2\n\rG3\r", 1)
def test_windows_of_any_size_are_the_same_lines(program: bytes, size: int) -> None:
    whole = WindowReader(dialect_of("linuxcnc")).read(program) if program else ()
    reader, lines = WindowReader(dialect_of("linuxcnc")), []
    windows = list(Source.of_bytes(program).windows(size))
    assert b"".join(windows) == program
    for text in windows:
        window = reader.read(text)
        lines += [window.line(n) for n in range(len(window))]
    assert lines == [whole.line(n) for n in range(len(whole))]  # type: ignore[union-attr]


@in_every_dialect
@given(program=lines_of_bytes(), chunk=st.integers(1, 60))
@example(b"(B)A1\n(C\nU2)V3((W4)\n", 60)
def test_no_axis_is_overlooked(name: str, program: bytes, chunk: int) -> None:
    reader, axes = WindowReader(dialect_of(name)), dialect_of(name).axes
    shapes = [reader.shapes.shapes[number].block for number in reader.read(program).shape]
    words = {w.address.upper() for block in shapes for w in block.items if isinstance(w, Word)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("gcxform.syntax.source.CHUNK", chunk)
        assert words & {*axes} <= {*Source.of_bytes(program).axes(axes)}


def test_letters_in_comments_are_no_axes() -> None:
    program = b"(PLATES, C)\nG0 X1 b2 (A\n; U\n"
    assert Source.of_bytes(program).axes("XYZABCUV") == "XYZABU"


@in_every_dialect
@given(program=st.one_of(st.binary(max_size=200), lines_of_bytes()))
def test_the_empty_pipeline_changes_no_byte(name: str, program: bytes) -> None:
    dialect = dialect_of(name)
    assert gx.Pipeline(dialect, dialect).run(program).text == program


@in_every_dialect
@given(program=lines_of_bytes())
@pytest.mark.parametrize("chain", ["absolute", "metric | segment chord-error=2um", "renumber"])
def test_any_bytes_are_run_or_refused(name: str, chain: str, program: bytes) -> None:
    places = [1]
    try:
        gx.Pipeline.parse(chain, name).run(program, verify="full")
    except gx.VerificationError as error:
        pytest.fail(str(error))
    except gx.InputError as refusal:
        places = [finding.where.line if finding.where else 0 for finding in refusal.diagnostics]
    assert all(places)


PARTS = (b"m", b"M", b"G", b"g", b"0", b"4", b"1", b"99", b" ", b"endsub", b"EndSub", b"_", b"\n")


@given(st.lists(st.sampled_from(PARTS), max_size=8).map(b"".join))
@example(b"x1 m099")
@example(b"g 04 1")
def test_signs_are_found_as_by_a_class_of_letters(text):
    """What is asked of every program, quickly, has the answer of the plain pattern."""
    for sign in (*SIGNS.values(), CODE):
        plain = re.search(sign.pattern, text, re.IGNORECASE) is not None
        assert has_sign(sign, text) == plain
