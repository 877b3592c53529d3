"""Freed memory goes back to the system now and then, so that a long program takes no more of it.

No two windows have columns of quite the same sizes, so what the C library keeps of one fits the
next less and less well. Elsewhere than with the GNU library nothing is done.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable

WINDOWS = 16  # after so many; giving back and asking again takes time


def _trimming() -> Callable[[int], int] | None:
    try:
        trim: Callable[[int], int] = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):
        return None
    return trim


_TRIM = _trimming()


def give_back(window: int) -> None:
    """Give freed memory back if it is time to, after the window of that number."""
    if _TRIM is not None and window % WINDOWS == WINDOWS - 1:
        _TRIM(0)
