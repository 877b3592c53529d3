"""Moves of a SINUMERIK as blocks of words: distances, rotary axes that go a way, arcs."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.shared.ways import IN_SPINDLE
from gcxform_plugins.dialects.siemens import arcs as arcs
from gcxform_plugins.dialects.siemens.cycle_calls import CycleCalls
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, NOBODYS, STEP, Line
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY
from gcxform_plugins.dialects.siemens.reading import NO_OFFSET, REASONS

EDGE = (
    "say D1 before; or edge-after-tool-change = 1 in [control] of the machine file, or 0, as it is"
)
OF_WHICH = "D1 of the tool in the spindle, and which that is is not known"
ALONG = 'move in G17; or say tool-length-axis = "Z" in [control], if it stays there (SD42940)'
START = (
    "write G1 in this block, or G0 if the way is clear; or say "
    'motion-at-start = "G1" in [control], or motion-at-start = "G0" in [control], as it is'
)
BY = (
    'write M6 behind T; or say tool-change-by = "T" in [control], or tool-change-by = "M6" in '
    "[control], as it is"
)
ARCS = ("2", "3", "CIP", "CT")
LINEAR_WAY = (
    'write ORIAXES and ORIMKS; or say orientation-path = "angles" in [control], if it is so'
)


class Moves(CycleCalls):
    """Makes the block of a move."""

    def motion_code(self, line: Line, motion: str) -> list[str]:
        """Return the motion code where the line has one, or another is in force in the blocks."""
        if motion == self.said and not line.motion:
            return []
        self.said = motion
        return [f"G{motion}"]

    def distance_code(self, line: Line, steps: bool) -> list[str]:
        """Return G90 or G91 where the other is in force in the blocks, or stands in the line."""
        if steps == self.said_steps:
            return []
        self.said_steps = steps
        line.codes[:] = [code for code in line.codes if code not in ("G90", "G91")]
        return ["G91" if steps else "G90"]

    def block_of(self, line: Line) -> str:
        """Return the block of words of a line. Raises InputError and PlaceError."""
        self.motion = line.motion or self.motion
        if line.axes or line.centres or line.named or line.middles:
            return self._moving(line)
        codes = self.motion_code(line, line.motion) if line.motion.isdigit() else []
        return " ".join([*line.codes, *codes, *rest_of(line)])

    def _moving(self, line: Line) -> str:
        self._check_tool(line)
        if not self.motion:
            message = "axis words, but no motion code is in force: a setting decides (MD20150)"
            raise self.refusal("GX209", message, self.any_of(line), START)
        self.place.moved = True
        if self.following and self.motion != "0":
            self._check_turning(line)
        motion, computed, arc = self.motion, dict[str, float](), list[str]()
        if motion in ARCS:
            motion, computed, arc = self._arc(line)
        elif line.centres or line.named or line.middles:
            self.refuse("words of an arc in a block that is none", self.first_of(line))
        steps, words = self._words(line, computed)
        words = self.outside(steps, words)
        if self.motion in ARCS and motion != "1":
            motion, arc = self.arc_outside(motion, arc)
        codes = [*self.motion_code(line, motion), *self.distance_code(line, steps)]
        return " ".join([*line.codes, *codes, *words, *arc, *rest_of(line)])

    def outside(self, steps: bool, words: Sequence[str]) -> list[str]:
        """Return axis words as they are outside of the frame of the program."""
        raise NotImplementedError

    def arc_outside(self, motion: str, arc: Sequence[str]) -> tuple[str, list[str]]:
        """Return the code of an arc and its words, outside of the frame of the program."""
        raise NotImplementedError

    def any_of(self, line: Line) -> gx.Item | None:
        """Return a word of a move."""
        return next((words[-1] for words in line.axes.values()), None) or self.first_of(line)

    # --- checks ---

    @property
    def length_is_elsewhere(self) -> bool:
        """Whether the length of the tool may be along Y, in G18, or along X, in G19."""
        said = self.reading.control.get("tool-length-axis")
        return self.edge == "1" and self.plane != "XY" and said != "Z"

    def check_plane(self, item: gx.Item | None) -> None:
        """Refuse moves in planes that turn the length of the tool. Raises InputError."""
        if self.length_is_elsewhere:
            message = "D1 in G18 or G19: its length is across the plane, and not along Z"
            self.refuse(message, item, ALONG)

    def check_offset(self, item: gx.Item | None) -> None:
        """Refuse moves that count from a zero which only the control knows."""
        if self.work == NO_OFFSET:
            self.refuse(REASONS["500"], item, "write a work offset, or SUPA")

    def _check_tool(self, line: Line) -> None:
        """Refuse moves of a tool of which the control alone knows the length."""
        self.check_plane(self.any_of(line))
        self.check_offset(self.any_of(line))
        item = next((line.axes[a][2] for a in LINEAR if a in line.axes), None)
        if item is None:
            return
        if self.edge == NOBODYS and self._counts_length(line):
            self.refuse(OF_WHICH, item, IN_SPINDLE)
        if self.changed and self.edge is None and self._counts_length(line):
            message = "behind M6 a setting of the control decides which edge is in force (MD20270)"
            self.refuse(message, item, EDGE)
        by = self.reading.control.get("tool-change-by")
        if self.waiting is not None and not self.changed and by is None:
            message = "T without M6: a setting decides whether it changes the tool (MD22550)"
            self.refuse(message, item, BY)

    def _counts_length(self, line: Line) -> bool:
        return "Z" in line.axes or not self.length_is_along_z

    @property
    def length_is_along_z(self) -> bool:
        """Whether the length of a tool counts in words of Z alone, in the plane that is in force.

        Length 1 of a milling tool is along the axis across the plane (Tool offset 11/2006, 2.5).
        """
        across = self.plane == "XY" or self.reading.control.get("tool-length-axis") == "Z"
        return across and self.keeps_radii and not self.following

    def _check_turning(self, line: Line) -> None:
        """Refuse cuts that turn axes where the tool axis may take another way than the angles."""
        if self.angles_change_in_proportion:
            return
        turning = [line.axes[a] for a in ROTARY if a in line.axes and self._turns(a, line)]
        if turning:
            why = f" in {' '.join(filter(None, self.orientation))}" if any(self.orientation) else ""
            message = f"TRAORI: whether angles change in proportion{why} is not known"
            self.refuse(message, turning[0][2], LINEAR_WAY)

    @property
    def angles_change_in_proportion(self) -> bool:
        """Whether the program or the machine file says so; else the tool axis may do it."""
        said, reference = self.orientation
        if self.reading.control.get("orientation-path") == "angles":
            return said not in ("ORIVECT", "ORIPLANE")
        return said == "ORIAXES" and reference != "ORIWKS"

    def _turns(self, axis: str, line: Line) -> bool:
        """Whether a word may turn its axis."""
        way, number, _ = line.axes[axis]
        if way == STEP or (not way and self.steps):
            return bool(Decimal(number))
        before = self.place.known(axis)
        if before is None:
            return True
        turn = before - Decimal(number)
        return bool(turn if way in ("", ABSOLUTE) else turn % 360)

    # --- axis words ---

    def _steps(self, way: str) -> bool:
        return way == STEP or (not way and self.steps)

    def _words(self, line: Line, computed: dict[str, float]) -> tuple[bool, list[str]]:
        """Return whether a line is incremental, and its axis words.

        A line of both kinds becomes absolute. Raises PlaceError.
        """
        place, axes = self.place, line.axes
        if not axes and not computed:
            return self.said_steps, []
        ways = {self._steps(way) for way, _, _ in axes.values()}
        if ways == {False} and not computed:
            return False, [axis + self._absolute(axis, line) for axis in axes]
        if ways == {True} and not computed:
            for axis, (_, number, _) in axes.items():
                place.step(axis, number)
            return True, [axis + number for axis, (_, number, _) in axes.items()]
        words = []
        for axis, (way, number, _) in axes.items():
            stepped = self._steps(way)
            words.append(
                axis + (place.stepped(axis, number) if stepped else self._absolute(axis, line))
            )
        for axis, text in zip(computed, arcs.decimals(computed), strict=True):
            place.absolute(axis, text[1:])
            words.append(text)
        return False, words

    def _absolute(self, axis: str, line: Line) -> str:
        way, number, _ = line.axes[axis]
        if way not in ("", ABSOLUTE):
            return self.place.turned(axis, way, number, self.motion == "0")
        self.place.absolute(axis, number)
        return number

    # --- arcs ---

    def _ends(self, line: Line) -> dict[str, float]:
        """Return where words of X, Y, Z lead to, as far as that is known."""
        ends = {}
        for axis in line.axes.keys() & set(LINEAR):
            way, number, _ = line.axes[axis]
            start = self.place.known(axis)
            if not self._steps(way):
                ends[axis] = float(number)
            elif start is not None:
                ends[axis] = float(start + Decimal(number))
        return ends

    def _arc(self, line: Line) -> tuple[str, dict[str, float], list[str]]:
        """Return the code of an arc, computed ends, and its other words. Raises PlaceError."""
        place, plane = self.place, self.plane
        if self.motion == "CIP":
            return self._through(line, self._ends(line))
        if line.middles:
            self.refuse("I1, J1 and K1 belong to CIP", self.first_of(line))
        others = line.named.keys() - {"CR", "AR", "TURN"}
        if others:
            name = min(others)
            self.refuse(f"{name}= is no word of an arc", line.named[name][1])
        if not line.centres and not line.named.keys() & {"CR", "AR"}:
            message = "an arc without I, J, K, CR= or AR="
            raise self.refusal("GX210", message, self.any_of(line), "write its centre or radius")
        words = [arcs.turns(line, place, plane, self._ends(line))] if "TURN" in line.named else []
        if "AR" in line.named:
            self._alone_in(line, "AR")
            sense = 1 if self.motion == "3" else -1
            made = arcs.opened(line, place, plane, sense, self._ends(line))
            centres = {k: v for k, v in made.items() if k in "IJK"}
            computed = {k: v for k, v in made.items() if k not in "IJK"}
            return self.motion, computed, [*self._centred(False), *arcs.decimals(centres), *words]
        if "CR" in line.named:
            self._alone_in(line, "CR")
            return self.motion, {}, [f"R{line.named['CR'][0]}", *words]
        absolute, centres_ = arcs.centre_words(line, place, plane)
        return self.motion, {}, [*self._centred(absolute), *centres_, *words]

    def _alone_in(self, line: Line, name: str) -> None:
        others = {"CR", "AR"} & line.named.keys() - {name}
        if others or (name == "CR" and line.centres):
            self.refuse(f"{name}= beside other words that make an arc", line.named[name][1])

    def _centred(self, absolute: bool) -> list[str]:
        if absolute == self.said_centres:
            return []
        self.said_centres = absolute
        return ["G90.1" if absolute else "G91.1"]

    def _through(
        self, line: Line, ends: dict[str, float]
    ) -> tuple[str, dict[str, float], list[str]]:
        """Return an arc over a point; it is written in the plane that is in force."""
        if line.centres or line.named or not line.middles:
            self.refuse(
                "CIP takes I1=, J1= and K1=, and no other words of arcs", self.first_of(line)
            )
        if self.steps and any(not way for way, _, _ in line.middles.values()):
            self.refuse("CIP under G91: what its point is counted from", self.first_of(line))
        sense, centre = arcs.through(line, self.place, self.plane, ends)
        words = {arcs.CENTRES[a]: v for a, v in zip(self.plane, centre, strict=True)}
        return sense, {}, [*self._centred(False), *arcs.decimals(words)]


def rest_of(line: Line) -> list[str]:
    """Return the feed, and words of the spindle and the machine."""
    return [f"F{line.feed}", *line.others] if line.feed else line.others
