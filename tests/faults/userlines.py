"""Faults of the user's lines where `rtcp` draws the tool back: what is taken, moved, proved."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_rtcp_lines.py"
LINES = "plugins/gcxform_plugins/passes/rtcp/user_lines.py"
MOVES = "plugins/gcxform_plugins/passes/rtcp/forward/retracting.py"
RETRACTED = "plugins/gcxform_plugins/passes/rtcp/proof/retracted.py"
PROOF = "plugins/gcxform_plugins/passes/rtcp/proof/proof.py"
STANDS = f"{TESTS}::test_lines_stand_where_they_should_and_the_tool_comes_back"
FOLLOWS = f"{TESTS}::test_the_proof_follows_every_move"
PLACES = f"{TESTS}::test_the_proof_wants_each_block_once_and_in_its_place"
HAPPENS = f"{TESTS}::test_the_proof_wants_what_happens_in_them_and_nothing_else"
OFFSET = f"{TESTS}::test_the_work_offset_is_that_of_the_target"
REFUSED = f"{TESTS}::test_a_line_is_refused_by_name"
TEXT = f"{TESTS}::test_a_text_with_other_lines_is_not_written"

MUTATIONS = (
    Mutation(
        "lines: a place of the machine is one of the work offset",
        MOVES,
        'end["XYZ".index(axis)] = value - zero["XYZ".index(axis)]',
        'end["XYZ".index(axis)] = value',
        STANDS,
    ),
    Mutation(
        "lines: axes come back as they have gone",
        LINES,
        "*reversed(moved)):",
        "*moved):",
        STANDS,
    ),
    Mutation(
        "lines: axes that no line moves come back last",
        LINES,
        'for axes in ("".join(a for a in left if a not in "".join(moved)), *reversed(moved)):',
        'for axes in (*reversed(moved), "".join(a for a in left if a not in "".join(moved))):',
        STANDS,
    ),
    Mutation(
        "lines: the tool comes back to where it cuts, and not to over it",
        MOVES,
        "place[:3] = self.brought(tip, target.angles(place[None, :]))",
        "pass",
        STANDS,
    ),
    Mutation(
        "lines: the output is read with the work offset of the other machine",
        "gcxform/pipeline/plan.py",
        "reading = replace(reading, work_offsets=offsets, homes=homes)",
        "reading = replace(reading, homes=homes)",
        OFFSET,
    ),
    Mutation(
        "lines: places of the machine are the same on any target",
        "plugins/gcxform_plugins/passes/rtcp/forward/moving.py",
        "return homes or bool((self.place.zero != self.target.zero).any())",
        "return homes",
        OFFSET,
    ),
    Mutation(
        "lines: the spindle may be stopped",
        LINES,
        'group == "coolant" or',
        'group in ("coolant", "spindle") or',
        REFUSED,
    ),
    Mutation(
        "lines: a place may be reached as the cut is",
        LINES,
        '_check("G0" in codes,',
        '_check("G53" in codes,',
        REFUSED,
    ),
    Mutation(
        "lines: any place is one of the machine",
        LINES,
        '_check("G53" in codes,',
        '_check("G0" in codes,',
        REFUSED,
    ),
    Mutation(
        "lines: a code is inert if one machine file says so",
        "plugins/gcxform_plugins/passes/rtcp/retarget.py",
        "inert = context.machine.inert_m & self.target.machine.inert_m",
        "inert = context.machine.inert_m | self.target.machine.inert_m",
        f"{TESTS}::test_inert_codes_are_those_of_both_machines",
    ),
    Mutation(
        "lines: inches are taken for mm",
        "plugins/gcxform_plugins/passes/rtcp/forward/moving.py",
        "if self.options.retraction is not None and self.options.retraction.lines.in_mm:",
        "if self.options.retraction is None:",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "lines: the proof does not look where G53 goes",
        RETRACTED,
        "if not abs(here[k] + self.target.place.zero[k] - wanted) <= SAME:",
        "if not abs(here[k] + self.target.place.zero[k] - wanted) <= 1.0:",
        FOLLOWS,
    ),
    Mutation(
        "lines: the proof lets X, Y and Z go while axes turn at a place of the machine",
        RETRACTED,
        "(np.abs(self.step[rows]) <= SAME).all()",
        "(np.abs(self.step[rows]) <= 1.0).all()",
        FOLLOWS,
    ),
    Mutation(
        "lines: the proof lets the tool go in from elsewhere",
        RETRACTED,
        "[back - tips[1], tips[0] - tips[2], back - tips[3]]",
        "[back - tips[1], tips[0] - tips[2]]",
        f"{TESTS}::test_the_tool_goes_in_from_over_the_cut",
    ),
    Mutation(
        "lines: the proof lets axes come back together",
        RETRACTED,
        "(np.abs(self.step[at][others]) <= SAME).all()",
        "(np.abs(self.step[at][others]) <= 1e9).all()",
        f"{TESTS}::test_axes_come_back_in_their_order",
    ),
    Mutation(
        "lines: the proof does not ask which blocks stand there",
        RETRACTED,
        "if [(g.row, g.text, g.moves) for g in given] != wanted:",
        "if not wanted:",
        PLACES,
    ),
    Mutation(
        "lines: the proof lets blocks stand elsewhere",
        PROOF,
        "if self.given or [",
        "if [",
        PLACES,
    ),
    Mutation(
        "lines: the proof does not ask what happens in them",
        RETRACTED,
        "if [(e.row, e.what, e.values) for e in inside] != done:",
        "if not wanted:",
        HAPPENS,
    ),
    Mutation(
        "lines: the proof lets anything happen elsewhere",
        PROOF,
        "[(e.row, e.what, e.values, e.line) for e in self.events] != wanted:",
        "len(self.events) < 0:",
        HAPPENS,
    ),
    Mutation(
        "lines: what is written is not asked for the blocks",
        "gcxform/proof/verify.py",
        "if [each for each in here if each in wanted] != wanted:",
        "if not here:",
        TEXT,
    ),
    Mutation(
        "lines: behind G53 G0 it is taken for G1",
        "gcxform/emit/needed_modes.py",
        "(Form.PLAIN, Form.MACHINE, Form.BLIND)",
        "(Form.PLAIN, Form.BLIND)",
        STANDS,
    ),
)
