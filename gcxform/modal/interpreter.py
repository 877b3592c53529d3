"""From windows of blocks to toolpaths: what the words mean, given all that stood before.

The interpreter works on columns. Every modal group, every axis and the feed is one column over the
lines of a window, filled forward from the line that set it; what holds at the end of a window is
carried into the next. Whatever a dialect leaves to the machine is an option of `Reading`, and what
needs a fact that is not known is refused, with the line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace

import numpy as np

from gcxform.config.quantities import LENGTH
from gcxform.dialect.arithmetic import Key
from gcxform.dialect.dialect import EXTRUDER, INCH, Dialect
from gcxform.modal.control_limits import refuse_limits
from gcxform.modal.cycles.expansion import Cycles
from gcxform.modal.expressions.assignments import compute
from gcxform.modal.expressions.unknown import note_prints
from gcxform.modal.expressions.value import given_to
from gcxform.modal.frame_state import FrameState
from gcxform.modal.frames.unsaid_tips import refuse_unsaid
from gcxform.modal.line_notes import Assignments, Unknown, WayHome
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import GROUPS, MANY_WORK, NUMBER, NURBS_END, SPLINES, MeaningTable
from gcxform.modal.moves.kept_calls import refuse_lost_modes
from gcxform.modal.moves.moves import Moves
from gcxform.modal.moves.open_units import refuse_open_units
from gcxform.modal.state import CYCLE_OFF, SPEED, TURNED, UNKNOWN_SPINDLE, Modes, Reading, State
from gcxform.syntax.scan import Window
from gcxform.syntax.undecided import DECIDED
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.records import Records
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass


@dataclass(frozen=True)
class Interpreted:
    """A window's toolpath and the modes of its lines; `live` lines are those the control runs.

    `shape` (live,) are their shapes: that of an empty line for blocks that are skipped. `value`
    are the window's numbers, those that were computed among them; `assigned` are the parameters
    that the lines set, in order, and `unknown` what of them only the machine can compute. `perhaps`
    (live,) are lines that move something and may not be executed; None: there are none. `loses`
    (live,) are lines behind which no position is known. `zeroed` are the lines of the program, from
    0, that set where something counts from, and the state of the frames behind each. `homed` are
    lines that only go to a point of the machine which is known; `ways_open` of one that is not, the
    settings that would say it.
    `lengths` are the lines that put a tool length in force, and its vector, mm.
    """

    path: Toolpath
    modes: Modes
    live: int
    shape: Ints
    before: State
    value: Floats
    assigned: Assignments = Assignments.of(())
    unknown: tuple[Unknown, ...] = ()
    perhaps: Flags | None = None
    loses: Flags = field(default_factory=lambda: np.zeros(0, np.bool_))
    zeroed: tuple[tuple[int, FrameState], ...] = ()
    homed: Mapping[int, WayHome] = field(default_factory=dict)
    ways_open: Mapping[int, str] = field(default_factory=dict)
    lengths: Mapping[int, tuple[float, float, float]] = field(default_factory=dict)


PECKS = ("peck-return", "peck-clearance")
"""Settings of the control that canned cycles need."""


def _length(control: Mapping[str, str | float], name: str) -> float | None:
    """Return a length (mm) among the settings of the control."""
    value = control.get(name)
    return LENGTH.parse(value) if isinstance(value, str) else value


UNSAID = {EXTRUDER: 0.0}
"""Where axes stand that count from anywhere: filament has no place, and programs set it by G92."""


class Interpreter:
    """Reads the windows of one program in order; `undecided` is what of it the machine decides.

    `only` are the codes of findings that are asked for, None for all.
    """

    only: frozenset[str] | None = None

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
        self.undecided = DECIDED
        self.state = self._first_state()

    def _first_state(self) -> State:
        initial = self.dialect.initial
        groups = {g: NUMBER.get(initial[g], MANY_WORK) for g in GROUPS}
        if self.reading.units:
            groups["units"] = int(self.reading.units == "in")
        start = self.reading.start
        position = np.array([start.get(axis, UNSAID.get(axis, np.nan)) for axis in self.axes])
        feed = np.nan if self.reading.feed is None else self.reading.feed
        unit = INCH if groups["units"] else 1.0
        frames = FrameState.at_start(
            self.axes,
            self.dialect.initial["frame"],
            bool(start) or self.dialect.offset_rule.known_at_start,
            self.reading.work_offsets,
            self.reading.homes,
        )
        following = self.reading.follows_at_start(self.dialect.tip_rule.follows_at_start)
        held = -1 if self.reading.tool is None else self.reading.tool
        frames = replace(frames, following=following, in_spindle=held)
        state = State(groups, position, feed, unit, frames, parameters=self._given())
        state.tool = np.nan if self.reading.tool is None else float(held)
        rule = self.dialect.cycle_rule
        if rule is not None:
            control = self.reading.control
            up, above = (_length(control, name) for name in PECKS)
            open_pecks = self.reading.open_pecks
            open_ways = open_pecks and self.reading.tables_stay
            state.cycles = Cycles(rule, up, above, open_pecks, open_ways)
        retract = int(rule is None or rule.initial_level)
        spindle = 0 if self.dialect.program_rule.spindle_stands else UNKNOWN_SPINDLE
        state.memory = {"cycle": CYCLE_OFF, "retract": retract, "spindle": spindle, "behind": 0}
        state.memory |= {"tool-length": NUMBER["G49"], "extrusion": 0, "extruded": 0}
        state.memory |= {SPEED: 0, TURNED: 0}
        state.memory |= {"centres": 0, "unit-open": int(self.reading.unit_open != "")}
        return state

    def _given(self) -> dict[Key, float]:
        """Return the parameters whose values are given, but for those the control changes."""
        arithmetic = self.dialect.flow_rule.arithmetic
        return {} if arithmetic is None else given_to(arithmetic, self.reading)

    def interpret(self, window: Window, table: MeaningTable) -> Interpreted:
        """Return the moves of a window. Raises InputError with all that speaks against it."""
        table.update()
        before = replace(self.state, position=self.state.position.copy())
        given = self.file, self.undecided
        lines = Lines(self.dialect, self.reading, self.state, window, table, *given)
        lines.findings.only = self.only
        lines.refuse_statically()
        assigned = compute(lines)
        note_prints(lines)
        modes = lines.modes()
        refuse_lost_modes(lines, modes)
        refuse_open_units(lines)
        moves = Moves(lines, modes, self.axes)
        path = moves.path()
        refuse_limits(lines, modes, path.events)
        lines.findings.raise_if_any()
        refuse_unsaid(lines, before, path)
        self._carry(lines, modes)
        return Interpreted(
            path,
            modes,
            lines.live,
            lines.shape,
            before,
            lines.window.value,
            assigned,
            Records(lines.unknown),
            lines.perhaps,
            lines.loses_position(),
            tuple(moves.track.zeroed),
            moves.track.homed,
            moves.track.ways_open,
            moves.track.lengths,
        )

    def _carry(self, lines: Lines, modes: Modes) -> None:
        """Leave the state in which the window ends."""
        if not lines.live:
            return
        self.state.parameters = lines.parameters
        last = {
            "motion": modes.motion,
            "plane": modes.plane,
            "distance": modes.incremental,
            "arc-distance": modes.absolute_centre,
            "feed-mode": modes.feed_mode,
            "units": modes.inch,
            "frame": modes.work,
            "cutter-comp": modes.comp,
        }
        self.state.groups = {name: int(column[-1]) for name, column in last.items()}
        if self.state.groups["motion"] in (*SPLINES, NURBS_END):
            self.state.groups["motion"] = NUMBER["G80"]
        self.state.feed = float(modes.feed[-1])
        self.state.feed_unit = float(modes.feed_unit[-1])
        if lines.flag("ends")[-1]:
            for name, code in self.dialect.program_rule.resets_at_end.items():
                if name == "feed-mode" and self.state.groups[name] != NUMBER[code]:
                    self.state.feed = np.nan
                self.state.groups[name] = NUMBER[code]
                if name == "frame":
                    ends = self.dialect.program_rule.shift_ends
                    self.state.frames = self.state.frames.ended(code, ends)
