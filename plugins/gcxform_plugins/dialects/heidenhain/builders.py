"""Cycles of the machine's builder, 300 to 399, of which a machine file says that one moves nothing.

What such a cycle does is in no manual of the control. It goes along as it stands; whether calls
behind it are of it, or of the cycle before it, is not known.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from gcxform_plugins.dialects.heidenhain.words import HEAD

INERT = "inert-cycle"
BUILDERS = range(300, 400)
SAID = "say inert-cycle = {} in [control], if it moves no axis"


def whose(number: int) -> str:
    """Return what a cycle is that is not read."""
    return f"a cycle of the {'builder' if number in BUILDERS else 'control'}"


def ways_out(number: int) -> tuple[str, ...]:
    """Return what may be said of a cycle that is not read."""
    return (SAID.format(number),) if number in BUILDERS else ()


def said_inert(number: int, control: Mapping[str, Any]) -> bool:
    """Return whether the machine file says that a cycle moves nothing."""
    return number in BUILDERS and number == control.get(INERT)


def said_again(lines: Sequence[str]) -> list[str]:
    """Return a statement of several lines without their numbers and comments."""
    bare = [HEAD.sub("", line.partition(";")[0], 1).rstrip(" \t~") for line in lines]
    last = len(bare) - 1
    return [f"{' ' * (k > 0)}{line}{' ~' * (k < last)}" for k, line in enumerate(bare)]
