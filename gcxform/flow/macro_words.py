"""The flow words of macro B: GOTO, IF, WHILE and DO."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

from lark import Token

from gcxform.dialect.arithmetic import Arithmetic, Key
from gcxform.flow.branches import Branches, Jumping, number_of
from gcxform.flow.listing import Listing
from gcxform.flow.relations import COMPARES, relations
from gcxform.flow.round_body import Repeated
from gcxform.flow.rounds import Rounds
from gcxform.modal.expressions.value import key_set
from gcxform.modal.state import Reading
from gcxform.syntax.grammar import span_of
from gcxform.syntax.tree import BLANKS, Block, Comment, Statement
from gcxform.syntax.undecided import Undecided
from gcxform.values import dataclass

CONDITION = -3
"""Which of the parts of a flow word is its condition: before GOTO, THEN or DO and what follows."""


@dataclass(frozen=True, slots=True)
class Loop:
    """A loop: the lines of its DO and its END."""

    first: int
    last: int


class MacroWords(Jumping):
    """Does what flow words say; `bounds` are the lines at which programs begin."""

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.loops: dict[int, Loop] = {}
        self.bounds: list[int] = []
        self.branches = Branches(self)
        self.many = Rounds(self)

    def forget_sequences(self) -> None:
        """Forget which lines have which numbers: there are more of them."""
        self.__dict__.pop("_sequences", None)

    @property
    def conditions(self) -> Arithmetic:
        """The arithmetic of conditions: relations are known there alone."""
        return self._conditions

    @cached_property
    def _conditions(self) -> Arithmetic:
        said = self.reading.control.get(COMPARES) or self.dialect.flow_rule.null_compare
        known = relations(str(said))
        return replace(self.arithmetic, operators={**self.arithmetic.operators, **known})

    def _program(self) -> tuple[int, int]:
        """Return the first line of the program that runs, and the line behind its last."""
        first = max((b for b in self.bounds if b <= self.line), default=0)
        if self.bounds and first == self.bounds[0]:
            first = 0
        return first, min(
            (b for b in self.bounds if b > max(self.line, first) and b != self.bounds[0]),
            default=len(self.listing),
        )

    # --- what only the machine decides ---

    def steady(self) -> bool:
        """Whether no jump that only the machine decides leads here, or ahead."""
        branches = self.branches
        waits = branches.open or branches.over or self.settled.loops
        return not waits and self.blocks not in branches.labels

    def begins(self) -> bool:
        """Do what is to be done where a jump may lead, or a loop begins."""
        return self.branches.begin()

    def next_stop(self) -> int:
        """Return the next line to which a jump may lead."""
        return self.branches.next_from(self.at)

    def is_done(self, line: int, before: int) -> None:
        """See to it that a line keeps its number to which a jump may lead."""
        self.branches.end(line, before)

    def close_branches(self) -> None:
        """Write what jumps may lead to behind the end."""
        self.branches.close()

    def is_jumped_to(self) -> bool:
        """Whether a jump that only the machine decides leads to what is written next."""
        return self.blocks in self.branches.labels

    def undecided(self) -> Undecided:
        """Return what of the executed lines only the machine decides."""
        return self.branches.undecided

    # --- jumps ---

    def labelled(self, number: float) -> int:
        """Return the line of the running program that has a sequence number."""
        first, last = self._program()
        found = [line for line in self._sequences.get(number, ()) if first <= line < last]
        if len(found) != 1:
            how = "no line" if not found else "more than one line"
            raise self.refusal("GX223", f"{how} of this program has the number N{number:g}")
        if not self.stands(self.listing.block(found[0])):
            message = f"N{number:g} is skipped: whether the control finds it is not certain"
            raise self.refusal("GX223", message)
        return found[0]

    @cached_property
    def _sequences(self) -> dict[float, list[int]]:
        """The lines of every sequence number."""
        found: dict[float, list[int]] = {}
        for line in range(len(self.listing)):
            if (number := number_of(self.listing.window.line(line))) is not None:
                found.setdefault(float(number), []).append(line)
        return found

    def _jump(self, number: float) -> None:
        target = self.labelled(number)
        self.refuse_into(target, number)
        self.branches.refuse_passing(self.line, target)
        self.jumps.add(len(self.walked) - 1)
        if target > self.line:
            self.at = target
        else:
            self.back_to(target)

    def _around(self, line: int) -> list[Loop]:
        return [loop for loop in set(self.loops.values()) if loop.first < line <= loop.last]

    def refuse_into(self, target: int, number: float) -> None:
        """Refuse a jump to a line inside a loop that is not running."""
        into = [p for p in self._around(target) if p not in self._around(self.line)]
        if into:
            raise self.refusal("GX223", f"N{number:g} stands inside a loop that is not running")

    def _goto(self, statement: Statement) -> None:
        if self.branches.open:
            self.branches.keep_jump(statement, always=True)
        else:
            self._jump(self.target(statement.tree.children[-1]))

    def target(self, node: Any) -> float:
        """Return the sequence number to which a jump leads."""
        return float(str(node).translate(BLANKS)) if isinstance(node, Token) else self.value(node)

    def _holds(self, statement: Statement) -> bool | None:
        """Return whether a condition holds; None if only the machine knows it."""
        found = self.value_or_lost(statement.tree.children[CONDITION])
        return None if found is None else found != 0

    def _if_goto(self, statement: Statement) -> None:
        holds = self._holds(statement)
        if holds is None:
            self.branches.keep_jump(statement)
        elif holds:
            self._goto(statement)

    def _if_then(self, statement: Statement) -> None:
        holds = self._holds(statement)
        if holds is None:
            self.branches.perhaps_set(self.listing.block(self.line), statement)
        elif holds:
            tree = statement.tree.children[-1]
            key, value = self.assignment(tree, (statement.start, statement.end))
            made = Statement(*span_of(tree), "assignment", tree)
            kept = self.kept_assignment(made, (key, value))
            self.set(self.arithmetic.behind(key, value))
            if text := self.lasting.account(key, value, kept):
                self.write_line(text + self._told_with(key))
            if key == self.arithmetic.machine.alarm:
                self._stop_with_alarm()

    def _told_with(self, key: Key) -> str:
        """Return the comments of the line if an assignment shows them: those of #3000, #3006."""
        block, text = self.listing.block(self.line), ""
        for item in block.items if self.arithmetic.acts(key) else ():
            text += block.text[item.start : item.end] if isinstance(item, Comment) else ""
        return text

    # --- ends ---

    def _ends(self, block: Block) -> bool:
        return super()._ends(block) or self.alarms(block)

    def alarms(self, block: Block) -> bool:
        """Whether a block stops the control with an alarm (#3000 of Fanuc and Haas)."""
        alarm = self.arithmetic.machine.alarm
        statements = (item for item in block.items if isinstance(item, Statement))
        return any(alarm is not None and key_set(each) == alarm for each in statements)

    def stop(self, block: Block) -> None:
        """End the program, or go on where a jump ahead may lead to: an alarm ends nothing else."""
        if self.alarms(block):
            self._stop_with_alarm()
        else:
            super().stop(block)

    def _stop_with_alarm(self) -> None:
        self.branches.over, self.ended = bool(self.branches.open), not self.branches.open
        self.alarm = self.blocks - 1 if self.ended else None

    # --- loops ---

    def _while(self, statement: Statement) -> None:
        holds = self._holds(statement)
        if holds is None:
            self.times[self.line] -= 1
            self.branches.keep_range(self.line, self.loops[self.line].last)
        elif not holds:
            self.at = self.loops[self.line].last + 1

    def _do(self, statement: Statement) -> None:
        """Go on."""

    def _end(self, statement: Statement) -> None:
        loop = self.loops[self.line]
        self.back_to(loop.first)
        opening = statement_of(self.listing.block(loop.first))
        if opening is not None and opening.kind == "while":
            flow = frozenset((loop.first, loop.last))
            condition = opening.tree.children[CONDITION]
            self.many.go(Repeated(loop.first, loop.last, flow, condition))


def statement_of(block: Block) -> Statement | None:
    """Return the flow word of a block."""
    found = (i for i in block.items if isinstance(i, Statement) and i.kind != "assignment")
    return next(found, None)
