"""What blocks may do in a tilted plane, so that its words lead where it says.

Between G68.2 and G53.1 controls differ in where they lead, and behind G53.1 they hold as long as
the rotary axes stand still.
"""

from __future__ import annotations

from collections.abc import Set

import numpy as np

from gcxform.modal.frames.planes import EQUAL
from gcxform.modal.frames.track import Track
from gcxform.modal.meaning.calls import CALL
from gcxform.modal.meaning.meaning import OWN_MOVES, TAKES_MOTION
from gcxform.modal.moves.rows import Stretches
from gcxform.system.arrays import Flags, Ints

ORIENT = "orient"
WORDED = frozenset({CALL, *TAKES_MOTION} - OWN_MOVES | {ORIENT})
"""Acts whose block moves by no words of axes: it has none, or they are theirs."""
BY_TABLES = "tilted planes go with the table as its axes stand in the machine file"
BETWEEN = "between the plane and the code that turns the tool onto it"
TURN_FIRST = "write G53.1 before: only then words lead where the plane says"
LOST = "where the axes of a tilted plane stand is not known any more"
INERT = (
    "write G69 before what may turn them, and the plane anew behind it; or say which M codes move "
    "no axis: inert-m in [control] of the machine file"
)
STILL = "a plane goes with the table: write G69 before the axis turns, and the plane anew behind it"


class InPlanes:
    """Looks at the stretches of a window; `own` (lines,) move in ways of their own.

    any   whether a tilted plane is said in the window, or in force before it
    """

    def __init__(self, track: Track, of: Stretches, own: Flags, lost: Flags) -> None:
        self.track, self.own, self.lost = track, own, lost
        lines = track.lines
        rule = track.dialect.tip_rule.planes
        said = {
            act.code
            for shape in {int(lines.shape[line]) for line in of.acts if rule}
            for act in lines.table.meanings[shape].acts
        }
        self.any = track.state.frames.plane is not None or bool(said & rule.keys())

    def check(self, first: int, last: int, acts: bool) -> None:
        """Refuse what a stretch may not do in the plane in force behind its first line.

        `acts`: its first line acts on the frame.
        """
        plane = self.track.state.frames.plane
        if plane is None:
            return
        orients = acts and self._acts(first, {ORIENT})
        if orients:
            self.track.state.assumed[BY_TABLES] = None
        behind = first + (acts and self._acts(first, WORDED))
        moving = np.flatnonzero((self.track.worded | self.own)[behind:last]) + behind
        turning = moving[self._turn(moving)]
        if not plane.angles:
            self._refuse(moving, f"a move {BETWEEN}", TURN_FIRST)
        elif len(turning):
            self._refuse(turning, "a rotary axis turns in a tilted plane", STILL)
        elif not orients:
            self._refuse(moving[moving >= self._lost_from(first, last)], LOST, INERT)

    def _acts(self, line: int, names: Set[str]) -> bool:
        lines = self.track.lines
        acts = lines.table.meanings[int(lines.shape[line])].acts
        return any(act.name in names for act in acts)

    def _turn(self, lines: Ints) -> Flags:
        """Return which lines name a rotary axis of the table."""
        plane, turns = self.track.state.frames.plane, np.zeros(len(lines), np.bool_)
        assert plane is not None
        for axis in plane.angles:
            word = self.track.column(axis)
            if word is not None:
                turns |= word[1][lines]
        return turns

    def _lost_from(self, first: int, last: int) -> int:
        """Return the line of a stretch from which the axes may have turned; `last` if none."""
        frames, position = self.track.state.frames, self.track.state.position
        assert frames.plane is not None
        for axis, angle in frames.plane.angles.items():
            k = frames.axes.index(axis)
            if not abs(position[k] - frames.machine[k] - angle) <= EQUAL:  # nan is not known
                return first
        lost = np.flatnonzero(self.lost[first:last])
        return first + int(lost[0]) if len(lost) else last

    def _refuse(self, lines: Ints, message: str, hint: str) -> None:
        for line in lines[:1].tolist():
            self.track.findings.add(line, "GX213", message, hint=hint)
