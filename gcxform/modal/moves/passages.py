"""Runs of stretches whose frames hang on their own words alone: read in columns, all at once.

Programs change their frame or go home in thousands of blocks: by G54, M6 and G43.1, by G53 and G28
under G90. What such a block does hangs on its words, on the modes, and on what was in force when
the run began, and not on where the axes stand; so frames are made once for all blocks that ask for
the same, and where the axes stand is filled forward through the whole run. Any other block ends a
run. It is done by itself, as these would be (`gcxform/modal/frames/track.py` and
`gcxform/modal/moves/home.py`), to the same bits: `tests/properties/test_roads.py`.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.modal.columns import fill
from gcxform.modal.frame_state import FrameState, replace
from gcxform.modal.frames.act import letters_of
from gcxform.modal.frames.tool_lengths import in_spindle, length_moves, name_by_value
from gcxform.modal.meaning.meaning import Act, Meaning
from gcxform.modal.moves.cycle_patterns import Drilling
from gcxform.modal.moves.home import is_rapid, warn_of_plunge
from gcxform.modal.moves.rows import Rows, Stretches
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.system.distinct import distinct
from gcxform.toolpath.columns import column_major
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Form, Kind
from gcxform.values import dataclass

FEW = 12  # stretches of which a run takes longer than each by itself
OTHER, MOVES, WORK, TOOL, VECTOR, MACHINE, HOME = range(7)
"""What begins a stretch: nothing but moves, an act of one of the kinds below, or another."""
KINDS = {
    "work": WORK,
    "change-tool": TOOL,
    "length-vector": VECTOR,
    "machine": MACHINE,
    "home": HOME,
}


@dataclass(frozen=True, slots=True)
class Run:
    """A run of stretches: their first lines (n,), what begins each, and the line behind the last.

    `shape` (n,) are the shapes of those first lines.
    """

    first: Ints
    kind: Ints
    shape: Ints
    end: int

    def lines(self, kind: int) -> Ints:
        """Return the lines, counted from the first, that are of a kind."""
        return np.asarray(self.first[self.kind == kind] - self.first[0])


@dataclass(frozen=True, slots=True)
class Framed:
    """The frames of a run: the state behind it, and the frames of its stretches.

    `number` (n,) are those of the stretches, counted from the frame in force before, and `fresh`
    the frames with the numbers 1, 2 and so on; `shift` (n, axes) is by what each shifts.
    """

    after: FrameState
    fresh: list[Frame]
    number: Ints
    shift: Floats


class Passages:
    """The runs of one window; `moving` (lines,) are the lines that are one plain move."""

    def __init__(self, drilling: Drilling, of: Stretches, moving: Flags) -> None:
        self.track, self.lines, self.modes = drilling.track, drilling.lines, drilling.modes
        self.drilling, self.moving, self.borders = drilling, moving, of.borders
        self.edges = np.append([first for first, _ in of.borders], of.borders[-1][1])
        self.words = [
            (k, word) for k, a in enumerate(self.track.axes) if (word := self.track.column(a))
        ]
        self.kind = self._kinds(of)
        broken = np.append(np.flatnonzero(self.kind == OTHER), len(self.kind))
        self.until = broken[np.searchsorted(broken, np.arange(len(self.kind)))].tolist()
        self._refused = 0
        self.own: list[Rows] = []
        self.plain: list[tuple[Ints, Floats, Ints]] = []

    # --- what may be in a run ---

    def _kinds(self, of: Stretches) -> Ints:
        """Return what begins each stretch; OTHER where anything in it is of another kind."""
        acting = np.zeros(self.lines.live, np.bool_)
        acting[[*of.acts]] = True
        first = self.edges[:-1]
        shape = self.lines.shape[first]
        by_shape = np.full(int(shape.max()) + 1, OTHER)
        for number in distinct(shape[acting[first]]).tolist():
            by_shape[number] = self._kind_of(self.lines.table.meanings[number])
        kind = np.where(acting[first], by_shape[shape], MOVES)
        barred = self._barred()
        barred[[*of.resets, *of.singles]] = True
        until = np.append(0, np.cumsum(barred))
        return np.where(until[self.edges[1:]] > until[first], OTHER, self._named(kind, first))

    def _kind_of(self, meaning: Meaning) -> int:
        """Return what a line does to the frame, or by itself, that does one of these things."""
        if len(meaning.acts) != 1:
            return OTHER
        (act,) = meaning.acts
        dialect = self.track.dialect
        kind, named = KINDS.get(act.name, OTHER), {address for address, _ in act.slots}
        if kind == VECTOR:
            plain = not (dialect.point_rule.required or length_moves(dialect, self.lines.reading))
            return kind if plain and named <= {*dialect.tool_rule.length_axes} & {*"XYZ"} else OTHER
        if kind == WORK and letters_of(dialect, act.code):
            return OTHER
        if kind == HOME and dialect.motion_rule.g28_ends_length:
            return OTHER
        return OTHER if kind != MACHINE and named else kind

    def _named(self, kind: Ints, first: Ints) -> Ints:
        """Return the kinds without lines to the machine that name no axis, or go there by no line.

        G53 moves in rapid on some controls whatever is in force, which is refused.
        """
        motion = self.modes.motion[first]
        straight = (motion == Kind.RAPID) | ((motion == Kind.LINE) & (not is_rapid(self.track)))
        fit = self.track.worded[first] & ((kind == HOME) | straight)
        return np.where((kind >= MACHINE) & ~fit, OTHER, kind)

    def _barred(self) -> Flags:
        """Return the lines that are in no run: of cycles, by steps, or of unknown length."""
        modes = self.modes
        barred = self.track.worded & (modes.incremental | (modes.extruded == 1))
        barred |= self.drilling.calls | (modes.cycle != CYCLE_OFF)
        for _, (value, has) in self.words:
            barred |= has & ~np.isfinite(value)
        return np.asarray(barred)

    # --- runs ---

    def over(self) -> Iterator[tuple[int, int]]:
        """Yield the stretches that are in no run, and do each run when it is its turn."""
        n = 0
        while n < len(self.borders):
            behind = self._over(n)
            if behind == n:
                yield self.borders[n]
            n = max(behind, n + 1)

    def _over(self, n: int) -> int:
        """Return the stretch behind the run that begins at one, which is done; itself if none."""
        last: int = self.until[n]
        if last - n < FEW or n < self._refused or not self._ready():
            return n
        first = self.edges[n:last]
        run = Run(first, self.kind[n:last], self.lines.shape[first], int(self.edges[last]))
        framed, ways = self._framed(run), self._ways(run)
        if framed is None or ways is None:
            self._refused = last
            return n
        self._move(run, framed, *ways)
        self.track.state.frames = framed.after
        self.track.frames += framed.fresh
        self._leave_cycles(run)
        return last

    def _leave_cycles(self, run: Run) -> None:
        """Forget what cycles keep, as each stretch of a run would by itself."""
        own = run.kind >= MACHINE
        if own.any():
            self.drilling.moved()
        for line in run.first[~own][:1].tolist():
            self.drilling.follows(line, line + 1)

    def _ready(self) -> bool:
        """Whether it is known which work offset is in force, and how long the tool is."""
        frames = self.track.state.frames
        return frames.known and not frames.unsettled and all(map(isfinite, frames.tool))

    # --- frames ---

    def _framed(self, run: Run) -> Framed | None:
        """Return the frames of a run; None where one does more than shift by what is known."""
        base = self.track.state.frames
        works, named = self._works(run)
        tools = self._tools(run)
        valued = np.logical_or.accumulate(run.kind == VECTOR)
        if not np.isfinite(tools).all():
            return None
        code = works * 2 + valued
        for column in tools.T:
            values = distinct(column)
            code = code * len(values) + np.searchsorted(values, column)
        nth, at = _first_of_each(code)
        states = [
            replace(
                base,
                work=named[works[row]],
                tool=tuple(tools[row].tolist()),
                tool_name=name_by_value(base.tool_name) if valued[row] else base.tool_name,
            )
            for row in at.tolist()
        ]
        return self._numbered(run, states, nth, tools)

    def _numbered(
        self, run: Run, states: list[FrameState], nth: Ints, tools: Floats
    ) -> Framed | None:
        """Return the frames of a run by the states of its stretches: state `nth` of each."""
        before = self.track.frame
        frames = [state.frame() for state in states]
        if any(not f.shifts_only or f.polar or f.origin != before.origin for f in frames):
            return None
        same: dict[Frame, int] = {before: 0}
        alike = np.array([same.setdefault(frame, len(same)) for frame in frames])[nth]
        new = alike != np.append(0, alike[:-1])
        shifts = np.array([frame.added for frame in (before, *frames)])
        return Framed(
            self._behind(run, states[nth[-1]], tools),
            [frames[n] for n in nth[new].tolist()],
            np.cumsum(new),
            shifts[fill(nth + 1, new, 0)],
        )

    def _works(self, run: Run) -> tuple[Ints, list[str]]:
        """Return which work offset is in force in each stretch, and their names."""
        rule, names = self.track.dialect.offset_rule, {self.track.state.frames.work: 0}
        found, stated = np.zeros(len(run.kind), np.int64), run.kind == WORK
        for here, act in self._acts(run, WORK):
            found[here] = names.setdefault(rule.names.get(act.code, act.code), len(names))
        return fill(found, stated, 0), [*names]

    def _tools(self, run: Run) -> Floats:
        """Return the tool vector (n, 3) in force in each stretch, mm."""
        tools, named = np.zeros((len(run.kind), 3)), np.zeros((len(run.kind), 3), np.bool_)
        for here, act in self._acts(run, VECTOR):
            line = run.first[here]
            unit = np.where(self.modes.inch[line], INCH, 1.0)
            for axis, slot in act.slots:
                k = "XYZ".index(axis)
                length = self.lines.window.value[self.lines.first[line] + slot] * unit
                tools[here, k] = length + 0.0  # as `FrameState.with_tool` has it
                named[here, k] = True
        for k, before in enumerate(self.track.state.frames.tool):
            tools[:, k] = fill(tools[:, k], named[:, k], before)
        return tools

    def _acts(self, run: Run, kind: int) -> Iterator[tuple[Ints, Act]]:
        """Yield the stretches of a run that an act of a kind begins, one spelling after another."""
        stretches = np.flatnonzero(run.kind == kind)
        shape = run.shape[stretches]
        for number in distinct(shape).tolist():
            yield stretches[shape == number], self.lines.table.meanings[number].acts[0]

    def _behind(self, run: Run, state: FrameState, tools: Floats) -> FrameState:
        """Return the state behind a run; note the tool vectors that its lines put in force."""
        valued, changes = np.flatnonzero(run.kind == VECTOR), run.first[run.kind == TOOL]
        vectors = [(x, y, z) for x, y, z in tools[valued].tolist()]
        self.track.lengths.update(zip(run.first[valued].tolist(), vectors, strict=True))
        if vectors:
            state = replace(state, tool=vectors[-1])
        if not len(changes):
            return state
        number = in_spindle(float(self.modes.tool[changes[-1]]))
        return replace(state, in_spindle=number, changes=state.changes + len(changes))

    # --- places ---

    def _ways(self, run: Run) -> tuple[Floats, Floats] | None:
        """Return the machine's zero (axes,), and where each line of G28 goes (m, axes), positions.

        None where that is not known, or positions count from elsewhere than the machine's do.
        """
        track, frames = self.track, self.track.state.frames
        zero = np.array(frames.machine)
        goes = np.full((len(run.kind), len(track.axes)), np.nan)
        if not (run.kind >= MACHINE).any():
            return zero, goes[:0]
        for here, act in self._acts(run, HOME):
            place = frames.homes.get(act.code, {})
            goes[here] = zero + [place.get(axis, np.nan) for axis in track.axes]
        goes = goes[run.kind == HOME]
        lines, homes = run.first[run.kind >= MACHINE], run.first[run.kind == HOME]
        for k, (_, has) in self.words:
            lost = np.isnan(goes[:, k])[has[homes]].any()
            if lost or (has[lines].any() and not isfinite(zero[k])):
                return None
        return (zero, goes) if {*track.frame.origin} == {frames.first} else None

    def _move(self, run: Run, framed: Framed, zero: Floats, goes: Floats) -> None:
        """Note the rows of a run, and leave the axes where it ends."""
        track, start = self.track, int(run.first[0])
        span = slice(start, run.end)
        stretch = np.repeat(np.arange(len(run.first)), np.diff(run.first, append=run.end))
        entry = track.state.position
        after = column_major(run.end - start, len(entry))
        machine, home = run.lines(MACHINE), run.lines(HOME)
        way = column_major(len(home), len(entry))
        after[:], way[:] = entry, entry
        for k, (value, has) in self.words:
            place = value[span] + framed.shift[stretch, k]
            through = place[home]
            place[machine] = zero[k] + value[span][machine]
            place[home] = goes[:, k]
            after[:, k] = fill(place, has[span], entry[k])
            before = np.append(entry[k], after[:, k])[home]
            way[:, k] = np.where(has[span][home], through, before)
        frame = framed.number[stretch] + len(track.frames) - 1
        self._warn(run, way, np.append(entry[2], after[:, 2])[home])
        line = np.flatnonzero(self.moving[span])
        self.plain.append((line + start, after[line], frame[line]))
        self._go(machine + start, self.modes.motion, after[machine], frame[machine])
        self._go_home(home + start, way, after[home], frame[home])
        track.state.position = after[-1].copy()

    def _go(self, line: Ints, kind: Small, end: Floats, frame: Ints) -> None:
        """Note moves to places of the machine, one a line."""
        if len(line):
            nth, form = np.zeros(len(line), np.int64), np.full(len(line), Form.MACHINE, np.int8)
            self.own.append(Rows(line, kind[line], end, nth, form, frame))

    def _go_home(self, line: Ints, way: Floats, end: Floats, frame: Ints) -> None:
        """Note moves over a point to home, two a line."""
        if len(line):
            ends = np.stack([way, end], axis=1).reshape(-1, way.shape[1])
            kind, form = (np.full(len(ends), n, np.int8) for n in (Kind.RAPID, Form.HOME))
            nth = np.arange(len(ends)) % 2
            self.own.append(Rows(np.repeat(line, 2), kind, ends, nth, form, np.repeat(frame, 2)))

    def _warn(self, run: Run, way: Floats, stands: Floats) -> None:
        """Warn of ways home that lead down first."""
        line, shape = (column[run.kind == HOME] for column in (run.first, run.shape))
        for n in np.flatnonzero(way[:, 2] < stands).tolist():
            code = self.lines.table.meanings[int(shape[n])].acts[0].code
            warn_of_plunge(self.track, int(line[n]), code, float(stands[n]), float(way[n, 2]))


def _first_of_each(values: Ints) -> tuple[Ints, Ints]:
    """Return which of the different values each is, by where they come first, and where that is."""
    kinds = distinct(values)
    nth = np.searchsorted(kinds, values)
    at = np.empty(len(kinds), np.int64)
    at[nth[::-1]] = np.arange(len(values))[::-1]
    order = np.argsort(at)
    rank = np.empty(len(kinds), np.int64)
    rank[order] = np.arange(len(kinds))
    return rank[nth], at[order]
