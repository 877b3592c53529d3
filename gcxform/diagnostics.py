"""Diagnostics: what is shown to a user when something cannot be done, and the errors that carry it.

A diagnostic names a code of the catalogue (`gcxform explain GX301`), a place in a text, one
sentence, the modal context and a way out. An error carries one or more of them, and its class says
which exit code the command line returns; nothing below the command line prints or exits.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field, replace
from enum import IntEnum
from typing import ClassVar, Self

from gcxform.values import dataclass

PRINTED_AT_MOST = 20
PLACES_SHOWN = 5  # of the other lines on which a finding holds as well


class Severity(IntEnum):
    """How much a finding matters; only an error stops a run."""

    NOTE = 0
    WARNING = 1
    ERROR = 2


@dataclass(frozen=True)
class Location:
    """A place in a text: file, 1-based line and column, the line's text, columns to mark."""

    file: str
    line: int = 0
    column: int = 1
    text: str = ""
    width: int = 1

    def __str__(self) -> str:
        file = shown(self.file)
        return f"{file}:{self.line}:{self.column}" if self.line else file


def shown(name: str) -> str:
    """Return the name of a file in one line that commands no terminal, whatever it is made of."""
    if name.isprintable():
        return name
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in name)


@dataclass(frozen=True)
class Diagnostic:
    """One finding: `code` is in the catalogue, `message` is one sentence without a full stop.

    `also` are other places with the same cause.
    """

    code: str
    message: str
    where: Location | None = None
    hint: str = ""
    context: str = ""
    severity: Severity = Severity.ERROR
    also: tuple[Location, ...] = ()

    def render(self) -> str:
        """Return the text for a person: place, code, sentence; the line, a caret, a hint."""
        head = f"{self.where}: " if self.where else ""
        lines = [f"{head}{self.severity.name.lower()}[{self.code}]: {self.message}"]
        if self.where is not None and self.where.line and self.where.text:
            lines += _excerpt(self.where)
        if self.context:
            lines.append(f"    = modal: {self.context}")
        if self.also:
            lines.append(f"    = also {_places(self.also)}")
        if self.hint:
            lines.append(f"    = hint: {self.hint}")
        return "\n".join(lines)

    def at(self, where: Location) -> Diagnostic:
        """Return the same finding at a place."""
        return replace(self, where=where)


def _places(places: tuple[Location, ...]) -> str:
    """Return other places in words: "at lines 12, 15, 20 (9 more)"."""
    first = [each for each in places if each.file == places[0].file][:PLACES_SHOWN]
    more = len(places) - len(first)
    lines = ", ".join(str(each.line) for each in first)
    return f"at line{'s' * (len(first) > 1)} {lines}" + (f" ({more} more)" if more else "")


def _excerpt(where: Location) -> list[str]:
    """Return the source line, cut around the caret where it is long, and the caret line."""
    text = "".join(c if c.isprintable() else ("\t" if c == "\t" else "?") for c in where.text)
    first = max(0, where.column - 1 - 60)
    shown = text[first : first + 120]
    number = str(where.line)
    pad = "".join("\t" if c == "\t" else " " for c in text[first : where.column - 1])
    caret = "^" * max(1, min(where.width, len(shown) - len(pad)))
    return [f"{number} | {shown}", f"{' ' * len(number)} | {pad}{caret}"]


@dataclass
class GcxformError(Exception):
    """The root of all errors a user can cause: diagnostics, and the exit code of the process."""

    diagnostics: tuple[Diagnostic, ...] = field(default=())
    exit_code: ClassVar[int] = 70

    def __post_init__(self) -> None:
        super().__init__(self.render())

    @classmethod
    def one(
        cls,
        code: str,
        message: str,
        where: Location | None = None,
        hint: str = "",
        context: str = "",
    ) -> Self:
        """Return an error with a single diagnostic."""
        return cls((Diagnostic(code, message, where, hint, context),))

    def render(self) -> str:
        """Return the diagnostics for a person, at most `PRINTED_AT_MOST` of them."""
        return render_all(self.diagnostics)

    def __str__(self) -> str:
        return self.render()

    def __reduce__(self) -> tuple[type[Self], tuple[tuple[Diagnostic, ...]]]:
        return type(self), (self.diagnostics,)


def render_all(diagnostics: Iterable[Diagnostic]) -> str:
    """Return several diagnostics as one text, the rest counted."""
    found = list(diagnostics)
    lines = [d.render() for d in found[:PRINTED_AT_MOST]]
    if len(found) > PRINTED_AT_MOST:
        lines.append(f"... and {len(found) - PRINTED_AT_MOST} more")
    return "\n".join(lines)


class UsageError(GcxformError):
    """Command line, pipeline, machine or model file: found before any input is read."""

    exit_code: ClassVar[int] = 2


class InputError(GcxformError):
    """The program is refused: not understood, or a pass cannot honour it."""

    exit_code: ClassVar[int] = 3


class SpellingError(InputError):
    """A line of a language cannot be written back in its place; all of them may be, anew."""


class VerificationError(GcxformError):
    """The output is not what it should be: nothing is written."""

    exit_code: ClassVar[int] = 4


class FileError(GcxformError):
    """Reading or writing failed."""

    exit_code: ClassVar[int] = 5
