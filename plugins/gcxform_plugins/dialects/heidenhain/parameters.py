"""Q parameters of a TNC: formulas, FN 0 to FN 38, and what only the control knows.

The tree of a formula is that of `heidenhain_computed.lark`; what it is worth the engine of all
languages computes, by the rules in `arithmetic.py`. A parameter that nothing in the program has
set is not known; those from 100 to 199 the control sets by itself.
"""

from __future__ import annotations

import math
import re
from functools import cached_property, lru_cache
from typing import Any

from lark import Token, Tree
from lark.exceptions import UnexpectedInput

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.heidenhain.arithmetic import LARGEST, TNC, holds
from gcxform_plugins.dialects.heidenhain.labels import Labels
from gcxform_plugins.dialects.heidenhain.words import written

FN = re.compile(r"FN\s*(\d{1,2})\s*:\s*(.*?)\s*", re.IGNORECASE)
NAMED = re.compile(r"(?<![A-Z0-9])Q[LR]?\s*\d+")
ANY = re.compile(r"(?<![A-Z0-9])Q[LRS]?\s*\d")
TEXTS = re.compile(r"QS\s*\d+|TOCHAR|TONUMB|SUBSTR|STRLEN|STRCOMP|INSTR|SYSSTR|CFGREAD|DEFINED")
JUMPS = {9: "EQU", 10: "NE", 11: "GT", 12: "LT"}
SETS = {0: "", 1: "+", 2: "-", 3: "*", 4: "DIV", 5: "SQRT", 6: "SIN", 7: "COS", 8: "LEN", 13: "ANG"}
PRINTS = (15, 16, 38)
READS = (18, 27, 28)
WRITES = 27
WHY = {
    14: "FN 14 ends the program with an error",
    17: "FN 17 writes what the control computes with",
    19: "FN 19 sets values of the PLC",
    20: "FN 20 waits for the PLC",
    29: "FN 29 sets values of the PLC",
}
STANDS = (14, 19, 20, 26, 29, 37)
"""Those that set no parameter: an error, the PLC, a table that is opened, what is exported."""
CONTROL = range(100, 200)
UNSET = "what is written sets no Q parameter: what runs behind it, or calls it, may not read them"


Node = Tree[Token]


class Formula(v.Evaluator):
    """Computes formulas of known parameters."""

    def __init__(self, known: dict[str, float | None]) -> None:
        super().__init__(TNC, {})
        self.known = known

    def _value(self, node: Any) -> float:
        value = self._computed(node)
        if abs(value) > LARGEST:
            raise v.NoValueError("the result is too large")
        return value

    def _computed(self, node: Any) -> float:
        if isinstance(node, Token):
            return float(str(node).replace(",", "."))
        rule = rule_of(node)
        if rule == "parameter":
            return self.read(key_of(str(node.children[0])))
        if rule == "constant":
            return math.pi
        if rule == "power" and rule_of(node.children[0]) == "negated":
            raise v.NoValueError("a sign before a power: write brackets")
        return super()._value(node)

    def read(self, key: str) -> float:
        """Return what a parameter is worth. Raises NoValueError."""
        value = self.known.get(key)
        if value is None:
            message = f"nothing in the program has set {key} before"
            if key in self.known or (key[1:].isdigit() and int(key[1:]) in CONTROL):
                message = f"{key} has a value that only the control knows"
            raise v.NoValueError(message, "set it to a number in the program before", "GX220", True)
        return value


class Parameters(Labels):
    """Sets Q parameters, and jumps by them.

    unsaid   executions of lines that set what outlives the program, and of which no block says it
    """

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.unsaid: set[int] = set()

    @cached_property
    def grammar_of_formulas(self) -> Any:
        """The grammar of lines that compute."""
        return self.grammar_named("gcxform_grammars", "heidenhain_computed")

    def worth(self, node: Any) -> float:
        """Return what a formula is worth. Raises NoValueError."""
        return Formula(self.q).value(node)

    def computed(self, item: gx.Item) -> list[str]:
        """Q = formula, and FN: no block; what is set is known from here on. Raises InputError."""
        match = FN.fullmatch(item.name)
        if match is not None and int(match[1]) not in {*SETS, *JUMPS}:
            return self._other_function(item, int(match[1]), match[2])
        self.computes = True
        text = self._whole(item.name)
        try:
            node: Any = self.grammar_of_formulas.parse(text).children[0]
        except UnexpectedInput:
            if TEXTS.search(text):
                self._forget(item.name, item)
                return []
            raise self.refusal("GX101", f"{item.name.strip()[:40]} is no formula", item) from None
        try:
            return self._execute(item, node)
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, item, why.hint) from None

    def _whole(self, text: str) -> str:
        """Return a formula with the lines that go on with it, which are passed."""
        while text.rstrip().endswith("~") and self.at < len(self.lines):
            text = f"{text.rstrip()[:-1]} {self.lines[self.at].upper().partition(';')[0]}"
            self.at += 1
        return text

    def _execute(self, item: gx.Item, node: Node) -> list[str]:
        """Take FN 9 to 12, or set a parameter. Raises NoValueError where that has no value."""
        if rule_of(node) == "jump":
            self._jump(item, node.children)
            return []
        target: Any = node.children[-2]
        value: Any = node.children[-1]
        if rule_of(node) == "set":
            self._check_kind(item, str(node.children[0]), value)
        key = key_of(str(target.children[0]))
        self.assigned(key)
        try:
            self.q[key] = self.worth(value)
        except v.NoValueError as why:
            self.q[key] = None
            if not (why.lost and why.code == "GX220"):
                raise
        return self._lasting(item, key)

    def _lasting(self, item: gx.Item, key: str) -> list[str]:
        """Return the block of a parameter that outlives the program, in the same language."""
        value = self.q[key]
        if not key.startswith("QR"):
            if self.reading.asides and key[1:].isdigit():
                self.told_anew(UNSET)
            return []
        if value is None or float(written(value)) != value:
            if self.reading.asides:
                self.in_place[self.line] = f"{key}, which outlives the program, is set here"
            self.unsaid.add(self.visit)
            return []
        return self.along(f"{key} = {written(value)}")

    def _check_kind(self, item: gx.Item, head: str, value: Any) -> None:
        """Refuse FN with the operator of another one. Raises InputError."""
        rule, found = rule_of(value), ""
        if rule in ("between", "call"):
            found = str(value.children[rule == "between"]).upper()
        wanted = SETS[_number(head)]
        if wanted != found and (wanted, found) != ("DIV", "/"):
            raise self.refusal("GX101", f"FN {_number(head)} does not compute {found}", item)

    def _jump(self, item: gx.Item, parts: list[Any]) -> None:
        head, left, relation, right, label = parts
        name = str(relation).upper()
        if JUMPS.get(_number(head)) != name:
            raise self.refusal("GX101", f"FN {_number(head)} does not decide by {name}", item)
        if holds(name, self.worth(left), self.worth(right)):
            self.go_to(item, str(label.children[0]))

    # --- what only the control knows ---

    def _other_function(self, item: gx.Item, number: int, text: str) -> list[str]:
        """FN from 14 on: what it prints is a comment, what it reads only the control knows."""
        if number in READS:
            self.computes = True
            self._forget(text, item)
            writes = number == WRITES and self.reading.asides
            return self.stands("FN 27 writes into a table") if writes else []
        if number in PRINTS:
            if not self.reading.asides:
                return [f"(FN {number} {text.translate(BRACKETS)})"]
            tells = number != 15 or ANY.search(text.upper())
            return self.stands(f"FN {number} tells of parameters") if tells else self.along()
        if number in STANDS and self.reading.asides:
            return self.stands(WHY.get(number, f"FN {number} is not resolved"))
        self.refuse(WHY.get(number, f"FN {number} is not resolved"), item)

    def _forget(self, text: str, item: gx.Item) -> None:
        """Forget the first parameter that a text names, which is set. Raises InputError."""
        for name in NAMED.findall(text.upper())[:1]:
            self.assigned(key_of(name))
            self.q[key_of(name)] = None
            self._lasting(item, key_of(name))

    def assigned(self, key: str) -> None:
        """Take note of a parameter that is set."""

    def value_of(self, name: str, item: gx.Item) -> str:
        """Return the number that `+Q1` stands for. Raises InputError."""
        sign = "-" if name.startswith("-") else ""
        try:
            value = Formula(self.q).read(key_of(name.lstrip("+- ")))
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, item, why.hint) from None
        return written(-value if sign else value)


BRACKETS = str.maketrans("()", "[]")


def key_of(text: str) -> str:
    """Return the key of a parameter: `Q5`, `QL3`, `QR10`."""
    kind = text.upper().rstrip(" \t0123456789")
    return f"{kind}{int(text[len(kind) :])}"


def _number(head: Any) -> int:
    return int(re.sub(r"\D", "", str(head)))


def rule_of(node: Any) -> str:
    """Return the rule of a node; nothing for a terminal."""
    return _last(str(node.data)) if isinstance(node, Tree) else ""


@lru_cache
def _last(name: str) -> str:
    return name.rsplit("__", 1)[-1]
