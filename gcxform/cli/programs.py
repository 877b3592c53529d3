"""Programs as the command line names them: a file, or `-` for stdin."""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, BinaryIO, cast

from gcxform.diagnostics import FileError
from gcxform.source import Source

IN_MEMORY = 1 << 24  # bytes of a spooled program or output; more goes to a temporary file


@contextmanager
def opened(file: str) -> Iterator[Source]:
    """Give the source of a file, or of stdin for `-`. Raises FileError.

    What can be read only once is copied first, because sources are read twice.
    """
    if file == "-":
        if sys.stdin is None:
            raise FileError.one("GX901", "cannot read stdin: it is closed")
        with spooled(sys.stdin.buffer) as copy:
            yield Source(copy)
        return
    source = Source.open(Path(file))
    with source.stream:
        if source.stream.seekable():
            yield source
            return
        with spooled(source.stream) as copy:
            yield Source(copy, file)


@contextmanager
def spooled(stream: IO[bytes]) -> Iterator[BinaryIO]:
    """Give a copy of a stream that can be read again."""
    with tempfile.SpooledTemporaryFile(max_size=IN_MEMORY) as copy:
        try:
            shutil.copyfileobj(stream, copy)
        except OSError as error:
            raise FileError.one("GX901", f"cannot read the program: {error.strerror}") from None
        copy.seek(0)
        yield cast(BinaryIO, copy)
