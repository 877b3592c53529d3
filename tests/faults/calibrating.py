"""Faults of calibration by body diagonals."""

from __future__ import annotations

from faults.mutation import Mutation

FIGURES = "tests/test_step_diagonal.py"
PLAIN = "tests/test_plain_diagonal.py"
FILES = "tests/test_diagonal_files.py"
COMMAND = "tests/test_calibrate.py"
ANGLES = "tests/test_angles.py"
ROUND_TRIP = "tests/properties/test_diagonal.py"


def _calibrate(file: str, name: str, old: str, new: str, tests: str = FIGURES) -> Mutation:
    return Mutation(f"diagonal: {name}", file, old, new, tests)


def _angles(name: str, old: str, new: str) -> Mutation:
    return _calibrate("gcxform/calibrate/diagonal/angles.py", name, old, new, ANGLES)


MUTATIONS = (
    # the equations
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "a reversed step keeps its sign",
        "sign * along[direction]",
        "along[direction]",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "cells are counted by time",
        "if sign < 0:\n                grown",
        "if sign < -1:\n                grown",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "axis and direction are swapped",
        "column = (3 * axis + direction) * layout.steps",
        "column = (3 * direction + axis) * layout.steps",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "a misaligned beam forgets the sense of a step",
        "= sign * step * aside",
        "= step * aside",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "means count as single readings",
        "noise / np.sqrt(n)",
        "noise",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "a linear test begins at machine zero",
        "(test.position - volume.low[test.axis])",
        "test.position",
        ROUND_TRIP,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "a linear test has no constant of its own",
        "rows[:, layout.errors + 2 * layout.beams + run] = 1.0",
        "pass",
        ROUND_TRIP,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/equations.py",
        "scatter is divided by the number of readings",
        "int((count - 1).sum())",
        "int(count.sum())",
    ),
    # the solution
    _calibrate(
        "gcxform/calibrate/solution.py",
        "the covariance is of whitened directions",
        "back @ back.T, right",
        "right[known].T @ right[known], right",
    ),
    _calibrate(
        "gcxform/calibrate/solution.py",
        "free directions are not seen",
        "RANK: Final = 1e-9",
        "RANK: Final = 1e-30",
    ),
    _calibrate(
        "gcxform/calibrate/solution.py",
        "redundancy counts all readings",
        "return len(self.residual) - self.rank",
        "return len(self.residual)",
    ),
    _calibrate(
        "gcxform/calibrate/solution.py",
        "chi square may be what it is on average",
        "SELDOM: Final = 1e-3",
        "SELDOM: Final = 0.5",
    ),
    # the frame
    _calibrate(
        "gcxform/calibrate/diagonal/reframe.py",
        "the turn about Z is the other way",
        "about_z = -slopes[..., 0, 1]",
        "about_z = slopes[..., 0, 1]",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/reframe.py",
        "the turn about Y is the other way",
        "about_y = slopes[..., 0, 2]",
        "about_y = -slopes[..., 0, 2]",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/reframe.py",
        "the turn about X is the other way",
        "about_x = -slopes[..., 1, 2]",
        "about_x = slopes[..., 1, 2]",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/reframe.py",
        "removed slopes are not carried over",
        "    return slopes\n",
        "    return np.triu(slopes)\n",
    ),
    # what is observable, what is refused
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "functions that are not determined are given",
        "if not self.determined.all():",
        "if not self.determined.any():",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "beams stay where they were in a turned frame",
        "angles - volume.diagonal * turned",
        "angles + volume.diagonal * turned",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "contradictions are taken",
        "if not found.redundancy_rms > limit:",
        "if True:",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "aligned beams are not questioned",
        "    if gain > limit:",
        "    if False:",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "scales are not questioned",
        "    if limit < gain:",
        "    if False:",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "signs are not questioned",
        "if gain > plausible(1) * max(1.0, other.ratio**2):",
        "if gain > 1e9:",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "linear tests are not questioned",
        "gain > REJECTED**2 * added",
        "gain > 1e9 * added",
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "the mean scale has equal weights",
        "square = self.diagonals.volume.travel**2",
        "square = self.diagonals.volume.travel**0",
        PLAIN,
    ),
    # the plain test
    _calibrate(
        "gcxform/calibrate/diagonal/plain_diagonal.py",
        "squareness has the sides of another plane",
        "size / (x * y), size / (x * z)",
        "size / (x * z), size / (x * y)",
        PLAIN,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/plain_diagonal.py",
        "the signs of a diagonal are mixed up",
        "(1.0, x * y, x * z, y * z)",
        "(1.0, x * y, y * z, x * z)",
        PLAIN,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/plain_diagonal.py",
        "a way back counts as a way out",
        "deviation = leg.ahead[1]",
        "deviation = leg.deviation",
        f"{ROUND_TRIP}::test_the_squareness_of_any_machine",
    ),
    # reports
    _calibrate(
        "gcxform/calibrate/diagonal/report.py",
        "the sign of C0Y is swapped",
        '("C0Y", -1.0)',
        '("C0Y", 1.0)',
        COMMAND,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/report.py",
        "the sign of A0Z is swapped",
        '("A0Z", -1.0)',
        '("A0Z", 1.0)',
        COMMAND,
    ),
    # files
    _calibrate(
        "gcxform/calibrate/diagonal/file.py",
        "readings keep their nominal",
        "values = values - values[0] - nominal",
        "values = values - values[0]",
        FILES,
    ),
    _calibrate(
        "gcxform/calibrate/csv_text.py", "inches are millimetres", '"in": 25.4', '"in": 1.0', FILES
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/readings.py",
        "steps may differ",
        "if not len(wrong):",
        "if True:",
        FILES,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/readings.py",
        "volumes may differ",
        "(np.abs(corner - corners[0]) > TOLERANCE)",
        "(np.abs(corner - corners[0]) > 1e9)",
        FILES,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/readings.py",
        "a diagonal may be missing",
        "if signs not in lines]",
        "if signs in ()]",
        FILES,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/readings.py",
        "a diagonal may go the other way",
        "if way * sign * sense <= TOLERANCE:",
        "if abs(way) <= TOLERANCE:",
        FILES,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/readings.py",
        "a way back is a way out",
        "slice(None) if self.forward else slice(None, None, -1)",
        "slice(None)",
    ),
    # readings
    # angular errors
    _angles("a turn moves along its lever", "self.direction] = shape", "self.lever] = shape"),
    _angles("the noise of what is left is forgotten", "max(1.0, self.left / self.freedom)", "1.0"),
    _angles(
        "the unknowns of the method keep their part", "read - basis @ (basis.T @ read)", "read"
    ),
    _angles("weak directions count as strong", "_WEAK: Final = 0.25", "_WEAK: Final = 1e-6"),
    _angles(
        "amounts are those of their directions",
        "(told / size[strong]) @",
        "(told * size[strong]) @",
    ),
    _angles("the linear tests stand in the middle", "= place ** (power + 1)", "= 0.0"),
    _angles("alarms are ten times as many", "RATE / len(DEGREES)", "10 * RATE / len(DEGREES)"),
    _calibrate(
        "gcxform/calibrate/diagonal/step_diagonal.py",
        "deviations are those of the stated noise",
        "self.scatter.factor**2 * (part",
        "1.0 * (part",
        ANGLES,
    ),
    _calibrate(
        "gcxform/calibrate/diagonal/plain_diagonal.py",
        "four lengths are as good as they say",
        "self.scatter.factor * self._factors",
        "self._factors",
        ANGLES,
    ),
)
