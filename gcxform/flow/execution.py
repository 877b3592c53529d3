"""Executing a listing: what every control does that has subprograms, whatever it writes them with.

What a flow word or a call does is that of a subclass.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from typing import ClassVar

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.flow.lasting_values import Lasting
from gcxform.flow.listing import Definition, Listing, bare
from gcxform.flow.lookup import Found, LookupFailedError, only
from gcxform.flow.residual import Edit
from gcxform.flow.run_state import UNKNOWN, Call, RunState, computed, has_slash
from gcxform.flow.text import as_named
from gcxform.flow.walk import Step, Walk, split
from gcxform.modal.expressions.value import Evaluator, forgotten
from gcxform.modal.state import Reading
from gcxform.syntax.tree import Block, Comment, Statement, Word
from gcxform.syntax.undecided import DECIDED, Undecided
from gcxform.system.limits import how_to_raise, limits

BYTES_AT_MOST = 1 << 28  # of executed blocks
MOST_FILES = 1000  # that one program calls
HINT = "let the CAM write plain blocks, or use passes that keep positions"
MISSING = f"say where it lies by --subprograms DIR or subprograms in [input]; or {HINT}"
"""The way out where a subprogram is not found."""


class Execution(RunState):
    """One run of a program; `deepest` are the calls that may be inside each other."""

    deepest: ClassVar[int] = 100

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.at = 0
        self.ended = self.acted = False
        self.executed = 0
        self.alarm: int | None = None
        self.skipped: set[int] = set()
        self.percents = 0
        self.steps = self.entries = 0
        self.rounds: dict[int, int] = {}
        self.lasting = Lasting(self)
        self.times = np.zeros(len(listing), np.int64)
        self.kept: tuple[Definition, ...] = ()
        self.deciding: set[int] = set()
        self.asked: dict[int, set[int]] = {}
        self.jumps: set[int] = set()
        self.tied = ""

    # --- the walk ---

    def run(self) -> None:
        """Execute the program to its end. Raises InputError where that cannot be done."""
        while not self.ended and self.at < len(self.listing):
            if self.at in self.listing.seams:
                self._leave_file()
                break
            if self.begins():
                continue
            special = self.listing.special  # more with every file that is called
            following = int(np.searchsorted(special, self.at))
            stop = int(special[following]) if following < len(special) else len(self.listing)
            before, line = self.blocks, self.at
            plain = stop > self.at
            behind = min(stop, self.next_stop()) if plain else self.at + 1
            level = self.levels_of_values()
            self.walked.append(Step(self.at, behind, self.blocks, len(self.calls), level))
            if plain:
                self._copy(behind)
            else:
                self._step()
            self.is_done(line, before)

    def begins(self) -> bool:
        """Do what is to be done before a line; return whether nothing is left to do there."""
        return False

    def steady(self) -> bool:
        """Whether lines do what they did before, wherever in the executed blocks they stand."""
        return True

    def decides(self, line: int) -> bool:
        """Whether a line does more than its words, calls, codes and statements say."""
        del line
        return False

    def next_stop(self) -> int:
        """Return the next line behind the one that is executed before which something is done."""
        return len(self.listing)

    def is_done(self, line: int, before: int) -> None:
        """Do what is to be done behind a line, before which so many lines were written."""

    def _leave_file(self) -> None:
        """Come to the end of a file: that of the program is its end, that of another is refused."""
        if self.at > self.listing.own:
            self.line = self.at - 1
            message = "the file of a subprogram ends here, without a return to what has called it"
            raise self.refusal("GX223", message)

    def levels_of_values(self) -> int:
        """Count the calls that have parameters of their own: not those by M97 and M98."""
        return sum(call.given is not None or not call.name.startswith("M9") for call in self.calls)

    def _copy(self, stop: int) -> None:
        """Take plain lines over as they stand."""
        self.put(self.listing.raw(self.at, stop), np.arange(self.at, stop))
        self.times[self.at : stop] += 1
        self.at = stop

    def _step(self) -> None:
        """Execute one line that is more than a plain block."""
        self.line, self.at = self.at, self.at + 1
        self.times[self.line] += 1
        if self.line > self.listing.own and self.listing.meaning(self.line).percent:
            self._leave_file()
        self._count()
        self._refuse_lone_cr()
        line, block = self.line, self.listing.block(self.line)
        if self._skips(block):
            self.skipped.add(self.line)
            self.copy_line()
        elif block.error is None and self.act(block):
            self.acted = True
            self.deciding.add(line)
        else:
            self.write(block)

    def _refuse_lone_cr(self) -> None:
        """Refuse a line that the control would take together with the next one."""
        if self.dialect.text_rule.lone_cr_is_blank and self.listing.line_end(self.line) == b"\r":
            message = f"the line ends with CR alone, which {self.dialect.name} reads as a blank"
            hint = "convert the line ends of the file to LF or CRLF"
            raise self.listing.refusal(self.line, "GX102", message, hint)

    def copy_line(self) -> None:
        """Take the line over as it stands."""
        self.put(self.listing.raw(self.line, self.line + 1), np.array([self.line]))

    def _skips(self, block: Block) -> bool:
        """Whether the control skips the line; a slash on one that decides something is refused."""
        if not has_slash(block):
            return False
        policy = self.reading.blocks_with_a_slash(self.dialect)
        if not policy:
            message = "a switch of the control decides whether this block is executed"
            hint = 'block-delete = "execute" in [input], or block-delete = "skip" in [input]'
            raise self.listing.refusal(self.line, "GX211", message, hint)
        return policy == "skip"

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

    def close(self, kept: tuple[Definition, ...]) -> None:
        """Write what stands behind the end of the program.

        That are the definitions in `kept`, which other programs may call, and the last percent
        sign, which the control reads. Without an end there is no place for any of them: they can
        only stand where they are.
        """
        self.kept = kept
        self.close_branches()
        self.executed = self.blocks
        for each in self.behind:
            lines = np.arange(each.first, each.last + 1)
            self.put(self.listing.raw(each.first, each.last + 1), lines)
        last = self.listing.own - 1
        while last > 0 and not self.listing.window.line(last).strip():
            last -= 1
        if self.ended and not self.times[last] and self.listing.meaning(last).percent:
            self.put(self.listing.raw(last, last + 1), np.array([last]))

    @property
    def behind(self) -> tuple[Definition, ...]:
        """What is kept behind the end of the program; nothing if that has none."""
        return self.kept if self.ended else ()

    def walk(self, callees: Mapping[int, tuple[Definition, ...]]) -> Walk:
        """Return what was done, once the program is closed."""
        steps, jumps, made = split(self.walked.table, self.jumps, self.lasting.made)
        return Walk(
            self.listing,
            steps,
            self.executed,
            tuple(dict.fromkeys(self.entered())),
            tuple(each for each in self.definitions() if each.first < self.listing.own),
            self.kept,
            callees,
            tuple(self._called_files()),
            frozenset(self.deciding),
            self.asked,
            jumps,
            made,
            self.tied,
            self.times,
            self.arithmetic,
            self.settled.needed if self.keeps else frozenset(),
        )

    def _called_files(self) -> Iterator[Definition]:
        for file in self.listing.files:
            first, behind = self.listing.part(file.first)
            yield Definition(file.name, first, behind - 1)

    def close_branches(self) -> None:
        """Write what only the machine may come to, behind the end."""

    def undecided(self) -> Undecided:
        """Return what of the executed lines only the machine decides."""
        return DECIDED

    def is_over(self, block: Block) -> bool:
        """Whether the program is over after a block."""
        return self._ends(block)

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
    def arrange(self) -> None:
        """Find which lines belong together, anew. Raises InputError for what does not fit."""

    @abstractmethod
    def callees(self, line: int) -> frozenset[str] | None:
        """Return the names of the subprograms that a line calls; None: it may be any of them."""

    @abstractmethod
    def act(self, block: Block) -> bool:
        """Do what a line decides about the order of execution; return whether that was all."""

    # --- calls ---

    def add_file(self, found: Found | None) -> bool:
        """Put the file of a subprogram behind the lines there are; return whether there is one."""
        if found is None:
            return False
        if len(self.listing.files) >= MOST_FILES:
            raise self.refusal("GX224", f"{MOST_FILES} files are called, and one more")
        self.listing = self.listing.with_file(found)
        more = len(self.listing) - len(self.times)
        self.times = np.concatenate([self.times, np.zeros(more, np.int64)])
        line = self.line
        self.arrange()
        self.line = line
        return True

    def found(self, files: Iterator[Found], what: str) -> list[Found]:
        """Return the files that were looked up. Raises InputError where one cannot be taken."""
        try:
            return list(files)
        except LookupFailedError as why:
            raise self.refusal("GX227", f"{what}: {why}") from None

    def only(self, found: list[Found], what: str) -> Found | None:
        """Return the file that was found, if any. Raises InputError for two that differ."""
        try:
            return only(found, what)
        except LookupFailedError as why:
            raise self.refusal("GX227", str(why)) from None

    def refuse_more(self, items: list[Word | Statement], addresses: str) -> None:
        """Refuse a block that calls or returns and does anything else, or has a word twice."""
        found = [item.address for item in items if isinstance(item, Word)]
        if len(found) != len(items) or sorted(found) != sorted({*found} & {*addresses}):
            message = "something else stands in a block that calls or returns"
            raise self.refusal("GX210", message, "write the call into a block of its own")

    def enter(self, call: Call) -> None:
        """Begin a subprogram."""
        if len(self.calls) >= self.deepest:
            raise self.refusal("GX224", f"{self.deepest} calls are inside each other, and one more")
        self.calls.append(call)
        self.entries += 1
        call.serial = self.entries
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
        changes = [self.assignment(each.tree, (each.start, each.end)) for each in statements]
        texts = [self.kept_assignment(*both) for both in zip(statements, changes, strict=True)]
        for change in changes:
            self.set(self.arithmetic.behind(*change))
        for statement, change, text in zip(statements, changes, texts, strict=True):
            made = self.lasting.account(*change, text)
            edits.append((statement.start, statement.end, as_named(statement, change[0], made)))
        edits += self.lasting.messages(block)
        self.lasting.outputs.before(block)
        edits = [(start, end, new) for start, end, new in edits if block.text[start:end] != new]
        if edits:
            self._write_changed(block, edits)
        else:
            self.copy_line()
        if meaning.runs_macro and not meaning.lost_by <= self.reading.inert_m:
            self._forget()
        self.percents += meaning.percent
        self.ended |= self.percents > 1
        self.stop(block)

    def stop(self, block: Block) -> None:
        """Note that nothing is executed behind a block that ends the program."""
        self.ended |= self._ends(block)

    def kept_assignment(self, statement: Statement, change: tuple[Key, float]) -> str:
        """Return what stays of an assignment that only the machine can make; "" for another."""
        if self.arithmetic.owns(change[0]) and change[1] == change[1]:
            return ""
        return self.remains(statement, Evaluator(self.arithmetic, self.parameters))

    def _forget(self) -> None:
        """Forget all parameters, those too that callers get back: a macro may have set them."""
        called = bool(self.listing.meaning(self.line).call)
        self.parameters = forgotten(self.parameters, self.arithmetic, called)
        for call in () if called else self.calls:
            call.locals = dict.fromkeys(call.locals, UNKNOWN)

    def edits(self, block: Block) -> list[Edit]:
        """Return the pieces of a block that are written otherwise: its values."""
        return [self._edit(word) for word in block.words if computed(word)]

    def _edit(self, word: Word) -> Edit:
        """Return a word with its value; one whose value is null is left out."""
        text = (
            self.handed_over(word) if self.listing.meaning(self.line).call else self.written(word)
        )
        self.acted |= not text
        if text:
            return (word.value.start, word.end, text)
        rest = self.listing.window.line(self.line)[word.end :]
        return (word.start, word.end + len(rest) - len(rest.lstrip(b" \t")), "")

    def becomes_other(self, block: Block) -> bool:
        """Whether a block cannot be judged before it is written out: a computed G or M code."""
        return any(computed(word) and word.address in "GM" for word in block.words)

    def _ends(self, block: Block) -> bool:
        """Whether the program is over after a block."""
        codes = [w.value.value for w in block.words if w.address == "M"]
        known = [self.dialect.m_codes.get(int(c)) for c in codes if c == c]  # nan: computed
        over = any(code is not None and code.ends for code in known)
        return over and self.dialect.program_rule.stops_at_end

    def _write_changed(self, block: Block, edits: list[Edit]) -> None:
        """Write a block whose expressions have become numbers; one of which nothing is left not."""
        gone = {start for start, _, new in edits if not new}
        words = [i for i in bare(block) if isinstance(i, Word | Statement) and i.start not in gone]
        active = [i for i in block.items if isinstance(i, Comment) and self._executes(block, i)]
        if not words and not active:
            return
        text = block.text
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        self.write_line(text.rstrip())

    def _executes(self, block: Block, comment: Comment) -> bool:
        return self.dialect.text_rule.executes(block.text[comment.start : comment.end])


def _statements(block: Block) -> list[Statement]:
    return [item for item in block.items if isinstance(item, Statement)]
