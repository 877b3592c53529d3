"""Faults in what the programs of shops are about: steps from nowhere, loops, settings of a Haas."""

from __future__ import annotations

from faults.mutation import Mutation

BLIND = "gcxform/modal/moves/blind_moves.py"
CASE = "tests/test_corpus.py::test_case"
FROM_NOWHERE = f"{CASE}[absolute/from-nowhere]"
STEPS = "tests/test_blind_moves.py"

FAULTS = (
    (
        "a G53 under G1 of a Haas is refused",
        "plugins/gcxform_plugins/dialects/haas.py",
        "g53_is_rapid=False",
        "g53_is_rapid=True",
        f"{CASE}[dialects/haas/machine-coordinates-in-feed]",
    ),
    (
        "behind a cycle that may drill or not the tool stands at R",
        "gcxform/modal/moves/cycle_patterns.py",
        "if after[normal] != words[normal]:",
        "if after[normal] != after[normal]:",
        f"{CASE}[dialects/haas/cycle-without-place-level]",
    ),
    (
        "a cycle that may drill or not is written out",
        "gcxform/modal/moves/cycle_patterns.py",
        "return self.cycles is not None and self.cycles.open_pecks",
        "return True",
        f"{CASE}[dialects/haas/cycle-without-place]",
    ),
    (
        "steps from nowhere under compensation",
        BLIND,
        " & (modes.comp == 0)",
        "",
        f"{CASE}[bad/gx207-incremental-from-nowhere]",
    ),
    (
        "steps from nowhere in another dialect",
        BLIND,
        "lines.reading.crosses or ",
        "",
        f"{CASE}[dialects/across/steps-from-nowhere]",
    ),
    (
        "a way home from nowhere known is not noted",
        "gcxform/modal/moves/home.py",
        "        note_way(track, line)\n",
        "",
        STEPS,
    ),
    (
        "steps from nowhere may be written otherwise",
        BLIND,
        "np.where(blind, np.int8(Form.BLIND), rows.form)",
        "rows.form",
        FROM_NOWHERE,
    ),
    (
        "what a step goes by is not noted",
        BLIND,
        "if value]",
        "if value > 1e9]",
        STEPS,
    ),
    (
        "what an arc goes by is not noted",
        BLIND,
        'if track.modes.motion[line] > 1 else ""',
        'if track.modes.motion[line] > 3 else ""',
        STEPS,
    ),
    (
        "what a step goes by is not turned",
        BLIND,
        "frame.turned(step)[0]",
        "step[0]",
        STEPS,
    ),
    (
        "a step stays in a mirror that is folded",
        "gcxform/emit/same_rows.py",
        "((alike.all(axis=1) & ~blind) | as_far",
        "(alike.all(axis=1) | as_far",
        f"{CASE}[offsets/steps-from-nowhere-mirrored]",
    ),
    (
        "the motion code of a step from nowhere is not stated",
        "gcxform/emit/stated.py",
        "(Form.PLAIN, Form.MACHINE, Form.BLIND)",
        "(Form.PLAIN, Form.MACHINE)",
        f"{CASE}[arcs/then-a-step-from-nowhere]",
    ),
    (
        "arcs from nowhere of other sweeps are the same",
        "gcxform/deviations/deviation.py",
        "self.distance[rows[~same]] = np.inf",
        "self.distance[rows[~same]] = 0.0",
        f"{STEPS}::test_an_arc_of_another_sweep_is_another",
    ),
    (
        "arcs from nowhere are cut",
        "plugins/gcxform_plugins/passes/segment.py",
        "if len(blind):",
        "if False:",
        f"{CASE}[segment/arc-from-nowhere]",
    ),
    (
        "a loop that moves is kept",
        "gcxform/flow/branches.py",
        "return all(f or is_still(*each)",
        "return all(True or is_still(*each)",
        f"{CASE}[flow/haas-loop-with-branch-moves]",
    ),
    (
        "a loop whose numbers would stand twice is refused",
        "gcxform/flow/branches.py",
        "if to.first < by.stop}",
        "if to.first > by.stop}",
        f"{CASE}[flow/haas-loop-with-branch]",
    ),
    (
        "what is set in the control has that value behind",
        "gcxform/dialect/arithmetic.py",
        "return {key: value if self.owns(key) else math.nan}",
        "return {key: value}",
        f"{CASE}[flow/control-values-set]",
    ),
    (
        "a cycle under compensation is written as one that is still called",
        "gcxform/pipeline/chain.py",
        "return compensates_cycles(passes) or any(",
        "return any(",
        f"{CASE}[volumetric/cycle]",
    ),
    (
        "another name of a parameter is another parameter",
        "gcxform/dialect/arithmetic.py",
        "return next(filter(self.owns, own), key)",
        "return key",
        f"{CASE}[flow/haas-other-names]",
    ),
    (
        "a number of a table is no act",
        "gcxform/modal/meaning/numbered.py",
        "if arithmetic is not None and digits.isdigit() and",
        "if arithmetic is None and digits.isdigit() and",
        f"{CASE}[flow/control-tables]",
    ),
    (
        "a zero that is written counts at once",
        "gcxform/modal/frames/work_offsets.py",
        "state = replace(state.shifted(), unsettled=False)",
        "state = replace(state, unsettled=False)",
        f"{CASE}[flow/control-tables]",
    ),
    (
        "the same work offset again is none, though it was written",
        "gcxform/modal/moves/moves.py",
        "again[:] = False",
        "again &= True",
        f"{CASE}[flow/control-tables]",
    ),
    (
        "a number of a table is folded",
        "gcxform/modal/frames/work_offsets.py",
        "if asked.reading.crosses or not asked.reading.tables_stay:",
        "if asked.reading.crosses:",
        f"{CASE}[flow/control-tables-folded]",
    ),
    (
        "a number of a table is perhaps written",
        "gcxform/flow/branches.py",
        "if run.arithmetic.writes_table(key):",
        "if False:",
        f"{CASE}[flow/control-tables-perhaps]",
    ),
    (
        "a distance is the same in every system",
        "gcxform/dialect/increments.py",
        "return round(count) / steps if near else math.nan",
        "return round(count) / steps",
        f"{CASE}[dialects/fanuc/increment-calculator-computed]",
    ),
    (
        "an arc is rounded openly",
        "gcxform/modal/expressions/assignments.py",
        "if may and rounded_openly(",
        "if rounded_openly(",
        f"{CASE}[expressions/fanuc-increment]",
    ),
    (
        "what is rounded openly is kept for another dialect",
        "gcxform/modal/expressions/assignments.py",
        "if not here or lines.reading.crosses:",
        "if not here:",
        f"{CASE}[dialects/across/computed-by-increments]",
    ),
    (
        "what a value reads that is rounded openly is left out",
        "gcxform/flow/run_state.py",
        "keys = set(parameters_in(word.value.tree))",
        "keys: set[Key] = set()",
        f"{CASE}[flow/fanuc-rounded-openly]",
    ),
    (
        "a tilted plane is in no other place",
        "gcxform/modal/frames/transforms.py",
        'return replace(state, tilt=f" in {asked.code} ({count})", tilted=count)',
        "return replace(state, tilted=count)",
        f"{CASE}[dialects/fanuc/tilted-plane-kept]",
    ),
    (
        "G69 leaves a tilted plane where it is",
        "gcxform/modal/frames/transforms.py",
        'return replace(state, tilt="")',
        "return state",
        f"{CASE}[dialects/fanuc/tilted-plane-kept]",
    ),
    (
        "the tip is in no other place",
        "gcxform/modal/frames/tool_lengths.py",
        'return replace(state, tip=f" at the tip ({count})", tilted=count)',
        "return replace(state, tilted=count)",
        f"{CASE}[dialects/fanuc/tilted-plane-kept]",
    ),
)

MUTATIONS = tuple(Mutation(f"shops: {name}", *rest) for name, *rest in FAULTS)
