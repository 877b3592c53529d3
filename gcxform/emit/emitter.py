"""Toolpath to text: untouched blocks are copied, the others are written again in their own style.

What decides is what the control believes. The emitter follows the formatted position and the modes
of the output; a block is copied when its bytes say to that control what the path says, and is
written anew otherwise, with every axis word whose formatted value changes. All of it is done for
a whole window at once: lines become **pieces** (a split block has several), the columns that their
words are taken from are made, and `gcxform/emit/writing.py` makes text of them.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.diagnostics import InputError
from gcxform.dialect.code_translation import HOME, IN_STEP
from gcxform.dialect.cycle_rule import TAPPING
from gcxform.emit.bored_places import led_behind
from gcxform.emit.centres import Centres
from gcxform.emit.codewords import WAY_HOME
from gcxform.emit.copying import Copying
from gcxform.emit.expressible import left_out, nothing_left, says_more
from gcxform.emit.fields import Role
from gcxform.emit.manner import Believed, Manner, Task
from gcxform.emit.needed_modes import stated_by
from gcxform.emit.path_modes import ENDS_EXACTLY, Exactness, PathMode
from gcxform.emit.pieces import pieces_of
from gcxform.emit.positions import Positions, motion_kinds
from gcxform.emit.presets import Presets
from gcxform.emit.render import interleave
from gcxform.emit.set_zeros import refuse_other_zeros
from gcxform.emit.tapping import Taps
from gcxform.emit.taps_as_cycles import taps_of
from gcxform.emit.writing import Style, Writing
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.inventory import defines
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.tables import NUMBER, MeaningTable
from gcxform.modal.program_end import Frame
from gcxform.syntax.scan import Window
from gcxform.syntax.source import line_end
from gcxform.syntax.tree import Comment, Item
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct, one_of
from gcxform.toolpath.path import FeedMode, Form, Kind, Toolpath
from gcxform.values import dataclass

LOST = 1e-3  # relative; of the time of a block that pieces without words would take along


@dataclass(frozen=True, slots=True)
class Emitted:
    """Text of a window, and for each of its lines the line of the program it came from.

    `nth` says which of the moves of that line its first move is.
    """

    text: bytes
    source: Ints
    nth: Ints

    def leaving(
        self, codes: tuple[str, ...], window: Window, table: MeaningTable, live: int, last: int
    ) -> Emitted:
        """Return the text with codes in a block before the one with which the program ends.

        It also ends in its line `last`, from 0; -1: only where it says so.
        """
        ends = table.flag("ends", window.shape[:live]).copy()
        if last in window.lines[:live]:
            ends[last - window.first_line] = True
        if not ends.any():
            return self
        line = window.first_line + int(np.argmax(ends))
        lines = self.text.splitlines(keepends=True)
        at = int(np.flatnonzero(self.source == line)[-1])
        lines.insert(at, " ".join(codes).encode() + line_end(lines[at - 1 if at else at]))
        source, nth = np.insert(self.source, at, line), np.insert(self.nth, at, 0)
        return Emitted(b"".join(lines), source, nth)

    def framed(self, frame: Frame, first: bool, last: bool) -> Emitted:
        """Return the text with the percent signs that go before and behind a whole program."""
        text, before, behind = frame.put(self.text, first, last)
        if not before and not behind:
            return self
        lines = (0, self.source[-1] if len(self.source) else 0)
        source = np.concatenate([[lines[0]] * before, self.source, [lines[1]] * behind])
        nth = np.concatenate([[0] * before, self.nth, [0] * behind])
        return Emitted(text, source.astype(np.int64), nth.astype(np.int64))


class Emitter:
    """Writes the windows of one program in order."""

    def __init__(
        self,
        manner: Manner,
        start: Floats,
        file: str = "-",
        called: Callable[[int], bool] = lambda _: False,
    ) -> None:
        self.manner = manner
        self.file = file
        self.called = called
        self.believed = Believed.at_start(manner, start)
        self.style = Style()
        self.path_mode = PathMode()
        self.over = False
        self.assumed: dict[str, None] = {}

    def emit(
        self, window: Window, table: MeaningTable, read: Interpreted, path: Toolpath
    ) -> Emitted:
        """Return the text of a window's path. Raises InputError for what the target cannot say."""
        self.style.look_at(window, table)
        task = Task(self.manner, window, table, read, path, self.file)
        return _Job(task, self).run()


class _Job:
    """The emission of one window."""

    def __init__(self, task: Task, emitter: Emitter) -> None:
        self.task = task
        self.emitter = emitter
        self.path = task.path
        self.positions = Positions(task, emitter.believed)
        self.in_step = taps_of(task, emitter.believed.speed)
        self.taps = Taps(task, self.positions, emitter.believed, self.in_step.rows)
        self.taps.words |= self.in_step.words(self.positions)
        self.exactness = Exactness(task, emitter.path_mode, emitter.called)
        self.pieces = pieces_of(task, self.taps, self.exactness.around, self.in_step)
        kind = motion_kinds(task, self.positions)
        self.stated = stated_by(task, self.pieces, kind, emitter.believed)
        self.copying = Copying(
            task, self.pieces, self.stated, self.taps, self.positions, emitter.believed
        )

        self.presets = Presets(task, self.positions, self.copying, emitter.believed)
        self.copying.lines &= ~self.presets.lines

    def run(self) -> Emitted:
        copied = self.copying.lines
        self._refuse_rounding()
        self._refuse_lost()
        self._refuse_behind_end()
        self._refuse_dwells()
        self._taps_alike()
        self._refuse_ways_home()
        refuse_other_zeros(self.task)
        centre = Centres(self.task, self.stated.kind, self.positions, self.copying).write()
        empty = self._without_words() | self._foreign() | self._gone() | self._only_compensates()
        empty &= self.pieces.event < 0
        empty |= self.task.skipped[self.pieces.line]
        chosen = np.flatnonzero(~copied[self.pieces.line] & ~empty)
        self._refuse_lost_times(chosen)
        columns = self.stated, self.positions, self.taps, centre, self.presets
        writing = Writing(self.task, self.emitter.style, self.pieces, *columns)
        text, lengths = writing.text(chosen)
        line, nth = self.pieces.line[chosen], self.pieces.of_rows(self.path.nth, 0)[chosen]
        whole, source, nth = interleave(self.task, copied, line, nth, text, lengths)
        self._carry()
        return Emitted(whole, source + self.task.window.first_line, nth)

    def _without_words(self) -> Flags:
        """Return the inner pieces of split blocks that would have no word: nothing moves."""
        still: Flags = ~self.positions.write.any(axis=1) & (self.stated.kind < Kind.ARC_CW)
        inner: Flags = (self.pieces.role == Role.MIDDLE) & self.pieces.has_row & ~self.pieces.tap
        inner &= ~self.pieces.expanded_line[self.pieces.line] | (self.stated.motion.code < 0)
        return np.asarray(inner & self.pieces.of_rows(still, False))

    def _gone(self) -> Flags:
        """Return the pieces of lines of whose move and text nothing is left: no comment either."""
        gone: Flags = self.pieces.role == Role.GONE
        if not gone.any():
            return gone
        silent = self._of_shapes(lambda items, _: not any(isinstance(i, Comment) for i in items))
        return np.asarray(gone & silent[self.pieces.line])

    def _foreign(self) -> Flags:
        """Return the pieces of lines of which nothing is left to write in the target dialect."""
        task = self.task
        switches = task.table.flag("switches", task.shape).any()
        says = task.manner.crossing or task.manner.saying.drop
        if not says and not self.path.folded and not switches:
            return np.zeros(len(self.pieces.line), np.bool_)
        work = self.path.frames[0].work if self.path.folded else ""
        gone = self._of_shapes(lambda items, m: nothing_left(items, m, task.manner, work))
        return np.asarray(gone[self.pieces.line] & ~self.pieces.has_row)

    def _only_compensates(self) -> Flags:
        """Return the pieces of lines that hold nothing but what is left out of them."""
        if not self.path.blocks.uncompensated:
            return np.zeros(len(self.pieces.line), np.bool_)
        only = self._of_shapes(
            lambda items, m: m.compensates and all(left_out(i, m) for i in items)
        )
        return np.asarray(only[self.pieces.line] & ~self.pieces.has_row)

    def _of_shapes(self, says: Callable[[tuple[Item, ...], Meaning], bool]) -> Flags:
        """Return, per line, what is said of its items and its meaning: once for each shape."""
        table, shape = self.task.table, self.task.shape
        here = np.bincount(shape).astype(np.bool_)
        for number in np.flatnonzero(here).tolist():
            items = table.shapes.shapes[number].block.items
            here[number] = says(items, table.meanings[number])
        return here[shape]

    def _refuse_lost(self) -> None:
        """Refuse to leave out a subprogram behind the end, which another dialect cannot keep."""
        task = self.task
        if not task.manner.crossing:
            return
        shapes = task.window.shape[task.read.live :]
        for number in distinct(shapes).tolist():
            if defines(task.table.shapes.shapes[number].block):
                line = task.read.live + int(np.argmax(shapes == number))
                message = "nothing calls this subprogram, and in another dialect it would be lost"
                hint = "give it a file of its own"
                raise InputError.one("GX226", message, task.location(line), hint)

    def _refuse_behind_end(self) -> None:
        """Refuse blocks behind an end at which the target stops, and the source does not.

        Another end does nothing there; what the proof sees of it is in the same window.
        """
        task = self.task
        source, target = task.manner.source, task.manner.target
        if source.program_rule.stops_at_end or not target.program_rule.stops_at_end:
            return
        ends = {n for n, code in source.m_codes.items() if code.ends and not self.emitter.over}
        over = np.logical_or.accumulate(
            np.append(self.emitter.over, task.table.flag("ends", task.shape))
        )
        self.emitter.over = bool(over[-1])
        wrong = over[:-1] & self._of_shapes(lambda items, _: says_more(items, ends))
        if wrong.any():
            message = f"{target.name} stops at the end before, and {source.name} goes on here"
            where = task.location(int(np.argmax(wrong)))
            raise InputError.one(
                "GX501", message, where, "take out M2 or M30, or what is behind it"
            )

    def _refuse_ways_home(self) -> None:
        """Refuse ways home that the target would have to say by G53, and of which none knows how.

        There they go elsewhere, end a tool length, or are not known to move what they move here.
        """
        task, saying = self.task, self.task.manner.saying
        codes, first = task.manner.source.codes, task.path.blocks.first
        if not saying.crosses:
            return
        for event in task.read.path.events:
            code, line = codes.get(event.what), event.line - first
            if code is None or code.act != HOME or line in task.read.homed:
                continue
            path = task.read.path
            row, end = np.searchsorted(path.block, [line, line + 1]).tolist()
            called = end > row and path.frames[path.frame[row]].called
            same = saying.instead(event.what) == event.what
            more = same and saying.moves_home(event.what, end - row == 1, called)
            if more or (not same and line in task.read.ways_open):
                why = "it does more there" if more else "it goes to a point of another kind there"
                message = f"{task.manner.target.name} cannot say {event.what}: {why}"
                said = task.read.ways_open.get(line, "")
                hint = f"give a machine file with {said}" if said else WAY_HOME
                where = task.location(line)
                found = re.search(rf"{event.what[0]}[ \t]*0*{event.what[1:]}(?![0-9.])", where.text)
                place = found.span() if found else (0, len(where.text))
                where = task.location(line, place[0], place[1] - place[0])
                raise InputError.one("GX501", message, where, hint)

    def _refuse_dwells(self) -> None:
        """Refuse cycles that stand as they are, and would wait for another time in the target."""
        task = self.task
        source, target = task.manner.source, task.manner.target
        if not task.manner.crossing:
            return
        self._refuse_open_waits()
        if source.point_rule.waits_as(target.point_rule):
            return
        waits = task.table.slots[task.shape, ord("P") - 65]
        cycles = self.path.block[self.path.form == Form.CYCLE]
        if task.manner.saying.taps != "alike":  # a tap is refused by its own name
            cycles = cycles[~one_of(task.read.modes.cycle[cycles], sorted(TAPPING))]
        for line in distinct(cycles[waits[cycles] >= 0]).tolist():
            number = int(task.window.first_number[line] + waits[line])
            pointed = bool(task.window.decimals[number] >= 0)
            was, now = (d.point_rule.seconds("P", pointed) for d in (source, target))
            if was != now and task.window.value[number]:
                wait = float(task.window.value[number])
                message = (
                    f"{target.name} would wait {wait * now:g} s here, and not {wait * was:g} s"
                )
                taps = task.read.modes.cycle[line] in TAPPING
                hint = "let the CAM write the time for this control"
                hint = hint if taps else put_before("cycles")
                raise InputError.one("GX501", message, task.location(line), hint)

    def _taps_alike(self) -> None:
        """Note that a tap is one there for only the user says so."""
        manner = self.task.manner
        tied = self.path.block[self.path.form == Form.SYNCHRONISED]
        cycles = one_of(self.task.read.modes.cycle[tied], sorted(TAPPING))
        if manner.crossing and manner.saying.taps == "alike" and cycles.any():
            said = f"in G74 and G84 the spindle turns on {manner.target.name} as it does on "
            self.emitter.assumed[said + manner.source.name] = None
        if self.in_step.rows.any():
            sides = [manner.source.name, manner.target.name]
            one, other = reversed(sides) if manner.saying.taps_as_cycles else sides
            said = f"G74 and G84 of {one} tap in step with the spindle, as {IN_STEP} of {other}"
            self.emitter.assumed[said] = None

    def _refuse_open_waits(self) -> None:
        """Refuse dwells of which a setting of the source says how long they are."""
        first = self.task.path.blocks.first
        for event in self.task.read.path.events:
            if event.what == "DWELL" and "increments" in dict(event.values):
                message = "how long it waits depends on the control: its time has no decimal point"
                hint = 'increment = "IS-B" in [input] if 1000 is 1 s; or write it with a point'
                raise InputError.one("GX205", message, self.task.location(event.line - first), hint)

    def _refuse_rounding(self) -> None:
        """Refuse moves of cycles where corners are rounded: the bottom would not be reached."""
        if self.exactness.refuse(self.pieces.expanded_line):
            self.emitter.assumed[ENDS_EXACTLY] = None
        self.emitter.path_mode = self.exactness.after

    def _refuse_lost_times(self, chosen: Ints) -> None:
        """Refuse blocks in inverse time whose pieces are too short to be written.

        A piece in which no word changes is left out, and what it would have taken goes with it.
        """
        path, pieces = self.path, self.pieces
        chosen = chosen[(pieces.has_row & ~pieces.special & ~pieces.tap)[chosen]]
        timed = (path.feed_mode == FeedMode.INVERSE_TIME) & (path.kind != Kind.RAPID)
        written = np.zeros(len(path), np.bool_)
        written[pieces.row[chosen]] = True
        again = np.zeros(len(pieces.count), np.bool_)
        again[pieces.line[chosen]] = True
        timed &= again[path.block] & (pieces.count[path.block] > 1)
        if (written | ~timed).all():
            return
        block, time = path.block[timed], 1.0 / path.feed[timed]
        lost = np.where(written[timed], 0.0, time)
        gone, whole = (np.bincount(block, each, len(again)) for each in (lost, time))
        wrong = gone > LOST * whole
        if wrong.any():
            rows = np.flatnonzero(timed & wrong[path.block])
            rows = rows[np.unique(path.block[rows], return_index=True)[1]]
            message = "in inverse time this block would lose pieces that are too short to write"
            self.task.refuse(rows, "GX508", message, "write more decimals, or longer pieces")

    # --- after ---

    def _leave_end(self, believed: Believed) -> None:
        """Leave the modes in which the end of a program leaves a control that goes on."""
        resets = self.task.manner.target.program_rule.resets_at_end
        if self.task.table.flag("ends", self.task.shape[-1:])[0] and resets:
            believed.motion = NUMBER[resets["motion"]]
            believed.incremental = NUMBER[resets["distance"]]
            believed.feed_mode = NUMBER[resets.get("feed-mode", "G94")]

    def _carry(self) -> None:
        """Leave what the control believes after the window."""
        believed, stated, taps = self.emitter.believed, self.stated, self.taps
        believed.level, believed.tapping, believed.aside = taps.level, taps.moved, taps.aside
        if len(self.path):
            exact = bool(self.copying.exact[-1])
            held = self.path.end[-1] if exact else self.positions.after[-1]
            believed.position = np.array(held)
            believed.exact = exact
            believed.said = np.array(self.copying.said_exactly()[-1])
            believed.stands = self.presets.standing(len(self.path) - 1)
        believed.led = led_behind(self.task, believed)
        believed.speed = self.in_step.speed
        if len(self.pieces.line):
            believed.motion = int(stated.motion.after[-1])
            believed.feed = float(stated.feed.after[-1])
            believed.feed_unit = float(stated.feed.unit_after[-1])
            for name in ("inch", "incremental", "absolute_centre", "feed_mode"):
                codes = getattr(stated, name)
                last = np.flatnonzero(codes >= 0)
                if len(last):
                    setattr(believed, name, int(codes[last[-1]]))
            self._leave_end(believed)
