"""The computed lines of a window as columns, where it sets parameters and no order has to be asked.

What a line reads is what the line before it has set that did so last. All values of a parameter are
computed before those that read it, so this can be done unless one is computed of itself
(`#1=[#1+1]`), and unless a line needs more than numbers: then nothing is done here
(`NoColumnError`), and the lines are computed one by one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gcxform.dialect.arithmetic import Arithmetic, Key
from gcxform.dialect.null import Null
from gcxform.modal.expressions.compiled import NO_VALUE, NoColumnError
from gcxform.modal.expressions.functions import Functions, whole_columns
from gcxform.modal.line_notes import Assignments
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Group:
    """The lines of one outline, ascending, and the first number of each."""

    functions: Functions
    lines: Ints
    first: Ints


@dataclass(frozen=True, slots=True)
class Values:
    """What is computed: numbers of words, the assignments in order, and parameters behind them."""

    words: list[tuple[Ints, Any]]
    assigned: Assignments
    parameters: dict[Key, float]


class Straight:
    """The computed lines of one window; `parameters` are those before it."""

    def __init__(
        self,
        groups: list[Group],
        parameters: dict[Key, float],
        arithmetic: Arithmetic,
        value: Floats,
    ) -> None:
        self.groups = groups
        self.parameters = parameters
        self.arithmetic = arithmetic
        self.value = value
        self.makers: dict[Key, list[tuple[Group, int]]] = {}
        for group in groups:
            for nth, (key, _) in enumerate(group.functions.assigned_columns):
                self.makers.setdefault(key, []).append((group, nth))
        self.made: dict[Key, tuple[Ints, Floats, Ints]] = {}
        self.open: set[Key] = set()

    def compute(self, first_line: int) -> Values:
        """Compute all lines; `first_line` is that of the window. Raises NoColumnError."""
        if not all(map(self.arithmetic.owns, self.makers)):
            raise NoColumnError
        words = [
            (group.first + slot, column)
            for group in self.groups
            for slot, column in whole_columns(
                group.functions, Reader(self, group.lines), self.value, group.first
            )
        ]
        found = {key: self.values(key) for key in self.makers}
        behind = {key: float(column[-1]) for key, (_, column, _) in found.items()}
        return Values(words, _in_order(found, first_line), behind)

    def values(self, key: Key) -> tuple[Ints, Floats, Ints]:
        """Return the lines that set a parameter, ascending, the values, and which of the block."""
        if key in self.made:
            return self.made[key]
        if key in self.open:
            raise NoColumnError
        self.open.add(key)
        lines, values, places = [], [], []
        for group, nth in self.makers[key]:
            lines.append(group.lines)
            values.append(self._column(group, nth))
            places.append(np.full(len(group.lines), nth))
        every = np.concatenate(lines)
        order = np.argsort(every, kind="stable")
        self.made[key] = every[order], np.concatenate(values)[order], np.concatenate(places)[order]
        self.open.discard(key)
        return self.made[key]

    def _column(self, group: Group, nth: int) -> Floats:
        functions = group.functions
        operands = [self.value[group.first + slot] for slot in range(functions.slots)]
        try:
            found = functions.assigned_columns[nth][1](Reader(self, group.lines), operands)
        except NO_VALUE:
            raise NoColumnError from None
        column = np.broadcast_to(np.asarray(found, np.float64), group.lines.shape)
        if not np.isfinite(column).all():
            raise NoColumnError
        return column

    def read(self, key: Key, lines: Ints, default: Any) -> Any:
        """Return what a parameter is worth in lines: a column, or what it was before them all."""
        if key not in self.makers:
            return self.parameters.get(key, default)
        setting, values, _ = self.values(key)
        last = np.searchsorted(setting, lines) - 1
        if (last >= 0).all():
            return values[last]
        start = self.parameters.get(key, np.nan)
        if not -np.inf < start < np.inf or isinstance(start, Null):
            raise NoColumnError
        return np.where(last >= 0, values[last], start)


class Reader:
    """The parameters as lines read them."""

    def __init__(self, straight: Straight, lines: Ints) -> None:
        self.straight = straight
        self.lines = lines

    def get(self, key: Key, default: Any, /) -> Any:
        """Return a column, or a number."""
        return self.straight.read(key, self.lines, default)


def _in_order(found: dict[Key, tuple[Ints, Floats, Ints]], first_line: int) -> Assignments:
    """Return the assignments in the order in which they are made."""
    if not found:
        return Assignments.of(())
    lines, values, places = (np.concatenate(part) for part in zip(*found.values(), strict=True))
    which = np.repeat(np.arange(len(found)), [len(each) for each, _, _ in found.values()])
    order = np.lexsort((places, lines))
    names = tuple((key, "") for key in found)
    return Assignments(lines[order] + first_line, names, which[order], values[order])
