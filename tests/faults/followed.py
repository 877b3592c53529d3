"""Faults of `volumetric` where the control follows the tip."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation

PASS = "plugins/gcxform_plugins/passes/volumetric"
FOLLOWED, FORWARD, UNDO = (f"{PASS}/{at}followed.py" for at in ("", "forward/", "undo/"))
UNSAID = "gcxform/modal/frames/unsaid_tips.py"
TESTS = "tests/test_volumetric_followed.py"
WALKED = f"{TESTS}::test_the_tip_stays_on_the_lines_of_the_program"
REFUSED = f"{TESTS}::test_what_is_not_known_is_refused"

MUTATIONS = (
    Mutation(
        "followed: tips are taken for axes",
        FOLLOWED,
        "change = place.axes_of if to_axes else place.tips_of",
        "change = place.tips_of",
        f"{CORPUS}[volumetric/tip-followed]",
    ),
    Mutation(
        "followed: a window begins where the axes are, and not the tip",
        FOLLOWED,
        "if self.rows[0] != 0:",
        "if True:",
        f"{TESTS}::test_windows_know_where_the_tip_was_left",
    ),
    Mutation(
        "followed: between its ends a line is one of the axes",
        FORWARD,
        "point[mine] = axes + self.offset_of(rows[mine])",
        "pass",
        WALKED,
    ),
    Mutation(
        "followed: lines are not cut",
        FORWARD,
        "count = np.asarray(np.maximum(np.nan_to_num(count), 1.0), np.int64)",
        "count = np.ones(len(count), np.int64)",
        WALKED,
    ),
    Mutation(
        "followed: the proof sends axes straight",
        UNDO,
        "point[mine] = self.followed.axes_at(which[mine], part[mine])",
        "pass",
        WALKED,
    ),
    Mutation(
        "followed: a tip that rests is not looked at",
        FORWARD,
        "wrong = moved > PACE",
        "wrong = -moved > PACE",
        f"{CORPUS}[volumetric/tip-followed-rests]",
    ),
    Mutation(
        "followed: arcs go through",
        FOLLOWED,
        "curved = ~np.isin(path.kind[rows], (gx.Kind.LINE, gx.Kind.RAPID))",
        "curved = np.zeros(len(rows), np.bool_)",
        f"{CORPUS}[volumetric/tip-followed-arc]",
    ),
    Mutation(
        "followed: a start that nobody has named goes through",
        FOLLOWED,
        "(last | first).any(axis=1))",
        "last.any(axis=1))",
        REFUSED,
    ),
    Mutation(
        "followed: G43 goes through while the tip is followed",
        "gcxform/modal/frames/tool_lengths.py",
        "if state.following and by_length and",
        "if False and",
        f"{CORPUS}[volumetric/tip-followed-g43]",
    ),
    Mutation(
        "followed: G49 leaves the tip followed",
        "gcxform/modal/frames/tool_lengths.py",
        "following = False if state.following and kept_by_length(asked) else state.following",
        "following = state.following",
        f"{CORPUS}[volumetric/tip-followed-fanuc]",
    ),
    Mutation(
        "followed: codes stay beside a step that turns feeds into others",
        "gcxform/pipeline/chain.py",
        "return len(others) < len(asked) and plain and not turned",
        "return len(others) < len(asked) and not turned",
        f"{TESTS}::test_a_step_that_has_other_positions_leaves_the_codes_refused",
    ),
    Mutation(
        "followed: a work offset that turns axes goes through",
        "plugins/gcxform_plugins/passes/rtcp/place.py",
        "if any(offset.get(letter, 0.0) for letter in letters):",
        "if False:",
        f"{CORPUS}[volumetric/tip-followed-turned-zero]",
    ),
    Mutation(
        "followed: before the first code axes are taken for not followed",
        UNSAID,
        "if memory[TURNED] and lines.state.frames.following is not None:",
        "if memory[TURNED] and lines.state.frames.following:",
        "tests/test_corpus.py::test_windows_make_no_difference[volumetric/tip-followed-unsaid]",
    ),
    Mutation(
        "followed: axes turned in a window before are forgotten",
        UNSAID,
        "if not memory[TURNED] and len(path):",
        "if len(path):",
        "tests/test_corpus.py::test_windows_make_no_difference[volumetric/tip-followed-unsaid]",
    ),
    Mutation(
        "followed: a switch may stand beside a move",
        FOLLOWED,
        "Switches(path, context).refuse_company()",
        "pass",
        f"{CORPUS}[volumetric/tip-followed-beside]",
    ),
    Mutation(
        "followed: axes may leave the table on their way",
        FORWARD,
        "check_points(self.step, self.path, points, rows)",
        "pass",
        f"{CORPUS}[volumetric/tip-followed-beyond]",
    ),
    Mutation(
        "followed: an error that jumps on the way goes through",
        FORWARD,
        "if jumps.any():",
        "if False:",
        f"{CORPUS}[volumetric/tip-followed-border]",
    ),
    Mutation(
        "followed: the certificate looks at ends alone",
        f"{PASS}/volumetric.py",
        "which = np.flatnonzero(followed.turning)",
        "which = np.flatnonzero(followed.turning)[:0]",
        f"{TESTS}::test_the_certificate_says_how_far_the_axes_go_beyond_the_table",
    ),
)
