"""Splines of weights and knots (G5.2 up to G5.3): their blocks are checked, and stay as they stand.

Each G5.2 with X and Y is a control point, with its weight in P; the first one is where the tool
stands, and its weight is the P of a first block that names no point, or 1. L of the first block is
the order. The curve is cut at G5.3, inside the hull of its control points, and ends at the last
one. A path has the legs between them, in a form of their own, so every step leaves them as they are
or is refused. For another control, or a step that makes lines, they are read as cubic Bezier curves
instead, as many as there are legs or more, which become lines.

What LinuxCNC 2.9 refuses is refused, and so is what it does otherwise than one would think (G91
counts all points from the first), or at another moment (words beside them act before the curve is
cut). `tests/test_nurbs.py` asks its interpreter.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.tables import NUMBER, NURBS, NURBS_END
from gcxform.modal.moves.rows import Rows
from gcxform.modal.state import Modes
from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.nurbs import Nurbs as Curve
from gcxform.toolpath.path import Form, Kind, Plane, Toolpath

LEAST_ORDER = 3
OPENS = frozenset({"motion", "distance", "units", "plane", "feed-mode"})
"""Groups whose codes may stand beside the first G5.2."""
WORDS = {"N", "P", "X", "Y"}


class Nurbs:
    """The blocks of a window; `state.nurbs` has points and order of a spline that is open.

    `lines` (live,) are those on which G5.2 or G5.3 is in force, or stated. `whole` has first and
    last line of the splines that begin and end in the window, and `opened` that of an open one.
    """

    def __init__(self, lines: Lines, modes: Modes) -> None:
        self.source, self.modes, self.state = lines, modes, lines.state
        self.lines = np.asarray((modes.motion == NURBS) | (modes.motion == NURBS_END))
        self.any = bool(self.lines.any())
        self.opened = -1
        self.whole: list[tuple[int, int]] = []

    def marked(self, rows: Rows) -> Rows:
        """Return plain rows with those between control points in a form of their own."""
        if not self.any:
            return rows
        legs = rows.kind == NURBS
        kind = np.where(legs, np.int8(Kind.LINE), rows.kind).astype(np.int8)
        form = np.where(legs, np.int8(Form.NURBS), rows.form).astype(np.int8)
        return replace(rows, kind=kind, form=form)

    def refuse_unknown_start(self, path: Toolpath) -> None:
        """Refuse splines of which the first control point is not known."""
        if not self.any:
            return
        open_ = (path.form == Form.NURBS) & ~np.isfinite(path.start[:, :2]).all(axis=1)
        for line in path.block[open_][: Findings.enough].tolist():
            message = "where this spline starts in X and Y is not known"
            hint = "program X and Y before, or give the position at the start"
            self.source.findings.add(line, "GX208", message, hint=hint)

    def check(self) -> None:
        """Refuse what is not certain."""
        last = -1
        for line in np.flatnonzero(self.lines).tolist():
            if self.state.nurbs is not None and line != last + 1:
                self._interrupted(last + 1)
            for message, hint in self._objections(line):
                self.source.findings.add(line, "GX306", message, hint=hint)
                break
            last = line
        if self.state.nurbs is not None and last + 1 < self.source.live:
            self._interrupted(last + 1)

    def _interrupted(self, line: int) -> None:
        self.state.nurbs = None
        message = "the control points before are of no curve: no G5.3 ends it"
        self.source.findings.add(line, "GX306", message, hint="write G5.3 before this block")

    def _objections(self, line: int) -> Iterator[tuple[str, str]]:
        """Yield what speaks against a line, and what would be right; count its control point."""
        meaning = self.source.table.meanings[int(self.source.shape[line])]
        if self.modes.motion[line] == NURBS_END:
            yield from self._end(line, meaning)
            return
        opens = self.state.nurbs is None
        before = self.state.nurbs or (1, self._order(line))
        self.opened = line if opens else self.opened
        letters = set(meaning.slots)
        named = len(letters & {"X", "Y"})
        self.state.nurbs = before[0] + (named == 2), before[1]
        yield from self._words(meaning, letters, opens)
        if named == 1 or (named == 0 and not opens and letters - {"N"}):
            yield "a control point needs both X and Y", ""
        if not opens and named == 0 and meaning.groups:
            yield "G5.2 without a control point", "leave it out"
        weight = self._value("P", line)
        if (named == 2 or "P" in letters) and not weight > 0:
            yield "a control point needs its weight in P, above zero", ""
        if opens and not (before[1] >= LEAST_ORDER and before[1] % 1 == 0):
            yield "the order of a spline is a whole number from 3 on", ""
        yield from self._modes(line)

    def _words(self, meaning: Meaning, letters: set[str], opens: bool) -> Iterator[tuple[str, str]]:
        extra = letters - WORDS - ({"F", "L"} if opens else set())
        groups = set(meaning.groups) - (OPENS if opens else {"motion"})
        acts = meaning.acts or meaning.events or meaning.ends or meaning.percent
        if extra or groups or acts or meaning.loses_position or meaning.changes_tool:
            message = "between G5.2 and G5.3 stand control points alone: X, Y and P"
            yield message, "what stands beside them would act before the curve is cut"

    def _modes(self, line: int) -> Iterator[tuple[str, str]]:
        modes = self.modes
        if modes.incremental[line]:
            yield "in G91 this control counts all control points from the first", "write G90"
        if modes.plane[line] != Plane.XY:
            yield "splines are cut in G17 only", ""
        if modes.feed_mode[line] == NUMBER["G93"]:
            yield "in G93 the control cuts a spline at whatever feed was before", "write G94"
        if modes.comp[line] > 0:
            yield "a spline beside cutter compensation", "write G40 before it"

    def _end(self, line: int, meaning: Meaning) -> Iterator[tuple[str, str]]:
        points, order = self.state.nurbs or (0, 0.0)
        self.state.nurbs = None
        if self.opened >= 0:
            self.whole.append((self.opened, line))
            self.opened = -1
        if not points:
            yield "G5.3 without G5.2 before it", ""
        if set(meaning.slots) - {"N"} or set(meaning.groups) != {"motion"} or meaning.acts:
            yield "G5.3 stands in a block of its own", ""
        if meaning.events or meaning.ends or meaning.percent:
            yield "G5.3 stands in a block of its own", ""
        if points < order:
            yield f"{points} control points for a spline of order {order:g}", "give more of them"

    # --- as curves ---

    def as_beziers(self, path: Toolpath) -> Toolpath:
        """Return a path of which lines are to be made, with Bezier curves in place of legs."""
        if not (self.whole and self.source.reading.curves) or self.source.findings.found:
            return path
        counts = np.ones(len(path), np.int64)
        parts: list[tuple[int, Floats]] = []
        for first, last in self.whole:
            rows = np.flatnonzero((path.block >= first) & (path.block < last))
            curves = self._curve(path, rows, first).beziers(len(rows))
            if curves is not None:
                share = np.arange(len(curves) + 1) * len(rows) // len(curves)
                counts[rows] = np.bincount(share[:-1], minlength=len(rows))
                parts.append((int(rows[0]), curves))
        return _placed(path, counts, parts)

    def _curve(self, path: Toolpath, rows: Ints, opens: int) -> Curve:
        """Return the curve of which some rows are the legs; the first of its lines is `opens`."""
        points = np.vstack([path.start[rows[:1], :2], path.end[rows, :2]])
        word = self.source.word("P", distance=False)
        assert word is not None
        weights = word[0][path.block[rows]]
        alone = path.block[rows[0]] != opens and self._has("P", opens)
        first = self._value("P", opens) if alone else 1.0
        return Curve(points, np.append(first, weights), int(self._order(opens)))

    def _order(self, line: int) -> float:
        order = self._value("L", line)
        return float(LEAST_ORDER) if np.isnan(order) and not self._has("L", line) else order

    def _has(self, letter: str, line: int) -> bool:
        word = self.source.word(letter, distance=False)
        return word is not None and bool(word[1][line])

    def _value(self, letter: str, line: int) -> float:
        word = self.source.word(letter, distance=False)
        return float(word[0][line]) if word is not None and word[1][line] else np.nan


def _placed(path: Toolpath, counts: Ints, parts: list[tuple[int, Floats]]) -> Toolpath:
    """Return the path with so many rows for each; `parts` are first rows, as they were, and curves.

    The curves are control points (m, 4, 2): Z, which may not be known, stays where it is.
    """
    begin = np.append(0, np.cumsum(path.check_rows(counts)))
    row = np.repeat(np.arange(len(path)), counts)
    end, form = path.end[row], path.form[row]
    control = np.array(path.control[row])
    control[..., 2] = np.where(form == Form.NURBS, end[:, 2], control[..., 2].T).T
    for first, curves in parts:
        here = slice(int(begin[first]), int(begin[first]) + len(curves))
        end[here, :2], control[here, :, :2] = curves[:, 3], curves[:, 1:3]
        form[here] = Form.SPLINE
    nth = path.nth[row] + np.arange(len(row)) - begin[row]
    return path.with_rows(counts, end=np.asfortranarray(end), form=form, control=control, nth=nth)
