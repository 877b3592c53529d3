"""What is noted of single lines: assignments, what only the machine knows, calls that are kept."""

from __future__ import annotations

from typing import NamedTuple

from gcxform.dialect.arithmetic import Key
from gcxform.toolpath.frames import Frame


class Assigned(NamedTuple):
    """A parameter that a line of the program, from 0, has set, and its value.

    `text` is the assignment itself where only the machine knows the value, which is nan then.
    """

    line: int
    key: Key
    value: float
    text: str = ""


class Unknown(NamedTuple):
    """A piece of a line of the window, from 0, that only the machine can compute.

    `text` has no blanks. `hangs_on` is what of the program its value depends on besides parameters:
    "" for nothing, "units", "place" for the places of the axes and modes, "motion" for these and
    the code of motion or the canned cycle in force. `BY_WAY`: nothing
    is computed; it is by how much a block goes. `rounded`: its value is known but for the increment
    to which the control rounds it.
    """

    line: int
    text: str
    hangs_on: str
    rounded: bool = False


class WayHome(NamedTuple):
    """A line that only goes to a point of the machine which is known.

    code    the code that it is said by
    frame   the frame of the machine
    bare    whether it names no axis
    called  whether a tool length is in force, or may be
    """

    code: str
    frame: Frame
    bare: bool
    called: bool

    @property
    def asked(self) -> tuple[str, bool, bool]:
        """What `Saying.moves_home` is asked about it."""
        return self.code, self.bare, self.called


class KeptCall(NamedTuple):
    """A call, in a line of the window, from 0, whose program is not there to be read.

    `ends` is what the machine file says of it: "unchanged", "unknown", "at XYZ", or nothing.
    """

    line: int
    name: str
    ends: str


BY_WAY = "way"
AT = "at "
"""What the axes begin with that a call leaves where it names them."""
