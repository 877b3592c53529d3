"""What a run of a program holds at each moment, and what expressions are worth there.

That is the line that is executed, the parameters, the calls that have not returned, and the blocks
that were executed so far.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from collections.abc import Set as AbstractSet
from dataclasses import field, replace
from typing import Any, ClassVar

import numpy as np

from gcxform.catalogue.questions import questions
from gcxform.diagnostics import InputError
from gcxform.dialect.arithmetic import Arithmetic, Key, NoValueError, whole
from gcxform.dialect.increments import coarse
from gcxform.dialect.null import NULL, Null
from gcxform.flow.listing import CODES_OF_CALLS, STORED_MODES, Listing
from gcxform.flow.rerun import Again, Settled
from gcxform.flow.residual import Edit, edited, residual
from gcxform.flow.text import DECIMALS, decimal
from gcxform.flow.walk import Steps
from gcxform.modal.expressions.compiled import NO_VALUE, Compiled, Compiler
from gcxform.modal.expressions.unknown import may_be_unknown
from gcxform.modal.expressions.value import (
    DOUBTFUL,
    Evaluator,
    LocatedError,
    given_to,
    has_computed,
    parameters_in,
    settable,
)
from gcxform.modal.lines import DISTANCES
from gcxform.modal.numbers_without_point import assumed_rounding, hint_of_rounding
from gcxform.modal.state import Reading
from gcxform.syntax.tree import Block, Expression, Mark, Number, Statement, Word
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

NAMED = 5  # of the calls that a refusal stands in
UNKNOWN = math.nan


@dataclass(slots=True)
class Call:
    """A call that has not returned: the line it goes on at, and what is put back then.

    `times` are the runs that are left, `first` the first line of the subprogram, `name` what
    called it by. A call with values has variables of its own: `given` are those that it was given.
    `serial` counts the calls of a run; `modal` is the number of the G66 that has made it, from 1.
    """

    name: str
    back: int
    first: int = 0
    times: int = 1
    locals: dict[Key, float] = field(default_factory=dict)
    counters: dict[int, int] = field(default_factory=dict)
    given: dict[Key, float] | None = None
    serial: int = 0
    modal: int = 0


class RunState:
    """Where a run is; `text` and `origin` are the executed blocks and their lines.

    `keeps`: the blocks are to be written, so what lasts in parameters and what nothing calls stands
    in them; otherwise they are only read.
    """

    doubtful: ClassVar[float] = DOUBTFUL

    def __init__(self, listing: Listing, reading: Reading, keeps: bool) -> None:
        assert listing.dialect.flow_rule.arithmetic is not None
        self.listing = listing
        self.dialect = listing.dialect
        self.arithmetic: Arithmetic = listing.dialect.flow_rule.arithmetic
        self.reading = reading
        self.keeps = keeps
        self.parameters = given_to(self.arithmetic, reading)
        self.settled = Settled()
        self.dropped: set[Key] = set()
        self.calls: list[Call] = []
        self.line = 0
        self.text: list[bytes] = []
        self.origin: list[Ints] = []
        self.size = self.blocks = self.changes = 0
        self.walked = Steps()
        self.assumed: dict[str, None] = {}
        self.inch = (reading.units or self.dialect.initial["units"]) in ("in", "G20")
        self.seen = 0
        self._functions: dict[tuple[int, int, bool], tuple[Compiled, Any]] = {}  # and their trees

    def set(self, values: Mapping[Key, float]) -> None:
        """Give parameters their values."""
        self.changes += any(differs(self.parameters.get(k), v) for k, v in values.items())
        self.parameters.update(values)

    def put(self, text: bytes, lines: Ints) -> None:
        """Take executed lines, from 0, with what is written for them."""
        if text and not text.endswith((b"\n", b"\r")):
            text += b"\n"
        self.text.append(text)
        self.origin.append(lines)
        self.blocks += len(lines)
        self.size += len(text)

    def write_line(self, text: str) -> None:
        """Write a block that the line stands for."""
        self.put(text.encode("latin-1") + self.listing.line_end(self.line), np.array([self.line]))

    def stands(self, block: Block) -> bool:
        """Whether a line counts where lines are put together: not if it is skipped."""
        policy = self.reading.blocks_with_a_slash(self.dialect)
        return not (policy == "skip" and has_slash(block))

    # --- values ---

    def value(self, node: Any, conditions: bool = False) -> float:
        """Return the value of an expression of the line. Raises InputError."""
        arithmetic = self.conditions if conditions else self.arithmetic
        try:
            return self._worth(arithmetic, node)
        except LocatedError as why:
            raise self.refusal(why.code, why.message, why.hint, (why.start, why.end)) from None

    def value_or_lost(self, node: Any) -> float | None:
        """Return the value of a condition of the line; None if only the machine knows it."""
        try:
            return self._worth(self.conditions, node)
        except LocatedError as why:
            if why.lost:
                return None
            raise self.refusal(why.code, why.message, why.hint, (why.start, why.end)) from None

    def _worth(self, arithmetic: Arithmetic, node: Any, in_word: bool = False) -> float:
        """Return what a node is worth, by a function made once. Raises NoValueError."""
        names = id(node), id(arithmetic), in_word
        made = self._functions.get(names)
        if made is None:
            made = Compiler(arithmetic, None, in_word).compiled(node), node
            self._functions[names] = made
        try:
            return float(made[0](self.parameters, ()))
        except NO_VALUE:
            return Evaluator(arithmetic, self.parameters, in_word).value(node)

    @property
    def conditions(self) -> Arithmetic:
        """The arithmetic of conditions."""
        return self.arithmetic

    def number(self, block: Block, address: str, default: float = UNKNOWN) -> float:
        """Return the value of the word with an address, or the default."""
        for word in block.words:
            if word.address == address:
                value = word.value
                if not isinstance(value, Expression):
                    return value.value
                found = self.value(value.tree)
                return default if found is NULL else found
        return default

    def written(self, word: Word) -> str:
        """Return the value of a word that is computed, as it is written; "" for null."""
        assert isinstance(word.value, Expression)
        try:
            value = self._worth(self.arithmetic, word.value.tree, in_word=True)
            if isinstance(value, Null):
                return _vanished(value, word)
            length = self.listing.meaning(self.line).is_length(word.address)
            if word.address in self.arithmetic.whole and not length:
                value = float(whole(value, self.arithmetic.whole_slip))
            if word.address in "GM":
                value = whole(value * 10) / 10
                self._refuse_flow(word, value)
        except NoValueError as why:
            if why.lost and word.address not in "GM":
                evaluator = Evaluator(self.arithmetic, self.parameters, in_word=True)
                return self.remains(word.value, evaluator)
            start, end = (
                (why.start, why.end) if isinstance(why, LocatedError) else (word.start, word.end)
            )
            raise self.refusal(why.code, why.message, why.hint, (start, end)) from None
        return self.spelled(word, [value])[0]

    def spelled(self, word: Word, values: list[float]) -> list[str]:
        """Return values of a word of the line as they are written."""
        if self.dialect.point_rule.feed_required and word.address == "F":
            return [decimal(value) for value in values]
        if self.dialect.point_rule.required and word.address in DISTANCES:
            return self._on_increment(word, values)
        return [decimal(value).removesuffix(".") for value in values]

    def handed_over(self, word: Word) -> str:
        """Return the value of a word of a call that is kept, in all its digits.

        One that only the machine knows stays as it stands, if its variables outlive the program.
        """
        assert isinstance(word.value, Expression)
        tree = word.value.tree
        try:
            value = Evaluator(self.arithmetic, self.parameters).value(tree)
        except LocatedError as why:
            if why.lost and all(self.arithmetic.outlives(key) for key in parameters_in(tree)):
                return self.listing.block(self.line).text[word.value.start : word.end]
            raise self.refusal(why.code, why.message, why.hint, (why.start, why.end)) from None
        if isinstance(value, Null):
            message = f"whether a call is handed 0 or null in {word.address} is not certain"
            raise self.refusal("GX221", message, "leave it out", (word.start, word.end))
        return decimal(value)

    def _refuse_flow(self, word: Word, value: float) -> None:
        """Refuse a computed M code that decides what is executed next, and a computed unit."""
        if word.address == "G" and value in (20, 21) and self.dialect.point_rule.required:
            message = f"G{value:g} is the unit of what is computed, and is computed itself"
            raise self.refusal("GX206", message, "write the code", (word.start, word.end))
        code = self.dialect.m_codes.get(int(value)) if word.address == "M" else None
        if code is not None and (code.ends or value in CODES_OF_CALLS or value in STORED_MODES):
            message = f"M{value:g} decides what is executed, and is computed: it must be written"
            raise self.refusal("GX206", message, place=(word.start, word.end))

    def rounds_openly(self, word: Word) -> bool:
        """Whether it is not known to what a word that is computed is rounded."""
        said = self.reading.increments
        known = said is not None and said.per_unit(word.address, self.in_inch()) is not None
        return self.dialect.point_rule.required and word.address in DISTANCES and not known

    def _on_increment(self, word: Word, values: list[float]) -> list[str]:
        """Return distances as the control rounds them."""
        inch, said = self.in_inch(), self.reading.increments
        steps = None if said is None else said.per_unit(word.address, inch)
        if said is None or steps is None:
            same = [coarse(value, word.address, inch) for value in values]
            if not any(map(math.isnan, same)):
                return [decimal(value) for value in same]
            keeps = may_be_unknown(word.address, self.listing.meaning(self.line))
            if keeps and not self.reading.crosses:
                return [self._as_it_stands(word)] * len(values)
            message = f"{word.address} is computed: to what it is rounded depends on the control"
            hint = hint_of_rounding(word.address, inch)
            raise self.refusal("GX205", message, hint, (word.start, word.end))
        self.assumed[assumed_rounding(word.address, inch, said)] = None
        if not all(math.isfinite(value * steps) for value in values):
            raise self.refusal("GX221", f"{word.address} is too large", "", (word.start, word.end))
        counts = [math.floor(abs(value) * steps + 0.5) for value in values]
        return [
            decimal(math.copysign(round(count / steps, DECIMALS), value))
            for count, value in zip(counts, values, strict=True)
        ]

    def _as_it_stands(self, word: Word) -> str:
        """Return the text of a value that the control rounds as nobody has said; see `needs`.

        Parameters of a call become what they are worth: outside of it their names mean others. It
        stays an expression, as a number would not be rounded.
        """
        assert isinstance(word.value, Expression)
        keys = set(parameters_in(word.value.tree))
        if self.level() and not all(map(self.arithmetic.outlives, keys)):
            evaluator = Evaluator(self.arithmetic, self.parameters, in_word=True)
            text = self.remains(word.value, evaluator)
            return text if text[0] == "[" else f"[{text}]"
        self.needs(keys | (self.dropped if has_computed(word.value.tree) else set()))
        return self.listing.block(self.line).text[word.value.start : word.value.end]

    def in_inch(self) -> bool:
        """Whether the line is in inches, behind the blocks that have been written."""
        fresh, self.seen = self.origin[self.seen :], len(self.origin)
        for lines in (*fresh, np.array([self.line])):
            said = self.listing.units[lines]
            said = said[said >= 0]
            self.inch = bool(said[-1]) if len(said) else self.inch
        return self.inch

    def assignment(self, tree: Any, place: tuple[int, int]) -> tuple[Key, float]:
        """Return the parameter that a tree sets, and its value: nan if only the machine knows it.

        Raises InputError.
        """
        parameter, expression = tree.children
        evaluator = Evaluator(self.arithmetic, self.parameters)
        key: Key | None = None
        try:
            key = settable(self.arithmetic, evaluator.key(parameter))
            return key, self._worth(self.arithmetic, expression)
        except NoValueError as why:
            if why.lost and key is not None:
                return key, UNKNOWN
            if isinstance(why, LocatedError):
                place = why.start, why.end
            raise self.refusal(why.code, why.message, why.hint, place) from None

    # --- what only the machine can compute ---

    def remains(self, item: Expression | Statement, evaluator: Evaluator) -> str:
        """Return what stays of an expression, an assignment or a flow word, as text.

        Raises Again if what it reads was left out before.
        """
        text = self.listing.block(self.line).text
        return edited(text, item.start, item.end, self.left_of(item, evaluator))

    def left_of(self, item: Expression | Statement, evaluator: Evaluator) -> list[Edit]:
        """Return the edits of what stays; see `remains`."""
        try:
            left = residual(item.tree, evaluator)
        except LocatedError as why:
            raise self.refusal(why.code, why.message, why.hint, (why.start, why.end)) from None
        self.needs(self.dropped if left.anywhere else left.reads)
        return left.edits

    def needs(self, keys: AbstractSet[Key]) -> None:
        """See to it that assignments to parameters stay. Raises Again if one was left out."""
        reads = keys & self.dropped
        if self.keeps and not reads <= self.settled.needed:
            raise Again(replace(self.settled, needed=self.settled.needed | reads))

    def is_jumped_to(self) -> bool:
        """Whether a jump that only the machine decides leads to what is written next."""
        return False

    def level(self) -> int:
        """Return the number of the call whose parameters end with it; 0 for the program itself."""
        own = [call.serial for call in self.calls if not call.name.startswith("M9")]
        return max(own, default=0)

    # --- refusals ---

    def located(self, error: InputError) -> InputError:
        """Return an error about executed blocks as one about the lines of the program."""
        lines = np.concatenate(self.origin)
        found = []
        for each in error.diagnostics:
            if each.where is not None:
                file, line = self.listing.place(int(lines[each.where.line - 1]))
                each = each.at(replace(each.where, file=file, line=line))
            found.append(each)
        return InputError(tuple(found))

    def refusal(
        self, code: str, message: str, hint: str = "", place: tuple[int, int] | None = None
    ) -> InputError:
        """Return the error about the line that is executed."""
        if self._asks_for_local(hint):
            hint = "set it in the subprogram, or give it with the call"
        error = self.listing.refusal(self.line, code, message, hint, place)
        if not self.calls:
            return error
        names = [self._told(call) for call in reversed(self.calls)]
        inside = ", by ".join(names[:NAMED] + ["..."] * (len(names) > NAMED))
        found = tuple(replace(d, context=f"called by {inside}") for d in error.diagnostics)
        return InputError(found)

    def _asks_for_local(self, hint: str) -> bool:
        """Whether a hint asks for a parameter that the call made anew: no start says its value."""
        asked = (question for question, _ in questions(hint) if self.calls)
        names = [name[0].strip("<>") for _, key, *name in asked if key == "parameters"]
        local = self.arithmetic.local if self.level() else ()
        return any(int(n) in local if n.isdecimal() else not n.startswith("_") for n in names)

    def _told(self, call: Call) -> str:
        """Return a call with its place; it goes on at the line behind that."""
        file, line = self.listing.place(call.back - 1)
        return f"{call.name} at {file}:{line}"


def differs(before: float | None, now: float) -> bool:
    """Whether a parameter has changed; null is not 0."""
    return before != now or isinstance(before, Null) is not isinstance(now, Null)


def _vanished(value: Null, word: Word) -> str:
    """Return what is written for a word of null, which is nothing. Raises NoValueError."""
    if not value.certain or word.address == "G":
        message = f"whether {word.address} is 0 here, or left out as its value is null"
        raise NoValueError(f"{message}, is not certain", "write the block without it")
    return ""


def computed(word: Word) -> bool:
    """Whether the value of a word is an expression."""
    return isinstance(word.value, Expression)


def has_slash(block: Block) -> bool:
    """Whether a switch of the control decides if a block is executed."""
    return any(isinstance(item, Mark) and item.kind == "block_delete" for item in block.items)


def whole_number(word: Word) -> int | None:
    """Return the whole number that a word was written with; None for another."""
    value = word.value.value if isinstance(word.value, Number) else UNKNOWN
    return int(value) if value == value and value % 1 == 0 else None
