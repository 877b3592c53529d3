"""Reading loses nothing, and reading by shapes is reading by the grammar."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.proof.verify import WindowReader
from gcxform.syntax.scan import Window
from gcxform.syntax.shapes import Shape, instantiate, slots_of
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Expression, Statement, Word, print_block
from gcxform.testing.strategies import lines_of_bytes, programs

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
    assert described(instantiate(shape, text, spans_of(window, line, shape))) == described(alone)
    first = int(window.first_number[line])
    for number, slot in enumerate(slots_of(alone), first):
        assert float(window.value[number]).hex() == slot.value.hex(), (text, slot)
        assert int(window.decimals[number]) == slot.decimals, (text, slot)


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


@in_every_dialect
@given(digits=st.from_regex(r"[+-]?([0-9]{1,18}\.?[0-9]{0,18}|\.[0-9]{1,18})", fullmatch=True))
@example("-0")
@example("-.0")
@example("00000000.00000001")
@example("9007199254740993")
@example("0.1")
@example("99999999.99999999")
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
