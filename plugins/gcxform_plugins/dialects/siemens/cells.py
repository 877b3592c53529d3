"""Variables of a program for a SINUMERIK: types, arrays, and what is known of their values.

A number is a float whatever its type; what only the control knows is `LOST`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.arithmetic import LARGEST, ROUND

Value = float | str | None
LOST: Value = None
"""The value of what only the control knows."""
SOME = 100_000  # elements of an array


def converted(kind: str, value: Value) -> Value:
    """Return a value as a variable of a type takes it. Raises NoValueError.

    REAL to INT rounds as ROUND does, and all but 0 is TRUE (Job planning 07/2010 p. 54).
    """
    if value is LOST:
        return LOST
    if kind in ("STRING", "AXIS", "FRAME"):
        if not isinstance(value, str):
            raise v.NoValueError(f"a number is no {kind}")
        return value
    if isinstance(value, str):
        if kind == "BOOL":
            return float(bool(value))
        if kind == "CHAR" and len(value) == 1:
            return float(ord(value))
        raise v.NoValueError(f"a text is no {kind}")
    if kind == "BOOL":
        return float(value != 0)
    if kind in ("INT", "CHAR"):
        whole = float(ROUND(value))
        if not (-LARGEST <= whole < LARGEST if kind == "INT" else 0 <= whole < 256):
            raise v.NoValueError(f"{value:.10g} is no {kind}")
        return whole
    return value


def initial(kind: str) -> Value:
    """Return the value of a variable that is defined without one."""
    if kind == "STRING":
        return ""
    return LOST if kind in ("AXIS", "FRAME") else 0.0


@dataclass
class Cell:
    """A variable: its type, its size in each dimension (none for a single value), its values.

    `most` is how many characters a text may have, where that is said.
    """

    kind: str
    size: tuple[int, ...] = ()
    values: list[Value] = field(default_factory=list)
    most: int | None = None

    @classmethod
    def new(cls, kind: str, size: tuple[int, ...] = ()) -> Cell:
        """Return a variable as it is when it is defined. Raises NoValueError."""
        count = math.prod(size)
        if not all(each > 0 for each in size) or count > SOME:
            raise v.NoValueError(f"an array of {count} elements")
        return cls(kind, size, [initial(kind)] * count)

    def place(self, index: Sequence[int]) -> int:
        """Return which of the values an index names. Raises NoValueError."""
        if len(index) != len(self.size):
            raise v.NoValueError(f"this array has {len(self.size)} dimensions")
        at = 0
        for each, size in zip(index, self.size, strict=True):
            if not 0 <= each < size:
                raise v.NoValueError(f"element {each} of an array from 0 to {size - 1}")
            at = at * size + each
        return at

    def put(self, at: int, value: Value) -> None:
        """Set one of the values. Raises NoValueError for what the type does not take."""
        found = converted(self.kind, value)
        if isinstance(found, str) and self.most is not None and len(found) > self.most:
            raise v.NoValueError(f"a text of {len(found)} characters in a STRING[{self.most}]")
        self.values[at] = found

    def lose(self) -> None:
        """Forget its values."""
        self.values = [LOST] * len(self.values)
