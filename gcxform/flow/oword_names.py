"""What belongs to a call of LinuxCNC, and what its subprograms are called."""

from __future__ import annotations

import re

from gcxform.dialect.arithmetic import RS274, Key

LOCALS = RS274.local
"""The numbered parameters of a call."""
STANDS = (
    *(f"_{axis}" for axis in "xyzabcuvw"),
    "_imperial",
    "_metric",
    "_incremental",
    "_absolute",
)
STANDS += ("_inverse_time", "_units_per_minute", "_units_per_rev", "_feed", "_rpm")
"""The names that say where the axes stand, and what is in force; the last two are F and S."""

NAMES_POSITION = re.compile(
    rf"#[ \t]*(?:5[ \t]*4[ \t]*2|<[ \t]*(?:{'|'.join(STANDS)})[ \t]*>)", re.IGNORECASE
)
"""What names one of them, or a parameter of a position."""


def is_local(key: Key) -> bool:
    """Whether a parameter belongs to its call."""
    return not RS274.outlives(key)


def is_named_local(key: Key) -> bool:
    """Whether a parameter belongs to its call by M98, all rounds of it: a name does."""
    return isinstance(key, str) and is_local(key)


def name_of(label: str) -> str:
    """Return the name of a subprogram with a label."""
    return f"O{label}" if label.isdigit() else f"o<{label}>"
