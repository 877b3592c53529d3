"""AND, OR and XOR of macro B, and numbers in digits of four bits.

Where sources differ in what comes first, operands in brackets do not (`[[#1 EQ 1] AND [#2 GT 3]]`).
What is 0 or 1, as relations are, is worth the same by bits and as truth; of other numbers a Haas
takes the bits of their whole parts (96-8000 p. 116).
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from dataclasses import replace

from gcxform.dialect.arithmetic import Arithmetic, NoValueError, Operator

BRACKETED = "[]"
"""What stands behind the name of an operator that is known between brackets alone."""
BITS: Mapping[str, Callable[[int, int], int]] = {
    "AND": operator.and_,
    "OR": operator.or_,
    "XOR": operator.xor,
}
LARGEST = 2**31


def _of_truths(name: str) -> Operator:
    def logic(a: float, b: float) -> float:
        if {a, b} <= {0.0, 1.0}:
            return float(BITS[name](int(a), int(b)))
        message = f"{name} of other numbers than 0 and 1 is known in two ways"
        raise NoValueError(message, code="GX206")

    return logic


def _of_bits(name: str) -> Operator:
    def logic(a: float, b: float) -> float:
        if not (0 <= a < LARGEST and 0 <= b < LARGEST):
            raise NoValueError(f"{name} takes numbers from 0", code="GX206")
        return float(BITS[name](int(a), int(b)))

    return logic


def with_logic(arithmetic: Arithmetic, bits: bool = False) -> Arithmetic:
    """Return an arithmetic with AND, OR, XOR, BIN and BCD; `bits`: of any whole parts."""
    made = _of_bits if bits else _of_truths
    operators = {f"{name}{BRACKETED}": made(name) for name in BITS}
    functions = {"BIN": from_digits, "BCD": to_digits}
    return replace(
        arithmetic,
        operators={**arithmetic.operators, **operators},
        functions={**arithmetic.functions, **functions},
    )


def operator_of(arithmetic: Arithmetic, name: str, bracketed: bool) -> Operator | None:
    """Return what an operator is worth; `bracketed`: its operands stand by themselves."""
    found = arithmetic.operators.get(name)
    if found is None and bracketed:
        found = arithmetic.operators.get(f"{name}{BRACKETED}")
    return found


def from_digits(a: float) -> float:
    """Return the number whose decimal digits are those of four bits each: BIN of macro B."""
    digits = f"{_counted(a):x}"
    if not digits.isdecimal():
        raise NoValueError(f"{a:.10g} is no number in digits of four bits")
    return float(digits)


def to_digits(a: float) -> float:
    """Return a number with its decimal digits in four bits each: BCD of macro B."""
    return float(int(f"{_counted(a)}", 16))


def _counted(a: float) -> int:
    if not 0 <= a < 10**8 or a != int(a):
        raise NoValueError("this takes whole numbers from 0, of eight digits at most")
    return int(a)
