"""Lines that compute, compiled: of lines of one shape their numbers alone go on.

The tree of the first of them becomes a function, written as Python, of its numbers and of R
parameters: it does what `Expressions` does with each node. A line that takes anything else is left
to that: one with a variable of the program or the control, and one that reads what it sets itself.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import Any, NamedTuple

from lark import Token

import gcxform as gx
from gcxform_plugins.dialects.siemens.arithmetic import COUNTS
from gcxform_plugins.dialects.siemens.expressions import PARAMETER, Expressions, lost, number_text
from gcxform_plugins.dialects.siemens.nodes import Node, names_in, rule_of, span_of
from gcxform_plugins.dialects.siemens.texts import FUNCTIONS

WORDS = frozenset((*"XYZABCIJKF", "CR"))
"""Addresses of words whose numbers may be any."""
OPERATORS = frozenset(("+", "-", "*", "/", "DIV", "MOD"))
CARRY_ON = frozenset("+-*")
"""Those whose results are not finite where an operand is not: it is looked at behind them."""
DEEP = 100  # brackets of what is written as Python, which takes 200 inside each other
MOST = 4096  # shapes that are kept
Numbers = Sequence[str]
Given = Sequence[tuple[int, float]]
Values = Mapping[int, Any]
Run = Callable[[Numbers, Values], tuple[Numbers, Given]]
Places = dict[tuple[int, int], int]


class _LeftError(Exception):
    """A line is left to what looks at its tree."""


class Compiled(NamedTuple):
    """A line: the pieces of its plain text, R parameters that it reads, and its function.

    For numbers and R parameters that gives what stands between the pieces, and R parameters with
    what they become.
    """

    pieces: tuple[str, ...]
    reads: tuple[int, ...]
    run: Run

    def worth(self, numbers: Numbers, r: Values) -> tuple[Numbers, Given]:
        """Return what a line is worth. Raises NoValueError, OverflowError."""
        for number in self.reads:
            if r.get(number) is None:
                raise lost(f"the value of R{number}")
        return self.run(numbers, r)

    def text(self, told: Numbers) -> str:
        """Return the line in plain words, for what it is `told`."""
        return "".join(chain(*zip(self.pieces, (*told, ""), strict=True)))

    def known(
        self, numbers: Numbers, r: Values, shape: Callable[[str], tuple[Any, Numbers]]
    ) -> InPlainWords | None:
        """Return the line with the shape of its plain text; None where no such lines are learnt.

        Raises NoValueError, OverflowError.
        """
        told, _ = self.worth(numbers, r)
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

    def computed(self, numbers: Numbers, r: Values, take: Callable[[Given], None]) -> gx.Computed:
        """Return the line for its numbers. Raises NoValueError, OverflowError."""
        told, given = self.line.worth(numbers, r)
        if self.signs:
            told = [sign + number for sign, number in zip(self.signs, told, strict=True)]
        return gx.Computed(self.shape, told, partial(take, given) if given else None)


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
        at, source = 0, _Source(self.worth, slots)
        parts: list[str | _Said] = []
        words, sets, read = 0, dict[int, str](), set[str]()
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
                sets[int(name[1:])] = source.finite(value)
            else:
                words += 1
                parts += _word(name, value, source)
        stop = text.find(";")
        parts += _literal(text, at, len(text) if stop < 0 else stop, slots)
        if sets and read and words + len(sets) > 1:
            raise _LeftError
        return source.made(parts, sets)

    def _name(self, target: Any) -> str:
        """Return what an assignment is to: a word, or an R parameter without an index."""
        name = str(target.children[0]).upper()
        known = PARAMETER.fullmatch(name) or (name in WORDS and name not in self.own)
        if len(target.children) > 1 or not known:
            raise _LeftError
        return name


class _Said(str):
    """What is written as Python of a number in a plain text."""

    __slots__ = ()


class _Source:
    """Writes values of a line as Python: `n` are its numbers, `r` R parameters.

    What is written has names of our own and places of numbers, and nothing else of the line.
    """

    def __init__(self, worth: Expressions, slots: Places) -> None:
        self.worth, self.slots = worth, slots
        self.known: dict[str, Any] = {"checked": worth.checked, "said": number_text, "float": float}
        self.reads: set[int] = set()

    def made(self, parts: Sequence[str | _Said], sets: Mapping[int, str]) -> Compiled:
        """Return a line of which texts and numbers come in any order. Raises _LeftError."""
        pieces, told = [""], list[str]()
        for part in parts:
            if isinstance(part, _Said):
                told.append(part)
                pieces.append("")
            else:
                pieces[-1] += part
        given = [f"({number}, {value})" for number, value in sets.items()]
        text = f"lambda n, r: ([{', '.join(told)}], [{', '.join(given)}])"
        if text.count("(") > DEEP:
            raise _LeftError
        return Compiled(tuple(pieces), tuple(self.reads), eval(text, self.known))

    def finite(self, node: Any) -> str:
        """Return a value that is looked at whether it is finite. Raises _LeftError."""
        return f"checked({self.value(node)})"

    def value(self, node: Any) -> str:
        """Return a value, which need not be finite. Raises _LeftError."""
        if isinstance(node, Token):
            return self._number(node)
        rule, children = rule_of(node), node.children
        if rule == "variable":
            return self._parameter(node)
        if rule == "bracketed":
            return self.value(children[0])
        if rule == "negated" and str(children[0]) in "+-":
            return f"({children[0]}{self.value(children[1])})"
        if rule == "function":
            return self._function(str(children[0]).upper(), children[1].children)
        if len(children) == 3 and str(children[1]).upper() in OPERATORS:
            return self._operated(str(children[1]).upper(), children[0], children[2])
        raise _LeftError

    def _number(self, token: Token) -> str:
        start = token.start_pos or 0
        slot = self.slots.get((start, start + len(token)))
        if slot is None or not token.type.endswith("NUMBER"):
            raise _LeftError
        return f"float(n[{slot}])"

    def _parameter(self, node: Node) -> str:
        name, *index = node.children
        if index or not PARAMETER.fullmatch(str(name).upper()):
            raise _LeftError
        number = int(str(name)[1:])
        self.reads.add(number)
        return f"r[{number}]"

    def _operated(self, sign: str, left: Any, right: Any) -> str:
        if sign in CARRY_ON:
            return f"({self.value(left)} {sign} {self.value(right)})"
        of = self._called(self.worth.arithmetic.operators[sign])
        return f"{of}({self.finite(left)}, {self.finite(right)})"

    def _function(self, name: str, given: Sequence[Any]) -> str:
        function = self.worth.arithmetic.functions.get(name)
        whole = len(given) == COUNTS.get(name, 1) and all(slot.children for slot in given)
        if function is None or name in FUNCTIONS or not whole:
            raise _LeftError
        values = [self.finite(slot.children[0]) for slot in given]
        return f"float({self._called(function)}({', '.join(values)}))"

    def _called(self, function: Callable[..., float]) -> str:
        """Return the name by which a function is called."""
        name = f"f{len(self.known)}"
        self.known[name] = function
        return name


def _word(name: str, value: Any, source: _Source) -> Iterator[str | _Said]:
    """Yield what of a word stands before its number, that, and what stands behind it."""
    if rule_of(value) != "axis_value":
        yield from (f" {name}=", _Said(f"said({source.finite(value)})"), " ")
        return
    way, inner = value.children
    yield from (f" {name}={str(way).upper()}(", _Said(f"said({source.finite(inner)})"), ") ")


def _literal(text: str, start: int, end: int, slots: Places) -> Iterator[str | _Said]:
    """Yield a part of a line, with its numbers as places."""
    for (first, last), slot in slots.items():
        if start <= first and last <= end:
            yield text[start:first]
            yield _Said(f"n[{slot}]")
            start = last
    yield text[start:end]
