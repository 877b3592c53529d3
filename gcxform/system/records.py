"""Many small records, which go from process to process as columns.

Pickled one by one each asks Python what it is made of, which takes longer than to make it: a
program that computes has an assignment in every other line.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import fields, is_dataclass
from itertools import repeat
from operator import attrgetter
from typing import Any, TypeVar

Record = TypeVar("Record", covariant=True)
Tuple = TypeVar("Tuple", bound=tuple[Any, ...])


class Records(tuple[Record, ...]):
    """Named tuples, or objects of a dataclass that has more than one field, all of one kind."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Callable[..., Records[Any]], tuple[Any, ...]]:
        """Say what it is made of: the kind, and a column for each field."""
        if not self:
            return Records, ()
        kind: Any = type(self[0])
        rows = self if not is_dataclass(kind) else map(_getter(kind), self)
        return _of_columns, (kind, *zip(*rows, strict=True))


def _getter(kind: Any) -> Callable[[object], tuple[Any, ...]]:
    """Return what takes the fields of an object of a dataclass."""
    return attrgetter(*(each.name for each in fields(kind)))


def of_rows(kind: type[Tuple], rows: Iterable[tuple[Any, ...]]) -> Iterator[Tuple]:
    """Yield named tuples of rows that have a value for each field.

    The kind itself, and its `_make`, are Python, and take three times as long.
    """
    return map(tuple.__new__, repeat(kind), rows)


def _of_columns(kind: type[Any], *columns: tuple[Any, ...]) -> Records[Any]:
    if issubclass(kind, tuple):
        return Records(of_rows(kind, zip(*columns, strict=True)))
    return Records(map(kind, *columns))
