"""Files written whole or not at all."""

from __future__ import annotations

import errno
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gcxform.diagnostics import FileError, UsageError
from gcxform.system.inputs import is_read
from gcxform.system.places import why_no_name

WRITABLE = 0o222  # nobody is to write it without one of these, not even the superuser by mistake
NAME_KEPT = 40  # characters of the name of a file that are in that of its temporary one
PAUSES = (0.05, 0.1, 0.2, 0.4)  # s; what looks at new files on Windows keeps them open so long


@contextmanager
def write_atomically(path: Path) -> Iterator[Callable[[bytes], object]]:
    """Give a function that takes the file's bytes; the file appears when the block ends well.

    The bytes go to a temporary file beside the place, which is flushed to disk and renamed. On any
    failure the destination is as it was. Permissions of a file that is replaced are kept; one that
    may not be written to is not replaced, nor is one that the run has read. Raises FileError, and
    UsageError for the latter.
    """
    import tempfile

    _check_replaceable(path)
    prefix = f".{path.name[:NAME_KEPT]}."
    try:
        handle, name = tempfile.mkstemp(prefix=prefix, suffix=".part", dir=path.parent)
    except OSError as error:
        raise _cannot(path, error) from None
    temporary = Path(name)
    try:
        try:
            with os.fdopen(handle, "wb") as stream:
                yield stream.write
                stream.flush()
                os.fsync(stream.fileno())
            _take_mode(path, temporary)
            _replace(temporary, path)
        except OSError as error:
            raise _cannot(path, error) from None
    finally:
        with suppress(OSError):
            temporary.unlink()


def _replace(temporary: Path, path: Path) -> None:
    """Give a file its name; on Windows that is refused while anybody has the other one open."""
    for pause in PAUSES if sys.platform == "win32" else ():
        try:
            os.replace(temporary, path)
            return
        except PermissionError:
            time.sleep(pause)
    os.replace(temporary, path)


def sync_folder(path: Path) -> None:
    """Have the names in a folder on the disk, where the system can be asked for that."""
    with suppress(OSError):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _check_replaceable(path: Path) -> None:
    """Refuse to replace a file that is read for this run, or that may not be written to."""
    if is_read(path):
        message = f"{path} would be overwritten, and it was read for this run"
        raise UsageError.one("GX727", message, hint="write elsewhere")
    if why_no := why_no_name(path):
        raise _cannot(path, OSError(errno.EINVAL, why_no))
    with suppress(FileNotFoundError):
        if not path.stat().st_mode & WRITABLE or not os.access(path, os.W_OK):
            why = OSError(errno.EACCES, "it is there, and may not be written to")
            raise _cannot(path, why)


def _take_mode(path: Path, temporary: Path) -> None:
    """Give the new file the permissions of the old one, or the usual ones."""
    if path.exists():
        temporary.chmod(path.stat().st_mode & 0o777)  # to run as another user is not ours to give
    else:
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)


def _cannot(path: Path, error: OSError) -> FileError:
    return FileError.one("GX902", f"cannot write {path}: {error.strerror or error}")
