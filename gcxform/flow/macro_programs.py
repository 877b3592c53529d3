"""Which programs and loops a listing of macro B has, and where a call begins one.

Programs of a file begin at their O numbers, and the first one is run; others are in files beside
it.
"""

from __future__ import annotations

from pathlib import Path

from gcxform.diagnostics import InputError
from gcxform.flow.execution import MISSING
from gcxform.flow.listing import Listing, bare
from gcxform.flow.macro_words import Loop, MacroWords, statement_of
from gcxform.flow.numbered_files import (
    begins_program,
    file_of,
    first_block,
    is_named,
    program_number,
)
from gcxform.modal.state import Reading
from gcxform.syntax.tree import BLANKS, Block, Statement

LOOPS = ("1", "2", "3")
OPEN = " that is open here"
PACKED = 10_000  # P of old controls: a count, and four digits of a program number


class MacroPrograms(MacroWords):
    """Finds programs by their numbers; those of files are added as they are called."""

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.starts: dict[int, int] = {}
        self.twice: set[int] = set()
        self.unnumbered: dict[int, int] = {}
        self.arrange()

    # --- which lines belong together ---

    def arrange(self) -> None:
        """Find programs and loops. Raises InputError for what does not fit together."""
        self.loops, self.starts, self.twice, self.bounds = {}, dict(self.unnumbered), set(), []
        self.forget_sequences()
        open_: list[tuple[int, str]] = []
        for line in self.listing.special.tolist():
            self.line = line
            if line in self.listing.seams:
                self._refuse_open(open_)
                self.bounds = [*(self.bounds or [0]), line + 1]
                continue
            block = self.listing.block(line)
            if not self.stands(block):
                continue
            if begins_program(block):
                self._refuse_open(open_)
                self.line = line
                self._begin(line, program_number(block))
            statement = statement_of(block)
            if statement is not None:
                self._place(line, statement, open_)
        self._refuse_open(open_)

    def _begin(self, line: int, number: int | None) -> None:
        """Note a program that begins; what stands before the first one is a program too."""
        if not self.bounds and self._holds_blocks(0, line):
            self.bounds.append(0)
        first, _ = self.listing.part(line)
        if first and self.bounds[-1] == first and not self._holds_blocks(first, line):
            self.bounds.pop()
        self.bounds.append(line)
        if number is None:
            return
        if number in self.starts:
            self.twice.add(number)
        self.starts[number] = line

    def _holds_blocks(self, first: int, last: int) -> bool:
        """Whether anything is done in lines up to one."""
        return any(bare(self.listing.block(line)) for line in range(first, last))

    def _place(self, line: int, statement: Statement, open_: list[tuple[int, str]]) -> None:
        """Put the begin or the end of a loop to its other half."""
        name = str(statement.tree.children[-1]).translate(BLANKS)
        if statement.kind in ("while", "do"):
            if name not in LOOPS:
                raise self.refusal("GX223", f"DO {name}: loops have the numbers 1 to 3")
            if name in (other for _, other in open_):
                raise self.refusal("GX223", f"DO {name} stands inside a loop of the same number")
            open_.append((line, name))
        elif statement.kind == "end":
            if not open_ or open_[-1][1] != name:
                raise self._unread() or self.refusal("GX223", f"END {name} ends no loop{OPEN}")
            first = open_.pop()[0]
            self.loops[first] = self.loops[line] = Loop(first, line)

    def _unread(self) -> InputError | None:
        """Return what is wrong with the last line before this one that is no block.

        It may have begun the loop that seems to be missing.
        """
        for line in range(self.line - 1, max(self.bounds, default=0) - 1, -1):
            error = self.listing.block(line).error
            if error is not None:
                message = f"this is not {self.dialect.name} G-code: {error[1]}"
                return self.listing.refusal(line, "GX101", message, "", (error[0] - 1, error[0]))
        return None

    def _refuse_open(self, open_: list[tuple[int, str]]) -> None:
        """Refuse a loop that is not closed in its program."""
        if open_:
            self.line = open_[-1][0]
            raise self.refusal("GX223", f"the loop DO {open_[-1][1]} has no END")

    # --- what a call names ---

    def called(self, block: Block) -> tuple[int, int]:
        """Return number and count of a call. Raises InputError."""
        if is_named(block):
            message = "which file the control calls by this name is not known"
            raise self.refusal("GX210", message, "call the program by its number")
        number = self.number(block, "P")
        if number % 1 != 0:
            raise self.refusal("GX221", "a call takes a number in P, and a count from 1 in L")
        return int(number), self.times_of(block)

    def times_of(self, block: Block) -> int:
        """Return the count of a call. Raises InputError."""
        times = self.number(block, "L", 1.0)
        if times % 1 != 0 or times < 1:
            raise self.refusal("GX221", "a call takes a number in P, and a count from 1 in L")
        return int(times)

    def unpacked(self, number: int, times: int, block: Block) -> tuple[int, int]:
        """Return program and count of a P that may hold both."""
        if self.dialect.program_rule.number_digits > 4:
            return number, times
        packed = number >= PACKED and self.has(number % PACKED)
        if packed and (number in self.starts or any(w.address == "L" for w in block.words)):
            raise self.refusal("GX210", "P can be read as a program, or as a count and a program")
        if not packed:
            return number, times
        target, times = number % PACKED, number // PACKED
        self.assumed[f"M98 P{number} calls O{target}, {times} times"] = None
        return target, times

    def start(self, number: int) -> int:
        """Return the first line of a program that is executed by a call."""
        if not self.has(number):
            message = f"the subprogram O{number} is not in this file, and in no file beside it"
            raise self.refusal("GX210", message, MISSING)
        if number in self.twice:
            raise self.refusal("GX223", f"there are two programs O{number}")
        if number in self.unnumbered:
            return self.unnumbered[number]
        block = self.listing.block(self.starts[number])
        if len(bare(block)) > (1 if any(block.words) else 0):
            message = f"words stand beside O{number}: whether a call executes them is not certain"
            raise self.refusal("GX210", message, "write them into a block of their own")
        return self.starts[number] + 1

    def has(self, number: int) -> bool:
        """Whether there is a program of a number, in the lines or in a file that is now added."""
        return number in self.starts or self._look_up(number)

    def _look_up(self, number: int) -> bool:
        """Add the file of a program, and return whether there is one. Raises InputError."""
        if not self.add_file(file_of(self, number)):
            return False
        if number not in self.starts:
            self.starts[number] = self.unnumbered[number] = first_block(self.listing)
            name = Path(self.listing.files[-1].name).name
            self.assumed[f"{name} has no O number, and is O{number}, as its name says"] = None
        return True
