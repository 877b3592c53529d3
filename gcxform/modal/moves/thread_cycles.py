"""Threads that are cut in passes (G76 of LinuxCNC): their blocks are checked, and stay as they are.

The cycle begins where the tool stands, on the drive line: X stays, and Z is its end. P is the way
per turn, I the place of the peaks beside the drive line, K the depth and J that of the first pass.
LinuxCNC 2.9 ends at Z, on the drive line; of the passes a path has the deepest. What it refuses is
refused, and so are numbers that its manual forbids and its interpreter takes (R below 1, L above
3). `tests/test_thread_cycles.py` asks its interpreter.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.modal.frames.track import Track
from gcxform.modal.moves.rows import Own
from gcxform.system.arrays import Floats
from gcxform.toolpath.path import Form, Kind


def thread_cycle(track: Track, line: int) -> Own:
    """Return the deepest pass of a thread, and the way back to its drive line."""
    start = track.state.position.copy()
    letters = {letter: _value(track, letter, line) for letter in "PIJKRLQ"}
    named = track.words_on(line)
    end = track.along(line, line + 1, np.array([line]), None)[0]
    for message, hint in _objections(track, line, start, letters, {*named}):
        track.findings.add(line, "GX216", message, hint=hint)
        break
    scale = INCH if track.modes.inch[line] else 1.0
    scale *= 0.5 if track.frame.diameter else 1.0
    deep = abs(letters["I"] or 0.0) + (letters["K"] or 0.0)
    deep = np.copysign(deep, letters["I"] or 0.0) * scale
    moves: list[tuple[int, Floats]] = []
    for kind, place, away in ((Kind.RAPID, start, deep), (Kind.LINE, end, deep)):
        beside = place.copy()
        beside[0] += away
        moves.append((kind, beside))
    return Own(line, Form.PASSES, [*moves, (Kind.RAPID, end)], len(track.frames) - 1)


def _objections(
    track: Track, line: int, start: Floats, words: dict[str, float | None], named: set[str]
) -> Iterator[tuple[str, str]]:
    """Yield what speaks against a block, and what would be right; unknown numbers are refused."""
    p, i, j, k, r, q = (words[letter] for letter in "PIJKRQ")
    if named != {"Z"}:
        yield "G76 takes Z alone of the axes", "go to X in a block before"
    if p is None or not p > 0:
        yield "G76 without P, its way per turn, above zero", "give it in this block"
    if i is None or not abs(i) > 0:
        yield "G76 without I, from the drive line to the peaks", "give it in this block"
    if j is None or k is None or not k > j > 0:
        yield "G76 without J and K: K is deeper than J, and J is above zero", ""
    if r is not None and not r >= 1:
        yield "R of G76 is 1 at least", ""
    if q is not None and not abs(q) < 90:
        yield "Q of G76 is an angle below 90", ""
    if words["L"] is not None and words["L"] not in (0, 1, 2, 3):
        yield "L of G76 is 0, 1, 2 or 3", ""
    if np.isnan(start[[0, 2]]).any():
        yield "where this thread starts in X and Z is not known", "program X and Z before"
    if track.frame.matrix is not None or track.frame.polar:
        yield "G76 in turned or mirrored coordinates", "leave them before it"


def _value(track: Track, letter: str, line: int) -> float | None:
    word = track.lines.word(letter, distance=False)
    return float(word[0][line]) if word is not None and word[1][line] else None
