"""Frames: how the numbers of a program become positions.

A position is where the spindle's reference point stands, counted from the zero of the work offset
in which the program starts. It does not change when a program shifts its coordinates: G55, G92,
G52, G68 or a tool length change the frame, and no axis moves. So geometry is compared and changed
in positions, and frames matter only where words are read and written:

    position = matrix @ word + shift

Where the shift between two frames is not known, the axis counts from another origin, and its
position is lost until it is programmed again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass

FLAT = 1e-12  # by how much the cosine of an angle that is none may differ from 1
Vector = tuple[float, ...]
Matrix = tuple[tuple[float, float, float], ...]


@dataclass(frozen=True)
class Frame:
    """How the words of a block become positions.

    work     the work offset in force, "G54"
    shift    per axis, mm or degrees: the position of a word 0
    origin   per axis: the zero from which positions count, by name
    matrix   3 x 3 for X, Y, Z, where the words are turned, scaled or mirrored
    diameter whether X words are diameters (G7)
    polar    whether the first two words of the plane are radius and angle (G16)
    tool     mm, from the tool's tip to the spindle's reference point, as the control adds it;
             nan where it adds a length that is not known
    following  whether the control takes X, Y and Z for the tip; None where that is not known, or no
             code that is read switches it
    called   whether the program has called a tool length, which may be 0
    valued   whether it has given that length by its value (G43.1), and not by a number
    instead  whether one by its number was in force until then, and not ended
    machine  whether words are those of the machine, whatever is in force: for a way home by G53
    """

    work: str
    shift: Vector
    origin: tuple[str, ...]
    matrix: Matrix | None = None
    diameter: bool = False
    polar: bool = False
    tool: tuple[float, float, float] = (0.0, 0.0, 0.0)
    following: bool | None = None
    called: bool = False
    valued: bool = False
    instead: bool = False
    machine: bool = False

    @cached_property
    def shifts_only(self) -> bool:
        """Whether words are positions but for a shift."""
        return self.matrix is None and not self.diameter

    def tilts(self, normal: int) -> bool:
        """Whether a plane of words, across an axis, is turned out of the axes of positions."""
        return self.matrix is not None and abs(abs(self.matrix[normal][normal]) - 1.0) > FLAT

    def is_apart(self, axis: int) -> bool:
        """Whether words of an axis, by number, are its positions but for a shift."""
        if self.matrix is None or axis >= len(self.matrix):
            return True
        whole = range(len(self.matrix))
        return all(self.matrix[axis][k] == self.matrix[k][axis] == float(k == axis) for k in whole)

    @cached_property
    def plain(self) -> bool:
        """Whether words are positions."""
        return self.shifts_only and not any(self.shift)

    @cached_property
    def added(self) -> Vector:
        """What is added to words where `shifts_only`: -0.0 leaves every bit of one as it is."""
        return (-0.0,) * len(self.shift) if self.plain else self.shift

    def positions(self, words: Floats) -> Floats:
        """Return the positions (n, axes) of words (n, axes)."""
        return self.placed(_scaled(words, 0.5) if self.diameter else words)

    def words(self, positions: Floats) -> Floats:
        """Return the words (n, axes) of positions (n, axes)."""
        local = self.local(positions)
        return _scaled(local, 2.0) if self.diameter else local

    def point(self, words: list[float]) -> list[float]:
        """Return the position of words, a number for each axis: `positions` of one block."""
        if self.plain:
            return words
        if self.shifts_only:
            return [word + shift for word, shift in zip(words, self.shift, strict=True)]
        found: list[float] = self.positions(np.array([words]))[0].tolist()
        return found

    def words_of(self, point: list[float]) -> list[float]:
        """Return the words of a position, a number for each axis: `words` of one."""
        if self.plain:
            return point
        if self.shifts_only:
            return [place - shift for place, shift in zip(point, self.shift, strict=True)]
        found: list[float] = self.words(np.array([point]))[0].tolist()
        return found

    def placed(self, local: Floats) -> Floats:
        """Return positions (n, k) of coordinates (n, k) in this frame; k is 3 or all axes."""
        if self.plain:
            return local
        return np.asarray(self.turned(local) + np.array(self.shift[: local.shape[1]]))

    def local(self, positions: Floats) -> Floats:
        """Return coordinates (n, k) in this frame of positions (n, k); k is 3 or all axes."""
        if self.plain:
            return positions
        return self.unturned(positions - np.array(self.shift[: positions.shape[1]]))

    def turned(self, vectors: Floats) -> Floats:
        """Return vectors (n, 3 or more) of the program as vectors between positions."""
        return vectors if self.matrix is None else _product(np.array(self.matrix), vectors)

    def unturned(self, vectors: Floats) -> Floats:
        """Return vectors between positions (n, 3 or more) as vectors of the program."""
        if self.matrix is None:
            return vectors
        return _product(np.linalg.inv(np.array(self.matrix)), vectors)

    def mirrors(self, first: int, second: int) -> bool:
        """Whether left becomes right in the plane of two axes, which it does not leave."""
        if self.matrix is None:
            return False
        m = self.matrix
        return m[first][first] * m[second][second] < m[first][second] * m[second][first]


def by_frame(
    change: Callable[[Frame, Floats], Floats],
    frames: Sequence[Frame],
    which: Ints,
    values: Floats,
    sign: float,
) -> Floats:
    """Return values (n, k) changed, each in its frame; `sign` is that of the shift.

    Frames that only shift are done at once, however many they are: every tool has its own.
    """
    if all(frame.plain for frame in frames):
        return values
    if len(frames) == 1:
        return change(frames[0], values)
    changed = np.empty(values.shape[::-1]).T
    shifts = sign * np.array([frame.shift for frame in frames])
    for axis in range(values.shape[1]):
        shift = shifts[:, axis]
        changed[:, axis] = values[:, axis] + shift[which] if shift.any() else values[:, axis]
    for number, frame in enumerate(frames):
        if not frame.shifts_only:
            rows = np.flatnonzero(which == number)
            changed[rows] = change(frame, values[rows])
    return changed


def _scaled(words: Floats, factor: float) -> Floats:
    """Return words (n, axes) with X multiplied."""
    return np.asarray(words * np.append(factor, np.ones(words.shape[1] - 1)))


def _product(matrix: Floats, vectors: Floats) -> Floats:
    """Return vectors with X, Y, Z multiplied; what is not known spreads only where it counts."""
    result = np.array(vectors, order="F")
    for row in range(3):
        used = np.flatnonzero(np.abs(matrix[row]) > 1e-15)
        with np.errstate(invalid="ignore"):  # of axes that a control has left where they are (inf)
            result[:, row] = sum(matrix[row, k] * vectors[:, k] for k in used)
    return result
