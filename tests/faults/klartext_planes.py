"""Faults of PLANE of a TNC: which plane it says, the attitude taken, and what may move in it."""

from __future__ import annotations

from faults.mutation import Mutation

PLANES = "plugins/gcxform_plugins/dialects/heidenhain/planes.py"
TILTING = "plugins/gcxform_plugins/dialects/heidenhain/tilting.py"
POSES = "gcxform/machine/tilting.py"
LINES = "plugins/gcxform_plugins/dialects/heidenhain/lines.py"
DATUMS = "plugins/gcxform_plugins/dialects/heidenhain/datums.py"
FILE = "tests/test_klartext_planes.py"
POINT = f"{FILE}::test_a_point_of_a_plane_is_where_trying_all_angles_says[0]"
EXAMPLE = f"{FILE}::test_the_example_of_the_manual"
WAYS = f"{FILE}::test_one_plane_said_in_four_ways"
PUBLISHED = f"{FILE}::test_published_poses"


def case(name: str) -> str:
    return f"tests/test_corpus.py::test_case[dialects/heidenhain/plane-{name}]"


MUTATIONS = (
    Mutation(
        "klartext planes: turns of one attitude are several",
        TILTING,
        "fit += [{**turns, self.master: signed}] if signed else []",
        "fit += [{**turns, self.master: [value]} for value in signed]",
        case("several-turns"),
    ),
    Mutation(
        "klartext planes: behind a line that turns in rapid the feed goes on",
        LINES,
        "            self._modes([code for code in codes if code not in TILTED])\n",
        "",
        case("rapid-behind"),
    ),
    Mutation(
        "klartext planes: a preset whose place goes into the words is said as well",
        DATUMS,
        'if work not in ("", "G54") and self.reading.turns_plainly',
        "if False and self.reading.turns_plainly",
        "tests/test_corpus.py::test_case[dialects/heidenhain/presets-folded]",
    ),
    Mutation(
        "klartext planes: spatial angles go along",
        TILTING,
        "np.asarray(c @ b @ a)",
        "np.asarray(a @ b @ c)",
        PUBLISHED,
    ),
    Mutation(
        "klartext planes: the angles of EULER are about axes that stand still",
        TILTING,
        'about("Z", first) @ about("X", second) @ about("Z", third)',
        'about("Z", third) @ about("X", second) @ about("Z", first)',
        PUBLISHED,
    ),
    Mutation(
        "klartext planes: turns about Y are left-handed",
        TILTING,
        '"Y": (2, 0)',
        '"Y": (0, 2)',
        EXAMPLE,
    ),
    Mutation(
        "klartext planes: the third point is on the other side",
        TILTING,
        "np.cross(ahead, aside)",
        "np.cross(aside, ahead)",
        WAYS,
    ),
    Mutation(
        "klartext planes: the first of the angles that go along has the other sense",
        TILTING,
        "math.atan2(xz, -yz)",
        "math.atan2(-xz, -yz)",
        POINT,
    ),
    Mutation(
        "klartext planes: SEQ- is SEQ+",
        TILTING,
        'factor, fit = (1.0 if self.sign == "+" else -1.0), []',
        "factor, fit = 1.0, []",
        EXAMPLE,
    ),
    Mutation(
        "klartext planes: of two attitudes the farther one is taken",
        TILTING,
        "reached[0 if sum(ways) < 0 else 1]",
        "reached[1 if sum(ways) < 0 else 0]",
        EXAMPLE,
    ),
    Mutation(
        "klartext planes: the nearer attitude is nearer all in all",
        TILTING,
        "if not (all(way <= ALIKE for way in ways) or all(way >= -ALIKE for way in ways)):",
        "if False:",
        case("which-way"),
    ),
    Mutation(
        "klartext planes: an attitude is taken beyond the limits",
        TILTING,
        "return turns if all(turns.values()) else {}",
        "return {axis: [angle] for axis, angle in pose.items()}",
        EXAMPLE,
    ),
    Mutation(
        "klartext planes: how far an axis turns need not be known",
        TILTING,
        "if axis.limits is None and axis.wrap is None:",
        "if False:",
        case("two-attitudes"),
    ),
    Mutation(
        "klartext planes: an axis that is free stays, whatever is said",
        TILTING,
        'if level is not None and (self.rot == "TABLE" or same):',
        "if level is not None and same:",
        case("free-axis"),
    ),
    Mutation(
        "klartext planes: an axis that is free stays where nothing is said",
        TILTING,
        "        if not self.rot:\n",
        "        if False:\n",
        case("free-axis-open"),
    ),
    Mutation(
        "klartext planes: B need not be square to N",
        TILTING,
        "if abs(float(x @ z)) > SQUARE:",
        "if False:",
        case("square"),
    ),
    Mutation(
        "klartext planes: a plane that is nearly across an axis is like any other",
        POSES,
        "near = min(tilt, 180.0 - tilt) < NEAR_POLE and len(chain.axes) > 1",
        "near = False",
        case("nearly-free"),
    ),
    Mutation(
        "klartext planes: what may move does before the axes stand",
        PLANES,
        "if moves or RETRACTS in functions or CALLS & functions:",
        "if False:",
        case("moves-before"),
    ),
    Mutation(
        "klartext planes: the axes stand wherever they were turned to",
        PLANES,
        "return not all(abs(math.remainder(each, 360.0)) <= ALIKE for each in away)",
        "return any(each != each for each in away)",
        case("turned-elsewhere"),
    ),
    Mutation(
        "klartext planes: one axis goes into a plane by itself",
        PLANES,
        "        if self.tilt is not None and alone and",
        "        if False and",
        case("one-axis"),
    ),
    Mutation(
        "klartext planes: MOVE leaves X, Y and Z where they are",
        PLANES,
        "        self.loses |= {*LINEAR} if gone else set()\n",
        "",
        case("move"),
    ),
    Mutation(
        "klartext planes: behind a shift that ends in a plane words count again",
        PLANES,
        "self.tilt = replace(self.tilt, why=OPEN)",
        "self.tilt = None",
        case("shift-ended-in"),
    ),
    Mutation(
        "klartext planes: rows of lines are in a plane whose datum is open",
        PLANES,
        'there = self._is_in_plane() and {"X", "Y"} <= self.place.keys()',
        "there = True",
        case("open-in-a-row"),
    ),
    Mutation(
        "klartext planes: a turn to where the axes stand may be written anew",
        PLANES,
        "ends.items() <= self.place.items()",
        "False",
        case("turned-again"),
    ),
    Mutation(
        "klartext planes: the angles by which the axes turn are not looked at",
        "gcxform/modal/frames/planes.py",
        "rotation(spin(turned), 0, 1)",
        "rotation(0.0, 0, 1)",
        POINT,
    ),
)
