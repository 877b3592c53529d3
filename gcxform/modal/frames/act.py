"""What an act on the frame is: a function from the state before it to the state after it.

What a control leaves open, or what is known of it from hearsay only, is refused by name.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import NamedTuple

from gcxform.dialect.dialect import Dialect
from gcxform.modal.frame_state import FrameState
from gcxform.modal.state import Reading
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import Plane


class ActError(Exception):
    """A block asks for what is not understood: code of the catalogue, message, hint."""

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint


class Asked(NamedTuple):
    """A block that acts: its code, and all that its effect depends on; it is made for each.

    words     numbers of the words it takes, lengths in mm, by address
    written   the same numbers as they stand in the block
    axes      the axes it names, with their words in mm or degrees, X as a radius
    position  (axes,) where the axes stand before the block
    ends      what the machine file says of a call that is kept
    lost      axes, as bits, that something has taken where they are not known
    """

    code: str
    words: Mapping[str, float]
    written: Mapping[str, float]
    axes: Mapping[str, float]
    position: Floats
    incremental: bool
    plane: Plane
    tool_word: float
    dialect: type[Dialect]
    reading: Reading
    ends: str = ""
    lost: int = 0

    def column(self, state: FrameState, axis: str) -> int:
        """Return the index of an axis."""
        return state.axes.index(axis)

    @property
    def numbers(self) -> str:
        """The letters, besides axes, of the words that the code takes: with these it says which."""
        return letters_of(self.dialect, self.code)


def letters_of(dialect: type[Dialect], name: str) -> str:
    """Return the letters, besides axes, of the words that a code takes."""
    code = dialect.codes.get(name)
    return "".join(a for a in (code.takes if code else "") if a not in dialect.axes)


Act = Callable[[FrameState, Asked], FrameState]
