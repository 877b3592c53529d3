"""Tool vectors: under G43.5 I, J and K of a line are the tool axis at its end, from tip to holder.

What is read is what two manuals of Fanuc say (A-79348E, B-63323EN): of I, J and K those that are
left out are 0; where all are, the tool keeps its direction; the length of a vector does not count;
words of rotary axes have no place beside them, and in G91 X, Y and Z are how far the tip goes. As
long as the program has said no vector, the tool stands as it stood before. All else is refused.

They are a column of their own, `tool` of the path. Rotary axes of such rows stand where G43.5
began, at 0. After G49 they are where the control's own choice has left them: their position is
`LEFT` (`gcxform/modal/frames/track.py`), inf, which no word can have, and the pass puts in what it
knows.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.modal.columns import fill
from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import NUMBER
from gcxform.modal.state import CYCLE_OFF, Modes
from gcxform.system.arrays import Flags, Floats
from gcxform.toolpath.path import Kind

UPRIGHT = (0.0, 0.0, 1.0)
"""The tool axis with all rotary axes at 0, where a program has to begin."""
LINEAR = "XYZ"


class Pointing:
    """The tool vectors of a window; the state's vector is left where the window ends.

    on      (lines,) where they are in force, the line that begins them among them
    named   (lines,) where one is programmed
    """

    def __init__(self, lines: Lines, modes: Modes, axes: str) -> None:
        self.lines, self.modes, self.axes = lines, modes, axes
        before = lines.state.memory["tool-length"]
        mode = lines.remembered("tool-length")
        self.on = np.asarray(mode == NUMBER["G43"])
        self.begins = self.on & (np.append(before, mode[:-1])[: lines.live] != NUMBER["G43"])
        self.named = np.zeros(lines.live, np.bool_)
        self.raw = np.zeros((lines.live, 3))
        for k, address in enumerate("IJK"):
            word = lines.word(address, self.on, distance=False)
            if word is not None:
                self.named |= word[1]
                self.raw[:, k] = np.where(word[1], word[0], 0.0)
        self.length = np.sqrt((self.raw**2).sum(axis=1))

    def vectors(self) -> Floats:
        """Return the tool axis (lines, 3) after each line, nan where no vectors are in force."""
        state, found = self.lines.state, np.empty((self.lines.live, 3))
        length = np.where(self.length > 0.0, self.length, np.nan)
        for k in range(3):
            value = np.where(self.named, self.raw[:, k] / length, UPRIGHT[k])
            said = self.named | self.begins
            found[:, k] = fill(np.where(said, value, np.nan), said | ~self.on, state.vector[k])
        if self.lines.live:
            x, y, z = found[-1].tolist()
            state.vector = (x, y, z)
        return found

    # --- what is refused ---

    def check(self) -> None:
        """Refuse what is not a vector at the end of a line, or what stands beside one."""
        if not self.on.any():
            return
        for wrong, code, message, hint in self._objections():
            for line in np.flatnonzero(wrong)[: Findings.enough].tolist():
                self.lines.findings.add(line, code, message, hint=hint)

    def _objections(self) -> Iterator[tuple[Flags, str, str, str]]:
        """Yield which lines are wrong, with code, message and hint."""
        lines, modes, named = self.lines, self.modes, self.named
        moves = (lines.flag("moves") | named) & self.on
        nowhere = modes.motion == NUMBER["G80"]
        hint = "let the CAM write lines in this part"
        other = ~nowhere & (modes.motion != Kind.RAPID) & (modes.motion != Kind.LINE)
        other |= modes.cycle != CYCLE_OFF
        yield moves & other, "GX336", "under G43.5 only G0 and G1 are read", hint
        own = self.on & (lines.flag("own_moves") | lines.loses_position())
        message = "under G43.5 this block may turn axes in a way of its own"
        yield (
            own,
            "GX336",
            message,
            "before it, draw the tool back along its axis and end G43.5 with G49",
        )
        begun = named & self.lines.stated("tool-length")
        message = "I, J and K in the block of G43.5: on machines with a table this is an alarm"
        yield begun, "GX336", message, "give the vector in the next block"
        yield named & (self.length == 0.0), "GX336", "a tool vector without length", ""
        yield self.on & (modes.comp != 0), "GX336", "cutter compensation under G43.5", ""
        yield self._with_words(), "GX336", "under G43.5 the tool axis is I, J, K alone", ""
        yield self._with_radius(), "GX203", "R belongs to arcs, and this is none", ""
        message = "I, J or K has no decimal point: its unit depends on the control"
        yield self._pointless(), "GX205", message, "write it with a point, where the control has it"

    def _with_words(self) -> Flags:
        """Return the lines that name an axis besides X, Y and Z."""
        found = np.zeros(self.lines.live, np.bool_)
        for axis in self.axes:
            word = None if axis in LINEAR else self.lines.word(axis, self.on, distance=False)
            if word is not None:
                found |= word[1]
        return found

    def _with_radius(self) -> Flags:
        word = self.lines.word("R", self.on, distance=False)
        return np.zeros(self.lines.live, np.bool_) if word is None else word[1] & self.named

    def _pointless(self) -> Flags:
        """Return the lines whose vector has a number, not 0, without a point."""
        found = np.zeros(self.lines.live, np.bool_)
        if not self.lines.dialect.point_rule.required:
            return found
        for k, address in enumerate("IJK"):
            slot = self.lines.table.slots[:, ord(address) - 65][self.lines.shape]
            here = np.flatnonzero(self.named & (slot >= 0))
            number = (self.lines.first + slot)[here]
            found[here] |= (self.lines.window.decimals[number] < 0) & (self.raw[here, k] != 0.0)
        return found
