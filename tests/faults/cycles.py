"""Faults in the arithmetic of canned cycles."""

from __future__ import annotations

from faults.mutation import CYCLES, Mutation

LEVELS = "gcxform/modal/cycles/expansion.py"
STRETCH = "gcxform/modal/cycles/stretch.py"
STEPS = "gcxform/modal/cycles/steps.py"
DRILLING = "gcxform/modal/moves/cycle_patterns.py"
STRETCHES = "tests/test_stretches.py"

FAULTS = (
    (
        "words of another cycle stay",
        STRETCH,
        "fresh if fresh.any() else None",
        "None",
    ),
    (
        "words do not stay",
        STRETCH,
        "present = ~np.isnan(word)\n        return",
        "present = np.ones(len(word), np.bool_)\n        return",
    ),
    (
        "G98 goes back to R",
        STRETCH,
        "np.where(calls.initial, high, clearance)",
        "clearance",
    ),
    (
        "G98 goes back to the initial level, even below R",
        STRETCH,
        "np.maximum(self.initial, clearance)",
        "self.initial",
    ),
    (
        "the initial level is taken anew",
        STRETCH,
        "np.array([mode.initial]) if mode.code else ",
        "",
    ),
    (
        "over the hole before up to R",
        STRETCH,
        "rises = self.initial < clearance",
        "rises = clearance < clearance",
    ),
    (
        "over the hole at R",
        STRETCH,
        "level = np.where(standing > clearance, standing, low)",
        "level = low",
    ),
    (
        "under G98 over the hole at R",
        STRETCH,
        "low = np.where(self.calls.initial, self.initial, clearance)",
        "low = clearance",
    ),
    (
        "increments are made once",
        STRETCH,
        "word * repeats",
        "word",
    ),
    (
        "increments are made at once",
        LEVELS,
        "(count[call] - 1 - number)",
        "(0 * number)",
    ),
    (
        "R is a distance from nowhere",
        STRETCH,
        'np.where(by_steps["r"], self.initial, 0.0)',
        "0.0",
    ),
    (
        "the bottom is a distance from nowhere",
        STRETCH,
        'np.where(by_steps["normal"], clearance, 0.0)',
        "0.0",
    ),
    (
        "the middle is no distance",
        LEVELS,
        "middle + np.where(calls.incremental, stretch.bottom, 0.0)",
        "middle + 0.0",
    ),
    (
        "blocks that store words drill",
        STRETCH,
        "wanted & (repeats > 0)",
        "repeats > -1",
    ),
    (
        "inches are counted in mm",
        LEVELS,
        "lengths if calls.unit == 1.0 else",
        "lengths if calls.unit > 0.0 else",
    ),
    (
        "every repeat rises",
        LEVELS,
        "stretch.rises[call] & (number == 0)",
        "stretch.rises[call]",
    ),
    (
        "repeats come from where the first came",
        LEVELS,
        "np.where(number == 0, stretch.level[call], stretch.retract[call])",
        "stretch.level[call]",
    ),
    (
        "the dwell is forgotten",
        LEVELS,
        "Mode(dwell=self.mode.dwell)",
        "Mode()",
    ),
    (
        "pecks begin at the last depth",
        STEPS,
        "depth + back)",
        "depth)",
    ),
    (
        "clearance and return are swapped",
        STEPS,
        "clears, above, up",
        "clears, up, above",
    ),
    (
        "the first peck is left out",
        STEPS,
        "(peck + 1) * holes",
        "(peck + 2) * holes",
    ),
    (
        "pecks are not cleared",
        STEPS,
        "np.where(clears & (part == 1), top, normal)",
        "normal",
    ),
    (
        "the rise is made over the hole",
        STEPS,
        "end[rising, :2] = holes.start[hole[rising]]",
        "pass",
    ),
    (
        "the tool is not shifted",
        STEPS,
        "end[shifted, axis] += holes",
        "end[shifted, axis] += 0 * holes",
    ),
    (
        "down to R before the hole",
        STEPS,
        "at[rows] == holes.rises[hole[rows]]",
        "at[rows] == 1 + holes.rises[hole[rows]]",
    ),
    (
        "what is done comes a move too late",
        STEPS,
        "row + number + 1",
        "row + number + 2",
    ),
    (
        "the spindle turns the other way",
        STEPS,
        "spindle > 0 else",
        "spindle < 0 else",
    ),
    (
        "the rounding of many pecks",
        STEPS,
        "if len(doubtful):",
        "if False:",
    ),
)
"""Name, file, old, new; the tests are those of cycles."""

TOGETHER = (
    (
        "count events from the first of them",
        "for event in events]) - bounds[whose]",
        "for event in events])",
    ),
    ("end at R under G98", "if plain.high else clearance", "if False else clearance"),
    ("keep the dwell before them", "if plain.dwell == plain.dwell:\n", "if False:\n"),
    ("forget that R is incremental", "clearance + initial if", "clearance if"),
    ("forget increments before the last place", "moved[place - first]", "0.0"),
    ("are one", "bounds[:-1], positions", "bounds[:1], positions[:1]"),
)
"""Name, old, new of faults in stretches that are made together."""

MUTATIONS = (
    *(Mutation(f"cycles: {name}", *where, CYCLES) for name, *where in FAULTS),
    *(
        Mutation(f"cycles: stretches made together {name}", DRILLING, old, new, STRETCHES)
        for name, old, new in TOGETHER
    ),
    Mutation(
        "cycles: stretches made together have words of the stretch before",
        "gcxform/modal/moves/pattern_ends.py",
        "place >= first, columns",
        "place >= 0, columns",
        STRETCHES,
    ),
    Mutation(
        "writing: what a cycle stores by steps is dropped where steps become positions",
        "gcxform/emit/pieces.py",
        "np.asarray(idle & turned & stores)",
        "np.zeros_like(idle)",
        "tests/test_corpus.py::test_case[absolute/stored-by-steps]",
    ),
    Mutation(
        "cycles: what a tap stores is gone with its cycle",
        "gcxform/emit/pieces.py",
        " & ~_stores_taps(task, count)",
        "",
        "tests/test_corpus.py::test_case[tied/tap-stored]",
    ),
    Mutation(
        "cycles: R of G90 is a distance in G91 where levels stay",
        STRETCH,
        "return in_g91 if rule.stays.levels else",
        "return",
        "tests/test_corpus.py::test_case[dialects/fanuc/levels-in-steps]",
    ),
    Mutation(
        "cycles: a row of holes ends where R would be a distance",
        "gcxform/modal/moves/pattern_ends.py",
        "[called] if stay else called]",
        "[called] if False else called]",
        "tests/test_corpus.py::test_case[dialects/fanuc/levels-in-steps-behind]",
    ),
    Mutation(
        "cycles: distances of G91 are levels in G90",
        "gcxform/modal/cycles/checks.py",
        "yield mixed & ~calls.incremental, message, again",
        "yield mixed & False, message, again",
        "tests/test_corpus.py::test_case[dialects/fanuc/levels-of-steps-in-g90]",
    ),
    Mutation(
        "cycles: an M code beside no hole is lost with the cycle",
        "gcxform/emit/codewords.py",
        "self.key.expanded and self.key.role is not Role.NONE",
        "self.key.expanded",
        "tests/test_corpus.py::test_case[dialects/fanuc/m-alone-in-a-cycle]",
    ),
    Mutation(
        "cycles: repeats of a call do not turn the axis further",
        DRILLING,
        "place - step * (hole[-1:] - hole)[going]",
        "place",
        "tests/test_corpus.py::test_case[dialects/fanuc/cycle-turns-an-axis]",
    ),
    Mutation(
        "cycles: an axis is turned while the tool rises to R",
        DRILLING,
        "going = hole > 0",
        "going = hole >= 0",
        "tests/test_cycles.py::test_axes_turn_on_the_way_to_the_hole",
    ),
    Mutation(
        "cycles: steps of a rotary axis count from its place before the cycle",
        DRILLING,
        "step, word = word, before + word * self.columns.counts[line]",
        "step, word = word, before + word",
        "tests/test_corpus.py::test_case[dialects/fanuc/cycle-turns-an-axis]",
    ),
    Mutation(
        "cycles: behind a tap that moves an axis stands as it did before it",
        "gcxform/emit/tapping.py",
        "after[3:] = hole.bottom[3:]",
        "after[3:] = standing[3:]",
        "tests/test_corpus.py::test_case[tied/tap-turns-an-axis]",
    ),
    Mutation(
        "cycles: a hole above R",
        "gcxform/modal/cycles/checks.py",
        "stretch.bottom > stretch.clearance",
        "stretch.bottom > np.inf",
        "tests/test_cycle_refusals.py",
    ),
    Mutation(
        "cycles: a shift of the machine's own is folded with a turn",
        "gcxform/modal/interpreter.py",
        "open_pecks and self.reading.tables_stay",
        "open_pecks",
        "tests/test_corpus.py::test_case[dialects/fanuc/fine-boring-turned]",
    ),
    Mutation(
        "cycles: fine boring is refused where its block stays",
        "gcxform/modal/cycles/checks.py",
        "not (one.steps and self.open_ways)",
        "True",
        "tests/test_corpus.py::test_case[dialects/fanuc/fine-boring-stays]",
    ),
    Mutation(
        "cycles: a pattern of holes drills a cycle that has become moves",
        "gcxform/emit/depending.py",
        "manner.expands and self._drills(line)",
        "False",
        "tests/test_corpus.py::test_case[dialects/haas/patterns-without-cycle]",
    ),
    Mutation(
        "comments: a percent sign gets into the file of a Fanuc",
        "plugins/gcxform_plugins/dialects/fanuc.py",
        'lower_case=False, asides=True, acts_anywhere="%"',
        "lower_case=False, asides=True",
        "tests/test_corpus.py::test_case[dialects/across/percent-in-a-comment]",
    ),
    Mutation(
        "windows: a cycle ends with its window",
        "gcxform/pipeline/whole_cuts.py",
        "_drilled(text, drills)",
        "_drilled(text, False)",
        "tests/test_whole_cuts.py",
    ),
    Mutation(
        "windows: a cycle ends before a text without codes",
        "gcxform/pipeline/whole_cuts.py",
        "        return len(text) * drills, drills\n",
        "        return 0, drills\n",
        "tests/test_whole_cuts.py",
    ),
    Mutation(
        "windows: codes in small letters drill nothing",
        "gcxform/pipeline/whole_cuts.py",
        ', re.compile(rb"g[78 \\t]")',
        ",",
        "tests/test_whole_cuts.py",
    ),
    Mutation(
        "windows: one hole makes all of them small",
        "gcxform/pipeline/whole_cuts.py",
        "2 * drilled > len(text)",
        "drilled",
        "tests/test_whole_cuts.py",
    ),
    Mutation(
        "cycles: two controls have one and the same parameter of pecks",
        "gcxform/pipeline/plan.py",
        "same and not expands, same and not folds",
        "not expands, same and not folds",
        "tests/test_corpus.py::test_case[dialects/across/pecks-for-haas]",
    ),
    Mutation(
        "cycles: pecks that are not known are expanded",
        "gcxform/pipeline/plan.py",
        "same and not expands, same and not folds",
        "same, same and not folds",
        "tests/test_corpus.py::test_case[bad/gx215-cycle]",
    ),
    Mutation(
        "cycles: R above the level is refused where it is copied",
        "gcxform/modal/cycles/checks.py",
        "high &= calls.initial | open_way",
        "high &= True",
        "tests/test_corpus.py::test_case[dialects/haas/r-above-the-level]",
    ),
    Mutation(
        "cycles: the last digit of a work offset is a higher R",
        "gcxform/modal/cycles/checks.py",
        "stretch.clearance - stretch.initial > SAME",
        "stretch.clearance > stretch.initial",
        "tests/test_corpus.py::test_case[tied/tapping-from-its-level]",
    ),
    Mutation(
        "cycles: R above the level ends at R under G98",
        "gcxform/modal/cycles/checks.py",
        "high &= calls.initial | open_way",
        "high &= open_way",
        "tests/test_corpus.py::test_case[dialects/haas/r-above-the-level-g98]",
    ),
    Mutation(
        "cycles: R above the level is expanded",
        "gcxform/modal/cycles/checks.py",
        "high &= calls.initial | open_way",
        "high &= calls.initial",
        "tests/test_corpus.py::test_case[dialects/haas/r-above-the-level-aside]",
    ),
    Mutation(
        "cycles: R above the level is refused over the hole",
        "gcxform/modal/cycles/checks.py",
        "~there & ~(stretch.level >= stretch.clearance)",
        "~(stretch.level >= stretch.clearance)",
        "tests/test_corpus.py::test_case[dialects/haas/r-above-the-level-expanded]",
    ),
    Mutation(
        "cycles: R above the level is refused at R",
        "gcxform/modal/cycles/checks.py",
        "~there & ~(stretch.level >= stretch.clearance)",
        "~there",
        "tests/test_corpus.py::test_case[dialects/haas/r-above-the-level-expanded]",
    ),
    Mutation(
        "cycles: M codes of a Fanuc act behind the hole",
        "plugins/gcxform_plugins/dialects/fanuc.py",
        'corners="CR", m_over_hole=True',
        'corners="CR"',
        "tests/test_corpus.py::test_case[dialects/fanuc/m-over-the-hole]",
    ),
    Mutation(
        "cycles: M codes of a Haas act over the hole",
        "plugins/gcxform_plugins/dialects/haas.py",
        "m_over_hole=False",
        "m_over_hole=True",
        "tests/test_corpus.py::test_case[dialects/haas/m-behind-the-hole-for-fanuc]",
    ),
    Mutation(
        "cycles: the end of a program comes over the last hole",
        "gcxform/dialect/move_rules.py",
        "if code.after and not code.ends}",
        "if code.after}",
        "tests/test_corpus.py::test_case[dialects/fanuc/m-over-the-hole]",
    ),
    Mutation(
        "cycles: a tap may dwell for any cycle that is expanded",
        "gcxform/toolpath/cycles_as_moves.py",
        "shared = np.isin(seconds, seconds[expanded[before]])",
        "shared = np.ones(len(seconds), np.bool_)",
        "tests/test_corpus.py::test_case[tied/tap-with-its-own-dwell]",
    ),
    Mutation(
        "cycles: a tap dwells for no other cycle",
        "gcxform/toolpath/cycles_as_moves.py",
        "shared = np.isin(seconds, seconds[expanded[before]])",
        "shared = np.zeros(len(seconds), np.bool_)",
        "tests/test_cycle_refusals.py::test_a_tap_that_dwells_for_the_p_of_a_cycle_that_goes",
    ),
)
