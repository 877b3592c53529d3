"""From windows of blocks to toolpaths: what the words mean, given all that stood before.

The interpreter works on columns. Every modal group, every axis and the feed is one column over the
lines of a window, filled forward from the line that set it; what holds at the end of a window is
carried into the next. Whatever a dialect leaves to the machine is an option of `Reading`, and what
needs a fact that is not known is refused, with the line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import INCH, LINEAR, Dialect
from gcxform.modal.arcs import ArcWords, resolve_arcs
from gcxform.modal.findings import Findings
from gcxform.modal.tables import GROUPS, NUMBER, MeaningTable
from gcxform.syntax.scan import Window
from gcxform.toolpath.path import Blocks, Event, Kind, Toolpath, column_major, constant

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Small = NDArray[np.int8]
Flags = NDArray[np.bool_]

DISTANCES = "XYZABCUVWIJKR"
LENGTHS = LINEAR + "IJKR"
NOTHING = 0  # the shape of an empty line


@dataclass(frozen=True, slots=True)
class Reading:
    """What a program does not say of itself.

    start         position of axes before the first block, mm or degrees
    increment     least input increment, in the unit the program is in (mm, inch) and degrees;
                  None: a distance without a point is refused where the dialect asks for one
    feed          feed in effect before the first F word, in the program's unit
    block_delete  "execute", "skip", or "" to refuse blocks with a slash that do anything
    units         "mm" or "in" until the program says G20 or G21; "" for the dialect's default
    """

    start: Mapping[str, float] = field(default_factory=dict)
    increment: float | None = None
    feed: float | None = None
    block_delete: str = ""
    units: str = ""


@dataclass(slots=True)
class State:
    """What one window hands to the next."""

    groups: dict[str, int]
    position: Floats
    feed: float
    feed_unit: float
    frame_known: bool
    ended: bool = False
    percents: int = 0
    stated: set[str] = field(default_factory=set)


@dataclass(frozen=True, slots=True)
class Modes:
    """Per line of a window, after its words: the number of the code in force of each group.

    `feed` is the number last programmed and `feed_unit` what 1 of it is worth in mm.
    """

    motion: Small
    plane: Small
    incremental: Flags
    absolute_centre: Flags
    feed_mode: Small
    inch: Flags
    frame: Small
    feed: Floats
    feed_unit: Floats


@dataclass(frozen=True)
class Interpreted:
    """A window's toolpath and the modes of its lines; `live` lines are those the control runs."""

    path: Toolpath
    modes: Modes
    live: int
    before: State


class Interpreter:
    """Reads the windows of one program in order."""

    def __init__(
        self,
        dialect: type[Dialect],
        reading: Reading | None = None,
        axes: str = "",
        file: str = "-",
    ) -> None:
        self.dialect = dialect
        self.reading = reading or Reading()
        self.axes = axes or dialect.axes
        self.file = file
        self.state = self._first_state()

    def _first_state(self) -> State:
        groups = {g: NUMBER[self.dialect.initial[g]] for g in GROUPS}
        if self.reading.units:
            groups["units"] = int(self.reading.units == "in")
        start = self.reading.start
        position = np.array([start.get(axis, np.nan) for axis in self.axes])
        feed = np.nan if self.reading.feed is None else self.reading.feed
        unit = INCH if groups["units"] else 1.0
        known = bool(start) or self.dialect.block_delete == "execute"
        return State(groups, position, feed, unit, known)

    def interpret(self, window: Window, table: MeaningTable) -> Interpreted:
        """Return the moves of a window. Raises InputError with all that speaks against it."""
        table.update()
        work = _Work(self, window, table)
        before = replace(self.state, position=self.state.position.copy())
        path, modes = work.run()
        return Interpreted(path, modes, work.live, before)


def fill(values: NDArray[Any], present: Flags, initial: float) -> NDArray[Any]:
    """Return a column in which every line has the value last set before or on it."""
    if not present.any():
        return np.full(len(values), initial, values.dtype)
    if present.all():
        return values
    at = np.where(present, np.arange(len(values)), -1)
    np.maximum.accumulate(at, out=at)
    filled = values[at]
    filled[at < 0] = initial
    return filled


class _Work:
    """The interpretation of one window."""

    def __init__(self, reader: Interpreter, window: Window, table: MeaningTable) -> None:
        self.reader = reader
        self.dialect = reader.dialect
        self.state = reader.state
        self.window = window
        self.table = table
        self.findings = Findings(reader.file, window, table)
        self._entry = self.state.position.copy()
        self.live = self._live()
        self.shape = window.shape[: self.live]
        self.first = window.first_number[: self.live]
        self._used = table.slots[np.unique(self.shape)].max(axis=0, initial=-1) >= 0

    def _live(self) -> int:
        """Return how many lines the control executes before the program ends."""
        if self.state.ended:
            return 0
        shape = self.window.shape
        ends = np.zeros(len(shape), np.bool_)
        if self.dialect.stops_at_end:
            ends |= self.table.flag("ends", shape) & ~self.table.flag("deleted", shape)
        percent = np.flatnonzero(self.table.flag("percent", shape))
        for line in percent[max(0, 1 - self.state.percents) :][:1]:
            ends[line] = True
        self.state.percents += len(percent)
        if not ends.any():
            return len(shape)
        self.state.ended = True
        return int(np.argmax(ends)) + 1

    def run(self) -> tuple[Toolpath, Modes]:
        self._refuse_statically()
        modes = self._modes()
        rows = self._rows(modes)
        ends = self._positions(modes, rows)
        path = self._path(modes, rows, ends)
        self.findings.raise_if_any()
        self._carry(modes, path)
        return path, modes

    # --- what can be seen without numbers ---

    def _refuse_statically(self) -> None:
        self._deleted_blocks()
        self._lone_line_ends()
        for line in np.flatnonzero(self.table.flag("wrong", self.shape)).tolist():
            self.findings.add_refusal(line)
        self.findings.raise_if_any()

    def _deleted_blocks(self) -> None:
        """Execute or silence blocks with a slash, or refuse them."""
        deleted = np.flatnonzero(self.table.flag("deleted", self.shape))
        policy = self.reader.reading.block_delete or self.dialect.block_delete
        if not len(deleted) or policy == "execute":
            return
        if policy == "skip":
            self.shape = self.shape.copy()
            self.shape[deleted] = NOTHING
            return
        for line in deleted.tolist():
            self.findings.add(
                line,
                "GX211",
                "a switch of the control decides whether this block is executed",
                hint='say which: block-delete = "execute" or "skip" in [input]',
            )

    def _lone_line_ends(self) -> None:
        """Refuse lines that the control would take together."""
        window = self.window
        if not self.dialect.lone_cr_is_blank or b"\r" not in window.text:
            return
        text = np.frombuffer(window.text + b"\n", np.uint8)
        stop = window.end[: self.live]
        lone = (text[stop] == 13) & (window.next[: self.live] - stop == 1)
        for line in np.flatnonzero(lone)[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX102",
                f"the line ends with CR alone, which {self.dialect.name} reads as a blank",
                hint="convert the line ends of the file to LF or CRLF",
            )

    # --- columns over the lines ---

    def _word(self, address: str) -> tuple[Floats, Flags] | None:
        """Return value and presence of a word on each line; None if no line has it."""
        column = ord(address) - 65
        if not self._used[column]:
            return None
        slot = self.table.slots[self.shape, column]
        present = slot >= 0
        number = self.first + slot
        if not present.all():
            number = np.where(present, number, 0)
        value = self.window.value[number] if len(self.window.value) else np.zeros(self.live)
        if self.dialect.point_required and address in DISTANCES:
            value = self._with_increment(address, value, present, number)
        return value, present

    def _with_increment(self, address: str, value: Floats, present: Flags, number: Ints) -> Floats:
        """Return distances with those that have no point scaled by the increment."""
        pointless = present & (self.window.decimals[number] < 0) & (value != 0)
        if not pointless.any():
            return value
        if self.reader.reading.increment is None:
            for line in np.flatnonzero(pointless).tolist():
                self.findings.add(
                    line,
                    "GX205",
                    f"{address} has no decimal point: its unit depends on the control",
                    address,
                    'say what 1 is worth: increment = "0.001 mm" in [input]',
                )
            return value
        return np.where(pointless, value * self.reader.reading.increment, value)

    def _group(self, name: str) -> Small:
        values = self.table.groups[self.shape, GROUPS.index(name)]
        present = values >= 0
        if present.any():
            self.state.stated.add(name)
        if name in self.dialect.resets_at_end:
            after = np.flatnonzero(self.table.flag("ends", self.shape)) + 1
            after = after[after < self.live]
            after = after[~present[after]]
            values[after] = NUMBER[self.dialect.resets_at_end[name]]
            present[after] = True
        return fill(values, present, self.state.groups[name])

    def _modes(self) -> Modes:
        groups = {name: self._group(name) for name in GROUPS}
        inch = groups["units"] == 1
        feed, feed_unit = self._feed(groups["feed-mode"], inch)
        return Modes(
            groups["motion"],
            groups["plane"],
            groups["distance"] == 1,
            groups["arc-distance"] == 1,
            groups["feed-mode"],
            inch,
            groups["frame"],
            feed,
            feed_unit,
        )

    def _feed(self, feed_mode: Small, inch: Flags) -> tuple[Floats, Floats]:
        """Return the feed number in force after each line's words, and its unit in mm."""
        word = self._word("F")
        value = np.full(self.live, np.nan)
        present = np.zeros(self.live, np.bool_)
        if word is not None:
            value, present = np.where(word[1], word[0], np.nan), word[1]
            self._refuse_pointless_feed(present, feed_mode, inch)
        present = present | self._cleared(feed_mode, inch)
        if self.dialect.feed_before_units:
            inch = np.append(self.state.groups["units"] == 1, inch[:-1])[: self.live]
        unit = np.where(inch, INCH, 1.0)
        return (
            fill(value, present, self.state.feed),
            fill(unit, present, self.state.feed_unit),
        )

    def _cleared(self, feed_mode: Small, inch: Flags) -> Flags:
        """Return the lines that leave no feed in force unless they program one."""
        cleared = np.zeros(self.live, np.bool_)
        if self.dialect.feed_mode_clears_feed:
            cleared |= self.table.groups[self.shape, GROUPS.index("feed-mode")] >= 0
        if self.dialect.change_clears_feed and self.live:
            mode = np.append(np.int8(self.state.groups["feed-mode"]), feed_mode)
            unit = np.append(self.state.groups["units"] == 1, inch)
            cleared |= (mode[1:] != mode[:-1]) | (unit[1:] != unit[:-1])
        return cleared

    def _refuse_pointless_feed(self, present: Flags, feed_mode: Small, inch: Flags) -> None:
        """Refuse feeds without a point where their unit depends on the control."""
        if not self.dialect.point_required:
            return
        slot = self.table.slots[self.shape, ord("F") - 65]
        number = np.where(present, self.first + slot, 0)
        odd = present & (self.window.decimals[number] < 0)
        odd &= inch | (feed_mode == NUMBER["G95"])
        for line in np.flatnonzero(odd)[: Findings.enough].tolist():
            message = "F has no decimal point: its unit depends on the control"
            self.findings.add(line, "GX205", message, "F", "write the feed with a point")

    # --- moves ---

    def _rows(self, modes: Modes) -> Ints:
        """Return the lines that move, after looking at what they may not be."""
        moves = self.table.flag("moves", self.shape)
        centre = self.table.flag("has_centre", self.shape)
        arc = (modes.motion == 2) | (modes.motion == 3)
        for line in np.flatnonzero(moves & (modes.motion == NUMBER["G80"])).tolist():
            self.findings.add(
                line,
                "GX209",
                "axis words, but no motion code is in force",
                hint="write G0 or G1 in this block",
            )
        for line in np.flatnonzero(centre & ~arc).tolist():
            self.findings.add(line, "GX203", "I, J, K and R belong to arcs, and this is none")
        for line in np.flatnonzero(centre & arc & self._dwells()).tolist():
            message = "a dwell and an arc: the control takes some words for both"
            self.findings.add(line, "GX203", message, hint="write the dwell in a block of its own")
        rows = np.flatnonzero(moves | (centre & arc))
        self._check_feed(modes, rows)
        return rows

    def _dwells(self) -> Flags:
        """Return the lines with a dwell that takes a word which arcs take as well."""
        if self.dialect.turns_address not in self.dialect.dwell:
            return np.zeros(self.live, np.bool_)
        dwell = np.array([meaning.dwell for meaning in self.table.meanings], np.bool_)
        return np.asarray(dwell[self.shape])

    def _check_feed(self, modes: Modes, rows: Ints) -> None:
        """Refuse feed moves without a feed, and blocks in inverse time without a feed word."""
        feeding = rows[modes.motion[rows] != Kind.RAPID]
        feed = modes.feed[feeding]
        missing = feeding[~(feed > 0)]
        inverse = feeding[modes.feed_mode[feeding] == NUMBER["G93"]]
        word = self._word("F")
        if len(inverse):
            none = inverse if word is None else inverse[~word[1][inverse]]
            missing = np.union1d(missing, none)
        for line in missing[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX204",
                "a feed move, but no feed is in force",
                hint="write an F word; in G93 every feed block needs one",
            )

    def _positions(self, modes: Modes, rows: Ints) -> Floats:
        """Return the ends of the moves; the state's position becomes that after the window."""
        lost = self.table.flag("loses_position", self.shape)
        lost = lost | self._other_frame(modes)
        any_lost = bool(lost.any())
        ends = column_major(len(rows), len(self.reader.axes))
        for column, axis in enumerate(self.reader.axes):
            position = self._axis(axis, column, modes, lost if any_lost else None)
            ends[:, column] = position[rows] if isinstance(position, np.ndarray) else position
            if self.live:
                last = position[-1] if isinstance(position, np.ndarray) else position
                self.state.position[column] = last
        return ends

    def _other_frame(self, modes: Modes) -> Flags:
        """Return the lines from which on positions count from another, unknown origin."""
        frame = np.append(self.state.groups["frame"], modes.frame)
        other = frame[1:] != frame[:-1]
        stated = self.table.groups[self.shape, GROUPS.index("frame")] >= 0
        if not self.state.frame_known and stated.any():
            other[int(np.argmax(stated))] = True
            self.state.frame_known = True
        return np.asarray(other)

    def _axis(self, axis: str, column: int, modes: Modes, lost: Flags | None) -> Floats | float:
        """Return the position of an axis after each line; one number if it never changes."""
        word = self._word(axis)
        before = float(self.state.position[column])
        if word is None:
            if lost is None:
                return before
            return fill(np.full(self.live, np.nan), lost, before)
        value, present = word
        if axis in LENGTHS and modes.inch.any():
            value = np.where(modes.inch, value * INCH, value)
        incremental = modes.incremental & present
        placed = present & ~incremental
        if lost is not None:
            value = np.where(lost & ~present, np.nan, value)
            placed = placed | (lost & ~incremental)
        if not incremental.any():
            return fill(value, placed, before)
        position = _with_increments(value, placed, incremental, before)
        for line in np.flatnonzero(incremental & np.isnan(position))[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX207",
                f"{axis} is incremental, but where {axis} stands is not known",
                axis,
                f"begin with an absolute {axis}, or say start = {{ {axis} = ... }} in [input]",
            )
        return position

    def _path(self, modes: Modes, rows: Ints, ends: Floats) -> Toolpath:
        """Return the rows as a toolpath; arcs get their centres."""
        count = len(rows)
        path = Toolpath(
            self.reader.axes,
            modes.motion[rows],
            ends,
            np.broadcast_to(np.nan, (count, 3)),
            constant(0.0, count),
            modes.plane[rows],
            self._feed_of_rows(modes, rows, ends),
            modes.feed_mode[rows],
            modes.frame[rows],
            rows + self.window.first_line,
            self._entry,
            Blocks(self.window.first_line, modes.inch, modes.incremental, modes.absolute_centre),
            self._events(rows),
        )
        if not path.has_arcs:
            return path
        arcs = np.flatnonzero(path.is_arc)
        return resolve_arcs(path, self._arc_words(modes, rows[arcs]), self.dialect, self.findings)

    def _feed_of_rows(self, modes: Modes, rows: Ints, ends: Floats) -> Floats:
        """Return feeds in mm/min, 1/min, mm/turn, or deg/min where only rotary axes turn."""
        feed, unit = modes.feed[rows], modes.feed_unit[rows]
        if (unit == 1.0).all():
            return feed
        plain = modes.feed_mode[rows] == NUMBER["G93"]
        plain |= turns_only(self.reader.axes, self._entry, ends) & (modes.motion[rows] < 2)
        return np.where(plain, feed, feed * unit)

    def _arc_words(self, modes: Modes, lines: Ints) -> ArcWords:
        """Return centre, radius and turns words of arcs, nan where there is none, in mm."""
        scale = np.where(modes.inch[lines], INCH, 1.0)

        def column(address: str) -> Floats:
            word = self._word(address) if address else None
            if word is None:
                return np.full(len(lines), np.nan)
            return np.where(word[1][lines], word[0][lines], np.nan)

        return ArcWords(
            lines,
            np.stack([column(a) * scale for a in "IJK"], axis=1),
            column("R") * scale,
            column(self.dialect.turns_address),
            np.stack([~np.isnan(column(a)) for a in "XYZ"], axis=1),
            modes.absolute_centre[lines],
        )

    def _events(self, rows: Ints) -> tuple[Event, ...]:
        """Return what happens between the moves, in the order of execution."""
        events = []
        lines = np.flatnonzero(self.table.flag("has_events", self.shape))
        row = np.searchsorted(rows, lines)
        on_move = np.isin(lines, rows)
        for line, at, moves in zip(lines.tolist(), row.tolist(), on_move.tolist(), strict=True):
            first = int(self.first[line])
            meaning = self.table.meanings[int(self.shape[line])]
            for event in meaning.events:
                values = tuple(self._event_value(event.what, a, first + n) for a, n in event.slots)
                where = at + (moves and event.after)
                events.append(Event(where, event.what, values, line + self.window.first_line))
        return tuple(events)

    def _event_value(self, what: str, address: str, number: int) -> tuple[str, float]:
        """Return a word of an event; a time in seconds where the dialect knows its unit."""
        value = float(self.window.value[number])
        if what != "DWELL":
            return address, value
        pointless = self.window.decimals[number] < 0 and address in LENGTHS
        if pointless and value and self.dialect.point_required:
            return "increments", value
        return "seconds", value * self.dialect.dwell[address]

    def _carry(self, modes: Modes, path: Toolpath) -> None:
        """Leave the state in which the window ends."""
        if not self.live:
            return
        last = {
            "motion": modes.motion,
            "plane": modes.plane,
            "distance": modes.incremental,
            "arc-distance": modes.absolute_centre,
            "feed-mode": modes.feed_mode,
            "units": modes.inch,
            "frame": modes.frame,
        }
        self.state.groups = {name: int(column[-1]) for name, column in last.items()}
        self.state.feed = float(modes.feed[-1])
        self.state.feed_unit = float(modes.feed_unit[-1])
        if self.table.flag("ends", self.shape[-1:])[0]:
            for name, code in self.dialect.resets_at_end.items():
                self.state.groups[name] = NUMBER[code]


def turns_only(axes: str, entry: Floats, ends: Floats) -> Flags:
    """Return the moves (n,) in which no linear axis moves and a rotary one does."""
    linear = [k for k, axis in enumerate(axes) if axis in LINEAR]
    rotary = [k for k, axis in enumerate(axes) if axis not in LINEAR]
    if not rotary or not len(ends):
        return np.zeros(len(ends), np.bool_)
    start = np.vstack([entry, ends[:-1]])
    still = (start == ends) | (np.isnan(start) & np.isnan(ends))
    return np.asarray(still[:, linear].all(axis=1) & ~still[:, rotary].all(axis=1))


def _with_increments(value: Floats, placed: Flags, incremental: Flags, before: float) -> Floats:
    """Return positions where some lines place the axis and others add to where it stands."""
    steps = np.cumsum(np.where(incremental, value, 0.0))
    base = fill(np.where(placed, value - steps, 0.0), placed, before)
    return np.asarray(base + steps)
