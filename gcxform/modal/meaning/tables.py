"""The meanings of all shapes as arrays: the interpreter looks all lines up at once."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect.dialect import Dialect
from gcxform.machine.machine import SWITCHES
from gcxform.modal.meaning.meaning import FRAMING, OWN_MOVES, PRESETS, Meaning
from gcxform.modal.meaning.sorting import meaning_of
from gcxform.syntax.shapes import Shape, ShapeTable
from gcxform.system.arrays import Flags, Ints, Small

GROUPS = (
    "motion",
    "plane",
    "distance",
    "arc-distance",
    "feed-mode",
    "units",
    "frame",
    "cutter-comp",
)
MEMORY = ("cycle", "retract", "spindle", "tool-length", "extrusion")
"""Groups that matter to canned cycles alone, to tool vectors, and to extruders."""
COLUMNS = (*GROUPS, *MEMORY)
THREAD, TAP = 33, 34
"""The numbers of G33 and G33.1, whose moves are tied to the spindle."""
THREAD_CYCLE = 76
"""The number of LinuxCNC's G76; in the group of cycles of other controls that is fine boring."""
PROBES = (38, 39, 40, 41)
"""The numbers of G38.2 to G38.5."""
CYCLES = tuple(n for n in range(73, 90) if n not in (75, 77, 78, 79, 80))
SPLINES = CUBIC, QUADRATIC = (5, 51)
NURBS, NURBS_END = 52, 53
"""The numbers of G5.2, that stays in force, and of G5.3."""
NUMBER = {
    **{f"G{n}": n for n in (0, 1, 2, 3, 80, *CYCLES)},
    "G5": CUBIC,
    "G5.1": QUADRATIC,
    "G5.2": NURBS,
    "G5.3": NURBS_END,
    "G33": THREAD,
    "G33.1": TAP,
    **{f"G38.{2 + k}": n for k, n in enumerate(PROBES)},
    **{f"G{17 + n}": n for n in range(3)},
    "G90": 0,
    "G91": 1,
    "G91.1": 0,
    "G90.1": 1,
    **{f"G{n}": n for n in (93, 94, 95)},
    "G21": 0,
    "G20": 1,
    "G71": 0,
    "G70": 1,
    **{f"G{54 + n}": n for n in range(6)},
    **{f"G59.{n}": 5 + n for n in (1, 2, 3)},
    "G54.1": 9,
    "G99": 0,
    "G98": 1,
    "M82": 0,
    "M83": 1,
    "M5": 0,
    "M19": 0,
    "M3": 1,
    "M4": 2,
    "G40": 0,
    "G41": 1,
    "G42": 2,
    "G41.1": 3,
    "G42.1": 4,
    "G49": 0,
    "G43": 1,
}
"""The number that stands for a code within its group."""
FAMILIES = {
    "motion": (
        *("G0", "G1", "G2", "G3", "G80", "G5", "G5.1", "G33", "G33.1"),
        *("G5.2", "G5.3"),
        *(f"G38.{2 + k}" for k in range(len(PROBES))),
        *(f"G{n}" for n in CYCLES),
    ),
    "plane": ("G17", "G18", "G19"),
    "distance": ("G90", "G91"),
    "arc-distance": ("G91.1", "G90.1"),
    "feed-mode": ("G93", "G94", "G95"),
    "units": ("G21", "G20"),
    "extrusion": ("M82", "M83"),
    "cutter-comp": ("G40", "G41", "G42", "G41.1", "G42.1"),
}
"""The codes of each of the groups, but for work offsets, which have names."""


def code_of(group: str, number: int) -> str:
    """Return the code of a group by its number."""
    return next(code for code in FAMILIES[group] if NUMBER[code] == number)


MANY_WORK = 9
"""The number of G54.1, whose P names one of many work offsets, and of all codes of that group that
have no number of their own. Two of them in a row may be two work offsets."""


FLAGS = (
    "moves",
    "has_centre",
    "wrong",
    "deleted",
    "asides",
    "ends",
    "loses_position",
    "has_events",
    "percent",
    "marked",
    "acts",
    "own_moves",
    "probes",
    "in_machine",
    "work_only",
    "framing",
    "switches",
    "presets",
    "takes_lengths",
    "computes",
    "drills",
    "drill_words",
    "changes_tool",
    "bars_comp_before",
    "bars_comp_after",
    "compensates",
    "lends",
    "calls",
    "prints",
    "sets_tables",
    "runs_macro",
    "shares_words",
    "corner",
)


def of_splines(motion: Small) -> Flags:
    """Return which numbers of motion codes are those of splines."""
    return np.asarray((motion == CUBIC) | (motion == QUADRATIC))


DRILL_WORDS = frozenset("XYZABCUVWRPQLIJK")
CHANGING = frozenset("XYZABCUVWIJKRQF")
"""Words that passes change."""


def _calls(meaning: Meaning) -> bool:
    """Whether blocks name a cycle."""
    return any(NUMBER.get(code) in CYCLES for code in meaning.groups.values())


ADDRESSES = 2 * 26  # letters, and letters behind a comma


def column_of(address: str) -> int:
    """Return the column of an address in the slots of a table of meanings."""
    return ord(address[-1]) - 65 + 26 * address.startswith(",")


LATELY = 8192  # shapes whose meanings are kept


@lru_cache(LATELY)
def _lately(shape: Shape, dialect: Any) -> Meaning:
    """Return what a shape means in a dialect, a class.

    The flow, the reader, the writer and the proof ask, each for a table of its own; nobody changes
    the answer, which hangs on the tree alone.
    """
    return meaning_of(shape, dialect)


class MeaningTable:
    """Meanings of the shapes of one shape table in one dialect; it grows with the shapes."""

    def __init__(self, shapes: ShapeTable, dialect: type[Dialect]) -> None:
        self.shapes = shapes
        self.dialect = dialect
        self.meanings: list[Meaning] = []
        self._calls_with_values = dialect.flow_rule.macro_levels > 0
        self.functions: dict[int, Any] = {}  # of shapes that compute something, once made
        self.groups: Small = np.empty((0, len(COLUMNS)), np.int8)
        self.flags: Flags = np.empty((0, len(FLAGS)), np.bool_)
        self.slots: NDArray[np.int16] = np.empty((0, ADDRESSES), np.int16)

    def update(self) -> None:
        """Look at the shapes that are new."""
        fresh = self.shapes.shapes[len(self.meanings) :]
        if not fresh:
            return
        known = len(self.meanings)
        dialect: Any = self.dialect  # mypy takes a class of its kind for unhashable
        self.meanings += [_lately(shape, dialect) for shape in fresh]
        room = len(self.groups)
        if room < len(self.meanings):
            more = max(len(self.meanings) - room, room)
            self.groups = np.vstack([self.groups, np.full((more, len(COLUMNS)), -1, np.int8)])
            self.flags = np.vstack([self.flags, np.zeros((more, len(FLAGS)), np.bool_)])
            self.slots = np.vstack([self.slots, np.full((more, ADDRESSES), -1, np.int16)])
        for index in range(known, len(self.meanings)):
            self._enter(index, self.meanings[index])

    def _enter(self, index: int, meaning: Meaning) -> None:
        for group, code in meaning.groups.items():
            other = MANY_WORK if group == "frame" else None
            number = NUMBER.get(code, other)
            if group in COLUMNS and number is not None:
                self.groups[index, COLUMNS.index(group)] = number
        for address, slot in meaning.slots.items():
            if address[-1].isalpha():
                self.slots[index, column_of(address)] = slot
        self.flags[index] = (
            bool(meaning.axes),
            bool(meaning.centres) or "R" in meaning.slots,
            meaning.refusal is not None,
            meaning.deleted,
            meaning.asides,
            meaning.ends,
            meaning.loses_position,
            bool(meaning.events),
            meaning.percent,
            meaning.marked,
            bool(meaning.acts),
            any(act.name in OWN_MOVES for act in meaning.acts),
            any(act.name == "probe" for act in meaning.acts),
            any(act.name == "machine" for act in meaning.acts),
            [act.name for act in meaning.acts] == ["work"] and "frame" in meaning.groups,
            any(act.name in FRAMING for act in meaning.acts),
            any(act.name in SWITCHES for act in meaning.acts),
            any(act.name in PRESETS for act in meaning.acts),
            bool(meaning.lengths),
            bool(meaning.assignments or meaning.expressions or meaning.runs_macro),
            bool(set(meaning.slots) & DRILL_WORDS) or _calls(meaning),
            bool(meaning.drill_words),
            meaning.changes_tool,
            bool(meaning.bars_comp[0]),
            bool(meaning.bars_comp[1]),
            meaning.compensates,
            bool(meaning.lent),
            bool(meaning.call),
            bool(meaning.prints),
            any(act.name == "table" for act in meaning.acts),
            meaning.runs_macro and not meaning.call,
            bool(self._calls_with_values and meaning.lost_by and set(meaning.slots) & CHANGING),
            bool(meaning.corner),
        )

    def flag(self, name: str, shape: Ints) -> Flags:
        """Return a flag of each line, given the lines' shapes."""
        return np.asarray(self.flags[:, FLAGS.index(name)][shape])
