"""A source whose calls and loops are written out, or the source itself if it has none."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from gcxform.diagnostics import GcxformError
from gcxform.dialect import Dialect
from gcxform.flow.signs import has_flow
from gcxform.modal.state import Reading
from gcxform.source import Source

if TYPE_CHECKING:
    from gcxform.flow.execution import Execution

EXECUTED = {"o-words": (70, 71, 72, 73, 98, 99), "macro-b": (97, 98, 99)}
"""M codes that are executed, and do not stand in what is written; M97 where a dialect has it."""


class WrittenOut(Source):
    """The blocks a program executes, in their order; `origin` are their lines, from 0."""

    def __init__(self, source: Source, text: bytes, origin: NDArray[np.int64]) -> None:
        super().__init__(Source.of_bytes(text).stream, source.name)
        self.origin = origin

    def line_of(self, line: int) -> int:
        """Return the line of the program that an executed line stands for."""
        inside = 0 < line <= len(self.origin)
        return int(self.origin[line - 1]) + 1 if inside else line


def written_out(source: Source, dialect: type[Dialect], reading: Reading) -> Source:
    """Return a source with the blocks that the control executes.

    That is the source itself if it has neither calls nor loops. Raises InputError where what is
    executed is not known before the control runs.
    """
    if dialect.translator is not None:
        from gcxform.flow.translation import translated

        return translated(source, dialect, reading)
    if not has_flow(source, dialect):
        return source
    run = _executed(b"".join(source.windows()), source.name, dialect, reading)
    if not run.acted:
        return source
    lines = np.concatenate([np.empty(0, np.int64), *run.origin])
    return WrittenOut(source, b"".join(run.text), lines)


def _executed(text: bytes, file: str, dialect: type[Dialect], reading: Reading) -> Execution:
    """Execute a program; what does that is loaded for programs that need it."""
    from gcxform.flow.listing import Listing
    from gcxform.flow.macros import MacroB
    from gcxform.flow.owords import OWords

    kind: type[Execution] = OWords if dialect.flow == "o-words" else MacroB
    run = kind(Listing(text, dialect, file), reading)
    run.run()
    return run


def located(error: GcxformError, source: Source) -> GcxformError:
    """Return an error about executed blocks as one about the lines of the program."""
    found = []
    for diagnostic in error.diagnostics:
        where = diagnostic.where
        if where is not None and where.line and where.file == source.name:
            diagnostic = diagnostic.at(source.shown(where))
        found.append(diagnostic)
    return type(error)(tuple(found))
