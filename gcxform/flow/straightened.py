"""A source whose calls and loops are written out, or the source itself if it has none."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from gcxform.diagnostics import GcxformError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.detection import aliases, has_flow
from gcxform.flow.executed import Executed, WrittenOut
from gcxform.modal.inventory import Tally
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source
from gcxform.syntax.undecided import Undecided
from gcxform.system.arrays import Flags

if TYPE_CHECKING:
    from gcxform.flow.execution import Execution

EXECUTED = {"o-words": (70, 71, 72, 73, 98, 99), "macro-b": (97, 98, 99)}
"""M codes that are executed, and do not stand in what is written; M97 where a dialect has it."""


def written_out(
    source: Source,
    dialect: type[Dialect],
    reading: Reading,
    target: type[Dialect] | None = None,
) -> Source:
    """Return a source with the blocks that the control executes.

    That is the source itself if it has neither calls nor loops. With a `target` the blocks are to
    be written for it: parameters that last are set in them, and subprograms that nothing calls
    stand behind the end. Raises InputError where what is executed is not known before the control
    runs.
    """
    if dialect.translator is not None:
        from gcxform.flow.translated import translated

        return translated(source, dialect, reading)
    assigns = target is not None and _assigns_for(source, dialect, target)
    if not assigns and not has_flow(source, dialect, reading.control):
        return source
    from gcxform.flow.uncalled_subprograms import callees

    keeps = target is not None
    run = _executed(source, dialect, reading, keeps)
    if not run.acted and not (assigns and run.lasting.outputs.assigned):
        source.assumed = tuple(run.assumed)
        source.undecided = Undecided(alarm=run.alarm)
        return source
    from gcxform.flow.corners import refuse_parted
    from gcxform.flow.walk import Walked

    lines = np.concatenate([np.empty(0, np.int64), *run.origin])
    text = b"".join(run.text)
    refuse_parted(run, dialect, text, lines)
    undecided = replace(run.undecided(), alarm=run.alarm)
    found = WrittenOut(source, text, lines, run.assumed, run.listing.files, undecided)
    if not undecided:
        found = Walked(source, text, lines, run.walk(callees(run)), run.assumed)
        found.undecided = undecided
    found.executed = _account(run)
    found.called = _inside(run)[lines]
    return found


def _inside(run: Execution) -> Flags:
    """Return which lines of a program stand in its subprograms."""
    inside = np.zeros(len(run.listing.window), np.bool_)
    for definition in run.definitions():
        inside[definition.lines] = True
    inside[run.listing.own :] = True
    return inside


def _account(run: Execution) -> Executed:
    """Return what an execution did with what the lines hold."""
    from gcxform.flow.uncalled_subprograms import why_not_behind, why_nothing_is_done

    shapes, table = run.listing.window.shape[: run.listing.own], run.listing.table
    idle = run.times[: run.listing.own] == 0
    for each in run.behind:
        idle[each.first : each.last + 1] = False
    for definition in run.definitions():
        idle[definition.first] &= not run.times[definition.lines].any()
    made = tuple((key, value) for _, key, value in run.lasting.outputs.assigned)
    held, left = Tally().add(table, shapes), Tally().add(table, shapes[idle])
    refusals = why_nothing_is_done(run), why_not_behind(run)
    return Executed(held, left, run.lasting.locals_set, made, len(run.kept), *refusals)


def _assigns_for(source: Source, dialect: type[Dialect], target: type[Dialect]) -> bool:
    """Whether assignments of a program are to be written for another control."""
    rule = dialect.flow_rule
    if dialect.name == target.name or not rule.language or target.flow_rule.arithmetic is None:
        return False
    return any(b"#" in text and b"=" in text for text in source.windows())


def _executed(source: Source, dialect: type[Dialect], reading: Reading, keeps: bool) -> Execution:
    """Execute a program; what does that is loaded for programs that need it."""
    from gcxform.flow.line_account import check_walk
    from gcxform.flow.listing import Listing
    from gcxform.flow.lookup import Folders
    from gcxform.flow.macros import MacroB
    from gcxform.flow.owords import OWords
    from gcxform.flow.rerun import Again, Settled
    from gcxform.flow.uncalled_subprograms import kept

    kind: type[Execution] = OWords if dialect.flow_rule.language == "o-words" else MacroB
    beside = [source.folder] if source.folder is not None else []
    folders = Folders([*beside, *reading.subprograms], dialect.flow_rule.lookup, source.suffix)
    listing = Listing(b"".join(source.windows()), dialect, source.name, folders)
    listing.take_for_calls(frozenset(aliases(reading.control)))
    settled = Settled()
    while True:
        run = kind(listing, reading, keeps)
        run.settled = settled
        try:
            run.run()
            run.close(kept(run))
            check_walk(run)
            return run
        except Again as again:
            settled = again.settled


def located(error: GcxformError, source: Source) -> GcxformError:
    """Return an error about executed blocks as one about the lines of the program."""
    found = []
    for diagnostic in error.diagnostics:
        where = diagnostic.where
        if where is not None and where.line and where.file == source.name:
            diagnostic = diagnostic.at(source.shown(where))
        found.append(diagnostic)
    return type(error)(tuple(found))
