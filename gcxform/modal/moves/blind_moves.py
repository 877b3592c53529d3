"""Moves by distances of axes of which it is not known where they stand: G91 behind a tool change.

Such a move is known from where it begins to where it ends, and not where that is. Its block stays
as it stands, and the axis is lost as before. What it goes by is noted as an event, in positions: so
the proof compares it though no end is known. It is refused where what is written would depend on
more: under cutter compensation, along vectors of the tool, and in another dialect.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.modal.frames.track import Track
from gcxform.modal.line_notes import BY_WAY, Unknown
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import PROBES
from gcxform.modal.moves.rows import Rows
from gcxform.modal.state import Modes
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.system.distinct import distinct, one_of
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Form, Kind, Plane

KEPT = "moves by distances from where it is not known that an axis stands are kept in G91"
BY = "BY "
"""How the event begins that says by what a block goes."""


def may_be_blind(lines: Lines, modes: Modes, moving: Flags, alone: bool) -> Flags:
    """Return the lines that may go by distances from nowhere known; `alone`: without vectors."""
    if lines.reading.crosses or not alone:
        return np.zeros(lines.live, np.bool_)
    plain = moving & modes.incremental & (modes.comp == 0)
    return np.asarray(plain & ((modes.motion <= Kind.ARC_CCW) | one_of(modes.motion, PROBES)))


def ways(track: Track, lines: Ints) -> Floats:
    """Return the distances (n, 3) along X, Y, Z that lines in G91 name, 0 where they name none."""
    found = np.zeros((len(lines), 3))
    for k, axis in enumerate("XYZ"):
        word = track.column(axis)
        if word is not None:
            there = word[1][lines] & track.modes.incremental[lines]
            found[:, k] = np.where(there, word[0][lines], 0.0)
    return found


def blind_rows(track: Track, rows: Rows) -> Rows:
    """Return rows with the form of those that begin nowhere known, and note what they go by."""
    may = track.may_step[rows.line] & (rows.form == Form.PLAIN)
    if not may.any() or not np.isnan(rows.end[may]).any():
        return rows
    blind = np.zeros(len(may), np.bool_)
    for k, axis in enumerate(track.axes):
        word = track.column(axis)
        if word is not None:
            blind |= may & np.isnan(rows.end[:, k]) & word[1][rows.line]
    arcs = may & (rows.kind >= Kind.ARC_CW)
    for plane in Plane if arcs.any() else ():
        here = arcs & (track.modes.plane[rows.line] == plane)
        blind |= here & np.isnan(rows.end[:, plane.axes[:2]]).any(axis=1)
    lines = rows.line[blind]
    said = _said(track, lines, _ways(track, lines, rows.frame[blind]))
    track.lines.unknown += [Unknown(*each, "") for each in zip(lines.tolist(), said, strict=True)]
    if blind.any():
        track.state.assumed.setdefault(KEPT, None)
    form = np.where(blind, np.int8(Form.BLIND), rows.form)
    return Rows(rows.line, rows.kind, rows.end, rows.nth, form, rows.frame)


def note_way(track: Track, line: int) -> None:
    """Note by what a block in G91 goes on its way to a place of the machine, from nowhere known.

    Its block stays as it stands, as the moves here do, and no end of it is known. Another control
    may know more of where it begins.
    """
    if not track.modes.incremental[line]:
        return
    words = track.words_on(line) if not track.lines.reading.crosses else {}
    named = [track.axes.index(axis) for axis in words]
    if np.isnan(track.state.position[named]).any():
        (way,) = _turned(track, np.array([line]), track.frame).tolist()
        each = zip(track.axes, way, strict=True)
        said = (f"{axis}{value + 0.0:.6f}" for axis, value in each if value or axis in words)
        track.lines.unknown.append(Unknown(line, f"{BY}{' '.join(said)}", BY_WAY))


def _ways(track: Track, lines: Ints, frames: Ints) -> Floats:
    """Return what lines in G91 go by (n, axes), each in its frame."""
    found = np.zeros((len(lines), len(track.axes)))
    for number in distinct(frames).tolist():
        here = frames == number
        found[here] = _turned(track, lines[here], track.frames[number])
    return found


def _turned(track: Track, lines: Ints, frame: Frame) -> Floats:
    """Return what the axes (n, axes) go by in lines of a frame, mm and degrees in positions."""
    steps = np.zeros((len(lines), len(track.axes)))
    for k, axis in enumerate(track.axes):
        word = track.column(axis)
        if word is not None:
            steps[:, k] = np.where(word[1][lines], word[0][lines], 0.0)
    if frame.diameter:
        steps[:, 0] *= 0.5
    return frame.turned(steps)


def _said(track: Track, lines: Ints, ways: Floats) -> list[str]:
    """Return what moves go by (n, axes), mm and degrees in positions, and the words of arcs."""
    along, found = ways != 0, [""] * len(lines)
    kinds = along @ (1 << np.arange(len(track.axes)))
    for kind in distinct(kinds).tolist():
        here = np.flatnonzero(kinds == kind)
        named = np.flatnonzero(along[here[0]])
        spelled = " ".join(f"{track.axes[axis]}%.6f" for axis in named.tolist())
        for number, way in zip(here.tolist(), ways[np.ix_(here, named)].tolist(), strict=True):
            found[number] = spelled % (*way,)
    for number in np.flatnonzero(track.modes.motion[lines] > 1).tolist():
        found[number] = " ".join(filter(None, [found[number], *_arc(track, int(lines[number]))]))
    return [BY + each for each in found]


def _arc(track: Track, line: int) -> Iterator[str]:
    """Yield the words of an arc, in mm."""
    scale = INCH if track.modes.inch[line] else 1.0
    for address in "IJKR" + track.dialect.arc_rule.turns:
        word = track.lines.word(address)
        if word is not None and word[1][line]:
            yield f"{address}{word[0][line] * scale:.6f}"
