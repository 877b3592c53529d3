"""Lines of a language of its own, taken apart into items: lark parses one line of each shape.

Two lines that differ only in their numbers have the same items. A number in a comment, or in a
name, belongs to the shape.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import field
from functools import cache
from typing import ClassVar

from lark import Lark, Token
from lark.exceptions import UnexpectedInput

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.flow.items import Item, Part, part_of
from gcxform.flow.learned import CODE, DIGITS
from gcxform.flow.speller import ASIDE, HIDDEN
from gcxform.flow.split_numbers import split_at_numbers
from gcxform.flow.stretch import Ahead, Slots
from gcxform.flow.tree_shapes import SLOT, TreeShapes
from gcxform.syntax import grammar_cache as kept
from gcxform.syntax.grammar import parsed, refusal_of
from gcxform.values import dataclass

COMMENT = "comment"
LATELY = 4096  # shapes with numbers in names and comments that are kept
AHEAD, SOME = 512, 64  # lines that are split at once, and how many of such parts are kept
BRACKETS = str.maketrans(f"(){ASIDE}", "[] ")
IN_ITS_LANGUAGE = HIDDEN | str.maketrans(ASIDE, " ")
"""What brackets in comments become where they come back: in the language that was read."""


@dataclass(eq=False, slots=True)
class Shape:
    """The parts of all lines that differ only in their numbers, and their comments.

    `template` is the block of a plain line, to be filled in with its numbers; nothing if it is not.
    `slots` says what can be learnt of such lines; None if nothing. Those that are `steady` do what
    their state says or is not known yet, and nothing beside. One that `computes` may become a line
    that is learnt.
    """

    parts: tuple[Part, ...]
    comments: str
    template: str
    routine: bool = False
    slots: Slots | None = None
    computes: bool = False
    steady: bool = field(init=False)

    def __post_init__(self) -> None:
        bare = not (self.comments or self.template or self.routine)
        self.steady = bare and self.slots is not None

    def items(self, numbers: Sequence[str]) -> tuple[Item, ...]:
        """Return the items of a line with these numbers."""
        if any([" " in number or "\t" in number for number in numbers]):
            numbers = [number.replace(" ", "").replace("\t", "") for number in numbers]
        return tuple([part.item(numbers) for part in self.parts])


class LineShapes(ABC):
    """The lines of a program, and the shapes that they have had."""

    grammar: ClassVar[tuple[str, str]]
    """Package and name of the grammar of a line."""
    number: ClassVar[re.Pattern[str]]
    """What the grammar's terminal NUMBER looks like, without groups and within a line; with a look
    behind it need not match the number of a code, which is then part of a name: `G54`. With a
    pattern of `split_numbers.py` lines are split faster."""

    def __init__(self, lines: list[str], file: str, dialect: type[Dialect]) -> None:
        self.lines = lines
        self.file = file
        self.dialect = dialect
        self.line = 0
        self.comes_back = False
        self.others: tuple[range, ...] = ()
        """Lines, from 0, of other programs in the file: they stay where this one is written anew,
        in its language."""
        self._lark = _grammar(*self.grammar)
        self._shapes: dict[str, Shape] = {}
        self._partly: dict[tuple[str, ...], Shape] = {}
        self._fixed: dict[str, tuple[int, ...]] = {}
        self._parts_ahead: dict[int, Ahead] = {}
        self._computing: dict[str, bool] = {}

    @abstractmethod
    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file in which a line stands, and which of its lines that is, from 1."""

    def plain(self, items: Sequence[Item]) -> bool:
        """Whether items are the words of one block, in order, whatever stands before them.

        Asked once for each shape, so the answer must not depend on numbers. It spares such lines
        the way through `blocks` while `plainly` is set: each item has a name, or one and a number.
        """
        return False

    def routine(self, items: Sequence[Item], text: str) -> bool:
        """Whether lines that differ from this one, `text`, only in numbers may come in runs.

        Asked once for each shape, of a line without a comment.
        """
        del items, text
        return False

    def role(self, part: Part) -> str:
        """Return what numbers of an item may be in lines that are learnt; nothing if none are.

        "any", "digits" alone, or "code", of which each is another line.
        """
        del part
        return ""

    def may_compile(self, parts: Sequence[Part]) -> bool:
        """Whether lines with these parts may be asked what they are in plain words."""
        del parts
        return False

    def items(self, line: int) -> tuple[Item, ...]:
        """Return the items of a line. Raises InputError for what the grammar does not accept."""
        shape, numbers = self.shape(line)
        return shape.items(numbers)

    def shape(self, line: int, text: str | None = None) -> tuple[Shape, Sequence[str]]:
        """Return the shape of a line, or of a text for it, and its numbers.

        Those in a comment, or in a name, belong to the shape.
        """
        if text is None:
            ahead, k = self._split_ahead(line)
            key = ahead.keys[k]
            found = [*ahead.numbers_of(k)]
        else:
            key, found = self._divided(text)
        shape = self._shapes.get(key)
        if shape is not None:
            return shape, found
        shape = self._shape_in_part(key, found)
        if shape is not None:
            fixed = self._fixed[key]
            return shape, [number for k, number in enumerate(found) if k not in fixed]
        return self._new_shape(line, self.lines[line] if text is None else text, key, found)

    def known_shape(self, ahead: Ahead, k: int) -> Shape | None:
        """Return the shape of one of the lines ahead, if there was one like it."""
        key = ahead.keys[k]
        return self._shapes.get(key) or self._shape_in_part(key, ahead.numbers, ahead.starts[k])

    def computes_alone(self, ahead: Ahead, k: int) -> bool:
        """Whether one of the lines ahead computes, as others like it, and has no comment."""
        found = self._computing.get(ahead.keys[k])
        if found is not None:
            return found
        shape = self.known_shape(ahead, k)
        if shape is None:
            return False
        found = self._computing[ahead.keys[k]] = shape.computes and not shape.comments
        return found

    def _shape_in_part(self, key: str, numbers: Sequence[str], at: int = 0) -> Shape | None:
        """Return the shape of a key with these numbers in its names and comments, if known."""
        fixed = self._fixed.get(key)
        if fixed is None:
            return None
        return self._partly.get((key, *[numbers[at + slot] for slot in fixed]))

    def _split_ahead(self, line: int) -> tuple[Ahead, int]:
        """Return some lines, each without its numbers, and with them; which of them is `line`."""
        part, k = divmod(line, AHEAD)
        found = self._parts_ahead.get(part)
        if found is None or k >= len(found.keys):
            if len(self._parts_ahead) >= SOME:
                self._parts_ahead.clear()
            first = part * AHEAD
            keys, numbers = self._divided("\n".join(self.lines[first : first + AHEAD]))
            found = self._parts_ahead[part] = Ahead.of(first, keys, numbers, SLOT)
        return found, k

    def _divided(self, text: str) -> tuple[str, list[str]]:
        """Return a text without its numbers, and with them."""
        return split_at_numbers(text, SLOT, self.number)

    def _new_shape(
        self, line: int, text: str, key: str, found: list[str]
    ) -> tuple[Shape, Sequence[str]]:
        """Return the shape of a line of which there was none, and its numbers."""
        numbers, parts = self._parsed(line, text)
        shape = self._shape_of(text, numbers, parts)
        if numbers == found:
            self._shapes[key] = shape
            return shape, numbers
        places = [at.span() for at in self.number.finditer(text)]
        taken = {number.start_pos: str(number) for number in numbers}
        own = [k for k, (at, _) in enumerate(places) if taken.get(at) == found[k]]
        fixed = tuple(k for k in range(len(found)) if k not in own)
        if len(own) < len(numbers) or self._fixed.setdefault(key, fixed) != fixed:
            return shape, numbers
        if len(self._partly) >= LATELY:
            self._partly.clear()
        self._partly[key, *[found[k] for k in fixed]] = shape
        return shape, numbers

    def _shape_of(self, text: str, numbers: Sequence[str], parts: tuple[Part, ...]) -> Shape:
        said = [part for part in parts if part.kind == COMMENT]
        comments = "".join(self.comment(text[slice(*part.place)]) for part in said)
        rest = [part for part in parts if part.kind != COMMENT]
        slots = [slot for part in rest for slot in part.slots]
        pairs = all(len(part.names) == 1 and len(part.slots) <= 1 for part in rest)
        if not rest or not pairs or slots != [*range(len(numbers))]:
            routine = not said and self.routine([part.item(numbers) for part in rest], text)
            return Shape(parts, comments, "", routine, computes=self.may_compile(rest))
        template = ""
        if self.plain([part.item(numbers) for part in rest]):
            words = [part.names[0].replace("%", "%%") + "%s" * len(part.slots) for part in rest]
            template = " ".join([*words, comments.replace("%", "%%")]).rstrip()
        routine = not said and self.routine([part.item(numbers) for part in rest], text)
        return Shape(parts, comments, template, routine, self._slots(rest))

    def comment(self, text: str) -> str:
        """Return the comment of a block for one of the language."""
        return _comment(text, IN_ITS_LANGUAGE if self.comes_back else BRACKETS)

    def _slots(self, parts: Sequence[Part]) -> Slots | None:
        """Return what can be learnt of lines with these parts."""
        roles = [(part, self.role(part)) for part in parts]
        if not all(role for _, role in roles):
            return None
        of = {name: [k for p, r in roles if r == name for k in p.slots] for name in (CODE, DIGITS)}
        return Slots(tuple(of[CODE]), tuple(of[DIGITS]))

    def take_for(self, line: int, text: str) -> None:
        """Take a line for another text; it stands where it stands as it is."""
        self.lines[line] = text
        self._parts_ahead.clear()

    def items_in(self, text: str) -> tuple[Item, ...]:
        """Return the items of a text that stands for the line. Raises InputError."""
        shape, numbers = self.shape(self.line, text)
        return shape.items(numbers)

    def placed_items(self, line: int) -> list[Item]:
        """Return the items of a line with their own places; those of `items` are of its shape."""
        numbers, parts = self._parsed(line)
        return [part.item(numbers) for part in parts]

    def text_in(self, line: int, item: Item, text: str | None = None) -> str:
        """Return an item of a line, or of a text for it, as it is written there.

        Its place is that in the first line of its shape: numbers before it may be longer here.
        """
        said = self.lines[line] if text is None else text
        found = said[slice(*item.place)]
        if found.upper() == item.name and not item.numbers:
            return found
        numbers, parts = self._parsed(line, said)
        bare = ["".join(number.split()) for number in numbers]
        there = (part for part in parts if part.item(bare)[:3] == item[:3])
        return said[slice(*next(there, item).place)]

    def grammar_named(self, package: str, name: str) -> TreeShapes:
        """Return what parses by another grammar of the language, as `grammar` names one."""
        return TreeShapes(_grammar(package, name))

    def _parsed(self, line: int, text: str | None = None) -> tuple[list[Token], tuple[Part, ...]]:
        """Return the numbers of a line, and its parts; or of another text for it."""
        text = self.lines[line] if text is None else text
        try:
            tree = parsed(self._lark, text)
        except UnexpectedInput as error:
            column, message = refusal_of(error, text)
            what = f"this is not a program for {self.dialect.name}: {message}"
            raise self.error_at(line, "GX101", what, (column - 1, column), "") from None
        numbers: list[Token] = []
        return numbers, tuple(part_of(child, numbers) for child in tree.children)

    def error_at(
        self, line: int, code: str, message: str, place: tuple[int, int], hint: str
    ) -> InputError:
        """Return the error about a part of a line, as it was read."""
        start, end = place
        where = Location(*self.place_of(line), start + 1, self.lines[line], max(1, end - start))
        return InputError((Diagnostic(code, message, where, hint),))


@cache
def _grammar(package: str, name: str) -> Lark:
    """Return a grammar, which is loaded once: that takes longer than a short program does."""
    return kept.grammar(package, name)


def _comment(text: str, brackets: Mapping[int, str | int]) -> str:
    """Return a comment in round brackets."""
    inner = text[1:].removesuffix(")") if text.startswith("(") else text.lstrip(";* \t")
    bare = inner.strip(" \t")  # half of a letter of two bytes is no blank
    return f"({bare.translate(brackets)})"
