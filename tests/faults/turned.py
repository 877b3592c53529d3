"""Faults of `volumetric` under a turned head: where the tip is, and how far it goes along arcs."""

from __future__ import annotations

from faults.mutation import CORPUS, RIGID, Mutation

TURNED = "tests/test_turned_head.py"
TIP = f"{TURNED}::test_the_tip_of_the_exact_machine_under_a_turning_head"
UNDO = f"{TURNED}::test_the_undo_is_as_near_to_the_curve_as_it_says"
BENT = f"{TURNED}::test_where_only_the_head_bends_the_error"
BOUND = f"{RIGID}::test_no_turn_is_above_its_bound"
LEVERS = "plugins/gcxform_plugins/passes/volumetric/levers.py"
SWINGING = "plugins/gcxform_plugins/passes/volumetric/forward/turning_head.py"
UNDOING = "plugins/gcxform_plugins/passes/volumetric/undo/machine.py"
RETRACING = "plugins/gcxform_plugins/passes/volumetric/undo/commands.py"
SPLITTING = "plugins/gcxform_plugins/passes/volumetric/forward/lines.py"
COMPENSATION = "plugins/gcxform_plugins/passes/volumetric/forward/compensation.py"


def _fault(name: str, file: str, old: str, new: str, tests: str = TIP) -> Mutation:
    return Mutation(f"turned head: {name}", file, old, new, tests)


MUTATIONS = (
    _fault(
        "the tip is turned the other way",
        LEVERS,
        "axis.turn(points, angles[:, k])",
        "axis.turn(points, -angles[:, k])",
    ),
    _fault(
        "the axes are in the wrong order",
        LEVERS,
        "in reversed([*enumerate(self.head)]):",
        "in [*enumerate(self.head)]:",
    ),
    _fault(
        "the axes go through the gauge point", LEVERS, "points = held + self.gauge", "points = held"
    ),
    _fault(
        "between the ends it is that of the end",
        LEVERS,
        "begin + share * (stop - begin)",
        "stop + share * (stop - begin)",
    ),
    _fault(
        "a work offset does not turn the head",
        LEVERS,
        "+ offset.get(letter, 0.0)",
        "+ 0.0 * offset.get(letter, 0.0)",
        f"{TURNED}::test_a_work_offset_turns_the_head_as_well",
    ),
    _fault(
        "the tool before the window is that of its end",
        "plugins/gcxform_plugins/passes/volumetric/place.py",
        "return self.lever.starts[:1]",
        "return self.lever.ends[:1]",
        "tests/test_corpus.py::test_windows_make_no_difference[rtcp/volumetric-turned-head]",
    ),
    _fault("the bend is a tenth", SWINGING, "8.0 * _sags(", "0.8 * _sags(", BENT),
    _fault(
        "cuts have the tool of the end",
        COMPENSATION,
        "self.command(target[inner], row[inner], part[inner])",
        "self.command(target[inner], row[inner])",
    ),
    _fault(
        "what a straight way is off is found with the tool of the end",
        SPLITTING,
        "exact = window.command(start + part[:, None] * way, row, part)",
        "exact = window.command(start + part[:, None] * way, row)",
    ),
    _fault(
        "no pace is too fast",
        COMPENSATION,
        "self.swing.turning & (moved",
        "False & (moved",
        f"{CORPUS}[rtcp/gx316-pace]",
    ),
    _fault(
        "the undo has the tool of the end",
        UNDOING,
        "self.place.tool_of(every, at)",
        "self.place.tool_of(every)",
    ),
    _fault(
        "pieces of the undo are ten times as long",
        UNDOING,
        "self.angle * turn**2 * long",
        "0.01 * self.angle * turn**2 * long",
        UNDO,
    ),
    _fault(
        "pieces of the undo of the inverse are as long as moves",
        RETRACING,
        "sag += arm.sag(",
        "sag += 0.0 * arm.sag(",
        UNDO,
    ),
    _fault(
        "the turns of one axis alone are bounded",
        "gcxform/errormodel/rigid.py",
        "angle += float(",
        "angle = float(",
        BOUND,
    ),
    _fault(
        "beyond a lattice its turns are those of the border",
        "gcxform/errormodel/lattice.py",
        "before = rows[:1] + cells *",
        "before = rows[:1] + 0.0 * cells *",
        BOUND,
    ),
    _fault(
        "turns alone take any time",
        "gcxform/proof/feeds.py",
        "off = np.where(turns, self._uneven(self._turned()), off)",
        "pass",
        f"{TURNED}::test_turns_alone_share_their_time_by_angles",
    ),
    _fault(
        "tips are taken for axes",
        "plugins/gcxform_plugins/passes/volumetric/volumetric.py",
        "requires = frozenset({gx.NOMINAL, gx.AXIS_POSITIONS})",
        "requires = frozenset({gx.NOMINAL})",
        "tests/test_rtcp_volumetric.py",
    ),
)
