"""What a caller of the Python API may pass: converted to what is meant, or refused by name.

A whole number where a float is meant, a numpy scalar or a tuple for a list are what people write,
and mean one thing. Anything else is an error at the door and never another result behind it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from gcxform.config.toml_text import did_you_mean
from gcxform.diagnostics import UsageError


def plain(value: object) -> Any:
    """Return a value without numpy: scalars and arrays as Python's own, tuples as lists."""
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist()) if isinstance(value, np.ndarray) else value.item()
    if isinstance(value, Mapping):
        return {plain(key): plain(each) for key, each in value.items()}
    return [plain(each) for each in value] if isinstance(value, list | tuple) else value


def _refused(what: str, expected: str, value: object) -> UsageError:
    return UsageError.one("GX702", f"{what}: expected {expected}, got {value!r:.80}")


def number(what: str, value: object) -> float:
    """Return a finite number; raises UsageError for anything else, truth values included."""
    value = plain(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _refused(what, "a number", value)
    try:
        found = float(value)
    except OverflowError:
        found = math.inf
    if not math.isfinite(found):
        raise _refused(what, "a number that is finite", value)
    return found


def positive(what: str, value: object) -> float:
    """Return a finite number above 0; raises UsageError."""
    found = number(what, value)
    if found <= 0:
        raise UsageError.one("GX706", f"{what}: {found:g} is not above 0")
    return found


def whole(what: str, value: object, most: int) -> int:
    """Return a whole number from 0 to `most`; raises UsageError."""
    value = plain(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise _refused(what, "a whole number", value)
    if not 0 <= value <= most:
        raise UsageError.one("GX706", f"{what}: {value} is not from 0 to {most}")
    return value


def flag(what: str, value: object) -> bool:
    """Return a truth value; raises UsageError."""
    value = plain(value)
    if not isinstance(value, bool):
        raise _refused(what, "True or False", value)
    return value


def chosen(what: str, value: object, choices: Collection[str]) -> str:
    """Return one of a few words; raises UsageError."""
    if not isinstance(value, str) or value not in choices:
        known = ", ".join(repr(choice) for choice in choices)
        words = [choice for choice in choices if choice]
        hint = did_you_mean(value, words) if isinstance(value, str) else ""
        raise UsageError.one("GX707", f"{what}: {value!r:.80} is not one of {known}", hint=hint)
    return str(value)


def table(what: str, value: object) -> dict[str, Any]:
    """Return a table with words for keys, without numpy; raises UsageError."""
    if not isinstance(value, Mapping) or not all(isinstance(key, str) for key in value):
        raise _refused(what, "a table by name", value)
    return dict(value)


def instance(what: str, value: object, kind: type | tuple[type, ...], expected: str) -> None:
    """Raise UsageError for a value that is not of a kind."""
    if not isinstance(value, kind):
        raise _refused(what, expected, value)
