"""Faults of keeping subprograms and loops: the proof, which executes the result, must find them."""

from __future__ import annotations

from faults.mutation import Mutation

FOLDING = "gcxform/emit/folding.py"
VALUES = "gcxform/emit/values_left.py"
PROOF = "gcxform/proof/structure.py"
PLANTED = "tests/test_folding.py"


def _fold(name: str, old: str, new: str, file: str = FOLDING, tests: str = PLANTED) -> Mutation:
    return Mutation(f"structure: {name}", file, old, new, tests)


MUTATIONS = (
    _fold(
        "a loop that nothing calls any more is left",
        "self.walk.deciding.intersection(first[depth == 0].tolist())",
        "self.walk.deciding",
        tests="tests/test_corpus.py::test_case[structure/called-by-what-is-written-out]",
    ),
    _fold(
        "a condition behind elseif reads nothing",
        "*self.asked.get(step.first, ())",
        "*()",
        "gcxform/flow/walk.py",
        "tests/test_corpus.py::test_case[structure/elseif-reads-what-was-set]",
    ),
    _fold("a call in what is written out is none", "return calls or not all(", "return not all("),
    _fold(
        "values that are set behind a call are one",
        " and self.spelled.raw(line) in text.text",
        "",
        tests="tests/test_corpus.py::test_case[structure/values-behind-what-is-written-out]",
    ),
    _fold("texts that differ are the same", "if len(texts) > 1:", "if False:"),
    _fold("runs that differ are the same", "if len(same) == 1 else None", "", VALUES),
    _fold(
        "no value is left",
        "for key in sorted(read & values.keys(), key=str):",
        "for key in ():",
        VALUES,
    ),
    _fold(
        "nobody reads behind a run",
        "if at < len(steps) and steps[at]",
        "if False and steps[at]",
        VALUES,
    ),
    _fold(
        "a callee's values are left",
        "if steps[made.step].level == level and",
        "if",
        VALUES,
        "tests/test_corpus.py::test_case[structure/own-value-of-a-call]",
    ),
    _fold("stored modes are nothing", "if self.variants and self.walk.tied:", "if False:"),
    _fold("a call that reads values stays", "or line in self.walk.reads:", "or False:"),
    _fold(
        "a number that is jumped to is doubled",
        "if lost or after[number] > before[number]:",
        "if False:",
    ),
    _fold("a jump out of a loop is lost", "steps[end].first == unit.last + 1", "True"),
    _fold("what others call is changed", "in self._needed():", "in ():"),
    _fold(
        "what is written out calls nothing",
        "new = [unit.first for unit in self.out if unit.name]",
        "new = [unit.first for unit in ()]",
    ),
    _fold(
        "definitions go where all is written out",
        "return beside(self._spelled(), self.takes_stamps)",
        "return None",
        "gcxform/pipeline/structure.py",
    ),
    _fold(
        "a definition that is passed stands behind the end",
        "places = {each: walk.passed_at(each.first) for",
        "places = {each: None for",
        "gcxform/emit/definitions.py",
    ),
    _fold(
        "all behind an end is executed",
        "return int(np.argmax(ends)) + 1 if ends.any() else None",
        "return None",
        PROOF,
    ),
    _fold(
        "definitions need not stand there",
        "idle[[each.first for each in walk.definitions]] = True",
        "pass",
        PROOF,
    ),
    _fold(
        "what is kept is what was done",
        "if moves and self.unmoved is not None:",
        "if False and self.unmoved is not None:",
        "gcxform/flow/executed.py",
        "tests/test_corpus.py::test_case[bad/gx226-alone-moves]",
    ),
    _fold(
        "what is kept stands behind no end",
        "if not folds and self.unended is not None:",
        "if False and self.unended is not None:",
        "gcxform/flow/executed.py",
        "tests/test_corpus.py::test_case[bad/gx226-no-end]",
    ),
    _fold("returned values are not read", "and self._reads_returns():", "and False:"),
    _fold(
        "what is executed is not compared", "    if now == wanted:", "    if True:", PROOF, PLANTED
    ),
    _fold(
        "what is not executed need not stand there",
        "if not any(new == old for new in written):",
        "if False:",
        PROOF,
        PLANTED,
    ),
    Mutation(
        "folding: a number counts in all programs of a text together",
        "gcxform/emit/numbered.py",
        "most |= Counter(",
        "most += Counter(",
        "tests/test_corpus.py::test_case[flow/numbers-of-several-files]",
    ),
)
