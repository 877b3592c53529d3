"""A toolpath: one row per canonical move, one array per quantity, read-only.

Lengths are mm, angles of rotary axes degrees, sweeps of arcs radians. A position that is not known
is nan. `start` is not stored: it is the end of the row before, `entry` for the first row. Passes
return new paths made with `replace`, `take` and `with_rows`, which carry `source` along.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace as dataclass_replace
from enum import IntEnum
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.dialect import EXTRUDER
from gcxform.system.arrays import Flags, Floats, Ints, Small, read_only
from gcxform.system.distinct import distinct, one_of
from gcxform.system.limits import how_to_raise, limits
from gcxform.toolpath.columns import COLUMNS, TYPES, picked, typed
from gcxform.toolpath.frames import Frame, by_frame
from gcxform.toolpath.table import Tabled
from gcxform.values import dataclass


class Kind(IntEnum):
    """The canonical moves; the numbers are those of G0 to G3."""

    RAPID = 0
    LINE = 1
    ARC_CW = 2
    ARC_CCW = 3


class Plane(IntEnum):
    """The plane of an arc, in the order of axes that fixes its sense."""

    XY = 0
    ZX = 1
    YZ = 2

    @property
    def axes(self) -> tuple[int, int, int]:
        """First, second and normal axis, as indices of X, Y, Z."""
        return ((0, 1, 2), (2, 0, 1), (1, 2, 0))[self]


class Form(IntEnum):
    """What a row is a part of; all but PLAIN are written as the block they came from, or refused.

    CYCLE: a canned cycle. HOME: G28, G30. MACHINE: a move in machine coordinates (G53). PROBE: it
    ends where something is touched, its target at the latest. SYNCHRONISED: it is tied to the
    spindle. SPLINE: a cubic Bezier curve; its kind is LINE, because it cuts. THREAD: tied to the
    spindle as well, one straight move (G33), which is written anew if its ends move. BLIND: a plain
    move by distances, of an axis of which it is not known where it stands. NURBS: a leg between
    control points of a spline (G5.2), which stays inside of their hull; its kind is LINE. PASSES:
    a thread that is cut in passes (G76), of which the deepest is told. TILTED: a leg around an arc
    in a plane that is turned out of the axes, which stays inside of their hull; its kind is LINE.
    """

    PLAIN = 0
    CYCLE = 1
    HOME = 2
    MACHINE = 3
    PROBE = 4
    SYNCHRONISED = 5
    SPLINE = 6
    THREAD = 7
    BLIND = 8
    NURBS = 9
    PASSES = 10
    TILTED = 11


FREE = (Form.PLAIN, Form.THREAD)
"""Forms whose blocks may be written anew."""
WHOLE = (Form.PROBE, Form.SYNCHRONISED, Form.THREAD, Form.PASSES)
"""Forms that stay one move, as they are."""
OWN_DISTANCES = (
    *(Form.CYCLE, Form.HOME, Form.PROBE, Form.SYNCHRONISED),
    *(Form.BLIND, Form.PASSES, Form.TILTED),
)
"""Forms whose blocks may stay in G91 where all others are written in G90."""


class FeedMode(IntEnum):
    """What a feed means: 1/min (G93), mm/min (G94) or mm per turn of the spindle (G95)."""

    INVERSE_TIME = 93
    PER_MINUTE = 94
    PER_TURN = 95


@dataclass(frozen=True, slots=True)
class Blocks:
    """How the blocks of a window are to be written, one value per line: it changes no position.

    first           line of the program, from 0, that the first value belongs to
    inch            lengths are written in inches (G20)
    incremental     axis words are distances from where the axis stands (G91)
    extruded        words of an extruder are (M83)
    absolute_centre I, J, K are the centre itself (G90.1)
    feed_mode       `FeedMode` in which the block is read
    leaves          whether after the block something else than this program may run: it ends, or
                    calls what may move axes
    apart           whether the block has a slash or a name and is joined with no other
    named           of which axes a block that moves in its own way (G28, G53) leads to a point of
                    the machine, also if they are there already: bit k stands for axis k
    uncompensated   cutter compensation has been resolved: G41, G42 and their D are left out
    """

    first: int
    inch: Flags
    incremental: Flags
    extruded: Flags
    absolute_centre: Flags
    feed_mode: Small
    leaves: Flags
    apart: Flags
    named: Ints
    uncompensated: bool = False


MODES = ("inch", "incremental", "extruded", "absolute_centre", "feed_mode")
BLOCK_MODES = (*MODES, "leaves", "apart", "named")


@dataclass(frozen=True, slots=True)
class Event:
    """Something done between moves: `row` is the move it stands before, `what` names it.

    `values` are its numbers, in seconds for a dwell. `line` counts source lines from 0. `within`:
    it is a part of a canned cycle, and no word of its block.
    """

    row: int
    what: str
    values: tuple[tuple[str, float], ...] = ()
    line: int = 0
    within: bool = False

    def at(self, row: int) -> Event:
        """Return the same event before another row: `replace` takes five times as long."""
        return Event(row, self.what, self.values, self.line, self.within)

    def __reduce__(self) -> tuple[type[Event], tuple[object, ...]]:
        """Go between processes by what it is made of: a dataclass of slots asks for its fields."""
        return Event, (self.row, self.what, self.values, self.line, self.within)


GROUND = "ground"
"""The number of a call that bores: how far its ground is below its end, in the unit of its block.

It is along the axis that the block names beside it, where what commands a machine asks for it.
"""


@dataclass(frozen=True, slots=True)
class Given:
    """A block that the user gives, to be written as it stands before the move `row`.

    `line` is the source line, from 0, of whose block it becomes a part: it stands between pieces of
    that. `moves`: it is the block of the move `row` itself.
    """

    row: int
    text: str
    line: int
    moves: bool = False


@dataclass(frozen=True)
class Toolpath(Tabled):
    """Rows of canonical moves.

    axes            letters of the columns of `end`, X Y Z first
    kind            (n,) `Kind`
    end             (n, axes) mm and degrees, positions as in `frames`; nan where unknown
    centre          (n, 3) mm, in the plane of the arc; nan for other moves
    sweep           (n,) rad, positive, full turns included; 0 for other moves
    plane           (n,) `Plane`
    feed, feed_mode (n,) mm/min, 1/min or mm/turn; nan where none is known; `FeedMode`
    frame           (n,) index into `frames`
    source          (n,) line of the program, from 0, that the move came from
    nth             (n,) which of the moves of its line it is, from 0
    form            (n,) `Form`
    side            (n,) cutter compensation: +1 left (G41), -1 right (G42), 0 none; `end` is then
                    the contour as programmed
    radius          (n,) mm, of the tool that is compensated; nan where it is not known
    lost            (n,) of which axes the position was lost before the move, by a tool change for
                    example: bit k stands for axis k
    control         (n, 2, 3) mm, the inner control points of splines; nan for other moves. The
                    outer ones are where the row starts and where it ends
    tool            (n, 3) unit vectors of the workpiece, from the tip to the holder at the end of
                    the move, where the program says them (G43.5); nan elsewhere
    entry           (axes,) position before the first row
    frames          the frames of the rows
    blocks          how the blocks the rows came from are to be written
    events          what happens between the moves
    given           blocks that stand as the user gives them; what they do is in rows and events
    slack           mm; how far a row may be from the curve it stands for
    first           the work offset from whose zero positions count
    folded          whether frames are folded into the words: codes that set them are not written
    joined          whether rows may stand for several: blocks left without one are not written
    left_out        letters of axes that are not written, because the machine has none such
    after_rapid     whether the move before the first row was a rapid
    leaving         whether a contour under cutter compensation was not left before the first row
    held            (axes,) where what was written before has left the axes, which may be elsewhere
                    than `entry` if a pass compensates; None: as the pass would write `entry`
    refit_centres   whether centres may be moved so that both ends are on the circle as formatted
    """

    words_of: ClassVar = {"kind": Kind, "form": Form, "feed_mode": FeedMode}
    axes: str
    kind: Small
    end: Floats
    centre: Floats
    sweep: Floats
    plane: Small
    feed: Floats
    feed_mode: Small
    frame: Ints
    source: Ints
    nth: Ints
    form: Small
    side: Small
    radius: Floats
    lost: Ints
    control: Floats
    tool: Floats
    entry: Floats
    frames: tuple[Frame, ...]
    blocks: Blocks
    events: tuple[Event, ...] = ()
    given: tuple[Given, ...] = ()
    slack: float = 0.0
    first: str = "G54"
    folded: bool = False
    joined: bool = False
    left_out: str = ""
    after_rapid: bool = False
    leaving: bool = False
    held: Floats | None = None
    refit_centres: bool = True

    def __post_init__(self) -> None:
        """Hold each column in its own type. Raises TypeError for one that would lose by it."""
        for name, kind in TYPES.items():
            column = getattr(self, name)
            if getattr(column, "dtype", None) != kind:
                column = typed(name, column, kind)
                object.__setattr__(self, name, column)
            column.flags.writeable = False

    def __len__(self) -> int:
        return len(self.kind)

    @property
    def start(self) -> Floats:
        """(n, axes) where each move starts."""
        start = np.empty_like(self.end)
        start[1:] = self.end[:-1]
        start[:1] = self.entry
        return self.with_lost(start)

    def with_lost(self, start: Floats) -> Floats:
        """Return positions (n, axes) before the rows, nan where the position was lost there."""
        if self.lost.any():
            for axis in range(len(self.axes)):
                start[(self.lost >> axis & 1) == 1, axis] = np.nan
        return start

    @property
    def plainly_framed(self) -> bool:
        """Whether the words of all rows are positions."""
        return all(frame.plain for frame in self.frames)

    @property
    def words(self) -> Floats:
        """(n, axes) the ends of the moves as the program says them, in the frame of each."""
        return self.in_frames(self.end)

    def in_frames(self, positions: Floats) -> Floats:
        """Return positions (n, axes), one a row, as words in the frames of the rows."""
        return self._by_frame(Frame.words, positions, -1.0)

    def from_frames(self, words: Floats) -> Floats:
        """Return words (n, axes), one a row in its frame, as positions."""
        return self._by_frame(Frame.positions, words, 1.0)

    def local(self, positions: Floats) -> Floats:
        """Return positions (n, 3), one a row, as coordinates in the frames of the rows."""
        return self._by_frame(Frame.local, positions, -1.0)

    def placed(self, local: Floats) -> Floats:
        """Return coordinates (n, 3), one a row in its frame, as positions."""
        return self._by_frame(Frame.placed, local, 1.0)

    def _by_frame(
        self, change: Callable[[Frame, Floats], Floats], values: Floats, sign: float
    ) -> Floats:
        return by_frame(change, self.frames, self.frame, values, sign)

    @property
    def mirrored(self) -> Flags:
        """(n,) whether left becomes right in the plane of the row, by its frame."""
        if all(frame.matrix is None for frame in self.frames):
            return np.zeros(len(self), np.bool_)
        mirrors = [[frame.mirrors(*plane.axes[:2]) for plane in Plane] for frame in self.frames]
        return np.array(mirrors, np.bool_)[self.frame, self.plane]

    @property
    def starts_known(self) -> Flags:
        """(n,) whether every axis that a move takes somewhere is known to start somewhere."""
        return np.asarray(~(np.isnan(self.start) & ~np.isnan(self.end)).any(axis=1))

    @cached_property
    def steps(self) -> Flags:
        """(n, axes) whether the words of a move, as it is to be written, are distances."""
        blocks, block = self.blocks, self.block
        by = [blocks.extruded if axis == EXTRUDER else blocks.incremental for axis in self.axes]
        return np.column_stack([each[block] for each in by])

    @cached_property
    def is_arc(self) -> Flags:
        """(n,) whether the move is an arc, read-only."""
        return read_only(self.kind >= Kind.ARC_CW)

    @property
    def sense(self) -> Floats:
        """(n,) +1 for counter-clockwise arcs, -1 for clockwise ones, 0 for other moves."""
        return np.where(self.is_arc, 2.0 * self.kind - 5.0, 0.0)

    @cached_property
    def has_arcs(self) -> bool:
        """Whether there is any arc."""
        return bool(self.is_arc.any())

    @cached_property
    def block(self) -> Ints:
        """(n,) index into `blocks` of each move, read-only."""
        return read_only(self.source - self.blocks.first)

    @cached_property
    def is_free(self) -> Flags:
        """(n,) whether the move may be written as other blocks than its own, read-only."""
        return read_only(one_of(self.form, FREE))

    @property
    def is_spline(self) -> Flags:
        """(n,) whether the move is a spline."""
        return np.asarray(self.form == Form.SPLINE)

    @cached_property
    def has_splines(self) -> bool:
        """Whether there is any spline."""
        return bool((self.form == Form.SPLINE).any())

    def refuse(self, code: str, rows: Ints, message: str, hint: str = "") -> InputError:
        """Return the error that refuses rows; the pipeline adds the text of their lines."""
        lines = distinct(self.source[rows])[:20] + 1
        return InputError(
            tuple(Diagnostic(code, message, Location("", int(line)), hint) for line in lines)
        )

    def replace(self, **changes: Any) -> Toolpath:
        """Return the path with some columns changed."""
        return dataclass_replace(self, **changes)

    def take(self, rows: Ints | Flags) -> Toolpath:
        """Return the path of some rows, in the order given; events and entry stay."""
        return self.replace(**{name: picked(getattr(self, name), rows) for name in COLUMNS})

    def check_rows(self, counts: Ints) -> Ints:
        """Return how often each row is to stand, if that is no more than a window may become."""
        if len(counts) and int(counts.sum()) > limits().rows:
            message = f"with this block a window of the program becomes {counts.sum()} moves"
            hint = how_to_raise("rows", int(counts.sum()))
            raise self.refuse("GX761", np.argsort(counts)[-1:], message, hint)
        return counts

    def with_rows(self, counts: Ints, **columns: Any) -> Toolpath:
        """Return the path with row i standing `counts[i]` times, and some columns new.

        Events and blocks that are given move along with the row they stand before. Of the rows that
        stand for one, only the first can start where the position was lost.
        """
        first = np.append(0, np.cumsum(self.check_rows(counts)))
        begin = first.tolist() if self.events or self.given else []
        events = tuple(event.at(begin[event.row]) for event in self.events)
        given = tuple(dataclass_replace(g, row=begin[g.row]) for g in self.given)
        row = np.repeat(np.arange(len(self)), counts)
        kept = {n: picked(getattr(self, n), row) for n in COLUMNS if n not in columns}
        if kept["lost"].any():
            kept["lost"] = np.where(np.arange(len(row)) == first[row], kept["lost"], 0)
        return self.replace(**kept, **columns, events=events, given=given)
