"""What each tool of a program does: when, where, how fast."""

from __future__ import annotations

from dataclasses import field
from typing import Any

import numpy as np

from gcxform.dialect.dialect import Dialect
from gcxform.system.arrays import Flags, Floats
from gcxform.toolpath.circles import arc_extremes
from gcxform.toolpath.path import Event, FeedMode, Kind, Toolpath
from gcxform.toolpath.splines import spline_extremes
from gcxform.toolpath.tools import NONE, ToolInSpindle
from gcxform.values import dataclass


class Range:
    """The least and the largest of some numbers; empty until one is known."""

    def __init__(self) -> None:
        self.low, self.high = np.inf, -np.inf

    def add(self, values: Any) -> None:
        """Take numbers into account; those that are not known count nothing."""
        known = np.asarray(values, np.float64)
        known = known[np.isfinite(known)]
        if len(known):
            self.low = min(self.low, float(known.min()))
            self.high = max(self.high, float(known.max()))

    @property
    def pair(self) -> list[float] | None:
        """Both, or None if there are none."""
        return [round(self.low, 6), round(self.high, 6)] if self.low <= self.high else None


class Extents:
    """The least and the largest position of each axis, in program coordinates."""

    def __init__(self) -> None:
        self.axes: dict[str, Range] = {}

    def add(self, path: Toolpath, rows: Flags) -> None:
        """Take the ends of moves, and the sides of arcs and splines, into account."""
        for axis, column in zip(path.axes, path.end.T, strict=True):
            self.axes.setdefault(axis, Range()).add(column[rows])
        if path.has_arcs:
            points, owners = arc_extremes(path)
            for axis, column in zip("XYZ", points.T, strict=True):
                self.axes[axis].add(column[rows[owners]])

        if path.has_splines:
            splines = np.flatnonzero(path.is_spline & rows)
            for axis, column in zip("XYZ", spline_extremes(path, splines).T, strict=True):
                self.axes[axis].add(column.ravel())

    @property
    def found(self) -> dict[str, list[float]]:
        """The axes that stand anywhere that is known."""
        return {axis: found.pair for axis, found in self.axes.items() if found.pair}


@dataclass
class Use:
    """What one tool does."""

    moves: int = 0
    seconds: float = 0.0
    extents: Extents = field(default_factory=Extents)
    feed: Range = field(default_factory=Range)
    speed: Range = field(default_factory=Range)

    def report(self) -> dict[str, Any]:
        """Return it as plain values; a range that is not known is left out."""
        ranges = {"extents": self.extents.found, "feed": self.feed.pair, "speed": self.speed.pair}
        known = {name: found for name, found in ranges.items() if found}
        return {"moves": self.moves, "seconds": round(self.seconds, 3), **known}


class Tools:
    """The tools of a program in the order of their first use.

    `changes`: the program changes tools with an M code, as M6; otherwise T does it.
    """

    def __init__(self, dialect: type[Dialect], codes: set[str]) -> None:
        self.spindle = ToolInSpindle(dialect, codes)
        self.uses: dict[str, Use] = {}

    def add(self, path: Toolpath, seconds: Floats) -> None:
        """Take a path with the times of its moves into account."""
        first = 0
        for event in path.events:
            self._rows(path, seconds, first, event.row)
            first = event.row
            self._event(event)
        self._rows(path, seconds, first, len(path))

    def _event(self, event: Event) -> None:
        """Change the tool or the speed of the spindle."""
        if self.spindle.see(event):
            self.uses.setdefault(self.spindle.loaded, Use())
        elif event.what == "S":
            # the value of an expression of which only the machine knows the worth is not there
            speeds = [value for address, value in event.values if address == "S"]
            self.uses.setdefault(self.spindle.loaded, Use()).speed.add(speeds)

    def _rows(self, path: Toolpath, seconds: Floats, first: int, last: int) -> None:
        """Take some rows of a path into account."""
        if first == last:
            return
        use = self.uses.setdefault(self.spindle.loaded, Use())
        rows = np.zeros(len(path), np.bool_)
        rows[first:last] = True
        cuts = path.kind != Kind.RAPID
        use.moves += last - first
        use.seconds += float(np.nansum(seconds[rows]))
        use.extents.add(path, rows)
        use.feed.add(path.feed[rows & cuts & (path.feed_mode == FeedMode.PER_MINUTE)])

    def report(self) -> dict[str, dict[str, Any]]:
        """Return the tools that do anything; before the first change it is `none`."""
        return {name: use.report() for name, use in self.uses.items() if name != NONE or use.moves}
