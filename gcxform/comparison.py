"""`compare`: how two programs differ, in path, feed and events, however they are written."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import zip_longest

import numpy as np
from numpy.typing import NDArray

from gcxform.api import Program
from gcxform.config import arguments
from gcxform.contract.passes import Pass, PassContext
from gcxform.deviations.matching import Matching, Pieces, cut, match
from gcxform.deviations.paired_pieces import known_alone, measure
from gcxform.diagnostics import InputError
from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import LINEAR, Dialect
from gcxform.machine.machine import Machine
from gcxform.modal.meaning.meaning import FRAMING, LENGTHENED
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.toolpath.circles import radius_and_angle
from gcxform.toolpath.path import (
    WHOLE,
    Event,
    FeedMode,
    Form,
    Kind,
    Toolpath,
)
from gcxform.toolpath.splines import straightened
from gcxform.values import dataclass

STRAIGHT = 1e-5  # mm; lines that stand for splines are so near
TOLERANCE = 0.001  # mm: twice what rounding an axis to three decimals can do
REACH = 1.0  # mm; what is farther apart is not taken for the same place
FEED_SLIP = 1e-3  # of a feed, or of the time of a move in G93
TIME_SLIP = 1e-3  # s, of a dwell


@dataclass(frozen=True)
class Difference:
    """Something other than the path that differs; lines of A and B from 1, 0 for none."""

    what: str
    line_a: int
    line_b: int


@dataclass(frozen=True)
class Comparison:
    """How two programs differ.

    deviation       largest distance of the two paths, mm; inf if they part
    line_a, line_b  where that is, from 1; 0 if there are no moves
    angle           largest difference of a rotary axis, degrees
    tolerance       mm and degrees that are still the same
    matched         pairs of moves, or of their parts, that were compared
    ends_only       how many of them only at their ends: rapids, and from an unknown start
    parted          lines of A and B from which nothing fits, None if everything does
    spared          rapids of B that are left to where the machine goes, off by up to `spared_by`
                    (mm) if that is known; they are compared by what the control is told
    places          axes whose place only one program knows, where it first is so: their deviation
                    there is not known, and not counted
    """

    deviation: float
    line_a: int
    line_b: int
    angle: float
    tolerance: float
    matched: int
    ends_only: int
    parted: tuple[int, int] | None = None
    feeds: tuple[Difference, ...] = ()
    events: tuple[Difference, ...] = ()
    spared: int = 0
    spared_by: float = 0.0
    places: tuple[Difference, ...] = ()

    @property
    def same(self) -> bool:
        """Whether path, feeds and events are the same within the tolerance."""
        near = self.deviation <= self.tolerance and self.angle <= self.tolerance
        near = near and self.parted is None and not self.places
        return near and not self.feeds and not self.events


def compare(
    a: Program,
    b: Program,
    tolerance: float = TOLERANCE,
    through: Pass | None = None,
    machine: Machine | None = None,
) -> Comparison:
    """Return how program B differs from program A, in whatever dialects, cut wherever they are.

    With `through`, B holds commands that came from this pass, and what the machine does with them
    is compared. Raises InputError where one of them is refused.
    """
    for one in (a, b):
        arguments.instance("program", one, Program, "a program, as `read` returns it")
    tolerance = arguments.positive("tolerance", tolerance)
    path_a, path_b = same_axes(a.curved, b.curved)
    left = _Left(path_b, path_b, np.zeros(len(path_b), np.bool_))
    if through is not None:
        numbers = b.dialect.numbers
        undone = _undone(b, path_b, through, PassContext(a.dialect, b.dialect, numbers, machine))
        left = _Left.of(path_b, undone, through)
        path_b = left.path
    path_a, path_b = (straightened(path, STRAIGHT) for path in (path_a, path_b))
    matching = match(path_a, path_b, tolerance, max(REACH, tolerance), partly=True)
    found = measure(path_a, path_b, matching, partly=True)
    if len(path_b) == len(left.path) and len(matching.a) and through is not None:
        found = replace(found, distance=np.maximum(found.distance, left.begins(path_a, matching)))
    worst = int(np.argmax(found.distance)) if len(matching.a) else -1
    compared = Comparison(
        np.inf if matching.parted else float(found.distance.max(initial=0.0)),
        _line(path_a, matching.a, worst),
        _line(path_b, matching.b, worst),
        float(found.angle.max(initial=0.0)),
        tolerance,
        len(matching.a),
        int(found.ends_only.sum()),
        _parted(path_a, path_b, matching),
        tuple(_feeds(path_a, path_b, matching, tolerance)),
        tuple(_events((path_a, a.dialect), (path_b, b.dialect), matching, tolerance)),
        int(left.rows.sum()),
        left.size,
        tuple(_places(path_a, path_b, matching)),
    )
    return _in_lines_of(a, b, compared)


def _undone(b: Program, path: Toolpath, through: Pass, context: PassContext) -> Toolpath:
    """Return what the machine does with a program, whose path is given. Raises GcxformError."""
    through.begin(context)
    try:
        return through.undo(path, context)
    except InputError as error:
        raise b.located(error) from None


@dataclass(frozen=True)
class _Left:
    """A path behind a pass, of which some rapids are left to where the machine goes.

    path    where the machine goes, but where it is told to go at the end of these rapids
    actual  where the machine goes
    rows    (n,) these rapids
    """

    path: Toolpath
    actual: Toolpath
    rows: Flags

    @classmethod
    def of(cls, told: Toolpath, actual: Toolpath, through: Pass) -> _Left:
        """Return what the machine does with a path that the control is told."""
        spares = through.demands.spares
        if spares is None:
            return cls(actual, actual, np.zeros(len(actual), np.bool_))
        mine, rows = np.flatnonzero(spares(told)), spares(actual)
        if len(mine) != np.count_nonzero(rows):
            return cls(actual, actual, np.zeros(len(actual), np.bool_))
        end = actual.end.copy(order="F")
        for row, other in zip(mine.tolist(), np.flatnonzero(rows).tolist(), strict=True):
            before = end[other - 1] if other else actual.entry
            rests = told.end[row] == told.start[row]
            end[other] = np.where(rests, before, told.end[row])
        return cls(actual.replace(end=end), actual, rows)

    @property
    def size(self) -> float:
        """How far (mm) the machine is off at most where they end, as far as that is known."""
        off = np.nan_to_num((self.actual.end - self.path.end)[self.rows, :3])
        return float(np.sqrt((off**2).sum(axis=1)).max(initial=0.0))

    def begins(self, other: Toolpath, matching: Matching) -> Floats:
        """Return how far (mm) feed moves begin from where those of another path do (pieces,).

        Only what begins behind these rapids, or with the program, is looked at.
        """
        row, fresh = matching.b.row, matching.b.low == 0.0
        behind = np.append(True, self.rows[:-1])[row] if len(self.rows) else fresh
        feeds = self.path.kind[row] != Kind.RAPID
        gap = (self.actual.start[row] - cut(other, matching.a).start)[:, :3]
        gap = np.sqrt((np.nan_to_num(gap) ** 2).sum(axis=1))
        return np.where(fresh & behind & feeds, gap, 0.0)


def _in_lines_of(a: Program, b: Program, found: Comparison) -> Comparison:
    """Return a comparison of executed blocks with the lines of the programs."""

    def moved(difference: Difference) -> Difference:
        lines = a.line_of(difference.line_a), b.line_of(difference.line_b)
        return replace(difference, line_a=lines[0], line_b=lines[1])

    parted = found.parted and (a.line_of(found.parted[0]), b.line_of(found.parted[1]))
    return replace(
        found,
        line_a=a.line_of(found.line_a),
        line_b=b.line_of(found.line_b),
        parted=parted,
        feeds=tuple(map(moved, found.feeds)),
        events=tuple(map(moved, found.events)),
        places=tuple(map(moved, found.places)),
    )


def same_axes(a: Toolpath, b: Toolpath) -> tuple[Toolpath, Toolpath]:
    """Return the paths over the axes that any of them has; the position of others is unknown."""
    axes = a.axes + "".join(axis for axis in b.axes if axis not in a.axes)
    return _over(a, axes), _over(b, axes)


def _over(path: Toolpath, axes: str) -> Toolpath:
    if path.axes == axes:
        return path
    end, entry = np.full((len(path), len(axes)), np.nan), np.full(len(axes), np.nan)
    for k, axis in enumerate(axes):
        if axis in path.axes:
            end[:, k] = path.end[:, path.axes.index(axis)]
            entry[k] = path.entry[path.axes.index(axis)]
    return path.replace(axes=axes, end=end, entry=entry)


def _line(path: Toolpath, pieces: Pieces, index: int) -> int:
    """Return the line, from 1, that a piece came from; 0 if there is none."""
    return int(path.source[pieces.row[index]]) + 1 if 0 <= index < len(pieces) else 0


def _parted(a: Toolpath, b: Toolpath, matching: Matching) -> tuple[int, int] | None:
    if matching.parted is None:
        return None
    one, other = (
        int(path.source[row]) + 1 if row >= 0 else 0
        for path, row in zip((a, b), matching.parted, strict=True)
    )
    return one, other


def _places(a: Toolpath, b: Toolpath, matching: Matching) -> Iterator[Difference]:
    """Return the axes whose place only one path knows, where it first is so."""
    alone = known_alone(a, b, matching)
    for axis, first in zip(a.axes, (alone != 0).argmax(axis=0) if len(alone) else (), strict=False):
        if who := int(alone[first, a.axes.index(axis)]):
            lines = _line(a, matching.a, int(first)), _line(b, matching.b, int(first))
            yield Difference(f"only {'AB'[who - 1]} says where {axis} is", *lines)


@dataclass(frozen=True)
class _Manner:
    """How pieces are travelled: feed (in G93 that of the whole piece), feed mode, work offset.

    `tied` is the form of what is tied to the spindle or to a probe, and that of plain moves else.
    """

    feed: Floats
    mode: Small
    origin: NDArray[np.str_]
    rapid: Flags
    side: Small
    radius: Floats
    tied: Small
    line: Ints

    @classmethod
    def of(cls, path: Toolpath, pieces: Pieces) -> _Manner:
        row = pieces.row
        mode, rapid = path.feed_mode[row], path.kind[row] == Kind.RAPID
        part = np.where(mode == FeedMode.INVERSE_TIME, pieces.high - pieces.low, 1.0)
        feed = np.divide(path.feed[row], part, out=np.full(len(row), np.inf), where=part > 0)
        origins = np.array([", ".join(dict.fromkeys(frame.origin)) for frame in path.frames])
        side, radius = path.side[row], np.nan_to_num(path.radius[row])
        origin, form = origins[path.frame[row]], path.form[row]
        tied = np.where(np.isin(form, WHOLE), form, np.int8(Form.PLAIN))
        return cls(feed, mode, origin, rapid, side, radius, tied, path.source[row] + 1)

    def alike(self, other: _Manner, at: Ints) -> Flags:
        """Return whether pieces `at` are travelled as the pieces of the other path."""
        feed, mode = self.feed[at], self.mode[at]
        with np.errstate(invalid="ignore"):
            near = (feed == other.feed) | (np.abs(feed - other.feed) <= FEED_SLIP * np.abs(feed))
        same = self.rapid[at] | (near & (mode == other.mode))
        same &= (self.side[at] == other.side) & (self.radius[at] == other.radius)
        same &= self.tied[at] == other.tied
        return np.asarray(same & (self.origin[at] == other.origin))


def _feeds(a: Toolpath, b: Toolpath, matching: Matching, tolerance: float) -> list[Difference]:
    """Return where feeds, feed modes or work offsets differ, once for each line of A.

    A piece no longer than the tolerance may as well be travelled as its neighbours are.
    """
    one, other = _Manner.of(a, matching.a), _Manner.of(b, matching.b)
    short = np.minimum(_lengths(a, matching.a), _lengths(b, matching.b)) <= tolerance
    here = np.arange(len(short))
    before, after = np.maximum(here - 1, 0), np.minimum(here + 1, len(here) - 1)
    same = one.alike(other, here)
    same |= short & (one.alike(other, before) | one.alike(other, after))
    found: dict[int, Difference] = {}
    for k in np.flatnonzero(~same).tolist():
        lines = int(one.line[k]), int(other.line[k])
        found.setdefault(lines[0], Difference(_changed(one, other, k), *lines))
    return list(found.values())


def _changed(one: _Manner, other: _Manner, k: int) -> str:
    """Return in what a piece is travelled otherwise."""
    if one.origin[k] != other.origin[k]:
        return f"{one.origin[k]} became {other.origin[k]}"
    if (one.side[k], one.radius[k]) != (other.side[k], other.radius[k]):
        return "cutter compensation is another"
    if one.tied[k] != other.tied[k]:
        names = (Form(int(form)).name.lower() for form in (one.tied[k], other.tied[k]))
        return " became ".join(f"a {name} move" for name in names)
    if one.mode[k] != other.mode[k]:
        return f"feed mode G{one.mode[k]} became G{other.mode[k]}"
    return f"feed {one.feed[k]:g} became {other.feed[k]:g}"


# --- events ---

Side = tuple[Toolpath, type[Dialect]]


def _events(a: Side, b: Side, matching: Matching, tolerance: float) -> list[Difference]:
    """Return the first event that differs in name, numbers or place, and nothing after it."""
    ours, theirs = _told(a, b[1]), _told(b, a[1])
    lengths = _lengths(a[0], matching.a)
    for one, other in zip_longest(ours, theirs):
        text = _difference(one, other)
        if not text and one and other and matching.parted is None:
            places = _place(matching.a, one.row), _place(matching.b, other.row)
            between = lengths[min(places) : max(places)]
            text = f"{_shown(one)} stands elsewhere" if between.sum() > 2 * tolerance else ""
        if text:
            lines = (event.line + 1 if event else 0 for event in (one, other))
            return [Difference(text, *lines)]
    return []


def _told(side: Side, other: type[Dialect]) -> list[Event]:
    """Return the events, without those that the other dialect reads as modes.

    What shifts coordinates by known amounts is seen in the positions, and needs no telling; nor do
    tool lengths, between controls that call them in ways of their own. Where the other control
    follows no tip, the code that leaves it says nothing.
    """
    path, own = side
    plainly = all(set(frame.origin) == {path.first} for frame in path.frames)
    modal = (c for c, what in other.codes.items() if what.effect is Effect.MODAL and not what.takes)
    silent = {*modal}
    if own.tip_rule.switches != other.tip_rule.switches:
        silent |= {code for act, code in own.tip_rule.switches.items() if act == "tip-off"}
    if plainly:
        acts = FRAMING if own is other else FRAMING | LENGTHENED
        silent |= {code for code, what in own.codes.items() if what.act in acts}
    return [event for event in path.events if event.what not in silent]


def _difference(one: Event | None, other: Event | None) -> str:
    """Return in what two events differ."""
    if one is None or other is None:
        lone = one or other
        return f"{_shown(lone)} is only in {'A' if one else 'B'}" if lone else ""
    slip = TIME_SLIP if one.what == "DWELL" else 1e-9
    same = one.what == other.what and len(one.values) == len(other.values)
    same = same and all(
        p[0] == q[0] and abs(p[1] - q[1]) <= slip
        for p, q in zip(one.values, other.values, strict=True)
    )
    return "" if same else f"{_shown(one)} became {_shown(other)}"


def _shown(event: Event) -> str:
    """Return an event as a person writes it."""
    if event.what == "DWELL":
        return "dwell " + " ".join(f"{value:g} {unit}" for unit, value in event.values)
    words = [f"{name}{value:g}" for name, value in event.values]
    return " ".join(words if len(event.what) == 1 and words else [event.what, *words])


def _place(pieces: Pieces, row: int) -> int:
    """Return before which piece an event stands that stands before a row."""
    return int(np.searchsorted(pieces.row, row))


def _lengths(path: Toolpath, pieces: Pieces) -> Floats:
    """Return how far the pieces go: mm, or degrees where only rotary axes turn."""
    linear = [k for k, axis in enumerate(path.axes) if axis in LINEAR]
    way = np.nan_to_num(path.end - path.start)
    length = np.maximum(np.sqrt((way[:, linear] ** 2).sum(axis=1)), np.abs(way).max(axis=1))
    if path.has_arcs:
        arcs = np.flatnonzero(path.is_arc)
        first, last, _ = radius_and_angle(path, arcs)
        length[arcs] = np.maximum(length[arcs], (first + last) / 2 * path.sweep[arcs])
    return np.asarray((pieces.high - pieces.low) * length[pieces.row])
