"""Arcs in a plane that is turned out of the axes, as by G18 where a work offset is turned about Z.

A path has no such arcs, only their legs: the sides of a polygon around the arc, between tangents at
equal angles, so that the arc stays inside of the hull of its legs. The block stays as it stands, or
is refused. On two circles (start and end radius differ) the larger one counts. That a control cuts
such arcs was executed with LinuxCNC 2.9, whose work offsets turn; on others they are refused.

For another control, or a step that makes lines, an arc on one circle is read as cubic Bezier curves
instead, which become lines: over the angle a they have tangents of r 4/3 tan(a/4), and for a up to
`SMALL` are off the arc by no more than 1e-9 r.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gcxform.modal.lines import Lines
from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.path import FeedMode, Form, Kind, Plane, Toolpath

STEP = np.deg2rad(30.0)  # of an arc, to a leg
SMALL = np.deg2rad(10.0)  # of an arc, to a Bezier curve
ONE_CIRCLE = 1e-6  # mm between start and end radius
HINT = "write it in coordinates that are not turned, or as lines"


def _tilted(path: Toolpath) -> Ints:
    """Return the arcs whose plane their frame turns out of the axes."""
    found = []
    for row in np.flatnonzero(path.is_arc).tolist():
        normal = Plane(int(path.plane[row])).axes[2]
        if path.frames[int(path.frame[row])].tilts(normal):
            found.append(row)
    return np.array(found, np.int64)


def with_legs(path: Toolpath, lines: Lines) -> Toolpath:
    """Return a path with legs or curves for tilted arcs; `centre` is that of coordinates still.

    Where legs do not say enough of an arc, it is refused: GX213.
    """
    rows, dialect, findings = _tilted(path), lines.dialect, lines.findings
    if not len(rows):
        return path
    places = np.hstack([path.start[rows], path.end[rows], path.centre[rows]])
    unsure = ~np.isfinite(places[:, [*range(3), *range(len(path.axes), len(path.axes) + 3)]]).all(1)
    unsure |= (path.side[rows] != 0) | (path.feed_mode[rows] == FeedMode.INVERSE_TIME)
    unsure |= (path.form[rows] != Form.PLAIN) | (not dialect.offset_rule.g10_rotates)
    for row in rows[unsure].tolist():
        line = int(path.source[row]) - path.blocks.first
        message = "an arc in a plane that is turned out of the axes"
        findings.add(line, "GX213", message, hint=HINT)
    rows = rows[~unsure & np.isfinite(path.centre[rows]).all(axis=1)]
    if not len(rows):
        return path
    curves = _curves if lines.reading.curves else _legs
    parts = [curves(path, row) or _legs(path, row) for row in rows.tolist()]
    counts = np.ones(len(path), np.int64)
    counts[rows] = [len(each.ends) for each in parts]
    return _in_place(path, rows, counts, parts)


class _Parts(NamedTuple):
    """Parts of an arc: ends (n, axes), control points (n, 2, 3), nan for legs; the form of all."""

    ends: Floats
    control: Floats
    form: Form


def _curves(path: Toolpath, row: int) -> _Parts | None:
    """Return the Bezier curves of an arc on one circle that turns no rotary axis, else None."""
    first, second, _ = Plane(int(path.plane[row])).axes
    frame = path.frames[int(path.frame[row])]
    start, end = (frame.local(each[row : row + 1])[0] for each in (path.start, path.end))
    away, into = (
        np.array([place[k] - path.centre[row, k] for k in (first, second)])
        for place in (start, end)
    )
    radius, sweep = float(np.hypot(*away)), float(path.sweep[row])
    turns = (path.start[row, 3:] != path.end[row, 3:]) & np.isfinite(path.end[row, 3:])
    if turns.any() or not abs(np.hypot(*into) - radius) <= ONE_CIRCLE:
        return None
    count = max(1, int(np.ceil(sweep / SMALL)))
    angle = np.arctan2(away[1], away[0]) + path.sense[row] * sweep * np.arange(count + 1) / count
    place = start + (end - start) * (np.arange(count + 1) / count)[:, None]
    place[:, first] = path.centre[row, first] + radius * np.cos(angle)
    place[:, second] = path.centre[row, second] + radius * np.sin(angle)
    along = np.repeat((end - start)[None, :] / count / 3, count + 1, axis=0)
    reach = path.sense[row] * radius * 4 / 3 * np.tan(sweep / count / 4)
    along[:, first], along[:, second] = -reach * np.sin(angle), reach * np.cos(angle)
    inner = [frame.placed(each)[:, :3] for each in ((place + along)[:-1], (place - along)[1:])]
    ends = np.vstack([frame.placed(place)[1:-1], path.end[row]])
    return _Parts(ends, np.stack(inner, axis=1), Form.SPLINE)


def _legs(path: Toolpath, row: int) -> _Parts:
    """Return the legs of an arc."""
    plane = Plane(int(path.plane[row])).axes[:2]
    frame = path.frames[int(path.frame[row])]
    start, end = (frame.local(each[row : row + 1])[0] for each in (path.start, path.end))
    away = [(place - _wide(path.centre[row], place))[[*plane]] for place in (start, end)]
    sweep = float(path.sweep[row])
    count = max(2, int(np.ceil(sweep / STEP)))
    parts = (np.arange(count) + 0.5) / count
    angle = np.arctan2(away[0][1], away[0][0]) + path.sense[row] * sweep * parts
    radius = max(np.hypot(*away[0]), np.hypot(*away[1])) / np.cos(sweep / count / 2)
    found = start + (end - start) * parts[:, None]
    for k, axis in enumerate(plane):
        found[:, axis] = path.centre[row, axis] + radius * (np.cos, np.sin)[k](angle)
    ends = np.vstack([frame.placed(found), path.end[row]])
    return _Parts(ends, np.full((len(ends), 2, 3), np.nan), Form.TILTED)


def _wide(place: Floats, like: Floats) -> Floats:
    """Return a place (3,) with as many axes as another, all others 0."""
    return np.append(place, np.zeros(len(like) - len(place)))


def _in_place(path: Toolpath, rows: Ints, counts: Ints, parts: list[_Parts]) -> Toolpath:
    """Return a path with the parts of arcs in the place of rows."""
    is_leg = np.repeat(np.isin(np.arange(len(path)), rows), counts)
    first = np.repeat(np.cumsum(counts) - counts, counts)
    end = np.repeat(path.end, counts, axis=0)
    end[is_leg] = np.concatenate([each.ends for each in parts])
    control = np.repeat(path.control, counts, axis=0)
    control[is_leg] = np.concatenate([each.control for each in parts])
    nth = np.where(is_leg, np.arange(len(is_leg)) - first, np.repeat(path.nth, counts))
    kind = np.where(is_leg, np.int8(Kind.LINE), np.repeat(path.kind, counts)).astype(np.int8)
    form = np.repeat(path.form, counts)
    form[is_leg] = np.concatenate([np.full(len(each.ends), each.form) for each in parts])
    sweep = np.where(is_leg, 0.0, np.repeat(path.sweep, counts))
    centre = np.where(is_leg[:, None], np.nan, np.repeat(path.centre, counts, axis=0))
    columns = {
        "end": end,
        "control": control,
        "nth": nth,
        "kind": kind,
        "form": form,
        "sweep": sweep,
        "centre": centre,
    }
    return path.with_rows(counts, **columns)
