"""Faults of circular tests with RTCP on, of the names of errors, and of what is simulated."""

from __future__ import annotations

from faults.mutation import Mutation

FIGURES = "tests/test_ballbar.py"
FILES = "tests/test_ballbar_files.py"
READINGS = "tests/test_readings.py"
PLAN = "tests/test_plan.py"
PICTURES = "tests/test_residual_pictures.py"


def _ballbar(file: str, name: str, old: str, new: str, tests: str = FIGURES) -> Mutation:
    return Mutation(f"ballbar: {name}", file, old, new, tests)


MUTATIONS = (
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "the sense of an axis is lost",
        "axis.sign * np.cross(along, lever)]",
        "-np.cross(along, lever)]",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "a tilt has no lever along the axis",
        "part * arms - (lever @ along) * square",
        "part * arms",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "a shift moves the bar the other way",
        "= -square @ basis.T",
        "= square @ basis.T",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "the spindle ball is on the spindle",
        "np.array([*spindle, 0.0])\n    return",
        "0.0\n    return",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "the second order stays",
        "ROUNDS: Final = 3",
        "ROUNDS: Final = 1",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "cosine and sine do not depend on each other",
        "np.linalg.inv(rows.T @ rows)[:2, :2]",
        "np.diag(np.diag(np.linalg.inv(rows.T @ rows)[:2, :2]))",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "short arcs are as good",
        "if poor > HOPELESS:",
        "if poor > 1e9:",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "a trace may be anything",
        "if found.rms > REJECTED * noise:",
        "if False:",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "tests may contradict each other",
        "if solution.ratio > REJECTED:",
        "if False:",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/ballbar.py",
        "tilts are not scaled back",
        "np.tile([1.0, 1.0, 1.0 / LEVER, 1.0 / LEVER]",
        "np.tile([1.0, 1.0, 1.0, 1.0]",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/locations.py",
        "a turn about Y lowers XOC",
        "[[0.0, oz, -oy]",
        "[[0.0, -oz, -oy]",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/locations.py",
        "the tilting axis turns C with it",
        "np.eye(8)[6 + other] - turns[other]",
        "np.eye(8)[6 + other]",
    ),
    _ballbar(
        "gcxform/calibrate/rotary/predicted_check.py",
        "turns are directions",
        "np.cross(axis.direction, basis).T",
        "basis.T",
    ),
    _ballbar(
        "gcxform/calibrate/rotary/predicted_check.py",
        "the dial does not turn with the lever",
        "-crossing(rotation @ lever) + rotation @ crossing(lever)",
        "-crossing(rotation @ lever) + crossing(lever)",
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/file.py",
        "a test is told by its axis alone",
        "if other == key]",
        "if other[1].letter == key[1].letter]",
        FILES,
    ),
    _ballbar(
        "gcxform/calibrate/ballbar/file.py",
        "a bar has one length",
        "BARS[bar], (x, y, z), length)",
        "BARS[bar], (x, y, z))",
        FILES,
    ),
    Mutation(
        "balls: a ball is where it was planned",
        "gcxform/simulate/balls.py",
        "tips[plan.ball.index(name)]",
        "tips.mean(axis=0)",
        READINGS,
    ),
    Mutation(
        "balls: scales are not seen",
        "gcxform/simulate/balls.py",
        "stands = compensate(model, stands).position",
        "pass",
        READINGS,
    ),
    Mutation(
        "balls: any model will do",
        "gcxform/simulate/balls.py",
        "if model.outside(stands).any():",
        "if False:",
        READINGS,
    ),
    Mutation(
        "ballbar: the bar along an axis is square to it",
        "gcxform/simulate/ballbar.py",
        "for way in (square, along):",
        "for way in (square, square):",
        READINGS,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "the worst poses are taken",
        "np.argmax(np.round(gains, 9))",
        "np.argmin(np.round(gains, 9))",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "a pose is taken twice",
        "gains[taken] = -np.inf",
        "pass",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/clearance.py",
        "limits have no room",
        "(stands <= high - above)",
        "(stands <= high + 3.0 * above)",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/clearance.py",
        "any tilt will do",
        ">= math.cos(math.radians(tilt)) - 1e-12",
        ">= -2.0",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "positions are not as written",
        "every).round(3)\n        good",
        "every).round(1)\n        good",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/touching.py",
        "the touch above is above the middle",
        "np.sqrt(radius**2 - far**2)",
        "radius",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/touching.py",
        "the centre is where four touches are on average",
        "found[:, 1:].sum(axis=1) / 2.0",
        "found[:, 1:].mean(axis=1)",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/touching.py",
        "the post is touched",
        "[45.0, 225.0, 135.0, 315.0]",
        "[0.0, 180.0, 90.0, 270.0]",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/touching.py", "any angles will do", "> ANGLE)", "> 400.0)", PLAN
    ),
    _ballbar(
        "gcxform/calibrate/bundle/touching.py",
        "a probe ends at the surface",
        "probing.radius - probing.clearance",
        "probing.radius",
        PLAN,
    ),
    Mutation(
        "residuals: readings left out are drawn as the others",
        "gcxform/plot/residuals.py",
        "axes.plot(turns[kept], values[kept], ",
        "axes.plot(turns, values, ",
        PICTURES,
    ),
    Mutation(
        "residuals: the ring is for one more division",
        "gcxform/plot/canvas.py",
        "division = nice(max(most / 2.0, 1e-6))",
        "division = nice(max(most, 1e-6))",
        PICTURES,
    ),
    Mutation(
        "residuals: a trace keeps its constant",
        "gcxform/plot/residuals.py",
        "(test.trace.readings - test.fitted[2])",
        "(test.trace.readings - 0.01)",
        PICTURES,
    ),
    Mutation(
        "bundle: the check is that of another axis",
        "gcxform/calibrate/bundle/report.py",
        "found.unknowns[first : first + 3]",
        "found.unknowns[first : first + 3] * 0.0",
        "tests/test_bundle.py",
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "the end of a turn is not its beginning",
        "[good, good & closed]",
        "[good, good & False]",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "a circle ends where it begins",
        "np.arange(wanted.poses) * 360.0 / wanted.poses",
        "np.linspace(0.0, 360.0, wanted.poses)",
        PLAN,
    ),
    _ballbar(
        "gcxform/calibrate/bundle/plan.py",
        "a circle may tilt the table",
        "wanted.room) & upright(chain, angles, wanted.tilt)",
        "wanted.room)",
        PLAN,
    ),
)
