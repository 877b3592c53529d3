"""What `cutter-comp` leaves as it is: kinds, feeds, events, and moves that it does not offset.

A part of its proof, and like that without any code of the search for the centre path.
"""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

CLOSE = 1e-6  # mm
SLIP = 1e-9  # relative, of feeds
SAME = ("plane", "feed_mode", "frame", "source", "form", "lost")


def paired_rows(before: gx.Toolpath, after: gx.Toolpath) -> tuple[Ints, Ints]:
    """Return, for each row, its row of the centre path and the row of its corner, or -1."""
    counts = np.ones(len(before), np.int64)
    lines, first, old = np.unique(before.source, return_index=True, return_counts=True)
    new = np.bincount(np.searchsorted(lines, after.source), minlength=len(lines))
    more = new - old
    if len(new) != len(lines) or ((more < 0) | (more > np.where(old > 2, 0, old))).any():
        _fail(before, 0, "moves are missing or too many")
    begin = np.cumsum(new) - new
    later = (more == 1) & (old == 2)
    later[later] = _goes_along(before, first[later], after, begin[later])
    counts[(first + later)[more > 0]] = 2
    counts[first[more == 2] + 1] = 2
    main = np.cumsum(counts) - 1
    return main, np.where(counts == 2, main - 1, -1)


def _goes_along(before: gx.Toolpath, rows: Ints, after: gx.Toolpath, others: Ints) -> Flags:
    """Return which rows of the centre path may be straight moves beside rows of the contour.

    A block with a piece in its corner is two moves, of which either may have a corner before it.
    """
    u, v = (
        np.nan_to_num(path.end[at, :3] - path.start[at, :3])
        for path, at in ((before, rows), (after, others))
    )
    across = np.sqrt((np.cross(u, v) ** 2).sum(axis=1))
    size = np.sqrt((u**2).sum(axis=1) * (v**2).sum(axis=1))
    return np.asarray((after.kind[others] == before.kind[rows]) & (across <= CLOSE * size + CLOSE))


def check_same(before: gx.Toolpath, after: gx.Toolpath, main: Ints, corner: Ints) -> None:
    """Check all that compensation does not change."""
    fail_if(before, after.kind[main] != before.kind, "kind has changed")
    owner = np.repeat(np.arange(len(before)), 1 + (corner >= 0))
    for name in SAME:
        wrong = getattr(after, name) != getattr(before, name)[owner]
        fail_if(before, owner[wrong], f"{name} has changed")
    free = (before.side == 0) | ~(before.radius > 0)
    kept = (after.end[main] == before.end) | np.isnan(before.end)
    fail_if(before, free & (~kept.all(axis=1) | (corner >= 0)), "a free move has changed")
    arcs = np.zeros(len(before), np.bool_)
    for name in ("centre", "sweep"):
        old, new = getattr(before, name), getattr(after, name)[main]
        same = (old == new) | (np.isnan(old) & np.isnan(new))
        arcs |= ~(same if same.ndim == 1 else same.all(axis=1))
    fail_if(before, free & arcs, "a free arc has changed")
    _check_feeds(before, after, owner)


def _check_feeds(before: gx.Toolpath, after: gx.Toolpath, owner: Ints) -> None:
    """Check the feeds; in inverse time the speed is the contour's: F of l mm is F l / m of m mm."""
    timed = (before.feed_mode == gx.FeedMode.INVERSE_TIME) & (before.side != 0)
    timed &= before.kind != gx.Kind.RAPID
    feed = before.feed[owner]
    same = (after.feed == feed) | np.isnan(feed)
    if timed.any():
        programmed, made = _lengths(before)[owner], _lengths(after)
        goes = timed[owner] & (np.minimum(programmed, made) > CLOSE)
        same |= timed[owner] & ~goes
        same |= goes & (np.abs(after.feed * made - feed * programmed) <= SLIP * feed * programmed)
    fail_if(before, owner[~same], "the feed has changed")


def _lengths(path: gx.Toolpath) -> Floats:
    """Return the lengths (n,) of moves along X, Y and Z; what is not known stands still."""
    way = np.nan_to_num(path.end[:, :3] - path.start[:, :3])
    arc = path.is_arc
    out = np.where(arc[:, None], path.start[:, :3] - path.centre, 0.0)
    normal = np.array([gx.Plane(p).axes[2] for p in range(3)])[path.plane][:, None]
    rise = np.take_along_axis(way, normal, axis=1)[:, 0]
    np.put_along_axis(out, normal, 0.0, axis=1)
    straight, radius = (np.sqrt((vectors**2).sum(axis=1)) for vectors in (way, out))
    return np.asarray(np.where(arc, np.hypot(radius * path.sweep, rise), straight))


def check_events(before: gx.Toolpath, after: gx.Toolpath, first: Ints) -> None:
    """Check that all events but those of compensation stand before the moves they stood before."""
    first = np.append(first, len(after))
    kept = [e for e in before.events if not e.what.startswith(("G41", "G42"))]
    wanted = [(e.what, e.values, e.line, int(first[e.row])) for e in kept]
    if wanted != [(e.what, e.values, e.line, e.row) for e in after.events]:
        _fail(before, 0, "an event is missing, or stands elsewhere")


def fail_if(path: gx.Toolpath, wrong: Flags | Ints, message: str) -> None:
    """Raise VerificationError about the first of the rows that are wrong, if there are any."""
    rows = np.flatnonzero(wrong) if wrong.dtype == np.bool_ else wrong
    if len(rows):
        _fail(path, int(rows[0]), message)


def _fail(path: gx.Toolpath, row: int, message: str) -> None:
    line = int(path.source[row]) + 1 if len(path) else 0
    raise gx.VerificationError.one(
        "GX604",
        f"the centre path is not beside the contour: {message}",
        gx.Location("", line),
        "nothing was written; this is a bug of gcxform or of a plugin",
    )
