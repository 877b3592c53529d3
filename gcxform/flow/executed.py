"""The blocks that a program executes, as a source, and what has become of its lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.modal.inventory import Account, nothing_held
from gcxform.syntax.source import Source
from gcxform.system.arrays import Ints

NEAR = 1e-11  # of a value: as many digits as are written


@dataclass(frozen=True, slots=True)
class Executed:
    """What calls and loops did with what the lines of a program hold, as counts (kinds,).

    held        in the lines of the program as they stand
    idle        in lines that are not executed, and are not kept either
    locals_set  how often a parameter was set that ends with its call, or with the program
    assigned    the others, with their values, in order
    kept        how many subprograms stay: nothing calls them, or one of them does
    """

    held: Ints
    idle: Ints
    locals_set: int
    assigned: tuple[tuple[Key, float], ...]
    kept: int

    def explain(self, account: Account, written: Ints) -> None:
        """Say by which rules the lines became the blocks that were written out."""
        account.rule("not executed: behind the end, or in a branch not taken", -self.idle)
        ended = "parameters that end with the program: their values are in the words"
        account.rule_of(ended, "assignments", -self.locals_set)
        rest = written - account.source - sum(account.rules.values(), nothing_held())
        account.rule("calls and loops written out", rest)

    def agrees(self, read: Sequence[tuple[Key, float]]) -> bool:
        """Whether the blocks, read again, set the same parameters."""
        return len(read) == len(self.assigned) and all(
            key == other and abs(value - now) <= NEAR * abs(value)
            for (key, value), (other, now) in zip(self.assigned, read, strict=True)
        )


class WrittenOut(Source):
    """The blocks a program executes, in their order; `origin` are their lines, from 0."""

    def __init__(
        self,
        source: Source,
        text: bytes,
        origin: Ints,
        assumed: Iterable[str] = (),
    ) -> None:
        super().__init__(Source.of_bytes(text).stream, source.name)
        self.origin = origin
        self.assumed = tuple(assumed)
        self.executed: Executed | None = None
        self.called = np.zeros(0, np.bool_)

    def line_of(self, line: int) -> int:
        """Return the line of the program that an executed line stands for."""
        inside = 0 < line <= len(self.origin)
        return int(self.origin[line - 1]) + 1 if inside else line

    def is_called(self, line: int) -> bool:
        """Whether a line of the text, from 0, came from a subprogram that was called."""
        return bool(line < len(self.called) and self.called[line])
