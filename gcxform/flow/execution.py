"""Executing a listing: what every control does that has subprograms, whatever it writes them with.

A run holds the line that comes next, the parameters, the calls that have not returned, and the
blocks that were executed. What a flow word or a call does is that of a subclass.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.dialect.arithmetic import Arithmetic, Key, NoValueError, whole
from gcxform.flow.lasting_values import Lasting
from gcxform.flow.listing import CODES_OF_CALLS, STORED_MODES, Listing, bare
from gcxform.flow.text import DECIMALS, decimal
from gcxform.flow.uncalled_subprograms import Definition, kept
from gcxform.modal.expressions.value import Evaluator, LocatedError, parameter_key, settable
from gcxform.modal.lines import DISTANCES
from gcxform.modal.numbers_without_point import assumed_rounding, hint_of_rounding
from gcxform.modal.state import Reading
from gcxform.syntax.tree import Block, Comment, Expression, Mark, Number, Statement, Word
from gcxform.system.limits import how_to_raise, limits

BYTES_AT_MOST = 1 << 28  # of executed blocks
NAMED = 5  # of the calls that a refusal stands in
UNKNOWN = math.nan
HINT = "let the CAM write plain blocks, or use passes that keep positions"


Edit = tuple[int, int, str]
"""Columns of a block, from 0, and what stands there instead."""


@dataclass(slots=True)
class Call:
    """A call that has not returned: the line it goes on at, and what is put back then.

    `times` are the runs that are left, `first` the first line of the subprogram, `name` what
    called it by.
    """

    name: str
    back: int
    first: int = 0
    times: int = 1
    locals: dict[Key, float] = field(default_factory=dict)
    counters: dict[int, int] = field(default_factory=dict)


class Execution:
    """One run of a program; `text` and `origin` are the executed blocks and their lines.

    `deepest` are the calls that may be inside each other. `keeps`: the blocks are to be written, so
    what lasts in parameters and what nothing calls stands in them; otherwise they are only read.
    """

    deepest: ClassVar[int] = 100

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        assert listing.dialect.arithmetic is not None
        self.listing = listing
        self.dialect = listing.dialect
        self.arithmetic: Arithmetic = listing.dialect.arithmetic
        self.reading = reading
        self.keeps = keeps
        given = {parameter_key(name): v for name, v in reading.parameters.items()}
        self.parameters = {k: v for k, v in given.items() if self.arithmetic.owns(k)}
        self.calls: list[Call] = []
        self.at = 0
        self.line = 0
        self.ended = self.acted = False
        self.skipped: set[int] = set()
        self.percents = 0
        self.text: list[bytes] = []
        self.origin: list[np.ndarray[Any, np.dtype[np.int64]]] = []
        self.steps = self.size = self.changes = 0
        self.rounds: dict[int, int] = {}
        self.assumed: dict[str, None] = {}
        self.inch = (reading.units or self.dialect.initial["units"]) in ("in", "G20")
        self.seen = 0
        self.lasting = Lasting(self)
        self.times = np.zeros(len(listing), np.int64)
        self.kept: tuple[Definition, ...] = ()

    # --- the walk ---

    def run(self) -> None:
        """Execute the program to its end. Raises InputError where that cannot be done."""
        special = self.listing.special
        while not self.ended and self.at < len(self.listing):
            following = int(np.searchsorted(special, self.at))
            stop = int(special[following]) if following < len(special) else len(self.listing)
            if stop > self.at:
                self._copy(stop)
            else:
                self._step()
        self._closing()

    def _copy(self, stop: int) -> None:
        """Take plain lines over as they stand."""
        self._put(self.listing.raw(self.at, stop), np.arange(self.at, stop))
        self.times[self.at : stop] += 1
        self.at = stop

    def _step(self) -> None:
        """Execute one line that is more than a plain block."""
        self.line, self.at = self.at, self.at + 1
        self.times[self.line] += 1
        self._count()
        self._refuse_lone_cr()
        block = self.listing.block(self.line)
        if self._skips(block):
            self.skipped.add(self.line)
            self._copy_line()
        elif block.error is None and self.act(block):
            self.acted = True
        else:
            self.write(block)

    def _refuse_lone_cr(self) -> None:
        """Refuse a line that the control would take together with the next one."""
        if self.dialect.lone_cr_is_blank and self.listing.line_end(self.line) == b"\r":
            message = f"the line ends with CR alone, which {self.dialect.name} reads as a blank"
            hint = "convert the line ends of the file to LF or CRLF"
            raise self.listing.refusal(self.line, "GX102", message, hint)

    def _copy_line(self) -> None:
        self._put(self.listing.raw(self.line, self.line + 1), np.array([self.line]))

    def _skips(self, block: Block) -> bool:
        """Whether the control skips the line; a slash on one that decides something is refused."""
        if not _has_slash(block):
            return False
        policy = self.reading.block_delete or self.dialect.block_delete
        if not policy:
            message = "a switch of the control decides whether this block is executed"
            hint = 'block-delete = "execute" in [input], or block-delete = "skip" in [input]'
            raise self.listing.refusal(self.line, "GX211", message, hint)
        return policy == "skip"

    def stands(self, block: Block) -> bool:
        """Whether a line counts where lines are put together: not if it is skipped."""
        policy = self.reading.block_delete or self.dialect.block_delete
        return not (policy == "skip" and _has_slash(block))

    def _put(self, text: bytes, lines: np.ndarray[Any, np.dtype[np.int64]]) -> None:
        if text and not text.endswith((b"\n", b"\r")):
            text += b"\n"
        self.text.append(text)
        self.origin.append(lines)
        self.size += len(text)

    def write_line(self, text: str) -> None:
        """Write a block that the line stands for."""
        self._put(text.encode("latin-1") + self.listing.line_end(self.line), np.array([self.line]))

    def _count(self) -> None:
        """Count executed lines. Raises InputError for a program that does not end."""
        self.steps += 1
        if self.steps > limits().steps or self.size > BYTES_AT_MOST:
            message = f"the program is not over after {self.steps} lines that decide something"
            raise self.refusal("GX224", message, f"does this loop end? {how_to_raise('steps')}")

    def back_to(self, line: int) -> None:
        """Go back to a line. Raises InputError if nothing has changed since the last time."""
        if self.rounds.get(self.line) == self.changes:
            message = "nothing changes from one round of this loop to the next: it has no end"
            raise self.refusal("GX224", message)
        self.rounds[self.line] = self.changes
        self.at = line

    def set(self, values: Mapping[Key, float]) -> None:
        """Give parameters their values."""
        self.changes += any(self.parameters.get(k) != v for k, v in values.items())
        self.parameters.update(values)

    def _closing(self) -> None:
        """Write what stands behind the end of the program.

        That are the definitions that nothing has called, which other programs may call, and the
        last percent sign, which the control reads.
        """
        self.kept = kept(self) if self.acted and self.keeps else ()
        for each in self.kept:
            lines = np.arange(each.first, each.last + 1)
            self._put(self.listing.raw(each.first, each.last + 1), lines)
        last = len(self.listing) - 1
        while last > 0 and not self.listing.window.line(last).strip():
            last -= 1
        if self.ended and last > self.line and self.listing.meaning(last).percent:
            self._put(self.listing.raw(last, last + 1), np.array([last]))

    # --- what differs between controls ---

    def entered(self) -> Iterator[tuple[int, int]]:
        """Yield first and last line of the loops and branches, whether they were entered or not."""
        return iter(())

    def leaves(self, line: int, first: int, last: int) -> bool:
        """Whether a line of a loop or branch may go on elsewhere than behind it."""
        return self._ends(self.listing.block(line))

    def definitions(self) -> Iterator[Definition]:
        """Yield the subprograms of the file that a call can name, in order."""
        return iter(())

    @abstractmethod
    def callees(self, line: int) -> frozenset[str] | None:
        """Return the names of the subprograms that a line calls; None: it may be any of them."""

    @abstractmethod
    def act(self, block: Block) -> bool:
        """Do what a line decides about the order of execution; return whether that was all."""

    # --- calls ---

    def refuse_more(self, items: list[Word | Statement], addresses: str) -> None:
        """Refuse a block that calls or returns and does anything else, or has a word twice."""
        found = [item.address for item in items if isinstance(item, Word)]
        alone = len(found) == len(items) == len(set(found)) and set(found) <= set(addresses)
        if not alone:
            raise self.refusal("GX210", "something else stands in a block that calls or returns")

    def enter(self, call: Call) -> None:
        """Begin a subprogram."""
        if len(self.calls) >= self.deepest:
            raise self.refusal("GX224", f"{self.deepest} calls are inside each other, and one more")
        self.calls.append(call)
        self.at = call.first

    # --- blocks ---

    def write(self, block: Block) -> None:
        """Write a block out with the values of its expressions, and do its assignments."""
        meaning = self.listing.meaning(self.line)
        if meaning.refusal is not None and not self.becomes_other(block):
            refusal = meaning.refusal
            place = (refusal.column, refusal.column + refusal.width)
            raise self.refusal(refusal.code, refusal.message, refusal.hint, place)
        edits = self.edits(block)
        self.acted |= self.becomes_other(block)
        statements = _statements(block)
        changes = [self._assigned(statement) for statement in statements]
        self.set(dict(changes))
        for statement, change in zip(statements, changes, strict=True):
            edits.append((statement.start, statement.end, self.lasting.account(*change)))
        edits += self.lasting.messages(block)
        if edits:
            self._write_changed(block, edits)
        else:
            self._copy_line()
        if meaning.runs_macro and not meaning.lost_by <= self.reading.inert_m:
            self._forget()
        self.percents += meaning.percent
        self.ended |= self.percents > 1 or self._ends(block)

    def _forget(self) -> None:
        """Forget all parameters, those too that callers get back: a macro may have set them."""
        self.parameters = dict.fromkeys(self.parameters, UNKNOWN)
        for call in self.calls:
            call.locals = dict.fromkeys(call.locals, UNKNOWN)

    def edits(self, block: Block) -> list[Edit]:
        """Return the pieces of a block that are written otherwise: its values."""
        return [
            (word.value.start, word.value.end, self._written(word))
            for word in block.words
            if _computed(word)
        ]

    def becomes_other(self, block: Block) -> bool:
        """Whether a block cannot be judged before it is written out: a computed G or M code."""
        return any(_computed(word) and word.address in "GM" for word in block.words)

    def _ends(self, block: Block) -> bool:
        """Whether the program is over after a block."""
        codes = [w.value.value for w in block.words if w.address == "M"]
        known = [self.dialect.m_codes.get(int(c)) for c in codes if c == c]  # nan: computed
        over = any(code is not None and code.ends for code in known)
        return over and self.dialect.stops_at_end

    def _write_changed(self, block: Block, edits: list[Edit]) -> None:
        """Write a block whose expressions have become numbers; one of which nothing is left not."""
        words = [item for item in bare(block) if isinstance(item, Word)]
        active = [i for i in block.items if isinstance(i, Comment) and self._executes(block, i)]
        kept = [new for start, _, new in edits if any(start == i.start for i in _statements(block))]
        if not words and not active and not any(kept):
            return
        text = block.text
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        self.write_line(text.rstrip())

    def _executes(self, block: Block, comment: Comment) -> bool:
        return self.dialect.executes(block.text[comment.start : comment.end])

    # --- values ---

    def value(self, node: Any, conditions: bool = False) -> float:
        """Return the value of an expression of the line. Raises InputError."""
        arithmetic = self.conditions if conditions else self.arithmetic
        try:
            return Evaluator(arithmetic, self.parameters).value(node)
        except LocatedError as why:
            raise self.refusal(why.code, why.message, why.hint, (why.start, why.end)) from None

    @property
    def conditions(self) -> Arithmetic:
        """The arithmetic of conditions."""
        return self.arithmetic

    def number(self, block: Block, address: str, default: float = UNKNOWN) -> float:
        """Return the value of the word with an address, or the default."""
        for word in block.words:
            if word.address == address:
                value = word.value
                return self.value(value.tree) if isinstance(value, Expression) else value.value
        return default

    def _written(self, word: Word) -> str:
        """Return the value of a word that is computed, as it is written."""
        assert isinstance(word.value, Expression)
        evaluator = Evaluator(self.arithmetic, self.parameters, in_word=True)
        try:
            value = evaluator.value(word.value.tree)
            length = self.listing.meaning(self.line).is_length(word.address)
            if word.address in self.arithmetic.whole and not length:
                value = float(whole(value, self.arithmetic.whole_slip))
            if word.address in "GM":
                value = whole(value * 10) / 10
                self._refuse_flow(word, value)
        except NoValueError as why:
            start, end = (
                (why.start, why.end) if isinstance(why, LocatedError) else (word.start, word.end)
            )
            raise self.refusal(why.code, why.message, why.hint, (start, end)) from None
        if self.dialect.feed_point_required and word.address == "F":
            message = "F is computed: its unit depends on the control"
            raise self.refusal("GX205", message, place=(word.start, word.end))
        if self.dialect.point_required and word.address in DISTANCES:
            return self._on_increment(word, value)
        return decimal(value).removesuffix(".")

    def _refuse_flow(self, word: Word, value: float) -> None:
        """Refuse a computed M code that decides what is executed next, and a computed unit."""
        if word.address == "G" and value in (20, 21) and self.dialect.point_required:
            message = f"G{value:g} is the unit of what is computed, and is computed itself"
            raise self.refusal("GX206", message, "write the code", (word.start, word.end))
        code = self.dialect.m_codes.get(int(value)) if word.address == "M" else None
        if code is not None and (code.ends or value in CODES_OF_CALLS or value in STORED_MODES):
            message = f"M{value:g} decides what is executed, and is computed: it must be written"
            raise self.refusal("GX206", message, place=(word.start, word.end))

    def _on_increment(self, word: Word, value: float) -> str:
        """Return a distance as the control rounds it."""
        inch, said = self._inch(), self.reading.increments
        steps = None if said is None else said.per_unit(word.address, inch)
        if said is None or steps is None:
            message = f"{word.address} is computed: to what it is rounded depends on the control"
            hint = hint_of_rounding(word.address, inch)
            raise self.refusal("GX205", message, hint, (word.start, word.end))
        self.assumed[assumed_rounding(word.address, inch, said)] = None
        count = math.floor(abs(value) * steps + 0.5)
        return decimal(math.copysign(round(count / steps, DECIMALS), value))

    def _inch(self) -> bool:
        """Whether the line is in inches, behind the blocks that have been written."""
        fresh, self.seen = self.origin[self.seen :], len(self.origin)
        for lines in (*fresh, np.array([self.line])):
            said = self.listing.units[lines]
            said = said[said >= 0]
            self.inch = bool(said[-1]) if len(said) else self.inch
        return self.inch

    def _assigned(self, statement: Statement) -> tuple[Key, float]:
        """Return a parameter and its new value."""
        return self.assignment(statement.tree, (statement.start, statement.end))

    def assignment(self, tree: Any, place: tuple[int, int]) -> tuple[Key, float]:
        """Return the parameter that a tree sets, and its value. Raises InputError."""
        parameter, expression = tree.children
        evaluator = Evaluator(self.arithmetic, self.parameters)
        try:
            return settable(self.arithmetic, evaluator.key(parameter)), evaluator.value(expression)
        except LocatedError as why:
            place, error = (why.start, why.end), why
        except NoValueError as why:
            error = why  # type: ignore[assignment]
        raise self.refusal(error.code, error.message, error.hint, place)

    def located(self, error: InputError) -> InputError:
        """Return an error about executed blocks as one about the lines of the program."""
        lines = np.concatenate(self.origin)
        return InputError(
            tuple(
                d.at(replace(d.where, line=int(lines[d.where.line - 1]) + 1)) if d.where else d
                for d in error.diagnostics
            )
        )

    def refusal(
        self, code: str, message: str, hint: str = "", place: tuple[int, int] | None = None
    ) -> InputError:
        """Return the error about the line that is executed."""
        error = self.listing.refusal(self.line, code, message, hint, place)
        if not self.calls:
            return error
        names = [call.name for call in reversed(self.calls)]
        inside = " in ".join(names[:NAMED] + ["..."] * (len(names) > NAMED))
        found = tuple(replace(d, context=f"called by {inside}") for d in error.diagnostics)
        return InputError(found)


def _statements(block: Block) -> list[Statement]:
    return [item for item in block.items if isinstance(item, Statement)]


def _computed(word: Word) -> bool:
    return isinstance(word.value, Expression)


def _has_slash(block: Block) -> bool:
    return any(isinstance(item, Mark) and item.kind == "block_delete" for item in block.items)


def whole_number(word: Word) -> int | None:
    """Return the whole number that a word was written with; None for another."""
    value = word.value.value if isinstance(word.value, Number) else UNKNOWN
    return int(value) if value == value and value % 1 == 0 else None
