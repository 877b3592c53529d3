"""How long moves are and how long they take, as far as the program and the machine file say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import numpy as np

from gcxform.dialect.dialect import LINEAR
from gcxform.system.arrays import Flags, Floats
from gcxform.toolpath.circles import radius_and_angle
from gcxform.toolpath.path import FeedMode, Kind, Plane, Toolpath
from gcxform.toolpath.splines import spline_lengths

MINUTE = 60.0


def lengths(path: Toolpath) -> Floats:
    """Return how far each move (n,) goes in mm; axes whose position is not known count nothing."""
    linear = [k for k, axis in enumerate(path.axes) if axis in LINEAR]
    way = (path.end - path.start)[:, linear]
    length = np.sqrt(np.nansum(way**2, axis=1))
    if path.has_arcs:
        arcs = np.flatnonzero(path.is_arc)
        first, last, _ = radius_and_angle(path, arcs)
        normal = np.array([plane.axes[2] for plane in Plane])[path.plane[arcs]]
        rise = np.nan_to_num(way[arcs, normal])
        length[arcs] = np.hypot((first + last) / 2 * path.sweep[arcs], rise)
    if path.has_splines:
        splines = np.flatnonzero(path.is_spline)
        length[splines] = np.mean(spline_lengths(path, splines), axis=0)
    return np.asarray(length)


def turns(path: Toolpath) -> Floats:
    """Return how far rotary axes turn in each move (n,), in degrees."""
    rotary = [k for k, axis in enumerate(path.axes) if axis not in LINEAR]
    way = (path.end - path.start)[:, rotary]
    return np.asarray(np.sqrt(np.nansum(way**2, axis=1)))


class Times:
    """The time that moves and dwells take, in seconds, and what is left out of it.

    `speeds` are the top speeds of axes in mm/min and degrees/min, for rapids.
    """

    def __init__(self, speeds: Mapping[str, float]) -> None:
        self.speeds = speeds
        self.found = dict.fromkeys(("feed", "rapid", "dwell"), 0.0)
        self.left_out: Counter[str] = Counter()
        self.spindle = np.nan

    def add(self, path: Toolpath) -> Floats:
        """Take a path into account; return the time of each move in seconds, nan if not known."""
        rapid = path.kind == Kind.RAPID
        spindle = self._spindle(path)
        feed = path.feed.copy()
        feed[path.feed_mode == FeedMode.PER_TURN] *= spindle[path.feed_mode == FeedMode.PER_TURN]
        way, turned = lengths(path), turns(path)
        way = np.where(way > 0, way, turned)
        way = np.where(path.feed_mode == FeedMode.INVERSE_TIME, 1.0, way)
        with np.errstate(divide="ignore", invalid="ignore"):
            seconds = np.where(rapid, self._rapids(path), way / feed * MINUTE)
        seconds[np.isnan(path.start).any(axis=1) & ~np.isnan(path.end).any(axis=1)] = np.nan
        self._count(path, seconds, rapid)
        return np.asarray(seconds)

    def _spindle(self, path: Toolpath) -> Floats:
        """Return the speed of the spindle (1/min) during each move, nan if it is not known."""
        speed = np.full(len(path), self.spindle)
        for event in path.events:
            if event.what == "S":
                self.spindle = event.values[0][1]
            elif event.what == "G96":  # S is a speed of the surface
                self.spindle = np.nan
            else:
                continue
            speed[event.row :] = self.spindle
        return speed

    def _rapids(self, path: Toolpath) -> Floats:
        """Return how long the slowest axis of each rapid takes; nan without its speed."""
        start, end = path.start, path.end
        way = np.where(np.isnan(start) & np.isnan(end), 0.0, np.abs(end - start))
        speed = np.array([self.speeds.get(axis, np.nan) for axis in path.axes])
        with np.errstate(invalid="ignore"):
            each = np.where((way > 0) | np.isnan(way), way / speed * MINUTE, 0.0)
        return np.asarray(each.max(axis=1, initial=0.0))

    def _count(self, path: Toolpath, seconds: Floats, rapid: Flags) -> None:
        known = np.isfinite(seconds)
        self.found["feed"] += float(seconds[known & ~rapid].sum())
        self.found["rapid"] += float(seconds[known & rapid].sum())
        self.found["dwell"] += sum(_dwell(path))
        for name, moves in (("rapid moves", rapid), ("feed moves", ~rapid)):
            if count := int((moves & ~known).sum()):
                self.left_out[name] += count

    def report(self) -> dict[str, float]:
        """Return the times in seconds by what takes them."""
        found = {**self.found, "sum": sum(self.found.values())}
        return {name: round(seconds, 3) for name, seconds in found.items()}


def _dwell(path: Toolpath) -> list[float]:
    """Return the dwells of a path in seconds."""
    values = [value for event in path.events if event.what == "DWELL" for value in event.values]
    return [value for unit, value in values if unit == "seconds"]
