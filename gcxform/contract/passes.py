"""The contract of a pass: what it needs, what it promises, and how its work can be undone.

A pass is a frozen dataclass whose fields are its options. It turns one toolpath into another, as a
pure function, and declares a tolerance and an `undo`: the model of what the machine does with its
output. The law, in the tests and on every run, is

    deviation(before, undo(after)) <= promise

along every move. `undo` uses the forward model and shares no code with the search it checks.

A pass that `resolves` gives the program another path on purpose, as the control would do it: the
centre of the tool in place of the contour. `prove` checks that path against the program as read,
and what comes after it is compared with that path.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from gcxform.contract.tip_codes import switches_of
from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import Dialect, NumberFormat
from gcxform.syntax.tree import Block
from gcxform.system.arrays import Flags
from gcxform.toolpath.facts import Fact
from gcxform.toolpath.path import FeedMode, Toolpath

if TYPE_CHECKING:
    from gcxform.contract.option_kinds import KinematicsFile
    from gcxform.machine.machine import Machine


@dataclass(frozen=True)
class PassContext:
    """What surrounds a pass: the dialects it works between, the output's numbers, the machine.

    `decimals` are those of addresses that differ from the number format.
    """

    source: type[Dialect]
    target: type[Dialect]
    numbers: NumberFormat
    machine: Machine | None = None
    decimals: Mapping[str, int] = field(default_factory=dict)

    @property
    def switches(self) -> Mapping[str, str]:
        """The M codes with which the control follows the tip and leaves it: their acts by code."""
        return switches_of(self.source, self.machine.control if self.machine is not None else {})

    def decimals_of_angle(self, letter: str) -> int:
        """Return with how many decimals a rotary axis is written."""
        return self.decimals.get(letter, self.numbers.angle)


@dataclass(frozen=True)
class Pass:
    """The base of the passes that change toolpaths.

    `name` is what a pipeline calls it; its docstring is its documentation. Override `promise`
    when the pass may deviate, and `undo` when the machine turns its output into something else.
    """

    name: ClassVar[str] = ""
    requires: ClassVar[frozenset[Fact]] = frozenset()
    ensures: ClassVar[frozenset[Fact]] = frozenset()
    clears: ClassVar[frozenset[Fact]] = frozenset()
    keeps_rows: ClassVar[bool] = True
    """Whether a pass that moves nothing has the rows of its input in its output, one for one."""
    joins: ClassVar[bool] = False
    """Whether a row may come to stand for several that follow one another: it is the first one's
    line that it keeps. Where a window ends decides then what can be joined."""
    folds: ClassVar[bool] = False
    """Whether the codes that shift coordinates are folded into the words of moves."""
    resolves: ClassVar[bool] = False
    """Whether its output is what the rest of the run is compared with; then it has to `prove` it.
    No window ends where cutter compensation is in force for such a pass."""
    reads_tip_codes: ClassVar[bool] = False
    """It does what codes for following the tip ask for, so they are read as plain tool lengths."""
    reads_vectors: ClassVar[bool] = False
    """It makes angles of the tool vectors that such codes announce."""
    deviates: ClassVar[Mapping[str, str]] = MappingProxyType({})
    """By "deviation" (mm) and "angle" (degrees) the name of what it measures of the same kind: what
    its promise bounds, and what no comparison of what it wrote with its own path can show."""
    whole_cuts: ClassVar[bool] = False
    """Whether it has to see every cut as a whole: a window then ends where a rapid follows one."""

    @property
    def letters(self) -> str:
        """The letters of axes that its output may have, whether the program names them or not."""
        return ""

    @property
    def written_for(self) -> KinematicsFile | None:
        """The machine that its output is for, if it is not the one of the pipeline."""
        return None

    @property
    def promise(self) -> float:
        """How far the path may deviate (mm); inf where nothing is promised."""
        return 0.0

    @property
    def promise_angle(self) -> float:
        """How far (deg) rotary axes may be from where they should be at a point of the path."""
        return 0.0

    @property
    def feed_mode(self) -> FeedMode | None:
        """The feed mode that the pass turns those of others into; None: it keeps them."""
        return None

    @property
    def slows(self) -> bool:
        """Whether its moves may take longer than their feeds say, where axes are at full speed."""
        return False

    def begin(self, context: PassContext) -> None:
        """Look at the context before any input is read; raise UsageError if it does not fit."""

    def apply(self, path: Toolpath, context: PassContext) -> Toolpath:
        """Return the changed path. Raises InputError, with lines, for what it cannot honour."""
        raise NotImplementedError

    def undo(self, path: Toolpath, context: PassContext) -> Toolpath:
        """Return what the machine does with a path that came from this pass."""
        return path

    def spares(self, path: Toolpath) -> Flags:
        """Return which rapids (n,) of a path are left to go where the machine takes them.

        Of these the proof asks that the control is told what the program says, and the certificate
        says how far off the machine is there.
        """
        return np.zeros(len(path), np.bool_)

    def measure(
        self, before: Toolpath, after: Toolpath, context: PassContext
    ) -> Mapping[str, float]:
        """Return what the certificate shall say of a window besides the deviation, by its name.

        Of each name the largest value of the run is told.
        """
        return {}

    def added(self, before: Toolpath, after: Toolpath, context: PassContext) -> Mapping[str, int]:
        """Return how many things of a window the source does not have, by name, if any may be."""
        return {}

    @classmethod
    def ways(cls, dialect: type[Dialect]) -> tuple[Pass, ...]:
        """Return the passes that, together, resolve in all ways in which such controls may do it.

        Where a parameter of the machine decides there is one for each of its settings.
        """
        return ()

    def stops(self, path: Toolpath, context: PassContext) -> InputError | None:
        """Return why the control itself stops where it is left to resolve a path; None: it goes on.

        Only what is certain counts.
        """
        return None

    def prove(self, before: Toolpath, after: Toolpath, context: PassContext) -> None:
        """Check what a pass that resolves has made of the path as read; VerificationError if wrong.

        It shares no code with `apply`.
        """
        raise NotImplementedError


@dataclass(frozen=True)
class TextPass:
    """The base of the passes that change text and no meaning: `edit` returns a block's new text.

    `edit` gets the tree of a block and its number, counted from 0 over the blocks that `counts`
    names and that stay; None drops the block. The words of a block, but for N, must stay as they
    are: this is checked on every run.
    """

    name: ClassVar[str] = ""

    def counts(self, block: Block) -> bool:
        """Return whether a block has a number: whether it has words."""
        return any(True for _ in block.words)

    def edit(self, block: Block, number: int) -> str | None:
        """Return the block's new text, or None to drop it."""
        raise NotImplementedError

    def refuse(self, block: Block) -> str:
        """Return why a program that has this block cannot be edited, or nothing."""
        return ""


def resolved(passes: Sequence[Pass]) -> int:
    """Return after how many steps the path is the one that the rest of the run is compared with."""
    return max((n for n, step in enumerate(passes, 1) if step.resolves), default=0)
