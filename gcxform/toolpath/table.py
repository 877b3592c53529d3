"""A toolpath as a table: a numpy array of records, or a frame of pandas or polars (extras)."""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from gcxform.diagnostics import UsageError
from gcxform.system.arrays import Floats, Ints

if TYPE_CHECKING:
    import pandas
    import polars

COUNTED = ("kind", "form", "feed_mode", "side")


class Tabled:
    """What a toolpath is as a table; `words_of` are the columns whose numbers have names."""

    words_of: ClassVar[Mapping[str, type[IntEnum]]] = {}
    axes: str
    end: Floats
    source: Ints

    def columns(self) -> dict[str, Any]:
        """Return arrays (n,) by name, of one row a move.

        `line` is the line of the program, from 1 (of the executed one where there are calls), `nth`
        which of its moves; then the axes by their letters, where the move ends (mm, degrees), feed
        (mm/min, 1/min or mm/turn, by feed_mode), and kind, form, feed_mode and side as numbers of
        `Toolpath`. nan is not known.
        """
        found: dict[str, Any] = {"line": self.source + 1, "nth": getattr(self, "nth")}  # noqa: B009
        found |= {letter: self.end[:, k] for k, letter in enumerate(self.axes)}
        found["feed"] = getattr(self, "feed")  # noqa: B009
        return found | {name: getattr(self, name) for name in COUNTED}

    def to_numpy(self) -> np.ndarray[Any, np.dtype[np.void]]:
        """Return the columns as an array (n,) of records: `table["X"]`."""
        columns = self.columns()
        kinds = [(name, column.dtype) for name, column in columns.items()]
        table = np.empty(len(self.source), dtype=kinds)
        for name, column in columns.items():
            table[name] = column
        return table

    def to_pandas(self) -> pandas.DataFrame:
        """Return the columns as a frame of pandas, with words for kinds: `rapid`, `arc-cw`.

        Raises UsageError without the extra `pandas`.
        """
        _needs("pandas")
        import pandas

        data = self.columns()
        for name, (words, numbers) in self._coded(data).items():
            data[name] = pandas.Categorical.from_codes(numbers, words)
        return pandas.DataFrame(data)

    def to_polars(self) -> polars.DataFrame:
        """Return the columns as a frame of polars, with words for kinds; null is not known.

        Raises UsageError without the extra `polars`.
        """
        _needs("polars")
        import polars

        data = self.columns()
        kinds: Any = {}
        for name, (words, numbers) in self._coded(data).items():
            data[name] = np.array(words)[numbers]
            kinds[name] = polars.Enum(words)
        return polars.DataFrame(data, nan_to_null=True).cast(kinds)

    def _coded(self, columns: Mapping[str, Any]) -> dict[str, tuple[list[str], Ints]]:
        """Return the words of columns, and which (n,) of them each row has."""
        found = {}
        for name, kind in self.words_of.items():
            known = [each.value for each in kind]
            words = [each.name.lower().replace("_", "-") for each in kind]
            found[name] = words, np.searchsorted(known, columns[name])
        return found


def _needs(extra: str) -> None:
    """Raise UsageError if a library of an extra is not installed."""
    if find_spec(extra) is None:
        message = f"{extra} is not installed"
        raise UsageError.one("GX736", message, hint=f"pip install 'gcxform[{extra}]'")
