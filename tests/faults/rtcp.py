"""Faults of the pass `rtcp`: what is added to positions, the bound, rounding, times."""

from __future__ import annotations

from faults.mutation import PASSES, Mutation

TESTS = "tests/test_rtcp.py"
BOUND = f"{PASSES}/rtcp_bound.py"
CUTTING = f"{PASSES}/rtcp_cutting.py"
PLACE = f"{PASSES}/rtcp_place.py"
UNDOING = f"{PASSES}/rtcp_undoing.py"
SMALL = f"{PASSES}/rtcp_small.py"
WAYS = f"{PASSES}/rtcp_ways.py"
REPOST = "tests/test_rtcp_repost.py"
RETARGET = "tests/test_rtcp_retarget.py"
CHOICE = f"{PASSES}/rtcp_choice.py"
MOVING = f"{PASSES}/rtcp_moving.py"
PROOF = f"{PASSES}/rtcp_proof.py"
SWITCHES = f"{PASSES}/rtcp_switches.py"
DRIVEN = f"{PASSES}/rtcp_driven.py"
RETRACTED = f"{PASSES}/rtcp_retracted.py"
RETRACTING = f"{PASSES}/rtcp_retracting.py"
DRAWN = "tests/test_rtcp_retract.py"
CHOOSING = "tests/test_rtcp_choice.py"
HOLDS = f"{TESTS}::test_the_bound_holds_for_any_piece"

MUTATIONS = (
    Mutation(
        "rtcp: the tool is added where it is taken away",
        PLACE,
        "return chain.linear(points + self.gauge - self._tool(chain), turned)",
        "return chain.linear(points + self.gauge + self._tool(chain), turned)",
        f"{TESTS}::test_rounded_angles_are_made_good",
    ),
    Mutation(
        "rtcp: the work offset is forgotten on the way back",
        PLACE,
        "angles[here]) - self.zero",
        "angles[here])",
        f"{TESTS}::test_rounded_angles_are_made_good",
    ),
    Mutation(
        "rtcp: the bound does not know that a point moves while it is turned",
        BOUND,
        "self.bend += 2.0 * w[:, None] * np.cross(d, speed) + bend",
        "self.bend += bend",
        HOLDS,
    ),
    Mutation(
        "rtcp: the bound of the middle holds for the whole piece",
        BOUND,
        "bend + (tip.twisted + arm.twisted) / 2.0",
        "bend + 0.0 * (tip.twisted + arm.twisted)",
        HOLDS,
    ),
    Mutation(
        "rtcp: X, Y and Z are computed from angles that are not rounded",
        CUTTING,
        "rounded[:, column] = np.round(positions[:, column], decimals)",
        "rounded[:, column] = np.round(positions[:, column], decimals + 4)",
        f"{TESTS}::test_rotary_decimals_of_their_own",
    ),
    Mutation(
        "rtcp: each piece takes the time of the whole",
        CUTTING,
        "feed = feed[row] * np.where(inverse[row], pieces[row], 1.0)",
        "feed = feed[row]",
        f"{TESTS}::test_the_time_is_that_of_the_tip",
    ),
    Mutation(
        "rtcp: limits are those of words, not of the machine",
        CUTTING,
        "axes = axes + place.zero",
        "axes = axes + 0.0 * place.zero",
        f"{TESTS}::test_limits_are_those_of_the_machine",
    ),
    Mutation(
        "rtcp: the head does not bend the way of the tip that is undone",
        UNDOING,
        "return np.asarray(table**2 * far + 2.0 * table * way + head**2 * arm)",
        "return np.asarray(table**2 * far + 2.0 * table * way)",
        f"{TESTS}::test_undone_pieces_stay_beside_the_curve",
    ),
    Mutation(
        "rtcp: the table does not bend the way of the tip that is undone",
        UNDOING,
        "return np.asarray(table**2 * far + 2.0 * table * way + head**2 * arm)",
        "return np.asarray(2.0 * table * way + head**2 * arm)",
        f"{TESTS}::test_undone_pieces_stay_beside_the_curve",
    ),
    Mutation(
        "rtcp: a point beside the axis is corrected in proportion",
        SMALL,
        "second * far + 2.0 * first * fast + size * bent + step**2 * aside,",
        "second * far + 2.0 * first * fast + size * bent,",
        f"{REPOST}::test_the_bound_of_corrections_holds",
    ),
    Mutation(
        "rtcp: an axis that leans is corrected in proportion",
        SMALL,
        "size, first, second = 2.0 * lean, step * lean, 2.0 * step**2 * lean",
        "size, first, second = 2.0 * lean, step * lean, 0.0 * step**2 * lean",
        f"{REPOST}::test_the_bound_of_an_axis_that_leans",
    ),
    Mutation(
        "rtcp: a program is corrected for the machine that it was posted for",
        WAYS,
        "return self.axes.axes_of(tips, angles, rows)",
        "return self.nominal.axes_of(tips, angles, rows)",
        f"{REPOST}::test_reposted_before_rounding",
    ),
    Mutation(
        "rtcp: the tool axis that stays off is that of one machine",
        f"{PASSES}/rtcp.py",
        "for p in (way.nominal, way.axes))",
        "for p in (way.nominal, way.nominal))",
        f"{REPOST}::test_reposted_before_rounding",
    ),
    Mutation(
        "rtcp: what is undone bends as if the tip went straight",
        UNDOING,
        "return np.asarray(turns**2 * far + 2.0 * turns * way + 2.0 * head**2 * arm)",
        "return np.asarray(0.0 * turns * way)",
        f"{REPOST}::test_undone_pieces_stay_beside_the_curve",
    ),
    Mutation(
        "rtcp: the way to a candidate is the one to the nearest before it",
        CHOICE,
        "cost = before.cost[:, None] + way.sum(axis=-1)",
        "cost = 0.0 * before.cost[:, None] + way.sum(axis=-1)",
        f"{CHOOSING}::test_no_way_is_cheaper",
    ),
    Mutation(
        "rtcp: axes may leap inside a cut",
        CHOICE,
        "cost = np.where(way.max(axis=-1, initial=0.0) > LEAP, np.inf, cost)",
        "cost = np.where(way.max(axis=-1, initial=0.0) > 8 * LEAP, np.inf, cost)",
        f"{CHOOSING}::test_a_long_sweep_begins_at_the_right_turn",
    ),
    Mutation(
        "rtcp: at the pole the free angle is any",
        CHOICE,
        "own[:, free] = np.tile(held, len(own) // len(held))",
        "own[:, free] = 0.0",
        f"{CHOOSING}::test_before_a_cut_the_free_axis_is_where_the_cut_needs_it",
    ),
    Mutation(
        "rtcp: angles are corrected fully up to the largest turn, and above it",
        MOVING,
        "share = np.clip(2.0 - 2.0 * turn / largest, 0.0, 1.0)[:, None]",
        "share = np.clip(2.0 - 0.0 * turn / largest, 0.0, 1.0)[:, None]",
        f"{REPOST}::test_no_angle_is_corrected_by_more_than_asked",
    ),
    Mutation(
        "rtcp: the proof takes the tip of the source for both",
        PROOF,
        "off = np.linalg.norm(found[0][0] - found[1][0], axis=1) + slack",
        "off = np.linalg.norm(found[0][0] - found[0][0], axis=1) + slack",
        f"{CHOOSING}::test_the_proof_sees_what_is_wrong",
    ),
    Mutation(
        "rtcp: the proof does not look at the tool axis",
        PROOF,
        "self.lean = max(self.lean, float(np.degrees((lean + slack).max())))",
        "self.lean = max(self.lean, 0.0 * float(np.degrees((lean + slack).max())))",
        f"{RETARGET}::test_a_program_for_another_machine",
    ),
    Mutation(
        "rtcp: a slip between axes does not bend",
        SMALL,
        "second * far + 2.0 * first * fast + size * bent,",
        "0.0 * far,",
        f"{RETARGET}::test_the_bound_holds_with_slips",
    ),
    Mutation(
        "rtcp: the tool axis goes evenly between its ends, and not on the circle",
        f"{PASSES}/rtcp_circling.py",
        "left = np.where(short, 1.0 - part, np.sin((1.0 - part) * angle) / whole)",
        "left = np.where(short, 1.0 - part, 1.0 - part)",
        f"{CHOOSING}::test_blocks_of_a_great_circle",
    ),
    Mutation(
        "rtcp: the proof lets the tool axis stand still",
        DRIVEN,
        "axis = np.cos(angle)[:, None] * one + np.sin(angle)[:, None] * np.cross(pole, one)",
        "axis = np.cos(angle)[:, None] * one + 0.0 * np.cross(pole, one)",
        f"{CHOOSING}::test_blocks_of_a_great_circle",
    ),
    Mutation(
        "rtcp: the top speed of one axis counts for all",
        CUTTING,
        "least = np.maximum(least, way / axis.max_speed)",
        "least = way / axis.max_speed",
        f"{TESTS}::test_no_axis_is_faster_than_it_can_be",
    ),
    Mutation(
        "feeds: a move may be late without an axis at full speed",
        "gcxform/feedproof.py",
        "return np.asarray(timed & (least * written.feed >= 1.0 - TIME_ERROR))",
        "return np.asarray(timed & (least * written.feed >= 0.0))",
        f"{TESTS}::test_a_late_move_has_to_have_a_reason",
    ),
    Mutation(
        "rtcp: comments lose their codes",
        "gcxform/tipcodes.py",
        'if found[0].startswith(b"("):',
        "if False:",
        "tests/test_tipcodes.py",
    ),
    Mutation(
        "rtcp: the control may begin with axes turned",
        f"{PASSES}/rtcp_place.py",
        "(self.which != self.which_before) & turned_at(self.angles(self.path.start))",
        "np.zeros(len(self.which), np.bool_)",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "rtcp: axes may be turned before the control follows",
        f"{PASSES}/rtcp_place.py",
        "bare[self.which] & turned_at(self.angles(self.path.end))",
        "np.zeros(len(self.which), np.bool_)",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "rtcp: axes may be turned while the control is off",
        SWITCHES,
        "yield from self._rows((self.state == OFF) & moves, message)",
        "yield from self._rows((self.state == OFF) & (not moves.size), message)",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: axes may be turned while it is not known what is on",
        SWITCHES,
        "yield from self._rows((self.state == UNKNOWN) & moves, message)",
        "yield from self._rows((self.state == UNKNOWN) & (not moves.size), message)",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: only where moves end is looked at for turned axes",
        SWITCHES,
        "turns[1:] | turns[:-1]",
        "turns[:-1]",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: an axis may be anywhere where the control is switched",
        SWITCHES,
        "event.what in self.codes and not rest[event.row]",
        "event.what in self.codes and not rest.any()",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: it is not seen that a position was lost before a switch",
        SWITCHES,
        "(self.state != self.before) & ~rest[:-1]",
        "(self.state != self.before) & (self.state < 0)",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: a move may stand beside a switch",
        SWITCHES,
        "lines[np.isin(lines, self.path.source)]",
        "lines[:0]",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: on is off",
        "gcxform/modal/lengths.py",
        "return replace(state, following=True)",
        "return replace(state, following=False)",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: once on, the control stays on",
        "gcxform/modal/lengths.py",
        "return replace(state, following=False)",
        "return state",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: a frame does not say what follows the tip",
        "gcxform/modal/frames.py",
        "            self.following,\n",
        "            None,\n",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: offsets forget what follows the tip",
        f"{PASSES}/offsets.py",
        "following=frame.following",
        "following=None",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: codes of what rtcp does are copied",
        "gcxform/emit/copying.py",
        'self.lines &= ~self.task.table.flag("switches", self.task.shape)',
        "self.lines &= True",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: a skipped block keeps its code",
        "gcxform/emit/copying.py",
        'skipped & self.task.table.flag("switches", shape)',
        "skipped & ~skipped",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: one code may say both",
        "gcxform/machine/machinefile.py",
        "len(set(given.values())) == 1",
        "len(given) == 1",
        "tests/test_tip_switches.py",
    ),
    Mutation(
        "rtcp: drawing the tool back costs no more than the turn",
        CHOICE,
        "np.where(same, 0.0, RETRACT + way)",
        "np.where(same, 0.0, 0.0 * RETRACT + way)",
        f"{DRAWN}::test_a_long_turn_before_the_cut_is_better",
    ),
    Mutation(
        "rtcp: the tool is drawn back anywhere",
        CHOICE,
        "self.may = self.may & cut &",
        "self.may = cut &",
        f"{DRAWN}::test_as_late_or_soon_as_it_may_but_not_more_often",
    ),
    Mutation(
        "rtcp: pieces begin as the ones before the tool was drawn back end",
        MOVING,
        "np.searchsorted(self.retracts, row + part + (NEAR if after else -NEAR))",
        "np.searchsorted(self.retracts, row + part - NEAR)",
        f"{DRAWN}::test_the_tool_is_drawn_back_where_axes_must_turn",
    ),
    Mutation(
        "rtcp: no piece ends where the tool is drawn back",
        CUTTING,
        "pieces[rows] = np.ceil(most / self.least[rows]) * self.least[rows]",
        "pieces[rows] = most",
        f"{DRAWN}::test_the_tool_is_drawn_back_where_axes_must_turn",
    ),
    Mutation(
        "rtcp: the tool is drawn back along Z of the workpiece",
        RETRACTING,
        "tip = tip + length * target.chain.tool_axis(angles)",
        "tip = tip + length * np.array([0.0, 0.0, 1.0])",
        f"{DRAWN}::test_the_tool_is_drawn_back_where_axes_must_turn",
    ),
    Mutation(
        "rtcp: the tip is nowhere while axes turn",
        RETRACTING,
        "limit, count, worst = HELD * work.step.retract, 1, np.inf",
        "limit, count, worst = 9.0 * work.step.retract, 1, np.inf",
        f"{DRAWN}::test_the_tool_is_drawn_back_where_axes_must_turn",
    ),
    Mutation(
        "rtcp: the proof lets the tip go where it likes while axes turn",
        RETRACTED,
        "return bool((off <= limit).all())",
        "return bool((off <= 9.0 * limit).all())",
        f"{DRAWN}::test_the_proof_takes_nothing_else",
    ),
    Mutation(
        "rtcp: the proof does not look how far the tool is drawn back",
        RETRACTED,
        "(off <= SAME).all()",
        "(off <= 1.0).all()",
        f"{DRAWN}::test_the_proof_takes_nothing_else",
    ),
    Mutation(
        "rtcp: the tool may go in with another axis",
        RETRACTED,
        "and lean <= self.lean",
        "and lean <= 1.0",
        f"{DRAWN}::test_the_tool_goes_in_with_the_axis_it_had",
    ),
    Mutation(
        "rtcp: axes may turn to and fro where the tool is drawn back",
        RETRACTED,
        "(steady <= SAME).all()",
        "(steady <= 1.0).all()",
        f"{DRAWN}::test_axes_do_not_turn_to_and_fro",
    ),
    Mutation(
        "rtcp: moves that draw the tool back have any feed",
        RETRACTED,
        "(np.abs(time * self.feed / way - 1.0) <= SAME_TIME).all()",
        "(np.abs(time * self.feed / way - 1.0) <= 1.0).all()",
        f"{DRAWN}::test_the_proof_takes_nothing_else",
    ),
    Mutation(
        "rtcp: the tool is drawn back in a line of its own",
        RETRACTED,
        "(owner != owner[-1]).any()",
        "(owner[1:] != owner[-1]).any()",
        f"{DRAWN}::test_the_proof_wants_it_whole_and_in_a_line",
    ),
    Mutation(
        "what passes add is that of the last window",
        "gcxform/run.py",
        "self.added[what] = self.added.get(what, 0) + number",
        "self.added[what] = number",
        f"{DRAWN}::test_several_cuts_are_counted_together",
    ),
)
