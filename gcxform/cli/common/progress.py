"""How far a run is, on a terminal, once it takes long enough to wonder."""

from __future__ import annotations

import sys
import time
from typing import Final

PATIENCE: Final = 0.5  # seconds
PACE: Final = 0.1  # seconds between two numbers
_CLEAR: Final = "\r\x1b[K"


class Progress:
    """Counts bytes, and shows a percentage on stderr if that is a terminal."""

    def __init__(self, size: int, quiet: bool) -> None:
        self.size = size
        self.done = 0
        self.shown = False
        self._next = time.monotonic() + PATIENCE
        self._silent = quiet or sys.stderr is None or not sys.stderr.isatty() or not size

    def __call__(self, count: int) -> None:
        """Take note of bytes that are done."""
        self.done += count
        now = time.monotonic()
        if self._silent or now < self._next:
            return
        self._next = now + PACE
        self.shown = True
        percent = min(100, 100 * self.done // self.size)
        print(f"{_CLEAR}{percent:3d} %", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Take the number away."""
        if self.shown:
            print(_CLEAR, end="", file=sys.stderr, flush=True)
