"""What most languages compute alike: functions of degrees, and variables of their own."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from gcxform import vocabulary as v

ALIKE = {
    **{
        name: v.RS274.functions[name]
        for name in ("ABS", "ACOS", "ASIN", "COS", "EXP", "LN", "SIN", "SQRT")
    },
    "TAN": v.MACRO_B.functions["TAN"],
}


def rules(operators: Mapping[str, Any], functions: Mapping[str, Any]) -> v.Arithmetic:
    """Return how a language computes, whose variables its own reader keeps.

    `functions` stand beside those in ALIKE, or in place of them.
    """
    return v.Arithmetic(
        operators=operators,
        functions={**ALIKE, **functions},
        own=(),
        named=True,
        system=frozenset(),
        whole="",
        whole_slip=0.0,
    )
