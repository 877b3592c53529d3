"""Files written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from gcxform.diagnostics import FileError


@contextmanager
def write_atomically(path: Path) -> Iterator[Callable[[bytes], object]]:
    """Give a function that takes the file's bytes; the file appears when the block ends well.

    The bytes go to a temporary file beside the place, which is flushed to disk and renamed. On any
    failure the destination is as it was. Permissions of a file that is replaced are kept. Raises
    FileError.
    """
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
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
            os.replace(temporary, path)
        except OSError as error:
            raise _cannot(path, error) from None
    finally:
        with suppress(OSError):
            temporary.unlink()


def _take_mode(path: Path, temporary: Path) -> None:
    """Give the new file the permissions of the old one, or the usual ones."""
    if path.exists():
        temporary.chmod(path.stat().st_mode & 0o7777)
    else:
        mask = os.umask(0)
        os.umask(mask)
        temporary.chmod(0o666 & ~mask)


def _cannot(path: Path, error: OSError) -> FileError:
    return FileError.one("GX902", f"cannot write {path}: {error.strerror or error}")
