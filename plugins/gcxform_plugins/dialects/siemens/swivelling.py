"""CYCLE800 that turns a table onto a plane, where all positions have to be known.

    CYCLE800(_FR, _TC, _ST, _MODE, _X0, _Y0, _Z0, _A, _B, _C, _X1, _Y1, _Z1, _DIR, _FR_I, _DMODE)

A point p of the plane is at (X0, Y0, Z0) + R ((X1, Y1, Z1) + p), and R three turns about axes that
go along, in the order that _MODE says (public specification of CAM posts for this cycle; a job that
a CAM wrote for two machines and two controls). _DIR chooses the attitude: the lower or the higher
value of one axis, which the machine's builder has set (operating manual). Where that is followed is
in `gcxform/modal/frames/planes.py`: to it this is G68.2 and G53.1. What is drawn back before, or
follows the tip, moves X, Y and Z: where they are is lost. Where the call does not stay as it stands
that way would be missing, and the table would turn beside the tool: it is refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.siemens.cycles import NO_RETRACT, CycleError
from gcxform_plugins.dialects.siemens.frames import Frame, about
from gcxform_plugins.dialects.siemens.line import Line
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY
from gcxform_plugins.dialects.siemens.reading import Statements

ORDERS = {"57": "XYZ", "45": "XZY", "54": "YXZ", "30": "YZX", "39": "ZXY", "27": "ZYX"}
"""The axes of the three turns, by _MODE; solid and projected angles are other modes."""
WITH_TIP = "10"
NEW = frozenset(("", "0", WITH_TIP))
"""_ST of a plane that is no addition to another one; its ten lets the tip stay where it is."""
PLANE, TURN, LEAVE = "G68.2", "G53.1", "G69"
"""The codes of blocks that say a plane, turn the table onto it, and leave it."""
ENDS = "0"
"""_TC that ends a plane."""
G17 = frozenset(("", "0", "1"))
MOST = 16
NO_WAY = frozenset(("", NO_RETRACT))
WAY = "CYCLE800 draws the tool back or leads it along, and where to only the machine knows"
AWAY = "draw it back in a line before (G0 SUPA Z and where to), with 0 for _FR and for _ST"
APART = "CYCLE800 that turns a table, and more than its plane is in force"
ALONE = "write it where no frame of the program is in force, in G17, and outside of MCALL"


def plane_of(given: Sequence[str]) -> tuple[list[str], str]:
    """Return the words that say the plane, and those that turn the table. Raises CycleError."""
    values = [*given, *[""] * (MOST - len(given))]
    if len(given) > MOST or values[2] not in NEW or values[3] not in ORDERS:
        raise CycleError("_ST or _MODE asks for a plane that is added, or said in another way")
    if values[15] not in G17:
        raise CycleError("_DMODE asks for another plane than G17")
    numbers = [_number(each) for each in values[4:14]]
    before, angles, behind, way = numbers[:3], numbers[3:6], numbers[6:9], numbers[9]
    if way not in (-1, 0, 1):
        raise CycleError("_DIR is not -1, 0 or 1")
    frame = Frame(shift=(before[0], before[1], before[2]))
    for axis, angle in zip(ORDERS[values[3]], angles, strict=True):
        frame @= about(axis, angle)
    zero = frame.point(behind)
    words = zip("XYZIJK", (*map(float, zero), *_euler(frame)), strict=True)
    said = [f"{letter}{Decimal(repr(value)):f}" for letter, value in words]
    return [PLANE, *said], f"{TURN} P{int(way)}"


def _number(text: str) -> Decimal:
    if text and not gx.NUMBER.fullmatch(text):
        raise CycleError("an argument is not a plain number")
    return Decimal(text or "0")


def _euler(frame: Frame) -> tuple[float, ...]:
    """Return the angles about Z, X', Z'' of a frame, degrees, the second from 0 to 180."""
    rows = [[float(value) for value in row] for row in frame.matrix]
    tilt = math.atan2(math.hypot(rows[0][2], rows[1][2]), rows[2][2])
    if rows[0][2] == rows[1][2] == 0.0:
        first, last = 0.0, math.atan2(rows[1][0], rows[0][0])
    else:
        first = math.atan2(rows[0][2], -rows[1][2])
        last = math.atan2(rows[2][0], rows[2][1])
    return tuple(math.degrees(angle) for angle in (first, tilt, last))


class Swivelling(Statements):
    """Takes CYCLE800; `swivelled`: a plane is in force, by which words count."""

    swivelled = False

    def may_swivel(self, given: Sequence[str]) -> bool:
        """Whether a plane may be followed: on its own control, or folded; on a known table."""
        reading = self.reading
        own = reading.asides or reading.turns_plainly or not reading.crosses
        return own and not reading.stays and reading.tables is not None and given != [""]

    def take_swivel(self, line: Line, item: gx.Item, given: Sequence[str]) -> None:
        """Take a plane, or its end. Raises InputError."""
        reading, ends = self.reading, given[1:2] == [f'"{ENDS}"']
        goes = reading.crosses and not reading.asides if ends else reading.turns_plainly
        moves = given[0] not in NO_WAY or given[2:3] == [WITH_TIP]
        if moves and goes:
            self.refuse(WAY, item, AWAY)
        if ends:
            self.end_plane(line)
            line.asides += [self.text_of(item)] * reading.asides
            if moves:
                self._lose_all()
            return
        try:
            plane, attitude = plane_of(given)
        except CycleError as error:
            self.refuse(f"CYCLE800: {error}", item)
        self.leave_plane(line)
        apart = self.following or self.comp or self.drilling is not None or self.plane != "XY"
        if apart or self.frame != Frame():
            self.refuse(APART, item, ALONE)
        stays = reading.asides and not reading.turns_plainly
        said = gx.Speller.aside(self.text_of(item)) if stays else ""
        line.ahead += ["G90"] * self.said_steps  # of its own: the text of the call has no G90
        line.ahead += [" ".join([*plane, said]).rstrip(), f"G0 {attitude}"]
        self.said, self.said_steps, self.swivelled = "", False, True
        self._lose_all()

    def leave_plane(self, line: Line) -> None:
        """End a plane: where X, Y and Z are without it is not known."""
        if self.swivelled:
            line.ahead.append(LEAVE)
            self.swivelled = False
            self._lose_all()

    def end_plane(self, line: Line) -> None:
        """End a plane by a call: whether the table turns back is the choice of its builder."""
        if self.swivelled and self.reading.tables is not None:
            self.loses |= {*self.reading.tables.letters}
        self.leave_plane(line)

    def _lose_all(self) -> None:
        self.place.lose({*LINEAR, *(self.place.named & {*ROTARY})})
        self.loses |= {*LINEAR}
