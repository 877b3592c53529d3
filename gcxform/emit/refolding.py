"""Writes a program whose positions became others in its own lines, in a language of its own.

Its blocks have been written one after the other. A line whose blocks say what they said stands as
it did, byte for byte; in another one words are changed where they stand, as they count in the frame
that is in force there. Pieces of a move stand behind each other, the first with the head and the
comment of its line. What is not executed stays. What comes out is read again and compared with the
blocks (`gcxform/proof/refolded.py`): where anything cannot be said so, the program is written anew.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import field

from gcxform.emit.folding import Folded
from gcxform.emit.respelling import Spelling, counting_lines, refusal, runs
from gcxform.flow.annexed import BYTE_ORDER_MARK, LINE_END
from gcxform.flow.block_words import LINEAR, At, BlockWords, Change, as_text, block_of
from gcxform.flow.translated import Translated
from gcxform.stamps.comment import OPEN_SEAL, is_stamp
from gcxform.values import dataclass

SLASHED = "a slash: a switch decides on lines that have become others"
OTHERS = "this line would change, and stands in another program"
UNSAID = "what this line became cannot be said in its place"
DIFFERS = "this line becomes another each time it is executed"
Lines = tuple[str, ...]


def refolded(
    given: bytes, source: Translated, blocks: list[list[bytes]], seals: bool, takes_stamps: bool
) -> Folded:
    """Return a program for its blocks as they were written: lists of lines, by block.

    `seals`: a seal that is still open goes behind it; `takes_stamps`: its own stamps are taken out.
    Raises SpellingError where a line cannot be spelled, or would differ between its executions.
    """
    folding = _Refolding(source, blocks)
    folding.spell()
    return folding.joined(given, seals, takes_stamps)


@dataclass
class _Standing:
    """What is in force in blocks, one after the other: steps or positions, and where axes stand."""

    steps: bool = False
    at: At = field(default_factory=dict)

    def take(self, block: BlockWords) -> None:
        """Go on behind a block."""
        self.steps = block.steps(self.steps)
        if block.shifts:
            self.at.clear()
        for letter, value in block.positions:
            before = self.at.get(letter)
            if block.in_machine or (self.steps and before is None):
                self.at.pop(letter, None)
            else:
                self.at[letter] = value + before if self.steps and before is not None else value


class _Refolding:
    """One program whose blocks go back into its lines."""

    def __init__(self, source: Translated, blocks: list[list[bytes]]) -> None:
        self.source, self.translator = source, source.translator
        self.whole = [each.decode("latin-1") for each in source.text.splitlines()]
        written = [[each.decode("latin-1").rstrip() for each in lines] for lines in blocks]
        self.stamps = [each for lines in written for each in lines if is_stamp(each)]
        self.written = [[each for each in lines if not is_stamp(each)] for lines in written]
        self.speller = Spelling(self.translator, source.text.splitlines())
        self.counting = counting_lines(self.translator)
        self.before, self.now = _Standing(), _Standing()
        self.new: dict[int, Lines] = {}

    def spell(self) -> None:
        """Find what each line becomes. Raises SpellingError."""
        slashed = next(iter(self.translator.slashed()), None)
        if slashed is not None:
            raise refusal(self.source, slashed, SLASHED)
        for line, first, stop in runs(self.source):
            text = self._spelled(line, first, stop)
            if self.new.setdefault(line, text) != text:
                raise refusal(self.source, line, DIFFERS)

    def _spelled(self, line: int, first: int, stop: int) -> Lines:
        """Return the lines that stand for an execution of a line."""
        was = [block_of(each) for each in self.whole[first:stop]]
        made = [block_of(each) for lines in self.written[first:stop] for each in lines]
        frame, raw = self.source.frame_of(first), self.source.lines[line]
        found: Lines | None = (raw,)
        if is_stamp(raw) or (was == made and line not in self.counting):
            self._pass(was, made)
        elif not made:
            found = None
        else:
            found = self._changed(line, frame, was, made)
        if found is None:
            raise refusal(self.source, line, UNSAID)
        if found != (raw,) and not self.translator.is_own(line):
            raise refusal(self.source, line, OTHERS)
        return found

    def _pass(self, was: Sequence[BlockWords], made: Sequence[BlockWords]) -> None:
        """Go on behind blocks that stay."""
        for block in was:
            self.before.take(block)
        for block in made:
            self.now.take(block)
        self.speller.met([[each.text.encode("latin-1")] for each in made])

    def _changed(
        self, line: int, frame: object, was: Sequence[BlockWords], made: Sequence[BlockWords]
    ) -> Lines | None:
        """Return the lines for a line that became another; None where it cannot be said.

        The blocks before and behind the one that has changed stay with the line.
        """
        ahead = 0
        while ahead < min(len(was), len(made)) - 1 and was[ahead] == made[ahead]:
            ahead += 1
        behind = 0
        while (
            behind < min(len(was), len(made)) - ahead - 1 and was[-1 - behind] == made[-1 - behind]
        ):
            behind += 1
        if len(was) - ahead - behind != 1 or (behind and len(made) - ahead - behind > 1):
            return self._anew(line, frame, was, made)
        self._pass(was[:ahead], made[:ahead])
        last = len(made) - behind
        found = self._in_place(line, frame, was[ahead], made[ahead:last])
        self._pass(was[ahead + 1 :], made[last:])
        return found

    def _in_place(
        self, line: int, frame: object, was: BlockWords, made: Sequence[BlockWords]
    ) -> Lines | None:
        """Return a line with its words changed where they stand, and the pieces behind it."""
        old = self._inside(frame, was, self.before)
        new = self._inside(frame, made[0], self.now)
        text = None
        if old is not None and new is not None:
            text = self.translator.changed_line(
                line, Change(old, new, self.before.steps, self.now.steps)
            )
        if text is None:
            return None
        self.speller.met([[as_text(new)]])
        return self._pieces(frame, text, made[1:])

    def _anew(
        self, line: int, frame: object, was: Sequence[BlockWords], made: Sequence[BlockWords]
    ) -> Lines | None:
        """Return lines that are said anew, with the head and the comment of a line."""
        for block in was:
            self.before.take(block)
        said = self._said(frame, made)
        text = self.translator.replaced(line, said) if said else None
        return None if text is None else tuple(text.split("\n"))

    def _pieces(self, frame: object, text: str, made: Sequence[BlockWords]) -> Lines | None:
        """Return a line and what is said behind it."""
        if not made:
            return (text,)
        said = self._said(frame, made)
        return (text, *said) if said else None

    def _said(self, frame: object, made: Sequence[BlockWords]) -> list[str]:
        """Return blocks in the words of the language; nothing where one cannot be said."""
        inside = [self._inside(frame, block, self.now) for block in made]
        if any(block is None for block in inside):
            return []
        self.speller.met([[as_text(block)] for block in inside if block is not None])
        return self.speller.said()

    def _inside(self, frame: object, block: BlockWords, standing: _Standing) -> BlockWords | None:
        """Return a block as its words count in a frame, and go on; None where that is not known."""
        steps, before = block.steps(standing.steps), dict(standing.at)
        standing.take(block)
        named = {letter: value for letter, value in block.positions if letter in LINEAR}
        if frame is None or not (named or block.bends) or block.in_machine:
            return block
        inside = self.translator.inside(frame, named, before, steps, block.bends)
        return None if inside is None else block.at(inside)

    # --- the program ---

    def joined(self, given: bytes, seals: bool, takes_stamps: bool) -> Folded:
        """Return the program, and of each of its lines the one that it is for."""
        head = BYTE_ORDER_MARK if given.startswith(BYTE_ORDER_MARK) else b""
        ends = LINE_END.search(given)
        between = ends[0] if ends else b"\n"
        first, last = self.translator.margins()
        stamps = [each for text in self.stamps for each in self._comment(text)]
        seal = self._comment(f"({OPEN_SEAL})") if seals else []
        found, of = [head], list[int]()
        for line, (old, end) in enumerate(_lines_of(given[len(head) :])):
            margin = [*(stamps if line == first else ()), *(seal if line == last else ())]
            texts = [*margin, *self._of_line(line, old, takes_stamps)]
            ended = [*[between] * (len(texts) - 1), end]
            found += [t.encode("latin-1") + e for t, e in zip(texts, ended, strict=False)]
            of += [line] * len(texts)
        if last >= (of[-1] + 1 if of else 0) and seal:
            found += [b"" if found[-1].endswith((b"\n", b"\r")) else between]
            found += [each.encode("latin-1") + between for each in seal]
            of += [of[-1] if of else 0] * len(seal)
        return Folded(b"".join(found), tuple(of), (), ())

    def _of_line(self, line: int, old: str, takes_stamps: bool) -> Lines:
        if takes_stamps and is_stamp(old):
            return ()
        new = self.new.get(line, (old,))
        return (old,) if new == (self.source.lines[line],) else new

    def _comment(self, text: str) -> list[str]:
        speller = self.translator.speller
        return speller("", False).lines(text) if speller is not None else []


def _lines_of(body: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield lines and what ends each."""
    at = 0
    for end in LINE_END.finditer(body):
        yield body[at : end.start()].decode("latin-1"), end[0]
        at = end.end()
    if at < len(body):
        yield body[at:].decode("latin-1"), b""
