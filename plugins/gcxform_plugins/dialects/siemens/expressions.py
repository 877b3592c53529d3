"""What expressions of a SINUMERIK are worth: numbers, texts, variables and arrays.

The tree is that of `siemens_computed.lark`, which has the priorities of the manual; numbers are
computed by the engine of all languages with the rule object of this one (`arithmetic.py`).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from typing import Any, cast

from lark import Token, Tree

from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.arithmetic import COUNTS, SINUMERIK, bits
from gcxform_plugins.dialects.siemens.cells import LOST, Cell, Value
from gcxform_plugins.dialects.siemens.place import text_of
from gcxform_plugins.dialects.siemens.texts import FUNCTIONS, TRUTHS, UNTOLD, of_texts

PARAMETER = re.compile(r"R[0-9]+")
CONSTANTS = {"TRUE": 1.0, "FALSE": 0.0}
LOGIC = frozenset(("conjunction", "disjunction", "exclusive"))
LOGIC_WORDS = frozenset(("AND", "OR", "XOR"))
COMPARED = frozenset(("==", "<>", ">=", "<=", ">", "<"))
BY_THE_MANUAL = (COMPARED, frozenset(("OR",)), frozenset(("XOR",)), frozenset(("AND",)))
AS_USUAL = (*BY_THE_MANUAL[1:], COMPARED)
Node = Tree[Token]
PLACES = 10  # of a number in a text; more are not written


def lost(what: str) -> v.NoValueError:
    """Return the error about a value that only the control knows."""
    return v.NoValueError(f"only the control knows {what}", code="GX220", lost=True)


def number_text(value: float) -> str:
    """Return a number as it is written in a word."""
    text = repr(value)
    if "e" in text:
        return text_of(Decimal(text))
    return text.removesuffix(".0") if text != "-0.0" else "0"


class Expressions(v.Evaluator):
    """Computes expressions; `find` gives the variable of a name, `system` a value of the control.

    R parameters are variables of their own: see `parameters`, by their numbers.
    """

    def __init__(
        self,
        r: dict[int, Value],
        find: Callable[[str], Cell | None],
        system: Callable[[str, Sequence[Any]], Value],
    ) -> None:
        super().__init__(SINUMERIK, {})
        self.r, self.find, self.system = r, find, system

    def number(self, node: Any) -> float:
        """Return a value that is a number. Raises NoValueError."""
        value = self.of(node)
        if isinstance(value, str):
            raise v.NoValueError("a text where a number is due")
        assert value is not None
        return self.checked(value)

    def checked(self, value: float) -> float:
        """Return a number that is finite. Raises NoValueError."""
        if not -math.inf < value < math.inf:
            raise v.NoValueError("the result is too large")
        return value

    def of(self, node: Any) -> Value:
        """Return what a node is worth. Raises NoValueError, `lost` where only the control knows."""
        try:
            return self._worth(node)
        except OverflowError:
            raise v.NoValueError("the result is too large") from None

    def _worth(self, node: Any) -> Value:
        if isinstance(node, Token):
            return self._token(node)
        rule, children = _rule(node), node.children
        if rule == "variable":
            return self.variable(node)
        if rule == "bracketed":
            return self.of(children[0])
        if rule == "negated":
            return self._prefixed(str(children[0]).upper(), children[1])
        if rule == "converted":
            return self._told(children[1])
        if rule == "function":
            return self._function(str(children[0]).upper(), children[1].children)
        if rule == "joined":
            return self._told(children[0]) + self._told(children[2])
        if rule == "expression" and not LOGIC_WORDS.isdisjoint(map(_upper, [*_flat(node)][1::2])):
            return self._both_ways(node)
        return self._binary(*children)

    def _both_ways(self, node: Node) -> Value:
        """Return what comparisons beside AND, OR and XOR without brackets are worth.

        By the manual these bind before comparisons (NC programming p. 444); who reads them the
        other way round has to get the same. Raises NoValueError where he does not.
        """
        flat = [*_flat(node)]
        values: list[Any] = [self.of(e) if k % 2 == 0 else _upper(e) for k, e in enumerate(flat)]
        found = self._joined(values, BY_THE_MANUAL)
        if found != self._joined(values, AS_USUAL):
            message = "a comparison beside AND, OR or XOR: by the manual these bind before it"
            raise v.NoValueError(message, "put brackets around each comparison")
        return found

    def _joined(self, values: list[Any], levels: Sequence[frozenset[str]]) -> Value:
        """Return what operands and operators in turn are worth; `levels` bind loosest first."""
        if len(values) == 1:
            return cast(Value, values[0])
        for level in levels:
            at = max((k for k in range(1, len(values), 2) if values[k] in level), default=0)
            if at:
                left = self._joined(values[:at], levels)
                return self._operated(values[at], left, self._joined(values[at + 1 :], levels))
        raise AssertionError(values)

    def _token(self, token: Token) -> Value:
        text = str(token)
        if token.type.endswith("STRING"):
            return text[1:-1]
        if token.type.endswith("HEX"):
            return float(int(text[2:-1], 16 if text[1] in "hH" else 2))
        mantissa, _, power = text.upper().partition("EX")
        return float(f"{mantissa}e{power}" if power else mantissa)

    def _prefixed(self, sign: str, node: Any) -> Value:
        value = self.number(node)
        if sign == "NOT":
            return float(not value)
        if sign == "B_NOT":
            return float(~bits(value))
        return -value if sign == "-" else value

    def _binary(self, left: Any, operator: Token, right: Any) -> Value:
        return self._operated(str(operator).upper(), self.of(left), self.of(right))

    def _operated(self, name: str, a: Value, b: Value) -> Value:
        if isinstance(a, str) or isinstance(b, str):
            if name in ("==", "<>") and isinstance(a, str) and isinstance(b, str):
                return float((a == b) == (name == "=="))
            raise v.NoValueError(f"{name} of texts")
        assert a is not None
        assert b is not None
        return self.checked(self.arithmetic.operators[name](a, b))

    def _told(self, node: Any) -> str:
        """Return what a node is worth as a part of a text. Raises NoValueError."""
        if self._kind(node) in UNTOLD:
            raise v.NoValueError("how a BOOL or a CHAR stands in a text no source tells")
        return self.text(self.of(node))

    def _kind(self, node: Any) -> str:
        """Return the type of a node, if it is one that does not stand in texts as others do."""
        if not _is_tree(node):
            return ""
        rule, children = _rule(node), node.children
        if rule == "bracketed":
            return self._kind(children[0])
        if rule == "variable":
            cell = self.find(str(children[0]).upper())
            known = "BOOL" if str(children[0]).upper() in TRUTHS else ""
            return known if cell is None else cell.kind
        if rule == "function":
            return "BOOL" if str(children[0]).upper() in TRUTHS else ""
        negated = rule == "negated" and str(children[0]).upper() == "NOT"
        return "BOOL" if negated or rule in (*LOGIC, "expression") else ""

    def text(self, value: Value) -> str:
        """Return a value as a text has it. Raises NoValueError."""
        if isinstance(value, str):
            return value
        assert value is not None
        found = number_text(value)
        if len(found.partition(".")[2]) > PLACES:
            raise v.NoValueError("a number with more than ten decimals in a text")
        return found

    def variable(self, node: Any) -> Value:
        """Return what a variable is worth. Raises NoValueError."""
        name, *index = node.children
        upper = str(name).upper()
        if upper.startswith("$"):
            return self._system(upper, index[0].children if index else ())
        if upper in CONSTANTS and not index:
            return CONSTANTS[upper]
        if PARAMETER.fullmatch(upper) and not index:
            return self.parameter(int(upper[1:]))
        if upper == "R" and index:
            return self.parameter(self.indices(index[0])[0])
        cell = self.find(upper)
        if cell is None:
            raise lost(f"what {name} is: nothing in the program defines it")
        value = cell.values[cell.place(self.indices(index[0]) if index else ())]
        if value is LOST:
            raise lost(f"the value of {name}")
        return value

    def _system(self, name: str, index: Sequence[Any]) -> Value:
        if name in ("$R", "$$R") and index:
            raise lost("the R parameter of a synchronous action")
        value = self.system(name, index)
        if value is LOST:
            raise lost(f"the value of {name}")
        return value

    def parameter(self, number: int) -> Value:
        """Return what an R parameter is worth. Raises NoValueError."""
        value = self.r.get(number, LOST)
        if value is LOST:
            raise lost(f"the value of R{number}")
        return value

    def indices(self, node: Any) -> tuple[int, ...]:
        """Return the numbers of an index. Raises NoValueError."""
        found = [self.number(each) for each in node.children]
        if any(each != int(each) for each in found):
            raise v.NoValueError("an index that is no whole number")
        return tuple(int(each) for each in found)

    def _function(self, name: str, arguments: Sequence[Any]) -> Value:
        if name in FUNCTIONS:
            return of_texts(name, [self._given(each) for each in arguments])
        function = self.arithmetic.functions.get(name)
        if function is None:
            raise lost(f"what {name}(...) gives")
        if len(arguments) != COUNTS.get(name, 1):
            raise v.NoValueError(f"{name} takes another number of arguments")
        return self.checked(float(function(*(self._argument(each) for each in arguments))))

    def _given(self, slot: Any) -> float | str:
        if not slot.children:
            raise v.NoValueError("an argument is missing")
        value = self.of(slot.children[0])
        assert value is not None
        return value

    def _argument(self, slot: Any) -> float:
        value = self._given(slot)
        if isinstance(value, str):
            raise v.NoValueError("a text where a number is due")
        return self.checked(value)


def _rule(node: Tree[Token]) -> str:
    return str(node.data).rsplit("__", 1)[-1]


def _upper(token: Any) -> str:
    return str(token).upper()


def _is_tree(node: Any) -> bool:
    return isinstance(node, Tree)


def _flat(node: Any) -> Iterator[Any]:
    """Yield operands and operators, in turn, of comparisons and logic without brackets."""
    if isinstance(node, Tree) and _rule(node) in (*LOGIC, "expression"):
        yield from _flat(node.children[0])
        yield node.children[1]
        yield from _flat(node.children[2])
    else:
        yield node
