"""Branches that only the machine can decide, and loops in which it waits.

They stand in the executed blocks as they are, and these are read from the first to the last. A jump
forwards opens a stretch that is executed or not: where it leads, what the stretch moves is lost,
what it sets is forgotten, and a mode that it changes has to be programmed before it counts. What is
repeated until the machine is content may move nothing and change no mode. Alarms and the like may
stand behind the end.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from lark import Token

from gcxform.dialect.arithmetic import Key
from gcxform.flow.execution import Execution
from gcxform.flow.forks import HINT, Arrival, Forks
from gcxform.flow.rerun import Again
from gcxform.flow.residual import Edit
from gcxform.flow.run_state import UNKNOWN
from gcxform.flow.skipped_stretches import is_still, said_of_codes
from gcxform.modal.expressions.value import Evaluator, settable
from gcxform.modal.meaning.printed import prints_values
from gcxform.syntax.tree import Block, Comment, Expression, Statement, Word

SEQUENCE = re.compile(rb"(?:\([^()]*\))*(?:/[1-9]?)?(?:\([^()]*\))*[Nn]([0-9]+)")


class Jumping(Execution):
    """A run of a language in which lines with numbers are jumped to."""

    @abstractmethod
    def target(self, node: Any) -> float:
        """Return the sequence number to which a jump leads."""

    @abstractmethod
    def labelled(self, number: float) -> int:
        """Return the line of the running program that has a sequence number."""

    @abstractmethod
    def refuse_into(self, target: int, number: float) -> None:
        """Refuse a jump to a line inside a loop that is not running."""


class Branches(Forks):
    """Those of one run. `open` are the lines that jumps may lead to, with what is known there.

    `over`: the run is behind a jump that is always made, so that nothing is executed here.
    """

    run: Jumping

    def __init__(self, run: Jumping) -> None:
        super().__init__(run)
        self.open: dict[int, list[Arrival]] = {}
        self.tail: set[int] = set()

    # --- the walk ---

    def next_from(self, line: int) -> int:
        """Return the next line behind this one to which a jump leads, or where a loop begins."""
        ahead = [n for n in self.open if n > line]
        ahead += [first for first, _ in self.run.settled.loops if first > line]
        return min(ahead, default=len(self.run.listing))

    def begin(self) -> bool:
        """Do what is to be done before a line; return whether that line is done by it."""
        run = self.run
        if self.over:
            run.at = self.next_from(run.at - 1) if self.open else len(run.listing)
            if run.at >= len(run.listing):
                run.ended = True
                return True
        if run.at in self.open:
            self._join(run.at)
        ends = [last for first, last in run.settled.loops if first == run.at]
        if ends:
            self.keep_range(run.at, max(ends))
        return bool(ends)

    def end(self, line: int, before: int) -> None:
        """See to it that the number of a line stays to which a jump leads."""
        if before in self.labels and self.labels[before] == line and self.run.blocks == before:
            self.run.line, now = line, self.run.line
            self.run.write_line(f"N{self._label_of(line)}")
            self.run.line = now

    def _label_of(self, line: int) -> int | None:
        """Return the sequence number of a line."""
        return number_of(self.run.listing.window.line(line))

    # --- jumps ---

    def keep_jump(self, statement: Statement, always: bool = False) -> None:
        """Keep a jump that may be made, or not come to; `always`: it has no condition."""
        run = self.run
        number = run.target(statement.tree.children[-1])
        target = run.labelled(number)
        run.refuse_into(target, number)
        if target > run.line:
            self.jump(run.listing.block(run.line), statement, target, always)
            return
        if always or run.calls or self.open:
            raise run.refusal("GX220", "only the machine knows how often this goes back", HINT)
        raise Again(replace(run.settled, loops=run.settled.loops | {(target, run.line)}))

    def _target(self, statement: Statement) -> int | None:
        """Return the line to which a jump of a loop leads; None for what is no jump."""
        if statement.kind not in ("goto", "if_goto"):
            return None
        node = statement.tree.children[-1]
        if not isinstance(node, Token):
            message = "a jump of a loop that the machine ends names its line by a value"
            raise self.run.refusal("GX220", message, HINT)
        return self.run.labelled(self.run.target(node))

    def jump(self, block: Block, statement: Statement, line: int, always: bool = False) -> None:
        """Keep a jump to a line ahead."""
        self.keep(block, statement)
        self.open.setdefault(line, []).append(self.here())
        self.over = always
        self.run.changes += 1

    def refuse_passing(self, line: int, target: int) -> None:
        """Refuse to pass a line to which a jump may lead: it would not be written."""
        if any(line < each < target for each in self.open):
            message = "a jump that only the machine decides leads to a line that is passed here"
            raise self.run.refusal("GX220", message, HINT)

    def perhaps_set(self, block: Block, statement: Statement) -> None:
        """Keep an assignment that may be made or not."""
        run = self.run
        key, _ = run.assignment(statement.tree.children[-1], (statement.start, statement.end))
        if run.arithmetic.writes_table(key):
            message = "a table of the control is written, or not: only the machine knows"
            raise run.refusal("GX220", message, HINT)
        self.keep(block, statement)
        run.lasting.account(key, UNKNOWN, block.text[statement.start : statement.end])
        run.set(run.arithmetic.behind(key, UNKNOWN))

    def _join(self, line: int) -> None:
        here = self.run.blocks
        self.labels[here] = line
        self.meet(self.open.pop(line), line)

    def carry(self, arrivals: Sequence[Arrival], line: int, stale: frozenset[Key]) -> None:
        """Note what is not known where ways meet: nothing hangs on it if the program ends there."""
        if not self._only_ends(line):
            super().carry(arrivals, line, stale)

    def _only_ends(self, line: int) -> bool:
        """Whether a line ends the program, or stops it with an alarm, and moves nothing."""
        meaning, block = self.run.listing.meaning(line), self.run.listing.block(line)
        return self.run.is_over(block) and not (meaning.axes or meaning.acts)

    # --- loops ---

    def keep_range(self, first: int, last: int) -> None:
        """Keep lines that are repeated until the machine is content."""
        run = self.run
        keys = {key for n in range(first, last + 1) for key in self._set_in(n)}
        linear = {**run.parameters, **dict.fromkeys(keys, UNKNOWN)}
        run.parameters = dict(linear)
        self.forgets[run.blocks] = frozenset(keys) | self.forgets.get(run.blocks, frozenset())
        for run.line in range(first, last + 1):
            run.times[run.line] += 1
            linear = self._keep_line(run.listing.block(run.line), first, last, linear)
        self.forgets[run.blocks] = frozenset(keys)
        run.at = last + 1
        run.changes += 1
        run.acted = True

    def _set_in(self, line: int) -> list[Key]:
        """Return the parameters that a line sets, or may set."""
        run = self.run
        run.line = line
        evaluator = Evaluator(run.arithmetic, run.parameters)
        trees = [i.tree for i in run.listing.block(line).items if isinstance(i, Statement)]
        found = [each for tree in trees for each in tree.iter_subtrees()]
        sets = [tree for tree in found if str(tree.data).endswith("assignment")]
        return [settable(run.arithmetic, evaluator.key(tree.children[0])) for tree in sets]

    def _keep_line(
        self, block: Block, first: int, last: int, linear: dict[Key, float]
    ) -> dict[Key, float]:
        run = self.run
        flow = [i for i in block.items if isinstance(i, Statement) and i.kind != "assignment"]
        if not flow and not self._stays_still(run.line):
            message = "this may be repeated: only the machine knows how often"
            said = said_of_codes(run.listing.meaning(run.line))
            hint = f"if it moves nothing: {said}" if said else HINT
            raise run.refusal("GX220", message, hint)
        pieces: list[Edit] = []
        known = Evaluator(run.conditions, run.parameters)
        for item in block.items:
            if isinstance(item, Statement):
                pieces.append((item.start, item.end, run.remains(item, known)))
                linear = self._account(item, linear, pieces[-1][2])
            elif isinstance(item, Word) and isinstance(item.value, Expression):
                value = item.value
                pieces.append((value.start, value.end, run.remains(value, known)))
            elif isinstance(item, Comment) and prints_values(block.text[item.start : item.end]):
                raise run.refusal("GX220", "this message may be repeated", HINT)
        if flow:
            self.lines.add(run.blocks)
        elif self._label_of(run.line) is not None:
            self.labels.setdefault(run.blocks, run.line)
        self.write(block, pieces)
        for item in flow:
            self._leads(item, first, last)
        return linear

    def _account(self, item: Statement, linear: dict[Key, float], text: str) -> dict[Key, float]:
        """Account for an assignment of a loop, as who reads the lines once would see it."""
        run = self.run
        if item.kind not in ("assignment", "if_then"):
            return linear
        tree = item.tree if item.kind == "assignment" else item.tree.children[-1]
        mine, run.parameters = run.parameters, linear
        key, value = run.assignment(tree, (item.start, item.end))
        run.parameters = mine
        value = value if item.kind == "assignment" else UNKNOWN
        run.lasting.account(key, value, text)
        return {**linear, key: value}

    def _leads(self, item: Statement, first: int, last: int) -> None:
        """Look at where a jump of a loop leads: inside, ahead, or back to make the loop longer."""
        run, to = self.run, self._target(item)
        if to is None or first <= to <= last:
            return
        if to < first:
            loops = run.settled.loops | {(to, last)}
            raise Again(replace(run.settled, loops=loops))
        self.open.setdefault(to, []).append(self.here())

    # --- behind the end ---

    def close(self) -> None:
        """Write what jumps lead to behind the end of the program, and check all of it."""
        for line in sorted(self.open):
            self._behind(line)
        self._check_labels()
        self.refuse_modes()

    def _behind(self, line: int) -> None:
        """Write lines behind the end, to which a jump leads."""
        run = self.run
        at = run.line = line
        if at in self.tail:
            return
        if not run.ended or run.times[at] or any(each.depth for each in self.open[line]):
            raise run.refusal("GX220", "a jump leads here that only the machine decides", HINT)
        while not run.times[at]:
            run.line = at
            self.tail.add(at)
            meaning, block = run.listing.meaning(at), run.listing.block(at)
            if meaning.percent:
                return
            run.times[at] = 1
            run.put(run.listing.raw(at, at + 1), np.array([at]))
            if run.is_over(block) and not (at + 1 < run.listing.own and self._only_ends(at + 1)):
                return  # an end behind an alarm stays with it
            if meaning.refusal is not None or not self._stays_still(at):
                break
            at += 1
            if at >= run.listing.own:
                return
        raise run.refusal("GX220", "what a jump behind the end leads to is not followed", HINT)

    def _check_labels(self) -> None:
        """Refuse sequence numbers that jumps name and that would stand twice in what is written."""
        run = self.run
        if not (self.labels or self.open):
            return
        written: dict[int | None, int] = {}
        text = b"".join(run.text)
        for each in text.splitlines():
            number = number_of(each)
            written[number] = written.get(number, 0) + 1
        for line in (*self.labels.values(), *self.open):
            run.line = line
            number = self._label_of(line)
            if number is not None and written.get(number) != 1:
                if (loop := self._repeated_around(line)) is not None:
                    raise Again(replace(run.settled, loops=run.settled.loops | {loop}))
                message = f"N{number} would stand {written.get(number, 0)} times where calls are"
                raise run.refusal("GX220", f"{message} written out, and a jump names it", HINT)

    def _repeated_around(self, line: int) -> tuple[int, int] | None:
        """Return the shortest loop around a line that can be kept, as it waits, counts or tells."""
        run = self.run
        steps = [step for step in run.walked if not step.depth]
        loops = {(to.first, by.stop - 1) for by, to in pairwise(steps) if to.first < by.stop}
        around = [(first, last) for first, last in loops if first <= line <= last]
        fit = [loop for loop in around if loop not in run.settled.loops and self._is_still(*loop)]
        return min(fit, key=lambda loop: loop[1] - loop[0], default=None)

    def _is_still(self, first: int, last: int) -> bool:
        """Whether lines move nothing and change no mode."""
        return all(
            any(isinstance(item, Statement) for item in self.run.listing.block(line).items)
            or self._stays_still(line)
            for line in range(first, last + 1)
        )

    def _stays_still(self, line: int) -> bool:
        """Whether a line moves nothing and changes no mode."""
        listing = self.run.listing
        return is_still(listing.meaning(line), listing.block(line), self.run.reading.inert_m)


def number_of(text: bytes) -> int | None:
    """Return the sequence number at the head of a block."""
    number = SEQUENCE.match(text.translate(None, b" \t"))
    return int(number[1]) if number else None
