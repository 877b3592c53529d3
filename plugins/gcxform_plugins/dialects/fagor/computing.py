"""Lines of a Fagor that compute: they become the same lines with numbers.

A parameter that nothing in the program has set is not known, nor is a variable of the control.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from decimal import Decimal
from functools import cached_property
from typing import Any

from lark import Token, Tree
from lark.exceptions import UnexpectedInput

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fagor.arithmetic import COUNTS, FAGOR, NOT_CERTAIN, holds
from gcxform_plugins.dialects.fagor.drilling import Drilling
from gcxform_plugins.dialects.fagor.structure import StructureError, code

COMPUTED = frozenset(("expression", "assignment", "flow", "call"))
OWN = re.compile(r"V\.[PS]\.[A-Z0-9_]+")
LOCALS = range(100)
"""Numbers of parameters that end with a level of calls; others are those of all programs."""
SET_IT = "set it to a number in the program before"
UNSET = "what is written sets no parameter: what runs behind it, or calls it, may not read them"
LARGEST = 1e9
TEXTS = re.compile(r'("[^"]*")')
NAMED = re.compile(r"(?<![A-Z0-9_.])(?:P[0-9]+|V\.[PS]\.[A-Z0-9_]+)", re.IGNORECASE)
INDIRECT = re.compile(r"(?<![A-Z0-9_.])P[P\[]", re.IGNORECASE)
INCHES = re.compile(r"(?<![A-Z0-9_])G[ \t]*0*70(?![0-9.])", re.IGNORECASE)
SAY_IT = "write a number in its place"
DECIMALS = 9  # of a computed word: far below what the control resolves
Node = Tree[Token]


class Values(v.Evaluator):
    """Computes expressions; `known` has parameters and variables by name, None where lost."""

    def __init__(self, known: dict[str, float | None], doubtful: Iterable[str] = ()) -> None:
        super().__init__(FAGOR, {})
        self.known, self.doubtful = known, frozenset(doubtful)

    def _value(self, node: Any) -> float:
        if isinstance(node, Token):
            return float(node)
        rule = rule_of(node)
        if rule in ("parameter", "variable"):
            return self.read(self.name(node))
        if rule == "function":
            return self._function(str(node.children[0]).upper(), node.children[1:])
        if rule == "relation":
            raise v.NoValueError("a comparison where a number is due")
        if rule == "power" and rule_of(node.children[0]) == "negated":
            raise v.NoValueError("a sign before a power: write brackets")
        return super()._value(node)

    def name(self, node: Any) -> str:
        """Return the name of a parameter or a variable. Raises NoValueError."""
        text = str(node.children[0]).upper()
        if rule_of(node) == "variable":
            return text
        if len(node.children) == 1:
            return f"P{int(text[1:])}"
        number = self.value(node.children[1])
        if number != int(number) or number < 0:
            raise v.NoValueError("the number of a parameter is not whole")
        return f"P{int(number)}"

    def read(self, name: str) -> float:
        """Return what a parameter or a variable is worth. Raises NoValueError."""
        value = self.known.get(name)
        if value is not None:
            return value
        if name in self.known or (name[0] == "V" and not OWN.fullmatch(name)):
            raise v.NoValueError(f"only the control knows {name}", SET_IT, "GX220", True)
        if name in self.doubtful:
            message = f"whether a subroutine has a {name} of its own is not certain"
            hint = 'say subroutine-locals = "shared" in [control], or call it by #PCALL'
            raise v.NoValueError(message, hint, "GX220", True)
        message = f"nothing in the program has set {name} before"
        raise v.NoValueError(message, SET_IT, "GX220", True)

    def _function(self, name: str, arguments: Sequence[Any]) -> float:
        function = self.arithmetic.functions.get(name)
        if function is None or name in NOT_CERTAIN:
            raise v.NoValueError(f"what {name} computes is not certain", code="GX206")
        if len(arguments) != COUNTS.get(name, 1):
            raise v.NoValueError(f"{name} takes another number of arguments")
        return float(function(*(self.value(each) for each in arguments)))

    def holds(self, node: Any) -> bool:
        """Return whether a condition holds; `*` and `+` join conditions in brackets."""
        rule = rule_of(node)
        if rule == "bracketed":
            return self.holds(node.children[0])
        if rule == "relation":
            left, relation, right = node.children
            return holds(str(relation), self.value(left), self.value(right))
        if rule in ("product", "sum") and str(node.children[1]) in "*+":
            left, joined, right = node.children
            both = self.holds(left), self.holds(right)
            return all(both) if str(joined) == "*" else any(both)
        raise v.NoValueError("a condition that compares nothing", "compare it with a number")


class Computing(Drilling):
    """Executes lines that compute.

    known     parameters and variables that the program has set, None where only the control knows
    doubtful  local parameters of the callers
    """

    def __init__(self, *given: object) -> None:
        super().__init__(*given)
        self.known: dict[str, float | None] = {
            f"P{int(number)}": value
            for number, value in self.reading.parameters.items()
            if number.isdigit()
        }
        self.doubtful: set[str] = set()

    @cached_property
    def _computed(self) -> Any:
        return self.grammar_named("gcxform_grammars", "fagor_computed")

    def tree_of(self, text: str) -> Any:
        """Return the tree of a line that computes. Raises UnexpectedInput."""
        return self._computed.parse(text)

    @property
    def values(self) -> Values:
        """What computes with the parameters as they are."""
        return Values(self.known, self.doubtful)

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        self.places.arrive()
        if not any(item.kind in COMPUTED for item in items):
            return super().blocks(items)
        item = next(item for item in items if item.kind in COMPUTED)
        text = self.lines[self.line]
        try:
            straight = self._straight(self.tree_of(text), text)
        except UnexpectedInput:
            self.refuse(f"{item.name.strip()[:40]} is not read", item)
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, item, why.hint) from None
        except StructureError as why:
            self.line = why.line
            raise self.refusal("GX223", why.message) from None
        plain = [i for i in self.items_in(straight) if i.kind not in ("comment", "block_delete")]
        return super().blocks(plain) if plain else []

    def _straight(self, tree: Node, text: str) -> str:
        """Return a line of plain words for one that computes; nothing where it only decides."""
        edits: list[tuple[int, int, str]] = []
        names: set[str] = set()
        nodes: list[Any] = tree.children
        for node in nodes:
            names |= {self._set(node)} if rule_of(node) == "assignment" else set()
        for node in nodes:
            rule = rule_of(node)
            span = (node.meta.start_pos, node.meta.end_pos)
            if rule == "computed":
                if names & set(self._names_in(node)):
                    raise v.NoValueError("a parameter that is set and used in one block")
                edits.append((*span, self._word(node)))
            elif rule not in ("word", "sequence", "label"):
                if rule != "assignment":
                    self.flow(rule, node)
                edits.append((*span, ""))
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        return text

    def flow(self, rule: str, node: Any) -> None:
        """Take what decides or calls."""
        raise NotImplementedError

    def _along(self, item: gx.Item) -> list[str]:
        """Return the block of a statement that goes along where all is written anew; or none.

        It has the values of its parameters. Raises InputError for what computes otherwise.
        """
        if not self.reading.asides:
            return []
        text = code(self.lines[self.line])
        if "CONTERROR" in text.upper() and any(map(INCHES.search, self.lines)):
            self.refuse("a contour error beside G70 and moves that are written anew", item)
        parts = TEXTS.split(text[text.index("#") :].strip())
        for k in range(0, len(parts), 2):
            parts[k] = NAMED.sub(lambda found: self._value_of(found[0], item), parts[k])
            rest = INDIRECT.search(parts[k])
            if rest is not None:
                self.refuse(f"{rest[0]} in a statement that goes along as it stands", item, SAY_IT)
        return [gx.Speller.along("".join(parts))]

    def _value_of(self, name: str, item: gx.Item) -> str:
        """Return what a parameter is worth in a statement. Raises InputError."""
        name = f"P{int(name[1:])}" if name[1].isdigit() else name.upper()
        try:
            value = self.values.read(name)
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, item, why.hint) from None
        if value < 0:
            self.refuse(f"{name} is below 0 in a statement that goes along", item, SAY_IT)
        return written(value)

    def _word(self, node: Any) -> str:
        """Return a computed word with its number. Raises NoValueError."""
        parts = [c for c in node.children if not _is(c, "EQUALS")]
        step = "I" if _is(parts[-1], "STEP") else ""
        value = self.values.value(parts[1])
        if abs(value) > LARGEST:
            raise v.NoValueError("a number beyond what the control takes")
        return f" {str(parts[0]).upper()}{written(value)}{step} "

    def _set(self, node: Any) -> str:
        """Set a parameter, and return its name. Raises NoValueError."""
        target, sign, value = node.children
        name = self.values.name(target)
        if name[0] == "V" and not OWN.fullmatch(name):
            raise v.NoValueError(f"what setting {name} does is not certain", code="GX206")
        self.check_set(node, name)
        if self.reading.asides and (
            name.startswith("V.S.") or (name[0] == "P" and int(name[1:]) not in LOCALS)
        ):
            self.told_anew(UNSET)
        try:
            found = self.values.value(value)
            if str(sign) != "=":
                found = FAGOR.operators[str(sign)[0]](self.values.read(name), found)
        except v.NoValueError as why:
            if not why.lost:
                raise
            self.known[name] = None
        else:
            self.known[name] = found
        return name

    def check_set(self, node: Any, name: str) -> None:
        """Refuse to set what other assignments of the line read or set. Raises NoValueError."""
        others = [n for n in self.tree_of(self.lines[self.line]).children if n is not node]
        if any(name in self._names_in(other) for other in others if rule_of(other) == "assignment"):
            raise v.NoValueError(f"{name} is set here, and stands in another assignment")

    def _names_in(self, node: Any) -> Iterable[str]:
        """Yield the names of parameters and variables in a node."""
        if not isinstance(node, Tree):
            return
        if rule_of(node) in ("parameter", "variable"):
            yield self.values.name(node)
        for child in node.children:
            yield from self._names_in(child)


def rule_of(node: Any) -> str:
    """Return the rule of a node; nothing for a terminal."""
    return str(node.data).rsplit("__", 1)[-1] if isinstance(node, Tree) else ""


def _is(node: Any, kind: str) -> bool:
    return isinstance(node, Token) and node.type.rsplit("__", 1)[-1] == kind


def written(value: float) -> str:
    """Return a computed number as a word has it."""
    text = format(Decimal(repr(value)).quantize(Decimal(1).scaleb(-DECIMALS)), "f")
    text = text.rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
