"""Where tools are along a path, for the proofs: as axes drive them, or as it is led.

At part s of a row, 0 <= s <= 1:

    p, a, q   (3,) mm, (3,), (m,) degrees: the tip and the tool axis on the workpiece, the angles
    T, w      rad: by how much the axes turn in the row, in all; the angle between a(0) and a(1)

    Driven    j and q in proportion to s, p and a by the chain:    bent by T^2 at most
    Led       p straight, a = sin((1 - s) w) / sin(w) a(0) + sin(s w) / sin(w) a(1): bent by w^2
    Pointed   the same, a(0) and a(1) being the vectors that the program says
    Straight  p straight, q in proportion; only tips are compared with it

`bends` and `leans` are an eighth of how far p (`undoing.py`) and a are bent: of bounds of their
second derivatives by s.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.rtcp.place import Place
from gcxform_plugins.passes.rtcp.proof.undoing import Undoing
from gcxform_plugins.passes.rtcp.tool_vectors import Vectors


class Leading(Protocol):
    """A path and where it leads the tool.

    Between two of n places in a row the tip is at most bends / n^2 (mm) from its chord, and the
    tool axis leans / n^2 (rad).
    """

    path: gx.Toolpath
    place: Place
    start: Floats
    end: Floats
    bends: Floats
    leans: Floats

    def at(self, rows: Ints, part: Floats) -> tuple[Floats, Floats, Floats]:
        """Return tips, tool axes and angles at parts (n,) of rows."""
        ...


class Driven:
    """A path whose axes all move in proportion."""

    def __init__(self, path: gx.Toolpath, place: Place) -> None:
        self.path, self.place = path, place
        self.start, self.end = path.start, path.end
        self.bends = Undoing(path, place, to_tips=True).bends()
        turn = np.abs(np.radians(place.angles(self.end - self.start))).sum(axis=1)
        self.leans = np.nan_to_num(turn) ** 2 / 8.0

    def at(self, rows: Ints, part: Floats) -> tuple[Floats, Floats, Floats]:
        """Return tips, tool axes and angles at parts (n,) of rows."""
        here = _between(self.start, self.end, rows, part)
        angles = self.place.angles(here)
        tips = self.place.tips_of(here[:, :3], angles, rows)
        return tips, self.place.chain.tool_axis(angles), angles


class Led:
    """A path of the tip, which goes straight, while the tool axis goes on great circles."""

    def __init__(self, path: gx.Toolpath, place: Place) -> None:
        self.path, self.place = path, place
        self.start, self.end = path.start, path.end
        self.bends = np.zeros(len(path))
        one, other = (place.chain.tool_axis(place.angles(s)) for s in (self.start, self.end))
        between = np.arctan2(
            np.linalg.norm(np.cross(one, other), axis=1), np.einsum("ij,ij->i", one, other)
        )
        self.leans = np.nan_to_num(between) ** 2 / 8.0

    def at(self, rows: Ints, part: Floats) -> tuple[Floats, Floats, Floats]:
        """Return tips, tool axes and angles at parts (n,) of rows."""
        here = _between(self.start, self.end, rows, part)
        chain = self.place.chain
        one, other = (
            chain.tool_axis(self.place.angles(side[rows])) for side in (self.start, self.end)
        )
        return here[:, :3], _on_circle(one, other, part), self.place.angles(here)


class Straight:
    """A path of the tip, which goes straight while the axes turn in proportion."""

    def __init__(self, path: gx.Toolpath, place: Place) -> None:
        self.path, self.place = path, place
        self.start, self.end = path.start, path.end
        self.bends = self.leans = np.zeros(len(path))

    def at(self, rows: Ints, part: Floats) -> tuple[Floats, Floats, Floats]:
        """Return tips, tool axes and angles at parts (n,) of rows."""
        here = _between(self.start, self.end, rows, part)
        angles = self.place.angles(here)
        return here[:, :3], self.place.chain.tool_axis(angles), angles


class Pointed:
    """The same of a path that says the tool axis as a vector (G43.5)."""

    def __init__(self, path: gx.Toolpath, place: Place) -> None:
        self.path, self.place = path, place
        self.start, self.end = path.start, path.end
        self.vectors = Vectors.of(path)
        self.bends = np.zeros(len(path))
        self.leans = np.nan_to_num(self.vectors.turn()) ** 2 / 8.0

    def at(self, rows: Ints, part: Floats) -> tuple[Floats, Floats, Floats]:
        """Return tips, tool axes and, of the angles, nothing at parts (n,) of rows."""
        here = _between(self.start, self.end, rows, part)
        axis = _on_circle(self.vectors.start[rows], self.vectors.end[rows], part)
        return here[:, :3], axis, np.full((len(rows), len(self.place.columns)), np.nan)


def _on_circle(one: Floats, other: Floats, part: Floats) -> Floats:
    across = np.cross(one, other)
    size = np.linalg.norm(across, axis=1)
    angle = np.arctan2(size, np.einsum("ij,ij->i", one, other)) * part
    pole = across / np.where(size > 0.0, size, 1.0)[:, None]
    axis = np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * np.cross(pole, one)
    return np.where((part == 1.0)[:, None], other, axis)


def _between(start: Floats, end: Floats, rows: Ints, part: Floats) -> Floats:
    return np.where(
        (part == 1.0)[:, None], end[rows], start[rows] + part[:, None] * (end[rows] - start[rows])
    )
