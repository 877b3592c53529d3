"""Rows of moves as they are read from the lines of a window, before they are a toolpath."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gcxform.toolpath.path import Form, column_major, constant

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Small = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Rows:
    """Moves (n,) in order: line of the window, kind, end, which of its line, form, frame."""

    line: Ints
    kind: Small
    end: Floats
    nth: Ints
    form: Small
    frame: Ints

    @classmethod
    def plain(cls, line: Ints, kind: Small, end: Floats, frame: int) -> Rows:
        """Return rows that are one plain move a line."""
        count = len(line)
        return cls(
            line,
            kind,
            end,
            constant(0, count, np.int64),
            constant(Form.PLAIN, count, np.int8),
            constant(frame, count, np.int64),
        )

    @classmethod
    def of_line(cls, line: int, form: Form, moves: list[tuple[int, Floats]], frame: int) -> Rows:
        """Return the moves of one line, given kinds and ends."""
        count = len(moves)
        return cls(
            np.full(count, line),
            np.array([kind for kind, _ in moves], np.int8),
            np.array([end for _, end in moves]),
            np.arange(count),
            constant(form, count, np.int8),
            constant(frame, count, np.int64),
        )

    @classmethod
    def joined(cls, parts: Sequence[Rows], axes: int) -> Rows:
        """Return rows one after another."""
        if len(parts) == 1:
            return parts[0]
        parts = [part for part in parts if len(part.line)] or parts[:1]
        if len(parts) == 1:
            return parts[0]
        end = column_major(sum(len(part.line) for part in parts), axes)
        np.concatenate([part.end for part in parts], out=end)
        names = ("line", "kind", "nth", "form", "frame")
        line, kind, nth, form, frame = (
            np.concatenate([getattr(part, name) for part in parts]) for name in names
        )
        return cls(line, kind, end, nth, form, frame)
