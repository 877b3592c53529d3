"""Path modes around the moves that stand for canned cycles.

A control whose cycles stop (`MotionRule.cycles_stop`) ends every move of one exactly, also under
G64: before a block that calls one it goes to exact path, and behind it back to what was stated,
with its tolerances. Where such a block is written as plain moves, blocks of their own say the same:
`G61` before them, and behind them `G64` with the words it was stated with. Where that cannot be
said the program is refused; where no path mode is stated, nobody knows what to go back to.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gcxform.dialect.code_translation import BLEND
from gcxform.emit.manner import Task
from gcxform.system.arrays import Flags, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.path import Event
from gcxform.values import dataclass

EXACT, BLENDING, GROUP = "G61", "G64", "path"
ENDS_EXACTLY = (
    "moves of expanded cycles end exactly (G61): no path mode is stated, and G64 would round them"
)
MESSAGE = "the moves of a cycle end exactly, and G64 would round their ends"
BEFORE = "write G61 before the cycle"
COMPUTED = "words of G64 are computed", f"{BEFORE}, or numbers behind G64"
CALLED = "G64 stands in a subprogram", f"{BEFORE}, or G64 into the program itself"
HERE = "G64 stands in its block", "give G64 a block of its own before"
UNITS = "the tolerance of G64 is in another unit", f"{BEFORE}, or G64 in the unit of the cycle"
LEAVES = "nothing can be written behind this block", "end the program in a block of its own"


@dataclass(frozen=True, slots=True)
class PathMode:
    """A path mode as it was stated, nothing in `what` for none.

    `words` are in units of the program, in inches if `inch`. `lacks`: why it cannot be stated
    again, and the way out.
    """

    what: str = ""
    words: tuple[tuple[str, float], ...] = ()
    inch: bool = False
    lacks: tuple[str, str] | None = None


class Exactness:
    """What path mode a window's rows have, and what has to stand around expanded cycles.

    `before` is what the windows before have stated; `after` is what this one leaves. `called` says
    of a line of the program, from 0, whether it came from a subprogram.
    """

    def __init__(self, task: Task, before: PathMode, called: Callable[[int], bool]) -> None:
        self.task = task
        source = task.manner.source
        coded = {code for code, what in source.codes.items() if what.group == GROUP}
        stated = [event for event in task.path.events if event.what in coded]
        self.rows = np.array([event.row for event in stated], np.int64)
        self.lines = np.array([event.line for event in stated], np.int64)
        self.modes = [before, *(self._mode(event, called) for event in stated)]
        self.says = source is task.manner.target and source.motion_rule.cycles_stop
        self.says &= {EXACT, BLENDING} <= coded

    @property
    def after(self) -> PathMode:
        """The path mode that the window leaves."""
        return self.modes[-1]

    def _mode(self, event: Event, called: Callable[[int], bool]) -> PathMode:
        """Return the mode that an event states."""
        blocks, table = self.task.path.blocks, self.task.table
        line = event.line - blocks.first
        computed = {slot for slot, _ in table.meanings[int(self.task.shape[line])].expressions}
        lacks = COMPUTED if event.values and computed else None
        lacks = CALLED if called(event.line) else lacks
        return PathMode(event.what, event.values, bool(blocks.inch[line]), lacks)

    def _calls(self, expanded: Flags) -> tuple[Ints, Ints, Ints]:
        """Return the lines of expanded cycles that move, and their first and last rows."""
        block = self.task.path.block
        lines = distinct(block[expanded[block]])
        first, last = (np.searchsorted(block, lines, side) for side in ("left", "right"))
        return lines, first, last - 1

    def _lacks(self, line: int, mode: PathMode) -> tuple[str, str] | None:
        """Return why a mode cannot be left before an expanded block and stated again behind it."""
        blocks, task = self.task.path.blocks, self.task
        if not self.says:
            return "", BEFORE
        if line + blocks.first in self.lines:
            return HERE
        if mode.words and bool(blocks.inch[line]) != mode.inch:
            return UNITS
        ends = task.table.flag("ends", task.shape[line : line + 1])[0]
        return LEAVES if blocks.leaves[line] or ends else mode.lacks

    def around(self, expanded: Flags) -> tuple[list[Event], list[Event]]:
        """Return what stands before and behind expanded blocks (live,), as events within them."""
        opens: list[Event] = []
        closes: list[Event] = []
        if not (self.says and expanded.any()):
            return opens, closes
        lines, first, last = self._calls(expanded)
        which = np.searchsorted(self.rows, first, "right")
        for line, row, end, number in zip(
            *(c.tolist() for c in (lines, first, last, which)), strict=True
        ):
            mode = self.modes[number]
            if mode.what == BLENDING and self._lacks(line, mode) is None:
                at = line + self.task.path.blocks.first
                opens.append(Event(row, EXACT, (), at, True))
                closes.append(Event(end + 1, BLENDING, mode.words, at, True))
        return opens, closes

    def refuse(self, expanded: Flags) -> bool:
        """Refuse cycles whose ends would be rounded; return whether their exactness is assumed."""
        manner = self.task.manner
        rounds = manner.target.motion_rule.rounds_corners
        if not any(code.act == BLEND for code in manner.target.codes.values()):
            return False  # nothing there rounds corners
        if not (manner.source.motion_rule.cycles_stop or rounds) or not expanded.any():
            return False
        lines, first, _ = self._calls(expanded)
        modes = [self.modes[n] for n in np.searchsorted(self.rows, first, "right").tolist()]
        for line, row, mode in zip(lines.tolist(), first.tolist(), modes, strict=True):
            lacks = self._lacks(line, mode) if mode.what == BLENDING else None
            if lacks is not None:
                message = ": ".join(filter(None, (MESSAGE, lacks[0])))
                self.task.refuse(np.array([row]), "GX506", message, lacks[1])
        return rounds and any(not mode.what for mode in modes)
