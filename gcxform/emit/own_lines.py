"""What lines of a program become where positions became others, one execution after another.

A line whose blocks say what they said stands as it did, byte for byte; in another one words are
changed where they stand, as they count in the frame that is in force there. Pieces of a move stand
behind each other, the first with the head and the comment of its line.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import field
from decimal import Decimal

from gcxform.emit.alike_lines import AlikeLines
from gcxform.emit.respelling import Spelling, counting_lines
from gcxform.flow.block_words import (
    DISTANCES,
    LINEAR,
    MOTIONS,
    SIDES,
    At,
    BlockWords,
    Change,
    as_text,
    block_of,
)
from gcxform.flow.translated import Translated
from gcxform.stamps.comment import is_stamp
from gcxform.values import dataclass

NOTHING = frozenset[str]()
GROUPS = {"motion": MOTIONS, "side": SIDES}
Lines = tuple[str, ...]


@dataclass
class _Standing:
    """What is in force in blocks, one after the other: steps or positions, and where axes stand.

    `modes` are the codes of `GROUPS`.
    """

    steps: bool = False
    at: At = field(default_factory=dict)
    modes: dict[str, str] = field(default_factory=dict)

    def behind(self, blocks: Sequence[BlockWords]) -> _Standing:
        """Return what is in force behind some blocks."""
        found = _Standing(self.steps, {**self.at}, {**self.modes})
        for block in blocks:
            found.take(block)
        return found

    def say(self, block: BlockWords) -> None:
        """Take the modes of a block."""
        for name, codes in GROUPS.items():
            said = [code for code in block.codes if code in codes]
            self.modes |= {name: said[-1]} if said else {}

    def take(self, block: BlockWords) -> None:
        """Go on behind a block."""
        self.steps = block.steps(self.steps)
        self.say(block)
        if block.shifts:
            self.at.clear()
        for letter, value in block.positions if block.moves else ():
            before = self.at.get(letter)
            if block.in_machine or (self.steps and before is None):
                self.at.pop(letter, None)
            else:
                self.at[letter] = value + before if self.steps and before is not None else value


class OwnLines:
    """Says what each execution of a line becomes; it has to be asked in their order.

    `whole` are the blocks as they were read, `written` the lines that each of them became. `owed`
    are codes that a line has to say where its block does, also where it had not said them: what
    was said before, in the place of others, may have left another one in force.
    """

    def __init__(
        self, source: Translated, whole: Sequence[str], written: Sequence[Sequence[str]]
    ) -> None:
        self.source, self.translator = source, source.translator
        self.whole, self.written = whole, written
        self.speller = Spelling(self.translator, source.text.splitlines(), asides=True)
        self.counting = counting_lines(self.translator) | {*self.translator.hanging()}
        self.before, self.now = _Standing(), _Standing()
        self.alike = AlikeLines(self.translator.worded())
        self.frames: dict[int, tuple[object, bool]] = {}
        self.owed = NOTHING

    def spelled(self, line: int, first: int, stop: int) -> Lines | None:
        """Return the lines for an execution of a line, with the blocks from `first` up to `stop`.

        None where it cannot be said in its place.
        """
        frame = self.source.frame_at(int(self.source.visits[first]))
        raw = self.source.lines[line]
        alone = stop - first == 1 and len(self.written[first]) == 1
        texts = raw, self.whole[first], self.written[first][0] if alone else ""
        says = bool(self.owed) and "G" in texts[2]
        quick = alone and not says and self._counts_alike(line, frame)
        if quick and (known := self._known(*texts)) is not None:
            return (known,)
        found = self._worded(line, first, stop, frame)
        if quick and found is not None and len(found) == 1:
            self.alike.learn(*texts, found[0])
        return found

    def _counts_alike(self, line: int, frame: object) -> bool:
        """Whether words of a line are those of its block, and lead to places."""
        if self.before.steps or self.now.steps or line in self.counting:
            return False
        if id(frame) not in self.frames:
            named = {axis: Decimal(k) for k, axis in enumerate("XYZ", 1)}  # 0 is no other mirrored
            inside = self.translator.inside(frame, named, {}, False, False)
            self.frames[id(frame)] = frame, frame is None or inside == named
        return self.frames[id(frame)][1]

    def _known(self, raw: str, was: str, now: str) -> str | None:
        """Return a line that is like one before; None for another."""
        if is_stamp(raw):
            return None
        found = raw if was == now and self.alike.passes(was) else None
        found = self.alike.spelled(raw, was, now) if found is None else found
        if found is not None:
            self.speller.met([[now.encode("latin-1")]])
            if "G" in now:
                self.now.say(block_of(now))
        return found

    def _worded(self, line: int, first: int, stop: int, frame: object) -> Lines | None:
        """Return the lines for an execution of a line, word by word."""
        self.alike.settle(self.before.at, self.now.at)
        was, made = self._blocks(first, stop)
        raw = self.source.lines[line]
        due = self._settle(raw, made)
        if is_stamp(raw) or (was == made and line not in self.counting and not due):
            self._pass(was, made)
            return (raw,)
        if not made:
            return None
        beside = self._differs(first - 1) or self._differs(stop)
        return self._changed(line, frame, was, made, due, beside)

    def _differs(self, block: int) -> bool:
        """Whether a block became another."""
        there = 0 <= block < len(self.whole)
        return there and [block_of(each) for each in self.written[block]] != [
            block_of(self.whole[block])
        ]

    def _settle(self, raw: str, made: Sequence[BlockWords]) -> frozenset[str]:
        """Return the codes of blocks that are owed, and which the line does not say.

        One that it says ends what is owed; another may be there for this block alone.
        """
        owed = self.owed & {code for block in made for code in block.codes}
        said = {code for code in owed if re.search(rf"(?<!\w)G0*{code[1:]}(?![0-9.])", raw, re.I)}
        for group in (DISTANCES, MOTIONS):
            if said & group:
                self.owed -= group
        return owed - said

    def written_out(self, line: int, first: int, stop: int, unit: frozenset[int]) -> Lines | None:
        """Return an execution of a line as lines by themselves; None where they cannot be said.

        `unit` are all lines that are written out: calls that one before them said stay with that.
        """
        if self.translator.stands_alone(line):
            return self.spelled(line, first, stop)
        frame = self.source.frame_at(int(self.source.visits[first]))
        self.alike.settle(self.before.at, self.now.at)
        was, made = self._blocks(first, stop)
        for block in was:
            self.before.take(block)
        calls = [k for k, block in enumerate(made) if self.translator.calls_behind(unit, block)]
        said = self._said(frame, made, frozenset(calls))
        self.owed = self.translator.lasting
        return None if said is None else tuple(said)

    def _blocks(self, first: int, stop: int) -> tuple[list[BlockWords], list[BlockWords]]:
        was = [block_of(each) for each in self.whole[first:stop]]
        made = [block_of(each) for lines in self.written[first:stop] for each in lines]
        return was, made

    def _pass(self, was: Sequence[BlockWords], made: Sequence[BlockWords]) -> None:
        """Go on behind blocks that stay."""
        for block in was:
            self.before.take(block)
        for block in made:
            self.now.take(block)
        self.speller.met([[each.text.encode("latin-1")] for each in made])

    def _changed(
        self,
        line: int,
        frame: object,
        was: Sequence[BlockWords],
        made: Sequence[BlockWords],
        due: frozenset[str],
        beside: bool,
    ) -> Lines | None:
        """Return the lines for a line that became another; None where it cannot be said.

        It has to say what is `due`. The blocks before and behind the one that has changed stay
        with the line. Words of a line are those of the first that leads somewhere.
        """
        leads = next((k for k, block in enumerate(was) if block.leads), len(was) - 1)
        ahead = 0
        while ahead < min(len(was), len(made)) - 1 and was[ahead] == made[ahead]:
            if was == made and ahead == leads:
                break
            ahead += 1
        behind = 0
        while (
            behind < min(len(was), len(made)) - ahead - 1 and was[-1 - behind] == made[-1 - behind]
        ):
            behind += 1
        if not due <= {*made[ahead].codes}:
            return None
        several = len(was) - ahead - behind != 1 or (behind and len(made) - ahead - behind > 1)
        if several or ahead > leads:
            return self._anew(line, frame, was, made)
        change = self._change(frame, was[: ahead + 1], made[: ahead + 1], due, beside)
        text = None if change is None else self.translator.changed_line(line, change)
        if change is None or text is None:
            return self._anew(line, frame, was, made)
        self._pass(was[:ahead], made[:ahead])
        self.before.take(was[ahead])
        self.now.take(made[ahead])
        self.speller.met([[as_text(change.now)]])
        last = len(made) - behind
        found = self._pieces(frame, text, made[ahead + 1 : last])
        self._pass(was[ahead + 1 :], made[last:])
        return found

    def _change(
        self,
        frame: object,
        was: Sequence[BlockWords],
        made: Sequence[BlockWords],
        due: frozenset[str],
        beside: bool,
    ) -> Change | None:
        """Return what the last of some blocks became, as it counts in a frame; nothing goes on."""
        before, now = self.before.behind(was[:-1]), self.now.behind(made[:-1])
        stood, stands = {**before.at}, {**now.at}
        old, new = self._inside(frame, was[-1], before), self._inside(frame, made[-1], now)
        if old is None or new is None:
            return None
        return Change(old, new, before.steps, now.steps, due, stood, stands, now.modes, beside)

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
        first = text.split("\n")
        if not made:
            return tuple(first)
        if self.now.steps:  # by IC alone, perhaps
            made = [made[0].saying("G91"), *made[1:]]
            self.owed |= DISTANCES
        said = self._said(frame, made)
        return (*first, *said) if said else None

    def _said(
        self, frame: object, made: Sequence[BlockWords], left: frozenset[int] = frozenset()
    ) -> list[str] | None:
        """Return blocks in the words of the language; None where one cannot be said.

        Those that are `left`, by number, another line has said already.
        """
        found = [self._inside(frame, block, self.now) for block in made]
        inside = [block for k, block in enumerate(found) if k not in left]
        if any(block is None for block in inside):
            return None
        self.speller.met([[block.text.encode("latin-1")] for block in inside if block is not None])
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
