"""Blocks that set a zero from where the axes stand (G92, G10 L20), where these stand elsewhere.

Behind a move that was compensated the axes stand at the command c and not at the place p of the
source. What the block sets is a zero z in the machine, and that shall be the one of the source. In
the frame that is in force a word w sets it at

    z = p - w,   so that at c the word has to be   w' = w + (c - p).

Where the axes stand is what is written, so that w' has as few decimals as c, p and w have. One that
has more than are written would set another zero: it is refused.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import INCH, LINEAR
from gcxform.emit.copying import Copying
from gcxform.emit.manner import Believed, Task
from gcxform.emit.numbers import quantise
from gcxform.emit.positions import Positions
from gcxform.emit.same_rows import EXACT
from gcxform.modal.frame_state import FrameState
from gcxform.modal.meaning.meaning import PRESETS, Act
from gcxform.system.arrays import Flags, Floats

NOISE = 5e-10  # mm, deg; what sums of places leave


class Presets:
    """The words of such blocks in a window.

    lines   (live,) the lines that are written with other words
    value   (numbers,) what the numbers of the window are worth, with those words
    """

    def __init__(
        self, task: Task, positions: Positions, copying: Copying, believed: Believed
    ) -> None:
        self.task = task
        self.positions = positions
        self.believed = believed
        self.said = copying.said_exactly()
        self.lines: Flags = np.zeros(task.read.live, np.bool_)
        self.value: Floats = task.read.value
        state = dict(task.read.zeroed)
        for line in task.counted_from_axes() if self._compensated else []:
            gap = self._gap(line)
            if (np.abs(gap) > EXACT).any():
                self._set(line, gap, state[line + task.window.first_line])

    @property
    def _compensated(self) -> bool:
        manner = self.task.manner
        return manner.compensates and not manner.crossing and not self.task.path.folded

    def _gap(self, line: int) -> Floats:
        """Return how far (axes,) the axes stand before a line from where the source has them."""
        path, source = self.task.path, self.task.read.path
        now, was = (int(np.searchsorted(each.block, line)) - 1 for each in (path, source))
        place = source.end[was] if was >= 0 else source.entry
        if now < 0:
            exact, stands = self.believed.exact, self.believed.stands
            return np.zeros(len(place)) if exact else np.nan_to_num(stands - place)
        return np.nan_to_num(self.standing(now) - place)

    def standing(self, row: int) -> Floats:
        """Return where the axes (axes,) stand behind a row, as exactly as is known."""
        stands = np.array(self.positions.after[row])
        exact = np.flatnonzero(self.said[row])
        stands[exact] = self.task.path.end[row, exact]
        return stands

    def _set(self, line: int, gap: Floats, state: FrameState) -> None:
        """Write the words of a line for a gap (axes,), in positions."""
        meaning = self.task.table.meanings[int(self.task.shape[line])]
        first, inch = int(self.task.window.first_number[line]), self.task.path.blocks.inch[line]
        self.value = self.value.copy()
        for act in (each for each in meaning.acts if each.name in PRESETS):
            way = dict(zip(state.axes, self._way(act, line, gap, state).tolist(), strict=True))
            for axis, slot in self._moved(act, way):
                unit = INCH if inch and axis in LINEAR else 1.0
                word = float(self.value[first + slot]) + way[axis] / unit
                self.value[first + slot] = self._written(word, line, axis, unit)
                self.lines[line] = True

    def _moved(self, act: Act, way: dict[str, float]) -> Iterator[tuple[str, int]]:
        """Yield the axis words of an act that are others, with their slots."""
        return ((a, slot) for a, slot in act.slots if abs(way.get(a, 0.0)) > EXACT)

    def _way(self, act: Act, line: int, gap: Floats, state: FrameState) -> Floats:
        """Return a gap (axes,) in the words of the frame in which an act counts."""
        if act.name != "preset" and any(state.rotation.values()):
            why = f"{act.code} sets a work offset where one is turned"
            self._refuse(line, why, "say where its zero is, with G10 L2")
        frame = state.frame()
        way = frame.unturned(gap[None, :])[0] if act.name == "preset" else np.array(gap)
        if frame.diameter:
            way[0] *= 2.0
        return way

    def _written(self, word: float, line: int, axis: str, unit: float) -> float:
        """Return a word as it is written; it may not be another."""
        decimals = self.task.manner.decimals_of(axis, unit != 1.0)
        written = float(quantise(np.array([word]), decimals)[0]) / 10.0**decimals
        if abs(written - word) * unit > NOISE:
            why = f"{axis} would have to be {word:.9g}, with more decimals than are written"
            self._refuse(line, why, f"give more decimals, or move {axis} in this unit before")
        return written

    def _refuse(self, line: int, why: str, hint: str) -> None:
        message = f"what this sets would be elsewhere: the axes stand elsewhere, and {why}"
        raise InputError.one("GX506", message, self.task.location(line), hint)
