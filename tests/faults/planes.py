"""Faults of planes in space: where they lead, which attitude is taken, what may be done in them."""

from __future__ import annotations

from faults.mutation import Mutation

PLANES = "gcxform/modal/frames/planes.py"
LOOK = "gcxform/modal/moves/in_planes.py"
POINT = "tests/test_tilted_planes.py::test_a_point_of_a_plane_is_where_quaternions_say[0]"


def case(name: str) -> str:
    return f"tests/test_corpus.py::test_case[dialects/fanuc/tilted-plane-{name}]"


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
        "np.array(plane.zero) - base + gauge, angles) - gauge + base",
        "np.array(plane.zero) - base, angles) + base",
        POINT,
    ),
    Mutation(
        "planes: what is left of the plane is turned the other way",
        PLANES,
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
        "if state is State.POLE and abs(",
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
        "turns |= word[1][lines]",
        "pass",
        case("turns"),
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
        "planes: the axes do not turn where their code is not written",
        "gcxform/modal/moves/home.py",
        "form = Form.PLAIN if track.lines.reading.turns_plainly else Form.MACHINE",
        "form = Form.MACHINE",
        case("folded"),
    ),
    Mutation(
        "planes: G69 leaves one where it is",
        "gcxform/modal/frames/transforms.py",
        'return replace(state, tilt="", plane=None)',
        'return replace(state, tilt="")',
        case("folded"),
    ),
    Mutation(
        "planes: other controls take the attitudes of a Fanuc",
        "plugins/gcxform_plugins/dialects/controls/industrial.py",
        "NO_PLANES = replace(Fanuc.tip_rule, planes={})",
        "NO_PLANES = Fanuc.tip_rule",
        "tests/test_corpus.py::test_case[dialects/controls/mazak-plane]",
    ),
)
