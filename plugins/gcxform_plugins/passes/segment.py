"""`segment`: long lines, arcs and splines are cut into pieces, arcs into lines or shorter arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints

WIDEST = np.pi / 2
"""The largest angle of a chord: with larger ones the sense of rotation could be lost."""
ANGLE_ERROR = 0.001
"""How far (deg) a rotary axis may be off on a chord: it turns with the chord, not the arc."""
MEASURED = 0.01
"""The part of the chord error that splines leave to the proof, whose bound is an upper one."""
TOO_MANY = 2.0**40  # pieces of a move: refused, and still a whole number
JUST_WHOLE = 1e-9  # a move that is so little longer than n pieces is cut into n


@dataclass(frozen=True)
class Segment(gx.Pass):
    """Cut arcs, splines and long lines into pieces.

    With `arcs = "lines"` arcs become chords that stay within `chord-error` of the arc and turn by
    at most 90 degrees each; with `arcs = "split"` they stay G2 and G3. `max-length` limits lines
    and chords, `arc-step` the angle of the pieces of an arc. Rapids are never cut. Splines become
    lines within `chord-error` and no longer than `max-length`, and so do those of weights and knots
    (G5.2) and arcs out of the planes of the axes; with `arcs = "split"` they stay.
    """

    name = "segment"
    ensures = frozenset({gx.LINEAR_ONLY})
    chord_error: Annotated[
        gx.Length | None, gx.Option("largest distance of a chord from its arc", above=0.0)
    ] = None
    max_length: Annotated[gx.Length | None, gx.Option("longest line, chord or arc", above=0.0)] = (
        None
    )
    arc_step: Annotated[
        gx.Angle | None, gx.Option("largest angle of a piece of an arc", above=0.0, at_most=360.0)
    ] = None
    arcs: Annotated[Literal["lines", "split"], gx.Option("what arcs become")] = "lines"

    def __post_init__(self) -> None:
        """Ensure no more than is done: pieces of arcs are arcs."""
        if self.arcs == "split":
            object.__setattr__(self, "ensures", frozenset())

    @property
    def promise(self) -> float:
        """The chord error, if arcs become lines; pieces of arcs are the arc."""
        if self.arcs == "split":
            return 0.0
        return self.chord_error if self.chord_error is not None else float("inf")

    @property
    def demands(self) -> gx.Demands:
        """Rows are cut; chords of arcs with rotary words are held to an angle."""
        if self.arcs == "split":
            return gx.Demands(keeps_rows=False)
        angle = ANGLE_ERROR if self.chord_error is not None else float("inf")
        return gx.Demands(keeps_rows=False, promise_angle=angle)

    def begin(self, context: gx.PassContext) -> None:
        """Refuse options that say nothing."""
        if self.arcs == "lines" and self.chord_error is None and self.arc_step is None:
            raise gx.UsageError.one(
                "GX720",
                "segment needs a chord-error to make lines of arcs",
                hint='chord-error = "2 um", or arcs = "split" to keep arcs',
            )

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with its arcs and long lines cut."""
        if path.has_splines and self.arcs == "lines":
            path = splines_as_lines(path, self.chord_error)
        arcs = path.is_arc
        blind = np.flatnonzero(arcs & (path.form == gx.Form.BLIND))
        if len(blind):
            hint = "begin with a line to a known point"
            raise path.refuse("GX208", blind, "an arc, but where it starts is not known", hint)
        pieces = np.ones(len(path), np.int64)
        if arcs.any():
            pieces = np.where(arcs, self._pieces_of_arcs(path), 1)
        if self.max_length is not None:
            lines = (path.kind == gx.Kind.LINE) & (path.form == gx.Form.PLAIN)
            length = np.nan_to_num(_length(path.start, path.end))
            pieces = np.where(lines, _whole(length / self.max_length), pieces)
        pieces = np.where(path.starts_known, pieces, 1)
        if arcs.any():
            return cut_arcs(path, pieces, arcs, keep=self.arcs == "split")
        return cut_lines(path, pieces)

    def _pieces_of_arcs(self, path: gx.Toolpath) -> Ints:
        """Return how many pieces each arc becomes."""
        pieces = np.ones(len(path), np.int64)
        if self.arcs == "lines":
            pieces = _whole(path.sweep / WIDEST)
            if self.chord_error is not None:
                pieces = np.maximum(pieces, chords(path, self.chord_error))
        if self.arc_step is not None:
            pieces = np.maximum(pieces, _whole(path.sweep / np.radians(self.arc_step)))
        if self.max_length is not None and self.arc_step is None:
            along = np.hypot(path.sweep * radius(path), _rise(path))
            pieces = np.maximum(pieces, _whole(np.nan_to_num(along) / self.max_length))
        return pieces


def splines_as_lines(path: gx.Toolpath, chord_error: float | None) -> gx.Toolpath:
    """Return the path with lines for its splines, within a chord error (mm)."""
    rows = np.flatnonzero(path.form == gx.Form.SPLINE)
    if chord_error is None:
        message = "a spline becomes lines by their chord error, and none is given"
        raise path.refuse("GX506", rows, message, 'chord-error = "2 um"')
    pieces = np.ones(len(path), np.int64)
    pieces[rows] = gx.spline_chords(path, rows, chord_error * (1.0 - MEASURED))
    return gx.splines_as_lines(path, pieces)


def _whole(value: Floats) -> Ints:
    return np.clip(np.ceil(value - JUST_WHOLE), 1, TOO_MANY).astype(np.int64)


def _length(start: Floats, end: Floats) -> Floats:
    """Return lengths (mm) in X, Y, Z."""
    way = np.nan_to_num((end - start)[:, :3])
    return np.asarray(np.sqrt((way**2).sum(axis=1)))


def radius(path: gx.Toolpath) -> Floats:
    """Return the larger of the radii (mm) of each arc at its start and end; 0 for other moves."""
    size = np.zeros(len(path))
    rows = np.flatnonzero(path.is_arc)
    first, last, _ = gx.radius_and_angle(path, rows)
    size[rows] = np.maximum(first, last)
    return size


def _rise(path: gx.Toolpath) -> Floats:
    """Return how far (mm) each arc goes along the normal of its plane."""
    normal = np.array([plane.axes[2] for plane in gx.Plane])[path.plane]
    rows = np.arange(len(path))
    return np.asarray(np.nan_to_num(path.end[rows, normal] - path.start[rows, normal]))


def chords(path: gx.Toolpath, chord_error: float) -> Ints:
    """Return how many chords keep within the chord error (mm) of each arc.

    A chord of the angle a is r (1 - cos(a/2)) from its arc. A helix turns evenly with its angle
    and its chord does not, by at most a**2 / 54 of the rise for a <= pi/2; both are kept.
    """
    size = np.maximum(radius(path), 1e-12)
    angle = 2 * np.arccos(np.clip(1 - chord_error / size, -1.0, 1.0))
    pieces = np.maximum(_whole(path.sweep / WIDEST), _whole(path.sweep / np.maximum(angle, 1e-9)))
    rise = np.abs(_rise(path))
    turned = np.nan_to_num(np.abs(path.end - path.start)[:, 3:]).max(axis=1, initial=0.0)
    for _ in range(60):
        step = path.sweep / pieces
        sag = size * (1 - np.cos(step / 2))
        uneven = step**2 / 54.0 / pieces
        over = np.hypot(sag, rise * uneven) > chord_error * (1 + 1e-9)
        over |= turned * uneven > ANGLE_ERROR
        if not (over & path.is_arc).any():
            break
        pieces = np.where(over, np.ceil(pieces * 1.02).astype(np.int64), pieces)
    return pieces


def cut_lines(path: gx.Toolpath, pieces: Ints) -> gx.Toolpath:
    """Return the path with each line cut into equal pieces."""
    if not (pieces > 1).any():
        return path
    row, part = _parts(path.check_rows(pieces))
    start, end = path.start[row], path.end[row]
    points = start + part[:, None] * (end - start)
    points = np.where((part == 1.0)[:, None] | np.isnan(points), end, points)
    return path.with_rows(pieces, end=np.asfortranarray(points), **_timed(path, row, pieces))


def cut_arcs(path: gx.Toolpath, pieces: Ints, arcs: Flags, keep: bool) -> gx.Toolpath:
    """Return the path with lines and the arcs chosen cut into equal pieces; `keep` them arcs."""
    row, part = _parts(path.check_rows(pieces))
    start, end = path.start[row], path.end[row]
    points = start + part[:, None] * (end - start)
    chosen = arcs[row]
    points[chosen, :3] = gx.points_on_arcs(path, row[chosen], part[chosen])
    points = np.where((part == 1.0)[:, None] | np.isnan(points), end, points)
    columns = {"end": np.asfortranarray(points), **_timed(path, row, pieces)}
    if keep:
        columns["sweep"] = (path.sweep / pieces)[row]
    else:
        columns["kind"] = np.where(chosen, np.int8(gx.Kind.LINE), path.kind[row])
        columns["sweep"] = np.where(chosen, 0.0, path.sweep[row])
        columns["centre"] = np.where(chosen[:, None], np.nan, path.centre[row])
    return path.with_rows(pieces, **columns)


def _parts(pieces: Ints) -> tuple[Ints, Floats]:
    """Return row and part of the way at the end of each piece."""
    row = np.repeat(np.arange(len(pieces)), pieces)
    nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    return row, nth / pieces[row]


def _timed(path: gx.Toolpath, row: Ints, pieces: Ints) -> dict[str, Floats]:
    """Return the feeds of pieces: in inverse time (G93) each piece has its part of the time."""
    inverse = path.feed_mode[row] == gx.FeedMode.INVERSE_TIME
    if not inverse.any():
        return {}
    return {"feed": np.where(inverse, path.feed[row] * pieces[row], path.feed[row])}
