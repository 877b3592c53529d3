"""The blocks that a program executes, as a source, and what has become of its lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from hashlib import sha256
from math import isnan

import numpy as np

from gcxform.diagnostics import InputError, Location
from gcxform.dialect.arithmetic import Key
from gcxform.modal.inventory import Account, nothing_held
from gcxform.syntax.source import Source, lines_in
from gcxform.syntax.undecided import DECIDED, Undecided
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

NEAR = 1e-11  # of a value: as many digits as are written


@dataclass(frozen=True, slots=True)
class CalledFile:
    """A file that a program calls, and what it is called in messages.

    Its lines are counted on behind those of the program: `first`, from 0, is its first one.
    """

    name: str
    first: int
    text: bytes

    def described(self) -> dict[str, str | int]:
        """Return what a certificate says of the file; `first` is its first line in source maps."""
        lines = lines_in(self.text) if self.text else 0
        digest = sha256(self.text).hexdigest()
        return {"name": self.name, "first": self.first + 1, "lines": lines, "sha256": digest}


@dataclass(frozen=True, slots=True)
class Executed:
    """What calls and loops did with what the lines of a program hold, as counts (kinds,).

    held        in the lines of the program as they stand
    idle        in lines that are not executed, and are not kept either
    locals_set  how often a parameter was set that ends with its call, or with the program
    assigned    the others, with their values, in order
    kept        how many subprograms stay: nothing calls them, or one of them does
    unmoved     why nothing is said of what the file does: these alone move; None if others do
    unended     why these cannot stand behind the end; None if they can
    """

    held: Ints
    idle: Ints
    locals_set: int
    assigned: tuple[tuple[Key, float], ...]
    kept: int
    unmoved: InputError | None = None
    unended: InputError | None = None

    def refuse(self, moves: bool, folds: bool) -> None:
        """Raise InputError for what cannot be kept.

        `moves`: positions are turned into others, `folds`: what is written keeps its structure.
        """
        if moves and self.unmoved is not None:
            raise self.unmoved
        if not folds and self.unended is not None:
            raise self.unended

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
            key == other
            and (abs(value - now) <= NEAR * abs(value) or (isnan(value) and isnan(now)))
            for (key, value), (other, now) in zip(self.assigned, read, strict=True)
        )


class WrittenOut(Source):
    """The blocks a program executes, in their order; `origin` are their lines, from 0.

    Lines of `files` are counted on behind those of the program.
    """

    def __init__(
        self,
        source: Source,
        text: bytes,
        origin: Ints,
        assumed: Iterable[str] = (),
        files: tuple[CalledFile, ...] = (),
        undecided: Undecided = DECIDED,
    ) -> None:
        super().__init__(Source.of_bytes(text).stream, source.name)
        self.origin = origin
        self.files = files
        self.assumed = tuple(assumed)
        self.undecided = undecided
        self.executed: Executed | None = None
        self.called = np.zeros(0, np.bool_)

    def line_of(self, line: int) -> int:
        """Return the line of the program that an executed line stands for."""
        inside = 0 < line <= len(self.origin)
        return int(self.origin[line - 1]) + 1 if inside else line

    def place_of(self, line: int) -> tuple[str, int]:
        """Return the file, and its line, from 1, that an executed line stands for."""
        number = self.line_of(line)
        file = next((each for each in reversed(self.files) if number > each.first), None)
        return (self.name, number) if file is None else (file.name, number - file.first)

    def shown(self, where: Location) -> Location:
        """Return a place in a file for one in the text."""
        file, line = self.place_of(where.line)
        return replace(where, file=file, line=line)

    def is_called(self, line: int) -> bool:
        """Whether a line of the text, from 0, came from a subprogram that was called."""
        return bool(line < len(self.called) and self.called[line])
