"""How far a run is: on a terminal, once it takes long enough to wonder, or told to a host.

The graphical interfaces of LinuxCNC read lines `FILTER_PROGRESS=n` from what a filter writes to
stderr. QtVCP and Gmoccapy take one line every 100 ms, and what they have not read fills a pipe: so
no more is written than they read.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from gcxform.system.stages import heard

PATIENCE: Final = 0.5  # seconds
PACE: Final = 0.1  # seconds between two numbers
WIDEST: Final = 50  # characters of what is being done
_CLEAR: Final = "\r\x1b[K"


class Progress:
    """Counts bytes, and shows a percentage on stderr if that is a terminal."""

    def __init__(self, size: int, quiet: bool) -> None:
        self.size = size
        self.done = 0
        self.shown = False
        self._next = time.monotonic() + PATIENCE
        self._silent = quiet or sys.stderr is None or not self.heard() or not size

    def heard(self) -> bool:
        """Return whether anybody reads it."""
        return sys.stderr.isatty()

    def __call__(self, count: int) -> None:
        """Take note of bytes that are done."""
        self.done += count
        now = time.monotonic()
        if self._silent or now < self._next:
            return
        self._next = now + PACE
        self.shown = True
        self.show(min(100, 100 * self.done // self.size))

    def show(self, percent: int) -> None:
        """Write a number."""
        print(f"{_CLEAR}{percent:3d} %", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Take the number away."""
        if self.shown:
            print(_CLEAR, end="", file=sys.stderr, flush=True)


class Stages:
    """Shows on a terminal what a verb is at, of which nobody knows before how long it takes."""

    def __init__(self) -> None:
        self.shown = False
        self._next = time.monotonic() + PATIENCE

    def __call__(self, what: str, share: float | None) -> None:
        """Take note of what is being done, and of the share that is; of nothing: take it away."""
        if not what:
            self.close()
            return
        now = time.monotonic()
        if now < self._next:
            return
        self._next, self.shown = now + PACE, True
        text = "".join(c if c.isprintable() else "?" for c in what[-WIDEST:])
        percent = "" if share is None else f" {100 * min(share, 1.0):3.0f} %"
        print(f"{_CLEAR}{text}{percent}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Take it away."""
        if self.shown:
            print(_CLEAR, end="", file=sys.stderr, flush=True)
            self.shown = False


@contextmanager
def stages_shown(wanted: bool) -> Iterator[Stages | None]:
    """Show what is being done if that is wanted and stderr is a terminal."""
    if not wanted or sys.stderr is None or not sys.stderr.isatty():
        yield None
        return
    shown = Stages()
    try:
        with heard(shown):
            yield shown
    finally:
        shown.close()


class FilterProgress(Progress):
    """The same as a line for each number: AXIS, QtVCP and Gmoccapy show a bar."""

    def heard(self) -> bool:
        """Return that a host reads it."""
        return True

    def show(self, percent: int) -> None:
        """Write a number as a line."""
        print(f"FILTER_PROGRESS={percent}", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Leave the bar as it is: the host takes it away."""
