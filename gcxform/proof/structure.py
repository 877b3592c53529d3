"""Proves a program that has calls and loops: it is executed, and does what has been proved.

The blocks that the control executes were proved as they were written one after the other. The
program that keeps its structure is executed anew, as the control will: what it executes has to be
those blocks, byte for byte, and then numbers, modes, events, assignments and messages are the same.
What is not executed stands in it as it did, in its order. How it was folded is not asked.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.diagnostics import Diagnostic, GcxformError, Location, VerificationError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.straightened import written_out
from gcxform.flow.walk import Walk, Walked
from gcxform.modal.inventory import Tally
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.stamps.comment import is_stamp
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source
from gcxform.system.arrays import Ints

HINT = "nothing was written; this is a bug of gcxform"


def check_executed(
    written: Source,
    lines: Sequence[int],
    proved: bytes,
    dialect: type[Dialect],
    reading: Reading,
    known: Walked | None = None,
) -> None:
    """Check that what was written executes what was proved. Raises VerificationError.

    `lines` are those of the program, from 0, that its lines are for. `known` is what a program of
    the same bytes has executed, with the same reading.
    """
    file = written.name
    try:
        executed = known or written_out(written, dialect, reading, dialect)
    except GcxformError as error:
        why = "; ".join(each.message for each in error.diagnostics)
        where = next((each.where.line - 1 for each in error.diagnostics if each.where), 0)
        raise _wrong(f"what was written is not executed: {why}", lines, where, file) from None
    now, wanted = b"".join(executed.windows()).splitlines(), proved.splitlines()
    now = now[: _last(executed, dialect, reading)]  # without what stands behind the end
    if now == wanted:
        return
    same = zip(now, wanted, strict=False)
    at = next((k for k, (a, b) in enumerate(same) if a != b), min(len(now), len(wanted)))
    said = [
        repr(each[at].decode("latin-1")) if at < len(each) else "nothing" for each in (now, wanted)
    ]
    where = executed.line_of(at + 1) - 1 if isinstance(executed, Walked) else at
    raise _wrong(f"what was written executes {said[0]}, and not {said[1]}", lines, where, file)


def _last(written: Source, dialect: type[Dialect], reading: Reading) -> int | None:
    """Return how many lines of an executed program come before its end; None for all."""
    if isinstance(written, Walked):
        return written.walk.blocks
    if written.undecided.alarm is not None:
        return written.undecided.alarm + 1
    if not dialect.program_rule.stops_at_end:
        return None
    window, table = _read(b"".join(written.windows()), dialect)
    ends = table.flag("ends", window.shape)
    if reading.blocks_with_a_slash(dialect) != "execute":
        ends &= ~table.flag("deleted", window.shape)
    return int(np.argmax(ends)) + 1 if ends.any() else None


def check_kept(text: bytes, walk: Walk, gone: Sequence[tuple[int, int]] | None, file: str) -> None:
    """Check that lines that are not executed stand in a text, as they are, in their order.

    So does the first line of every definition. Lines in `gone`, first and last, are written out:
    something in each was executed. None: of all lines those of definitions alone are left, and each
    of these stands as it is. Raises VerificationError.
    """
    idle = (walk.times[: walk.listing.own] == 0) & (gone is not None)
    for each in walk.kept if gone is not None else walk.definitions:
        idle[each.first : each.last + 1] = True
    idle[[each.first for each in walk.definitions]] = True
    for first, last in gone or ():
        if idle[first : last + 1].all():
            raise _wrong("what is not executed is gone", (), first, file)
        idle[first : last + 1] = False
    written = iter(text.splitlines())
    for line in np.flatnonzero(idle).tolist():
        old = walk.listing.window.line(line)
        if is_stamp(old.decode("latin-1").strip()):
            continue
        if not any(new == old for new in written):
            raise _wrong("a line that is not executed is gone, or moved", (), line, file)


def held_by(text: bytes, dialect: type[Dialect]) -> Ints:
    """Return what a text holds as it stands, (kinds,)."""
    window, table = _read(text, dialect)
    return Tally().add(table, window.shape)


def _read(text: bytes, dialect: type[Dialect]) -> tuple[Window, MeaningTable]:
    """Return a text as one window, with what its lines mean."""
    reader = WindowReader(dialect)
    window = reader.read(text)
    reader.table.update()
    return window, reader.table


def _wrong(message: str, lines: Sequence[int], at: int, file: str) -> VerificationError:
    """Return the error about a line of a text, or of the program."""
    line = lines[at] if 0 <= at < len(lines) else at
    return VerificationError((Diagnostic("GX601", message, Location(file, line + 1), HINT),))
