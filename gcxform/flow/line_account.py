"""Proves that an execution has left out no line: by its account alone, not by how it went.

Behind a block that decides nothing the next line is executed, as often at least; and so is what
stands behind a loop or a branch that was entered, if nothing inside goes elsewhere. Where the
program ends inside of what was called, the lines that called it are gone on behind once less.
"""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import Diagnostic, Location, VerificationError
from gcxform.flow.execution import Execution
from gcxform.system.arrays import Flags, Ints

HINT = "nothing was written; this is a bug of gcxform"


def check_walk(program: Execution) -> None:
    """Raise VerificationError for a line that was not executed, or not written out."""
    times = program.times
    plain = np.ones(len(times), np.bool_)
    plain[program.listing.special] = False
    _refuse(program, plain & (times != _written(program)), "a block is not written out as often")
    behind = np.append(times[1:], np.iinfo(np.int64).max // 2)
    waiting = [call.back - 1 for call in program.calls] if program.ended else []
    np.add.at(behind, waiting, 1)
    _refuse(program, plain & (behind < times), "the line behind this one is not executed as often")
    for first, last in program.entered():
        inside = np.flatnonzero(times[first : last + 1]) + first
        gone = any(line in waiting or program.leaves(line, first, last) for line in inside.tolist())
        if times[first] and not gone and last + 1 < len(times) and not times[last + 1]:
            _refuse(program, np.arange(len(times)) == last, "what stands behind this is left out")


def _written(program: Execution) -> Ints:
    """Return how often each line stands in what is written, for itself and no other reason."""
    lines = np.concatenate([np.empty(0, np.int64), *program.origin])
    times = np.bincount(lines, minlength=len(program.times))
    for each in program.behind:
        times[each.first : each.last + 1] -= 1
    return np.asarray(times)


def _refuse(program: Execution, wrong: Flags, message: str) -> None:
    if wrong.any():
        where = Location(*program.listing.place(int(np.argmax(wrong))))
        raise VerificationError((Diagnostic("GX601", message, where, HINT),))
