"""Templates: how a block of a shape is written again, as a row of fields.

A template is made once for each way in which a shape has to be written (which piece of a split
block, which motion word, whether the feed must be stated ...). Its fields are literals copied from
the source, numbers copied from the source, and numbers to be formatted from columns. Rendering is
then a matter of whole arrays.
"""

from __future__ import annotations

from gcxform.dialect.code_translation import ABORT, EXECUTED, LASTING
from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import LINEAR
from gcxform.emit.codewords import CodeWords
from gcxform.emit.draft import Draft
from gcxform.emit.expressible import (
    CannotSayError,
    code_of,
    comment_for,
    is_foreign,
    lasts_in,
    left_out,
    needs_assignment,
    own_gap,
    program_named,
    unsaid_words,
)
from gcxform.emit.fields import (
    Axis,
    Centre,
    Computed,
    Converted,
    Copied,
    CopiedText,
    CycleWords,
    Feed,
    FeedWord,
    Field,
    Key,
    Literal,
    Preset,
    Role,
    Wait,
)
from gcxform.emit.manner import Manner
from gcxform.modal.meaning.asides import ASIDE
from gcxform.modal.meaning.meaning import DRILL_WORDS, Meaning
from gcxform.modal.meaning.printed import is_output
from gcxform.modal.meaning.sorting import program_number_fits
from gcxform.modal.meaning.too_many import drops_move
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import CODES, Comment, Expression, Item, Mark, Number, Statement, Word

WAITS = "DWELL"
PLANE_AXES = ("XY", "ZX", "YZ")
OFFSETS = {"X": "I", "Y": "J", "Z": "K"}
ANGLE = "R"
"""The word of a turn (G68) whose unit may hang on a point, as that of an axis does."""


class TemplateWriter:
    """Makes one template: of a shape, in one way."""

    def __init__(
        self,
        key: Key,
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
        self.manner = manner
        self.source = manner.source
        self.target = manner.target
        self.axes = axes
        self.unsaid = unsaid_words(meaning, folded_to, manner.saying)
        self.gap = own_gap(shape, gap)
        self.uncompensated = uncompensated
        self.draft = Draft(self.text, self.target, self.gap)
        self.key = key
        self.codes = CodeWords(self.draft, key, self.shape, self.meaning, self.manner)
        self.axes_written = key.as_it_stands or key.tap
        named = [word.address for word in self.shape.block.words]
        self.cycle_words = CycleWords("XYZR" if key.tap else "", named, self.gap)
        self.centre_written = not key.arc
        self.feed_written = False
        self.last: list[Comment] = []  # which end a block in the target

    def write(self) -> tuple[Field, ...]:
        """Return the fields of a piece of the block. Raises CannotSayError."""
        if self.key.role is Role.GONE:
            return self._comments()
        self._check_move_stays()
        at = slot = 0
        whole = self.key.role not in (Role.MIDDLE, Role.LAST)
        gap: bytes | None = None  # what stood before words that are left out
        for item in self.shape.block.items:
            lead = self.text[at : item.start].encode("latin-1") if whole else b""
            if at and not self.draft.fields:
                lead = b""  # what stood before is left out, and the blank after it
            at = item.end
            if self._goes(item) or (self.uncompensated and left_out(item, self.meaning)):
                gap = lead if gap is None else gap
            else:
                self._item(item, lead if gap is None else gap, slot)
                gap = None
            slot += isinstance(item, Word) and item.address not in CODES
        self._rest()
        for comment in self.last if self.key.role not in (Role.MIDDLE, Role.LAST) else ():
            self._comment(comment, self.draft.gap_before(b""))
        if whole and at < len(self.text):
            self.draft.fields.append(Literal(self.text[at:].encode("latin-1")))
        return tuple(self.draft.fields)

    def _check_move_stays(self) -> None:
        """Raise CannotSayError where the target leaves out the move of such a block."""
        name = drops_move(self.meaning, self.target) if self.source is not self.target else ""
        if name and self.target.codes[name].effect is not Effect.BARRIER:
            message = f"{self.target.name} leaves out the move beside {name}"
            raise CannotSayError(0, len(self.text), message, "write two blocks")

    def _comments(self) -> tuple[Field, ...]:
        """Write the sequence number and the comments of a block whose move another makes."""
        slot = 0
        for item in self.shape.block.items:
            if isinstance(item, Comment):
                self._comment(item, self.gap if self.draft.fields else b"")
            elif isinstance(item, Word) and item.address not in CODES:
                if item.address == "N":
                    self._copy(item, b"", slot)
                slot += 1
        return tuple(self.draft.fields)

    def _rest(self) -> None:
        """Write what the piece needs and no item of the block has stood for."""
        self.codes.repair()
        self.draft.fields += self.cycle_words.rest(self.draft.gap_before(b""))
        self._axes(b"")
        self._centre(b"")
        self._feed_at_end()

    # --- one item ---

    def _goes(self, item: Item) -> bool:
        """Whether an item is folded into the words of moves, or done by a pass."""
        if isinstance(item, Comment):  # beside a percent sign another control may refuse it
            return self.meaning.percent and self.source is not self.target
        if not isinstance(item, Word):
            return False
        if item.address == self.meaning.corner:  # its piece is a block of its own
            return self.key.role is not Role.VERBATIM
        return (code_of(item) if item.address in CODES else item.address) in self.unsaid

    def _item(self, item: Item, lead: bytes, slot: int) -> None:
        if isinstance(item, Word):
            self._word(item, lead, slot)
        elif isinstance(item, Comment):
            ends, crosses = self.target.text_rule.parenthesis_ends, self.source is not self.target
            if self.text[item.start] == ";" or (ends and not crosses):
                self._rest()
            if ends and crosses:
                self.last.append(item)
            elif self.key.role not in (Role.MIDDLE, Role.LAST):
                self._comment(item, lead)
        elif isinstance(item, Mark):
            self._mark(item, lead)
        elif self.key.role not in (Role.MIDDLE, Role.LAST):
            self._statement(item, lead)

    def _statement(self, item: Statement, lead: bytes) -> None:
        """Write an assignment; another dialect needs only those that last, as plain numbers."""
        crossing = self.source is not self.target
        if crossing and item.kind != "assignment":
            self.draft.refuse(item, item.kind.replace("_", " "))
        slot = self._text_slot(item)
        if (not crossing or lasts_in(item, self.source, self.target)) and slot >= 0:
            self.draft.literal(lead, "")
            self.draft.fields.append(CopiedText(slot))
        elif not crossing or lasts_in(item, self.source, self.target):
            self.draft.literal(lead, self.text[item.start : item.end])
        elif lost := needs_assignment(item, self.source, self.target, self.manner.saying.drop):
            hint = (
                f"{self.manner.saying.dropping(LASTING)} leaves it out" if "lasts" in lost else ""
            )
            self.draft.refuse(item, lost, hint)

    def _check_same(self, item: Item, name: str) -> None:
        """Raise CannotSayError where the target is another dialect."""
        if self.source is not self.target:
            self.draft.refuse(item, name)

    def _comment(self, item: Comment, lead: bytes) -> None:
        """Write a comment."""
        slot = self._text_slot(item)
        if slot >= 0:
            self.draft.literal(lead, "")
            self.draft.fields.append(CopiedText(slot, self.source is not self.target))
        else:
            self.draft.literal(lead, self._comment_text(item))

    def _text_slot(self, item: Item | Expression) -> int:
        """Return the slot that has the text of an item, or of a value; -1: all lines have this."""
        layout = self.shape.layout
        return -1 if layout is None else layout.slot_of.get((item.start, item.end), -1)

    def _comment_text(self, item: Comment) -> str:
        text = self.text[item.start : item.end]
        executed = self.source.text_rule.executes(text) and self.source is not self.target
        said = self.manner.saying.instead(text)
        if executed and said and not self.target.text_rule.executes(text):
            hint = f"{self.manner.saying.dropping(EXECUTED)} makes it a comment that does nothing"
            message = f"{self.target.name} does not execute this comment"
            self.draft.raise_at(item, message, hint if ABORT not in text.upper() else "")
        return comment_for(self.source, self.target, text)

    def _mark(self, item: Mark, lead: bytes) -> None:
        if item.kind == ASIDE:
            self._rest()
            self.codes.aside(item, lead)
            return
        if item.kind == "block_delete":
            if not self.manner.slashes:
                return
        elif is_output(item):
            self._check_same(item, "a block that sends something out")
        elif item.kind == "block_end":
            self._rest()
            if self.source is not self.target:
                return
        elif is_foreign(item, self.source, self.target):
            return
        if item.kind == "block_delete" or self.key.role not in (Role.MIDDLE, Role.LAST):
            text = self.text[item.start : item.end]
            crosses = self.source is not self.target and item.kind == "program_name"
            self.draft.literal(lead, program_named(text, self.target) if crosses else text)

    # --- words ---

    def _word(self, word: Word, lead: bytes, slot: int) -> None:
        address, verbatim = word.address, self.key.role is Role.VERBATIM
        if self.key.expanded and address in self.meaning.slots and address in DRILL_WORDS + "IJR":
            return
        if address not in "NO" and self.codes.repairs_wait:
            lead = self.codes.repair_before(word, lead)
        if address == "G":
            self.codes.g_word(word, lead)
        elif address == "M":
            self.codes.m_word(word, lead)
        elif (other := self._other_number(address, slot)) is not None:
            self.draft.literal(lead, "")
            self.draft.fields.append(other)
        elif address in self.meaning.slots and not verbatim and self._motion(word, lead):
            return
        elif address == "F" and "F" in self.meaning.slots:
            self._feed(word, lead, slot)
        elif address == "O" and not self.target.program_rule.has_program_number:
            return
        elif self.key.role not in (Role.MIDDLE, Role.LAST):
            self._copy(word, lead, slot)

    def _other_number(self, address: str, slot: int) -> Converted | Preset | Wait | None:
        """Return what is written for a word of a code whose number is another one here."""
        if self.key.converted and address in self.meaning.axes and address in LINEAR:
            return Converted(address, slot)
        if self._waits(address):
            return Wait(slot)
        taken = address in self.source.axes and address not in self.meaning.slots
        return Preset(address, slot) if self.key.preset and taken else None

    def _waits(self, address: str) -> bool:
        """Whether a word is the time of a dwell, and would be another in the target."""
        rules = self.source.point_rule, self.target.point_rule
        if not self.meaning.dwell or rules[0].waits_as(rules[1]):
            return False
        return any(address == a for e in self.meaning.events if e.what == WAITS for a, _ in e.slots)

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
            return word.address == self.source.arc_rule.turns or (spline and word.address in "PQ")
        return True

    def _cycle_word(self, address: str, lead: bytes) -> bool:
        """Write a word of a canned cycle that has moved; return whether it is no more to be copied.

        The one that counts repeats is left out where they are blocks of their own.
        """
        if address in self.cycle_words.waiting:
            self.draft.fields += self.cycle_words.at(address, self.draft.gap_before(lead))
            return True
        if self.key.motion >= 0:  # a tap that was none of a cycle
            return address == "K"
        rule = self.source.cycle_rule
        return self.key.apart and rule is not None and address == rule.repeats

    def _copy(self, word: Word, lead: bytes, slot: int) -> None:
        """Write a word as it stands in the source."""
        if word.address not in self.target.block_rule.words + self.target.axes + "GMO":
            self.draft.raise_at(word, f"{self.target.name} has no word {word.address}")
        if word.address == "O" and not program_number_fits(word, self.target):
            self.draft.refuse(word, "this program number")
        crosses = self.source is not self.target
        if word.address == "T" and self.source.tool_rule.t_changes != (
            self.target.tool_rule.t_changes
        ):
            self.draft.refuse(word, "T as what changes the tool, or does not")
        pointed = word.address in self.source.axes + ANGLE and self.target.point_rule.required
        pointed &= crosses and not self.source.point_rule.required
        if pointed or (isinstance(word.value, Expression) and crosses):
            self.draft.literal(lead, "")
            self.draft.fields.append(Computed(word.address, slot, pointed))
            return
        if isinstance(word.value, Expression) and self._text_slot(word.value) >= 0:
            self.draft.literal(lead, self.draft.said(word.start, word.value.start))
            self.draft.fields.append(CopiedText(slot))
        elif word.address in CODES or not isinstance(word.value, Number):
            self.draft.literal(lead, self.draft.said(word.start, word.end))
        else:
            self.draft.literal(lead, self.draft.said(word.start, word.value.start))
            self.draft.fields.append(Copied(slot))

    # --- what the piece needs ---

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
        if lead and not self.draft.fields:
            self.draft.fields.append(Literal(lead))
            lead = b""
        self._check_axes(named)
        if self.key.homed:
            self.draft.literal(self.draft.gap_before(lead), self.manner.saying.machine)
            lead = b""
        order = [address for address in order if address in self.target.axes]
        for nth, address in enumerate(order):
            gap = lead if lead else (self.gap if nth or self.draft.ends_in_word() else b"")
            self.draft.fields.append(Axis(gap, address))
            lead = b""

    def _check_axes(self, named: list[str]) -> None:
        """Raise CannotSayError for an axis that the target has not."""
        for word in self.shape.block.words:
            if word.address in named and word.address not in self.target.axes:
                self.draft.refuse(word, f"{word.address}: it has no such axis")

    def _centre(self, lead: bytes) -> None:
        """Write the centre words of an arc and its turns."""
        if self.centre_written:
            return
        self._axes(b"")
        self.centre_written = True
        for index, axis in enumerate(PLANE_AXES[self.key.plane]):
            self.draft.fields.append(Centre(self.draft.gap_before(lead), OFFSETS[axis], index))
            lead = b""
        if self.key.turns:
            if not self.target.arc_rule.turns:
                raise CannotSayError(
                    0,
                    len(self.text),
                    f"{self.target.name} has no arcs of more than a turn",
                )
            self.draft.literal(
                self.draft.gap_before(b""), f"{self.target.arc_rule.turns}{self.key.turns + 1}"
            )

    def _feed(self, word: Word, lead: bytes, slot: int) -> None:
        if self.axes_written and not set("IJKR") & set(self.meaning.slots):
            self._centre(b"")
        if self.key.feed is Feed.KEEP:
            self._copy(word, self.draft.gap_before(lead) if self.draft.fields else lead, slot)
        elif self.key.feed > Feed.KEEP:
            self.draft.fields.append(FeedWord(self.draft.gap_before(lead), self.key.feed))
        self.feed_written = True

    def _feed_at_end(self) -> None:
        if self.key.feed > Feed.KEEP and not self.feed_written:
            self.feed_written = True
            self.draft.fields.append(FeedWord(self.draft.gap_before(b""), self.key.feed))
