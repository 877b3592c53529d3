"""Ways that only the machine chooses, in blocks that are read from the first to the last.

A block with a flow word that only the machine decides stands among the executed ones. What lies
between it and where its other way comes in is executed or not: behind that, what the stretch moves
is lost, what it sets is forgotten, and a mode that it changes has to be programmed before it
counts. That is so whatever the language calls it; which lines these are says a subclass.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.flow.execution import Execution
from gcxform.flow.run_state import UNKNOWN, differs
from gcxform.flow.skipped_stretches import Effect, Join, effect_of, other_modes
from gcxform.modal.expressions.value import Evaluator
from gcxform.modal.lines import NOTHING
from gcxform.modal.reader import new_table
from gcxform.syntax.scan import scan
from gcxform.syntax.tree import Block, Statement
from gcxform.syntax.undecided import Undecided
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

FEW_BYTES = 4096  # lines that a loop executes again and again; what is longer is read in columns
MOST_KNOWN = 20_000  # lines whose shapes are remembered
HINT = "set what it reads with parameters in [input], or use passes that keep positions"


@dataclass(frozen=True, slots=True)
class Arrival:
    """A way that comes in: what is known on it, and the executed line that it comes from."""

    parameters: dict[Key, float]
    line: int
    depth: int


class Forks:
    """Those of one run. `over`: no way leads to the line at which the run stands."""

    def __init__(self, run: Execution) -> None:
        self.run = run
        self.over = False
        self.lines: set[int] = set()
        self.labels: dict[int, int] = {}
        self.lost: dict[int, str] = {}
        self.forgets: dict[int, frozenset[Key]] = {}
        self.perhaps: set[int] = set()
        self.ends: set[int] = set()
        self.joins: list[Join] = []
        self.table = new_table(run.dialect)  # one to the end: the shapes are numbers in it
        self.shapes: list[int] = []
        self.known: dict[bytes, int] = {}
        self.still: set[int] = set()  # written lines that neither move nor set anything
        self.seen = 0

    @property
    def undecided(self) -> Undecided:
        """What of the executed blocks only the machine decides."""
        lines, labels, perhaps = (
            frozenset(n) for n in (self.lines | self.ends, self.labels, self.perhaps)
        )
        return Undecided(lines, labels, self.lost, self.forgets, perhaps)

    def here(self) -> Arrival:
        """Return the way on which the run is, behind the last executed line."""
        return Arrival(dict(self.run.parameters), self.run.blocks - 1, len(self.run.calls))

    def keep(
        self, block: Block, statement: Statement, more: Sequence[tuple[int, int, str]] = ()
    ) -> None:
        """Write a block with a flow word as it stands, but for what is known, and `more` edits."""
        run = self.run
        run.acted = True
        left = run.left_of(statement, Evaluator(run.conditions, run.parameters))
        self.lines.add(run.blocks)
        self.write(block, [*left, *more])

    def write(self, block: Block, edits: Sequence[tuple[int, int, str]]) -> None:
        """Write a block with pieces of it changed."""
        text = block.text
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        if text == block.text:
            self.run.copy_line()
        else:
            self.run.write_line(text.rstrip())

    def meet(self, arrivals: Sequence[Arrival], line: int) -> None:
        """Let ways come in before a line, beside the one on which the run is."""
        run = self.run
        if any(each.depth != len(run.calls) for each in arrivals):
            raise run.refusal("GX220", "a jump that only the machine decides leads here", HINT)
        states = [each.parameters for each in arrivals] + [run.parameters] * (not self.over)
        first, every = states[0], [*states, run.parameters]
        lost = {k for k in {*first}.union(*states) if not _agree(k, states)}
        stale = {k for k in {*first}.union(*every) if not _agree(k, every)}
        run.parameters = {**first, **dict.fromkeys(lost, UNKNOWN)}
        self.over = False
        run.lasting.outputs.stands.clear()
        run.changes += 1
        self.carry(arrivals, line, frozenset(stale))

    def carry(self, arrivals: Sequence[Arrival], line: int, stale: frozenset[Key]) -> None:
        """Note what is not known behind a place where ways meet: `stale`, and what was moved."""
        here, since = self.run.blocks, min(each.line for each in arrivals)
        self.forgets[here] = stale | self.forgets.get(here, frozenset())
        self.joins.append(Join(tuple(each.line for each in arrivals), here, line))
        self.note(here, since, self.effect(since))

    def note(self, here: int, since: int, found: Effect) -> None:
        """Note what is lost before a block, and what may not be executed that moves."""
        if found.letters:
            self.lost[here] = "".join(sorted({*found.letters, *self.lost.get(here, "")}))
        self.perhaps.update(range(since + 1, here) if found.moves else ())

    def effect(self, since: int) -> Effect:
        """Return what is changed by the lines behind one, up to the last that is written."""
        shapes = np.array(self._shapes()[since + 1 :], np.int64)
        shapes[[line - since - 1 for line in self.ends if line > since]] = NOTHING
        return effect_of(self.run, self.table, shapes, self.since(since)[1])

    def since(self, line: int) -> tuple[bytes, Ints]:
        """Return what was written behind an executed line, and the lines that it stands for."""
        run, piece, count = self.run, len(self.run.text), self.run.blocks - line - 1
        while count > 0:
            piece -= 1
            count -= len(run.origin[piece])
        origin = np.concatenate([np.empty(0, np.int64), *run.origin[piece:]])[-count or None :]
        text = b"".join(run.text[piece:])
        return b"".join(text.splitlines(keepends=True)[-count:]) if count else text, origin

    def _shapes(self) -> list[int]:
        """Return the shapes of all written lines."""
        text, self.seen = b"".join(self.run.text[self.seen :]), len(self.run.text)
        if len(text) > FEW_BYTES:
            self.shapes += self._scanned(text)
            return self.shapes
        if len(self.known) > MOST_KNOWN:
            self.known.clear()
        lines = text.splitlines()
        for number in self.still.intersection(range(len(self.shapes), self.run.blocks)):
            lines[number - len(self.shapes)] = b""
        if new := [line for line in dict.fromkeys(lines) if line not in self.known]:
            self.known |= zip(new, self._scanned(b"\n".join(new) + b"\n"), strict=True)
        self.shapes += map(self.known.__getitem__, lines)
        return self.shapes

    def _scanned(self, text: bytes) -> list[int]:
        """Return the shapes of lines; those that are not executed have none."""
        shapes = scan(text, 0, self.table.shapes).shape.copy()
        self.table.update()
        if self.run.reading.blocks_with_a_slash(self.run.dialect) != "execute":
            shapes[self.table.flag("deleted", shapes)] = NOTHING
        found: list[int] = shapes.tolist()
        return found

    def refuse_modes(self) -> None:
        """Refuse modes that count where only the machine knows which is in force."""
        if not self.joins:
            return
        run, shapes = self.run, np.array(self._shapes(), np.int64)
        if (other := other_modes(run, self.table, shapes, self.joins)) is not None:
            run.line, code = other
            message = f"only the machine knows whether {code} is in force here"
            raise run.refusal("GX220", message, f"program it behind the branch, or {HINT}")


def _agree(key: Key, states: Sequence[dict[Key, float]]) -> bool:
    first = states[0].get(key)
    return not any(differ(first, each.get(key)) for each in states)


def differ(one: float | None, other: float | None) -> bool:
    """Whether a parameter is not known to be the same on two ways."""
    return other is None if one is None else other is None or differs(one, other)
