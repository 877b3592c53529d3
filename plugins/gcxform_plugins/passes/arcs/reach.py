"""Which lines become one arc: from each start as far as the tolerance reaches.

All runs of a window are walked at the same time, one trial of each in one step: the number of lines
is doubled while an arc fits them, then halved in between. Long runs are cut into blocks, so that
there are many to be walked, and arcs that meet at a cut are joined again.

A block of the program may have become many rows. An arc that goes on into another block goes on to
the end of one, so that a block is either gone as a whole or still has its beginning.

What the lines before a better arc have been taken for is then given back to it.
"""

from __future__ import annotations

import numpy as np

from gcxform.vocabulary import Flags, Ints
from gcxform_plugins.passes.arcs.fit import Fit

BLOCK = 512  # lines; runs are walked in blocks of at most so many
SHORT = 4  # times the fewest lines: an arc so short may be what led to a better one
NOTHING = np.empty(0, np.int64)


class Ends:
    """Where arcs may end: rows here are stops, the rows after the last one of an arc."""

    def __init__(self, block: Ints) -> None:
        ends = np.append(block[1:] != block[:-1], True)
        stop = np.arange(len(block) + 1)
        self.before = np.maximum.accumulate(np.where(np.append(True, ends), stop, 0))
        after = np.where(np.append(True, ends), stop, len(block))
        self.after = np.minimum.accumulate(after[::-1])[::-1]

    def _own(self, first: Ints, stop: Ints) -> Flags:
        """Return which arcs are in the block in which they begin."""
        return np.asarray(stop <= self.after[first + 1])

    def good(self, first: Ints, stop: Ints) -> Flags:
        """Return which arcs may end where they do."""
        return np.asarray(self._own(first, stop) | (self.before[stop] == stop))

    def down(self, first: Ints, stop: Ints) -> Ints:
        """Return the last places up to `stop` where arcs may end."""
        return np.where(self._own(first, stop), stop, self.before[stop])

    def up(self, first: Ints, stop: Ints) -> Ints:
        """Return the first places from `stop` on where arcs may end."""
        return np.where(self._own(first, stop), stop, self.after[stop])


def farthest_reaching(fit: Fit, follows: Flags, block: Ints, fewest: int) -> tuple[Ints, Ints]:
    """Return the first and the last row of each arc.

    `follows` (rows,) says which rows may be one arc with the row before; `block` (rows,) is the
    block each came from.
    """
    ends = Ends(block)
    begin, stop = _blocks(follows, fewest)
    first, last = _walk(fit, ends, begin, stop, fewest)
    first, last = _begun_earlier(fit, ends, follows, first, last, fewest)
    first, last = _joined_at(fit, ends, follows, first, last, begin)
    return first, last - 1


def _blocks(follows: Flags, fewest: int) -> tuple[Ints, Ints]:
    """Return begin and stop (exclusive) of the blocks of rows to be walked."""
    begin = np.flatnonzero(~follows)
    stop = np.append(begin[1:], len(follows))
    long = stop - begin >= fewest
    begin, stop = begin[long], stop[long]
    parts = -(-(stop - begin) // BLOCK)
    run = np.repeat(np.arange(len(begin)), parts)
    nth = np.arange(len(run)) - (np.cumsum(parts) - parts)[run]
    size = (stop - begin)[run]
    return begin[run] + size * nth // parts[run], begin[run] + size * (nth + 1) // parts[run]


def _walk(fit: Fit, ends: Ends, begin: Ints, stop: Ints, fewest: int) -> tuple[Ints, Ints]:
    """Return first row and stop of the arcs in blocks, each as long as it can be."""
    at, stop = begin.copy(), stop.copy()
    found: list[tuple[Ints, Ints]] = [(NOTHING, NOTHING)]
    good, curved = np.zeros(len(at), np.int64), np.zeros(len(at), np.bool_)
    bad = stop - at + 1
    while True:
        on = stop - at >= fewest
        if not on.all():
            at, stop, good, bad, curved = at[on], stop[on], good[on], bad[on], curved[on]
        if not len(at):
            break
        room = stop - at
        trial = np.where(bad > room, np.minimum(np.maximum(2 * good, fewest), room), 0)
        trial = np.where(trial == 0, np.maximum((good + bad) // 2, 1), trial)
        trial = ends.down(at, at + trial) - at
        lost = trial <= good
        trial = np.where(lost, ends.up(at, at + np.minimum(good + 1, room)) - at, trial)
        none = (trial >= bad) | (trial > room) | (trial <= good)
        arcs = fit.arcs(at, np.where(none, at + 1, at + trial))
        near = arcs.near & ~none
        curved = np.where(near, arcs.curved, curved)
        good, bad = np.where(near, trial, good), np.where(near | none, bad, trial)
        done = none | (bad - good <= 1) | (good == room) | (bad <= fewest)
        arc = done & curved & (good >= fewest)
        found.append((at[arc], (at + good)[arc]))
        at = at + np.where(done, np.where(arc, good, np.maximum(good // 2, 1)), 0)
        good, curved = np.where(done, 0, good), curved & ~done
        bad = np.where(done, stop - at + 1, bad)
    first = np.concatenate([a for a, _ in found])
    order = np.argsort(first, kind="stable")
    return first[order], np.concatenate([b for _, b in found])[order]


def _begun_earlier(
    fit: Fit, ends: Ends, follows: Flags, first: Ints, last: Ints, fewest: int
) -> tuple[Ints, Ints]:
    """Let arcs begin earlier, where lines or a short arc before them are theirs as well.

    Walking forward, what leads from a straight line into an arc is found first, as an arc of its
    own that ends where the better one should have begun.
    """
    if not len(first):
        return first, last
    low = np.append(0, last[:-1])
    meets = np.append(False, first[1:] == last[:-1])
    short = np.append(False, (last - first)[:-1] <= SHORT * fewest)
    low = np.where(meets & short, np.append(0, first[:-1]), low)
    rows = np.arange(len(follows))
    run = np.maximum.accumulate(np.where(follows, 0, rows))
    low = np.maximum(low, run[first])
    begun = _backwards(fit, ends, first, last, low)
    shorter = np.flatnonzero(begun[1:] < last[:-1])
    rest = begun[shorter + 1] - first[shorter] >= fewest
    rest[rest] = fit.arcs(first[shorter[rest]], begun[shorter[rest] + 1]).curved
    begun[shorter[rest] + 1] = first[shorter[rest] + 1]  # two arcs before and after: no better
    stop = np.minimum(last, np.append(begun[1:], len(follows)))
    changed = (begun != first) | (stop != last)
    enough = (stop - begun >= fewest) & ends.good(begun, stop)
    begun, stop, changed = begun[enough], stop[enough], changed[enough]
    kept = np.ones(len(begun), np.bool_)
    kept[changed] = fit.arcs(begun[changed], stop[changed]).curved
    return begun[kept], stop[kept]


def _backwards(fit: Fit, ends: Ends, first: Ints, last: Ints, low: Ints) -> Ints:
    """Return where arcs can begin that end at `last`, not before `low`."""
    good, bad = np.zeros(len(first), np.int64), first - low + 1
    left = np.flatnonzero(bad > 1)
    while len(left):
        room = (first - low)[left]
        g, b = good[left], bad[left]
        trial = np.where(b > room, np.minimum(np.maximum(2 * g, 1), room), (g + b) // 2)
        fits = fit.arcs(first[left] - trial, last[left]).curved
        fits &= ends.good(first[left] - trial, last[left])
        good[left] = np.where(fits, trial, g)
        bad[left] = np.where(fits, b, trial)
        left = left[(bad[left] - good[left] > 1) & (good[left] < room)]
    return first - good


def _joined_at(
    fit: Fit, ends: Ends, follows: Flags, first: Ints, last: Ints, seams: Ints
) -> tuple[Ints, Ints]:
    """Join arcs that meet where runs were cut into blocks, if one arc can stand for both."""
    seam = np.zeros(len(follows) + 1, np.bool_)
    seam[seams[follows[seams]]] = True
    while len(first) > 1:
        meet = np.flatnonzero((last[:-1] == first[1:]) & seam[last[:-1]])
        meet = meet[ends.good(first[meet], last[meet + 1])]
        meet = meet[fit.arcs(first[meet], last[meet + 1]).curved] if len(meet) else meet
        meet = meet[np.append(True, np.diff(meet) > 1)[: len(meet)]]
        if not len(meet):
            break
        last[meet] = last[meet + 1]
        stays = np.ones(len(first), np.bool_)
        stays[meet + 1] = False
        first, last = first[stays], last[stays]
    return first, last
