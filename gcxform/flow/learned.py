"""What lines of one shape become in one state, learnt once: then only their numbers go on.

Most lines do to a translator what others of their shape did before: their numbers go into blocks,
and say where axes stand. Whether that is so is tried, and not declared. The line is translated with
numbers that cannot be looked at (`Opaque`), by a translator of which all is noted that it reads and
writes. If it looks at a number, or at anything beside what is `keyed`, nothing is learnt. What is
learnt is a template of the blocks, the axes that are told, and the state behind the line.

While lines are known the translator is not touched; what they did is put into it before another
line is translated as ever.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from types import FunctionType
from typing import Any, NoReturn, Protocol

from gcxform.flow.items import Item, Part
from gcxform.flow.stretch import Ahead, Computed, Known, Numbers, Slots, Stretch
from gcxform.values import dataclass

MARK = re.compile("\ue000([0-9]+)\ue001")
MOST = 4096  # steps that are kept
BEFORE = 1_000_000  # slots from here on are places of axes before the line
SOON = 8  # known lines in a row, behind which it is worth while to look for more at once
ANY, CODE, DIGITS = "any", "code", "digits"
"""What the numbers of an item may be: any; those of this very line; any that have digits alone."""


class LookedAtError(Exception):
    """A number, or something that is not keyed, was looked at."""


class Opaque(str):
    """A number that may be written, and nothing else."""

    __slots__ = ("slot",)
    slot: int

    @classmethod
    def of(cls, slot: int) -> Opaque:
        """Return what stands for the number of a slot."""
        made = cls(f"\ue000{slot}\ue001")
        made.slot = slot
        return made

    def _no(self, *_: object) -> NoReturn:
        raise LookedAtError

    def __bool__(self) -> bool:
        return True

    def __hash__(self) -> int:
        raise LookedAtError


class Digits(Opaque):
    """One that is known to have digits alone."""

    __slots__ = ()

    def isdigit(self) -> bool:
        """Return what was seen."""
        return True


_WRITTEN = frozenset(("__format__", "__str__", "__add__", "__rmod__"))
_OWN = frozenset(("__new__", "__init__", "__bool__", "__hash__", "__getattribute__", "__class__"))
_SAFE = _WRITTEN | _OWN | {"__doc__", "__init_subclass__", "__subclasshook__", "__reduce_ex__"}
for _method in set(dir(str)) - _SAFE - {"__setattr__", "__delattr__", "__sizeof__", "__dir__"}:
    setattr(Opaque, _method, Opaque._no)
for _method in ("__float__", "__int__", "__index__", "__complex__"):
    setattr(Opaque, _method, Opaque._no)


@dataclass(eq=False, slots=True)
class Step:
    """What a line becomes: templates with the slots in them, ends of axes, and what is behind.

    `in_order` is the template of the only block, for all numbers of the line in their order, of
    which some are not shown; nothing where there is no such template.
    """

    blocks: tuple[tuple[str, tuple[int, ...]], ...]
    ends: tuple[tuple[str, int], ...]
    behind: Node
    in_order: str

    def said(self, numbers: Numbers) -> list[str]:
        """Return the blocks of a line."""
        return [text % tuple([numbers[k] for k in slots]) for text, slots in self.blocks]


@dataclass(eq=False, slots=True)
class Node:
    """A state, with the steps that begin there; None for lines of which nothing is learnt."""

    key: Hashable
    steps: dict[Hashable, Step | None]


class Learner(Protocol):
    """What is asked of a translator; it is told there (`translation.py`)."""

    @property
    def keyed(self) -> Mapping[str, frozenset[str]]: ...  # noqa: D102
    @property
    def fixed(self) -> frozenset[str]: ...  # noqa: D102
    def key(self) -> Hashable | None: ...  # noqa: D102
    def take_key(self, key: Any) -> None: ...  # noqa: D102
    def told(self) -> dict[str, Any]: ...  # noqa: D102
    def blocks(self, items: Sequence[Item]) -> Any: ...  # noqa: D102


class Learned:
    """The steps of one translator, and where among them it is.

    node   the state, while lines are known; None where it is that of the translator
    ends   where axes were told to be since
    row    how many of them there were, one by one
    """

    def __init__(self, translator: Learner) -> None:
        self.translator = translator
        self.nodes: dict[Hashable, Node] = {}
        self.node: Node | None = None
        self.ends: dict[str, str] = {}
        self.row = 0
        self.count = 0

    def blocks(self, shape: Hashable, slots: Slots, numbers: Numbers) -> list[str] | None:
        """Return the blocks of a line, and go on behind it; None where it has to be translated."""
        node = self.node or self._entered()
        if node is None:
            return None
        step = node.steps.get(slots.name(shape, numbers))
        if step is None or not slots.fit(numbers):
            return None
        for axis, slot in step.ends:
            self.ends[axis] = numbers[slot]
        self.node = step.behind
        self.row += 1
        return step.said(numbers)

    def enter(self) -> bool:
        """Begin where the translator is, if it is in a state in which lines are learnt."""
        self.node = self.node or self._entered()
        return self.node is not None

    def stretch(
        self,
        ahead: Ahead,
        lines: range,
        shapes: Mapping[str, Known],
        computed: Callable[[Ahead, int], Computed | None],
    ) -> list[str]:
        """Return the blocks of lines that are known and have one each, up to the first that is not.

        It goes on behind them. Of a line without a block there is an empty one.
        """
        known = Stretch(ahead, self.node, shapes)
        known.take(lines, computed)
        self.node = known.node
        self.ends |= known.told()
        return known.blocks()

    def _entered(self) -> Node | None:
        """Return the node of the state of the translator."""
        key = self.translator.key()
        return None if key is None else self._node_of(key)

    def _node_of(self, key: Hashable) -> Node:
        node = self.nodes.get(key)
        if node is None:
            node = self.nodes[key] = Node(key, {})
        return node

    def leave(self) -> None:
        """Put into the translator what the lines have done."""
        if self.node is not None:
            self.translator.told().update(self.ends)
            self.translator.take_key(self.node.key)
            self.node, self.ends, self.row = None, {}, 0

    # --- learning ---

    def tried(
        self, shape: Hashable, slots: Slots, parts: Sequence[Part], numbers: Numbers
    ) -> tuple[Node, Hashable, Step] | None:
        """Return what there is to learn of a line, before it is translated; None without it."""
        if self.count >= MOST:
            self.nodes, self.count = {}, 0
        node, name = self._entered(), slots.name(shape, numbers)
        if node is None or name in node.steps or not slots.fit(numbers):
            return None
        self.count += 1
        node.steps[name] = None
        opaque = [
            numbers[k] if k in slots.codes else (Digits if k in slots.digits else Opaque).of(k)
            for k in range(len(numbers))
        ]
        step = self._step([part.item(opaque) for part in parts], len(numbers))
        return None if step is None else (node, name, step)

    def confirm(
        self, tried: tuple[Node, Hashable, Step], blocks: Sequence[str], numbers: Numbers
    ) -> None:
        """Keep what was tried where the line, now translated, became the same."""
        node, name, step = tried
        if step.said(numbers) == [*blocks] and self.translator.key() == step.behind.key:
            node.steps[name] = step

    def _step(self, items: Sequence[Item], count: int) -> Step | None:
        """Return what a line does whose numbers cannot be looked at; None where it looks."""
        translator = self.translator
        owners = {
            name: getattr(translator, name) if name else translator for name in translator.keyed
        }
        before = {name: _kept(vars(owner)) for name, owner in owners.items()}
        axes = [axis for axis, value in translator.told().items() if value is not None]
        try:
            told = translator.told()
            told.update((axis, Opaque.of(BEFORE + k)) for k, axis in enumerate(axes))
            with _watched(owners) as looked:
                blocks = [*translator.blocks(items)]
            if not self._is_closed(owners, before, looked):
                return None
            return self._made(blocks, axes, count)
        except Exception:  # whatever it is: it is met again when the line is translated
            return None
        finally:
            for name, owner in owners.items():
                _put_back(vars(owner), before[name])

    def _is_closed(
        self,
        owners: Mapping[str, Any],
        before: Mapping[str, dict[str, tuple[Any, Any]]],
        looked: Mapping[str, set[str]],
    ) -> bool:
        """Whether a line has looked at nothing, and changed nothing, beside what is keyed."""
        for name, keyed in self.translator.keyed.items():
            if looked[name] - keyed - self.translator.fixed:
                return False
            now = {each: value for each, value in vars(owners[name]).items() if _is_state(each)}
            if now.keys() - before[name].keys() - keyed:
                return False
            for each in before[name].keys() - keyed:
                was, copy = before[name][each]
                if now[each] is not was or (copy is not None and was != copy):
                    return False
        return True

    def _made(self, blocks: Sequence[str], axes: Sequence[str], count: int) -> Step | None:
        """Return the step that was made; None where a place of before went into it."""
        key, ends = self.translator.key(), []
        for axis, text in self.translator.told().items():
            if text is None:
                continue  # `key` says which these are
            if type(text) not in (Opaque, Digits):
                return None
            if text.slot < BEFORE:
                ends.append((axis, text.slot))
            elif axes[text.slot - BEFORE] != axis:
                return None
        made = tuple(_template(block) for block in blocks)
        if key is None or any(k >= BEFORE for _, slots in made for k in slots):
            return None
        return Step(made, tuple(ends), self._node_of(key), _in_order(made, count))


def _template(block: str) -> tuple[str, tuple[int, ...]]:
    """Return a block with places for its numbers, and their slots."""
    slots = tuple(int(each) for each in MARK.findall(block))
    return MARK.sub("%s", block.replace("%", "%%")), slots


def _in_order(blocks: Sequence[tuple[str, tuple[int, ...]]], count: int) -> str:
    """Return the template of one block for so many numbers, in their order; nothing without it."""
    if len(blocks) != 1:
        return ""
    ((text, slots),) = blocks
    if not text or "%%" in text or any(a >= b for a, b in pairwise(slots)):
        return ""
    left = iter(text.split("%s"))
    pieces = [next(left)]
    for k in range(count):
        pieces.append(f"%s{next(left)}" if k in slots else "%.0s")
    return "".join(pieces)


def _kept(values: Mapping[str, Any]) -> dict[str, tuple[Any, Any]]:
    """Return values with copies of those that may be changed in their place.

    Names of caches, with a line in front, and the lines of the program are left as they are.
    """
    return {
        name: (value, value.copy() if type(value) in (dict, list, set) else None)
        for name, value in values.items()
        if _is_state(name)
    }


def _is_state(name: str) -> bool:
    return name[0] != "_" and name != "lines"


def _put_back(values: dict[str, Any], kept: Mapping[str, tuple[Any, Any]]) -> None:
    """Make values what they were."""
    for name in [each for each in values if each not in kept and _is_state(each)]:
        del values[name]
    for name, (value, copy) in kept.items():
        values[name] = value
        if type(value) is list:
            value[:] = copy
        elif copy is not None:
            value.clear()
            value.update(copy)


@contextmanager
def _watched(owners: Mapping[str, Any]) -> Iterator[dict[str, set[str]]]:
    """Note which values of objects are looked at: all but methods, and caches."""
    looked: dict[str, set[str]] = {name: set() for name in owners}
    kinds = {name: type(owner) for name, owner in owners.items()}
    for name, owner in owners.items():
        owner.__class__ = _watching(kinds[name], looked[name])
    try:
        yield looked
    finally:
        for name, owner in owners.items():
            owner.__class__ = kinds[name]


def _watching(kind: type, looked: set[str]) -> type:
    def seen(self: object, name: str) -> Any:
        if name[0] != "_" and not isinstance(getattr(kind, name, None), (FunctionType, property)):
            looked.add(name)
        return object.__getattribute__(self, name)

    return type(kind)(kind.__name__, (kind,), {"__slots__": (), "__getattribute__": seen})
