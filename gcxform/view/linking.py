"""Which move of one program belongs to which of another, and how far they are apart.

Two paths are matched as `gcxform compare` does, however each of them is cut, so that it does not
matter who wrote the second program. What a pipeline wrote is compared as the machine goes with it:
its passes are undone first, as the proof does.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from gcxform.comparison import REACH, STRAIGHT, TOLERANCE, same_axes
from gcxform.contract.passes import Pass, PassContext
from gcxform.deviations.deviation import deviation
from gcxform.deviations.matching import match
from gcxform.deviations.paired_pieces import measure
from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.path import BLOCK_MODES, Toolpath
from gcxform.toolpath.splines import spline_chords, splines_as_lines
from gcxform.values import dataclass

COMPARED: Final = ("kind", "end", "centre", "sweep", "feed", "feed_mode", "frame", "form", "side")


@dataclass(frozen=True)
class Linked:
    """Rows of two paths that belong together.

    distance  (n,) mm for each row of the first path, and (m,) for each of the second: how far it is
              from the other path; nan where nothing belongs to it
    row       (m,) row of the first path, -1 where nothing belongs to it
    parted    whether there are rows from which nothing fits
    """

    distance: tuple[Floats, Floats]
    row: Ints
    parted: bool


def linked(a: Toolpath, b: Toolpath, owner: Ints | None = None) -> Linked:
    """Return how two paths belong together.

    `owner` (len(b),) is the row of the first path that each of the second came from, where that is
    known. Otherwise rows belong together one by one if they are as many and of the same kinds, and
    near; or both paths are walked along.
    """
    a, b = same_axes(a, b)
    if owner is None and len(a) == len(b) and (a.kind == b.kind).all():
        owner = np.arange(len(b))
    found = None if owner is None else _owned(a, b, owner)
    return found or _walked(a, b)


def _owned(a: Toolpath, b: Toolpath, owner: Ints) -> Linked | None:
    """Return how far rows are from their owners; None where some have nothing in common."""
    distance = deviation(a, b, owner).distance
    if (distance > REACH).any():
        return None
    return Linked((_largest(distance, owner, len(a)), distance), owner, False)


def owners(a: Ints, b: Ints) -> Ints | None:
    """Return the row for which each of others stands, by lines; None where that is not certain.

    `a` (n,) and `b` (m,) are the lines of the first program that the rows of both came from.
    """
    if not len(a) or (np.diff(a) < 1).any():
        return None
    row = np.minimum(np.searchsorted(a, b), len(a) - 1)
    return row if (a[row] == b).all() and (np.diff(row) >= 0).all() else None


def _walked(a: Toolpath, b: Toolpath) -> Linked:
    """Return how two paths belong together of which nothing is known."""
    sizes = len(a), len(b)
    (a, of_a), (b, of_b) = (_straight(path) for path in (a, b))
    matching = match(a, b, TOLERANCE, REACH, partly=True)
    found = measure(a, b, matching, partly=True).distance
    rows = of_a[matching.a.row], of_b[matching.b.row]
    row = np.full(sizes[1], -1)
    row[rows[1][::-1]] = rows[0][::-1]
    one, other = (_largest(found, r, size) for r, size in zip(rows, sizes, strict=True))
    return Linked((one, other), row, matching.parted is not None)


def _straight(path: Toolpath) -> tuple[Toolpath, Ints]:
    """Return a path with lines for its splines, and of which row each of its rows is."""
    pieces = np.ones(len(path), np.int64)
    if path.has_splines:
        rows = np.flatnonzero(path.is_spline)
        pieces[rows] = spline_chords(path, rows, STRAIGHT)
        path = splines_as_lines(path, pieces)
    return path, np.repeat(np.arange(len(pieces)), pieces)


def _largest(distance: Floats, row: Ints, size: int) -> Floats:
    """Return the largest distance of the pieces of each row, nan for a row without any."""
    found = np.full(size, -1.0)
    np.maximum.at(found, row, np.where(np.isfinite(distance), distance, -1.0))
    return np.where(found < 0, np.nan, found)


def undone(path: Toolpath, steps: Sequence[Pass], context: PassContext) -> tuple[Toolpath, Ints]:
    """Return what a machine does with a path that came from passes, and of which row each is."""
    after = path
    for step in reversed(steps):
        after = step.undo(after, context)
    first = np.searchsorted(path.source, after.source, side="left")
    many = len(after) != len(path)
    return after, np.asarray(first + after.nth if many else np.arange(len(path)))


def changed_by(path: Toolpath, steps: Sequence[Pass], context: PassContext) -> Ints:
    """Return for each block which step, from 1, has changed it last; 0 where none has."""
    found = np.zeros(len(path.blocks.inch), np.int64)
    for number, step in enumerate(steps, 1):
        after = step.apply(path.replace(held=path.entry), context)
        found[_unlike(path, after, len(found))] = number
        path = after
    return found


def _unlike(before: Toolpath, after: Toolpath, blocks: int) -> Ints:
    """Return the blocks whose moves or modes are not the same in two paths."""
    counts = [np.bincount(path.source, minlength=blocks) for path in (before, after)]
    unlike = counts[0] != counts[1]
    for name in BLOCK_MODES:
        unlike |= getattr(before.blocks, name) != getattr(after.blocks, name)
    one, other = (np.flatnonzero(~unlike[path.source]) for path in (before, after))
    for name in COMPARED:
        here, there = getattr(before, name)[one], getattr(after, name)[other]
        same = (here == there) | ((here != here) & (there != there))
        whole = same if same.ndim == 1 else same.all(axis=tuple(range(1, same.ndim)))
        unlike[before.source[one[~whole]]] = True
    return np.flatnonzero(unlike)
