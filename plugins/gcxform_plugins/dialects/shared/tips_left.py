"""What ends the following of the tip where nothing follows it, in a program that is written anew.

The control may have followed the tip since before the program: it is said again as it stands, but
for a pass that reads such codes.
"""

from __future__ import annotations

from typing import Any


def goes_along(translator: Any) -> bool:
    """Whether the code that leaves the tip goes along, and stands for no block."""
    on = translator.dialect.m_codes.get(128)
    anew = translator.reading.asides and not translator.following
    return bool(anew and (on is None or not on.act.startswith("tip-")))
