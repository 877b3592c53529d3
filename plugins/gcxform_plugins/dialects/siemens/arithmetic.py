"""How a SINUMERIK computes: what its operators and functions are worth.

Comparisons are relative, to 1e-12 (Job planning 03/2006 p. 1-23); by MD10280 `<` and `>` may be
absolute, so that what differs by less has no order here. What the manuals leave open has no value:
MOD of other than positive whole numbers, ROUND of halves below zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.arithmetic import rules

RELATIVE = 1e-12
LARGEST = 2**31
ROUND = v.MACRO_B.functions["ROUND"]


def equal(a: float, b: float) -> bool:
    """Return whether two numbers are the same to the control."""
    return abs(a - b) <= RELATIVE * max(abs(a), abs(b))


def _ordered(compare: Callable[[float, float], bool]) -> v.Operator:
    def ordered(a: float, b: float) -> float:
        if a != b and equal(a, b):
            raise v.NoValueError("these differ by less than 1e-12 of them: MD10280 decides")
        return float(compare(a, b))

    return ordered


def _quotient(a: float, b: float) -> float:
    """Return the whole part of a quotient (NC programming p. 443)."""
    if b == 0:
        raise v.NoValueError("this divides by zero")
    found = a / b
    nearest = math.floor(found + 0.5)
    if found != nearest and equal(found, nearest):
        raise v.NoValueError(f"the last digit of {found:.10g} decides what DIV gives")
    return float(math.trunc(found))


def bits(a: float) -> int:
    """Return the whole number that bits are taken of. Raises NoValueError."""
    if a != math.floor(a) or not 0 <= a < LARGEST:
        raise v.NoValueError(f"bits of {a:.10g}: only those of whole numbers from 0 are known")
    return int(a)


def _upwards(a: float) -> float:
    return float(math.ceil(a))


def _within(low: float, high: float, value: float) -> float:
    if low > high:
        raise v.NoValueError("BOUND: the lower limit is above the upper one")
    return min(max(value, low), high)


SINUMERIK = rules(
    operators={
        "*": v.RS274.operators["*"],
        "/": v.RS274.operators["/"],
        "DIV": _quotient,
        "MOD": v.MACRO_B.operators["MOD"],
        "+": v.RS274.operators["+"],
        "-": v.RS274.operators["-"],
        "B_AND": lambda a, b: float(bits(a) & bits(b)),
        "B_XOR": lambda a, b: float(bits(a) ^ bits(b)),
        "B_OR": lambda a, b: float(bits(a) | bits(b)),
        "AND": lambda a, b: float(bool(a) and bool(b)),
        "XOR": lambda a, b: float(bool(a) != bool(b)),
        "OR": lambda a, b: float(bool(a) or bool(b)),
        "==": lambda a, b: float(equal(a, b)),
        "<>": lambda a, b: float(not equal(a, b)),
        ">=": lambda a, b: float(a > b or equal(a, b)),
        "<=": lambda a, b: float(a < b or equal(a, b)),
        ">": _ordered(lambda a, b: a > b),
        "<": _ordered(lambda a, b: a < b),
    },
    functions={
        "ATAN2": v.RS274.functions["ATAN/"],
        "POT": lambda a: a * a,
        "ROUND": ROUND,
        "ROUNDUP": _upwards,
        "TRUNC": lambda a: float(math.trunc(a)),
        "MINVAL": min,
        "MAXVAL": max,
        "BOUND": _within,
    },
)
"""What the language computes; `gcxform/modal/expressions/value.py` is what does it."""
COUNTS = {"ATAN2": 2, "MINVAL": 2, "MAXVAL": 2, "BOUND": 3}
"""How many arguments functions take; the others take one."""
