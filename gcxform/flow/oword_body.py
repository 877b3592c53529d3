"""A file of O-words by itself: what its one subprogram does, as a program that can be executed.

The control executes nothing of such a file until something calls it. Read from the state of a call
its lines are those of a program: parameters up to 30 and names are its own in both. The lines of
`sub` and `endsub` become comments, so that all keep their numbers; in what is written they take
their places again. What stands behind `endsub` is never executed, and stays.

What a call does besides is refused: to return from the midst, to return a value of its own, to give
stored modes back, and to tell what was returned before.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterable
from collections.abc import Set as AbstractSet

from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.flow.arguments import unknown, unsaid
from gcxform.flow.executed import CalledFile
from gcxform.flow.listing import STORED_MODES, Listing, bare
from gcxform.flow.lookup import Folders
from gcxform.flow.oword_names import NAMES_POSITION
from gcxform.flow.run_state import has_slash, whole_number
from gcxform.flow.subprogram_file import keyword, label
from gcxform.flow.uncalled_subprograms import HINT
from gcxform.syntax.source import Source, line_end
from gcxform.syntax.tree import Block, Statement, Word

BEGINS, ENDS = b"(SUBPROGRAM BEGINS)", b"(SUBPROGRAM ENDS)"
ASKED = frozenset({"units", "distance", "feed-mode", "frame", "tool-length"})
"""The groups on which parameters depend that say modes or places."""
STORED = re.compile(rb"M[ \t]*0*7[ \t]*[0-3](?![0-9])", re.IGNORECASE)
RETURNED = re.compile(r"#[ \t]*<[ \t]*_value", re.IGNORECASE)


class Body(Source):
    """The lines of a file up to `last`, from 0; `first` and `last` have become comments."""

    def __init__(self, source: Source, lines: list[bytes], first: int, last: int) -> None:
        own = lines[: last + 1]
        own[first] = BEGINS + line_end(lines[first])
        own[last] = ENDS + line_end(lines[last])
        super().__init__(io.BytesIO(b"".join(own)), source.name, source.written)
        self.folder, self.suffix, self.state = source.folder, source.suffix, source.state
        self.lines, self.first, self.last = lines, first, last

    def whole(self, text: bytes) -> bytes:
        """Return the file for what its lines have become. Raises InputError if it is not one."""
        found = text.splitlines(keepends=True)
        for mark, line in ((BEGINS, self.first), (ENDS, self.last)):
            places = [n for n, each in enumerate(found) if each.strip() == mark]
            if len(places) != 1:
                raise self.refusal("its sub and endsub have no place in what is written", line)
            (at,) = places
            found[at] = self.lines[line].rstrip(b"\r\n") + line_end(found[at])
        return b"".join([*found, *self.lines[self.last + 1 :]])

    def refuse_unsaid(self, dialect: type[Dialect], said: Iterable[str]) -> None:
        """Refuse an argument that is read, and of which nothing is said. Raises InputError."""
        if found := dict(unsaid(self.lines[: self.last], dialect, said)):
            raise unknown(self.name, self.lines, found, "; what a call does not give is 0 in it")

    def refuse_called(self, files: Iterable[CalledFile]) -> None:
        """Refuse files that it calls. Raises InputError.

        That are itself, of which what is written would be called instead, and such as give back
        modes: those of which nobody says what they were.
        """
        own = b"".join(self.lines).rstrip()
        for each in files:
            if each.text.rstrip() == own:
                raise self.refusal("the subprogram calls itself", self.first)
            if STORED.search(each.text):
                message = f"{each.name}, which it calls, has M70 to M73, which give modes back"
                raise self.refusal(message, self.first)

    def refuse_asking(self, files: Iterable[CalledFile], said: AbstractSet[str]) -> None:
        """Refuse a subprogram that asks for modes or places if not all is said that they are."""
        unsaid = sorted(ASKED - said)
        texts = [b"".join(self.lines[: self.last]), *(each.text for each in files)]
        if unsaid and any(NAMES_POSITION.search(text.decode("latin-1")) for text in texts):
            message = f"it asks for modes or places, and its {' and '.join(unsaid)} are not said"
            raise self.refusal(message, self.first)

    def refusal(self, message: str, line: int) -> InputError:
        """Return why the file is not transformed by itself, by one of its lines, from 0."""
        return _refusal(message, self.name, line, self.lines[line])


def body_of(source: Source, dialect: type[Dialect]) -> Body:
    """Return what the one subprogram of a file does. Raises InputError."""
    text = b"".join(source.windows())
    listing = Listing(text, dialect, source.name, Folders((), dialect.flow_rule.lookup))
    lines = [listing.raw(n, n + 1) for n in range(len(listing))]
    words = {n: _word(listing.block(n)) for n in listing.special.tolist()}
    ends = [n for n, word in words.items() if word in ("SUB", "ENDSUB")]
    if len(ends) != 2:
        at = ends[2] if len(ends) > 2 else 0
        message = "a file of more than one subprogram is not executed by itself"
        raise _refusal(message, source.name, at, lines[at])
    first, last = ends
    for line in listing.special.tolist():
        if line <= last and (why := _why_not(listing, line, words[line], (first, last))):
            raise _refusal(why, source.name, line, lines[line])
    return Body(source, lines, first, last)


def _word(block: Block) -> str:
    """Return the keyword of the O-word with which a line begins, in capitals; else nothing."""
    items = bare(block)
    return keyword(items[0]) if items else ""


def _why_not(listing: Listing, line: int, word: str, ends: tuple[int, int]) -> str:
    """Return why a line is not executed as it is in a call; nothing if it is."""
    block = listing.block(line)
    if line in ends:
        return _why_no_end(block, listing.block(ends[0]))
    if line < ends[0]:
        return "" if not bare(block) else "what stands before the subprogram ends the file"
    codes = {whole_number(each) for each in block.words if each.address == "M"}
    if word == "RETURN":
        return "it returns from the midst"
    if codes & STORED_MODES:
        return "modes that M70 to M73 store are given back by its return"
    if any(isinstance(each, Word) and each.address == "O" for each in bare(block)):
        return "a number stands in it that M98 may call"
    return "it reads what was returned before" if RETURNED.search(block.text) else ""


def _why_no_end(block: Block, begin: Block) -> str:
    """Return why a line is no plain `sub` or `endsub` of one label; nothing if it is."""
    items = bare(block)
    if len(items) != 1 or has_slash(block) or label(items[0]) != label(bare(begin)[0]):
        return "sub and endsub of one label stand in lines of their own"
    assert isinstance(items[0], Statement)
    valued = len(items[0].tree.children) > 3 and "#" in block.text
    return "it returns a value that hangs on its own" if valued else ""


def _refusal(message: str, name: str, line: int, text: bytes) -> InputError:
    shown = text.rstrip(b"\r\n").decode("latin-1")
    where = Location(name, line + 1, text=shown, width=max(1, len(shown)))
    return InputError.one("GX226", message, where, HINT)
