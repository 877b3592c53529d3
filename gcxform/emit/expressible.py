"""What a target dialect has words for, and what is left of a block in it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import replace
from itertools import pairwise

import numpy as np

from gcxform.dialect.code_translation import IN_STEP, LASTING, Saying
from gcxform.dialect.codes import Code, Effect, MCode
from gcxform.dialect.cycle_rule import TAPPING as TAPS
from gcxform.dialect.dialect import Dialect
from gcxform.emit.manner import Manner
from gcxform.machine.machine import SWITCHES
from gcxform.modal.expressions.value import key_set, sets_number, written
from gcxform.modal.meaning.meaning import FRAMING, Meaning
from gcxform.modal.meaning.sorting import only_for_cycles
from gcxform.modal.meaning.tables import TAP
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import BLANKS, CODES, Item, Mark, Number, Statement, Word
from gcxform.toolpath.path import Event

STATED: Mapping[str, tuple[str, Mapping[int, str] | tuple[str, ...]]] = {
    "units": ("inch", ("G21", "G20")),
    "distance": ("incremental", ("G90", "G91")),
    "arc-distance": ("absolute_centre", ("G91.1", "G90.1")),
    "feed-mode": ("feed_mode", {93: "G93", 94: "G94", 95: "G95"}),
    "motion": ("motion", {0: "G0", 1: "G1", 2: "G2", 3: "G3", TAP: IN_STEP, 74: "G74", 84: "G84"}),
}
"""Groups whose code may have to be stated: field of the key, and codes by value."""
TAPPING = ("G74", "G84")


class CannotSayError(Exception):
    """The target dialect has no words for something: column from 0, width, message, hint."""

    def __init__(self, column: int, width: int, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.column = column
        self.width = width
        self.message = message
        self.hint = hint


def code_of(word: Word) -> str:
    """Return the code of a G, M or O word."""
    assert isinstance(word.value, Number)
    return f"{word.address}{round(word.value.value, 6):g}"


def unsaid_words(meaning: Meaning, work: str, saying: Saying) -> frozenset[str]:
    """Return codes and addresses that are not written.

    They are codes of what a pass does instead of the control; and where frames are folded into the
    words (`work`, if it is not "", is where the program then stays) those that set frames. The code
    of the work offset in which the program stays is written as it was. And they are codes that the
    target does without, and words that it does not take.
    """
    gone = {act.code for act in meaning.acts if act.name in SWITCHES}
    for act in meaning.acts if work else ():
        framing = act.name in FRAMING or saying.folds_value(act.name)
        if framing and act.code != work:
            gone |= {act.code, *(address for address, _ in act.slots)}
    for event in meaning.events if saying.crosses or saying.drop else ():
        taken = "".join(address for address, _ in event.slots)
        said = saying.instead(event.what) and not saying.lengthens(event.what)
        gone |= set() if said else {event.what}
        gone |= set(taken) - set(saying.words_of(event.what, taken))
    return frozenset(gone | {end_of_length(meaning, saying)} - {""})


def end_of_length(meaning: Meaning, saying: Saying) -> str:
    """Return the code of a block that lets go of a tool length by itself in the target, or "".

    Beside nothing that moves it may stay.
    """
    motion = meaning.groups.get("motion", "G80") != "G80"
    moves = motion or not meaning.slots.keys().isdisjoint(saying.source.axes)
    if not saying.crosses or not moves:
        return ""
    return next((act.code for act in meaning.acts if saying.ends_length_alone(act.code)), "")


def gaps_between(text: str, words: list[Word]) -> Iterator[bool]:
    """Yield, for each two words that follow one another, whether blanks are between them."""
    for one, other in pairwise(words):
        between = text[one.end : other.start]
        if not between.strip(" \t"):
            yield bool(between)


def lasts_in(statement: Statement, source: type[Dialect], target: type[Dialect]) -> bool:
    """Whether a control takes an assignment, of a number, to a parameter that outlives programs."""
    key, known, own = key_set(statement), target.flow_rule.arithmetic, source.flow_rule.arithmetic
    if key is None or known is None or not (own is None or own.owns(key)):
        return False
    return sets_number(statement) and known.can_say(key)


def needs_assignment(
    statement: Statement,
    source: type[Dialect],
    target: type[Dialect],
    drop: frozenset[str] = frozenset(),
) -> str:
    """Return what is lost without an assignment that another control cannot be told, or nothing.

    Nothing is lost where parameters end with the program, and on a control that has none: nobody
    there could read them. Which they are is known by now, but for dialects without flow words.
    """
    key, known = key_set(statement), source.flow_rule.arithmetic
    if key is not None and known is not None and known.acts(key):
        return f"the assignment to {written(key)}, which does something on the machine"
    flows = key is None and bool(source.flow_rule.language)
    flows = flows or LASTING in drop
    if target.flow_rule.arithmetic is None or known is None or flows:
        return ""
    if key is not None and not known.outlives(key):
        return ""
    name = "a parameter" if key is None else written(key)
    return f"the assignment to {name}, which lasts longer than the program"


def is_foreign(item: Item, source: type[Dialect], target: type[Dialect]) -> bool:
    """Whether an item has no place in another dialect: assignments, frames that it has not.

    A percent sign that says nothing in the source would say something in a target that has it. An
    assignment of a number to a parameter that lasts, in a control that has it, is no such item.
    """
    if isinstance(item, Statement):
        return item.kind == "assignment" and not lasts_in(item, source, target)
    if not isinstance(item, Mark):
        return False
    if item.kind == "title":
        return source is not target
    if item.kind == "block_end":  # the line end says it everywhere
        return True
    if item.kind == "percent":
        framed = source.program_rule.has_percent and target.program_rule.has_percent
        return source is not target and not framed
    return item.kind.startswith("program") and not target.program_rule.has_program_number


def says_more(items: tuple[Item, ...], ends: Set[int]) -> bool:
    """Whether a block has words but those that end a program, by the numbers of their M codes."""
    words = (item for item in items if isinstance(item, Word) and item.address != "N")
    return any(
        word.address != "M" or not isinstance(word.value, Number) or word.value.value not in ends
        for word in words
    )


def program_named(text: str, target: type[Dialect]) -> str:
    """Return the name of a program, `O<name>` or `<name>`, as a control has it."""
    bare = text.lstrip("Oo \t")
    return f"O{bare}" if target.flow_rule.language == "o-words" else bare


def event_text(event: Event, target: type[Dialect], gap: bytes) -> bytes | None:
    """Return the block that does what a cycle does between its moves; None if there is none."""
    if event.what in target.codes:
        words = (f"{a}{np.format_float_positional(v, trim='-')}" for a, v in event.values)
        return gap.join(word.encode() for word in (event.what, *words))
    if event.what != "DWELL":
        known = event.what[0] == "M" and int(event.what[1:]) in target.m_codes
        return event.what.encode() if known else None
    word = dwell_word(event.values[0][1], target)
    return b"G4" + gap + word.encode() if word else None


def dwell_word(seconds: float, target: type[Dialect]) -> str:
    """Return the word by which a control waits for a time, "" if none can say it.

    Nor can any where a setting of the control says what its G4 counts.
    """
    if "G4" not in target.codes or target.codes["G4"].effect is not Effect.DWELL:
        return ""
    for address, unit in target.point_rule.dwell.items():
        count = seconds / unit
        whole = abs(count - round(count)) < 1e-9
        if unit != 1.0 and not whole:
            continue
        number = f"{round(count)}" if unit != 1.0 else f"{seconds:.6f}".rstrip("0")
        return address + number
    return ""


def nothing_left(items: tuple[Item, ...], meaning: Meaning, manner: Manner, work: str) -> bool:
    """Whether of a block that has items nothing but its number would be written.

    That is so for parts of the program frame that the target has not, and for codes that are not
    written (`unsaid_words`).
    """
    unsaid = unsaid_words(meaning, work, manner.saying)

    def goes(item: Item) -> bool:
        if isinstance(item, Word):
            name = code_of(item) if item.address in CODES else item.address
            idle = only_for_cycles(name, manner.source, manner.target)
            return name == "N" or name in unsaid or idle
        slash = isinstance(item, Mark) and item.kind == "block_delete"
        if isinstance(item, Statement) and needs_assignment(
            item, manner.source, manner.target, manner.saying.drop
        ):
            return False
        return slash or (manner.crossing and is_foreign(item, manner.source, manner.target))

    kept = [item for item in items if not (isinstance(item, Word) and item.address == "N")]
    kept = [item for item in kept if not (isinstance(item, Mark) and item.kind == "block_delete")]
    return bool(kept) and all(goes(item) for item in items)


def left_out(item: Item, meaning: Meaning) -> bool:
    """Whether an item turns cutter compensation on, and is left out once that is resolved."""
    if not isinstance(item, Word) or not meaning.compensates:
        return False
    if item.address == "G" and isinstance(item.value, Number):
        return f"G{round(item.value.value, 6):g}" == meaning.groups["cutter-comp"]
    return item.address == "D"


def like(text: str, code: str) -> str:
    """Return a code written like another: `g01` for G3 gives `g03`."""
    letter, digits = text[0], text[1:].translate(BLANKS)
    number = code[1:]
    if digits[:1] == "0" and len(digits.split(".")[0]) == 2 and len(number.split(".")[0]) == 1:
        number = "0" + number
    return letter + number


def other_in(
    source: type[Dialect],
    target: type[Dialect],
    name: str,
    code: Code,
    meaning: Meaning,
    asked: str = "",
    taps_alike: bool = False,
) -> str:
    """Return what the target cannot say, if a G code means something else there, or nothing.

    `asked` is the code of the block, where another one is said for it.
    """
    other = target.codes.get(name)
    open_dwell = name == "G4" and code.effect is Effect.INERT  # a setting says what it counts
    if other is None or _what(other) != _what(code) or open_dwell:
        return name
    words = _words_of(meaning) if code.effect is Effect.FRAME else {*code.takes, *other.takes}
    if words & (set(code.takes) ^ set(other.takes)):
        return name
    alone = not any(act.slots for act in meaning.acts if act.code == (asked or name))
    stays = source.tool_rule.h_stays, target.tool_rule.h_stays
    if "H" in code.takes and alone and stays[0] != stays[1]:
        return f"{name} without H"
    stored = source.cutter_comp.stored, target.cutter_comp.stored
    sides = code.group == "cutter-comp" and "D" in code.takes and "D" not in meaning.slots
    if sides and stored[0] != stored[1]:  # the tool in the spindle, or the D in force
        return f"{name} without D"
    if name in TAPPING and not (taps_alike and same_tap(source, target, name, meaning)):
        return f"{name} with the spindle tied to the feed in the same way"
    if code.act == "local" and source.offset_rule.g52_is_g92 != target.offset_rule.g52_is_g92:
        return f"{name} without changing what G92 has set"
    return ""


def same_tap(source: type[Dialect], target: type[Dialect], name: str, meaning: Meaning) -> bool:
    """Whether a tapping cycle has the same moves, and the words of its block say the same."""
    rules, number = (source.cycle_rule, target.cycle_rule), int(name[1:])
    one, other = (rule.cycles.get(number) if rule else None for rule in rules)
    if one is None or other is None or replace(one, takes="") != replace(other, takes=""):
        return False
    waits = source.point_rule.dwell.get("P") == target.point_rule.dwell.get("P")
    return meaning.slots.keys().isdisjoint({*one.takes} ^ {*other.takes} | set("P" * (not waits)))


def _what(code: Code) -> tuple[str, Effect, str]:
    """Return what a code is."""
    return code.group, code.effect, code.act


def _words_of(meaning: Meaning) -> set[str]:
    """Return the addresses of all words of a block."""
    return {*meaning.slots, *(address for event in meaning.events for address, _ in event.slots)}


def foreign_cycles(
    source: type[Dialect], target: type[Dialect], in_step: bool = False
) -> frozenset[int]:
    """Return the canned cycles of a control, by number, that another has not, or as others.

    Of those that wait the same number may be another time; where that hangs on a point in it,
    who writes refuses the number. `in_step`: taps are said by another code.
    """
    rule = source.cycle_rule
    if rule is None or source is target:
        return frozenset()
    waits = source.point_rule.dwell.get("P") == target.point_rule.dwell.get("P")
    return frozenset(
        number
        for number, cycle in rule.cycles.items()
        if source.codes.get(f"G{number}") != target.codes.get(f"G{number}")
        or ("P" in cycle.needs and not waits)
        or (in_step and number in TAPS)
    )


def same_m(code: MCode, other: MCode, words: set[str]) -> bool:
    """Whether an M code of a block that has `words` does the same in another dialect.

    What builders have put there does not.
    """
    if "user" in (code.group, other.group) or code.group != other.group:
        return False
    return code.takes == other.takes or not words & {*code.takes, *other.takes}


def comment_in(target: type[Dialect], text: str) -> str:
    """Return a comment as a dialect writes it."""
    begins = target.text_rule.comments
    if text[0] in begins and (begins[0] == "(" or text[0] == begins[0]):
        return text
    inner = text[1:-1] if text[0] == "(" else text[1:]
    if target.text_rule.comments.startswith("("):
        return "(" + inner.replace("(", "[").replace(")", "]") + ")"
    return ";" + inner


def comment_for(source: type[Dialect], target: type[Dialect], text: str) -> str:
    """Return a comment for a target, which does not execute it where the source does not."""
    if target.text_rule.executes(text) and not source.text_rule.executes(text):
        text = f"{text[0]}-{text[1:]}"
    if source is not target and text[0] == "(":
        inner = text[1:].removesuffix(")")
        text = "(" + inner.replace("(", "[").replace(")", "]") + ")"
    if source is not target:
        text = text.translate({ord(each): "-" for each in target.text_rule.acts_anywhere})
    if target.text_rule.semicolon_ends and not source.text_rule.semicolon_ends and text[0] == "(":
        text = text.replace(";", ",")
    return comment_in(target, text)


def slash_of(shape: Shape, manner: Manner) -> bytes:
    """Return the slash with which the blocks of a shape may be skipped, if they have one there."""
    if not manner.slashes:
        return b""
    marks = [i for i in shape.block.items if isinstance(i, Mark) and i.kind == "block_delete"]
    return "".join(shape.block.text[mark.start : mark.end] for mark in marks).encode("latin-1")


def own_gap(shape: Shape, usual: bytes) -> bytes:
    """Return what stands between the words of a block, or what is usual in the program."""
    words = list(shape.block.words)
    if len(words) < 2:
        return usual
    return b" " if any(gaps_between(shape.block.text, words)) else b""
