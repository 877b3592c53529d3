"""Toolpath to text: untouched blocks are copied, the others are written again in their own style.

What decides is what the control believes. The emitter follows the formatted position and the modes
of the output; a block is copied when its bytes say to that control what the path says, and is
written anew otherwise, with every axis word whose formatted value changes. All of it is done for
a whole window at once: lines become **pieces** (a split block has several), pieces that are
written in the same way share a template, and each template is rendered as a matrix of bytes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import Diagnostic, InputError
from gcxform.dialect import Dialect
from gcxform.emit.centres import Centres
from gcxform.emit.copying import Copying
from gcxform.emit.fields import (
    Axis,
    Centre,
    Computed,
    Copied,
    CycleWord,
    Feed,
    Field,
    Key,
    Literal,
    Role,
)
from gcxform.emit.manner import Believed, Manner, Task
from gcxform.emit.numbers import MOST_DECIMALS, decimals_for, decimals_of, quantise
from gcxform.emit.pieces import Pieces
from gcxform.emit.positions import Positions, motion_kinds
from gcxform.emit.render import Renderer, groups_of, interleave
from gcxform.emit.saying import (
    CannotSayError,
    event_text,
    gaps_between,
    left_out,
    nothing_left,
    slash_of,
)
from gcxform.emit.tapping import Taps
from gcxform.emit.templates import TemplateWriter
from gcxform.modal.arcs import TURN
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.limits import without_blanks
from gcxform.modal.tables import NUMBER, MeaningTable
from gcxform.syntax.scan import Window
from gcxform.syntax.tree import Comment
from gcxform.toolpath.path import Kind, Toolpath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


FEED_SLIP = 1.5e-4  # relative; a feed that would be written farther off is refused


@dataclass(frozen=True, slots=True)
class Emitted:
    """Text of a window, and for each of its lines the line of the program it came from.

    `nth` says which of the moves of that line its first move is.
    """

    text: bytes
    source: Ints
    nth: Ints


class Emitter:
    """Writes the windows of one program in order."""

    def __init__(self, manner: Manner, start: Floats, file: str = "-") -> None:
        self.manner = manner
        self.file = file
        self.believed = Believed.at_start(manner, start)
        self.line_end = b""
        self.gap: bytes | None = None
        self.path_mode = ""

    def emit(
        self, window: Window, table: MeaningTable, read: Interpreted, path: Toolpath
    ) -> Emitted:
        """Return the text of a window's path. Raises InputError for what the target cannot say."""
        self._look_at_style(window, table)
        task = Task(self.manner, window, table, read, path, self.file)
        return _Job(task, self).run()

    def _look_at_style(self, window: Window, table: MeaningTable) -> None:
        """Take line end and gap between words from the first lines that show them."""
        if not self.line_end and len(window):
            self.line_end = window.text[int(window.end[0]) : int(window.next[0])] or b"\n"
        if self.gap is None:
            for shape in table.shapes.shapes:
                gaps = list(gaps_between(shape.block.text, list(shape.block.words)))
                if gaps:
                    self.gap = b" " if any(gaps) else b""
                    break


class _Job:
    """The emission of one window."""

    def __init__(self, task: Task, emitter: Emitter) -> None:
        self.task = task
        self.emitter = emitter
        self.path = task.path
        self.positions = Positions(task, emitter.believed)
        self.taps = Taps(task, self.positions, emitter.believed)
        self.kind = motion_kinds(task, self.positions)
        self.pieces = Pieces(task, self.kind, emitter.believed, self.taps)
        self.copying = Copying(task, self.pieces, self.positions, emitter.believed)

    def run(self) -> Emitted:
        copied = self.copying.lines
        self._refuse_rounding()
        self.centre = Centres(self.task, self.kind, self.positions, self.copying).write()
        empty = self._without_words() | self._foreign() | self._gone() | self._only_compensates()
        chosen = np.flatnonzero(~copied[self.pieces.line] & ~empty)
        renderer = Renderer(self.task)
        self._render(chosen, renderer)
        text, lengths = renderer.text(len(chosen))
        self._check_lengths(text, lengths, chosen)
        line, nth = self.pieces.line[chosen], self.pieces.of_rows(self.path.nth, 0)[chosen]
        whole, source, nth = interleave(self.task, copied, line, nth, text, lengths)
        self._carry()
        return Emitted(whole, source + self.task.window.first_line, nth)

    def _without_words(self) -> Flags:
        """Return the inner pieces of split blocks that would have no word: nothing moves."""
        still: Flags = ~self.positions.write.any(axis=1) & (self.kind < Kind.ARC_CW)
        inner: Flags = (self.pieces.role == Role.MIDDLE) & self.pieces.has_row & ~self.pieces.tap
        inner &= ~self.pieces.expanded_line[self.pieces.line] | (self.pieces.motion < 0)
        return np.asarray(inner & self.pieces.of_rows(still, False))

    def _gone(self) -> Flags:
        """Return the pieces of lines of whose move and text nothing is left: no comment either."""
        gone: Flags = self.pieces.role == Role.GONE
        if not gone.any():
            return gone
        items = [shape.block.items for shape in self.task.table.shapes.shapes]
        silent = np.array([not any(isinstance(i, Comment) for i in some) for some in items])
        return np.asarray(gone & silent[self.task.shape][self.pieces.line])

    def _foreign(self) -> Flags:
        """Return the pieces of lines of which nothing is left to write in the target dialect."""
        task = self.task
        if not task.manner.crossing and not self.path.folded:
            return np.zeros(len(self.pieces.line), np.bool_)
        work = self.path.frames[0].work if self.path.folded else ""
        gone = np.array(
            [
                nothing_left(shape.block.items, meaning, task.manner, work)
                for shape, meaning in zip(
                    task.table.shapes.shapes, task.table.meanings, strict=False
                )
            ],
            np.bool_,
        )
        return np.asarray(gone[task.shape][self.pieces.line] & ~self.pieces.has_row)

    def _only_compensates(self) -> Flags:
        """Return the pieces of lines that hold nothing but what is left out of them."""
        if not self.path.blocks.uncompensated:
            return np.zeros(len(self.pieces.line), np.bool_)
        table = self.task.table
        shapes = zip(table.shapes.shapes, table.meanings, strict=False)  # others are read ahead
        only = np.array(
            [m.compensates and all(left_out(item, m) for item in s.block.items) for s, m in shapes],
            np.bool_,
        )
        return np.asarray(only[self.task.shape][self.pieces.line] & ~self.pieces.has_row)

    def _refuse_rounding(self) -> None:
        """Refuse moves of cycles where corners are rounded: the bottom would not be reached."""
        manner, path = self.task.manner, self.path
        modes = [e for e in path.events if _is_path_mode(e.what, manner.source)]
        if manner.source.cycles_stop and self.pieces.expanded_line.any():
            rows = np.flatnonzero(self.pieces.expanded_line[path.block])
            last = np.searchsorted([event.row for event in modes], rows, "right")
            rounds = np.array(
                [e == "G64" for e in [self.emitter.path_mode, *(e.what for e in modes)]]
            )
            if rounds[last].any():
                message = "the moves of a cycle end exactly, and G64 would round their ends"
                first = rows[rounds[last]][:1]
                self._refuse(first, "GX506", message, "write G61 before the cycle")
        if modes:
            self.emitter.path_mode = modes[-1].what

    # --- rendering ---

    def _turns(self) -> Ints:
        """Return the full turns of each row beyond its arc."""
        return np.maximum(np.ceil(self.path.sweep / TURN - 1 - 1e-9), 0).astype(np.int64)

    def _ways(self, chosen: Ints) -> Ints:
        """Return, per piece, one number for the way in which it has to be written."""
        pieces = self.pieces
        arc = pieces.of_rows((self.kind >= Kind.ARC_CW).astype(np.int64), 0)
        inch = self.path.blocks.inch[pieces.line]
        way = self.task.shape[pieces.line].astype(np.int64)
        parts = [
            (pieces.role, len(Role)),
            (pieces.event + 1, len(pieces.events) + 1),
            (pieces.expanded_line[pieces.line], 2),
            (pieces.motion + 1, 128),
            (pieces.inch + 1, 3),
            (pieces.incremental + 1, 3),
            (pieces.absolute_centre + 1, 3),
            (pieces.feed_mode + 1, 128),
            (pieces.silent, 2),
            (pieces.thread, 2),
            (pieces.tap, 2),
            (pieces.apart, 2),
            (pieces.feed, 3),
            (inch, 2),
        ]
        if arc.any():
            plane = pieces.of_rows(self.path.plane.astype(np.int64), 0)
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
            renderer.line_ends(lines, self.pieces.ends[members], self.emitter.line_end)
            renderer.finish(places)

    def _template(self, piece: int) -> tuple[Field, ...]:
        """Return the fields of a piece, which are those of all pieces written in its way."""
        pieces = self.pieces
        if pieces.event[piece] >= 0:
            return self._event_text(piece)
        line = int(pieces.line[piece])
        shape = int(self.task.shape[line])
        row = int(pieces.row[piece])
        arc = bool(pieces.has_row[piece]) and int(self.kind[row]) >= Kind.ARC_CW
        key = Key(
            Role(int(pieces.role[piece])),
            int(pieces.motion[piece]),
            int(pieces.inch[piece]),
            int(pieces.incremental[piece]),
            int(pieces.absolute_centre[piece]),
            int(pieces.feed_mode[piece]),
            bool(pieces.silent[piece]),
            Feed(int(pieces.feed[piece])),
            bool(pieces.expanded_line[line]),
            bool(pieces.thread[piece]),
            bool(pieces.tap[piece]),
            bool(pieces.apart[piece]),
            arc,
            int(self.path.plane[row]) if arc else 0,
            int(self._turns()[row]) if arc else 0,
        )
        writer = TemplateWriter(
            self.task.table.shapes.shapes[shape],
            self.task.table.meanings[shape],
            self.task.manner,
            self.path.axes,
            b" " if self.emitter.gap is None else self.emitter.gap,
            self.path.frames[0].work if self.path.folded else "",
            self.path.blocks.uncompensated,
        )
        try:
            return writer.write(key)
        except CannotSayError as error:
            where = self.task.location(line, error.column, error.width)
            raise InputError.one("GX501", error.message, where) from None

    def _event_text(self, piece: int) -> tuple[Field, ...]:
        """Return the block of something that a canned cycle does between its moves."""
        event, target = self.pieces.events[int(self.pieces.event[piece])], self.task.manner.target
        line = int(self.pieces.line[piece])
        text = event_text(event, target, self.emitter.gap or b"")
        if text is None:
            where = self.task.location(line)
            message = f"{target.name} cannot say the {event.what} of this cycle"
            raise InputError.one("GX501", message, where)
        shape = self.task.table.shapes.shapes[int(self.task.shape[line])]
        return (Literal(slash_of(shape) + text),)

    def _field(self, field: Field, members: Ints, renderer: Renderer) -> None:
        """Render one field of the pieces of a template."""
        manner, rows = self.task.manner, self.pieces.row[members]
        inch = bool(self.path.blocks.inch[self.pieces.line[members[0]]])
        if isinstance(field, Literal):
            renderer.literal(field.text)
        elif isinstance(field, Copied):
            renderer.copied(self.pieces.line[members], field.slot)
        elif isinstance(field, Computed):
            self._computed(field, self.pieces.line[members], renderer)
        elif isinstance(field, Axis):
            column = self.path.axes.index(field.address)
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
            feed = self.pieces.feed_value[members]
            decimals = decimals_for(feed, manner.decimals_of("F", inch))
            whole = quantise(feed, decimals)
            self._check_feed(feed, whole / 10.0**decimals, members)
            everywhere = np.ones(len(rows), np.bool_)
            point = manner.target.point_required
            renderer.number(field.gap, "F", whole, decimals, everywhere, point)

    def _computed(self, field: Computed, lines: Ints, renderer: Renderer) -> None:
        """Write what expressions are worth as plain numbers, to the last bit."""
        value = self.task.read.value[self.task.window.first_number[lines] + field.slot]
        decimals = decimals_of(value)
        whole = quantise(value, decimals)
        inexact = whole / 10.0**decimals != value
        if inexact.any():
            where = self.task.location(int(lines[np.argmax(inexact)]))
            message = f"{field.address} is computed, and has more decimals than can be written"
            raise InputError.one("GX501", message, where)
        renderer.number(b"", field.address, whole, decimals, np.ones(len(lines), np.bool_), False)

    # --- after ---

    def _refuse(self, rows: Ints, code: str, message: str, hint: str) -> None:
        lines = self.path.block[rows[:20]].tolist()
        raise InputError(
            tuple(Diagnostic(code, message, self.task.location(line), hint) for line in lines)
        )

    def _check_known(self, address: str, whole: Floats, present: Flags, rows: Ints) -> None:
        """Refuse increments from where the control only knows: the operator may have moved it."""
        unknown = rows[present & np.isnan(whole)]
        if len(unknown):
            message = f"{address} is incremental, but where {address} stands is not known"
            self._refuse(unknown, "GX207", message, f"program {address} in G90 before")

    def _check_feed(self, feed: Floats, written: Floats, members: Ints) -> None:
        """Refuse feeds that are too small to be written."""
        lost = np.flatnonzero(~(np.abs(written - feed) <= FEED_SLIP * feed))
        for piece in members[lost[:1]].tolist():
            where = self.task.location(int(self.pieces.line[piece]))
            message = f"a feed this small has more than {MOST_DECIMALS} decimals"
            raise InputError.one("GX503", message, where, 'cut the move with "segment"')

    def _check_lengths(self, text: bytes, lengths: Ints, chosen: Ints) -> None:
        target = self.task.manner.target
        limit = target.line_length
        if not limit or not len(lengths) or int(lengths.max()) <= limit:
            return
        if target.length_without_blanks:
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

    def _leave_end(self, believed: Believed) -> None:
        """Leave the modes in which the end of a program leaves a control that goes on."""
        resets = self.task.manner.target.resets_at_end
        if self.task.table.flag("ends", self.task.shape[-1:])[0] and resets:
            believed.motion = NUMBER[resets["motion"]]
            believed.incremental = NUMBER[resets["distance"]]
            believed.feed_mode = NUMBER[resets.get("feed-mode", "G94")]

    def _carry(self) -> None:
        """Leave what the control believes after the window."""
        believed, pieces = self.emitter.believed, self.pieces
        taps = self.taps
        believed.level, believed.tapping, believed.aside = taps.level, taps.moved, taps.aside
        if len(self.path):
            exact = bool(self.copying.exact[-1])
            held = self.path.end[-1] if exact else self.positions.after[-1]
            believed.position = np.array(held)
            believed.exact = exact
        if len(pieces.line):
            believed.motion = int(pieces.motion_after[-1])
            believed.feed = float(pieces.feed_after[-1])
            believed.feed_unit = float(pieces.unit_after[-1])
            for name in ("inch", "incremental", "absolute_centre", "feed_mode"):
                stated = getattr(pieces, name)
                last = np.flatnonzero(stated >= 0)
                if len(last):
                    setattr(believed, name, int(stated[last[-1]]))
            self._leave_end(believed)


def _is_path_mode(what: str, source: type[Dialect]) -> bool:
    return what in source.codes and source.codes[what].group == "path"
