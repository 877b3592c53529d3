"""What ends a run from outside: an interrupt, a terminal that closes, a system that shuts down.

All three become an exception, so that temporary files go on the way out, as with any other error.
While modules are imported there is nothing to clean up, and an interrupt just ends the process.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

ENDING = tuple(
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")  # the last of Windows: Ctrl-Break
    if hasattr(signal, name)
)


class Ended(KeyboardInterrupt):
    """A run was ended by a signal; `exit_code` is what a shell shows for it."""

    def __init__(self, number: int) -> None:
        words = {"SIGTERM": "terminated", "SIGHUP": "hung up"}
        super().__init__(words.get(signal.Signals(number).name, "interrupted"))
        self.exit_code = 128 + number


@contextmanager
def ending() -> Iterator[None]:
    """Let signals end the block by an exception; those after the first do not disturb its end."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard = [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]
    before = {number: signal.getsignal(number) for number in heard}

    def end(number: int, _: object) -> None:
        for other in heard:
            signal.signal(other, signal.SIG_IGN)
        raise Ended(number)

    for number in heard:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def end_quietly() -> None:
    """Let an interrupt end the process without a traceback if the process is the command line."""
    script = os.path.basename(sys.argv[0]).partition(".")[0] == "gcxform" if sys.argv else False
    module = _named_module(sys.orig_argv) == "gcxform.cli"
    main = threading.current_thread() is threading.main_thread()
    if (script or module) and main and "click" not in sys.modules:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def _named_module(command: list[str]) -> str:
    """Return the module that Python was told to run, nothing if it was something else."""
    at = command.index("-m") if "-m" in command else len(command)
    return next(iter(command[at + 1 : at + 2]), "")
