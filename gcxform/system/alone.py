"""One process at a time: a lock on a file, which goes with the process however that ends."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def alone(path: Path) -> Iterator[int | None]:
    """Give the handle of a lock file, None if another process has it. Raises OSError.

    The lock is of the process and not of its children, so that one that outlives it keeps nobody
    out.
    """
    handle = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
    try:
        yield handle if _locked(handle) else None
    finally:
        os.close(handle)


def is_there(handle: int, path: Path) -> bool:
    """Whether a lock file is still the one of its name: its folder may have been put elsewhere."""
    try:
        return os.path.samestat(os.fstat(handle), os.stat(path))
    except OSError:
        return False


def _locked(handle: int) -> bool:
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def is_being_written(path: Path) -> bool:
    """Whether somebody has a file open to write into it, as far as the system tells.

    Linux gives a lease on files of one's own only if nobody has; on Windows a file that is open
    cannot be moved, so nothing has to be asked. What cannot be told is no.
    """
    if not sys.platform.startswith("linux"):
        return False
    import errno
    import fcntl

    try:
        handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW)
    except OSError:
        return False
    try:
        fcntl.fcntl(handle, fcntl.F_SETLEASE, fcntl.F_RDLCK)
        fcntl.fcntl(handle, fcntl.F_SETLEASE, fcntl.F_UNLCK)
    except OSError as error:
        return error.errno == errno.EAGAIN
    finally:
        os.close(handle)
    return False


def ignore_leases() -> None:
    """Let nobody who opens a file while it is asked about end the process."""
    if hasattr(signal, "SIGIO"):
        signal.signal(signal.SIGIO, signal.SIG_IGN)
