"""Faults of parameters and expressions."""

from __future__ import annotations

from faults.mutation import Mutation


def _computed(name: str, file: str, old: str, new: str) -> Mutation:
    tests = "tests/test_expressions.py"
    return Mutation(f"computing: {name}", f"gcxform/modal/{file}.py", old, new, tests)


MUTATIONS = (
    _computed("relations are as close as sums", "arithmetic", "EQUAL = 1e-4", "EQUAL = 1e-9"),
    _computed(
        "fractions are cut towards zero", "arithmetic", "float(math.floor(a))", "float(int(a))"
    ),
    _computed("MOD keeps the sign", "arithmetic", "rest if rest >= 0 else rest + abs(b)", "rest"),
    _computed("XOR is OR", "arithmetic", "(a != 0) != (b != 0)", "a != 0 or b != 0"),
    _computed("angles are in radians", "arithmetic", "np.longdouble(a) * PI / 180", "a"),
    _computed("a sign is lost", "expressions", "-value if children[0]", "value if children[0]"),
    _computed("operands are swapped", "expressions", "(left), self", "(right), self"),
    _computed("names have their case", "expressions", "BLANKS).lower()", "BLANKS)"),
    _computed(
        "what nobody set is zero",
        "expressions",
        "value = self.parameters.get(key)\n",
        "value = self.parameters.get(key, 0.0)\n",
    ),
    _computed(
        "assignments act at once",
        "computing",
        "return key, evaluator.value(expression)",
        "self.lines.parameters[key] = evaluator.value(expression)\n            return None",
    ),
    _computed(
        "parameters end with their window",
        "interpreter",
        "self.state.parameters = lines.parameters",
        "pass",
    ),
    Mutation(
        "an assignment stands in every piece of its block",
        "gcxform/emit/templates.py",
        "elif self.key.role not in (Role.MIDDLE, Role.LAST):\n            self._statement",
        "else:\n            self._statement",
        "tests/test_corpus.py",
    ),
    Mutation(
        "what a macro may have set is still known",
        "gcxform/modal/computing.py",
        "if self.meaning.runs_macro and",
        "if False and",
        "tests/test_corpus.py",
    ),
    Mutation(
        "computed distances are not rounded to the increment",
        "gcxform/modal/pointless.py",
        "np.where(computed, rounded, np",
        "np.where(computed, value, np",
        "tests/test_expressions.py",
    ),
)
