"""Writes a program in the language it was read in, where that is not one of words.

Its lines were turned into blocks, and those were transformed and written one after the other. A
line whose blocks stayed as they were, every time it was executed, stands as it did, byte for byte;
for another one its translator spells a new line, which has to be the same each time. What is not
executed stays. `gcxform/proof/respelled.py` reads what comes out of here.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

import numpy as np

from gcxform.diagnostics import Diagnostic, Location, SpellingError
from gcxform.emit.spelled_out import inch_first
from gcxform.flow.annexed import BYTE_ORDER_MARK, LINE_END
from gcxform.flow.speller import UnspeakableError
from gcxform.flow.translated import Translated
from gcxform.flow.translation import Translator
from gcxform.toolpath.facts import Fact

HINT = "let the CAM write plain moves in its place, or write for another dialect"
WHY = {
    "METRIC": "its lengths are inches",
    "LINEAR_ONLY": "it may lead along an arc",
    "XY_ARCS": "it may lead along an arc",
    "NO_CYCLES": "it drills in a cycle",
    "WORKPIECE_FRAME": "it shifts or turns coordinates",
}
"""What is wrong with a line that has what is against a fact."""
IN_LINES = frozenset(("NO_CYCLES", "WORKPIECE_FRAME"))
"""Facts that hold of blocks, and not of the lines that stand for them."""


def counting_lines(translator: Translator) -> frozenset[int]:
    """Return the lines, from 0, with words that count from where an axis stands."""
    lines, counted = translator.lines, frozenset(translator.counted)
    if not translator.stepped:
        return counted | {k for k, line in enumerate(lines) if translator.counts(line)}
    text = translator.uncommented("\n".join(lines))
    found, line, at = set[int](), 0, 0
    for place in sorted(m.end() for each in translator.stepped for m in each.finditer(text)):
        line, at = line + text.count("\n", at, place), place
        found.add(line)
    return counted | {line for line in found if translator.counts(lines[line])}


def respelled(
    given: bytes,
    source: Translated,
    blocks: list[list[bytes]],
    counting: frozenset[int] = frozenset(),
) -> bytes:
    """Return a program for its blocks as they were written: lists of lines, by block.

    Words of lines that are `counting` from where an axis stands are written as positions, but for
    lines whose blocks stay and that no other can stand for: steps of a loop, or by a parameter.
    Raises SpellingError where a line cannot be spelled, or would differ between its executions.
    """
    new: dict[int, str] = {}
    changes: dict[int, bool] = {}
    whole, translator = source.text.splitlines(), source.translator
    at_stake = _changing(source, whole, blocks) | counting
    speller = Spelling(translator, whole)
    for line, first, stop in runs(source):
        speller.met(blocks[first:stop])
        if line not in at_stake:
            continue
        made = _ends_off(blocks[first:stop])
        raw = source.lines[line]
        text: str | None = raw
        stepped = line in counting and not _is_kept(translator.kept, made)
        changed = made != whole[first:stop]
        changes[line] = changes.get(line, False) or changed
        if changed or stepped:
            text = _anew(translator, speller, line, made, whole[first:stop])
            text = raw if text is None and not changed else text
        if text != raw and not translator.is_own(line):
            raise refusal(source, line, "this line would change, and stands in another program")
        if text is None:
            raise refusal(source, line, "what this line became cannot be said in its language")
        if new.setdefault(line, text) != text:
            if changes[line]:
                raise refusal(source, line, "this line becomes another each time it is executed")
            new[line] = raw
    new = {line: text for line, text in new.items() if text != source.lines[line]}
    several = any("\n" in text for text in new.values())
    made_of = _joined(given, new) if new else given
    if not several:
        return made_of
    return translator.renumbered(made_of.decode("latin-1")).encode("latin-1")


def refuse_kept(source: Translated, facts: Collection[Fact]) -> None:
    """Refuse a line that would stay as it stands and is what a pass leaves nowhere.

    Raises SpellingError.
    """
    translator = source.translator
    against = [f.name for f in facts if f.name in WHY and f.name in translator.against]
    if not against:
        return
    kept = [
        line
        for line, block in zip(source.origin.tolist(), source.text.splitlines(), strict=True)
        if _is_kept(translator.kept, [block])
    ]
    executed = {*source.executed_lines()[1:].tolist()} if IN_LINES & {*against} else ()
    for name in against:
        for line in (*kept, *translator.left_behind(), *(executed if name in IN_LINES else ())):
            if translator.against[name].search(source.lines[line]):
                raise refusal(source, line, f"this line would stay as it stands, and {WHY[name]}")


def against_lines(translator: Translator, facts: Collection[Fact]) -> list[re.Pattern[str]]:
    """Return what no line may have that is executed, by facts that hold of blocks alone."""
    names = IN_LINES & {fact.name for fact in facts} & translator.against.keys()
    return [translator.against[name] for name in sorted(names)]


class Spelling:
    """What the speller of a language says to the blocks of its programs, one after the other.

    It hears of those that were met when it is asked for the last of them, and not before.
    """

    def __init__(self, translator: Translator, blocks: list[bytes], asides: bool = False) -> None:
        replaces = type(translator).replaced is not Translator.replaced
        kind = translator.speller if replaces else None
        self.speller = None if kind is None else kind("", inch_first(blocks, False))
        if self.speller is not None:
            self.speller.asides = asides
        self.waiting: list[list[list[bytes]]] = []

    def met(self, blocks: list[list[bytes]]) -> None:
        """Take note of what the blocks of a line became."""
        if self.speller is not None:
            self.waiting.append(blocks)

    def said(self) -> list[str] | None:
        """Return lines for the last blocks; None where the language has no words for them."""
        found: list[str] | None = None
        for blocks in self.waiting:
            found = self._said(_ends_off(blocks))
        self.waiting.clear()
        return found

    def _said(self, blocks: list[bytes]) -> list[str] | None:
        assert self.speller is not None
        try:
            return [
                line for block in blocks for line in self.speller.lines(block.decode("latin-1"))
            ]
        except UnspeakableError:
            self.speller.lose()
            return None


def _anew(
    translator: Translator, speller: Spelling, line: int, made: list[bytes], was: list[bytes]
) -> str | None:
    """Return a line for what its blocks became; None where it cannot be said.

    Where only the first became another it says the place at which a cycle is called.
    """
    text = translator.spelled(line, [each.decode("latin-1") for each in made])
    if text is None and len(made) > 1 and made[1:] == was[1:]:
        text = translator.spelled(line, [made[0].decode("latin-1")])
    said = speller.said() if text is None else None
    return translator.replaced(line, said) if said else text


def _is_kept(code: str, blocks: list[bytes]) -> bool:
    return any(code.encode() in block.split() for block in blocks)


def _ends_off(blocks: list[list[bytes]]) -> list[bytes]:
    """Return the lines of blocks without what ends them."""
    return [line.rstrip(b"\r\n") for block in blocks for line in block]


def _changing(source: Translated, whole: list[bytes], blocks: list[list[bytes]]) -> frozenset[int]:
    """Return the lines of which a block became another, at least once."""
    blocks_changed = [
        k
        for k, (was, made) in enumerate(zip(whole, blocks, strict=True))
        if len(made) != 1 or (made[0] != was and made[0].rstrip(b"\r\n") != was)
    ]
    return frozenset(source.origin[blocks_changed].tolist())


def runs(source: Translated) -> Iterator[tuple[int, int, int]]:
    """Yield each execution of a line that has blocks: the line, its first block, the one behind."""
    count = len(source.visits)
    firsts = np.flatnonzero(np.diff(source.visits, prepend=-1))
    lines = source.origin[firsts].tolist()
    yield from zip(lines, firsts.tolist(), [*firsts[1:].tolist(), count], strict=True)


def _joined(given: bytes, new: dict[int, str]) -> bytes:
    """Return a program with other lines in place of some of its own; line ends stay."""
    head = BYTE_ORDER_MARK if given.startswith(BYTE_ORDER_MARK) else b""
    body = given[len(head) :]
    found, at, line = [head], 0, 0
    ends = LINE_END.search(body)
    between = ends[0] if ends else b"\n"
    for end in (*LINE_END.finditer(body), None):
        stop, behind = (len(body), len(body)) if end is None else end.span()
        old = body[at:stop]
        text = new.get(line, "").encode("latin-1").replace(b"\n", between)
        found += [text if line in new and text.strip() != old.strip() else old, body[stop:behind]]
        at, line = behind, line + 1
    return b"".join(found)


def refusal(source: Translated, line: int, message: str) -> SpellingError:
    """Return the error about a line that cannot be written back."""
    text = source.lines[line]
    where = Location(*source.translator.place_of(line), 1, text, max(1, len(text.rstrip())))
    return SpellingError((Diagnostic("GX501", message, where, HINT),))
