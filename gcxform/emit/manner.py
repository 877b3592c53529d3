"""How a program is to be written, and what the control believes while it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from functools import cached_property
from typing import NoReturn

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.dialect.code_translation import Saying
from gcxform.dialect.dialect import INCH, LINEAR, Dialect, NumberFormat
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.meaning.meaning import PRESETS, Act
from gcxform.modal.meaning.tables import NUMBER, MeaningTable
from gcxform.syntax.scan import Window
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

WORDS = ("changed", "programmed", "all")
NOISE = 1e-9  # mm; what positions may be off because they are computed in binary


@dataclass(frozen=True)
class Manner:
    """Dialects, numbers, and which axis words a changed block gets.

    words     "changed": what changes or was programmed; "programmed": only that; "all": every axis
    decimals  by address, where they differ from the number format
    expands   whether canned cycles have become plain moves
    foreign_cycles  the numbers of those that have because the target has not the same
    promised  mm; how far the passes may be off, which a tap may use up
    compensates  positions become commands for a machine with errors, or the other way round
    spares    which rapids passes leave to the machine, each as it says that
    curves    whether splines of weights and knots were read as curves, and became lines
    open_place   whether a setting that is not known decides if a cycle drills that names no place
    said      what the user says of codes of the source
    """

    source: type[Dialect]
    target: type[Dialect]
    numbers: NumberFormat
    words: str = "changed"
    decimals: Mapping[str, int] = field(default_factory=dict)
    expands: bool = False
    promised: float = 0.0
    compensates: bool = False
    spares: tuple[Callable[[Toolpath], Flags], ...] = ()
    curves: bool = False
    open_place: bool = False
    said: Saying | None = None
    foreign_cycles: frozenset[int] = frozenset()

    @cached_property
    def saying(self) -> Saying:
        """How the target says what codes of the source do."""
        return self.said or Saying(self.source, self.target)

    @property
    def crossing(self) -> bool:
        """Whether the program changes its dialect."""
        return self.source is not self.target

    @property
    def slashes(self) -> bool:
        """Whether a slash says in the target what it says in the source.

        Where it does not, blocks that have one are executed or skipped, as is known by now.
        """
        one, other = self.source.program_rule, self.target.program_rule
        return one.block_delete == other.block_delete

    def decimals_of(self, address: str, inch: bool) -> int:
        """Return the decimals of an address."""
        if address in self.decimals:
            return self.decimals[address]
        if address == "F":
            return self.numbers.feed
        if address not in LINEAR + "IJKR":
            return self.numbers.angle
        return self.numbers.inch if inch else self.numbers.mm

    def step(self, address: str, inch: bool) -> float:
        """Return the last decimal of an address in mm or degrees."""
        unit = INCH if inch and address in LINEAR + "IJKR" else 1.0
        return float(10.0 ** -self.decimals_of(address, inch)) * unit

    def rounding(self, inch: bool) -> float:
        """Return the largest distance (mm) of a formatted position from the exact one."""
        return float(np.sqrt(sum((self.step(a, inch) / 2) ** 2 for a in "XYZ"))) + NOISE


@dataclass(slots=True)
class Believed:
    """What the control believes after the text written so far.

    `exact`: its position is that of the source to the last bit, because all was copied.
    `said` (3,): in which of X, Y and Z it is, because a block that was copied named them.
    `level`: from where the canned cycle in force has begun, along its axis; nan: there is none, or
    it has no moves. `tapping`: its taps have moved, so that each needs words of its own.
    `aside`: how far (mm) it stands from where it shall be, after a tap. `stands`: its position, to
    the last bit in those axes of `said`. `led`: a move has led there that passes have corrected.
    `speed`: of the spindle, in turns per minute.
    """

    position: Floats
    motion: int
    inch: int
    incremental: int
    absolute_centre: int
    feed_mode: int
    feed: float = np.nan
    feed_unit: float = 1.0
    exact: bool = True
    said: Flags = field(default_factory=lambda: np.zeros(3, np.bool_))
    level: float = np.nan
    tapping: bool = False
    aside: float = 0.0
    stands: Floats = field(default_factory=lambda: np.zeros(0))
    led: bool = False
    speed: float = np.nan

    @classmethod
    def at_start(cls, manner: Manner, position: Floats) -> Believed:
        """Return what a control believes before the first block."""
        initial = manner.target.initial
        return cls(
            position.copy(),
            NUMBER[initial["motion"]],
            NUMBER[initial["units"]],
            NUMBER[initial["distance"]],
            -1 if manner.target.arc_rule.centres_open else NUMBER[initial["arc-distance"]],
            NUMBER[initial["feed-mode"]],
            stands=position.copy(),
        )


@dataclass(frozen=True, slots=True)
class Task:
    """One window to be written: its text, what was read from it, and the path it shall have."""

    manner: Manner
    window: Window
    table: MeaningTable
    read: Interpreted
    path: Toolpath
    file: str

    @property
    def shape(self) -> Ints:
        """Shapes of the lines that the control executes."""
        return self.read.shape

    @property
    def skipped(self) -> Flags:
        """The lines (live,) that the control skips, because of their slash."""
        return np.asarray(self.window.shape[: len(self.shape)] != self.shape)

    def counted_from_axes(self) -> list[int]:
        """Return the lines that set coordinates from where the axes stand.

        G10 L2 does not, nor L20 where it only names more work offsets: both say where a zero is.
        Nor does what gives a length of a tool by a number of its own (`_states_length`).
        """
        lines = np.flatnonzero(self.table.flag("presets", self.shape)).tolist()
        return [line for line in lines if self._counts_from_axes(line)]

    def _counts_from_axes(self, line: int) -> bool:
        named = self.manner.source.offset_rule.g10_l20 not in ("", "here")
        for act in self.table.meanings[int(self.shape[line])].acts:
            slot = dict(act.slots).get("L") if act.name == "set-work" else None
            first = int(self.window.first_number[line])
            kind = np.nan if slot is None else float(self.read.value[first + slot])
            stated = kind == 2 or (kind == 20 and named) or self._states_length(act, kind)
            if act.name in PRESETS and not stated:
                return True
        return False

    def _states_length(self, act: Act, kind: float) -> bool:
        """Whether G10 writes into the tool table what it says, by L1 or without words of axes."""
        by_axes = any(address in self.manner.source.axes for address, _ in act.slots)
        return kind in self.manner.source.offset_rule.g10_tools and (kind == 1 or not by_axes)

    def location(self, line: int, column: int = 0, width: int = 0) -> Location:
        """Return a place in a line of the window; column from 0."""
        text = self.window.line(line).decode("latin-1")
        number = self.window.first_line + line + 1
        return Location(self.file, number, column + 1, text, width or max(1, len(text)))

    def refuse(self, rows: Ints, code: str, message: str, hint: str) -> NoReturn:
        """Raise InputError at the lines of some rows of the path, the first twenty of them."""
        lines = self.path.block[rows[:20]].tolist()
        raise InputError(
            tuple(Diagnostic(code, message, self.location(line), hint) for line in lines)
        )
