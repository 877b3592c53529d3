"""Templates: how a block of a shape is written again, as a row of fields.

A template is made once for each way in which a shape has to be written (which piece of a split
block, which motion word, whether the feed must be stated ...). Its fields are literals copied from
the source, numbers copied from the source, and numbers to be formatted from columns. Rendering is
then a matter of whole arrays.
"""

from __future__ import annotations

from typing import NoReturn

from gcxform.emit.fields import (
    Axis,
    Centre,
    Computed,
    Copied,
    CycleWords,
    Feed,
    FeedWord,
    Field,
    Key,
    Literal,
    Role,
)
from gcxform.emit.manner import Manner
from gcxform.emit.saying import (
    STATED,
    CannotSayError,
    code_of,
    comment_in,
    folded_words,
    is_foreign,
    left_out,
    like,
    other_in,
    own_gap,
    same_m,
)
from gcxform.modal.meaning import DRILL_WORDS, Meaning
from gcxform.modal.sorting import only_for_cycles, program_number_fits
from gcxform.syntax.shapes import CODES, Shape
from gcxform.syntax.tree import Comment, Expression, Item, Mark, Number, Statement, Word

PLANE_AXES = ("XY", "ZX", "YZ")
OFFSETS = {"X": "I", "Y": "J", "Z": "K"}


class TemplateWriter:
    """Makes the templates of one shape."""

    def __init__(
        self,
        shape: Shape,
        meaning: Meaning,
        manner: Manner,
        axes: str,
        gap: bytes,
        folded_to: str = "",
        uncompensated: bool = False,
    ) -> None:
        self.shape = shape
        self.text = shape.block.text
        self.meaning = meaning
        self.source = manner.source
        self.target = manner.target
        self.axes = axes
        self.folded = folded_words(meaning, folded_to) if folded_to else frozenset()
        self.gap = own_gap(shape, gap)
        self.uncompensated = uncompensated

    def write(self, key: Key) -> tuple[Field, ...]:
        """Return the fields of a piece of the block. Raises CannotSayError."""
        self.fields: list[Field] = []
        self.key = key
        self.as_it_stands = key.role in (Role.NONE, Role.VERBATIM)
        self.axes_written = self.as_it_stands or key.tap
        named = [word.address for word in self.shape.block.words]
        self.cycle_words = CycleWords("XYZR" if key.tap else "", named, self.gap)
        self.centre_written = not key.arc
        self.stated: set[str] = set()
        if key.role is Role.GONE:
            return self._comments()
        at = slot = 0
        whole = key.role not in (Role.MIDDLE, Role.LAST)
        self._repairs_wait = True
        gap: bytes | None = None  # what stood before words that are left out
        for item in self.shape.block.items:
            lead = self.text[at : item.start].encode("latin-1") if whole else b""
            if at and not self.fields:
                lead = b""  # what stood before is left out, and the blank after it
            at = item.end
            if self._goes(item) or (self.uncompensated and left_out(item, self.meaning)):
                gap = lead if gap is None else gap
            else:
                self._item(item, lead if gap is None else gap, slot)
                gap = None
            slot += isinstance(item, Word) and item.address not in CODES
        self._rest()
        if whole and at < len(self.text):
            self.fields.append(Literal(self.text[at:].encode("latin-1")))
        return tuple(self.fields)

    def _comments(self) -> tuple[Field, ...]:
        """Write the sequence number and the comments of a block whose move another makes."""
        slot = 0
        for item in self.shape.block.items:
            if isinstance(item, Comment):
                self._literal(self.gap if self.fields else b"", self._comment(item))
            elif isinstance(item, Word) and item.address not in CODES:
                if item.address == "N":
                    self._copy(item, b"", slot)
                slot += isinstance(item.value, Number)
        return tuple(self.fields)

    def _rest(self) -> None:
        """Write what the piece needs and no item of the block has stood for."""
        self._repair()
        self.fields += self.cycle_words.rest(self._gap(b""))
        self._axes(b"")
        self._centre(b"")
        self._feed_at_end()

    # --- one item ---

    def _goes(self, item: Item) -> bool:
        """Whether an item is folded into the words of moves."""
        if not isinstance(item, Word):
            return False
        return (code_of(item) if item.address in CODES else item.address) in self.folded

    def _item(self, item: Item, lead: bytes, slot: int) -> None:
        if isinstance(item, Word):
            self._word(item, lead, slot)
        elif isinstance(item, Comment):
            if self.text[item.start] == ";":
                self._rest()
            if self.key.role not in (Role.MIDDLE, Role.LAST):
                self._literal(lead, self._comment(item))
        elif isinstance(item, Mark):
            self._mark(item, lead)
        elif self.key.role not in (Role.MIDDLE, Role.LAST):
            self._statement(item, lead)

    def _statement(self, item: Statement, lead: bytes) -> None:
        """Write an assignment; another dialect needs none, for its blocks hold plain numbers."""
        if self.source is not self.target and is_foreign(item, self.target):
            return
        self._check_same(item, f"{item.kind.replace('_', ' ')}")
        self._literal(lead, self.text[item.start : item.end])

    def _literal(self, lead: bytes, text: str) -> None:
        if lead or text:
            self.fields.append(Literal(lead + text.encode("latin-1")))

    def _check_same(self, item: Item, name: str) -> None:
        if self.source is not self.target:
            raise CannotSayError(
                item.start, item.end - item.start, f"{self.target.name} cannot say {name}"
            )

    def _comment(self, item: Comment) -> str:
        text = self.text[item.start : item.end]
        executed = self.source.executes(text)
        if executed and self.source is not self.target and not self.target.executes(text):
            message = f"{self.target.name} does not execute this comment"
            raise CannotSayError(item.start, item.end - item.start, message)
        if not executed and self.target.executes(text):
            text = f"{text[0]}-{text[1:]}"
        return comment_in(self.target, text)

    def _mark(self, item: Mark, lead: bytes) -> None:
        if item.kind == "block_delete":
            if self.source.block_delete != self.target.block_delete:
                self._check_same(item, "a block with a slash in the same way")
        elif self.key.role in (Role.MIDDLE, Role.LAST) or is_foreign(item, self.target):
            return
        self._literal(lead, self.text[item.start : item.end])

    # --- words ---

    def _word(self, word: Word, lead: bytes, slot: int) -> None:
        address, verbatim = word.address, self.key.role is Role.VERBATIM
        if self.key.expanded and address in self.meaning.slots and address in DRILL_WORDS + "IJR":
            return
        if address not in "NO" and self._repairs_wait:
            lead = self._repair_before(word, lead)
        if address == "G":
            self._g_word(word, lead)
        elif address == "M":
            self._m_word(word, lead)
        elif address in self.meaning.slots and not verbatim and self._motion(word, lead):
            return
        elif address == "F" and "F" in self.meaning.slots:
            self._feed(word, lead, slot)
        elif address == "O" and not self.target.has_program_number:
            return
        elif self.key.role not in (Role.MIDDLE, Role.LAST):
            self._copy(word, lead, slot)

    def _motion(self, word: Word, lead: bytes) -> bool:
        """Write what a word of the motion stands for; return whether it is one."""
        if self.key.tap:
            return self._cycle_word(word.address, lead)
        if word.address in self.axes:
            self._axes(lead)
        elif self.key.thread:
            return False
        elif word.address in "IJKR":
            self._centre(lead)
        else:
            spline = self.meaning.groups.get("motion") in ("G5", "G5.1")
            return word.address == self.source.turns_address or (spline and word.address in "PQ")
        return True

    def _cycle_word(self, address: str, lead: bytes) -> bool:
        """Write a word of a canned cycle that has moved; return whether it is no more to be copied.

        The one that counts repeats is left out where they are blocks of their own.
        """
        if address in self.cycle_words.waiting:
            self.fields += self.cycle_words.at(address, self._gap(lead))
            return True
        rule = self.source.cycle_rule
        return self.key.apart and rule is not None and address == rule.repeats

    def _said(self, start: int, end: int) -> str:
        """Return a piece of a word, in capitals where the target knows nothing else."""
        text = self.text[start:end]
        return text if self.target.lower_case else text.upper()

    def _copy(self, word: Word, lead: bytes, slot: int) -> None:
        """Write a word as it stands in the source."""
        if word.address not in self.target.words + self.target.axes + "GMO":
            raise CannotSayError(
                word.start, word.end - word.start, f"{self.target.name} has no word {word.address}"
            )
        if word.address == "O" and not program_number_fits(word, self.target):
            self._refuse(word, "this program number")
        if isinstance(word.value, Expression) and self.source is not self.target:
            self._literal(lead, "")
            self.fields.append(Computed(word.address, slot))
            return
        if word.address in CODES or not isinstance(word.value, Number):
            self._literal(lead, self._said(word.start, word.end))
            return
        self._literal(lead, self._said(word.start, word.value.start))
        self.fields.append(Copied(slot))

    def _g_word(self, word: Word, lead: bytes) -> None:
        assert isinstance(word.value, Number)
        name = f"G{round(word.value.value, 6):g}"
        code = self.source.codes.get(name)
        group = code.group if code is not None else ""
        text = self._said(word.start, word.end)
        if self.key.role in (Role.MIDDLE, Role.LAST):
            lead = self._gap(lead)
        if group == "cycle" and self.key.expanded:
            return
        if group in self.stated:
            return  # of several codes of a group one has been written
        if group in STATED and self._states(word, name, group, lead):
            return
        after = code is not None and code.after
        if self.key.role in ((Role.FIRST, Role.MIDDLE) if after else (Role.MIDDLE, Role.LAST)):
            return
        if only_for_cycles(name, self.source, self.target):
            return
        if self.source is not self.target and code is not None:
            what = other_in(self.source, self.target, name, code, self.meaning.dwell)
            if what:
                self._refuse(word, what)
        self._literal(lead, text)

    def _states(self, word: Word, name: str, group: str, lead: bytes) -> bool:
        """Write the code that has to be stated for a group; return whether this settles it."""
        wanted = self._wanted(group)
        self.stated.add(group)
        if wanted is not None:
            if not self._goes_without_saying(word, wanted):
                text = self._said(word.start, word.end)
                self._literal(lead, text if wanted == name else like(text, wanted))
            return True
        if group != "motion":
            return False
        # A spline that goes nowhere is left out, and its words are.
        left_out = name in ("G5", "G5.1") and self.key.role is Role.NONE
        stays = self.as_it_stands or self.key.thread or self.key.tap
        return left_out or not stays or self.key.silent

    def _refuse(self, word: Word, what: str) -> NoReturn:
        raise CannotSayError(
            word.start, word.end - word.start, f"{self.target.name} cannot say {what}"
        )

    def _m_word(self, word: Word, lead: bytes) -> None:
        assert isinstance(word.value, Number)
        number = int(word.value.value)
        code = self.source.m_codes.get(number, self.source.unknown_m)
        if self.source is not self.target:
            other = self.target.m_codes.get(number, self.target.unknown_m)
            words = {word.address for word in self.shape.block.words}
            if other is None or code is None or not same_m(code, other, words):
                self._refuse(word, f"M{number}")
            if code.after != other.after and self.key.role is not Role.NONE:
                self._refuse(word, f"M{number}")
        after = code is not None and code.after
        whole = self.key.role is Role.ONLY or self.as_it_stands
        if whole or self.key.role is (Role.LAST if after else Role.FIRST):
            self._literal(self._gap(lead), self._said(word.start, word.end))

    # --- what has to be stated ---

    def _wanted(self, group: str) -> str | None:
        """Return the code that has to be stated for a group, if any."""
        value = getattr(self.key, STATED[group][0])
        return None if value < 0 else STATED[group][1][value]

    def _goes_without_saying(self, word: Word, code: str) -> bool:
        """Whether the target has no such code because it knows nothing else."""
        if code in self.target.codes:
            return False
        if code != "G91.1":
            self._refuse(word, code)
        return True

    def _repair_before(self, word: Word, lead: bytes) -> bytes:
        """State before the first word what the block leaves to modes that no longer hold."""
        self._repairs_wait = False
        explicit = {code for code in self.meaning.groups if code in STATED}
        texts = []
        for group in STATED:
            wanted = self._wanted(group)
            if wanted is not None and group not in explicit:
                if not self._goes_without_saying(word, wanted):
                    texts.append(wanted)
                self.stated.add(group)
        if not texts:
            return lead
        self._literal(lead, self.gap.decode().join(texts))
        return self.gap

    def _repair(self) -> None:
        """State what is still to be stated, in a block that had no word to put it before."""
        if self._repairs_wait and self.key.role is not Role.NONE:
            self._repairs_wait = False
            texts = [w for g in STATED if (w := self._wanted(g)) is not None]
            self._literal(b"", self.gap.decode().join(texts))

    def _axes(self, lead: bytes) -> None:
        """Write the axis words of the block, in its own order, and those it does not name."""
        if self.axes_written:
            return
        self.axes_written = True
        named = [w.address for w in self.shape.block.words if w.address in self.meaning.axes]
        if named == sorted(named, key=self.axes.index):
            order = list(self.axes)
        else:
            order = named + [a for a in self.axes if a not in named]
        if lead and not self.fields:
            self.fields.append(Literal(lead))
            lead = b""
        self._check_axes(named)
        order = [address for address in order if address in self.target.axes]
        for nth, address in enumerate(order):
            gap = lead if lead else (self.gap if nth or self._ends_in_word() else b"")
            self.fields.append(Axis(gap, address))
            lead = b""

    def _check_axes(self, named: list[str]) -> None:
        """Raise CannotSayError for an axis that the target has not."""
        for word in self.shape.block.words:
            if word.address in named and word.address not in self.target.axes:
                self._refuse(word, f"{word.address}: it has no such axis")

    def _gap(self, lead: bytes) -> bytes:
        return lead or (self.gap if self.fields else b"")

    def _ends_in_word(self) -> bool:
        """Whether something other than blanks has been written."""
        return any(not isinstance(f, Literal) or f.text.strip() for f in self.fields)

    def _centre(self, lead: bytes) -> None:
        """Write the centre words of an arc and its turns."""
        if self.centre_written:
            return
        self._axes(b"")
        self.centre_written = True
        for index, axis in enumerate(PLANE_AXES[self.key.plane]):
            self.fields.append(Centre(self._gap(lead), OFFSETS[axis], index))
            lead = b""
        if self.key.turns:
            if not self.target.turns_address:
                raise CannotSayError(
                    0,
                    len(self.text),
                    f"{self.target.name} has no arcs of more than a turn",
                )
            self._literal(self._gap(b""), f"{self.target.turns_address}{self.key.turns + 1}")

    def _feed(self, word: Word, lead: bytes, slot: int) -> None:
        if self.axes_written and not set("IJKR") & set(self.meaning.slots):
            self._centre(b"")
        if self.key.feed is Feed.KEEP:
            self._copy(word, self._gap(lead) if self.fields else lead, slot)
        elif self.key.feed is Feed.WRITE:
            self.fields.append(FeedWord(self._gap(lead)))
        self.stated.add("feed")

    def _feed_at_end(self) -> None:
        if self.key.feed is Feed.WRITE and "feed" not in self.stated:
            self.stated.add("feed")
            self.fields.append(FeedWord(self._gap(b"")))
