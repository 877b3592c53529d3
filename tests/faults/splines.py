"""Faults of splines, and of the bound beside which their lines are proved."""

from __future__ import annotations

from faults.mutation import Mutation

SPLINES = "tests/test_corpus.py::test_case"
BY_LINES = "tests/test_corpus.py::test_windows_make_no_difference"
SPLINE_LAWS = "tests/properties/test_splines.py"

MUTATIONS = (
    *(
        Mutation(f"splines: {name}", file, old, new, tests)
        for name, file, old, new, tests in (
            (
                "minus the P and Q before is plus",
                "gcxform/modal/moves/splines.py",
                "np.isnan(words.offset), -in_series,",
                "np.isnan(words.offset), in_series,",
                SPLINES,
            ),
            (
                "P and Q from the start",
                "gcxform/modal/moves/splines.py",
                "second = end + np.where(cubic, pull,",
                "second = start + np.where(cubic, pull,",
                SPLINES,
            ),
            (
                "a quadratic is cubic",
                "gcxform/modal/moves/splines.py",
                "offset, THIRDS * offset)",
                "offset, offset)",
                SPLINES,
            ),
            (
                "the series goes on after a line",
                "gcxform/modal/moves/splines.py",
                "(np.diff(words.row) == 1) & words.cubic[:-1]",
                "(np.diff(words.row) >= 1) & words.cubic[:-1]",
                SPLINES,
            ),
            (
                "the weight of the first control point is 1",
                "gcxform/modal/moves/nurbs.py",
                'first = self._value("P", opens) if alone else 1.0',
                "first = 1.0",
                f"{SPLINES}[splines/nurbs-other-dialect]",
            ),
            (
                "the order is always 3",
                "gcxform/modal/moves/nurbs.py",
                "np.append(first, weights), int(self._order(opens))",
                "np.append(first, weights), LEAST_ORDER",
                SPLINE_LAWS,
            ),
            (
                "tilted arcs go around the other way",
                "gcxform/modal/moves/tilted_arcs.py",
                "angle = np.arctan2(away[1], away[0]) + path.sense[row] * sweep * np.arange",
                "angle = np.arctan2(away[1], away[0]) - path.sense[row] * sweep * np.arange",
                "tests/test_tilted_arcs.py",
            ),
            (
                "tilted arcs of two circles are of one",
                "gcxform/modal/moves/tilted_arcs.py",
                "ONE_CIRCLE = 1e-6",
                "ONE_CIRCLE = 1e6",
                f"{SPLINES}[splines/tilted-two-circles]",
            ),
            (
                "weights do not count in tangents",
                "gcxform/toolpath/nurbs.py",
                "slope[:, -1:] * place",
                "0.0 * place",
                f"{SPLINES}[splines/nurbs-other-dialect]",
            ),
            (
                "a spline of weights is divided by windows",
                "gcxform/pipeline/whole_cuts.py",
                "texts = _divided(texts, _last_spline)",
                "pass",
                f"{BY_LINES}[splines/nurbs-other-dialect]",
            ),
            (
                "a step leaves splines of weights to their own control",
                "gcxform/pipeline/plan.py",
                "not same or any(LINEAR_ONLY in step.ensures for step in self.path_passes)",
                "not same",
                "tests/test_corpus.py::test_case[splines/nurbs-compensated]",
            ),
            (
                "what opens a spline stays on its own control",
                "gcxform/emit/pieces.py",
                "return points if task.manner.curves else",
                "return points if task.manner.crossing else",
                "tests/test_corpus.py::test_case[splines/nurbs-compensated]",
            ),
            (
                "half as many chords",
                "gcxform/toolpath/splines.py",
                "np.sqrt(0.75 * second",
                "0.5 * np.sqrt(0.75 * second",
                SPLINE_LAWS,
            ),
            (
                "the bound is a quarter",
                "gcxform/deviations/splines.py",
                "np.maximum.at(worst, self.group, bound)",
                "np.maximum.at(worst, self.group, bound / 4)",
                SPLINE_LAWS,
            ),
            (
                "the bound forgets a part of each line",
                "gcxform/deviations/splines.py",
                "for k in range(2**HALVINGS):",
                "for k in range(2**HALVINGS - 1, 2**HALVINGS):",
                SPLINE_LAWS,
            ),
            (
                "a spline for a line is no matter",
                "gcxform/deviations/deviation.py",
                "bent = before.is_spline[self.owner] | self.after.is_spline",
                "bent = before.is_spline[self.owner]",
                SPLINE_LAWS,
            ),
        )
    ),
    *(
        Mutation(f"splines of NURBS: {name}", file, old, new, tests)
        for name, file, old, new, tests in (
            (
                "they begin anywhere",
                "gcxform/emit/copying.py",
                "good[points] &= starts_exact[points] | placed",
                "pass",
                "tests/test_corpus.py::test_case[splines/nurbs-moved]",
            ),
            (
                "G91 is G90",
                "gcxform/modal/moves/nurbs.py",
                "if modes.incremental[line]:",
                "if False:",
                "tests/test_nurbs.py",
            ),
            (
                "no end is an end",
                "gcxform/modal/moves/nurbs.py",
                "if self.state.nurbs is not None and line != last + 1:",
                "if False:",
                "tests/test_nurbs.py",
            ),
            (
                "what stands between acts behind",
                "gcxform/modal/moves/nurbs.py",
                "acts = meaning.acts or meaning.events or",
                "acts = meaning.acts or",
                "tests/test_nurbs.py",
            ),
        )
    ),
)
