"""Relations between numbers in the conditions of macro B, null among them.

Null is equal to null alone, and counts as 0 where sizes are compared (Mitsubishi M700V manual,
which prints a table of it, and NCT 99M manual p. 173). Of other controls that is not known, and a
setting says whether null is equal to 0. Numbers that are almost equal are refused: a Fanuc compares
all digits of its doubles, and its manual asks programs to compare with a tolerance (B-63324EN p.
619).
"""

from __future__ import annotations

from collections.abc import Mapping

from gcxform.dialect.arithmetic import NoValueError, Operator
from gcxform.dialect.null import Null

NEAR = 1e-6
COMPARES = "null-compare"
DISTINCT, ZERO = "distinct", "zero"
HOW_NULL = f'{COMPARES} = "{DISTINCT}" in [control] of the machine file, or "{ZERO}"'


def same(a: float, b: float) -> bool:
    """Whether numbers are equal. Raises NoValueError for those that almost are."""
    if a != b and abs(a - b) < NEAR * max(1.0, abs(a), abs(b)):
        raise NoValueError("the numbers are almost equal: how the control compares is not certain")
    return a == b


def equal(a: float, b: float, said: str = DISTINCT) -> bool:
    """Whether two values are equal, null among them. Raises NoValueError where that is open.

    `said` is how null compares with 0: "distinct", "zero", or "" where that is not known.
    """
    nulls = [value for value in (a, b) if isinstance(value, Null)]
    if not nulls:
        return same(a, b)
    if len(nulls) == 2 and all(value.certain for value in nulls):
        return True
    if len(nulls) == 1 and float(a) != float(b):
        return False
    if said == ZERO:
        return True
    if len(nulls) == 1 and nulls[0].certain:
        if said == DISTINCT:
            return False
        raise NoValueError("whether null is equal to 0 is not certain", HOW_NULL)
    raise NoValueError("whether a value is null or 0 decides here, and it is not certain")


def relations(said: str) -> Mapping[str, Operator]:
    """Return the relations of conditions; `said` is how null compares with 0, as for `equal`."""
    return {
        **RELATIONS,
        "EQ": lambda a, b: float(equal(a, b, said)),
        "NE": lambda a, b: float(not equal(a, b, said)),
    }


RELATIONS: Mapping[str, Operator] = {
    "GT": lambda a, b: float(not same(a, b) and a > b),
    "GE": lambda a, b: float(same(a, b) or a > b),
    "LT": lambda a, b: float(not same(a, b) and a < b),
    "LE": lambda a, b: float(same(a, b) or a < b),
}
"""Those of sizes."""
