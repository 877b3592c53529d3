"""Lines that are known, one after the other: their blocks at once, one for each.

Lines are split many at a time. Of lines of one shape in a row, each of which leaves the state as it
was, only codes and digits are looked at. A line that computes is one of plain words, for what its
variables are worth by then: no other line reads or sets these.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from itertools import accumulate
from operator import itemgetter
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

    `done` does all else that the line does, if anything.
    """

    shape: Known | None
    numbers: Numbers
    done: Callable[[], None] | None


class Ahead(NamedTuple):
    """Lines that were split at once, from `first` on: `keys` are they without their numbers.

    The numbers of each begin at `starts`.
    """

    first: int
    keys: Sequence[str]
    numbers: Numbers
    starts: Sequence[int]

    @classmethod
    def of(cls, first: int, text: str, numbers: Numbers, slot: str) -> Self:
        """Return lines for their text, in which `slot` stands for each of their numbers."""
        keys = text.split("\n")
        count = {key: key.count(slot) for key in {*keys}}
        starts = [*accumulate([count[key] for key in keys], initial=0)]
        return cls(first, keys, numbers, starts)

    def numbers_of(self, k: int) -> Numbers:
        """Return the numbers of a line, of which `k` are before it."""
        return self.numbers[self.starts[k] : self.starts[k + 1]]

    def alike(self, k: int, stop: int, slots: Slots) -> int:
        """Return where lines end that have the key and codes of line `k`, and digits where due."""
        key, keys, end = self.keys[k], self.keys, k + 1
        while end < stop and keys[end] == key:
            end += 1
        stop = end
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
    steps  what lines have done, each with the place in `given` of the last that did it
    """

    def __init__(self, ahead: Ahead, node: Any, shapes: Mapping[str, Known]) -> None:
        self.ahead, self.node, self.shapes = ahead, node, shapes
        self.texts: list[str] = []
        self.given: list[str] = []
        self.steps: dict[Stepped, int] = {}

    def take(self, lines: range, computed: Callable[[Ahead, int], Computed | None]) -> None:
        """Take lines of those that were split, up to the first that is not known.

        It is gone through for each line of a program, so it calls as little as it can.
        """
        ahead, shapes, node = self.ahead, self.shapes, self.node
        keys, numbers, starts = ahead.keys, ahead.numbers, ahead.starts
        texts, given, steps = self.texts, self.given, self.steps
        k, stop = lines.start, lines.stop
        while k < stop:
            shape = shapes.get(keys[k])
            slots = shape.slots if shape is not None and shape.steady else None
            if slots is None:
                self.node = node
                if not self._takes(computed(ahead, k)):
                    return
                node, k = self.node, k + 1
                continue
            at, behind = starts[k], k + 1
            step = node.steps.get(slots.name(shape, numbers, at) if slots.codes else shape)
            if not step or not step.in_order or (slots.digits and not slots.fit(numbers, at)):
                break
            if step.behind is node and behind < stop and keys[behind] == keys[k]:
                behind = max(ahead.alike(k, stop, slots), behind)
            steps[step] = len(given) + starts[behind - 1] - at
            texts += [step.in_order] * (behind - k)
            given += numbers[at : starts[behind]]
            node, k = step.behind, behind
        self.node = node

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
            self.steps[step] = len(self.given)
            self.texts.append(step.in_order)
            self.given += line.numbers
            self.node = step.behind
        if line.done is not None:
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
        in_order = sorted(self.steps.items(), key=itemgetter(1))
        return {axis: self.given[at + slot] for step, at in in_order for axis, slot in step.ends}
