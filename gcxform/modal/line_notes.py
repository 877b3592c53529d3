"""What is noted of single lines: assignments, what only the machine knows, calls that are kept."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.system.arrays import Floats, Ints
from gcxform.system.records import of_rows
from gcxform.toolpath.frames import Frame
from gcxform.values import dataclass


class Assigned(NamedTuple):
    """A parameter that a line of the program, from 0, has set, and its value.

    `text` is the assignment itself where only the machine knows the value, which is nan then.
    """

    line: int
    key: Key
    value: float
    text: str = ""


@dataclass(frozen=True)
class Assignments:
    """What the lines of a window have set, in order, in columns: there may be one in every line.

    line   (n,) of the program, from 0
    names  the parameters, each with the text of the assignment if only the machine knows the value
    which  (n,) of the names it is that is set
    value  (n,)
    """

    line: Ints
    names: tuple[tuple[Key, str], ...]
    which: Ints
    value: Floats

    @classmethod
    def of(cls, made: Sequence[Assigned]) -> Assignments:
        """Return assignments in columns."""
        numbers: dict[tuple[Key, str], int] = {}
        which = [numbers.setdefault((each.key, each.text), len(numbers)) for each in made]
        line, value = [each.line for each in made], [each.value for each in made]
        columns = np.array(line, np.int64), np.array(which, np.int64), np.array(value, np.float64)
        return cls(columns[0], tuple(numbers), *columns[1:])

    def __len__(self) -> int:
        return len(self.line)

    def __iter__(self) -> Iterator[Assigned]:
        """Yield them one by one."""
        names = [self.names[number] for number in self.which.tolist()]
        keys, texts = ([name[part] for name in names] for part in (0, 1))
        columns = self.line.tolist(), keys, self.value.tolist(), texts
        return of_rows(Assigned, zip(*columns, strict=True))

    def named_by(self, names: Sequence[tuple[Key, str]]) -> Ints:
        """Return which (n,) of other names it is that is set; -1 for none."""
        numbers = {name: number for number, name in enumerate(names)}
        found = np.array([numbers.get(name, -1) for name in self.names], np.int64)
        return found[self.which]


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

    @property
    def led(self) -> str:
        """The axes that are behind it where its block says."""
        return self.ends.removeprefix(AT) if self.ends.startswith(AT) else ""


def call_of(calls: Sequence[KeptCall], line: int) -> KeptCall | None:
    """Return the call of a line among some in order; None where it has none."""
    at = bisect_left(calls, line, key=attrgetter("line"))
    return calls[at] if at < len(calls) and calls[at].line == line else None


BY_WAY = "way"
AT = "at "
"""What the axes begin with that a call leaves where it names them."""
