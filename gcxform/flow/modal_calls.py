"""G66: a program is called with values behind every block that moves an axis, until G67.

Not in the block of G66 itself, and not behind blocks without a movement. A second G66 is called
first, and what its program moves calls the one before; G67 takes the last one back (Mitsubishi
M700V manual p. 314, NCT 99M manual p. 171, of the same language; Fanuc 16i B-63684EN p. 278 counts
the levels). The variables are those of the G66 in every call. Whether arcs, canned cycles, home
moves, or what programs called otherwise move call it as well, no manual at hand says.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.flow.run_state import Call, RunState, computed
from gcxform.modal.meaning.meaning import OWN_MOVES, Meaning
from gcxform.modal.meaning.tables import COLUMNS, NUMBER
from gcxform.syntax.tree import Word
from gcxform.values import dataclass

BEGINS, ENDS = "G66", "G67"
STRAIGHT = frozenset({NUMBER["G0"], NUMBER["G1"]})
BEHIND = "behind each block with axis words in G0 or G1"


@dataclass(frozen=True, slots=True)
class Modal:
    """A G66 in force: what it calls, by which name, how often, with what; `depth` counts calls."""

    name: str
    first: int
    times: int
    given: Mapping[Key, float]
    depth: int


class ModalCalls:
    """Those of one run; `make` makes a call of a name with values."""

    def __init__(self, run: RunState, make: Callable[[Modal], Call]) -> None:
        self.run = run
        self.make = make
        self.open: list[Modal] = []
        self.codes = dict.fromkeys(("motion", "cycle"), -1)

    def begin(self, modal: Modal) -> None:
        """Put a program in force."""
        if not self.open:
            self._look_back()
        self.open.append(modal)
        self.run.assumed[f"{modal.name}: it is called {BEHIND}"] = None

    def end(self, words: list[Word]) -> bool:
        """Take back the last one; return whether the block is done by it."""
        if not self.open:
            return False
        if len(words) > 1:
            place = words[0].start, words[-1].end
            message = f"whether the words beside {ENDS} act before it is not certain"
            raise self.run.refusal("GX210", message, f"write {ENDS} in a block of its own", place)
        if self._inside() or self.open[-1].depth != len(self.run.calls):
            message = f"{ENDS} stands in another program than its {BEGINS}"
            raise self.run.refusal("GX210", message)
        self.open.pop()
        return True

    def _inside(self) -> int:
        """Return 1 + the number of the modal call whose program runs, 0 outside of them."""
        return next((call.modal for call in reversed(self.run.calls) if call.modal), 0)

    def _look_back(self) -> None:
        """Find the codes that are in force."""
        origin = np.concatenate([np.empty(0, np.int64), *self.run.origin])
        groups = self.run.listing.table.groups[self.run.listing.window.shape[origin]]
        for name in self.codes:
            stated = groups[:, COLUMNS.index(name)]
            stated = stated[stated >= 0]
            self.codes[name] = int(stated[-1]) if len(stated) else -1

    def called_behind(self, line: int, written: list[Word]) -> Call | None:
        """Return the call that a line makes that was written, None for one that moves nothing."""
        meaning = self.run.listing.meaning(line)
        moves = any(word.address in self.run.dialect.axes for word in written)
        self._follow(meaning)
        moves = moves and bool(meaning.axes)  # not the X of a dwell
        active = self._inside() - 1 if self._inside() else len(self.open)
        if not active or not (moves or _may_move(meaning)):
            return None
        modal = self.open[active - 1]
        if why := self._doubt(meaning, written, active):
            self.run.line = line
            message = f"whether {modal.name} is called behind {why} is not certain"
            raise self.run.refusal("GX210", message, f"end it with {ENDS} before")
        return replace(self.make(modal), modal=active)

    def _follow(self, meaning: Meaning) -> None:
        for name in self.codes:
            code = meaning.groups.get(name)
            self.codes[name] = self.codes[name] if code is None else NUMBER.get(code, -1)
        if "motion" in meaning.groups and "cycle" not in meaning.groups:
            self.codes["cycle"] = -1

    def _doubt(self, meaning: Meaning, written: list[Word], active: int) -> str:
        """Return why it is not certain that a block with a movement calls, nothing if it is."""
        run = self.run
        if meaning.runs_macro:
            return "what a program moves that is not at hand"
        if _may_move(meaning):
            return "a home move, a move in machine coordinates, or a probing one"
        if self.codes["cycle"] not in (-1, NUMBER["G80"]):
            return "a canned cycle"
        if self.codes["motion"] not in STRAIGHT or any(
            word.address == "G" and computed(word) for word in written
        ):
            return "another move than by G0 or G1"
        depth = self.open[active - 1].depth if not self._inside() else self._called_at()
        return "" if depth == len(run.calls) else "a move of a program that is called otherwise"

    def _called_at(self) -> int:
        """Return how many calls there are where the program of the last modal call runs."""
        depths = [nth + 1 for nth, call in enumerate(self.run.calls) if call.modal]
        return depths[-1]


def _may_move(meaning: Meaning) -> bool:
    """Whether a block moves axes in a way of its own, or calls what may do so."""
    return meaning.runs_macro or any(act.name in OWN_MOVES for act in meaning.acts)
