"""Sorts the codes of a block into modal groups and gives its words to their owners.

This is done once per shape, by plain code; the interpreter then works on whole columns. Everything
that can be refused without knowing the numbers is found here.
"""

from __future__ import annotations

from collections.abc import Container, Iterator

from gcxform.dialect.codes import Code, Effect, MCode
from gcxform.dialect.dialect import LINEAR, Dialect
from gcxform.modal.meaning.asides import ASIDE, read_aside
from gcxform.modal.meaning.calls import ELSEWHERE, calling, not_there, read_call
from gcxform.modal.meaning.choices import choices_of
from gcxform.modal.meaning.corner_words import corner_word
from gcxform.modal.meaning.lathe import lathe_signs
from gcxform.modal.meaning.meaning import (
    ACT_ORDER,
    DRILL_WORDS,
    TAKES_MOTION,
    Act,
    EventShape,
    Meaning,
    Refusal,
)
from gcxform.modal.meaning.numbered import (
    code_of,
    length_number,
    offset_word,
    spindle_number,
    table_acts,
    tool_number,
)
from gcxform.modal.meaning.percent import behind_percent, is_dropped
from gcxform.modal.meaning.printed import is_output, print_hangs_on, prints_values, read_output
from gcxform.modal.meaning.statements import read_statement, stands_alone
from gcxform.modal.meaning.too_many import drops_move, too_many
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import CODES, Comment, Expression, Mark, Number, Statement, Word

BEHIND_AN_END = "; ends a block: what is behind it is another line, and a comment stands in ( )"
TO_THE_CONSOLE = "$ begins a command for the console of a control, and no block: send it before"
BY_A_TABLE = (
    "on a table that turns it is followed where the machine file says its axes, by passes that "
    "make no positions of axes of tips, nor the reverse"
)
CENTRE = "IJK"
COMMENT = 0
"""The order of comments that are executed: LinuxCNC does so before all else in the block."""
LENT = "DIJKLPQR"
"""Words of which a block has one value for all of its codes, its move among them."""


def meaning_of(shape: Shape, dialect: type[Dialect]) -> Meaning:
    """Return what the blocks of a shape mean in a dialect."""
    meaning = Meaning()
    for refusal in _read(shape, dialect, meaning):
        meaning.refusal = refusal
        break
    return meaning


def _read(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Fill the meaning and yield what speaks against it, in the order in which it is looked for."""
    word = calling(shape, dialect)
    if word is not None:
        yield from read_call(shape, word, dialect, meaning)
        return
    if shape.block.error is not None:
        column, message = shape.block.error
        message = f"this is not {dialect.name} G-code: {message}"
        hint = BEHIND_AN_END if "';'" in message else ""
        hint = TO_THE_CONSOLE if "'$'" in message and column == 1 else hint
        yield Refusal("GX101", column - 1, 1, message, hint)
    yield from lathe_signs(shape, dialect)
    yield from _items(shape, dialect, meaning)
    yield from _g_codes(shape, dialect, meaning)
    yield from _m_codes(shape, dialect, meaning)
    yield from _number_first(shape, dialect)
    yield from corner_word(shape, dialect, meaning)
    yield from _words(shape, dialect, meaning)
    meaning.bars_comp = _bars_comp(shape, dialect, meaning)
    meaning.choices = choices_of(shape, dialect, meaning)
    meaning.events.sort(key=lambda event: (event.after, event.order))
    meaning.acts.sort(key=lambda act: ACT_ORDER.index(act.name))


def _items(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Look at what is not a word, and number the slots."""
    slot = 0
    for item in shape.block.items:
        if isinstance(item, Word):
            if isinstance(item.value, Expression):
                yield from _expression(item, dialect)
                meaning.expressions.append((slot, item))
            if item.address not in CODES:
                if item.address in meaning.slots and item.address != "N":
                    yield Refusal("GX203", item.start, 1, f"{item.address} stands here twice")
                meaning.slots.setdefault(item.address, slot)
                slot += 1
        elif isinstance(item, Statement):
            yield from read_statement(item, shape, dialect)
            meaning.assignments.append(item)
            meaning.acts += table_acts(item, dialect)
        elif isinstance(item, Mark):
            yield from _mark(item, shape, dialect, meaning)
        elif isinstance(item, Comment):
            yield from _comment(item, shape, dialect, meaning)


def _mark(item: Mark, shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Look at a sign of the frame of a program, or at what is sent out."""
    meaning.marked = True
    meaning.deleted |= item.kind == "block_delete"
    meaning.percent |= item.kind == "percent" and not is_dropped(shape, dialect)
    if item.kind == "percent" and dialect.program_rule.has_percent:
        yield from behind_percent(item, shape, dialect)
    if item.kind == "program_name" and not stands_alone(item, shape):
        size = item.end - item.start
        yield Refusal("GX203", item.start, size, "a name of a program stands by itself")
    if item.kind == ASIDE:
        yield from read_aside(item, shape, dialect, meaning)
    if is_output(item):
        yield from read_output(item, shape.block, dialect, meaning)


def _comment(
    item: Comment, shape: Shape, dialect: type[Dialect], meaning: Meaning
) -> Iterator[Refusal]:
    """Turn a comment that is executed into an event."""
    text = shape.block.text[item.start : item.end]
    if text[0] not in dialect.text_rule.comments:
        yield Refusal("GX101", item.start, 1, f"{dialect.name} has no such comments")
    if dialect.text_rule.executes(text):
        inner = text[1:].removesuffix(")") if text[0] == "(" else text[1:]
        meaning.events.append(EventShape(COMMENT, f"({inner})"))
        if prints_values(text):
            meaning.prints = meaning.prints or print_hangs_on(text, dialect)


def _expression(word: Word, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse a word whose value cannot be computed."""
    if dialect.flow_rule.arithmetic is None:
        message = f"the value of {word.address} is an expression, which is not computed"
    elif word.address in CODES or word.address == "N":
        message = f"{word.address} is followed by an expression: which one it is must be written"
    else:
        return
    hint = "let the CAM write plain numbers, or use passes that keep positions"
    yield Refusal("GX206", word.start, word.end - word.start, message, hint)


def _g_codes(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Sort the G codes into their groups."""
    owners: dict[str, Word] = {}
    for word in shape.block.words:
        if word.address != "G" or not isinstance(word.value, Number):
            continue
        name = code_of(word)
        code = dialect.codes.get(name)
        width = word.end - word.start
        if code is None:
            yield not_there(word, name, dialect)
            continue
        if not dialect.block_rule.g80_beside_motion:
            pass
        elif "G80" in (name, meaning.groups.get(code.group)) and name != "G80":
            owners.pop(code.group, None)  # beside another motion code G80 says nothing
        elif name == "G80" and code.group in owners and meaning.groups[code.group] != "G80":
            continue
        if code.group in owners and not dialect.block_rule.last_code_wins:
            yield Refusal(
                "GX202",
                word.start,
                width,
                f"{name} and {code_of(owners[code.group])} are of one modal group",
            )
        owners[code.group] = word
        meaning.groups[code.group] = name
        yield from _unresolved(name, code, word, dialect.tip_rule.planes)
    if meaning.groups.get("cycle", "G80") != "G80" and "motion" in meaning.groups:
        word = owners["cycle"]
        message = f"{meaning.groups['cycle']} beside {meaning.groups['motion']}"
        yield Refusal("GX202", word.start, word.end - word.start, message)
    yield from _g_effects(dialect, meaning, owners)


def _unresolved(name: str, code: Code, word: Word, planes: Container[str]) -> Iterator[Refusal]:
    """Refuse barriers, and calls that do not begin their block; `planes` a table may follow."""
    width = word.end - word.start
    if code.effect is Effect.CALL:
        message = f"in what order {name} and the words in front of it act is not certain"
        hint = "write the call in a block of its own"
        yield Refusal("GX210", word.start, width, message, hint)
    if code.effect is Effect.BARRIER:
        hint = BY_A_TABLE if name in planes else ""
        yield Refusal("GX210", word.start, width, f"{name} is not resolved: {code.reason}", hint)


def _g_effects(
    dialect: type[Dialect], meaning: Meaning, owners: dict[str, Word]
) -> Iterator[Refusal]:
    """Turn dwell and inert codes into events."""
    for group, name in list(meaning.groups.items()):
        code = dialect.codes[name]
        modal = code.effect is Effect.MODAL
        taken = () if modal and group != "motion" else _take(name, code, dialect, meaning)
        if modal:
            continue
        lengths = LINEAR if code.effect is Effect.FRAME else code.lengths
        meaning.lengths += [(name, a, slot) for a, slot in taken if a in lengths]
        if code.effect is Effect.DWELL:
            meaning.dwell = True
            if not taken:
                hint = f"write it with {' or '.join(dialect.point_rule.dwell)}"
                yield Refusal("GX204", owners[group].start, 2, f"{name} needs a time", hint)
            elif taken[1:]:
                yield Refusal("GX203", owners[group].start, 2, f"{name} has two times")
            meaning.events.append(EventShape(50, "DWELL", taken))
        else:
            meaning.events.append(EventShape(60, name, taken, code.after))
            if code.effect is Effect.FRAME:
                yield from _g_act(dialect, meaning, code, owners[group], taken)


def _g_act(
    dialect: type[Dialect],
    meaning: Meaning,
    code: Code,
    word: Word,
    taken: tuple[tuple[str, int], ...],
) -> Iterator[Refusal]:
    """Note what a code does to the frame; refuse it beside a motion that wants its words."""
    name, width = code_of(word), word.end - word.start
    meaning.acts.append(Act(code.act, name, taken, word.start, width))
    if code.act == "length-add" and any(axis in meaning.slots for axis in dialect.axes):
        yield Refusal("GX202", word.start, width, f"{name} takes H or axis words, not both")
    motion = meaning.groups.get("motion", "G80") != "G80"
    moves = motion or not meaning.slots.keys().isdisjoint(dialect.axes)
    if code.act == "no-length" and dialect.tool_rule.g49_takes_axes and moves:
        message = f"{name} takes the axis words here, and has no use for them"
        yield Refusal("GX202", word.start, width, message, "move in a block of its own")
    wants = code.act in TAKES_MOTION and "motion" in meaning.groups
    if dialect.block_rule.one_action and wants and not _leaves_words(dialect, meaning, code, taken):
        message = f"{name} and {meaning.groups['motion']} both want the axis words"
        yield Refusal("GX202", word.start, width, message)


def _leaves_words(
    dialect: type[Dialect], meaning: Meaning, code: Code, taken: tuple[tuple[str, int], ...]
) -> bool:
    """Whether the motion code of a block is G80 and leaves its axis words to another code."""
    if meaning.groups["motion"] != "G80" or code.act == "length-vector":
        return False
    words = {*meaning.slots, *(address for address, _ in taken)}
    return dialect.block_rule.g80_beside_motion or words.isdisjoint(dialect.axes)


def _take(
    name: str, code: Code | MCode, dialect: type[Dialect], meaning: Meaning
) -> tuple[tuple[str, int], ...]:
    """Take the words that are parameters to a code away from the block."""
    letters = code.takes
    if isinstance(code, Code) and code.effect is Effect.DWELL:
        letters = "".join(dialect.point_rule.dwell)
    taken = tuple((a, meaning.slots[a]) for a in letters if a in meaning.slots)
    for address, _ in taken:
        del meaning.slots[address]
    if isinstance(code, MCode) or code.effect is not Effect.FRAME:
        meaning.lent |= {address: name for address, _ in taken if address in LENT}
    return taken


def _m_codes(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Turn M codes into events."""
    groups: dict[str, str] = {}
    yield from too_many(shape, dialect)
    for word in shape.block.words:
        if word.address != "M" or not isinstance(word.value, Number):
            continue
        name, width = code_of(word), word.end - word.start
        code = dialect.m_codes.get(int(word.value.value), dialect.block_rule.unknown_m)
        if code is None or word.value.value % 1:
            yield Refusal(
                "GX201", word.start, width, f"{dialect.name} has no code {name}", ELSEWHERE
            )
            continue
        if code.group in groups and not dialect.block_rule.last_code_wins:
            message = f"{name} and {groups[code.group]} are of one modal group"
            yield Refusal("GX202", word.start, width, message)
        groups[code.group] = name
        if code.group in ("spindle", "extrusion"):
            meaning.groups[code.group] = name
        if code.barrier:
            called = dialect.tip_rule.spelled.get(name, name)
            yield Refusal("GX210", word.start, width, f"{called} is not resolved: {code.barrier}")
        meaning.ends |= code.ends
        if code.loses_position:
            meaning.loses_position = True
            own = code.group in ("user", "tool")  # of others nobody can say that they move nothing
            meaning.lost_by.add(int(word.value.value) if own else -1)
        meaning.runs_macro |= code is dialect.block_rule.unknown_m
        meaning.changes_tool |= code.group == "tool"
        order = {"tool": 30, "spindle": 40, "coolant": 41, "override": 42}.get(code.group, 43)
        taken = _take(name, code, dialect, meaning)
        if code.act:
            meaning.acts.append(Act(code.act, name, taken, word.start, width))
        meaning.events.append(EventShape(order, name, taken, code.after))


def only_for_cycles(name: str, source: type[Dialect], target: type[Dialect]) -> bool:
    """Whether a code is about cycles alone (G80, G98, G99), and the target gets no cycle.

    That is so where the target has no cycles, or calls them otherwise: those of the source are then
    refused, or have become plain moves.
    """
    if name not in ("G80", "G98", "G99") or source.codes.get(name) == target.codes.get(name):
        return False
    return source.codes.get("G81") != target.codes.get("G81")


def program_number_fits(word: Word, dialect: type[Dialect]) -> bool:
    """Whether the control can hold a program number."""
    digits = dialect.program_rule.number_digits
    return not digits or not isinstance(word.value, Number) or word.value.value < 10**digits


def _lacking(word: Word, dialect: type[Dialect]) -> Refusal | None:
    """Return why the control does not have a word, None if it does."""
    address, width = word.address, word.end - word.start
    known = address in dialect.axes or address in dialect.block_rule.words or address in CODES
    known |= address in {f",{letter}" for letter in dialect.motion_rule.corners}
    if not known or (address == "O" and not dialect.program_rule.has_program_number):
        message = f"{dialect.name} has no word {address}"
        if address[0] == ",":
            message = f"what {address} puts into the corner on a {dialect.name} is not known"
        return Refusal("GX201", word.start, width, message)
    if address == "O" and not program_number_fits(word, dialect):
        digits = dialect.program_rule.number_digits
        message = f"{dialect.name} has program numbers of at most {digits} digits"
        return Refusal("GX201", word.start, width, message)
    return None


def _bars_comp(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> tuple[str, str]:
    """Return a code that is refused while compensation is on before the block, and after it."""
    sorted_codes = [(name, group) for group, name in meaning.groups.items()]
    for word in shape.block.words:
        if word.address == "M" and isinstance(word.value, Number):
            code = dialect.m_codes.get(int(word.value.value), dialect.block_rule.unknown_m)
            sorted_codes += [(code_of(word), code.group)] if code else []
    rule = dialect.cutter_comp
    before = [name for name, group in sorted_codes if group in rule.before]
    after = [name for name, group in sorted_codes if group in rule.after and name != "G4"]
    return "".join(before[:1]), "".join(after[:1])


def _number_first(shape: Shape, dialect: type[Dialect]) -> Iterator[Refusal]:
    """Refuse a sequence number behind something else where the control wants it first."""
    items = [item for item in shape.block.items if not isinstance(item, Mark)]
    for item in items[1:]:
        if isinstance(item, Word) and item.address == "N" and dialect.block_rule.number_first:
            message = f"{dialect.name} takes a sequence number only at the head of a block"
            yield Refusal("GX203", item.start, item.end - item.start, message)


def _words(shape: Shape, dialect: type[Dialect], meaning: Meaning) -> Iterator[Refusal]:
    """Give the remaining words to motion, feed, spindle and tool; what is left over is refused."""
    slots = meaning.slots
    spindle_number(shape, dialect, meaning)
    length_number(shape, dialect, meaning)
    yield from tool_number(shape, dialect, meaning)
    for address, order in (("S", 10), ("T", 20)):
        if address in slots:
            event = EventShape(order, address, ((address, slots[address]),))
            meaning.events.append(event)
    meaning.axes = "".join(a for a in dialect.axes if a in slots)
    meaning.centres = "".join(a for a in CENTRE if a in slots)
    if meaning.dwell and meaning.axes and set(dialect.point_rule.dwell) & set(dialect.axes):
        message = "a dwell and axis words in one block"
        yield Refusal("GX203", 0, len(shape.block.text), message, "write two blocks")
    if name := drops_move(meaning, dialect):
        message = f"beside {name} this control leaves the move of a block out"
        yield Refusal("GX202", 0, len(shape.block.text), message, "write two blocks")
    motion = {*meaning.axes, *meaning.centres, *"FNRST", dialect.arc_rule.turns}
    motion |= offset_word(dialect, meaning) | {meaning.corner}
    for word in shape.block.words:
        address = word.address
        if (lacking := _lacking(word, dialect)) is not None:
            yield lacking
        elif address in slots and address in DRILL_WORDS and dialect.cycle_rule is not None:
            meaning.drill_words += "" if address in motion else address
        elif address in slots and address not in motion:
            message = f"{address} belongs to no code of this block"
            yield Refusal("GX203", word.start, word.end - word.start, message)
    if meaning.percent and not dialect.program_rule.has_percent:
        yield Refusal("GX201", 0, 1, f"{dialect.name} has no % sign")
