"""The words of splines (G5, G5.1) to control points, with the checks a control makes.

A G5 is a cubic Bezier curve from where the tool stands to X Y. Its first inner control point is at
I, J from the start and its second at P, Q from the end; in a series of G5 the I and J that are left
out are minus the P and Q before. A G5.1 is a quadratic one, whose control point is at I, J from the
start; it is the cubic one whose inner control points are two thirds of the way there from either
end. I, J, P and Q are distances also in G91 and in G90.1, and turn with the frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import CUBIC, NUMBER, of_splines
from gcxform.modal.moves.rows import Rows
from gcxform.modal.state import Modes
from gcxform.system.arrays import Flags, Floats, Ints
from gcxform.toolpath.path import Form, Kind, Plane, Toolpath
from gcxform.values import dataclass

THIRDS = 2.0 / 3.0


def with_splines(rows: Rows) -> Rows:
    """Return plain rows with those whose kind is a code of splines marked as such."""
    bent = of_splines(rows.kind)
    kind = np.where(bent, np.int8(Kind.LINE), rows.kind)
    form = np.where(bent, np.int8(Form.SPLINE), rows.form)
    return replace(rows, kind=kind.astype(np.int8), form=form.astype(np.int8))


@dataclass(frozen=True, slots=True)
class SplineWords:
    """The words of splines (n,), nan where one is missing, in units of the program.

    line in the window; row of the path; cubic: G5 and not G5.1; offset (n, 2) is I, J; pull (n, 2)
    is P, Q; scale: mm in the unit.
    """

    line: Ints
    row: Ints
    cubic: Flags
    offset: Floats
    pull: Floats
    scale: Floats


def read_splines(path: Toolpath, lines: Lines, modes: Modes) -> Toolpath:
    """Return the path with the control points of its splines; leave what the next G5 needs."""
    _refuse_standing(lines, modes)
    rows = np.flatnonzero(path.is_spline)
    line = path.block[rows]
    words = SplineWords(
        line,
        rows,
        np.asarray(modes.motion[line] == CUBIC),
        _columns("IJ", lines, line),
        _columns("PQ", lines, line),
        np.where(modes.inch[line], INCH, 1.0),
    )
    for wrong, code, message, hint in _objections(path, words, lines, modes):
        for at in line[wrong][: Findings.enough].tolist():
            lines.findings.add(at, code, message, hint=hint)
    in_series = _in_series(words, lines.state.pull)
    _refuse_first(words, in_series, lines.findings)
    last = len(rows) > 0 and bool(rows[-1] == len(path) - 1 and words.cubic[-1])
    lines.state.pull = (float(words.pull[-1, 0]), float(words.pull[-1, 1])) if last else None
    return _placed(path, words, in_series)


def _columns(letters: str, lines: Lines, at: Ints) -> Floats:
    """Return words (n, letters) on some lines, nan where there is none."""
    found = np.full((len(at), len(letters)), np.nan)
    among = np.zeros(lines.live, np.bool_)
    among[at] = True
    for column, letter in enumerate(letters):
        word = lines.word(letter, among, distance=True)
        if word is not None:
            found[:, column] = np.where(word[1][at], word[0][at], np.nan)
    return found


def _refuse_standing(lines: Lines, modes: Modes) -> None:
    """Refuse blocks of splines that go nowhere."""
    named = np.zeros(lines.live, np.bool_)
    for axis in "XY":
        word = lines.word(axis)
        named |= word is not None and word[1]
    for line in np.flatnonzero(of_splines(modes.motion) & ~named).tolist():
        lines.findings.add(line, "GX306", "a spline needs X or Y")


def _objections(
    path: Toolpath, words: SplineWords, lines: Lines, modes: Modes
) -> Iterator[tuple[Flags, str, str, str]]:
    """Yield what speaks against splines: which of them, code, message and hint."""
    i, j = np.asarray(~np.isnan(words.offset)).T
    p, q = np.asarray(~np.isnan(words.pull)).T
    cubic, line = words.cubic, words.line
    strange = "".join(a for a in path.axes if a not in "XY")
    others = np.asarray((~np.isnan(_columns(strange + "KRL", lines, line))).any(axis=1))
    ends = np.hstack([path.start[words.row, :2], path.end[words.row, :2]])
    known = np.asarray(np.isfinite(ends).all(axis=1))
    other_plane = np.asarray(modes.plane[line] != Plane.XY)
    yield other_plane, "GX306", "splines are cut in G17 only", ""
    yield others, "GX306", "a spline takes X and Y, I and J, P and Q, and no other word", ""
    yield cubic & ~(p & q), "GX306", "G5 needs both P and Q", ""
    yield cubic & (i != j), "GX306", "G5 needs both I and J, or neither", ""
    yield ~cubic & ~(i & j), "GX306", "G5.1 needs both I and J", ""
    yield ~cubic & (p | q), "GX306", "P and Q belong to G5, and this is G5.1", ""
    inverse = np.asarray(modes.feed_mode[line] == NUMBER["G93"])
    message = "in G93 the control cuts a spline at whatever feed was in force before"
    yield inverse, "GX306", message, "write it in G94"
    message = "where this spline starts or ends in X and Y is not known"
    yield (
        np.asarray(~known),
        "GX208",
        message,
        "program X and Y before, or give the position at the start",
    )


def _in_series(words: SplineWords, before: tuple[float, float] | None) -> Floats:
    """Return P and Q (n, 2) of the G5 directly before each spline; nan if there is none."""
    pull = np.full((len(words.row), 2), np.nan)
    follows = (np.diff(words.row) == 1) & words.cubic[:-1]
    pull[1:][follows] = words.pull[:-1][follows]
    if before is not None and len(pull) and words.row[0] == 0:
        pull[0] = before
    return pull


def _refuse_first(words: SplineWords, in_series: Floats, findings: Findings) -> None:
    """Refuse a G5 that goes on from a G5 which is not there."""
    first = words.cubic & np.isnan(words.offset).all(axis=1) & np.isnan(in_series).any(axis=1)
    message = "I and J are left out, and the move before is no G5 to go on from"
    for line in words.line[first][: Findings.enough].tolist():
        findings.add(line, "GX306", message, hint="write I and J")


def _placed(path: Toolpath, words: SplineWords, in_series: Floats) -> Toolpath:
    """Return the path with the control points at the places that the words say."""
    if not len(words.row):
        return path
    offset = np.where(np.isnan(words.offset), -in_series, words.offset) * words.scale[:, None]
    pull = words.pull * words.scale[:, None]
    start = path.local(path.start[:, :3])[words.row, :2]
    end = path.local(path.end[:, :3])[words.row, :2]
    cubic = words.cubic[:, None]
    first = start + np.where(cubic, offset, THIRDS * offset)
    second = end + np.where(cubic, pull, THIRDS * (start + offset - end))
    control = np.full((len(path), 2, 3), np.nan)
    for nth, inner in enumerate((first, second)):
        local = np.array(path.local(path.end[:, :3]))
        local[words.row, :2] = inner
        control[words.row, nth] = path.placed(local)[words.row]
    return path.replace(control=control)
