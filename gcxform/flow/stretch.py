"""Lines that are known, one after the other: their blocks at once, one for each.

Lines are split many at a time. Of lines of one shape in a row, each of which leaves the state as it
was, only codes and digits are looked at. A line that computes is one of plain words, for what its
variables are worth by then: no other line reads or sets these.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from itertools import accumulate, groupby
from typing import Any, NamedTuple, Protocol, Self

from gcxform.values import dataclass

Numbers = Sequence[str]


@dataclass(frozen=True, slots=True)
class Slots:
    """Which numbers of a shape belong to what is learnt, and which have to be digits alone."""

    codes: tuple[int, ...]
    digits: tuple[int, ...]

    def name(self, shape: Hashable, numbers: Numbers, at: int = 0) -> Hashable:
        """Return what lines are called that do the same; their numbers begin `at` a place."""
        return (shape, *[numbers[at + k] for k in self.codes]) if self.codes else shape

    def fit(self, numbers: Numbers, at: int = 0) -> bool:
        """Whether the numbers have digits alone that have to."""
        return not self.digits or all([numbers[at + k].isdigit() for k in self.digits])


class Known(Hashable, Protocol):
    """What is asked of the shape of a line; `line_shapes.py` says what it is."""

    @property
    def steady(self) -> bool: ...  # noqa: D102
    @property
    def slots(self) -> Slots | None: ...  # noqa: D102


class Stepped(Protocol):
    """What is asked of the step of a line; `learned.py` says what it is."""

    @property
    def ends(self) -> tuple[tuple[str, int], ...]: ...  # noqa: D102
    @property
    def behind(self) -> Any: ...  # noqa: D102
    @property
    def in_order(self) -> str: ...  # noqa: D102


class Computed(NamedTuple):
    """A line that computes, in plain words: their shape, None without any, and their numbers.

    `done` does all else that the line does.
    """

    shape: Known | None
    numbers: Numbers
    done: Callable[[], None]


class Ahead(NamedTuple):
    """Lines that were split at once, from `first` on: `keys` are they without their numbers.

    The numbers of each begin at `starts`; the lines of its key in a row end before `ends`.
    """

    first: int
    keys: Sequence[str]
    numbers: Numbers
    starts: Sequence[int]
    ends: Sequence[int]

    @classmethod
    def of(cls, first: int, text: str, numbers: Numbers, slot: str) -> Self:
        """Return lines for their text, in which `slot` stands for each of their numbers."""
        keys = text.split("\n")
        starts = [*accumulate([key.count(slot) for key in keys], initial=0)]
        ends: list[int] = []
        for _, same in groupby(keys):
            count = len([*same])
            ends += [len(ends) + count] * count
        return cls(first, keys, numbers, starts, ends)

    def numbers_of(self, k: int) -> Numbers:
        """Return the numbers of a line, of which `k` are before it."""
        return self.numbers[self.starts[k] : self.starts[k + 1]]

    def alike(self, k: int, stop: int, slots: Slots) -> int:
        """Return where lines end that have the key and codes of line `k`, and digits where due."""
        stop = min(self.ends[k], stop)
        at, width = self.starts[k], self.starts[k + 1] - self.starts[k]
        for slot in slots.codes:
            codes = self.numbers[at + slot : self.starts[stop] : width]
            if codes.count(codes[0]) < len(codes):
                stop = k + next(n for n, code in enumerate(codes) if code != codes[0])
        for slot in slots.digits:
            digits = self.numbers[at + slot : self.starts[stop] : width]
            if not "".join(digits).isdigit():
                stop = k + next(n for n, each in enumerate(digits) if not each.isdigit())
        return stop


class Stretch:
    """Takes lines from a state on, as long as they are known and have one block each, or none.

    node   the state behind them
    texts  templates of their blocks, to be filled in with the numbers that are `given`
    steps  what lines have done, each with the place in `given` of the last that did it in a row
    """

    def __init__(self, ahead: Ahead, node: Any, shapes: Mapping[str, Known]) -> None:
        self.ahead, self.node, self.shapes = ahead, node, shapes
        self.texts: list[str] = []
        self.given: list[str] = []
        self.steps: list[tuple[Stepped, int]] = []

    def take(self, lines: range, computed: Callable[[Ahead, int], Computed | None]) -> None:
        """Take lines of those that were split, up to the first that is not known."""
        k, keys, shapes = lines.start, self.ahead.keys, self.shapes
        while k < lines.stop:
            shape = shapes.get(keys[k])
            if shape is not None and shape.steady:
                behind = self._plain(shape, k, lines.stop)
            else:
                behind = k + self._takes(computed(self.ahead, k))
            if behind == k:
                return
            k = behind

    def _plain(self, shape: Known, k: int, stop: int) -> int:
        """Take lines that do the same; return where they end."""
        ahead, slots = self.ahead, shape.slots
        starts, at = ahead.starts, ahead.starts[k]
        step = self._step(shape, slots, ahead.numbers, at)
        if step is None or slots is None:
            return k
        behind = ahead.alike(k, stop, slots) if step.behind is self.node else k + 1
        self.steps.append((step, len(self.given) + starts[behind - 1] - at))
        self.texts += [step.in_order] * (behind - k)
        self.given += ahead.numbers[at : starts[behind]]
        self.node = step.behind
        return behind

    def _takes(self, line: Computed | None) -> bool:
        """Take a line that computes; return whether it could be taken."""
        if line is None:
            return False
        if line.shape is None:
            self.texts.append("")
        else:
            step = self._step(line.shape, line.shape.slots, line.numbers, 0)
            if step is None:
                return False
            self.steps.append((step, len(self.given)))
            self.texts.append(step.in_order)
            self.given += line.numbers
            self.node = step.behind
        line.done()
        return True

    def _step(self, shape: Known, slots: Slots | None, numbers: Numbers, at: int) -> Stepped | None:
        """Return the step of a line that has one block; None for others."""
        if slots is None:
            return None
        step: Stepped | None = self.node.steps.get(slots.name(shape, numbers, at))
        return step if step and step.in_order and slots.fit(numbers, at) else None

    def blocks(self) -> list[str]:
        """Return the blocks of the lines, an empty one for a line without any."""
        return ("\n".join(self.texts) % (*self.given,)).split("\n") if self.texts else []

    def told(self) -> dict[str, str]:
        """Return where axes are told to be behind the lines: what the last of each says."""
        ends: dict[str, str] = {}
        axes = {axis for step in {step for step, _ in self.steps} for axis, _ in step.ends}
        for step, at in reversed(self.steps):
            if not axes:
                break
            ends |= {axis: self.given[at + slot] for axis, slot in step.ends if axis in axes}
            axes -= ends.keys()
        return ends
