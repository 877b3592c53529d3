"""The value of an expression, from its tree and the parameters that the program has set.

Precedence is the grammar's; what operators and functions are worth is the dialect's `Arithmetic`.
A parameter that nothing in the program has set is not zero: it has what another program has left.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from lark import Token, Tree

from gcxform.diagnostics import UsageError
from gcxform.dialect.arithmetic import RS274, Arithmetic, Key, NoValueError, whole
from gcxform.dialect.logic import operator_of
from gcxform.dialect.null import MAYBE, NULL, Null, as_argument
from gcxform.modal.state import Reading
from gcxform.syntax.grammar import rule_of, span_of
from gcxform.syntax.tree import BLANKS, Statement

DOUBTFUL = math.inf
SET_IT = "set it to a number in the program before"
"""Stands for the value of a parameter that controls are known to set in two ways."""
ALONE = frozenset({"bracketed", "parameter", "call", "arctangent"})
"""Rules of operands that are worth the same whatever stands beside them."""
Parameters = Mapping[Key, float]
"""Values by parameter; nan for one that is no longer known."""


class LocatedError(NoValueError):
    """An expression without a value, and where in the block that is (columns from 0)."""

    def __init__(self, why: NoValueError, start: int, end: int) -> None:
        super().__init__(why.message, why.hint, why.code, why.lost)
        self.start, self.end = start, end


def parameter_key(text: str) -> Key:
    """Return the key of a parameter as a person writes it: `#100`, `100`, `#<depth>`."""
    bare = text.translate(BLANKS).removeprefix("#")
    if bare.startswith("<") and bare.endswith(">") and len(bare) > 2:
        return bare[1:-1].lower()
    if not bare.isdecimal():
        raise ValueError(f"{text!r} is neither a number nor a name such as '<depth>'")
    return int(bare)


def given_to(arithmetic: Arithmetic, reading: Reading) -> dict[Key, float]:
    """Return the parameters whose values are given, but for those the control changes.

    Raises UsageError for what is no parameter.
    """
    try:
        found = {parameter_key(name): value for name, value in reading.parameters.items()}
    except ValueError as error:
        raise UsageError.one("GX701", f"parameters: {error}") from None
    told = reading.told.items() if arithmetic.named else ()
    return {parameter_key(name): value for name, value in told} | {
        k: v for k, v in found.items() if arithmetic.may_be_given(k)
    }


def how_to_give(key: Key) -> str:
    """Return what to do about a parameter without a value."""
    name = key if isinstance(key, int) else f"<{key}>"
    setting = f'parameters = {{ "{name}" = ... }} in [input]'
    return f"set it in the program, or say what it is worth: {setting}"


def written(key: Key) -> str:
    """Return a parameter as it is written."""
    return f"#{key}" if isinstance(key, int) else f"#<{key}>"


class Evaluator:
    """Computes the expressions of one block. `in_word`: it is the value of a word."""

    def __init__(
        self, arithmetic: Arithmetic, parameters: Parameters, in_word: bool = False
    ) -> None:
        self.arithmetic = arithmetic
        self.parameters = parameters
        self.in_word = in_word

    def value(self, node: Any) -> float:
        """Return what a node is worth. Raises LocatedError at the innermost node without a value.

        A number that is no number or infinite is no value.
        """
        try:
            value = self._value(node)
            if not math.isfinite(value):
                raise NoValueError("the result is too large")
        except LocatedError:
            raise
        except OverflowError:
            raise LocatedError(NoValueError("the result is too large"), *span_of(node)) from None
        except NoValueError as why:
            raise LocatedError(why, *span_of(node)) from None
        return value

    def _value(self, node: Any) -> float:
        if isinstance(node, Token):
            return float(str(node).translate(BLANKS))
        rule, children = rule_of(node), node.children
        if rule == "parameter":
            return self._read(self.key(node))
        if rule == "negated":
            return self._negated(str(children[0]), children[1])
        if rule == "bracketed":
            return as_argument(self.value(children[0]))
        if rule in ("call", "arctangent"):
            return self._call(rule, str(children[0]).upper(), children[1:])
        return self._operation(*children)

    def _negated(self, sign: str, node: Any) -> float:
        """Return a value with its sign; whether a word of -null vanishes no manual says."""
        value = self.value(node)
        if isinstance(value, Null):
            return MAYBE if self.in_word else 0.0
        return -value if sign == "-" else value

    def _operation(self, left: Any, operator: Token, right: Any) -> float:
        name = str(operator).upper()
        alone = _stands_alone(left, name) and _stands_alone(right, name)
        function = operator_of(self.arithmetic, name, alone)
        if function is None:
            raise NoValueError(f"{name} is not computed in this dialect", code="GX206")
        return function(self.value(left), self.value(right))

    def _call(self, rule: str, name: str, arguments: list[Any]) -> float:
        if name == "EXISTS":
            return self._exists(arguments)
        function = self.arithmetic.functions.get(name + "/" * (rule == "arctangent"))
        if function is None:
            raise NoValueError(f"{name} is not computed in this dialect", code="GX206")
        if self.in_word and name in self.arithmetic.not_in_words:
            message = f"{name} in a word rounds to what the control can resolve"
            raise NoValueError(message, "compute it in an assignment", "GX206")
        if rule == "call" and len(arguments) != 1 + (name == "POW"):
            raise NoValueError(f"{name} takes another number of arguments")
        return function(*(self.value(argument) for argument in arguments))

    def key(self, node: Any) -> Key:
        """Return which parameter a node names."""
        child = node.children[0]
        if isinstance(child, Token) and str(child).startswith("<"):
            if not self.arithmetic.named:
                raise NoValueError("this dialect has no parameters with names", code="GX206")
            return _name(child)
        return self.arithmetic.cell(whole(self.value(child)))

    def _read(self, key: Key) -> float:
        if key == self.arithmetic.machine.null:
            return NULL
        value = self.parameters.get(key)
        if value is not None and math.isfinite(value):
            return value
        name = written(key)
        if value == DOUBTFUL:
            raise NoValueError(f"{name} is known in two ways here", SET_IT, "GX220")
        if value is not None:
            message = f"{name} is not known here: it was set to what only the control knows"
            raise NoValueError(message, SET_IT, "GX220", True)
        if not self.arithmetic.owns(key):
            message = f"{name} has a value that only the control knows"
            raise NoValueError(message, "", "GX220", self.arithmetic.exists(key))
        message = f"nothing in the program has set {name} before"
        raise NoValueError(message, how_to_give(key), "GX220", self.arithmetic.exists(key))

    def _exists(self, arguments: list[Any]) -> float:
        """Return whether a parameter has a value; only of local names is that known."""
        node = arguments[0]
        if len(arguments) != 1 or isinstance(node, Token) or rule_of(node) != "parameter":
            raise NoValueError("EXISTS takes a parameter")
        key = self.key(node)
        if key in self.parameters:
            return 1.0
        if isinstance(key, int) or key.startswith("_"):
            raise NoValueError(
                f"only the control knows whether {written(key)} exists", code="GX220", lost=True
            )
        return 0.0


def _stands_alone(node: Any, name: str) -> bool:
    """Whether an operand hangs on no order of operators, but for others of the same name."""
    if isinstance(node, Token) or rule_of(node) in ALONE:
        return True
    children = node.children
    return len(children) == 3 and str(children[1]).upper() == name


def _name(token: Token) -> str:
    """Return the name of a parameter: blanks and case do not count."""
    return str(token)[1:-1].translate(BLANKS).lower()


def parameter_of(node: Any) -> Key | None:
    """Return which parameter a node names; None where it is computed which."""
    child = node.children[0]
    if not isinstance(child, Token):
        return None
    if str(child).startswith("<"):
        return _name(child)
    value = float(str(child).translate(BLANKS))
    return int(value) if value == int(value) else None


def parameters_in(node: Any) -> Iterator[Key]:
    """Yield the parameters that an expression names; the first local one for any it computes."""
    if isinstance(node, Tree):
        if rule_of(node) == "parameter":
            key = parameter_of(node)
            yield 1 if key is None else key
        for child in node.children:
            yield from parameters_in(child)


def has_computed(node: Any) -> bool:
    """Whether an expression computes which parameter it reads."""
    if not isinstance(node, Tree):
        return False
    if rule_of(node) == "parameter" and parameter_of(node) is None:
        return True
    return any(has_computed(child) for child in node.children)


def forgotten(parameters: Parameters, arithmetic: Arithmetic, called: bool) -> dict[Key, float]:
    """Return parameters behind what may have set them.

    A program that was `called` with values has local variables of its own; what an M code runs may
    have those of its caller.
    """
    kept = {k: v for k, v in parameters.items() if called and not arithmetic.outlives(k)}
    return {**dict.fromkeys(parameters, math.nan), **kept}


def key_set(statement: Statement) -> Key | None:
    """Return the parameter that an assignment sets; None where it is computed which, or none."""
    if statement.kind != "assignment":
        return None
    parameter = statement.tree.children[0]
    return Evaluator(LITERAL, {}).key(parameter) if _is_literal(parameter.children[0]) else None


def sets_number(statement: Statement) -> bool:
    """Return whether an assignment sets a parameter that is named to a number as written."""
    value = statement.tree.children[1]
    if isinstance(value, Tree) and rule_of(value) == "negated":
        value = value.children[1]
    return key_set(statement) is not None and _is_literal(value)


def _is_literal(node: Any) -> bool:
    return isinstance(node, Token)


LITERAL = replace(RS274, operators={}, functions={})
"""For what is written out already: no dialect's own."""


def settable(arithmetic: Arithmetic, key: Key) -> Key:
    """Return the key of a parameter that a program may set. Raises NoValueError."""
    if not arithmetic.sets(key):
        message = f"{written(key)} belongs to the control, which may do something when it is set"
        raise NoValueError(message, code="GX206")
    return key
