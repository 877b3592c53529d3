"""Faults of the translator of Klartext: each turns a program into another one."""

from __future__ import annotations

from faults.mutation import Mutation

LANGUAGES = "plugins/gcxform_plugins/languages"
CYCLES = "plugins/gcxform_plugins/dialects/heidenhain/cycles.py"
LABELS = "plugins/gcxform_plugins/dialects/heidenhain/labels.py"
MOVES = "plugins/gcxform_plugins/dialects/heidenhain/moves.py"
SAID = "plugins/gcxform_plugins/dialects/heidenhain/positioning.py"
WORDS = "plugins/gcxform_plugins/dialects/heidenhain/words.py"
PROGRAM = "plugins/gcxform_plugins/dialects/heidenhain/klartext.py"
TESTS = "tests/test_heidenhain.py"
PARAMETERS = "plugins/gcxform_plugins/dialects/heidenhain/parameters.py"
COMPUTES = "plugins/gcxform_plugins/dialects/heidenhain/arithmetic.py"
BACK = "plugins/gcxform_plugins/dialects/heidenhain/programs.py"
CONTOURS = "plugins/gcxform_plugins/dialects/heidenhain/contours.py"
HOLES = "plugins/gcxform_plugins/dialects/heidenhain/holes.py"
RUNS = "plugins/gcxform_plugins/dialects/heidenhain/runs.py"
SPELLING = "plugins/gcxform_plugins/dialects/heidenhain/spelling.py"
LINES = "plugins/gcxform_plugins/dialects/heidenhain/lines.py"
SPELLED = "gcxform/proof/spelled_out.py"
IDIOM = "tests/test_klartext_written.py::test_words_become_klartext_in_its_idiom_and_words_again"
WRITTEN = "tests/test_klartext_written.py"
READ = f"{TESTS}::test_it_is_read_as_by_a_reader_of_one_line_at_a_time"
REFUSED = "tests/test_heidenhain_refusals.py::test_it_is_refused_by_name"

MUTATIONS = (
    Mutation(
        "klartext: a reamer leaves in the feed of the way in",
        CYCLES,
        "exact(told[208] or feed)",
        "exact(feed)",
        "tests/test_klartext_holes.py::test_a_reamer_leaves_at_a_feed",
    ),
    Mutation(
        "klartext: a reamer leaves at no feed",
        CYCLES,
        "exact(told[208] or feed)",
        "exact(told[208])",
        "tests/test_klartext_holes.py::test_a_reamer_leaves_at_a_feed",
    ),
    Mutation(
        "klartext: the last hole around is the first",
        HOLES,
        "count if whole else count - 1",
        "count - 1",
        "tests/test_klartext_holes.py::test_holes_around_begin_at_the_first_angle_and_do_not_meet_it_again",
    ),
    Mutation(
        "klartext: an arc of holes does not reach its end",
        HOLES,
        "count if whole else count - 1",
        "count",
        "tests/test_klartext_holes.py::test_holes_along_an_arc_end_at_the_last_angle",
    ),
    Mutation(
        "klartext: a row of holes is not turned",
        HOLES,
        "step * k, told[224])",
        "step * k, told[224] * 0)",
        "tests/test_klartext_holes.py::test_holes_in_a_row_are_turned_about_the_first_one",
    ),
    Mutation(
        "klartext: patterns keep the surface of the cycle",
        CYCLES,
        "hole = {**self.hole, **{n: told[n] for n in (200, 203, 204)}}",
        "hole = self.hole",
        "tests/test_klartext_holes.py::test_the_surface_is_that_of_the_pattern",
    ),
    Mutation(
        "klartext: depths of centres may be diameters",
        HOLES,
        '{343: "a depth by the diameter"}, (344,)',
        "{}, (344, 343)",
        "tests/test_klartext_holes.py::test_what_is_not_certain_is_refused",
    ),
    Mutation(
        "klartext: corners turn the other way",
        CONTOURS,
        '"G3" if left > 0 else "G2")',
        '"G2" if left > 0 else "G3")',
        "tests/test_klartext_contours.py::test_a_corner_is_rounded",
    ),
    Mutation(
        "klartext: a chamfer is as long as it is across",
        CONTOURS,
        'back = size if name == "CHF" else',
        'back = size / 2 if name == "CHF" else',
        "tests/test_klartext_contours.py::test_a_chamfer_cuts_both_lines_along_themselves",
    ),
    Mutation(
        "klartext: a rounding begins as far away as its radius",
        CONTOURS,
        "else size / tan(angle / 2)",
        "else size",
        "tests/test_klartext_contours.py::test_a_corner_is_rounded",
    ),
    Mutation(
        "klartext: the feed of a corner stays in force",
        CONTOURS,
        '        return [block, f"F{old}"]',
        "        return [block]",
        "tests/test_klartext_contours.py::test_steps_count_from_the_corner_and_f_of_a_corner_is_its_own",
    ),
    Mutation(
        "klartext: an arc goes on against the arc before it",
        CONTOURS,
        "by = -left * (end[1] - centre[1]), left * (end[0] - centre[0])",
        "by = left * (end[1] - centre[1]), -left * (end[0] - centre[0])",
        "tests/test_klartext_contours.py::test_an_arc_goes_on_where_an_arc_ends",
    ),
    Mutation(
        "klartext: CC holds behind a tangential arc",
        CONTOURS,
        "        self.pole = {}\n        return self._all(said, block)",
        "        return self._all(said, block)",
        "tests/test_klartext_contours.py::test_what_is_not_certain_is_refused",
    ),
    Mutation(
        "klartext: roundings may be longer than their lines",
        CONTOURS,
        "size <= 0 or back > min(sizes) + 1e-9",
        "size <= 0",
        "tests/test_klartext_contours.py::test_what_is_not_certain_is_refused",
    ),
    Mutation(
        "klartext: runs end nowhere",
        RUNS,
        "            self.place[letter] = number\n",
        "",
        "tests/test_klartext_runs.py::test_runs_are_their_lines",
    ),
    Mutation(
        "klartext: feeds of runs in inches are of mm",
        RUNS,
        '" F" in text and not rapid and self.inch',
        "False",
        "tests/test_klartext_runs.py::test_runs_are_their_lines",
    ),
    Mutation(
        "klartext: runs leave the contour by R0 in no time",
        RUNS,
        '" R" in text and self.side',
        "False",
        "tests/test_klartext_runs.py::test_a_run_with_r0_leaves_the_contour",
    ),
    Mutation(
        "klartext: no tolerance is one of 0",
        CYCLES,
        'f"G64 P{bound}" if Decimal(bound) > 0 else "G61"',
        'f"G64 P{bound}"',
        "tests/test_klartext_target.py::test_the_tolerance_of_the_builder_is_none_at_all_elsewhere",
    ),
    Mutation(
        "klartext: a length counts from where it is called",
        SPELLED,
        "    yield from _first(counts & ~_same(was, is_, 0.0).all(axis=1), LENGTH)\n",
        "",
        "tests/test_klartext_target.py::test_a_length_that_comes_later_is_refused_where_it_would_count",
    ),
    Mutation(
        "klartext: a full circle behind a helix is one by its end",
        LINES,
        "not (self.rounded and self._whole(ends))",
        "True",
        "tests/test_klartext_spelled.py::test_a_full_circle_behind_a_helix_stays_one",
    ),
    Mutation(
        "klartext: powers bind to the left",
        "grammars/gcxform_grammars/heidenhain_computed.lark",
        "?power: applied | applied POWER power",
        "?power: applied | power POWER applied",
        "tests/test_klartext_computed.py::test_it_is_computed_as_by_a_reader_of_one_line_at_a_time",
    ),
    Mutation(
        "klartext: arcs are written the other way round",
        LINES,
        'sense = " DR+" if self.motion == "G3" else " DR-"',
        'sense = " DR-" if self.motion == "G3" else " DR+"',
        IDIOM,
    ),
    Mutation(
        "klartext: CC is written from the start of an arc",
        LINES,
        'pole = {axis: self.place[axis] + by[axis] for axis in "XY"}',
        'pole = {axis: by[axis] for axis in "XY"}',
        IDIOM,
    ),
    Mutation(
        "klartext: what is written for a TNC is not compared",
        SPELLED,
        'yield from _first(~_same(a.end, b.end, near[:, None]).all(axis=1), "an end")',
        "pass",
        f"{WRITTEN}::test_what_is_written_for_a_tnc_is_read_and_compared",
    ),
    Mutation(
        "klartext: the length of another tool is said by TOOL CALL",
        LINES,
        'if "G43" in codes and _plain(values.pop("H", self.in_spindle)) != self.in_spindle:',
        "if False:",
        f"{WRITTEN}::test_what_klartext_has_no_words_for_is_refused",
    ),
    Mutation(
        "klartext: a circle that became one line stays a circle",
        SPELLING,
        'if path[1].upper() in ("C", "CR", "CP") and not',
        "if False and not",
        f"{WRITTEN}::test_a_circle_becomes_lines_and_block_numbers_are_renewed",
    ),
    Mutation(
        "klartext: ANG has the opposite side last",
        COMPUTES,
        "math.atan2(a, b)",
        "math.atan2(b, a)",
        f"{WRITTEN}::test_functions_with_numbers",
    ),
    Mutation(
        "klartext: INT goes down",
        COMPUTES,
        '"INT": lambda a: float(math.trunc(a))',
        '"INT": lambda a: float(math.floor(a))',
        f"{WRITTEN}::test_formulas_are_worth_what_the_manual_says",
    ),
    Mutation(
        "klartext: values that are nearly equal are different",
        COMPUTES,
        "if a != b and abs(a - b) <= NEAR:",
        "if a != b and abs(a - b) < 0:",
        REFUSED,
    ),
    Mutation(
        "klartext: a sign before a power is that of the power",
        PARAMETERS,
        'if rule == "power" and rule_of(node.children[0]) == "negated":',
        "if False:",
        REFUSED,
    ),
    Mutation(
        "klartext: what the control reads leaves parameters as they were",
        PARAMETERS,
        "            self.q[key_of(name)] = None\n\n",
        "            self.q.setdefault(key_of(name), None)\n\n",
        f"{WRITTEN}::test_what_only_the_control_decides_is_kept_with_all_behind_it",
    ),
    Mutation(
        "klartext: -Q1 is Q1",
        PARAMETERS,
        "return written(-value if sign else value)",
        "return written(value)",
        f"{WRITTEN}::test_a_loop_counts_by_jumps_and_a_subprogram_has_the_parameters",
    ),
    Mutation(
        "klartext: QL parameters are those of all programs",
        LABELS,
        "self.q |= dict(call.local)",
        "pass",
        f"{WRITTEN}::test_a_program_beside_it_is_called",
    ),
    Mutation(
        "klartext: a jump out of a repeat leaves it where it is",
        LABELS,
        "if key[1] == len(self.calls) and not self.repeated[key] <= line <= key[0]:",
        "if False:",
        REFUSED,
    ),
    Mutation(
        "klartext: a step of a shift replaces it",
        CYCLES,
        "value = exact(Decimal(value) + Decimal(self.shift[axis]))",
        "value = exact(Decimal(value))",
        f"{WRITTEN}::test_a_shift_adds_and_leaves_other_axes",
    ),
    Mutation(
        "klartext: places are known behind what is kept",
        BACK,
        "        self.lose()\n        self.pole, self.motion",
        "        self.pole, self.motion",
        f"{WRITTEN}::test_blocks_are_the_same_whatever_is_kept",
    ),
    Mutation(
        "klartext: what hangs on the next line's direction is cut",
        BACK,
        "if at < len(self.lines) and ROUNDED.match(self.lines[at]):",
        "if False:",
        f"{WRITTEN}::test_blocks_are_the_same_whatever_is_kept",
    ),
    Mutation(
        "klartext: lines that may be executed again are changed",
        BACK,
        "return None if self.tied else spelled(",
        "return spelled(",
        f"{WRITTEN}::test_a_line_that_may_be_executed_again_is_not_changed",
    ),
    Mutation(
        "klartext: a circle in a scale is cut as without",
        BACK,
        'if path.name not in ("L", "LP") and self.scaled:',
        "if False:",
        f"{WRITTEN}::test_a_circle_in_a_scale_is_kept",
    ),
    Mutation(
        "klartext: M89 calls nothing",
        BACK,
        'self.modal = (self.modal or "89" in called) and "99" not in called',
        "self.modal = False",
        f"{WRITTEN}::test_cycles_that_call_themselves_keep_what_follows",
    ),
    Mutation(
        "klartext: DR+ is clockwise",
        SAID,
        'said.sense = "G3" if item.name[-1] == "+" else "G2"',
        'said.sense = "G2" if item.name[-1] == "+" else "G3"',
        READ,
    ),
    Mutation(
        "klartext: FMAX stays in force",
        MOVES,
        'code = "G0" if said.rapid else "G1"\n        if code == "G1":',
        'code = "G0" if said.rapid or self.motion == "G0" else "G1"\n        if code == "G1":',
        READ,
    ),
    Mutation(
        "klartext: steps count from zero",
        WORDS,
        "return axis, exact(self.stands_at(axis, item) + Decimal(number))",
        "return axis, exact(self.stands_at(axis, item) * 0 + Decimal(number))",
        READ,
    ),
    Mutation(
        "klartext: feeds in inches are inches",
        WORDS,
        "number = exact(Decimal(number).scaleb(-1))",
        "number = exact(Decimal(number))",
        READ,
    ),
    Mutation(
        "klartext: the feed of M128 is that of the tip",
        SAID,
        "if last == 128:",
        "if last == 127:",
        READ,
    ),
    Mutation(
        "klartext: M129 acts at the start of its block",
        MOVES,
        "blocks = [*said.before, *([block] if block else ()), *said.after]",
        "blocks = [*said.before, *said.after, *([block] if block else ())]",
        READ,
    ),
    Mutation(
        "klartext: a turn more or less in a helix",
        MOVES,
        'words += f" P{turns}" if turns > 1 else ""',
        'words += f" P{turns + 1}" if turns > 1 else ""',
        READ,
    ),
    Mutation(
        "klartext: a helix ends beside its circle",
        MOVES,
        "ends |= self._at(pole, radius, begin + turn)",
        "ends |= self._at(pole, radius, begin - turn)",
        READ,
    ),
    Mutation(
        "klartext: a helix may turn against its sense",
        MOVES,
        "if turn * sense < 0:",
        "if turn * sense > 1e9:",
        REFUSED,
    ),
    Mutation(
        "klartext: REP counts all runs",
        LABELS,
        "left = self.left.get(key, times)",
        "left = self.left.get(key, times - 1)",
        READ,
    ),
    Mutation(
        "klartext: a repeat is not begun anew",
        LABELS,
        "        if not left:\n            del self.left[key]",
        "        if not left:\n            self.left[key] = 0",
        f"{TESTS}::test_labels_in_labels",
    ),
    Mutation(
        "klartext: a shift is added to the one before",
        CYCLES,
        "new = {axis: known[axis] for axis in LINEAR}",
        "new = {a: exact(Decimal(given.get(a, 0)) + Decimal(old[a])) for a in LINEAR}",
        READ,
    ),
    Mutation(
        "klartext: places keep their numbers under a shift",
        CYCLES,
        "self.place[axis] = exact(Decimal(self.place[axis]) - by[axis])",
        "self.place[axis] = exact(Decimal(self.place[axis]))",
        f"{TESTS}::test_a_shift_counts_from_the_datum",
    ),
    Mutation(
        "klartext: pecks go to the bottom of the last one in rapid",
        CYCLES,
        "near = surface - reached + before",
        "near = surface - reached",
        f"{TESTS}::test_strokes_of_the_old_cycle",
    ),
    Mutation(
        "klartext: a hole in many strokes is one in one",
        CYCLES,
        "if depth >= 0 or told.get(202, -depth) < -depth or self.inch:",
        "if depth >= 0 or self.inch:",
        f"{TESTS}::test_other_holes_are_not_certain",
    ),
    Mutation(
        "klartext: the feed in force behind a cycle is that of the cycle",
        CYCLES,
        'self.motion, self.feed_lost = "G0", True',
        'self.motion, self.feed_lost = "G0", False',
        f"{TESTS}::test_a_hole_in_one_stroke",
    ),
    Mutation(
        "klartext: the shorter way is as it is written",
        MOVES,
        "abs(Decimal(after) - Decimal(before)) >= 180",
        "abs(Decimal(after) - Decimal(before)) > 180",
        REFUSED,
    ),
    Mutation(
        "klartext: places are known behind a tool change",
        PROGRAM,
        "        tool = self.in_spindle = self.tool\n        self.lose()",
        "        tool = self.in_spindle = self.tool",
        REFUSED,
    ),
    Mutation(
        "klartext: M91 under M128",
        MOVES,
        'if self.following:\n            self.refuse("M91',
        'if self.following is None:\n            self.refuse("M91',
        REFUSED,
    ),
    Mutation(
        "klartext: tools may be longer than the machine file says",
        PROGRAM,
        "- value) > 1e-9:",
        "- value) > 1e9:",
        REFUSED,
    ),
    Mutation(
        "klartext: RL is right of the contour",
        MOVES,
        'SIDES = {"RL": "G41", "RR": "G42"}',
        'SIDES = {"RR": "G41", "RL": "G42"}',
        f"{TESTS}::test_beside_a_contour_it_is_read_as_g41",
    ),
    Mutation(
        "klartext: behind a switch with turned axes places are known",
        SAID,
        'self.lose("XYZ")',
        'self.lose("")',
        f"{TESTS}::test_behind_a_switch_with_turned_axes_places_are_lost",
    ),
)
