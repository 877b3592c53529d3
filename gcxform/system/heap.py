"""The memory of a long run: kept at hand between windows, and given back when it becomes more.

The columns of a window are as large as those of the one before, and what the C library gives back
to the system in between has to be cleared by it when it is asked for again, which takes a tenth of
the time of a run. But no two windows have columns of quite the same sizes, so what is kept of one
fits the next less and less well. Elsewhere than with the GNU library nothing is done.
"""

from __future__ import annotations

import ctypes
from typing import Any

FIRST = 8  # windows after which a run has about what it needs
MORE = 1.03  # of that; then it gives back what it does not use
# what `mallopt` calls them, and their values in bytes
TRIM_THRESHOLD, TOP_PAD, MMAP_THRESHOLD = -1, -2, -3
KEPT = {TRIM_THRESHOLD: 1 << 30, TOP_PAD: 4 << 20, MMAP_THRESHOLD: 32 << 20}


def _function(name: str) -> Any:
    """Return a function of the GNU C library; one that does nothing elsewhere."""
    try:
        return getattr(ctypes.CDLL(None), name)
    except (AttributeError, OSError, TypeError):
        return lambda *_: 0


def keep() -> None:
    """Let freed memory stay with this process, and with those that are copied from it."""
    for setting, size in KEPT.items():
        _function("mallopt")(setting, size)


class Heap:
    """Watches how much memory a process has from window to window."""

    def __init__(self) -> None:
        self.windows = self.needed = 0
        self._trim = _function("malloc_trim")

    def give_back(self) -> None:
        """Give freed memory back after a window, if there is more than was needed at first."""
        self.windows += 1
        if self.windows <= FIRST:
            self.needed = _resident()
        elif _resident() > MORE * self.needed:
            self._trim(0)


def _resident() -> int:
    """Return how many pages of memory this process has; 0 where the system does not say."""
    try:
        with open("/proc/self/statm", "rb") as sizes:
            return int(sizes.read().split()[1])
    except OSError:
        return 0
