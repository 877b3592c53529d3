"""What Siemens' compensation files share: assignments to system variables, and equal steps."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import ClassVar, TypeVar

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats

AXES = "XYZ"
UNITS = {"mm": 1.0, "in": 25.4}
WORDS = r"[^\s\[\],=]+"
GRAIN = 1e6  # per mm: positions are whole nanometres
_ASSIGNMENT = re.compile(r"\s*\$\w+\s*\[[^\]]*\]\s*=\s*[^\s=]+\s*")
_FRAME = re.compile(r"%_N_\w+_INI|CHANDATA\(\d+\)|M17|M30", re.I)


def assignments(path: Path, widths: Mapping[str, int]) -> Iterator[gx.TextRow]:
    """Yield the assignments of a file, whose words are the variable, its indices and the value.

    `widths` says how many words each variable takes. Raises UsageError for all other lines.
    """
    for row in gx.text_rows(path, WORDS, ";"):
        name = row.word(0).upper()
        if _FRAME.fullmatch(name) and len(row.words) == 1:
            continue
        if not name.startswith("$"):
            raise row.refuse("GX482", f"{row.word(0)!r} has no meaning in this file", 0)
        if name not in widths:
            raise row.refuse("GX482", f"the variable {row.word(0)} is not known here", 0)
        text = row.text.partition(";")[0]
        if not _ASSIGNMENT.fullmatch(text) or len(row.words) != widths[name]:
            raise row.refuse("GX418", f"this is no assignment to {row.word(0)}", 0)
        yield row


def whole(row: gx.TextRow, column: int) -> int:
    """Return a whole number. Raises UsageError for another word."""
    if not re.fullmatch("[0-9]{1,6}", row.word(column)):
        raise row.refuse("GX419", f"{row.word(column)!r} is not an index", column)
    return int(row.word(column))


def finite(row: gx.TextRow) -> float:
    """Return the value of an assignment, which is its last word."""
    column = len(row.words) - 1
    value = row.number(column)
    if not math.isfinite(value):
        raise row.refuse("GX412", f"{row.word(0)} is {row.word(column)}", column)
    return value


Key = TypeVar("Key")


class Compensation(gx.ErrorFormat):
    """A file of compensation values: `axes` is an option, `value` the variable of the values."""

    axes: str
    value: ClassVar[str]
    suffixes: ClassVar[tuple[str, ...]] = (".ini",)

    def __post_init__(self) -> None:
        names_of(self.axes, "axes")

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file begins with values of this compensation."""
        return cls.value in gx.head_of(path).upper()

    def read_tables(
        self, path: Path, widths: Mapping[str, int], key: Callable[[gx.TextRow], Key]
    ) -> dict[Key, Table]:
        """Return the tables of a file by what `key` says of their rows. Raises UsageError."""
        found: dict[Key, Table] = {}
        for row in assignments(path, widths):
            table = found.setdefault(key(row), Table())
            if row.word(0).upper() == self.value:
                table.put(row, whole(row, 2))
            else:
                table.set(row, row.word(0).upper().removeprefix(self.value))
        if not found:
            raise gx.UsageError.one("GX417", "the file has no table", gx.Location(str(path)))
        return found


class Table:
    """One table of a file while it is read: the values by index, and the other variables."""

    def __init__(self) -> None:
        self.values: dict[int, float] = {}
        self.rows: dict[str, gx.TextRow] = {}
        self.last: gx.TextRow | None = None

    def put(self, row: gx.TextRow, index: int) -> None:
        """Take one compensation value."""
        if index in self.values:
            raise row.refuse("GX483", f"the value {index} stands twice", 0)
        self.values[index] = finite(row)
        self.last = row

    def set(self, row: gx.TextRow, key: str) -> None:
        """Take another variable of the table."""
        if key in self.rows:
            raise row.refuse("GX483", f"{row.word(0)} stands twice", 0)
        self.rows[key] = row
        self.last = row

    def number(self, key: str, default: float | None = None) -> float:
        """Return a variable. Raises UsageError for one that is missing."""
        if key in self.rows:
            return finite(self.rows[key])
        if default is not None:
            return default
        assert self.last is not None
        raise self.last.refuse("GX417", f"the table has no {key}", 0)

    def refuse_unless_zero(self, key: str, why: str) -> None:
        """Refuse a table with a function that has no meaning here."""
        if self.number(key, 0.0):
            raise self.rows[key].refuse("GX482", why, 0)

    def points(self) -> tuple[Floats, Floats]:
        """Return positions and values. Raises UsageError unless there is one at each step."""
        low, high, step = (self.number(key) for key in ("_MIN", "_MAX", "_STEP"))
        if not step > 0 or not low < high:
            message = f"there are no steps of {step:g} from {low:g} to {high:g}"
            raise self.rows["_STEP"].refuse("GX408", message, 0)
        last = min((high - low) / step, 1e9)
        if abs(last - round(last)) > 1e-6:
            message = f"{step:g} does not go into {low:g} to {high:g} a whole number of times"
            raise self.rows["_STEP"].refuse("GX483", message, 0)
        count = round(last) + 1
        if set(self.values) != set(range(min(count, len(self.values) + 1))):
            message = f"the table has not one value for each of {count} positions"
            raise self.rows["_STEP"].refuse("GX483", message, 0)
        positions: Floats = low + step * np.arange(count, dtype=np.float64)
        return positions, np.array([self.values[k] for k in range(count)])


def stepped(name: str, axis: str, position: Floats, most: int) -> Floats:
    """Return equally spaced positions (mm) which hold all those of a function.

    Raises UsageError if they are more than `most`.
    """
    grains = np.round(position * GRAIN).astype(np.int64)
    step = int(np.gcd.reduce(np.diff(grains)))
    count = int(grains[-1] - grains[0]) // step + 1 if step else most + 1
    if count > most:
        hint = f"points={count}, if the control has room for them"
        what = f"the positions of {axis}: equal steps that hold all of them need {count} points"
        raise gx.cannot_hold(name, what, hint)
    return np.asarray((grains[0] + step * np.arange(count)) / GRAIN)


def names_of(option: str, owner: str) -> dict[str, str]:
    """Return axes by their names in the control, of an option such as `X1,Y1,Z1`."""
    names = [name.strip().upper() for name in option.split(",")]
    if len(names) != 3 or len(set(names)) != 3 or not all(names):
        raise ValueError(f"{owner} is not three names, of X, Y and Z: {option!r}")
    return dict(zip(names, AXES, strict=True))
