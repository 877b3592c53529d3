"""Rows of moves as they are read from the lines of a window, before they are a toolpath."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gcxform.system.arrays import Floats, Ints, Small
from gcxform.toolpath.columns import column_major, constant
from gcxform.toolpath.path import Form
from gcxform.values import dataclass


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


class Own(NamedTuple):
    """The moves of one line, kinds and ends, that moves in its own way: G28, G53, a probe, a tap.

    They are as short as can be: a program may have such a line for each ten, and arrays of their
    own would take longer than all else.
    """

    line: int
    form: Form
    moves: Sequence[tuple[int, Floats | list[float]]]
    frame: int


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
    def of_lines(cls, own: Sequence[Own]) -> Rows:
        """Return the moves of lines that move in ways of their own, at least one move in all."""
        count = np.array([len(each.moves) for each in own])
        form = np.array([each.form for each in own], np.int8)
        frame = np.array([each.frame for each in own])
        return cls(
            np.repeat(np.array([each.line for each in own]), count),
            np.array([kind for each in own for kind, _ in each.moves], np.int8),
            np.array([end for each in own for _, end in each.moves]),
            np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count),
            np.repeat(form, count),
            np.repeat(frame, count),
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
