"""Faults of matching two paths without a map, and of saying how far they are apart."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_matching.py"
PROPERTY = "tests/properties/test_twins.py"


def _walk(name: str, old: str, new: str, tests: str = TESTS) -> Mutation:
    return Mutation(f"twins: {name}", "gcxform/deviations/matching.py", old, new, tests)


def _even(name: str, old: str, new: str) -> Mutation:
    return Mutation(f"twins: {name}", "gcxform/deviations/even_travel.py", old, new, TESTS)


def _apart(name: str, old: str, new: str) -> Mutation:
    return Mutation(f"twins: {name}", "gcxform/deviations/paired_pieces.py", old, new, TESTS)


def _compare(name: str, old: str, new: str) -> Mutation:
    return Mutation(f"twins: {name}", "gcxform/comparison.py", old, new, TESTS)


MUTATIONS = (
    _walk("nobody waits for a stub", "min(one, other) <= self.reach", "min(one, other) <= 0.001"),
    _walk("whole circles are left out", ", self.turn_left)", ", 0.0)"),
    _walk("the farther path waits", "(a, b) if one <= other", "(a, b) if one > other", PROPERTY),
    _walk("rows pair though one lags", "(late and pair", "(pair"),
    _walk("nobody fits partly", "_partly_apart if partly else _apart", "_apart"),
    _walk("everybody fits partly", "_partly_apart if partly else _apart", "_partly_apart"),
    _apart("a place of one path only is measured", "!= 0\n        entry", "> 2\n        entry"),
    _apart("a place of one path only is left out always", "if partly:", "if True:"),
    _apart(
        "what is unlike is the same", "nearer[unlike] = evenly", "nearer[unlike] = 0.0 * evenly"
    ),
    _even("the bend between parts is nothing", "bound += _bend", "bound += 0.0 * _bend"),
    _even("rotary axes do as they like", "rotary] != 0.0).any", "rotary] > 1e9).any"),
    _even("only the ends are looked at", "np.linspace(0.0, 1.0, PARTS + 1)", "(0.0, 1.0)"),
    _even("known and unknown are the same place", "np.isnan(gap), np.inf", "np.isnan(gap), 0.0"),
    _compare("what is not known is the same", "is None and not self.places", "is None"),
    _compare("B is said to be A", "{'AB'[who - 1]}", "{'BA'[who - 1]}"),
)
