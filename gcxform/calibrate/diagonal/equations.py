"""What readings say about the errors of the axes: one linear equation for each.

A step of axis A through its cell k, on the diagonal with signs s and beam u = (s_B c_B), changes
the deviation by

    m = s_A u . e_A(k) + s_A h_A (d . a_A)

e_A(k) is how much the error (3,) of the axis grows over the cell in its positive direction: twice
the sign of a reversed step cancels. h_A is the step, and d the misalignment of the beam, square to
it. (C. Wang, Rev. Sci. Instrum. 71 (2000) 3933; the misalignment after Ibaraki and Hata, Precis.
Eng. 34 (2010) 516.) Cells are counted by position, from the low corner.

The unknowns are, in this order: e (axis, direction, cell), mm; with free beams two misalignments
for each set-up, mm at the end of the diagonal; a constant for each run of a linear test, mm.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.calibrate.diagonal.readings import Diagonals, LinearTest, Volume, beam, sideways
from gcxform.system.arrays import Floats
from gcxform.values import dataclass


@dataclass(frozen=True)
class Layout:
    """Which unknown stands where: cells of an axis, set-ups with a free beam, linear runs."""

    steps: int
    beams: int
    runs: int

    @property
    def errors(self) -> int:
        """How many unknowns are errors of cells."""
        return 9 * self.steps

    @property
    def angles(self) -> slice:
        """The misalignments."""
        return slice(self.errors, self.errors + 2 * self.beams)

    @property
    def size(self) -> int:
        """How many unknowns there are."""
        return self.errors + 2 * self.beams + self.runs


@dataclass(frozen=True, eq=False)
class Equations:
    """Observations (m,) in mm with their standard deviations (m,), and the matrix (m, n)."""

    layout: Layout
    matrix: Floats
    observed: Floats
    deviation: Floats


@dataclass(frozen=True, eq=False)
class Increments:
    """The means of the increments of each set-up: (set-ups, axis, cell) mm, how many of each.

    `scatter` is the standard deviation of one increment about its mean, in mm, nan if none was
    repeated.
    """

    mean: Floats
    count: Floats
    scatter: float


def increments(diagonals: Diagonals) -> Increments:
    """Return what the deviations grow by over each cell; ways out and back are averaged.

    Backlash and noise are the same to a mean; `scatter` shows both.
    """
    steps = diagonals.volume.steps
    lines = diagonals.lines
    total = np.zeros((len(lines), 3, steps))
    squares, count = np.zeros_like(total), np.zeros(len(lines))
    for leg in diagonals.legs:
        grown = np.diff(leg.ahead[1]).reshape(steps, 3).T
        for axis, sign in enumerate(leg.signs):
            if sign < 0:
                grown[axis] = grown[axis, ::-1]
        line = lines.index(leg.signs)
        total[line] += grown
        squares[line] += grown**2
        count[line] += 1
    mean = total / count[:, None, None]
    left = squares.sum() - (mean * total).sum()
    repeated = 3 * steps * int((count - 1).sum())
    scatter = float(np.sqrt(max(left, 0.0) / repeated)) if repeated else float("nan")
    return Increments(mean, count, scatter)


def equations(
    diagonals: Diagonals,
    linear: Sequence[LinearTest],
    noise: float,
    linear_noise: float,
    free_beams: bool,
) -> Equations:
    """Return the equations of all readings; noise of a step, of a linear reading, in mm."""
    lines = diagonals.lines
    layout = Layout(diagonals.volume.steps, len(lines) if free_beams else 0, len(linear))
    grown = increments(diagonals)
    blocks = [_diagonal_rows(layout, diagonals, line) for line in range(len(lines))]
    blocks += [_linear_rows(layout, diagonals.volume, run, t) for run, t in enumerate(linear)]
    observed = [*grown.mean.reshape(len(lines), -1), *(test.deviation for test in linear)]
    deviation = [
        *(np.full(3 * layout.steps, noise / np.sqrt(n)) for n in grown.count),
        *(np.full(len(test.deviation), linear_noise) for test in linear),
    ]
    return Equations(
        layout, np.concatenate(blocks), np.concatenate(observed), np.concatenate(deviation)
    )


def _diagonal_rows(layout: Layout, diagonals: Diagonals, line: int) -> Floats:
    """Return the rows (3 steps, n) of a set-up: axes, then cells."""
    volume, signs = diagonals.volume, diagonals.lines[line]
    along = beam(signs, volume.travel)
    rows = np.zeros((3, layout.steps, layout.size))
    cells = np.arange(layout.steps)
    for axis, sign in enumerate(signs):
        for direction in range(3):
            column = (3 * axis + direction) * layout.steps + cells
            rows[axis, cells, column] = sign * along[direction]
        if layout.beams:
            aside = sideways(signs, volume.travel)[:, axis] / volume.diagonal
            first = layout.angles.start + 2 * line
            step = volume.travel[axis] / layout.steps
            rows[axis, :, first : first + 2] = sign * step * aside
    return rows.reshape(-1, layout.size)


def _linear_rows(layout: Layout, volume: Volume, run: int, test: LinearTest) -> Floats:
    """Return the rows (n targets, n) of a run: the cells passed on the way, and its constant."""
    rows = np.zeros((len(test.position), layout.size))
    cell = (test.position - volume.low[test.axis]) * layout.steps / volume.travel[test.axis]
    first = (3 * test.axis + test.axis) * layout.steps
    passed = np.clip(cell[:, None] - np.arange(layout.steps), 0.0, 1.0)
    rows[:, first : first + layout.steps] = passed
    rows[:, layout.errors + 2 * layout.beams + run] = 1.0
    return rows
