"""Subprograms that nothing calls: they stay behind the end of the program, as they stand.

With them stay those that they call, and those that a skipped block would call: it is copied, and
with the switch off the control executes it.

There the control does not read them in this run, so they are not transformed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.flow.execution import Execution
from gcxform.flow.listing import Definition
from gcxform.modal.meaning.meaning import OWN_MOVES

NAMED = 5  # of the subprograms that a refusal names
HINT = "transform the program that calls it: it is looked up beside that"


def kept(program: Execution) -> tuple[Definition, ...]:
    """Return the subprograms that nothing has called in a run, or what is copied may call.

    There are none if the run has decided nothing, or its blocks are not to be written. What they do
    is not transformed, so a file in which nothing else moves is refused: InputError.
    """
    if not (program.acted and program.keeps):
        return ()
    every = tuple(program.definitions())
    skipped = {name for line in program.skipped for name in program.callees(line) or ()}
    found = tuple(
        each for each in every if each.name in skipped or not program.times[each.lines].any()
    )
    if not found:
        return ()
    first, names = found[0], ", ".join(each.name for each in found[:NAMED])
    if not any(_moves(program, line) for line in np.flatnonzero(program.times).tolist()):
        message = f"nothing moves in this file but in what nothing here calls: {names}"
        raise program.listing.refusal(first.first, "GX226", message, HINT)
    if not program.ended:
        message = f"nothing calls {first.name}, and no end stands behind which it could be kept"
        hint = "end the program with M2 or M30, or take the subprogram out"
        raise program.listing.refusal(first.first, "GX226", message, hint)
    return _with_called(program, every, found)


def _with_called(
    program: Execution, every: tuple[Definition, ...], found: tuple[Definition, ...]
) -> tuple[Definition, ...]:
    """Return the subprograms found, and those that they call, in the order of the file.

    What the program has called as well is written out there, and stays beside it: it would be
    missing for those that are kept as they stand.
    """
    keeps, new = set(found), list(found)
    while new:
        for names in _callees(program, new.pop()):
            called = [each for each in every if names is None or each.name in names]
            new += [each for each in called if each not in keeps]
            keeps.update(called)
    return tuple(each for each in every if each in keeps)


def _callees(program: Execution, one: Definition) -> Iterator[frozenset[str] | None]:
    """Yield what the lines of a subprogram call. A shape that calls nothing is looked at once."""
    plain: set[int] = set()
    for line in range(one.first, one.last + 1):
        shape = int(program.listing.window.shape[line])
        names = frozenset() if shape in plain else program.callees(line)
        if names == frozenset():
            plain.add(shape)
        else:
            yield names


def _moves(program: Execution, line: int) -> bool:
    """Whether a line moves an axis."""
    meaning = program.listing.meaning(line)
    return bool(meaning.axes) or any(act.name in OWN_MOVES for act in meaning.acts)
