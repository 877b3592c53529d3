"""Pieces to text: pieces that are written in the same way share a template, rendered as a whole.

Which pieces there are is settled before (`gcxform/emit/pieces.py`), and what each has to say
(`gcxform/emit/needed_modes.py`). Here they are sorted by the way in which they are written, each
way gets its template, and what a number of a template is worth is looked up in columns. What cannot
be written as a number, or makes a block too long, is refused.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import INCH
from gcxform.emit.expressible import (
    CannotSayError,
    comment_for,
    dwell_word,
    event_text,
    gaps_between,
    slash_of,
)
from gcxform.emit.fields import (
    Axis,
    Centre,
    Computed,
    Converted,
    Copied,
    CopiedText,
    CycleWord,
    Feed,
    Field,
    Key,
    Literal,
    Preset,
    Role,
    Wait,
)
from gcxform.emit.manner import Task
from gcxform.emit.needed_modes import Stated
from gcxform.emit.numbers import MOST_DECIMALS, decimals_for, decimals_of, quantise
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions
from gcxform.emit.presets import Presets
from gcxform.emit.render import Renderer, groups_of
from gcxform.emit.tapping import Taps
from gcxform.emit.templates import TemplateWriter
from gcxform.modal.control_limits import without_blanks
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.scan import Window
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.path import Given, Kind
from gcxform.values import dataclass

FEED_SLIP = 1.5e-4  # relative; a feed that would be written farther off is refused


@dataclass(slots=True)
class Style:
    """What a program shows of how it is written; empty and None until a line shows it."""

    line_end: bytes = b""
    gap: bytes | None = None

    def look_at(self, window: Window, table: MeaningTable) -> None:
        """Take line end and gap between words from the first lines that show them."""
        if not self.line_end and len(window):
            self.line_end = window.text[int(window.end[0]) : int(window.next[0])] or b"\n"
        if self.gap is None:
            met = int(window.shape.max(initial=0)) + 1  # shapes beyond are read ahead
            for shape in table.shapes.shapes[:met]:
                gaps = list(gaps_between(shape.block.text, list(shape.block.words)))
                if gaps:
                    self.gap = b" " if any(gaps) else b""
                    break


@dataclass(frozen=True, slots=True)
class Writing:
    """The columns that the text of a window is made of.

    `centre` (rows, 2): centre words, in last decimals.
    """

    task: Task
    style: Style
    pieces: Pieces
    stated: Stated
    positions: Positions
    taps: Taps
    centre: Floats
    presets: Presets

    def text(self, chosen: Ints) -> tuple[bytes, Ints]:
        """Return the text of pieces, and the length of each. Raises InputError."""
        renderer = Renderer(self.task)
        self._render(chosen, renderer)
        text, lengths = renderer.text(len(chosen))
        self._check_lengths(text, lengths, chosen)
        return text, lengths

    def _turns(self) -> Ints:
        """Return the full turns of each row beyond its arc."""
        return np.maximum(np.ceil(self.task.path.sweep / TURN - 1 - 1e-9), 0).astype(np.int64)

    def _ways(self, chosen: Ints) -> Ints:
        """Return, per piece, one number for the way in which it has to be written."""
        pieces, stated = self.pieces, self.stated
        arc = pieces.of_rows((stated.kind >= Kind.ARC_CW).astype(np.int64), 0)
        inch = self.task.path.blocks.inch[pieces.line]
        way = self.task.shape[pieces.line].astype(np.int64)
        parts: list[tuple[NDArray[Any], int]] = [
            (pieces.role, len(Role)),
            (pieces.event + 1, len(pieces.events) + 1),
            (pieces.expanded_line[pieces.line], 2),
            (stated.motion.code + 1, 128),
            (stated.inch + 1, 3),
            (stated.incremental + 1, 3),
            (stated.absolute_centre + 1, 3),
            (stated.feed_mode + 1, 128),
            (stated.motion.silent, 2),
            (stated.motion.thread, 2),
            (pieces.tap, 2),
            (pieces.apart, 2),
            (pieces.converted, 2),
            (pieces.homed, 2),
            (self.presets.lines[pieces.line], 2),
            (stated.feed.word, len(Feed)),
            (inch, 2),
        ]
        if arc.any():
            plane = pieces.of_rows(self.task.path.plane.astype(np.int64), 0)
            turns = pieces.of_rows(self._turns(), 0)
            parts += [(arc, 2), (plane * arc, 3), (turns * arc, int(turns.max()) + 1)]
        for part, size in parts:
            if part.any():
                way = way * size + part
        return np.asarray(way[chosen])

    def _render(self, chosen: Ints, renderer: Renderer) -> None:
        """Render the pieces, one template after another."""
        for places in groups_of(self._ways(chosen)):
            members = chosen[places]
            renderer.begin(self.pieces.line[members])
            for field in self._template(int(members[0])):
                self._field(field, members, renderer)
            lines = self.pieces.line[members]
            renderer.line_ends(lines, self.pieces.ends[members], self.style.line_end)
            renderer.finish(places)

    def _template(self, piece: int) -> tuple[Field, ...]:
        """Return the fields of a piece, which are those of all pieces written in its way."""
        pieces, stated = self.pieces, self.stated
        if pieces.event[piece] >= 0:
            return self._event_text(piece)
        line = int(pieces.line[piece])
        shape = int(self.task.shape[line])
        row = int(pieces.row[piece])
        arc = bool(pieces.has_row[piece]) and int(stated.kind[row]) >= Kind.ARC_CW
        arc = arc and not pieces.special[piece]
        key = Key(
            Role(int(pieces.role[piece])),
            int(stated.motion.code[piece]),
            int(stated.inch[piece]),
            int(stated.incremental[piece]),
            int(stated.absolute_centre[piece]),
            int(stated.feed_mode[piece]),
            bool(stated.motion.silent[piece]),
            Feed(int(stated.feed.word[piece])),
            bool(pieces.expanded_line[line]),
            bool(stated.motion.thread[piece]),
            bool(pieces.tap[piece]),
            bool(pieces.apart[piece]),
            bool(pieces.converted[piece]),
            bool(self.presets.lines[line]),
            bool(pieces.homed[piece]),
            arc,
            int(self.task.path.plane[row]) if arc else 0,
            int(self._turns()[row]) if arc else 0,
        )
        writer = TemplateWriter(
            key,
            self.task.table.shapes.shapes[shape],
            self.task.table.meanings[shape],
            self.task.manner,
            self.task.path.axes,
            b" " if self.style.gap is None else self.style.gap,
            self.task.path.frames[0].work if self.task.path.folded else "",
            self.task.path.blocks.uncompensated,
        )
        try:
            return writer.write()
        except CannotSayError as error:
            where = self.task.location(line, error.column, error.width)
            raise InputError.one("GX501", error.message, where, error.hint) from None

    def _event_text(self, piece: int) -> tuple[Field, ...]:
        """Return the block of what a canned cycle does between its moves, or one that is given."""
        event, target = self.pieces.events[int(self.pieces.event[piece])], self.task.manner.target
        line = int(self.pieces.line[piece])
        slash = slash_of(
            self.task.table.shapes.shapes[int(self.task.shape[line])], self.task.manner
        )
        if isinstance(event, Given):
            return (Literal(slash + event.text.encode()),)
        text = event_text(event, target, self.style.gap or b"")
        if text is None:
            where = self.task.location(line)
            message = f"{target.name} cannot say the {event.what} of this cycle"
            raise InputError.one("GX501", message, where)
        return (Literal(slash + text),)

    def _field(self, field: Field, members: Ints, renderer: Renderer) -> None:
        """Render one field of the pieces of a template."""
        manner, rows = self.task.manner, self.pieces.row[members]
        inch = bool(self.task.path.blocks.inch[self.pieces.line[members[0]]])
        if isinstance(field, Literal):
            renderer.literal(field.text)
        elif isinstance(field, Copied):
            renderer.copied(self.pieces.line[members], field.slot)
        elif isinstance(field, CopiedText):
            self._copied_text(field, self.pieces.line[members], renderer)
        elif isinstance(field, Computed | Wait):
            self._computed(field, self.pieces.line[members], renderer)
        elif isinstance(field, Converted | Preset):
            self._other_number(field, self.pieces.line[members], inch, renderer)
        elif isinstance(field, Axis):
            column = self.task.path.axes.index(field.address)
            present = self.positions.write[rows, column]
            if present.any():
                whole = self.positions.words_of(column, rows)
                self._check_known(field.address, whole, present, rows)
                decimals = manner.decimals_of(field.address, inch)
                renderer.number(field.gap, field.address, whole, decimals, present)
        elif isinstance(field, CycleWord):
            whole = self.taps.words[field.address][rows]
            decimals = manner.decimals_of(field.address, inch)
            everywhere = np.ones(len(rows), np.bool_)
            renderer.number(field.gap, field.address, whole, decimals, everywhere)
        elif isinstance(field, Centre):
            whole = self.centre[rows, field.index]
            decimals = manner.decimals_of(field.address, inch)
            everywhere = np.ones(len(rows), np.bool_)
            renderer.number(field.gap, field.address, whole, decimals, everywhere)
        else:
            feed, address = self.stated.feed.value[members], field.address
            decimals = manner.decimals_of(address, inch)
            decimals = decimals_for(feed, decimals)
            whole = quantise(feed, decimals)
            self._check_feed(feed, whole / 10.0**decimals, members)
            everywhere = np.ones(len(rows), np.bool_)
            point = manner.target.point_rule.required
            renderer.number(field.gap, address, whole, decimals, everywhere, point)

    def _copied_text(self, field: CopiedText, lines: Ints, renderer: Renderer) -> None:
        """Write texts of the source; comments as those of the target."""
        if not field.comment:
            renderer.copied_text(lines, field.slot)
            return
        source, target = self.task.manner.source, self.task.manner.target
        texts = [comment_for(source, target, text) for text in renderer.texts(lines, field.slot)]
        renderer.said([text.encode("latin-1") for text in texts])

    def _wait(self, lines: Ints, renderer: Renderer) -> None:
        """Write for how long a dwell waits, by a word of the target."""
        first, target = self.task.path.blocks.first, self.task.manner.target
        times = {
            event.line - first: dict(event.values).get("seconds", np.nan)
            for event in self.task.read.path.events
            if event.what.endswith("DWELL") and not event.within
        }
        words = [dwell_word(seconds, target) for seconds in map(times.__getitem__, lines.tolist())]
        if "" in words:
            message = f"{target.name} has no dwell that lasts as long"
            raise InputError.one("GX501", message, self.task.location(int(lines[words.index("")])))
        renderer.said([word.encode() for word in words])

    def _computed(self, field: Computed | Wait, lines: Ints, renderer: Renderer) -> None:
        """Write what expressions are worth as plain numbers, to the last bit; and times."""
        if isinstance(field, Wait):
            self._wait(lines, renderer)
            return
        value = self.task.read.value[self.task.window.first_number[lines] + field.slot]
        decimals = decimals_of(value)
        whole = quantise(value, decimals)
        inexact = whole / 10.0**decimals != value
        if inexact.any():
            where = self.task.location(int(lines[np.argmax(inexact)]))
            message = f"{field.address} is computed, and has more decimals than can be written"
            raise InputError.one("GX501", message, where)
        everywhere = np.ones(len(lines), np.bool_)
        renderer.number(b"", field.address, whole, decimals, everywhere, field.point)

    def _other_number(
        self, field: Converted | Preset, lines: Ints, inch: bool, renderer: Renderer
    ) -> None:
        """Write lengths in the unit that is in force now, `inch` or millimetres, and zeros."""
        numbers = self.task.window.first_number[lines] + field.slot
        if isinstance(field, Converted):
            value = self.task.read.value[numbers]
            value = value / INCH if inch else value * INCH
        else:
            value = self.presets.value[numbers]
        decimals = self.task.manner.decimals_of(field.address, inch)
        everywhere = np.ones(len(lines), np.bool_)
        renderer.number(b"", field.address, quantise(value, decimals), decimals, everywhere)

    # --- what is refused ---

    def _check_known(self, address: str, whole: Floats, present: Flags, rows: Ints) -> None:
        """Refuse increments from where the control only knows: the operator may have moved it."""
        unknown = rows[present & np.isnan(whole)]
        if len(unknown):
            message = f"{address} is incremental, but where {address} stands is not known"
            self.task.refuse(unknown, "GX207", message, f"program {address} in G90 before")

    def _check_feed(self, feed: Floats, written: Floats, members: Ints) -> None:
        """Refuse feeds that are too small to be written."""
        lost = np.flatnonzero(~(np.abs(written - feed) <= FEED_SLIP * feed))
        for piece in members[lost[:1]].tolist():
            where = self.task.location(int(self.pieces.line[piece]))
            message = f"a feed this small has more than {MOST_DECIMALS} decimals"
            raise InputError.one("GX503", message, where, 'cut the move with "segment"')

    def _check_lengths(self, text: bytes, lengths: Ints, chosen: Ints) -> None:
        target = self.task.manner.target
        limit = target.text_rule.line_length
        if not limit or not len(lengths) or int(lengths.max()) <= limit:
            return
        if target.text_rule.length_without_blanks:
            ends = np.cumsum(lengths)
            lines = [text[int(e - n) : int(e)] for e, n in zip(ends, lengths, strict=True)]
            lengths = np.array([without_blanks(line) for line in lines], np.int64)
            if int(lengths.max()) <= limit:
                return
        worst = int(np.argmax(lengths))
        line = int(self.pieces.line[chosen[worst]])
        message = (
            f"the block would have {int(lengths[worst])} characters; {target.name} takes {limit}"
        )
        raise InputError.one("GX502", message, self.task.location(line))
