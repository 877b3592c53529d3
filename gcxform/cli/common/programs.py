"""Programs as the command line names them: a file, or `-` for stdin."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gcxform.diagnostics import FileError
from gcxform.syntax.source import Source


@contextmanager
def opened(file: str) -> Iterator[Source]:
    """Give the source of a file, or of stdin for `-`. Raises FileError."""
    if file == "-" and sys.stdin is None:
        raise FileError.one("GX901", "cannot read stdin: it is closed")
    source = Source.copied(sys.stdin.buffer) if file == "-" else Source.open(Path(file))
    with source.stream:
        yield source
