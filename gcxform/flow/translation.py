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
from abc import abstractmethod
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from typing import Any, ClassVar, NoReturn

from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import Dialect
from gcxform.flow import slashes
from gcxform.flow.annexed import Annexed
from gcxform.flow.items import Item
from gcxform.flow.learned import SOON, Learned
from gcxform.flow.line_shapes import COMMENT, Shape
from gcxform.flow.line_writing import LineWriting
from gcxform.flow.lookup import Folders, LookupFailedError
from gcxform.flow.stretch import Ahead, Computed
from gcxform.modal.state import Reading
from gcxform.system.limits import how_to_raise, limits

BLOCK_DELETE = "block_delete"
HINT = "let the CAM write plain moves in its place"
QUICK = 4  # lines that are only translated, in the time of one that is executed


class Translator(LineWriting):
    """Turns the lines of one program into blocks; one is made for each program.

    The children of the grammar's `start` are the items of a line. Two kinds are seen to here:
    `comment`, which is kept, and `block_delete`, for which there is a setting. A translator may
    carry on at another line by setting `at`, which counts from 0.
    """

    signs: ClassVar[re.Pattern[bytes]]
    """What programs in this language have, and those of other controls have not."""
    keyed: ClassVar[Mapping[str, frozenset[str]]] = {}
    """Names of what learnt lines may hang on and change, for the translator ("") and for what it
    has under a name: `key` tells it, `take_key` takes it. Without any nothing is learnt; see
    `learned.py`."""
    fixed: ClassVar[frozenset[str]] = frozenset()
    """Names of what they may hang on and do not change: `key` tells that, or it never changes."""
    frame: Any = None
    """By what words of lines become those of blocks, where a program moves its zero."""

    def __init__(self, lines: list[str], file: str, dialect: type[Dialect], reading: Reading):
        super().__init__(lines, file, dialect)
        self.reading, self.comes_back = reading, reading.asides
        self.at = self.visit = 0
        self.own = len(lines)  # those of the program; behind them are those of files that it calls
        self.annexed: Annexed | None = None
        self.assumed: dict[str, None] = {}
        """What a line was taken to mean that it does not say, in sentences."""
        self.anew: dict[str, None] = {}
        """What holds besides where the program is written anew, and not in its own lines."""
        self.in_place: dict[int, str] = {}
        """Lines that stand in no program that is written anew, and why."""
        self.counted: set[int] = set()
        """Lines, from 0, that count from where an axis stands."""
        self.jumps: list[tuple[int, int]] = []
        """Each execution of a line that does not stand behind the one before, with that line."""
        self._behind = -1
        self.framed: list[tuple[int, Any]] = []
        """Each `frame` there was, with the first execution of a line behind it."""
        self.loses: set[str] = set()
        """Axes, and F for the feed, of which nothing is known any more at the next block."""
        self.loses_behind: dict[int, str] = {}
        """Axes that are lost behind all blocks of an execution of a line, by its number."""
        self.called_behind: set[int] = set()
        """Executions of lines behind each block of which a cycle is called."""
        self.again: set[int] = set()
        """Lines that may be executed again, as only the machine knows: they have to stay."""
        self.stay: frozenset[int] = frozenset()
        """Those that were found to be executed `again` when the program was read before."""
        self.plainly = True
        """Whether plain lines are translated as such, and not by `blocks`."""
        self._items: tuple[Item, ...] = ()
        self._learned = Learned(self) if self.keyed else None

    def lose_behind(self) -> None:
        """Lose before the next block what is lost behind the executions that are over."""
        for visit in [each for each in self.loses_behind if each < self.visit]:
            self.loses |= {*self.loses_behind.pop(visit)}

    @abstractmethod
    def blocks(self, items: Sequence[Item]) -> Iterable[str]:
        """Return the blocks that the items of a line stand for. Raises InputError."""

    def key(self) -> Hashable | None:
        """Return the state that `keyed` names; None where nothing can be learnt in it."""
        return None

    def take_key(self, key: Any) -> None:
        """Take a state; of where axes are, which of them have been lost."""
        raise NotImplementedError

    def told(self) -> dict[str, Any]:
        """Return where axes are, to be changed in its place; None for what is not known."""
        return {}

    def plain_words(self, ahead: Ahead, k: int) -> Computed | None:
        """Return a line that `computes` in plain words, one of those ahead; None for others.

        It is asked where lines are learnt, and may not hang on more than variables, nor change more
        of the translator, and nothing before it is done.
        """
        del ahead, k
        return None

    def several(self) -> list[str]:
        """Return the blocks of a run of lines from `line` on, one for each; nothing without one.

        A line without a block has an empty one. They are what `blocks` returns for each by itself.
        """
        return []

    def closing(self) -> Iterable[str]:
        """Return the blocks behind the last line."""
        return ()

    def count_on(self) -> None:
        """Note that a line counts from where an axis stands, if that may become another place."""
        if self.reading.asides:
            self.counted.add(self.line)

    def told_anew(self, sentence: str) -> None:
        """Tell what holds where the program is written, and not in its own lines."""
        (self.anew if self.reading.asides else self.assumed)[sentence] = None

    # --- files ---

    def called_file(self, name: str) -> range | None:
        """Return the lines of the file of a subprogram that is called by a name; None without one.

        They are put behind those there are. Raises InputError for two files that differ.
        """
        try:
            return self.annexing().file(name)
        except LookupFailedError as why:
            raise self.refusal("GX227", f"{name}: {why}") from None

    def annexing(self) -> Annexed:
        """Return what puts the lines of files behind those there are."""
        if self.annexed is None:
            folders = Folders(self.reading.subprograms, self.dialect.flow_rule.lookup)
            self.annexed = Annexed(self.lines, folders)
        return self.annexed

    def is_own(self, line: int) -> bool:
        """Whether a line may change: one of a file that is called may not, as others call it."""
        return line < self.own

    def in_main(self, line: int) -> bool:
        """Whether a line is of the main program, and of none that it calls, in its file or not."""
        return self.is_own(line)

    def at_end(self) -> None:
        """Come to the end of a file: that of the program is its end."""
        self.at = len(self.lines)

    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file in which a line stands, and which of its lines that is, from 1."""
        other = None if self.annexed is None else self.annexed.place(line)
        return other or (self.file, line + 1)

    # --- the walk ---

    def run(self) -> Iterator[tuple[int, Sequence[str]]]:
        """Yield blocks with the line that they are for, from 0. Raises InputError.

        Several are those of as many lines that follow upon each other, one for each; an empty one
        is none.
        """
        left = most = QUICK * limits().steps + len(self.lines)
        while self.at < len(self.lines):
            if self.annexed is not None and self.at in self.annexed.seams:
                self.at_end()
                continue
            first, learned = self.at, self._learned
            self._arrive()
            if learned is not None and learned.row >= SOON and (known := self._stretch(learned)):
                left -= len(known)
                self._behind = self.at
                yield first, known
                continue
            self.line = self.at
            self.at = self._behind = self.at + 1
            self.visit += 1
            left -= 1
            if left < 0:
                message = f"the program is not over after {most} lines"
                raise self.refusal("GX224", message, hint=f"does it end? {how_to_raise('steps')}")
            shape, numbers = self.shape(self.line)
            if shape.template and self.plainly:
                blocks = [shape.template % (*numbers,), *self._plain_behind()]
                left -= len(blocks) - 1
                self._behind = self.at
                yield first, blocks
                continue
            if shape.routine:
                blocks = self.several()
                left -= len(blocks)
                self._pass(len(blocks) - 1)
                yield first, blocks
                self._pass(1)
                self._behind = self.at
                shape, numbers = self.shape(self.line)
            for block in self._learnt(shape, numbers):
                yield self.line, (block,)
        if self._learned is not None:
            self._learned.leave()
        self.line = max(self.own - 1, 0)
        self.visit += 1
        for block in self.closing():
            yield self.line, (block,)

    def _arrive(self) -> None:
        """Note where the walk is not behind the line before, or in another frame."""
        if self.at != self._behind:
            self.jumps.append((self.visit + 1, self.at))
        if not self.framed or self.framed[-1][1] is not self.frame:
            self.framed.append((self.visit + 1, self.frame))

    def _stretch(self, learned: Learned) -> list[str]:
        """Return the blocks of the lines from here on that are known, one for each; go on to them.

        The translator is not touched by these.
        """
        known = learned.stretch(*self._lines_ahead(), self._shapes, self._in_plain_words)
        self._pass(len(known))
        return known

    def _in_plain_words(self, ahead: Ahead, k: int) -> Computed | None:
        """Return one of the lines ahead in plain words; None for one that is not so or is new."""
        return self.plain_words(ahead, k) if self.computes_alone(ahead, k) else None

    def _plain_behind(self) -> list[str]:
        """Return the blocks of the plain lines from here on, one for each; go on to them."""
        if self.at >= len(self.lines) or (
            self.annexed is not None and self.at in self.annexed.seams
        ):
            return []
        ahead, lines = self._lines_ahead()
        templates = list[str]()
        for line in lines:
            shape = self._shapes.get(ahead.keys[line])
            if shape is None or not shape.template:
                break
            templates.append(shape.template)
        if not templates:
            return []
        self._pass(len(templates))
        begin, end = ahead.starts[lines.start], ahead.starts[lines.start + len(templates)]
        return ("\n".join(templates) % tuple(ahead.numbers[begin:end])).split("\n")

    def _lines_ahead(self) -> tuple[Ahead, range]:
        """Return lines that were split at once, and those of them from here on, of one file."""
        ahead, k = self._split_ahead(self.at)
        stop = k + len(self.lines) - self.at
        if self.annexed is not None:
            stop = k + min(seam for seam in self.annexed.seams if seam > self.at) - self.at
        return ahead, range(k, min(stop, len(ahead.keys)))

    def _pass(self, count: int) -> None:
        """Go on behind lines of which there are the blocks."""
        self.at += count
        self.visit += count
        self.line = self.at - 1

    def _learnt(self, shape: Shape, numbers: Sequence[str]) -> Iterable[str]:
        """Return the blocks of a line, as they were learnt where there is something."""
        learned = self._learned
        if learned is None:
            return self._translated(shape, numbers)
        if shape.slots is None:
            known = self._computed(shape, learned) if shape.computes else None
            if known is not None:
                return known
            learned.leave()
            return self._translated(shape, numbers)
        found = learned.blocks(shape, shape.slots, numbers)
        if found is not None:
            return _with_comments(found, shape.comments)
        learned.leave()
        rest = [part for part in shape.parts if part.kind != COMMENT]
        tried = learned.tried(shape, shape.slots, rest, numbers)
        items = self._items = shape.items(numbers)
        blocks = [*self.blocks([item for item in items if item.kind != COMMENT])]
        if tried is not None:
            learned.confirm(tried, blocks, numbers)
        return _with_comments(blocks, shape.comments)

    def _computed(self, shape: Shape, learned: Learned) -> Iterable[str] | None:
        """Return the blocks of a line that computes, as they were learnt; None without these."""
        if (
            not learned.enter()
            or (found := self.plain_words(*self._split_ahead(self.line))) is None
        ):
            return None
        blocks: list[str] | None = []
        if found.shape is not None:
            slots = found.shape.slots
            blocks = None if slots is None else learned.blocks(found.shape, slots, found.numbers)
        if blocks is None:
            return None
        if found.done is not None:
            found.done()
        return _with_comments(blocks, shape.comments)

    def learnt_text(self, text: str, blocks: Callable[[Sequence[Item]], list[str]]) -> list[str]:
        """Return the blocks of a text that stands for the line: learnt ones, or by `blocks`.

        The text is one of plain words, of which `self.blocks` makes the same.
        """
        shape, numbers = self.shape(self.line, text)
        learned, slots = self._learned, shape.slots
        if learned is None or slots is None or shape.comments:
            made = blocks([item for item in shape.items(numbers) if item.kind != COMMENT])
            seen = self.shape(self.line)[0].comments  # an expression may hide what is behind it
            return [*_with_comments(made, shape.comments if not seen else "")]
        found = learned.blocks(shape, slots, numbers)
        learned.leave()
        if found is not None:
            return found
        tried = learned.tried(shape, slots, shape.parts, numbers)
        found = blocks(shape.items(numbers))
        if tried is not None:
            learned.confirm(tried, found, numbers)
        return found

    def _translated(self, shape: Shape, numbers: Sequence[str]) -> Iterator[str]:
        """Yield the blocks of a line, the first with its comments."""
        items = self._items = shape.items(numbers)
        rest = [item for item in items if item.kind not in (COMMENT, BLOCK_DELETE)]
        if self._skips(items):
            return
        yield from _with_comments(self.blocks(rest) if rest else (), shape.comments)

    def _skips(self, items: Sequence[Item]) -> bool:
        """Whether the control skips the line. Raises InputError where nobody has said so."""
        slash = next((item for item in items if item.kind == BLOCK_DELETE), None)
        if slash is None:
            return False
        policy = self.reading.blocks_with_a_slash(self.dialect)
        if not policy:
            raise self.refusal("GX211", slashes.OPEN, slash, slashes.SAY)
        self.assumed |= {slashes.TOLD[policy]: None} if self.reading.crosses else {}
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
        return self.error_at(self.line, code, message, place, hint)

    def refuse(self, message: str, item: Item | None = None, hint: str = HINT) -> NoReturn:
        """Refuse an item as one that is not resolved. Raises InputError."""
        raise self.refusal("GX210", message, item, hint)


def translator_of(dialect: type[Dialect]) -> type[Translator]:
    """Return what reads the language of a dialect that has one of its own."""
    kind = dialect.translator
    assert kind is not None
    assert issubclass(kind, Translator), f"{kind.__name__} is no Translator"
    return kind


def _with_comments(blocks: Iterable[str], comments: str) -> Iterable[str]:
    """Return blocks, the first with the comments of the line; these alone where there is none."""
    if not comments:
        return blocks
    first, *others = [*blocks] or [""]
    return [f"{first} {comments}".strip(), *others]
