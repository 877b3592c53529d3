"""What blocks may do in a tilted plane, or while a tip is followed, so that words lead as they say.

Between G68.2 and G53.1 controls differ in where they lead, and behind G53.1 they hold as long as
the rotary axes stand still. So do those of a tip behind G43.4.
"""

from __future__ import annotations

from collections.abc import Set

import numpy as np

from gcxform.dialect.code_translation import FOLLOW
from gcxform.modal.frame_state import TiltedPlane
from gcxform.modal.frames.followed_tips import BY_RTCP
from gcxform.modal.frames.planes import EQUAL
from gcxform.modal.frames.track import Track
from gcxform.modal.meaning.calls import CALL
from gcxform.modal.meaning.meaning import ORIENTING, OWN_MOVES, TAKES_MOTION
from gcxform.modal.moves.rows import Stretches
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Ints

WORDED = frozenset({CALL, *TAKES_MOTION} - OWN_MOVES | ORIENTING)
"""Acts whose block moves by no words of axes: it has none, or they are theirs."""
BY_TABLES = {
    **dict.fromkeys(
        ORIENTING, "tilted planes go with the table as its axes stand in the machine file"
    ),
    FOLLOW: "tips are followed on the table as its axes stand in the machine file",
}
BETWEEN = "between the plane and the code that turns the tool onto it"
TURN_FIRST = "write G53.1 before: only then words lead where the plane says"
INERT = (
    "write {} before what may turn them, and {} anew behind it; or say which M codes move "
    "no axis: inert-m in [control] of the machine file"
)
STILL = (
    "a plane goes with the table: write G69, CYCLE800() or PLANE RESET STAY before the axis turns, "
    "and the plane anew behind it"
)
UNTIPPED = "draw the tool back, and write G49 before"


class InPlanes:
    """Looks at the stretches of a window; `own` (lines,) move in ways of their own.

    any   whether a tilted plane or a tip is said in the window, or in force before it
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
        said = {name for name in BY_TABLES if acts and self._acts(first, {name})}
        self.track.state.assumed |= {BY_TABLES[name]: None for name in said}
        behind = first + (acts and self._acts(first, WORDED))
        moving = np.flatnonzero((self.track.worded | self.own)[behind:last]) + behind
        turning = moving[self._turn(plane, moving)]
        if not plane.angles:
            self._refuse(moving, f"a move {BETWEEN}", TURN_FIRST)
        elif len(turning) and plane.tip:
            self._refuse(turning, "a rotary axis turns while the control follows the tip", BY_RTCP)
        elif len(turning):
            self._refuse(turning, "a rotary axis turns in a tilted plane", STILL)
        elif not said & ORIENTING:
            what, hint = (
                "a tilted plane",
                INERT.format("G69, CYCLE800() or PLANE RESET STAY", "the plane"),
            )
            if plane.tip:
                what = "a tip that is followed"
                hint = f"draw the tool back, and {INERT.format('G49', 'G43.4')}"
            lost = moving[moving >= self._lost_from(first, last)]
            self._refuse(lost, f"where the axes of {what} stand is not known any more", hint)
        if plane.tip:
            self._check_tip(plane, first, last)

    def _check_tip(self, plane: TiltedPlane, first: int, last: int) -> None:
        """Refuse places of the machine by way of words, and what is more than lines where tilted.

        Arcs are looked at where they are read.
        """
        here = np.arange(first, last)
        home = self.own[here] & self._homing(first)
        self._refuse(here[self.own[here] & ~home], "a move of its own from a tip", UNTIPPED)
        if not self.track.frame.tilts(2):
            return
        drills = self.track.modes.cycle[here] != CYCLE_OFF
        self._refuse(here[drills], "a canned cycle of a tip that is tilted", BY_RTCP)

    def _homing(self, line: int) -> bool:
        """Whether a line goes home from where it stands, so that no word of the tip counts."""
        words = self.track.words_on(line)
        steps = bool(self.track.modes.incremental[line]) or not words
        return self._acts(line, {"home"}) and steps and not any(words.values())

    def _acts(self, line: int, names: Set[str]) -> bool:
        lines = self.track.lines
        acts = lines.table.meanings[int(lines.shape[line])].acts
        return any(act.name in names for act in acts)

    def _turn(self, plane: TiltedPlane, lines: Ints) -> Flags:
        """Return which lines turn an axis of the table away from where it stands."""
        frames, turns = self.track.state.frames, np.zeros(len(lines), np.bool_)
        for axis, angle in plane.angles.items():
            word = self.track.column(axis)
            if word is not None:
                k = frames.axes.index(axis)
                zero = frames.machine[k] + angle - self.track.frame.shift[k]
                there = np.where(self.track.modes.incremental[lines], 0.0, zero)
                stays = np.abs(word[0][lines] - there) <= EQUAL  # nan is not known
                turns |= word[1][lines] & (~stays | self.own[lines])
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
