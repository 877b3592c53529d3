"""Subprograms that nothing calls: they stay as they stand.

That is where they are, or behind the end of a program that is written out. With them stay those
that they call, and those that a skipped block would call: it is copied, and with the switch off the
control executes it.

The control does not execute them in this run, so they are not transformed.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.flow.execution import Execution
from gcxform.flow.listing import Definition
from gcxform.modal.meaning.meaning import OWN_MOVES

NAMED = 5  # of the subprograms that a refusal names
HINT = "transform the program that calls it: it is looked up beside that"


def kept(program: Execution) -> tuple[Definition, ...]:
    """Return the subprograms that nothing has called in a run, or what is copied may call.

    There are none if the run has decided nothing, or its blocks are not to be written.
    """
    if not (program.acted and program.keeps):
        return ()
    every = tuple(program.definitions())
    skipped = {name for line in program.skipped for name in program.callees(line) or ()}
    found = tuple(
        each for each in every if each.name in skipped or not program.times[each.lines].any()
    )
    return _with_called(program, every, found)


def why_nothing_is_done(program: Execution) -> InputError | None:
    """Return why a run says nothing of what a file does: it moves in what is kept, and only there.

    None if it does say something, or nothing in the file moves.
    """
    if not program.kept:
        return None
    ran = np.flatnonzero(program.times).tolist()
    inside = (n for each in program.kept for n in range(each.first, each.last + 1))
    if any(_moves(program, n) for n in ran) or not any(_moves(program, n) for n in inside):
        return None
    names = ", ".join(each.name for each in program.kept[:NAMED])
    message = f"nothing moves in this file but in what nothing here calls: {names}"
    return program.listing.refusal(program.kept[0].first, "GX226", message, HINT)


def why_not_behind(program: Execution) -> InputError | None:
    """Return why what is kept cannot stand behind the end; None if it can."""
    if program.ended or not program.kept:
        return None
    first = program.kept[0]
    message = f"nothing calls {first.name}, and no end stands behind which it could be kept"
    hint = "end the program with M2 or M30, or take the subprogram out"
    return program.listing.refusal(first.first, "GX226", message, hint)


def _with_called(
    program: Execution, every: tuple[Definition, ...], found: tuple[Definition, ...]
) -> tuple[Definition, ...]:
    """Return the subprograms found, and those that they call, in the order of the file.

    What the program has called as well is written out there, and stays beside it: it would be
    missing for those that are kept as they stand.
    """
    keeps, new = set(found), list(found)
    while new:
        called = _called_by(program, new.pop(), every)
        new += [each for each in called if each not in keeps]
        keeps.update(called)
    return tuple(each for each in every if each in keeps)


def callees(program: Execution) -> dict[int, tuple[Definition, ...]]:
    """Return the subprograms that each one of the file may call, by its first line."""
    every = tuple(program.definitions())
    return {each.first: _called_by(program, each, every) for each in every}


def _called_by(
    program: Execution, one: Definition, every: tuple[Definition, ...]
) -> tuple[Definition, ...]:
    calls = [*_calls_of(program, one)]
    if None in calls:
        return every
    names = frozenset().union(*(each for each in calls if each is not None))
    return tuple(each for each in every if each.name in names)


def _calls_of(program: Execution, one: Definition) -> Iterator[frozenset[str] | None]:
    """Yield what the lines of a subprogram call. A shape that calls nothing is looked at once."""
    shape = program.listing.window.shape[one.first : one.last + 1]
    for each, line in zip(*np.unique(shape, return_index=True), strict=True):
        if program.callees(one.first + int(line)) != frozenset():
            for like in np.flatnonzero(shape == each).tolist():
                yield program.callees(one.first + like)


def _moves(program: Execution, line: int) -> bool:
    """Whether a line moves an axis."""
    meaning = program.listing.meaning(line)
    return bool(meaning.axes) or any(act.name in OWN_MOVES for act in meaning.acts)
