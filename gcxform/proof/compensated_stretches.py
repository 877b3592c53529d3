"""Stretches under cutter compensation: each with the move that ends it, whatever the windows are.

A control looks ahead, so what it makes of a move can depend on one that another window has. A
stretch that a window leaves open waits for the rest.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gcxform.toolpath.columns import COLUMNS
from gcxform.toolpath.path import Event, Plane, Toolpath


class Stretches:
    """Is shown the windows of a path in order, and gives the stretches that are complete."""

    def __init__(self) -> None:
        self._open: Toolpath | None = None

    @property
    def waiting(self) -> Toolpath | None:
        """What there is of a stretch that is not complete yet."""
        return self._open

    def of(self, path: Toolpath, end: Event | None) -> list[Toolpath]:
        """Return the stretches that are complete with this window.

        `end` is the event that ends the program, if it does here: it ends compensation too.
        """
        found = list(self._complete(path))
        if end is not None and self._open is not None:
            found.append(self._open.replace(events=(end.at(len(self._open)),)))
            self._open = None
        return [_flat(stretch) for stretch in found]

    def _complete(self, path: Toolpath) -> Iterator[Toolpath]:
        on, goes_on = path.side != 0, self._open is not None
        begins = np.flatnonzero(on & ~np.append(goes_on, on[:-1])[: len(on)]).tolist()
        for first in [0] * (goes_on and len(on) > 0) + begins:
            off = np.flatnonzero(~on[first:])
            last = first + int(off[0]) + 1 if len(off) else len(path)
            piece = _rows(path, first, last)
            whole = piece if self._open is None else _joined(self._open, piece)
            self._open = None if len(off) else whole
            if len(off):
                yield whole


def _rows(path: Toolpath, first: int, last: int) -> Toolpath:
    """Return rows of a path, without what stands between them."""
    return path.take(np.arange(first, last)).replace(
        entry=path.start[first].copy(), events=(), given=()
    )


def _joined(one: Toolpath, other: Toolpath) -> Toolpath:
    """Return the rows of a path and of the one that goes on from there."""
    frames = list(one.frames)
    frames += [frame for frame in other.frames if frame not in frames]
    number = np.array([frames.index(frame) for frame in other.frames])
    columns: dict[str, Any] = {
        name: np.concatenate([getattr(one, name), getattr(other, name)]) for name in COLUMNS
    }
    columns["frame"] = np.concatenate([one.frame, number[other.frame]])
    return one.replace(frames=tuple(frames), **columns)


def _flat(path: Toolpath) -> Toolpath:
    """Return a stretch at height 0 where its height is not known: it has no part in this."""
    axis = Plane(int(path.plane[0])).axes[2]
    end, entry = path.end.copy(order="F"), path.entry.copy()
    end[np.isnan(end[:, axis]), axis] = 0.0
    entry[axis] = np.nan_to_num(entry[axis])
    return path.replace(end=end, entry=entry, lost=path.lost & ~(1 << axis))
