"""Why a line of the output is another one than in the source: which step has changed it.

A step has changed a line if the moves that come from it are not the same before and behind the
step, or the modes in which its block is to be written. That is asked where somebody looks at what
a run would change (`Plan.told`), and costs nothing otherwise.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from gcxform.system.arrays import Flags, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.columns import COLUMNS
from gcxform.toolpath.path import BLOCK_MODES, Toolpath

Told = Callable[[str, Sequence[int]], object]
"""Takes the name of a step and the lines of the source, from 0, that it has changed."""
ASIDE = ("frame", "nth", "source")  # indices, and a count that follows from the number of rows


def changed_lines(before: Toolpath, after: Toolpath) -> list[int]:
    """Return the lines of the program, from 0, about which two paths differ."""
    return sorted({*_by_moves(before, after), *_by_modes(before, after), *_by_given(before, after)})


def _by_moves(before: Toolpath, after: Toolpath) -> Iterator[int]:
    """Yield the lines whose moves differ in number or in any column."""
    if len(before) == len(after) and np.array_equal(before.source, after.source):
        yield from distinct(before.source[_differ(before, after)]).tolist()
        return
    old, new = _rows(before), _rows(after)
    yield from (line for line in {*old, *new} if old.get(line) != new.get(line))


def _differ(before: Toolpath, after: Toolpath) -> Flags:
    """Return of each row whether it is another one."""
    other = np.zeros(len(before), np.bool_)
    for name in _columns(before, after):
        one, two = (np.asarray(getattr(path, name), np.float64) for path in (before, after))
        same = (one == two) | (np.isnan(one) & np.isnan(two))
        other |= ~same.reshape(len(other), -1).all(axis=1)
    return other


def _columns(*paths: Toolpath) -> list[str]:
    """Return the columns that say what a row does, without those of axes that one path lacks."""
    same = len({path.axes for path in paths}) == 1
    return [name for name in COLUMNS if name not in ASIDE and (same or name not in ("end", "lost"))]


def _rows(path: Toolpath) -> dict[int, bytes]:
    """Return what the rows of each line hold, as bytes."""
    columns = [
        np.asarray(getattr(path, name), np.float64).reshape(len(path), -1)
        for name in _columns(path)
    ]
    table = np.concatenate(columns, axis=1) + 0.0 if len(path) else np.empty((0, 1))
    order: Ints = np.argsort(path.source, kind="stable")
    lines, firsts = np.unique(path.source[order], return_index=True)
    parts = np.split(table[order], firsts[1:])
    return {int(line): part.tobytes() for line, part in zip(lines, parts, strict=False)}


def _by_modes(before: Toolpath, after: Toolpath) -> Iterator[int]:
    """Yield the lines whose blocks are to be written in other modes."""
    for name in BLOCK_MODES:
        one, two = getattr(before.blocks, name), getattr(after.blocks, name)
        if one is not two and len(one) == len(two):
            yield from (np.flatnonzero(one != two) + before.blocks.first).tolist()


def _by_given(before: Toolpath, after: Toolpath) -> Iterator[int]:
    """Yield the lines of events and of blocks of the user's that a step has added or taken."""
    events = [{(each.line, each.what, each.values) for each in p.events} for p in (before, after)]
    given = [{(each.line, each.text) for each in p.given} for p in (before, after)]
    yield from (line for line, *_ in (events[0] ^ events[1]) | (given[0] ^ given[1]))
