"""Fanuc and its relatives: M98, M97 and M99, GOTO, IF and WHILE of macro B.

What M98 calls has the local variables of its caller (Fanuc macro executor B-62093E-1 p. 32, 30i
executor B-63943EN-2 p. 105); G65 makes new ones (`gcxform/flow/macro_calls.py`). Modes stay as what
was called leaves them.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from gcxform.flow.listing import Definition, Listing, bare
from gcxform.flow.macro_calls import BY, T_VALUE, ValueCalls
from gcxform.flow.macro_programs import PACKED, MacroPrograms
from gcxform.flow.macro_words import statement_of
from gcxform.flow.modal_calls import BEGINS, ENDS, Modal, ModalCalls
from gcxform.flow.numbered_files import begins_program, program_number
from gcxform.flow.run_state import UNKNOWN, Call, computed, whole_number
from gcxform.flow.state_read import ALL, NAMES, StateRead
from gcxform.flow.subprogram_file import returns
from gcxform.flow.words_first import are_certain, of_call, without
from gcxform.modal.meaning.tables import COLUMNS
from gcxform.modal.state import Reading
from gcxform.syntax.tree import Block, Number, Statement, Word

CALLING = frozenset({"M98", "M198", "G65", "G66", "G66.1", "computed"})
"""What calls a program by its number, or may do so."""


class MacroB(MacroPrograms):
    """Runs programs of Fanuc, Haas and their relatives."""

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.values = ValueCalls(self)
        self.modals = ModalCalls(self, self._modal_call)
        self.state = StateRead(self, self.branches)
        self.state_is_read = False

    # --- what lines do ---

    def act(self, block: Block) -> bool:
        """Do what flow words and calls do."""
        if begins_program(block) and self.line != self.bounds[0]:
            message = "the program before goes on into this one, without M30 or M99"
            raise self.refusal("GX223", message)
        self._read_state(block)
        statement = statement_of(block)
        if statement is not None:
            getattr(self, f"_{statement.kind}")(statement)
            return True
        items = bare(block)
        words = [item for item in items if isinstance(item, Word)]
        alias = self.values.alias(words)
        if alias and self.values.shares(alias[0]):
            self._call_sharing(block, items, *alias)
            return True
        if alias or (
            words and words[0] is items[0] and self.values.levels and _code(words[0]) == "G65"
        ):
            self._refuse_assignments(len(words) < len(items))
            return self._call_with_values(block, words, *(alias or ()))
        if self._is_modal(block, words):
            self._refuse_assignments(len(words) < len(items))
            return True
        codes = {whole_number(i) for i in items if isinstance(i, Word) and i.address == "M"}
        if 98 in codes or (97 in codes and self.dialect.flow_rule.calls_own_lines):
            self._call(block, items, own=97 in codes)
            return True
        if 99 in codes and self.dialect.flow_rule.m99_jumps and _has(block, "P"):
            self._go_on_at(block, items)
            return True
        if 99 in codes and self.calls:
            self._return(block, items)
            return True
        if 99 in codes:
            self._refuse_beginning_anew(block)
            line = self.listing.place(self.line)[1]
            what = f"M99 in line {line} stands in no call: it returns, or begins the program anew"
            self.assumed[what] = None
        return False

    def _read_state(self, block: Block) -> None:
        """Give the variables their values that say modes and where the axes stand."""
        if NAMES.search(block.text):
            found = self.state.values()
            self.parameters |= found
            self.state_is_read = True
            if any(value == value for value in found.values()):
                self.acted = True
                self.tied = "modes or positions are read (#4001 to #4120, #5001 to #5003)"
        elif self.state_is_read:
            self.parameters |= dict.fromkeys(ALL, UNKNOWN)

    def decides(self, line: int) -> bool:
        """Whether a line reads modes, or where the axes stand."""
        return NAMES.search(self.listing.window.line(line).decode("latin-1")) is not None

    def _refuse_beginning_anew(self, block: Block) -> None:
        """Refuse M99 outside a call where this program goes on in a state that it has left.

        A file without another end is a subprogram by itself, and read as one.
        """
        first, last = self._program()
        special = (n for n in self.listing.special.tolist() if first <= n < last)
        if any(
            self.listing.meaning(n).ends and not returns(self.listing.block(n)) for n in special
        ):
            message = "M99 outside a call, in a program that ends as well: it begins anew here"
            hint = "let the program end with M30 alone, or transform the one that calls it"
            raise self.refusal("GX226", message, hint)
        to = self.number(block, "P")
        if any(first <= line < last for line in self._sequences.get(to, ())):
            message = f"M99 P{to:g} goes to N{to:g} of this program, or of one that has called it"
            raise self.refusal("GX210", message, "rename N, or transform the program that calls it")

    # --- subprograms ---

    def entered(self) -> Iterator[tuple[int, int]]:
        """Yield the lines of DO and END of the loops."""
        return ((loop.first, loop.last) for loop in self.loops.values())

    def leaves(self, line: int, first: int, last: int) -> bool:
        """Whether a line jumps, returns, or ends the program; IF THEN may do so by an alarm."""
        block = self.listing.block(line)
        statement = statement_of(block)
        jumps = statement is not None and statement.kind in ("goto", "if_goto", "if_then")
        returns = any(w.address == "M" and whole_number(w) == 99 for w in block.words)
        return jumps or returns or super().leaves(line, first, last)

    def definitions(self) -> Iterator[Definition]:
        """Yield the programs of the file behind the first, which is the one that runs."""
        own = [line for line in self.bounds if line < self.listing.own]
        for line, after in pairwise([*own[1:], None]):
            assert line is not None
            number = program_number(self.listing.block(line))
            name = "a program without a number" if number is None else f"O{number}"
            yield Definition(name, line, self.listing.last_of(line, after))

    def callees(self, line: int) -> frozenset[str] | None:
        """Return the programs that M98, G65 or a relative names; P may hold a count as well."""
        block = self.listing.block(line)
        codes = {_code(word) for word in block.words if word.address in "GM"}
        if block.error is None and not codes & CALLING:
            return frozenset()
        numbers = [whole_number(word) for word in block.words if word.address == "P"]
        if len(numbers) != 1 or numbers[0] is None:
            return None
        return frozenset(f"O{number}" for number in (numbers[0], numbers[0] % PACKED))

    def _execute_words(self, block: Block) -> bool:
        """Execute the words beside a call or a return; return whether there are any."""
        mine = of_call(block)
        if not mine or not self.dialect.flow_rule.words_first:
            return False
        waits = self.modals.open or self.branches.open or self.branches.over
        if waits or not are_certain(block, mine, self.dialect) or self.becomes_other(block):
            return False
        if len(mine) > 1 and self.state.in_cycle():
            raise self.refusal("GX210", "P and L may be those of the cycle that is on, or of M98")
        values = [self._edit(word) for word in block.words if computed(word) and word not in mine]
        self._write_changed(block, [*values, *without(block, mine)])
        return True

    def _call(self, block: Block, items: list[Word | Statement], own: bool) -> None:
        if not self._execute_words(block):
            self.refuse_more(items, "MPL")
        target, times = self.called(block)
        name = f"M98 P{target}"
        if own:
            first, name = self.labelled(target), f"M97 P{target}"
            if self._around(first):
                raise self.refusal("GX223", f"N{target} stands inside a loop that is not running")
            self.jumps.add(len(self.walked) - 1)
        else:
            target, times = self.unpacked(target, times, block)
            first = self.start(target)
        self.enter(Call(name, self.at, first, times))

    def _call_sharing(
        self, block: Block, items: list[Word | Statement], name: str, number: int
    ) -> None:
        """Call the program of a code, with the variables of its caller."""
        self.refuse_more(items, name[0])
        first = self.start(number)
        if name == "T":
            value = self.number(block, "T")
            self.set({T_VALUE: value})
            if text := self.lasting.account(T_VALUE, value):
                self.write_line(text)
        self.enter(Call(f"M98 P{number}{BY}{name}", self.at, first))

    def _call_with_values(
        self, block: Block, words: list[Word], name: str = "", number: int = 0
    ) -> bool:
        """Call a program with variables of its own; return whether there is one to be called.

        `name` is a code that calls the program of a `number`; without it P says which.
        """
        times = self.times_of(block)
        if not name:
            number = self.called(block)[0]
            if not self.has(number):
                return False
        call = self.values.made_by(name or f"G65 P{number}", words[1:], times, self.at)
        call.first = self.start(number)
        self.enter(call)
        self.values.give(call)
        return True

    def _refuse_assignments(self, stand: bool) -> None:
        """Refuse assignments that stand in a block which calls: what it does with them is open."""
        if stand:
            message = "whether the assignment beside this call acts before it is not certain"
            raise self.refusal("GX206", message, "write it into a block of its own")

    # --- modal calls ---

    def _is_modal(self, block: Block, words: list[Word]) -> bool:
        """Begin or end a modal call; return whether that was all of the block."""
        name = _code(words[0]) if words and words[0] is bare(block)[0] else ""
        if name not in self.dialect.codes or name not in (BEGINS, ENDS):
            ends = any(_code(word) == ENDS for word in words)
            return ends and self.modals.end(words)
        if self.branches.open:
            message = f"only the machine knows whether this {name} is executed"
            raise self.refusal("GX220", message)
        if name == ENDS:
            return self.modals.end(words)
        number, times = self.called(block)
        given = self.values.made_by(f"{name} P{number}", words[1:], times, self.at).given or {}
        first = self.start(number)
        self.tied = "moves call a program (G66)"
        self.modals.begin(Modal(f"{name} P{number}", first, times, given, len(self.calls)))
        return True

    def _modal_call(self, modal: Modal) -> Call:
        """Return a call that a block with a movement makes."""
        call = self.values.with_values(modal.name, dict(modal.given), modal.times, self.at)
        call.first = modal.first
        return call

    def steady(self) -> bool:
        """Whether no move calls a program, and nothing reads the state of the control."""
        return not (self.modals.open or self.state_is_read) and super().steady()

    def next_stop(self) -> int:
        """Return the next line to which a jump may lead, or behind which a program is called."""
        stop = super().next_stop()
        if not self.modals.open:
            return stop
        window, table = self.listing.window, self.listing.table
        shapes = window.shape[self.at : stop]
        moves = table.flag("moves", shapes) | table.flag("own_moves", shapes)
        for name in ("motion", "cycle"):
            moves |= table.groups[shapes, COLUMNS.index(name)] >= 0
        return self.at + int(np.argmax(moves)) + 1 if moves.any() else stop

    def is_done(self, line: int, before: int) -> None:
        """Call what is to be called behind a block with a movement."""
        super().is_done(line, before)
        if not self.modals.open or self.blocks == before or self.ended:
            return
        last = self.origin[-1][-1]
        call = self.modals.called_behind(int(last), self._written_words())
        if call is not None:
            self.enter(call)
            self.values.give(call)

    def _written_words(self) -> list[Word]:
        """Return the words of the block that was written last."""
        text = self.text[-1].splitlines()[-1].decode("latin-1")
        return list(self.dialect.load_grammar().parse(text).words)

    def _return(self, block: Block, items: list[Word | Statement]) -> None:
        if not self._execute_words(block):
            self.refuse_more(items, "MP")
        call = self.calls[-1]
        call.times -= 1
        if call.times:
            if _has(block, "P"):
                raise self.refusal("GX210", "M99 goes to a line, and the call is not over")
            self._begin_again(call)
            return
        self.calls.pop()
        if call.given is not None:
            self.values.take_back(call)
        self.at = call.back
        if _has(block, "P"):
            target = self.number(block, "P")
            self.line = call.back - 1
            self._jump(target)

    def _go_on_at(self, block: Block, items: list[Word | Statement]) -> None:
        """Jump to the line that M99 P names, of its own program (Haas 96-8000 p. 118)."""
        self.refuse_more(items, "MP")
        self._jump(self.number(block, "P"))

    def _begin_again(self, call: Call) -> None:
        """Execute a subprogram once more."""
        self.values.again(call)
        self.changes += 1
        self.at = call.first


def _has(block: Block, address: str) -> bool:
    """Whether a block has a word."""
    return any(word.address == address for word in block.words)


def _code(word: Word) -> str:
    """Return a G or M code as it is named."""
    value = word.value
    return f"{word.address}{value.value:g}" if isinstance(value, Number) else "computed"
