"""Expressions as functions: made once for each outline, and called with numbers or whole columns.

An expression of an outline is the same on all its lines but for its numbers. What is made of it
here takes the parameters and these numbers: of one line, or, as arrays, of many lines between which
no parameter changes. Where columns are made a parameter may be one as well.

It has a value or it has none: whatever `Evaluator` would refuse, or do in a way of its own, is
`NO_VALUE` here, and the line is computed again by `Evaluator`, whose errors have a place. So
there is one definition of what is refused. Both use the functions of the same `Arithmetic`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import count
from typing import Any, Protocol

import numpy as np
from lark import Token

from gcxform.dialect.arithmetic import COLUMNS, Arithmetic, Key, NoValueError
from gcxform.dialect.null import Null
from gcxform.modal.expressions.value import parameter_of
from gcxform.syntax.grammar import rule_of
from gcxform.syntax.tree import BLANKS


class Parameters(Protocol):
    """Values by parameter, as a mapping has them; arrays of finite numbers for columns."""

    def get(self, key: Key, default: Any, /) -> Any:
        """Return the value of a parameter."""


Operands = Sequence[Any]
"""Numbers by slot: floats, or arrays of one length."""
Compiled = Callable[[Parameters, Operands], Any]


class NoColumnError(Exception):
    """A value that is not found in this way."""


NO_VALUE = (NoColumnError, NoValueError, ArithmeticError, ValueError)
"""What functions raise that have no value here."""


class Compiler:
    """Makes the function of one expression; `slot` is that of its first number in an outline.

    The others follow in the order of the text, but behind what is refused. Without a slot numbers
    are worth what they are in the tree.
    """

    def __init__(
        self, arithmetic: Arithmetic, slot: int | None, in_word: bool, columns: bool = False
    ) -> None:
        self.arithmetic = arithmetic
        self.slots = None if slot is None else count(slot)
        self.in_word = in_word
        self.columns = columns

    def compiled(self, node: Any) -> Compiled:
        """Return the function of an expression; it raises NO_VALUE."""
        if isinstance(node, Token):
            if self.slots is None:
                number = float(str(node).translate(BLANKS))
                return lambda _, __: number
            slot = next(self.slots)
            return lambda _, operands: operands[slot]
        rule, children = rule_of(node), node.children
        if rule == "parameter":
            return self._parameter(node)
        if rule == "bracketed":
            return self.compiled(children[0])
        if rule == "negated":
            inner = self.compiled(children[1])
            return inner if children[0] == "+" else lambda p, o: -inner(p, o)
        if rule in ("call", "arctangent"):
            return self._call(rule, str(children[0]).upper(), children[1:])
        return self._operation(*children)

    def _parameter(self, node: Any) -> Compiled:
        key = parameter_of(node)
        if key is None or (isinstance(key, str) and not self.arithmetic.named):
            return _refused
        key = self.arithmetic.cell(key)

        def read(parameters: Parameters, _: Operands) -> float:
            value: float = parameters.get(key, np.nan)
            if not -math.inf < value < math.inf or isinstance(value, Null):
                raise NoColumnError
            return value

        def column(parameters: Parameters, operands: Operands) -> Any:
            value = parameters.get(key, None)
            return value if isinstance(value, np.ndarray) else read(parameters, operands)

        return column if self.columns else read

    def _operation(self, left: Any, operator: Token, right: Any) -> Compiled:
        function = self.arithmetic.operators.get(str(operator).upper())
        if function is None:
            return _refused
        return self._applied(function, self.compiled(left), self.compiled(right))

    def _call(self, rule: str, name: str, arguments: list[Any]) -> Compiled:
        function = self.arithmetic.functions.get(name + "/" * (rule == "arctangent"))
        wrong = rule == "call" and len(arguments) != 1 + (name == "POW")
        if function is None or wrong or (self.in_word and name in self.arithmetic.not_in_words):
            return _refused
        return self._applied(function, *map(self.compiled, arguments))

    def _applied(self, function: Callable[..., Any], *arguments: Compiled) -> Compiled:
        """Return a function of functions, whose result is finite."""
        if self.columns:
            return lambda p, o: _column(function, [each(p, o) for each in arguments])
        if len(arguments) == 1:
            only = arguments[0]
            return lambda p, o: _finite(function(only(p, o)))
        left, right = arguments
        return lambda p, o: _finite(function(left(p, o), right(p, o)))


def _refused(_: Parameters, __: Operands) -> Any:
    raise NoColumnError


def _finite(value: float) -> float:
    if not -math.inf < value < math.inf:
        raise NoColumnError
    return value


def _column(function: Callable[..., Any], values: list[Any]) -> Any:
    """Return a function of whole columns, or of numbers. Raises NO_VALUE."""
    if not any(isinstance(value, np.ndarray) for value in values):
        return _finite(function(*values))
    whole = COLUMNS.get(function)
    if whole is not None:
        with np.errstate(all="ignore"):
            result = whole(*values)
    else:
        columns = [each.tolist() for each in np.broadcast_arrays(*values)]
        result = np.array([function(*each) for each in zip(*columns, strict=True)])
    if not np.isfinite(result).all():
        raise NoColumnError
    return result
