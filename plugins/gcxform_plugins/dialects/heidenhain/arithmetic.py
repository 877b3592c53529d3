"""How a TNC computes: what its operators and functions are worth.

Numbers are IEEE doubles, angles degrees. What the manuals leave open has no value here: the sign of
0, a sign before a power, what is left of negative numbers, and values that are nearly the same.
"""

from __future__ import annotations

import math
import operator

from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.arithmetic import rules

NEAR = 1e-9
"""So near may two values be that the control takes for the same, by one simulator; or not so."""
LARGEST = 999_999_999.0  # TNC 640 1/2015, p. 631


def _rest(a: float, b: float) -> float:
    if a < 0 or b <= 0:
        raise v.NoValueError("% of what is not positive: which sign is left is not known")
    return math.fmod(a, b)


def _sign(a: float) -> float:
    if a == 0:
        raise v.NoValueError("SGN of 0 is 1 on some of these controls, and 0 on others")
    return math.copysign(1.0, a)


def _to(a: float, b: float) -> float:
    """Return the angle from the cosine axis, 0 to 360: a is opposite (TNC 640, p. 384)."""
    if not (a or b):
        raise v.NoValueError("ANG of two zeros has no value")
    return math.degrees(math.atan2(a, b)) % 360.0


def _decimal_logarithm(a: float) -> float:
    if a <= 0:
        raise v.NoValueError("only positive numbers have a logarithm")
    return math.log10(a)


TNC = rules(
    operators={
        "^": v.RS274.operators["**"],
        "*": operator.mul,
        "/": v.RS274.operators["/"],
        "DIV": v.RS274.operators["/"],
        "+": operator.add,
        "-": operator.sub,
        "LEN": math.hypot,
        "ANG": _to,
        "%": _rest,
    },
    functions={
        "ATAN": lambda a: math.degrees(math.atan(a)),
        "SQ": lambda a: a * a,
        "LOG": _decimal_logarithm,
        "NEG": operator.neg,
        "INT": lambda a: float(math.trunc(a)),
        "FRAC": lambda a: a - math.trunc(a),
        "SGN": _sign,
    },
)
"""What Klartext computes; `gcxform/modal/expressions/value.py` is what does it."""


def holds(relation: str, a: float, b: float) -> bool:
    """Return whether FN 9 to 12 jumps: EQU, NE, GT, LT. Raises NoValueError for what is near."""
    if a != b and abs(a - b) <= NEAR:
        message = f"{a:.12g} and {b:.12g} are nearly equal: whether they are to the control"
        raise v.NoValueError(f"{message} is not known")
    return {"EQU": a == b, "NE": a != b, "GT": a > b, "LT": a < b}[relation]
