"""Faults of the calibration of rotary axes, and of what is said about it."""

from __future__ import annotations

from faults.mutation import Mutation

FIGURES = "tests/test_rotary.py"
CIRCLES = "tests/test_ball_circles.py"
CHECK = "tests/test_rotary_check.py"
FILES = "tests/test_rotary_files.py"
BUNDLE = "tests/test_bundle.py"
SPECIAL = {
    "gcxform/calibrate/rotary/circle.py": CIRCLES,
    "gcxform/calibrate/rotary/check.py": CHECK,
}


def _rotary(file: str, name: str, old: str, new: str, tests: str = "") -> Mutation:
    by = tests or SPECIAL.get(file, FIGURES)
    return Mutation(f"rotary: {name}", file, old, new, by)


MUTATIONS = (
    # circles
    _rotary(
        "gcxform/calibrate/rotary/circle.py",
        "the plane is that of the largest",
        "axes[..., 2, :]",
        "axes[..., 0, :]",
    ),
    _rotary(
        "gcxform/calibrate/rotary/circle.py",
        "one step is enough",
        "for _ in range(STEPS):",
        "for _ in range(1):",
    ),
    _rotary(
        "gcxform/calibrate/rotary/circle.py",
        "any axis is upright",
        "np.where(largest < 0.0, -vectors",
        "np.where(largest < -2.0, -vectors",
        FIGURES,
    ),
    _rotary(
        "gcxform/calibrate/rotary/circle.py",
        "the slopes forget the radius",
        "-inside / circle.radius",
        "-inside",
    ),
    _rotary(
        "gcxform/calibrate/rotary/circle.py",
        "the height has no variance",
        "[np.zeros((3, 2)), axis]",
        "[np.zeros((3, 2)), 0 * axis]",
    ),
    # the fit with angles
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "turns of the fit add up",
        "design[..., 3:6] @ _added(step[3:6])",
        "design[..., 3:6]",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "the start turns the other way",
        "(u + np.cross(w, direction))",
        "(u - np.cross(w, direction))",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "the sense is lost",
        "return 1 if float(self.direction @",
        "return 1 if float(self.figure.direction @",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "a turn of the figure is its opposite",
        "[shift, -crossing(arms), growth]",
        "[shift, crossing(arms), growth]",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "a tilt is its opposite",
        "-crossing(self.direction), np.zeros((3, 1))]",
        "0 * crossing(self.direction), np.zeros((3, 1))]",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "unknowns are not counted",
        "self.kept.sum()) - UNKNOWNS",
        "self.kept.sum())",
        FILES,
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "the covariance is not squared",
        "self.scatter.effective**2 * np.linalg",
        "self.scatter.effective * np.linalg",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "outliers are kept",
        "weights), OUTLYING)",
        "weights), 1e9)",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "deviations are those of the stated noise",
        "self.scatter.effective**2",
        "self.noise**2",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/ballbar/ballbar.py",
        "deviations of a ballbar are those of the stated noise",
        "scale = self.scatter.factor * self._scale",
        "scale = self._scale",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/ballbar/ballbar.py",
        "what is left within traces is forgotten",
        "chi_square = within + between.chi_square",
        "chi_square = between.chi_square",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/solution.py",
        "less scatter makes deviations better",
        "return max(1.0, self.ratio)",
        "return max(0.1, self.ratio)",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/solution.py",
        "all that is worse than stated lies",
        "outlying * shown",
        "outlying",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "residuals are not standardised",
        "noise * np.sqrt(np.clip(1.0 - taken, 1e-6, None))",
        "10 * noise",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "the head forgets the tip",
        "self.figure.arm + self.tip",
        "self.figure.arm",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "the head has the covariance of the table",
        "if self.tip is not None:\n            shift =",
        "if False:\n            shift =",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "leaving out leaves in",
        "kept[k] = False",
        "kept[k] = True",
    ),
    # refusals
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "no arc is too short",
        "if poor > HOPELESS:",
        "if poor > 1e9:",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "a copied centre passes",
        "if first != row and (",
        "if first == -1 and (",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "a full turn is a copy",
        "math.remainder(apart, 360.0) != 0.0",
        "apart != 0.0",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "a ball at rest passes",
        "if singular[0] <= blur:",
        "if singular[0] < 0.0:",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "turns are different positions",
        "np.mod(degrees, 360.0), 6) % 360.0",
        "degrees, 6)",
    ),
    _rotary(
        "gcxform/calibrate/rotary/axis.py",
        "contradictions pass",
        "found.rms > REJECTED * noise",
        "found.rms > 1e9",
    ),
    _rotary(
        "gcxform/calibrate/rotary/machine.py",
        "any axis will do",
        "if off > FAR:",
        "if off > 360.0:",
        FILES,
    ),
    _rotary(
        "gcxform/calibrate/rotary/machine.py",
        "any sense will do",
        "* cosine < 0.0:",
        "* cosine < -2.0:",
        FILES,
    ),
    # what is said
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "three points are sound",
        "if count == 3:",
        "if count == 2:",
        FIGURES,
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "a short arc is sound",
        "if found.condition > ILL:",
        "if found.condition > HOPELESS:",
        FIGURES,
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "the dial sees no tilt",
        "effect = (np.eye(3) - rotation) @ moves + tilt @ turn",
        "effect = (np.eye(3) - rotation) @ moves",
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "the dial starts at angle 0",
        "found.figure.arms(found.centres.degrees[:1])[0]",
        "found.figure.arm",
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "the worst position is next",
        "int(np.argmin(np.round(left",
        "int(np.argmax(np.round(left",
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "harmonics are swapped",
        "np.cos(q), np.sin(q), np.cos(2 * q), np.sin(2 * q)",
        "np.cos(2 * q), np.sin(2 * q), np.cos(q), np.sin(q)",
    ),
    _rotary(
        "gcxform/calibrate/rotary/check.py",
        "the axial part is the radial one",
        '("radial", "tangential", "axial")',
        '("axial", "tangential", "radial")',
    ),
    # all axes
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "squareness has the other sign",
        "[scale, -c0y, b0z]",
        "[scale, c0y, b0z]",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "readings are where the machine stands",
        "np.linalg.solve(np.eye(3) + self.errors(unknowns), stands.T).T",
        "stands",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "all balls are the first",
        "balls[self.poses.index]",
        "balls[[0] * len(self.poses.ball)]",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "the blind are not refused",
        "for row in blind(layout, design):",
        "for row in ():",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "outliers of a bundle are kept",
        "noise), OUTLYING)",
        "noise), 1e9)",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "differences are not halved",
        "/ (2.0 * size)",
        "/ size",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/bundle/bundle.py",
        "contradictions of a bundle pass",
        "found.rms > REJECTED * noise",
        "found.rms > 1e9",
        BUNDLE,
    ),
    _rotary(
        "gcxform/calibrate/solution.py",
        "what is far off weighs as much as the rest",
        "1.0 / (1.0 + part)",
        "1.0 + 0.0 * part",
        "tests/test_scatter.py",
    ),
    _rotary(
        "gcxform/calibrate/rotary/predicted_check.py",
        "a shift is a tilt",
        "for part in parts",
        "for part in parts[::-1]",
        BUNDLE,
    ),
    # files
    _rotary(
        "gcxform/calibrate/csv_text.py",
        "a radian is a degree",
        '"rad": math.degrees(1.0)',
        '"rad": 1.0',
        FILES,
    ),
    Mutation(
        "rotary: old comments stay",
        "gcxform/machine/axis_text.py",
        "while old and lines",
        "while not old and lines",
        FILES,
    ),
    Mutation(
        "rotary: what was written is not looked at",
        "gcxform/machine/axis_text.py",
        "if tomllib.loads(written) != wanted:",
        "if tomllib.loads(written) == 0:",
        "tests/test_axis_text.py",
    ),
)
