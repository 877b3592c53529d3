"""What the interpreter is told, what it carries from window to window, and what holds on a line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from pathlib import Path

import numpy as np

from gcxform.config import arguments
from gcxform.config.quantities import AXIS_LETTERS
from gcxform.diagnostics import Diagnostic, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.dialect.increments import Increments
from gcxform.machine.chain import Chain, tables_of
from gcxform.machine.machine import TIP_AT_START, Machine, Tool
from gcxform.modal.cycles.expansion import Cycles
from gcxform.modal.frame_state import FrameState
from gcxform.syntax.source import Source
from gcxform.system.arrays import Flags, Floats, Small
from gcxform.toolpath.frames import Frame
from gcxform.values import dataclass

BLOCK_DELETE = ("execute", "skip", "")
UNITS = ("mm", "in", "")
TOOLS = 99_999_999  # a T has at most eight digits on any control
CYCLE_OFF = 80
UNKNOWN_SPINDLE = 3
SPEED = "speed"  # whether an S that is not 0 is in force, in `State.memory`
TURNED = "turned"  # the first line with axes turned while nobody has said whose words are


@dataclass(frozen=True, slots=True)
class Entry:
    """In which state a subprogram that stands in a file by itself is called; all else is unknown.

    modes       codes in force, "G91"; at most one of a modal group
    start       position of axes, mm or degrees
    feed        feed in effect, in the unit of the program
    parameters  values of parameters, by number or name: of its arguments those that they set
    """

    modes: tuple[str, ...] = ()
    start: Mapping[str, float] = field(default_factory=dict)
    feed: float | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Reading:
    """What a program does not say of itself.

    start         position of axes before the first block, mm or degrees
    increment     what 1 means in a distance without a point, as `Increments` takes it: "IS-B",
                  "calculator", a length in mm; None: such a distance is refused where the dialect
                  asks for a point
    feed          feed in effect before the first F word, in the program's unit
    tool          number of the tool in the spindle before the first block, None if not known
    block_delete  "execute", "skip", or "" to refuse blocks with a slash that do anything
    units         "mm" or "in" until the program says G20 or G21; "" for the dialect's default
    work_offsets  machine positions of work offsets, by code
    homes         machine positions of G28 and G30
    tools         the tool table
    control       settings of the control on which the meaning of codes depends
    inert_m       M codes of the machine's own that move no axis and set no variable
    feed_increment   what 1 means in an F without a point: a number of units per minute, a system
                  or "calculator"; None: such an F is refused where the dialect asks for a point
    rotary        the letters of the rotary axes of the machine; "" where that is not known
    tables        the chain of a machine whose rotary axes all turn the table, where it is known:
                  there tilted planes are followed; `turns_plainly`: the axes that turn a tool onto
                  them do so by words of their own
    open_pecks    whether a cycle may be read whose way back between pecks is a parameter that is
                  not given: where it then goes up to is nan; or whose R is above the level from
                  which it began, under G99. Its block must stay as it is. With `tables_stay`,
                  whereby no turn or mirror is folded, also one that leaves its hole in a direction
                  which only the machine knows
    tables_stay   whether a G10 may be read that writes into the control's tool table: its block
                  stays as it is, on the same control
    crosses       whether the program is to be written for another control
    curves        whether lines are to be written for curves that this control has and paths have
                  not, splines of weights and knots and tilted arcs: they are read as such curves
    stays         whether it is to be written for the same one by passes that keep positions: then
                  what is not understood may stay as it stands
    asides        whether it is to be written whole in the language that it is in: what only says
                  how fast, or how smooth, goes along, in comments that nobody else can write
    compensates   whether positions become those that make up for the errors of a machine
    keeps_tips    whether axes may turn behind a length with which the control follows the tip, as
                  tips become other tips
    modes_count   whether what is written depends on units, plane and feed mode: not where words of
                  the same coordinates are said in another way
    unit_open     whether that depends on a unit in which the program begins and nobody knows:
                  "refused" where the size of the part would, "told" where corrections and cuts do
    parameters    values of parameters before the first block, by number ("100") or name ("<a>")
    subprograms   folders in which subprograms are looked up, behind that of the program
    told          values of parameters that a file of the control gives, named as in `parameters`
    entry         how a subprogram is called that stands in a file by itself
    """

    start: Mapping[str, float] = field(default_factory=dict)
    increment: float | str | None = None
    feed: float | None = None
    block_delete: str = ""
    units: str = ""
    feed_increment: float | str | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    work_offsets: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    homes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    tools: Mapping[int, Tool] = field(default_factory=dict)
    control: Mapping[str, str | float] = field(default_factory=dict)
    inert_m: frozenset[int] = frozenset()
    rotary: str = ""
    tables: Chain | None = None
    turns_plainly: bool = False
    open_pecks: bool = False
    tables_stay: bool = True
    crosses: bool = False
    curves: bool = False
    stays: bool = False
    asides: bool = False
    compensates: bool = False
    keeps_tips: bool = False
    modes_count: bool = False
    unit_open: str = ""
    subprograms: tuple[Path, ...] = ()
    told: Mapping[str, float] = field(default_factory=dict)
    entry: Entry = field(default_factory=Entry)
    tool: int | None = None

    @property
    def same_words(self) -> bool:
        """Whether the program is written for its own control, by passes that say the same words."""
        return self.open_pecks and not self.modes_count

    def __post_init__(self) -> None:
        """Take what a caller may write for what it means; refuse all else. Raises UsageError."""
        for name, value in self._taken().items():
            object.__setattr__(self, name, value)
        try:
            _ = self.increments
        except ValueError as error:
            raise UsageError.one("GX708", f"increment: {error}") from None

    def blocks_with_a_slash(self, dialect: type[Dialect]) -> str:
        """Return what is done with them: what is told, else what the dialect says, else ""."""
        return self.block_delete or dialect.program_rule.block_delete

    def _taken(self) -> dict[str, object]:
        """Return the fields that a program cannot be read without understanding, converted."""
        start = {
            arguments.chosen("start", axis, AXIS_LETTERS): arguments.number(
                f"start of {axis}", value
            )
            for axis, value in arguments.table("start", self.start).items()
        }
        parameters = {
            name: arguments.number(f"parameter {name}", value)
            for name, value in arguments.table("parameters", self.parameters).items()
        }
        return {
            "start": start,
            "parameters": parameters,
            "tool": None if self.tool is None else arguments.whole("tool", self.tool, TOOLS),
            "feed": None if self.feed is None else arguments.positive("feed", self.feed),
            "block_delete": arguments.chosen("block_delete", self.block_delete, BLOCK_DELETE),
            "units": arguments.chosen("units", self.units, UNITS),
            "increment": _increment("increment", self.increment),
            "feed_increment": _increment("feed_increment", self.feed_increment),
            "subprograms": tuple(Path(each) for each in self.subprograms),
        }

    @property
    def increments(self) -> Increments | None:
        """What is said of distances without a point, None where nothing is."""
        return None if self.increment is None else Increments.of(self.increment)

    def axes_of(self, source: Source, dialect: type[Dialect]) -> str:
        """Return the axes that a program may move: by name, or to turn the tool onto a plane."""
        named = source.axes(dialect.axes)
        codes = (dialect.codes[name] for name in dialect.tip_rule.planes)
        if self.tables is None or not any(code.act for code in codes):
            return named
        return "".join(axis for axis in dialect.axes if axis in {*named, *self.tables.letters})

    def follows_at_start(self, otherwise: bool | None) -> bool | None:
        """Return whether the control follows the tip before the first block, None if not known."""
        said = {"on": True, "off": False}
        return said.get(str(self.control.get(TIP_AT_START)), otherwise)

    def on(self, machine: Machine) -> Reading:
        """Return what is known when the program runs on a machine."""
        return replace(
            self,
            work_offsets=machine.work_offsets,
            homes=machine.homes,
            tools=machine.tools,
            control=machine.control,
            inert_m=machine.inert_m,
            rotary="".join(machine.table + machine.head),
            tables=tables_of(machine),
            subprograms=(*self.subprograms, *machine.subprograms),
            told=machine.told,
        )


def _increment(what: str, value: object) -> float | str | None:
    """Return an increment as `Increments` takes it: a length, or words."""
    return value if value is None or isinstance(value, str) else arguments.positive(what, value)


@dataclass(slots=True)
class State:
    """What one window hands to the next.

    lost        axes, as bits, whose position was lost since the last row
    lost_once   axes, as bits, whose position a block has lost: the start says nothing of them
    row_frame   the frame of the last row
    polar       radius and angle last programmed in G16, in `polar_plane`
    side, radius  cutter compensation in force; `at_side`: that of the last move;
                  `cancelled`: G40 has been in force since; `leaving`: no move in the plane has
                  left the contour since
    selected      the T word; `tool`: the tool in the spindle; `stored`: the D word; nan: not known
    pull   P and Q of the last move if that was a G5, in units of the program
    nurbs  how many control points a spline has that G5.3 has not ended, and its order
    assumed  what was chosen among several meanings that a word can have, in sentences; those that
             may surprise with a warning
    feed_lost  a feed is in force that only the machine knows
    kept_calls  how often each call is made whose program is not at hand
    lost_modes  groups whose code is not known, behind a call that is kept, `lost_by`
    vector the tool axis that G43.5 has led to, nan where it is not in force
    """

    groups: dict[str, int]
    position: Floats
    feed: float
    feed_unit: float
    frames: FrameState
    tool_word: float = -1.0
    ended: bool = False
    percents: int = 0
    rapid: bool = False
    lost: int = 0
    lost_once: int = 0
    row_frame: Frame | None = None
    polar: tuple[float, float] = (np.nan, np.nan)
    polar_plane: int = 0
    side: int = 0
    radius: float = np.nan
    selected: float = np.nan
    tool: float = np.nan
    stored: float = np.nan
    at_side: int = 0
    leaving: bool = False
    cancelled: bool = False
    stated: set[str] = field(default_factory=set)
    assumed: dict[str, Diagnostic | None] = field(default_factory=dict)
    parameters: dict[int | str, float] = field(default_factory=dict)
    cycles: Cycles | None = None
    pull: tuple[float, float] | None = None
    nurbs: tuple[int, float] | None = None
    vector: tuple[float, float, float] = (np.nan, np.nan, np.nan)
    memory: dict[str, int] = field(default_factory=dict)
    lost_modes: frozenset[str] = frozenset()
    lost_by: str = ""
    kept_calls: dict[str, int] = field(default_factory=dict)
    feed_lost: bool = False


@dataclass(frozen=True, slots=True)
class Modes:
    """Per line of a window, after its words: the number of the code in force of each group.

    `feed` is the number last programmed and `feed_unit` what 1 of it is worth in mm; `tool` is the
    number of the last T word, -1 for none; `extruded` is 1 where words of an extruder are distances
    (M83), 0 where they are not (M82), and -1 where that is not known; `cycle` is that of the canned
    cycle in force, or `CYCLE_OFF`; `retract` is 1 in G98; `spindle` is 0 for M5, 1 for M3, 2 for
    M4.
    """

    motion: Small
    plane: Small
    incremental: Flags
    extruded: Small
    absolute_centre: Flags
    feed_mode: Small
    inch: Flags
    work: Small
    comp: Small
    feed: Floats
    feed_unit: Floats
    tool: Floats
    cycle: Small
    retract: Small
    spindle: Small
