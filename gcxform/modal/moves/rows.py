"""Rows of moves as they are read from the lines of a window, before they are a toolpath."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gcxform.system.arrays import Floats, Ints, Small
from gcxform.toolpath.columns import column_major, constant
from gcxform.toolpath.path import Form


@dataclass(frozen=True, slots=True)
class Stretches:
    """First line and last line + 1 of stretches, and what lines do that begin some of them.

    Before `leaving` an M code loses positions, before `lost` a jump some axes; `busy` (live + 1,)
    counts lines that change them.
    """

    borders: list[tuple[int, int]]
    acts: set[int]
    resets: set[int]
    singles: set[int]
    leaving: set[int]
    lost: dict[int, str]
    busy: list[int]


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
    def plain(cls, line: Ints, kind: Small, end: Floats, frame: Ints) -> Rows:
        """Return rows that are one plain move a line."""
        count = len(line)
        return cls(
            line,
            kind,
            end,
            constant(0, count, np.int64),
            constant(Form.PLAIN, count, np.int8),
            frame,
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
        """Return all rows in the order of their lines; those of one line are in one part."""
        if len(parts) == 1:
            return parts[0]
        line = np.concatenate([part.line for part in parts])
        order = np.argsort(line, kind="stable")
        end = column_major(len(line), axes)
        ends = [part.end for part in parts]
        for k in range(axes):
            end[:, k] = np.concatenate([one[:, k] for one in ends])[order]
        names = ("kind", "nth", "form", "frame")
        kind, nth, form, frame = (
            np.concatenate([getattr(part, name) for part in parts])[order] for name in names
        )
        return cls(line[order], kind, end, nth, form, frame)
