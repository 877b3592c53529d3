"""Where the axes stand, and in which frame, from stretch to stretch of a window.

A stretch is a run of lines in one frame. Within it every axis is one column, filled forward; the
block that begins a stretch may act on the frame first.

A program that never shifts coordinates is one stretch. Those in G90 whose frames only shift are
filled together (`gcxform/modal/frames/shifted.py`), the others one by one. Where M codes switch
whether the control follows the tip, X, Y and Z are let go of if one comes while axes are turned:
nothing can go wrong before the program says them again.
"""

from __future__ import annotations

from functools import cached_property
from math import isfinite, isnan, remainder

import numpy as np

from gcxform.dialect.dialect import EXTRUDER, INCH, LINEAR, ROTARY
from gcxform.modal.columns import fill, with_increments
from gcxform.modal.findings import Findings
from gcxform.modal.frame_state import FrameState
from gcxform.modal.frames.act import ActError, Asked
from gcxform.modal.frames.acts import ACTS, done
from gcxform.modal.frames.followed_tips import turned_tip
from gcxform.modal.frames.planes import out_of_plane
from gcxform.modal.frames.tool_lengths import LENGTH_STEP, length_moves
from gcxform.modal.frames.transforms import turned_by
from gcxform.modal.line_notes import WayHome, call_of
from gcxform.modal.lines import LENGTHS, Lines
from gcxform.modal.meaning.meaning import LENGTHENED, SWITCHED, ZEROING, Act
from gcxform.modal.state import Modes
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct, union
from gcxform.toolpath.columns import constant
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Plane
from gcxform.values import dataclass

ALONG_Z = "tools whose lengths are not known have them along Z alone: there is no tool table"
LOST_BY_TURN = frozenset({"rotate", "no-rotate", "mirror", "no-mirror", "polar", "no-polar"})
FRAMELESS = frozenset({"change-tool", "set-tool", "user-code", "store-home"})
UNFOLLOWED = frozenset({"plane", "tip"})
SPATIAL = 0b111  # X, Y and Z as bits
PLANES = tuple(Plane)
NOTHING: dict[str, float] = {}
WHOLE_TURN = 360.0  # degrees
NOISE = 1e-9  # degrees; what steps of G91 may leave of their sum

LEFT = np.inf
"""The position of an axis that is where a control has left it that turns the tool along vectors.

No word has this value. A pass that chooses the angles instead of the control knows where it is.
"""


@dataclass(frozen=True, slots=True)
class Break:
    """From a line on the position of some axes is not known: bit k of `axes` stands for axis k."""

    line: int
    axes: int


class Track:
    """Follows position and frame; `state.position` and `state.frames` are left up to date.

    `may_step` (lines,) are the moves that may go by distances from where it is not known; `zeroed`,
    `homed`, `ways_open` and `lengths` are as in `Interpreted`.
    """

    def __init__(self, lines: Lines, modes: Modes, axes: str) -> None:
        self.lines = lines
        self.modes = modes
        self.axes = axes
        self.state = lines.state
        self.dialect = lines.dialect
        self.findings = lines.findings
        self.entry = lines.state.position.copy()
        self.frames: list[Frame] = [self.state.frames.frame()]
        if self.state.row_frame not in (None, self.frame):
            self.frames.insert(0, self.state.row_frame)
        self.breaks: list[Break] = []
        self.zeroed: list[tuple[int, FrameState]] = []
        self.homed: dict[int, WayHome] = {}
        self.ways_open: dict[int, str] = {}
        self.lengths: dict[int, tuple[float, float, float]] = {}
        self._columns: dict[str, tuple[Floats, Flags] | None] = {}
        self.may_step = np.zeros(lines.live, np.bool_)

    @property
    def frame(self) -> Frame:
        """The frame in force."""
        return self.frames[-1]

    def column(self, axis: str) -> tuple[Floats, Flags] | None:
        """Return value (mm, deg) and presence of an axis word by line; None if no line has it."""
        if axis not in self._columns:
            word = self.lines.word(axis)
            if word is not None and axis in LENGTHS and self.modes.inch.any():
                word = np.where(self.modes.inch, word[0] * INCH, word[0]), word[1]
            self._columns[axis] = word
        return self._columns[axis]

    def words_on(self, line: int) -> dict[str, float]:
        """Return the axis words of a line, mm and degrees."""
        return {axis: float(value[line]) for axis, (value, has) in self._named_axes if has[line]}

    @cached_property
    def _named_axes(self) -> list[tuple[str, tuple[Floats, Flags]]]:
        """The columns of axes that any line names, in the order of the axes."""
        return [(axis, word) for axis in self.axes if (word := self.column(axis)) is not None]

    # --- acts ---

    def act(self, line: int) -> None:
        """Do what a line does to the frame."""
        meaning = self.lines.table.meanings[int(self.lines.shape[line])]
        for act in meaning.acts:
            if act.name in ACTS:
                try:
                    self._one_act(act, line)
                    if act.name in LENGTHENED:
                        self.lengths[line] = self.state.frames.tool
                except ActError as error:
                    self.state.frames = out_of_plane(self.state.frames, act.name)
                    self.findings.add(line, error.code, error.message, act.code[0], error.hint)

    def _one_act(self, act: Act, line: int) -> None:
        before, old = self.state.frames, self.frame
        self.state.frames = frames = done(act.name, before, self._asked(act, line))
        if act.name in ZEROING:
            self.zeroed.append((line + self.lines.window.first_line, frames))
        if act.name in FRAMELESS:
            return
        if act.name == "work" and not before.known:
            stood = np.flatnonzero(np.isfinite(self.state.position)).tolist()
            once = self.state.lost_once | sum(1 << k for k in stood)
            self._lose(line, (1 << len(self.axes)) - 1)
            self.state.lost_once = once  # where nothing was known, the start is said in this one
        if act.name == "no-vectors" and before.following:
            self.state.position[:] = LEFT  # the angles are the control's own choice
            self.note_lost((1 << len(self.axes)) - 1)
        if act.name in SWITCHED and before.following is not frames.following:
            self._lose(line, 0 if self._upright() else SPATIAL)
        if turned_tip(before) or turned_tip(frames):
            self._lose(line, SPATIAL * (before.plane is not frames.plane))
        lengthened = act.name in LENGTHENED and frames.frame() != old
        height = self._moved_by_length(line, old) if lengthened else np.nan
        tools = self.dialect.tool_rule
        if isnan(frames.tool[2]) and frames.tool[0] == 0.0 and tools.lengths_aside:
            self.state.assumed[ALONG_Z] = None
        if act.name == "polar":
            self.state.polar = np.nan, np.nan
        if act.name in LOST_BY_TURN:
            plane = PLANES[self.modes.plane[line]]
            self._lose(line, turned_by(before, frames, plane))
        self.enter(line, old)
        self._stand(2, height)

    def _moved_by_length(self, line: int, old: Frame) -> float:
        """Let go of Z where another length may move it; return its word if that stays for certain.

        The word is nan where it does not. `old` is the frame with the length before. Along which
        axes a length lies in a plane that the tool does not stand on yet is not known.
        """
        if not length_moves(self.dialect, self.lines.reading):
            return np.nan
        plane, word = self.state.frames.plane, old.words_of(self.state.position.tolist())[2]
        self._lose(line, 4 if plane is None or plane.angles else SPATIAL)
        return word if self.lines.reading.control.get(LENGTH_STEP) == "moves" else np.nan

    def _stand(self, k: int, word: float) -> None:
        """Let an axis stand where a word of the frame in force leads, if that is known."""
        turned = self.frame.matrix is not None or self.state.frames.plane is not None
        if turned or not isfinite(word):
            return
        words = list(self.frame.words_of(self.state.position.tolist()))
        words[k] = word
        self.state.position[k] = self.frame.point(words)[k]

    def _upright(self) -> bool:
        """Whether all rotary axes are known to be at 0, where the tip is as far as the axes are."""
        rotary = self.lines.reading.rotary or ROTARY
        turned = [v for a, v in zip(self.axes, self.state.position, strict=True) if a in rotary]
        return all(isfinite(v) and abs(remainder(v, WHOLE_TURN)) < NOISE for v in turned)

    def reset_work(self, line: int) -> None:
        """Enter the work offset that the end of a program leaves, before a line."""
        old = self.frame
        rule = self.dialect.program_rule
        self.state.frames = self.state.frames.ended(rule.resets_at_end["frame"], rule.shift_ends)
        self.enter(line, old)

    def enter(self, line: int, old: Frame) -> None:
        """Note the frame that is in force from a line on, if it is another one."""
        new = self.state.frames.frame()
        if new is not old and new != old:
            if new.origin != old.origin:
                pairs = enumerate(zip(old.origin, new.origin, strict=True))
                self._lose(line, sum(1 << k for k, (was, now) in pairs if was != now))
            self.frames.append(new)

    def _asked(self, act: Act, line: int) -> Asked:
        written, words, axes = self._said(act, line) if act.slots else (NOTHING, NOTHING, NOTHING)
        modes, call = self.modes, call_of(self.lines.kept_calls, line)
        return Asked(
            act.code,
            words,
            written,
            axes,
            self.state.position,
            bool(modes.incremental[line]),
            PLANES[modes.plane[line]],
            float(modes.tool[line]),
            self.dialect,
            self.lines.reading,
            "" if call is None else call.ends,
            lost=self.state.lost_once,
        )

    def _said(self, act: Act, line: int) -> tuple[dict[str, float], ...]:
        """Return the words that an act takes: as written, in mm, and those of axes as radii."""
        window, first = self.lines.window, int(self.lines.first[line])
        written = {a: float(window.value[first + slot]) for a, slot in act.slots}
        scale = INCH if self.modes.inch[line] else 1.0
        words = {a: v * scale if a in LINEAR else v for a, v in written.items()}
        for address, slot in act.slots if act.name not in UNFOLLOWED else ():
            self.lines.refuse_pointless(line, address, first + slot)
        axes = {a: v for a, v in words.items() if a in self.axes}
        if self.state.frames.diameter and "X" in axes:
            axes["X"] /= 2
        return written, words, axes

    def _lose(self, line: int, axes: int) -> None:
        if not axes:
            return
        axes &= self._losable
        self.note_lost(axes)
        self.state.position[[bool(axes >> k & 1) for k in range(len(self.axes))]] = np.nan
        self.breaks.append(Break(line, axes))

    @cached_property
    def _losable(self) -> int:
        """The axes, as bits, that something can take where it is not known: no filament."""
        return sum(1 << k for k, axis in enumerate(self.axes) if axis != EXTRUDER)

    def lose_all(self, line: int) -> None:
        """Note that from a line on no position is known."""
        self._lose(line, (1 << len(self.axes)) - 1)

    def lose(self, line: int, axes: str) -> None:
        """Note that from a line on the positions of some axes are not known."""
        self._lose(line, sum(1 << self.axes.index(axis) for axis in axes))

    def note_lost(self, axes: int) -> None:
        """Note that something has taken axes where they are not known: no start says it."""
        self.state.lost_once |= axes

    def _computed(self, axis: str, here: slice) -> bool:
        """Whether a word of an axis is worth what only the machine knows."""
        word = self.column(axis)
        return word is not None and bool(np.isnan(word[0][here][word[1][here]]).any())

    # --- stretches ---

    def along(self, first: int, last: int, rows: Ints, lost: Flags | None) -> Floats:
        """Return the positions (n, axes) after lines `rows` of the stretch from first to last.

        `lost` (lines,) are the lines of the window at which all positions are lost.
        """
        here = slice(first, last)
        before = self.frame.words(self.state.position[None, :])[0]
        lost_here = None if lost is None or not lost[here].any() else lost[here]
        words = np.empty((len(self.axes), len(rows))).T
        words[:] = before
        if lost_here is None and not self._words_until[last] > self._words_until[first]:
            return self.frame.positions(words)
        end = np.array(before)
        polar = self.polar(here) if self.frame.polar else {}
        for k, axis in enumerate(self.axes):
            gone = lost_here if self._losable >> k & 1 else None
            if gone is None and axis not in polar and self.column(axis) is None:
                continue
            position = self._axis(axis, float(before[k]), here, gone, polar.get(axis))
            words[:, k] = position[rows - first]
            end[k] = position[-1]
            if np.isnan(end[k]) and self._computed(axis, here):
                self.note_lost(1 << k)
        self.state.position = np.array(self.frame.positions(end[None, :])[0])
        if lost_here is not None:
            self.note_lost(self._losable)
            self.breaks += [Break(first + int(n), self._losable) for n in np.flatnonzero(lost_here)]
        return self.frame.positions(words)

    @cached_property
    def worded(self) -> Flags:
        """The lines with axis words."""
        named = np.zeros(self.lines.live, np.bool_)
        for word in filter(None, map(self.column, self.axes)):
            named |= word[1]
        return named

    @cached_property
    def _words_until(self) -> Ints:
        """How many lines before each line have axis words."""
        return np.append(0, np.cumsum(self.worded))

    def _steps(self, axis: str) -> Flags:
        """Return on which lines words of an axis are distances."""
        return self.modes.incremental if axis != EXTRUDER else self.modes.extruded == 1

    def _axis(
        self,
        axis: str,
        before: float,
        here: slice,
        lost: Flags | None,
        instead: tuple[Floats, Flags] | None,
    ) -> Floats:
        """Return where an axis is after each line of a stretch."""
        word = instead or self.column(axis)
        if word is None:
            assert lost is not None
            return fill(np.full(len(lost), np.nan), lost, before)
        value, present = word if instead else (word[0][here], word[1][here])
        steps = self._steps(axis)
        if lost is None and not steps.any():
            return fill(value, present, before)
        incremental = steps[here] & present
        placed = present & ~incremental
        if lost is not None:
            value = np.where(lost & ~present, np.nan, value)
            nowhere = incremental & lost & (not self.dialect.block_rule.m_first)
            self.refuse_steps(nowhere, axis, here.start, lost)
            placed = placed | (lost & ~incremental)
        if not incremental.any():
            return fill(value, placed, before)
        position = with_increments(value, placed, incremental, before)
        nowhere = incremental & ~np.isfinite(position) & np.isfinite(value)
        nowhere &= ~(self.may_step[here] & np.isnan(position))
        self.refuse_steps(nowhere, axis, here.start, lost)
        return position

    def named(self, own: Flags) -> Ints:
        """Return the axes (lines,), as bits, that blocks which move in their own way name."""
        if not own.any():
            return constant(0, len(own), np.int64)
        named = np.zeros(len(own), np.int64)
        for axis, (_, has) in self._named_axes:
            named += has.astype(np.int64) << self.axes.index(axis)
        named[named == 0] = (1 << len(self.axes)) - 1  # G28 alone is of all axes
        return np.where(own, named, 0)

    def refuse_steps(self, which: Flags, axis: str, first: int, lost: Flags | None) -> None:
        """Refuse incremental words of lines, counted from the first, that begin nowhere known."""
        for line in np.flatnonzero(which)[: Findings.enough].tolist():
            self.findings.add(
                line + first,
                "GX207",
                f"{axis} is incremental, but where {axis} stands is not known",
                axis,
                self._way_out(axis, line + first, lost is not None and lost[: line + 1].any()),
            )

    def _way_out(self, axis: str, line: int, lost: bool | np.bool_) -> str:
        """Return how an axis becomes known; behind a block that loses it the start is no help."""
        absolute = f"write an absolute {axis} before"
        before = self.state.lost_once >> self.axes.index(axis) & 1
        if lost or before or self._computed(axis, slice(0, line)):
            return f"{absolute}, behind what loses it"
        return f"{absolute}, or say start = {{ {axis} = ... }} in [input]"

    def polar(self, here: slice) -> dict[str, tuple[Floats, Flags]]:
        """Return the words of the plane's axes where radius and angle are programmed."""
        planes = distinct(self.modes.plane[here])
        if not np.isnan(self.state.polar).all():
            planes = union(planes, self.state.polar_plane)
        first, second, _ = Plane(int(self.modes.plane[here][0])).axes
        names = "XYZ"[first], "XYZ"[second]
        columns = []
        count = self.modes.plane[here].shape[0]
        any_word = np.zeros(count, np.bool_)
        for k, axis in enumerate(names):
            word = self.lines.word(axis) if k else self.column(axis)  # an angle has no unit
            value = np.full(count, np.nan) if word is None else word[0][here]
            present = np.zeros(count, np.bool_) if word is None else word[1][here]
            columns.append(fill(np.where(present, value, np.nan), present, self.state.polar[k]))
            any_word |= present
        if count:
            self.state.polar = float(columns[0][-1]), float(columns[1][-1])
            self.state.polar_plane = int(self.modes.plane[here][-1])
        radius, angle = columns[0], np.deg2rad(columns[1])
        bad = any_word & (np.isnan(radius + angle) | self.modes.incremental[here])
        bad |= self.worded[here] & (len(planes) > 1)
        for line in np.flatnonzero(bad)[: Findings.enough].tolist():
            message = "in polar words radius and angle must be known, in one plane and in G90"
            self.findings.add(line + here.start, "GX213", message)
        place = radius * np.cos(angle), radius * np.sin(angle)
        return {name: (value, any_word) for name, value in zip(names, place, strict=True)}
