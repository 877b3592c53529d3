"""Words that say by a number which one is meant: D, H and T of tools, `$` of spindles."""

from __future__ import annotations

from collections.abc import Iterator

from lark import Token

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Act, EventShape, Meaning, Refusal
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import BLANKS, CODES, Number, Statement, Word


def code_of(word: Word) -> str:
    """Return `G54.1` or `M3` for a code word as written; `G01` is `G1`."""
    assert isinstance(word.value, Number)
    value = round(word.value.value, 6)
    return f"{word.address}{value:g}"


def spindle_number(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> None:
    """Turn a word `$` into an event beside what turns a spindle; elsewhere it is left over."""
    if "$" not in meaning.slots or not dialect.block_rule.spindle_words:
        return
    coded = [w for w in shape.block.words if w.address in CODES and isinstance(w.value, Number)]
    codes = {code_of(word) for word in coded}
    if dialect.block_rule.spindle_words & {*codes, *meaning.slots}:
        meaning.events.append(EventShape(9, "$", (("$", meaning.slots.pop("$")),)))


def offset_word(dialect: type[Dialect], meaning: Meaning) -> set[str]:
    """Return D if it belongs to cutter compensation; it is told as an event, like G41 and G42."""
    code = meaning.groups.get("cutter-comp", "G40")
    named = (("D", meaning.slots["D"]),) if "D" in meaning.slots else ()
    if code != "G40":
        meaning.events.append(EventShape(45, code, named))
    elif dialect.cutter_comp.stored and named:
        meaning.events.append(EventShape(45, "D", named))
    takes = dialect.codes[code].takes if code in dialect.codes else ""
    if named and code in dialect.codes and "D" in dialect.codes[code].lengths:
        meaning.lengths.append((code, *named[0]))
    return set("D") if dialect.cutter_comp.stored or "D" in takes else set()


def length_number(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> None:
    """Turn an H that no code has taken into an act and an event, where it stays in force."""
    if not dialect.tool_rule.h_stays or "H" not in meaning.slots:
        return
    word = next(word for word in shape.block.words if word.address == "H")
    taken = (("H", meaning.slots.pop("H")),)
    meaning.acts.append(Act("length-number", "H", taken, word.start, word.end - word.start))
    meaning.events.append(EventShape(46, "H", taken))


def tool_number(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Let a T change the tool where it does so by itself; elsewhere it only says which is next."""
    rule = dialect.tool_rule
    if "T" not in meaning.slots or (rule.t_selects and not rule.t_changes):
        return
    word = next(word for word in shape.block.words if word.address == "T")
    if not rule.t_changes:
        message = "T is not resolved: what moves when the tool changes is a setting of the machine"
        yield Refusal("GX210", word.start, word.end - word.start, message)
        return
    taken = (("T", meaning.slots["T"]),)
    meaning.acts.append(Act("offset-of-tool", "T", taken, word.start, word.end - word.start))
    meaning.changes_tool = meaning.loses_position = True
    meaning.lost_by.add(-1)


def table_acts(item: Statement, dialect: type[Dialect]) -> Iterator[Act]:
    """Yield the act of an assignment that writes into a table of the control, by its number."""
    arithmetic = dialect.flow_rule.arithmetic
    number = item.tree.children[0].children[0] if item.kind == "assignment" else ""
    digits = str(number).translate(BLANKS) if isinstance(number, Token) else ""
    if arithmetic is not None and digits.isdigit() and arithmetic.writes_table(int(digits)):
        yield Act("table", f"#{int(digits)}", (), item.start, item.end - item.start)
