"""Faults of planes in space and of followed tips: where they lead, and what may be done in them."""

from __future__ import annotations

from faults.mutation import Mutation

PLANES = "gcxform/modal/frames/planes.py"
POSES = "gcxform/machine/tilting.py"
TIPS = "gcxform/modal/frames/followed_tips.py"
LOOK = "gcxform/modal/moves/in_planes.py"
POINT = "tests/test_tilted_planes.py::test_a_point_of_a_plane_is_where_quaternions_say[0]"
TIP = "tests/test_tilted_planes.py::test_a_tip_is_where_quaternions_say[0-workpiece]"


def case(name: str) -> str:
    return f"tests/test_corpus.py::test_case[dialects/fanuc/tilted-plane-{name}]"


def tip(name: str) -> str:
    return f"tests/test_corpus.py::test_case[dialects/fanuc/followed-tip-{name}]"


SWIVELS = "plugins/gcxform_plugins/dialects/siemens/swivelling.py"
SWIVELLED = "tests/test_swivelled_tables.py::test_a_point_of_a_plane_is_where_quaternions_say[1]"


def swivel(name: str) -> str:
    return f"tests/test_corpus.py::test_case[dialects/siemens/swivelled-{name}]"


MUTATIONS = (
    Mutation(
        "planes: the angles are turned in the other order",
        PLANES,
        "matrix_of(about_z @ about_x @ again)",
        "matrix_of(again @ about_x @ about_z)",
        POINT,
    ),
    Mutation(
        "planes: the second angle turns the other way",
        PLANES,
        "rotation(j, 1, 2)",
        "rotation(-j, 1, 2)",
        POINT,
    ),
    Mutation(
        "planes: the gauge point is where the axes are",
        PLANES,
        "zero - base + gauge, angles) - gauge + base",
        "zero - base, angles) + base",
        POINT,
    ),
    Mutation(
        "planes: what is left of the plane is turned the other way",
        POSES,
        "np.arctan2(turned[1, 0], turned[0, 0])",
        "np.arctan2(-turned[1, 0], turned[0, 0])",
        POINT,
    ),
    Mutation(
        "planes: the axis farther from the base decides between attitudes",
        PLANES,
        "(*ways.T, *from_zero.T)",
        "(*ways.T[::-1], *from_zero.T)",
        case("attitude"),
    ),
    Mutation(
        "planes: the attitude nearest to 0 is taken, from wherever the axes stand",
        PLANES,
        "(*ways.T, *from_zero.T)",
        "(*from_zero.T,)",
        case("attitude"),
    ),
    Mutation(
        "planes: an axis that is free turns with the coordinates",
        PLANES,
        "if free is not None and abs(",
        "if False and abs(",
        case("free-axis"),
    ),
    Mutation(
        "planes: an axis turns as far as it likes",
        PLANES,
        "if axis.limits is None and axis.wrap is None:",
        "if False:",
        case("unlimited"),
    ),
    Mutation(
        "planes: a work offset is changed in one",
        PLANES,
        "name not in IN_PLANE",
        "False",
        case("in-another-offset"),
    ),
    Mutation(
        "planes: words lead into it before the tool stands on it",
        LOOK,
        "if not plane.angles:",
        "if False:",
        case("between"),
    ),
    Mutation(
        "planes: an axis turns in one",
        LOOK,
        "(~stays | self.own[lines])",
        "False",
        case("turns"),
    ),
    Mutation(
        "planes: an axis that is named turns, also where it stands there already",
        LOOK,
        "(~stays | self.own[lines])",
        "True",
        tip("compensated"),
    ),
    Mutation(
        "planes: the words of a block that sets a length are no move in one",
        LOOK,
        "acts and self._acts(first, WORDED)",
        "acts and not self.own[first]",
        case("beside-a-length"),
    ),
    Mutation(
        "planes: an axis stands where it stood behind a code that may turn it",
        LOOK,
        "lost = np.flatnonzero(self.lost[first:last])",
        "lost = np.flatnonzero(self.lost[:0])",
        case("lost"),
    ),
    Mutation(
        "planes: their angles are lengths",
        "plugins/gcxform_plugins/passes/metric.py",
        "if event.what in dialect.tip_rule.unfollowed:",
        "if False:",
        case("angles"),
    ),
    Mutation(
        "planes: their zero is no length",
        "plugins/gcxform_plugins/passes/metric.py",
        'OF_PLANES = frozenset("XYZ")',
        "OF_PLANES = frozenset[str]()",
        case("inches"),
    ),
    Mutation(
        "planes: a length may move Z alone before the tool stands on one",
        "gcxform/modal/frames/track.py",
        "4 if plane is None or plane.angles else SPATIAL",
        "4",
        case("length-x-alone"),
    ),
    Mutation(
        "planes: Z stands where another length would move it to in one",
        "gcxform/modal/frames/track.py",
        "self.frame.matrix is not None or self.state.frames.plane is not None",
        "False",
        case("length-moves"),
    ),
    Mutation(
        "planes: an axis that no turn mixes with others is as lost as those",
        "plugins/gcxform_plugins/passes/offsets.py",
        "np.isnan(path.start))[:, :3] & counts",
        "np.isnan(path.start))[:, :3]",
        case("length-before"),
    ),
    Mutation(
        "planes: no axis is made of words of others",
        "plugins/gcxform_plugins/passes/offsets.py",
        "bool(mixes) for mixes",
        "False for mixes",
        "tests/test_corpus.py::test_case[offsets/fanuc-g68-one-axis]",
    ),
    Mutation(
        "planes: the axes do not turn where their code is not written",
        "gcxform/modal/moves/home.py",
        "form = Form.PLAIN if track.lines.reading.turns_plainly else Form.MACHINE",
        "form = Form.MACHINE",
        case("folded"),
    ),
    Mutation(
        "planes: G69 leaves one where it is",
        "gcxform/modal/frames/transforms.py",
        'return replace(state, tilt="", plane=followed)',
        'return replace(state, tilt="")',
        case("folded"),
    ),
    Mutation(
        "tips: G69 ends one",
        "gcxform/modal/frames/transforms.py",
        'return replace(state, tilt="", plane=followed)',
        'return replace(state, tilt="", plane=None)',
        tip("compensated"),
    ),
    Mutation(
        "tips: G49 ends none",
        "gcxform/modal/frames/tool_lengths.py",
        "plane = None if followed else state.plane",
        "plane = state.plane",
        tip("begins"),
    ),
    Mutation(
        "tips: the table does not turn their words",
        TIPS,
        "matrix_of(carried(chain, np.eye(3), angles))",
        "matrix_of(np.eye(3))",
        TIP,
    ),
    Mutation(
        "tips: the table does not take their zero along",
        TIPS,
        "place = zero_carried(chain, state, zero, angles)",
        "place = vector_of(zero)",
        TIP,
    ),
    Mutation(
        "tips: they are of the workpiece, whatever the control does",
        TIPS,
        "if turned and said is None:",
        "if False:",
        tip("not-said"),
    ),
    Mutation(
        "tips: words of a turned tip may be those of the machine",
        TIPS,
        "if asked.reading.turns_plainly and not asked.reading.crosses:",
        "if False:",
        tip("folded"),
    ),
    Mutation(
        "tips: another control has the code that follows them",
        "gcxform/pipeline/plan.py",
        "self.source.tip_rule.codes if folds and self.source is not self.target else {}",
        "{}",
        "tests/test_corpus.py::test_case[dialects/across/followed-tip]",
    ),
    Mutation(
        "tips: their words are those of another control, whatever folds them",
        "gcxform/pipeline/plan.py",
        "self.source.tip_rule.codes if folds and",
        "self.source.tip_rule.codes if",
        "tests/test_corpus.py::test_case[dialects/across/followed-tip-offered]",
    ),
    Mutation(
        "tips: X, Y and Z stand where they stood when one begins",
        "gcxform/modal/frames/track.py",
        "SPATIAL * (before.plane is not frames.plane)",
        "0",
        tip("begins"),
    ),
    Mutation(
        "tips: the table stands where it stood behind a tool change",
        LOOK,
        "elif not said & ORIENTING:",
        "elif not said:",
        tip("lost"),
    ),
    Mutation(
        "tips: other zeros and lengths may come while one is followed",
        PLANES,
        "name not in WITH_TIP",
        "False",
        tip("busy"),
    ),
    Mutation(
        "planes: other controls take the attitudes of a Fanuc",
        "plugins/gcxform_plugins/dialects/controls/industrial.py",
        'TIPS = replace(NO_PLANES, planes={"G43.4": "follow-tip"})',
        "TIPS = Fanuc.tip_rule",
        "tests/test_corpus.py::test_case[dialects/controls/mazak-plane]",
    ),
    Mutation(
        "swivels: the higher value is the lower one",
        PLANES,
        "values = angles[:, column] * way",
        "values = angles[:, column] * -way",
        swivel("compensated"),
    ),
    Mutation(
        "swivels: of an axis that turns without end one value is the lowest",
        PLANES,
        "apart[column] |= chain.axes[column].limits is None",
        "pass",
        swivel("without-ends"),
    ),
    Mutation(
        "swivels: by the first axis, where nobody says",
        PLANES,
        "if by not in chain.letters:",
        "by = by or chain.letters[0]\n    if by not in chain.letters:",
        swivel("by-which-axis"),
    ),
    Mutation(
        "swivels: an axis that is free stays",
        PLANES,
        "angles, free = _possible(chain, tilted, standing, asked)\n    if free is not None:",
        "angles, free = _possible(chain, tilted, standing, asked)\n    if False:",
        swivel("free"),
    ),
    Mutation(
        "swivels: axes that are not told to turn stand right",
        PLANES,
        "stands = np.abs(angles - standing).max(axis=1) <= EQUAL",
        "stands = np.abs(angles - standing).max(axis=1) >= 0",
        swivel("not-at-all"),
    ),
    Mutation(
        "swivels: turns are about axes that stand",
        SWIVELS,
        "frame @= about(axis, angle)",
        "frame = about(axis, angle) @ frame",
        SWIVELLED,
    ),
    Mutation(
        "swivels: what shifts behind the turns shifts before them",
        SWIVELS,
        "zero = frame.point(behind)",
        "zero = Frame(shift=frame.shift).point(behind)",
        SWIVELLED,
    ),
    Mutation(
        "swivels: the first angle of Euler is half a turn off",
        SWIVELS,
        "math.atan2(rows[0][2], -rows[1][2])",
        "math.atan2(-rows[0][2], rows[1][2])",
        SWIVELLED,
    ),
    Mutation(
        "swivels: a plane upon another is a new one",
        SWIVELS,
        "values[2] not in NEW or ",
        "",
        swivel("upon-another"),
    ),
    Mutation(
        "swivels: a frame of the program stays",
        SWIVELS,
        "if apart or self.frame != Frame():",
        "if apart:",
        swivel("in-a-frame"),
    ),
    Mutation(
        "swivels: behind a plane X, Y and Z are where they were in it",
        SWIVELS,
        "self.swivelled = False\n            self._lose_all()",
        "self.swivelled = False",
        swivel("and-left"),
    ),
    Mutation(
        "swivels: MCALL of one is one",
        "plugins/gcxform_plugins/dialects/siemens/cycle_calls.py",
        "elif line.modal is not None:",
        "elif False:",
        swivel("under-mcall"),
    ),
    Mutation(
        "swivels: the motion behind one is rapid",
        SWIVELS,
        'self.said, self.said_steps, self.swivelled = "", False, True',
        "self.said_steps, self.swivelled = False, True",
        "tests/test_swivelled_tables.py::test_a_feed_move_behind_is_one",
    ),
    Mutation(
        "swivels: a plane may stay where none shall",
        "plugins/gcxform_plugins/dialects/siemens/effects.py",
        "|CYCLE800[ \\t]*\\([ \\t]*[^) \\t])",
        ")",
        swivel("folded"),
    ),
    Mutation(
        "planes: a way back goes with the call that asks for it",
        SWIVELS,
        "if moves and goes:",
        "if False:",
        swivel("folded-drawn-back"),
    ),
    Mutation(
        "planes: behind a way back it is known where the tool stands",
        SWIVELS,
        "            if moves:",
        "            if not moves:",
        swivel("and-drawn-back"),
    ),
    Mutation(
        "planes: where _DIR leads hangs on where the axes stand",
        PLANES,
        'open_ = bool(asked.written.get("P"))',
        "open_ = False",
        swivel("again"),
    ),
    Mutation(
        "planes: the table that turns is the first move in a plane",
        "plugins/gcxform_plugins/passes/offsets.py",
        "moved = ~_turns_alone(path)",
        "moved = path.kind >= 0",
        swivel("folded-again"),
    ),
)
