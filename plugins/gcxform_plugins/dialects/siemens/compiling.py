"""Lines that compute, compiled: of lines of one shape their numbers alone go on.

The tree of the first of them becomes functions of its numbers and of R parameters, of which each
does what `Expressions` does with its node. A line that takes anything else is left to that: one
with a variable of the program or the control, and one that reads what it sets itself.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

from lark import Token

import gcxform as gx
from gcxform_plugins.dialects.siemens.arithmetic import COUNTS
from gcxform_plugins.dialects.siemens.cells import converted
from gcxform_plugins.dialects.siemens.expressions import PARAMETER, Expressions, number_text
from gcxform_plugins.dialects.siemens.nodes import Node, names_in, rule_of, span_of
from gcxform_plugins.dialects.siemens.texts import FUNCTIONS

WORDS = frozenset((*"XYZABCIJKF", "CR"))
"""Addresses of words whose numbers may be any."""
OPERATORS = frozenset(("+", "-", "*", "/", "DIV", "MOD"))
MOST = 4096  # shapes that are kept
Numbers = Sequence[str]
Valued = Callable[[Numbers], float]
Places = dict[tuple[int, int], int]


class _LeftError(Exception):
    """A line is left to what looks at its tree."""


class Compiled(NamedTuple):
    """A line: the pieces of its plain text, what stands between them, and what is set.

    `places` are numbers of the line, or -1 for what the next word is worth.
    """

    pieces: tuple[str, ...]
    places: tuple[int, ...]
    words: tuple[Valued, ...]
    sets: tuple[tuple[int, Valued], ...]

    def text(self, told: Numbers) -> str:
        """Return the line in plain words, for what it is `told`."""
        return "".join(chain(*zip(self.pieces, (*told, ""), strict=True)))

    def told(self, numbers: Numbers) -> list[str]:
        """Return what stands between the pieces. Raises NoValueError, OverflowError."""
        if not self.words:
            return [numbers[place] for place in self.places]
        worth = iter([number_text(value(numbers)) for value in self.words])
        return [numbers[place] if place >= 0 else next(worth) for place in self.places]

    def given(self, numbers: Numbers) -> list[tuple[int, Any]]:
        """Return R parameters and what they become. Raises NoValueError, OverflowError."""
        return [(n, converted("REAL", value(numbers))) for n, value in self.sets]

    def known(
        self, numbers: Numbers, shape: Callable[[str], tuple[Any, Numbers]]
    ) -> InPlainWords | None:
        """Return the line with the shape of its plain text; None where no such lines are learnt.

        Raises NoValueError, OverflowError.
        """
        told = self.told(numbers)
        text = self.text(told)
        if not text.strip():
            return InPlainWords(self, None, ())
        try:
            found, seen = shape(text)
        except gx.InputError:  # it is refused when it is come to
            return None
        if found.slots is None or found.comments or len(seen) != len(told):
            return None
        assert all(map(str.endswith, seen, told))
        signs = tuple(one.removesuffix(other) for one, other in zip(seen, told, strict=True))
        return InPlainWords(self, found, signs if any(signs) else ())


class InPlainWords(NamedTuple):
    """A line with the shape of its plain text, None without a word, and signs of its numbers."""

    line: Compiled
    shape: Any
    signs: tuple[str, ...]

    def computed(self, numbers: Numbers, take: Callable[[Any], None]) -> gx.Computed:
        """Return the line for its numbers. Raises NoValueError, OverflowError."""
        told, given = self.line.told(numbers), self.line.given(numbers)
        if self.signs:
            told = [sign + number for sign, number in zip(self.signs, told, strict=True)]
        return gx.Computed(self.shape, told, partial(take, given))


class Compiler:
    """Compiles lines by their trees; `own` are names that a user has given values."""

    def __init__(self, worth: Expressions, own: Collection[str]) -> None:
        self.worth, self.own = worth, own

    def compiled(self, tree: Node, text: str, spans: Sequence[tuple[int, int]]) -> Compiled | None:
        """Return a line, of which numbers stand at `spans`; None for one that is left."""
        slots = {span: k for k, span in enumerate(spans)}
        try:
            return self._compiled(tree, text, slots)
        except _LeftError:
            return None

    def _compiled(self, tree: Node, text: str, slots: Places) -> Compiled:
        if '"' in text:
            raise _LeftError
        at = 0
        parts: list[str | int] = []
        words: list[Valued] = []
        sets: dict[int, Valued] = {}
        read: set[str] = set()
        for node in tree.children:
            rule = rule_of(node)
            if rule in ("word", "sequence"):
                continue
            if rule != "assignment":
                raise _LeftError
            assert not isinstance(node, Token)
            (target, value), (start, end) = node.children, span_of(node)
            parts += _literal(text, at, start, slots)
            at, name = end, self._name(target)
            read |= {*names_in(value)}
            if PARAMETER.fullmatch(name):
                if int(name[1:]) in sets:
                    raise _LeftError
                sets[int(name[1:])] = self._value(value, slots)
            else:
                before, worth, behind = self._word(name, value, slots)
                words.append(worth)
                parts += (before, -1, behind)
        stop = text.find(";")
        parts += _literal(text, at, len(text) if stop < 0 else stop, slots)
        if sets and read and len(words) + len(sets) > 1:
            raise _LeftError
        return _made(parts, tuple(words), tuple(sets.items()))

    def _name(self, target: Any) -> str:
        """Return what an assignment is to: a word, or an R parameter without an index."""
        name = str(target.children[0]).upper()
        known = PARAMETER.fullmatch(name) or (name in WORDS and name not in self.own)
        if len(target.children) > 1 or not known:
            raise _LeftError
        return name

    def _word(self, name: str, value: Any, slots: Places) -> tuple[str, Valued, str]:
        """Return what of a word stands before its number, that, and what stands behind it."""
        if rule_of(value) != "axis_value":
            return f" {name}=", self._value(value, slots), " "
        way, inner = value.children
        return f" {name}={str(way).upper()}(", self._value(inner, slots), ") "

    # --- values ---

    def _value(self, node: Any, slots: Places) -> Valued:
        """Return what gives the value of a node. Raises _LeftError."""
        if isinstance(node, Token):
            start = node.start_pos or 0
            slot = slots.get((start, start + len(node)))
            if slot is None or not node.type.endswith("NUMBER"):
                raise _LeftError
            return lambda numbers: float(numbers[slot])
        rule, children = rule_of(node), node.children
        if rule == "variable":
            return self._parameter(node)
        if rule == "bracketed":
            return self._value(children[0], slots)
        if rule == "negated" and str(children[0]) in "+-":
            inner, minus = self._value(children[1], slots), str(children[0]) == "-"
            return lambda numbers: -inner(numbers) if minus else inner(numbers)
        if rule == "function":
            return self._function(str(children[0]).upper(), children[1].children, slots)
        if len(children) == 3 and str(children[1]).upper() in OPERATORS:
            return self._operated(str(children[1]).upper(), children[0], children[2], slots)
        raise _LeftError

    def _parameter(self, node: Node) -> Valued:
        name, *index = node.children
        if index or not PARAMETER.fullmatch(str(name).upper()):
            raise _LeftError
        parameter, checked, number = self.worth.parameter, self.worth.checked, int(str(name)[1:])
        return lambda _: checked(parameter(number))  # type: ignore[arg-type]

    def _operated(self, sign: str, left: Any, right: Any, slots: Places) -> Valued:
        operate, checked = self.worth.arithmetic.operators[sign], self.worth.checked
        one, other = self._value(left, slots), self._value(right, slots)
        return lambda numbers: checked(operate(one(numbers), other(numbers)))

    def _function(self, name: str, given: Sequence[Any], slots: Places) -> Valued:
        function, checked = self.worth.arithmetic.functions.get(name), self.worth.checked
        whole = len(given) == COUNTS.get(name, 1) and all(slot.children for slot in given)
        if function is None or name in FUNCTIONS or not whole:
            raise _LeftError
        values = [self._value(slot.children[0], slots) for slot in given]
        return lambda numbers: checked(float(function(*[checked(of(numbers)) for of in values])))


def _literal(text: str, start: int, end: int, slots: Places) -> Iterator[str | int]:
    """Yield a part of a line, with its numbers as places."""
    for (first, last), slot in slots.items():
        if start <= first and last <= end:
            yield text[start:first]
            yield slot
            start = last
    yield text[start:end]


def _made(
    parts: Sequence[str | int],
    words: tuple[Valued, ...],
    sets: tuple[tuple[int, Valued], ...],
) -> Compiled:
    """Return a line of which pieces and places come in any order."""
    pieces, places = [""], list[int]()
    for part in parts:
        if isinstance(part, str):
            pieces[-1] += part
        else:
            places.append(part)
            pieces.append("")
    return Compiled(tuple(pieces), tuple(places), words, sets)
