"""Lines of a SINUMERIK that compute: they become the same lines with numbers, and decide nothing.

A line with a flow word says where to go on (`deciding.py`), and is no block.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import Any

from lark import Tree
from lark.exceptions import UnexpectedInput

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.compiling import MOST, Compiler, InPlainWords
from gcxform_plugins.dialects.siemens.deciding import Deciding
from gcxform_plugins.dialects.siemens.expressions import number_text
from gcxform_plugins.dialects.siemens.going_along import bare, goes_along
from gcxform_plugins.dialects.siemens.nodes import Node, names_in, rule_of, span_of
from gcxform_plugins.dialects.siemens.place import LINEAR
from gcxform_plugins.dialects.siemens.structure import StructureError, code
from gcxform_plugins.dialects.siemens.variables import AXES

COMPILED = frozenset(("word", "value", "named", "indexed", "expression"))
COMPUTED = frozenset(("expression", "flow", "system", "array"))
SLASH = re.compile(r"\A[ \t]*/[0-9]?")
MESSAGE = re.compile(r"MSG[ \t]*\(", re.IGNORECASE)
ZEROS = bytes.maketrans(b"123456789", b"000000000")
CYCLES = re.compile(
    r"CYCLE[678][0-9]+|HOLES[12]|POCKET[1-4]|SLOT[12]|LONGHOLE|WORKPIECE", re.IGNORECASE
)
HANDED_ON = re.compile(rf"(?:{CYCLES.pattern})[ \t]*\((?:[^\"A-Z]|\"[^\"]*\")*[A-Z]", re.IGNORECASE)
"""Cycles that are handed on what is not a plain number, and their like."""
BRACKETS = str.maketrans("()\x01", "[] ")
UNTOLD = "messages of which only the control knows the text are left out"
AS_THEY_STAND = frozenset(("word", "bare", "label", "sequence", "call", "text_call"))


class Computing(Deciding):
    """Executes lines that compute.

    kept_lines     those that are not understood, and why;  standing: those that stay all the same
    unsaid         modal groups of which it is not known what is in force
    unknown_cycle  the line of MCALL with a cycle that is not read
    fed            a feed may be in force, in `feed_mode`: none is behind another feed mode
    """

    def __init__(self, lines: list[str], file: str, dialect: Any, reading: Any) -> None:
        super().__init__(lines, file, dialect, reading)
        self.kept_lines: list[tuple[int, str]] = []
        self.standing: list[tuple[int, str]] = []
        self.unsaid: set[str] = set()
        self.unknown_cycle = ""
        self._keys: dict[tuple[str, bytes], str] = {}
        self._compiled: dict[Hashable, InPlainWords | None] = {}
        self._compiler = Compiler(self.worth, self.given)
        self.fed, self.feed_mode = True, "94"
        if reading.stays and reading.feed is None:
            self.loses.add("F")

    # --- lines ---

    def may_compile(self, parts: Sequence[Any]) -> bool:
        """Whether lines with these parts may be compiled."""
        return {part.kind for part in parts} <= COMPILED and any(map(self._may_compute, parts))

    def _may_compute(self, part: Any) -> bool:
        kind, name = str(part.kind), str(part.names[0])
        return kind == "expression" or (kind == "indexed" and name == "R")

    def plain_words(self, ahead: gx.Ahead, k: int) -> gx.Computed | None:
        """Return a line in plain words, which may set R parameters; None for other lines."""
        numbers, grammar = ahead.numbers_of(k), self.grammar_of_expressions
        text = " ".join(numbers)
        form = ahead.keys[k], text.encode().translate(ZEROS)
        key = self._keys.get(form)
        if key is None and (key := self._new_key(form, ahead.first + k)) is None:
            return None
        fixed = grammar.fixed(key)
        if fixed is None:
            return None
        signed = "-" in text or "+" in text
        bare = [number.lstrip("+-") for number in numbers] if signed else numbers
        name = (key, *[bare[slot] for slot in fixed])
        try:
            if name not in self._compiled:
                self._compile(name, ahead.first + k, bare)
            line = self._compiled[name]
            return line and line.computed(bare, self.r, self._take)
        except (v.NoValueError, OverflowError):
            return None

    def _new_key(self, form: tuple[str, bytes], line: int) -> str | None:
        """Return the key of a line by the grammar of expressions, and keep it."""
        if len(self._keys) >= MOST:
            self._keys.clear()
        with suppress(UnexpectedInput):
            return self._keys.setdefault(form, self.grammar_of_expressions.key(self.lines[line]))
        return None

    def _compile(self, name: Hashable, line: int, numbers: Sequence[str]) -> None:
        """Compile a line and keep it by a name; None of one that is left to `executed`.

        Raises NoValueError, OverflowError.
        """
        if len(self._compiled) >= MOST:
            self._compiled.clear()
        text = self.lines[line]
        tree, spans = self.tree_of(text), self.grammar_of_expressions.spans(text)
        made = self._compiler.compiled(tree, text, spans)
        known = made and made.known(numbers, self.r, lambda plain: self.shape(line, plain))
        self._compiled[name] = known

    def _take(self, given: Sequence[tuple[int, Any]]) -> None:
        """Take R parameters of a line that is compiled."""
        self.r.update(given)
        self.tell_of_parameters()

    def executed(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a line. Raises InputError."""
        if not any(self._computes(item) for item in items):
            return self._plainly(items) if not self._tells(items) else self._message()
        text = self.lines[self.line]
        try:
            tree = self.tree_of(text)
            straight = self._straight(tree, text)
        except UnexpectedInput:
            self.refuse("this is not read", items[-1] if items else None)
        except v.NoValueError as why:
            raise self.refusal(why.code, why.message, None, why.hint) from None
        except StructureError as why:
            self.line = why.line
            raise self.refusal("GX223", why.message) from None
        if not straight.strip():
            return []
        self.straight = straight
        try:
            return self.learnt_text(straight, self._plainly)
        finally:
            self.straight = ""

    def executed_or_along(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line, or the one of a line that goes along. Raises InputError."""
        try:
            return self.executed(items)
        except gx.InputError:
            found = goes_along(text := bare(self.lines[self.line]))
            if found is None or not self.reading.asides:
                raise
            if found.counts:
                self.in_place[self.line] = found.counts
            if {*found.axes} & {*LINEAR} and (self.following or self.comp or self.drilling):
                self.refuse("this leads axes elsewhere under TRAORI, MCALL or compensation")
            self.lose_axes(found.axes)
            if {*found.axes} & {*LINEAR}:
                self.place.lose(self.moved_inside(found.axes))
            number = next((f"N{i.numbers[0]} " for i in items if i.name == "N"), "")
            return [f"{number}{gx.Speller.along(text)}"]

    def lose_axes(self, axes: str) -> None:
        """Forget where axes are; F is the feed that is in force."""
        self.place.lose([axis for axis in axes if axis != "F"])
        self.loses |= {*axes}

    def _tells(self, items: Sequence[gx.Item]) -> bool:
        """Whether a line only shows a text that is computed, and does not stay as it stands."""
        rest = [i for i in items if i.kind not in ("label", "main_number") and i.name != "N"]
        calls = [i for i in rest if i.kind == "call" and MESSAGE.match(i.name)]
        return len(rest) == len(calls) == 1 and not self.reading.stays

    def _message(self) -> list[str]:
        """Return the comment for a text that is shown; none for what only the control knows."""
        try:
            tree = self.tree_of(self.lines[self.line])
            call = next(node for node in tree.children if rule_of(node) == "call")
            slots = next(node for node in call.children if rule_of(node) == "arguments").children
            told = self.worth.text(self.worth.of(slots[0].children[0])).translate(BRACKETS)
            return [self.comment(f'MSG("{told}")') if self.reading.asides else f"({told})"]
        except (UnexpectedInput, IndexError):
            self.refuse("this message is not read")
        except v.NoValueError as why:
            if not why.lost:
                raise self.refusal(why.code, why.message, None, why.hint) from None
            self.told_anew(UNTOLD)
            return []

    def _plainly(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a line that does not compute."""
        return self._ended(items, [*super().blocks(items)])

    def _computes(self, item: gx.Item) -> bool:
        if item.kind == "indexed":
            return item.name == "R"
        if item.kind == "call":
            return HANDED_ON.match(item.name) is not None
        return item.kind in COMPUTED or (item.kind == "named" and self._cell(item.name) is not None)

    def _ended(self, items: Sequence[gx.Item], blocks: list[str]) -> list[str]:
        """Return the blocks of a line; behind an end of the program there are no others."""
        ends = any(i.kind == "word" and i.name == "M" and _whole(i) in (2, 17, 30) for i in items)
        if ends and self.decides:
            self.at = len(self.lines)
        if any(item.names and item.name in AXES for item in items):
            self.stopped = False
        self.stopped |= any(item.name == "STOPRE" for item in items if item.names)
        return blocks

    def _handed_on(self, node: Node) -> Iterator[tuple[int, int, str]]:
        """Yield the numbers of what a cycle is handed on; its words, as _FINISH, stay."""
        if not CYCLES.fullmatch(str(node.children[0])):
            return
        arguments: Any = next(c for c in node.children if rule_of(c) == "arguments")
        for slot in arguments.children:
            (value,) = slot.children or (None,)
            word = rule_of(value) == "variable" and not any(map(self._is_known, names_in(value)))
            if isinstance(value, Tree) and not word:
                yield *span_of(slot), number_text(self.worth.number(value))

    def _is_known(self, name: str) -> bool:
        return self._is_variable(name, None) or name.startswith("$") or name == "R"

    def _straight(self, tree: Node, text: str) -> str:
        """Return a line of plain words for one that computes; nothing where it decides."""
        edits: list[tuple[int, int, str]] = []
        set_names = {*self._names_set(tree)}
        for node in tree.children:
            assert isinstance(node, Tree)
            rule = rule_of(node)
            if rule in self.flow:
                if rule not in ("def", "proc"):
                    self.decides = True
                self.flow[rule](node)
            if rule == "assignment":
                edits += self._assignment(node, set_names)
            elif rule == "call":
                edits += self._handed_on(node)
            elif rule not in AS_THEY_STAND:
                edits.append((*span_of(node), ""))
        text = text.partition(";")[0] if '"' not in text else code(text, True)
        for start, end, new in sorted(edits, reverse=True):
            text = text[:start] + new + text[end:]
        return SLASH.sub("", text)


def _whole(item: gx.Item) -> int:
    return int(item.numbers[0]) if item.numbers[0].isdigit() else -1
