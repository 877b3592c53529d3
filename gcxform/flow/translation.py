"""Programs whose statements are not blocks of words: each becomes the blocks that say the same.

A control with a language of its own is read in two steps. Its grammar takes a line apart into
items, and a `Translator` says which blocks of words the items stand for, in order; those are read
with the tables of the dialect, as any program is. What is written is a program of another dialect,
or of the same one where its translator `writes`: then each line whose blocks stayed as they were
stands as it did, and one whose blocks changed is spelled anew (`gcxform/emit/respelling.py`).

lark parses one line of each shape, as it does for words (`gcxform/syntax/scan.py`): two lines that
differ only in their numbers have the same items. A line of plain words is a template that is filled
in with its numbers, and the translator does not see it; a line with numbers in a comment is a shape
of its own. Numbers stay text, so no digit changes.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from typing import ClassVar, NoReturn

from lark import Lark, Token
from lark.exceptions import UnexpectedInput

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.flow.annexed import Annexed
from gcxform.flow.items import Item, Part, part_of
from gcxform.flow.lookup import Folders, LookupFailedError
from gcxform.flow.speller import Speller
from gcxform.flow.tree_shapes import SLOT, TreeShapes
from gcxform.modal.state import Reading
from gcxform.syntax import grammar_cache as kept
from gcxform.syntax.grammar import parsed, refusal_of
from gcxform.system.limits import how_to_raise, limits
from gcxform.values import dataclass

COMMENT, BLOCK_DELETE = "comment", "block_delete"
HINT = "let the CAM write plain moves in its place"
LATELY = 4096  # shapes with numbers in names and comments that are kept
QUICK = 4  # lines that are only translated, in the time of one that is executed
BRACKETS = str.maketrans("()", "[]")


@dataclass(frozen=True, slots=True)
class _Shape:
    """The parts of all lines that differ only in their numbers, and their comments.

    `template` is the block of a plain line, to be filled in with its numbers; nothing if it is not.
    """

    parts: tuple[Part, ...]
    comments: str
    template: str
    routine: bool = False


class Translator(ABC):
    """Turns the lines of one program into blocks; one is made for each program.

    The children of the grammar's `start` are the items of a line. Two kinds are seen to here:
    `comment`, which is kept, and `block_delete`, for which there is a setting. A translator may
    carry on at another line by setting `at`, which counts from 0.
    """

    grammar: ClassVar[tuple[str, str]]
    """Package and name of the grammar of a line."""
    number: ClassVar[re.Pattern[str]]
    """What the grammar's terminal NUMBER looks like, without groups; with a look behind it need not
    match the number of a code, which is then part of a name: `G54`."""
    signs: ClassVar[re.Pattern[bytes]]
    """What programs in this language have, and those of other controls have not."""
    writes: ClassVar[bool] = False
    """Whether programs in this language can be written as such again: see `spelled`."""
    speller: ClassVar[type[Speller] | None] = None
    """What writes programs for another control in this language; None: they are only read."""
    kept: ClassVar[str] = ""
    """The code of blocks that stand for a line that is kept as it stands, whatever it does."""

    def __init__(self, lines: list[str], file: str, dialect: type[Dialect], reading: Reading):
        self.lines = lines
        self.file = file
        self.dialect = dialect
        self.reading = reading
        self.line = self.at = self.visit = 0
        self.own = len(lines)
        """How many lines are those of the program; behind them are those of files that it calls."""
        self.annexed: Annexed | None = None
        self.assumed: dict[str, None] = {}
        """What a line was taken to mean that it does not say, in sentences."""
        self.loses: set[str] = set()
        """Axes, and F for the feed, that are lost before the next block: it is then not known where
        they are, or what is in force."""
        self.again: set[int] = set()
        """Lines that may be executed again, as only the machine knows: they have to stay."""
        self.stay: frozenset[int] = frozenset()
        """Those that were found to be executed `again` when the program was read before."""
        self.plainly = True
        """Whether plain lines are translated as such, and not by `blocks`."""
        self._lark = _grammar(*self.grammar)
        self._split = re.compile(f"({self.number.pattern})", self.number.flags).split
        self._shapes: dict[str, _Shape] = {}
        self._partly: dict[tuple[str, ...], _Shape] = {}
        self._fixed: dict[str, tuple[int, ...]] = {}
        self._items: tuple[Item, ...] = ()

    @abstractmethod
    def blocks(self, items: Sequence[Item]) -> Iterable[str]:
        """Return the blocks that the items of a line stand for. Raises InputError."""

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

    def several(self) -> list[str]:
        """Return the blocks of a run of lines from `line` on, one for each; nothing without one.

        They have to be what `blocks` returns for each of them by itself.
        """
        return []

    def closing(self) -> Iterable[str]:
        """Return the blocks behind the last line."""
        return ()

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks, in the manner of the one that is there.

        `line` counts from 0; None where no such line is known.

        What is returned is read again, and has to stand for those blocks.
        """
        del line, blocks
        return None

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return lines for what a line became, joined by line feeds; None where there are none.

        `said` are those of the speller, where nothing like the line can say it.
        """
        del line, said
        return None

    def renumbered(self, text: str) -> str:
        """Return a program in which a line became several, with its numbers anew."""
        return text

    def counts(self, line: str) -> bool:
        """Return whether a line has words that count from where an axis stands."""
        del line
        return False

    # --- lines ---

    def items(self, line: int) -> tuple[Item, ...]:
        """Return the items of a line. Raises InputError for what the grammar does not accept."""
        shape, numbers = self._shape(line)
        bare = [number.replace(" ", "").replace("\t", "") for number in numbers]
        return tuple(part.item(bare) for part in shape.parts)

    def _shape(self, line: int, text: str | None = None) -> tuple[_Shape, Sequence[str]]:
        """Return the shape of a line, or of a text for it, and its numbers.

        Those in a comment, or in a name, belong to the shape.
        """
        text = self.lines[line] if text is None else text
        pieces = self._split(text)
        found, key = pieces[1::2], SLOT.join(pieces[::2])
        shape = self._shapes.get(key)
        if shape is not None:
            return shape, found
        fixed = self._fixed.get(key)
        if fixed is not None:
            shape = self._partly.get((key, *[found[k] for k in fixed]))
            if shape is not None:
                return shape, [number for k, number in enumerate(found) if k not in fixed]
        return self._new_shape(line, text, key, found)

    def _new_shape(
        self, line: int, text: str, key: str, found: list[str]
    ) -> tuple[_Shape, Sequence[str]]:
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

    def _shape_of(self, text: str, numbers: Sequence[str], parts: tuple[Part, ...]) -> _Shape:
        said = [part for part in parts if part.kind == COMMENT]
        comments = "".join(_comment(text[slice(*part.place)]) for part in said)
        rest = [part for part in parts if part.kind != COMMENT]
        slots = [slot for part in rest for slot in part.slots]
        pairs = all(len(part.names) == 1 and len(part.slots) <= 1 for part in rest)
        if not rest or not pairs or slots != [*range(len(numbers))]:
            routine = not said and self.routine([part.item(numbers) for part in rest], text)
            return _Shape(parts, comments, "", routine)
        template = ""
        if self.plain([part.item(numbers) for part in rest]):
            words = [part.names[0].replace("%", "%%") + "%s" * len(part.slots) for part in rest]
            template = " ".join([*words, comments.replace("%", "%%")]).rstrip()
        routine = not said and self.routine([part.item(numbers) for part in rest], text)
        return _Shape(parts, comments, template, routine)

    def items_in(self, text: str) -> tuple[Item, ...]:
        """Return the items of a text that stands for the line. Raises InputError."""
        shape, numbers = self._shape(self.line, text)
        bare = [number.replace(" ", "").replace("\t", "") for number in numbers]
        return tuple(part.item(bare) for part in shape.parts)

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
            raise self._error(line, "GX101", what, (column - 1, column), "") from None
        numbers: list[Token] = []
        return numbers, tuple(part_of(child, numbers) for child in tree.children)

    # --- files ---

    def called_file(self, name: str) -> range | None:
        """Return the lines of the file of a subprogram that is called by a name; None without one.

        They are put behind those there are. Raises InputError for two files that differ.
        """
        if self.annexed is None:
            folders = Folders(self.reading.subprograms, self.dialect.flow_rule.lookup)
            self.annexed = Annexed(self.lines, folders)
        try:
            return self.annexed.file(name)
        except LookupFailedError as why:
            raise self.refusal("GX227", f"{name}: {why}") from None

    def at_end(self) -> None:
        """Come to the end of a file: that of the program is its end."""
        self.at = len(self.lines)

    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file in which a line stands, and which of its lines that is, from 1."""
        other = None if self.annexed is None else self.annexed.place(line)
        return other or (self.file, line + 1)

    # --- the walk ---

    def run(self) -> Iterator[tuple[int, str]]:
        """Yield blocks with the line that each is for, from 0. Raises InputError."""
        left = most = QUICK * limits().steps + len(self.lines)
        while self.at < len(self.lines):
            if self.annexed is not None and self.at in self.annexed.seams:
                self.at_end()
                continue
            self.line, self.at = self.at, self.at + 1
            self.visit += 1
            left -= 1
            if left < 0:
                message = f"the program is not over after {most} lines"
                raise self.refusal("GX224", message, hint=f"does it end? {how_to_raise('steps')}")
            shape, numbers = self._shape(self.line)
            if shape.template and self.plainly:
                yield self.line, shape.template % (*numbers,)
                continue
            run = self.several() if shape.routine else ()
            for block in run:
                yield self.line, block
                self.line, self.at = self.at, self.at + 1
                self.visit += 1
            if run:
                left -= len(run)
                shape, numbers = self._shape(self.line)
            for block in self._translated(shape, numbers):
                yield self.line, block
        self.line = max(self.own - 1, 0)
        self.visit += 1
        for block in self.closing():
            yield self.line, block

    def _translated(self, shape: _Shape, numbers: Sequence[str]) -> Iterator[str]:
        """Yield the blocks of a line, the first with its comments."""
        bare = [number.replace(" ", "").replace("\t", "") for number in numbers]
        items = self._items = tuple(part.item(bare) for part in shape.parts)
        rest = [item for item in items if item.kind not in (COMMENT, BLOCK_DELETE)]
        if self._skips(items):
            return
        comments = shape.comments
        for block in self.blocks(rest) if rest else ():
            yield f"{block} {comments}".rstrip()
            comments = ""
        if comments:
            yield comments

    def _skips(self, items: Sequence[Item]) -> bool:
        """Whether the control skips the line. Raises InputError where nobody has said so."""
        slash = next((item for item in items if item.kind == BLOCK_DELETE), None)
        if slash is None:
            return False
        policy = self.reading.blocks_with_a_slash(self.dialect)
        if not policy:
            message = "a switch of the control decides whether this block is executed"
            hint = 'block-delete = "execute" in [input], or block-delete = "skip" in [input]'
            raise self.refusal("GX211", message, slash, hint)
        return policy == "skip"

    # --- refusals ---

    def refusal(
        self, code: str, message: str, item: Item | None = None, hint: str = ""
    ) -> InputError:
        """Return the error about an item of the line that is translated; about all of it without.

        Where items of a shape stand is that of the first line of it, so the line is parsed again.
        """
        text = self.lines[self.line]
        place = len(text) - len(text.lstrip()), len(text.rstrip())
        if item is not None:
            same = [k for k, other in enumerate(self._items) if other is item]
            same += [k for k, other in enumerate(self.items(self.line)) if other == item]
            place = self._parsed(self.line)[1][same[0]].place if same else item.place
        return self._error(self.line, code, message, place, hint)

    def refuse(self, message: str, item: Item | None = None, hint: str = HINT) -> NoReturn:
        """Refuse an item as one that is not resolved. Raises InputError."""
        raise self.refusal("GX210", message, item, hint)

    def _error(
        self, line: int, code: str, message: str, place: tuple[int, int], hint: str
    ) -> InputError:
        start, end = place
        where = Location(*self.place_of(line), start + 1, self.lines[line], max(1, end - start))
        return InputError((Diagnostic(code, message, where, hint),))


@cache
def _grammar(package: str, name: str) -> Lark:
    """Return a grammar, which is loaded once: that takes longer than a short program does."""
    return kept.grammar(package, name)


def translator_of(dialect: type[Dialect]) -> type[Translator]:
    """Return what reads the language of a dialect that has one of its own."""
    kind = dialect.translator
    assert kind is not None
    assert issubclass(kind, Translator), f"{kind.__name__} is no Translator"
    return kind


def _comment(text: str) -> str:
    """Return a comment in round brackets."""
    inner = text[1:].removesuffix(")") if text.startswith("(") else text.lstrip(";* \t")
    return f"({inner.strip().translate(BRACKETS)})"
