"""The contract of a pass: what it needs, what it promises, and how its work can be undone.

A pass is a frozen dataclass whose fields are its options. It turns one toolpath into another, as a
pure function, and declares a tolerance and an `undo`: the model of what the machine does with its
output. The law, in the tests and on every run, is

    deviation(before, undo(after)) <= promise

along every move. `undo` uses the forward model and shares no code with the search it checks.

A pass that resolves (`Demands.resolves`) gives the program another path on purpose, as the control
would do it: the centre of the tool in place of the contour. `prove` checks that path against the
program as read, and what comes after it is compared with that path.

What a pass promises is called `promise`, because `tolerance` is the name that options have.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, ClassVar

from gcxform.contract.demands import Demands
from gcxform.contract.tip_codes import switches_of
from gcxform.diagnostics import InputError
from gcxform.dialect.code_translation import Saying
from gcxform.dialect.dialect import Dialect, NumberFormat
from gcxform.syntax.tree import Block
from gcxform.toolpath.facts import Fact
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.machine.machine import Machine


@dataclass(frozen=True)
class PassContext:
    """What surrounds a pass: the dialects it works between, the output's numbers, the machine.

    `decimals` are those of addresses that differ from the number format; `said` is what the user
    says of codes of the source. `keeps_tips`: codes that follow the tip are read, and stay, so that
    rows which follow have positions of the tip.
    """

    source: type[Dialect]
    target: type[Dialect]
    numbers: NumberFormat
    machine: Machine | None = None
    decimals: Mapping[str, int] = field(default_factory=dict)
    said: Saying | None = None
    keeps_tips: bool = False

    @property
    def saying(self) -> Saying:
        """How the target says what codes of the source do."""
        return self.said or Saying(self.source, self.target)

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

    `name` is what a pipeline calls it; its docstring is its documentation. `name` and
    `apply` are enough for a pass that is exact. Override `promise` when it may deviate, `undo` when
    the machine turns its output into something else, `demands` when a run has to know more of it.
    """

    name: ClassVar[str] = ""
    requires: ClassVar[frozenset[Fact]] = frozenset()
    ensures: ClassVar[frozenset[Fact]] = frozenset()
    clears: ClassVar[frozenset[Fact]] = frozenset()

    @property
    def demands(self) -> Demands:
        """What it asks of a run besides."""
        return Demands()

    @property
    def promise(self) -> float:
        """How far the path may deviate (mm); inf where nothing is promised."""
        return 0.0

    def begin(self, context: PassContext) -> None:
        """Look at the context before any input is read; raise UsageError if it does not fit."""

    def apply(self, path: Toolpath, context: PassContext) -> Toolpath:
        """Return the changed path. Raises InputError, with lines, for what it cannot honour."""
        raise NotImplementedError

    def undo(self, path: Toolpath, context: PassContext) -> Toolpath:
        """Return what the machine does with a path that came from this pass."""
        return path

    def measure(
        self, before: Toolpath, after: Toolpath, context: PassContext
    ) -> Mapping[str, float]:
        """Return what the certificate shall say of a window besides the deviation, by its name.

        Of each name the largest value of the run is told, or the sum (`Demands.counts`).
        """
        return {}

    def added(self, before: Toolpath, after: Toolpath, context: PassContext) -> Mapping[str, int]:
        """Return how many things of a window the source does not have, by name, if any may be."""
        return {}

    def prove(self, before: Toolpath, after: Toolpath, context: PassContext) -> None:
        """Check what a pass that resolves has made of the path as read; VerificationError if wrong.

        It shares no code with `apply`.
        """
        raise NotImplementedError


@dataclass(frozen=True)
class CompensationPass(Pass):
    """The base of a pass that resolves cutter compensation, which controls do in several ways."""

    @classmethod
    def ways(
        cls, dialect: type[Dialect], control: Mapping[str, str | float]
    ) -> tuple[CompensationPass, ...]:
        """Return the passes that, together, resolve in all ways in which such controls may do it.

        Where a parameter of the machine decides there is one for each of its settings, or the one
        that `control` has, the settings of a machine file.
        """
        return ()

    def stops(self, path: Toolpath, context: PassContext) -> InputError | None:
        """Return why the control itself stops where it is left to resolve a path; None: it goes on.

        Only what is certain counts.
        """
        return None


@dataclass(frozen=True)
class TextPass:
    """The base of the passes that change text and no meaning: `edit` returns a block's new text.

    `edit` gets the tree of a block and its number, counted from 0 over the blocks that `counts`
    names and that stay; None drops the block. The words of a block, but for N, must stay as they
    are: this is checked on every run.

    Where a block `asks` for the whole program, `rewritten` gets all blocks at once, and may change
    the numbers of lines that jumps name as well: that they lead where they led is checked.
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

    def asks(self, block: Block) -> bool:
        """Return whether a program that has this block is to be seen as a whole."""
        return False

    def refused(self, blocks: Sequence[Block], dialect: type[Dialect]) -> tuple[int, str] | None:
        """Return a block by which a whole program cannot be edited, and why."""
        return None

    def rewritten(self, blocks: Sequence[Block], dialect: type[Dialect]) -> list[str]:
        """Return the new texts of all blocks of a program."""
        raise NotImplementedError


def resolved(passes: Sequence[Pass]) -> int:
    """Return after how many steps the path is the one that the rest of the run is compared with."""
    return max((n for n, step in enumerate(passes, 1) if step.demands.resolves), default=0)
