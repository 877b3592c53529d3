"""What an execution did, step by step: which lines, in which order, and how many calls deep.

Who writes a program with its calls and loops needs to know which executed blocks a line stands for.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from gcxform.dialect.arithmetic import Arithmetic, Key
from gcxform.flow.executed import WrittenOut
from gcxform.flow.listing import Definition, Listing
from gcxform.modal.expressions.value import parameter_key
from gcxform.syntax.source import Source
from gcxform.system.arrays import Ints
from gcxform.system.distinct import distinct
from gcxform.values import dataclass

PARAMETER = re.compile(r"#[ \t]*(<[^<>]*>|[0-9]+)?")


class Step(NamedTuple):
    """A line that was executed, or plain lines in a row: from `first` up to `stop`, from 0.

    `block` is the first block that was written for it, or would have been; `depth` counts the calls
    that it stands in, `level` those of them that have parameters of their own.
    """

    first: int
    stop: int
    block: int
    depth: int
    level: int


class Steps:
    """Steps as they are done, one by one or many at once; a row of `table` is a `Step`."""

    def __init__(self) -> None:
        self._parts: list[Ints] = []
        self._last: list[Step] = []
        self._before = 0

    def __len__(self) -> int:
        return self._before + len(self._last)

    def __iter__(self) -> Iterator[Step]:
        return map(Step._make, self.table.tolist())

    def append(self, step: Step) -> None:
        """Add one."""
        self._last.append(step)

    def extend(self, steps: Ints) -> None:
        """Add many, (n, 5)."""
        self._parts += [_table(self._last), steps]
        self._before += len(self._last) + len(steps)
        self._last = []

    @property
    def table(self) -> Ints:
        """All of them, (n, 5)."""
        return np.concatenate([*self._parts, _table(self._last)])


def _table(steps: list[Step]) -> Ints:
    return np.array(steps, np.int64).reshape(-1, len(Step._fields))


class Made(NamedTuple):
    """An assignment that a step made."""

    step: int
    key: Key
    value: float


@dataclass(frozen=True)
class Walk:
    """One execution.

    table        its steps, (n, 5), as columns
    blocks       how many blocks were executed; what is kept behind the end follows them
    loops        first and last line of each loop, branches too
    definitions  the subprograms of the file, and those of them that stay: see `Execution.close`
    callees      by the first line of a definition: those that it may call
    files        those that are called, each as one definition
    deciding     the lines that decided what is executed next, or stored modes
    asked        by a line that was executed, those of which it looked at the conditions as well
    jumps        the steps that went to a line by its number
    made         the assignments, in order
    tied         why the order of execution rests on the path itself; nothing if it does not
    times        how often each line was executed, (lines,)
    said         parameters of a call whose assignments stand in the blocks that were executed
    """

    listing: Listing
    table: Ints
    blocks: int
    loops: tuple[tuple[int, int], ...]
    definitions: tuple[Definition, ...]
    kept: tuple[Definition, ...]
    callees: Mapping[int, tuple[Definition, ...]]
    files: tuple[Definition, ...]
    deciding: frozenset[int]
    asked: Mapping[int, set[int]]
    jumps: frozenset[int]
    made: tuple[Made, ...]
    tied: str
    times: Ints
    arithmetic: Arithmetic
    said: frozenset[Key] = frozenset()

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """The steps of the table, one by one."""
        return tuple(map(Step._make, self.table.tolist()))

    @cached_property
    def reads(self) -> dict[int, frozenset[Key | None]]:
        """The parameters that each line names; None for one that is computed."""
        found = {}
        for line in range(len(self.listing)):
            text = self.listing.window.line(line)
            if b"#" in text:
                names = PARAMETER.findall(text.decode("latin-1"))
                found[line] = frozenset(parameter_key(f"#{n}") if n else None for n in names)
        return found

    def block_end(self, step: int) -> int:
        """Return the block behind those of a step."""
        behind = step + 1
        return self.steps[behind].block if behind < len(self.steps) else self.blocks

    @cached_property
    def _returned(self) -> list[int]:
        found, open_ = [len(self.steps)] * len(self.steps), list[int]()
        for number, step in enumerate(self.steps):
            while open_ and self.steps[open_[-1]].depth >= step.depth:
                found[open_.pop()] = number
            open_.append(number)
        return found

    def returned(self, step: int) -> int:
        """Return the step behind a call: the first that is no deeper than the one that calls."""
        return self._returned[step]

    @cached_property
    def _left(self) -> list[int]:
        found, open_ = [len(self.steps)] * len(self.steps), list[int]()
        for number, step in enumerate(self.steps):
            while open_ and self.steps[open_[-1]].level > step.level:
                found[open_.pop()] = number
            open_.append(number)
        return found

    def left(self, step: int) -> int:
        """Return the step behind all those that have the parameters of a step."""
        return self._left[step]

    @cached_property
    def readers(self) -> dict[int, list[int]]:
        """The steps of the lines that name parameters, ascending."""
        found: dict[int, list[int]] = {}
        for number, step in enumerate(self.steps):
            for line in self.looked_at(step):
                if line in self.reads:
                    found.setdefault(line, []).append(number)
        return found

    def looked_at(self, step: Step) -> set[int]:
        """Return the lines of which a step reads the parameters."""
        return {*range(step.first, step.stop), *self.asked.get(step.first, ())}

    def calls(self, step: int) -> bool:
        """Whether a step begins a call."""
        behind = step + 1
        return behind < len(self.steps) and self.steps[behind].depth > self.steps[step].depth

    def passed_at(self, line: int) -> int | None:
        """Return the block before which a line was first executed or passed; None if never."""
        return next((step.block for step in self.steps if step.first == line), None)

    def made_by(self, begin: int, end: int) -> tuple[Made, ...]:
        """Return the assignments of steps up to one."""
        low, high = (bisect_left(self.made, at, key=lambda made: made.step) for at in (begin, end))
        return self.made[low:high]


class Walked(WrittenOut):
    """The blocks that a walk has executed, of which `text` is all of them."""

    def __init__(
        self, source: Source, text: bytes, origin: Ints, walk: Walk, assumed: Iterable[str]
    ) -> None:
        super().__init__(source, text, origin, assumed, walk.listing.files)
        self.walk = walk
        self.text = text


def parts_of(first: int, last: int, others: Iterable[tuple[int, int]]) -> tuple[int, int]:
    """Return lines from first to last, with all others that they overlap in part."""
    grown = True
    while grown:
        grown = False
        for begin, end in others:
            overlaps = begin <= last and first <= end
            nested = (first <= begin and end <= last) or (begin <= first and last <= end)
            if overlaps and not nested:
                first, last, grown = min(first, begin), max(last, end), True
    return first, last


def split(
    table: Ints, jumps: set[int], made: list[Made]
) -> tuple[Ints, frozenset[int], tuple[Made, ...]]:
    """Return steps in which every line that was jumped to begins one; jumps and assignments so."""
    begin = np.array(sorted(jumps), np.int64) + 1
    targets = distinct(table[begin[begin < len(table)], 0])
    low = np.searchsorted(targets, table[:, 0], "right")
    high = np.searchsorted(targets, table[:, 1], "left")
    more = np.maximum(high - low, 0)
    if not more.any():
        return table, frozenset(jumps), tuple(made)
    found: list[Step] = []
    for step, first, last in zip(
        map(Step._make, table.tolist()), low.tolist(), high.tolist(), strict=True
    ):
        begins = [step.first, *targets[first:last].tolist()]
        for at, stop in pairwise([*begins, step.stop]):
            found.append(step._replace(first=at, stop=stop, block=step.block + at - step.first))
    places = np.cumsum(more + 1) - 1
    moved = tuple(each._replace(step=int(places[each.step])) for each in made)
    return _table(found), frozenset(places[[*jumps]].tolist()), moved
