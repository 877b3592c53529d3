"""How a Fagor computes: what its operators and functions are worth.

Operators are those of 1.11 of the programming manual of the 8070 (Ref. 1709), p. 50; functions of
angles those of 13.4 of the 8055 M (V02.2x), p. 390. What no page says has no value: rounding below
zero and of halves, MOD of other than positive numbers, EXP and LOG, powers of powers, and an order
of numbers that are nearly the same.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable

from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.arithmetic import rules

NEAR = 1e-9
"""So near may two values be that the control takes for the same, or not so."""


def _power(a: float, b: float) -> float:
    if a < 0 and b != math.floor(b):
        raise v.NoValueError("a power of a negative number that is not whole")
    if a == 0 and b <= 0:
        raise v.NoValueError("0 has no such power")
    return float(a**b)


def _rest(a: float, b: float) -> float:
    if a < 0 or b <= 0:
        raise v.NoValueError("MOD of what is not positive: which sign is left is not known")
    return math.fmod(a, b)


def _from_zero(name: str, function: Callable[[float], float]) -> Callable[[float], float]:
    """Return a function that rounds, of numbers from zero on."""

    def rounded(a: float) -> float:
        if a < 0 and a != math.floor(a):
            raise v.NoValueError(f"{name} below zero: which way it rounds is not known")
        return float(function(a))

    return rounded


def _round(a: float) -> float:
    if abs(abs(a - math.floor(a)) - 0.5) <= NEAR:
        raise v.NoValueError("ROUND of a half: which way it rounds is not known")
    return float(math.floor(a + 0.5))


def _argument(x: float, y: float) -> float:
    """Return the angle of a point, from 0 to 360."""
    if not (x or y):
        raise v.NoValueError("ARG of two zeros has no value")
    return math.degrees(math.atan2(y, x)) % 360.0


FAGOR = rules(
    operators={
        "**": _power,
        "*": operator.mul,
        "/": v.RS274.operators["/"],
        "MOD": _rest,
        "+": operator.add,
        "-": operator.sub,
    },
    functions={
        "ATAN": lambda a: math.degrees(math.atan(a)),
        "ARG": _argument,
        "INT": _from_zero("INT", math.floor),
        "FRACT": _from_zero("FRACT", lambda a: a - math.floor(a)),
        "FUP": _from_zero("FUP", math.ceil),
        "ROUND": _round,
    },
)
"""What the language computes; `gcxform/modal/expressions/value.py` is what does it."""
NOT_CERTAIN = frozenset(("EXP",))
COUNTS = {"ARG": 2}
"""How many arguments functions take; the others take one."""


def holds(relation: str, a: float, b: float) -> bool:
    """Return whether a comparison holds. Raises NoValueError for what is near."""
    if a != b and abs(a - b) <= NEAR * max(1.0, abs(a), abs(b)):
        message = f"{a:.12g} and {b:.12g} are nearly equal: whether they are to the control"
        raise v.NoValueError(f"{message} is not known", "compare with a tolerance")
    return bool(RELATIONS[relation](a, b))


RELATIONS: dict[str, Callable[[float, float], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    ">=": operator.ge,
    "<=": operator.le,
    ">": operator.gt,
    "<": operator.lt,
}
