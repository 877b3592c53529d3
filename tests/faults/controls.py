"""Faults in the tables of the controls that people have, and in telling them from their kin."""

from __future__ import annotations

from faults.mutation import Mutation

TABLES = "plugins/gcxform_plugins/dialects/controls"
CASE = "tests/test_corpus.py::test_case[dialects/controls/{}]"


def _table(case: str, name: str, old: str, new: str, file: str = "grbls") -> Mutation:
    return Mutation(f"controls: {name}", f"{TABLES}/{file}.py", old, new, CASE.format(case))


MUTATIONS = (
    _table(
        "fluidnc-semicolon-in-parentheses",
        "FluidNC reads on behind `;` in brackets",
        "        semicolon_ends=True,\n",
        "",
    ),
    _table("fluidnc-long-line", "FluidNC counts no comments", "line_length=127", "line_length=200"),
    _table("grblhal-more-than-grbl", "turns are not counted", 'turns="P"', 'turns=""'),
    _table("grblhal-refused", "a switch is taken for off", 'delete=""', 'delete="execute"'),
    _table("grblhal-more-than-grbl", "G49 takes axes", "g49_takes_axes=False, ", ""),
    Mutation(
        "controls: a dialect is named beside its kin",
        "gcxform/guess.py",
        "if n not in kin or scores[n] >= others + ALIKE]",
        "if True]",
        "tests/test_guess.py",
    ),
    Mutation(
        "controls: a comment keeps the semicolon that ends a block",
        "gcxform/emit/expressible.py",
        'text = text.replace(";", ",")',
        "pass",
        CASE.format("fluidnc-comment-of-another"),
    ),
)
