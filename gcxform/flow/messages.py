"""Messages of LinuxCNC with the values of their parameters, as its interpreter prints them.

What is here was executed with the stand-alone interpreter. `(DEBUG,`, `(PRINT,` and `(LOG,` print
values, other comments that act do not. `%d`, `%f` and `%.3f` say how the values behind them are
printed, and are not printed themselves. A number is a parameter without blanks; what is nearer to
zero than 0.0001 is zero; a name that does not exist is `######`, and so is what takes 30 characters
or more: such a value is left to the control.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from gcxform.dialect.arithmetic import Key, NoValueError
from gcxform.modal.expressions.value import parameter_key
from gcxform.modal.meaning.printed import prints_values

PART = re.compile(r"#<[^<>]*>|#[0-9]+|%d|%f|%\.[0-9]f|%\.")
DECIMALS, OF_F = 6, 4
LONGEST = 1e18  # a value from here on may take 30 characters, with nine decimals
ZERO = 1e-4  # what is nearer to zero is printed as zero


def told(comment: str, value: Callable[[Key], float | None]) -> str:
    """Return a comment that prints values with the values in it.

    `value` returns None for a parameter that the control prints by itself: it then stands as it is.
    Raises NoValueError where the interpreter takes a format for something else.
    """
    if not prints_values(comment):
        return comment
    decimals = [DECIMALS]
    kept: list[str] = []

    def printed(found: re.Match[str]) -> str:
        part = found[0]
        if part == "%.":
            raise NoValueError("this format of a message is not resolved", code="GX206")
        if part.startswith("%"):
            decimals[0] = {"%d": 0, "%f": OF_F}.get(part) or int(part[2:3] or 0)
            return ""
        known = value(parameter_key(part))
        if known is None:
            kept.append(part if decimals[0] == DECIMALS else "")
            return part
        return _number(known, decimals[0])

    new = PART.sub(printed, comment)
    if PART.findall(new) != kept:
        message = "what this message prints behind its values is not resolved"
        raise NoValueError(message, "print each value by itself", "GX206")
    return new


def _number(value: float, decimals: int) -> str:
    return f"{0.0 if abs(value) < ZERO or math.isnan(value) else value:.{decimals}f}"
