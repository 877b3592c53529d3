"""Where results go: files that appear whole or not at all, or stdout at the very end."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from gcxform.cli.common.answer import note_written
from gcxform.cli.common.request import excluding
from gcxform.diagnostics import FileError, UsageError
from gcxform.syntax.source import IN_MEMORY
from gcxform.system.files import write_atomically
from gcxform.system.places import is_one_file
from gcxform.system.stages import stage

STDOUT = "-"
Put = Callable[[bytes], object]


@contextmanager
def destination(name: str) -> Iterator[Put]:
    """Give a function that takes a result's bytes; they arrive when the block ends well.

    `-` is stdout. What is there and is no regular file, a pipe or a device, is written to and never
    replaced; a symbolic link stays, and the file it names is replaced. Raises FileError.
    """
    path = Path(name)
    if name != STDOUT and not (path.exists() and not path.is_file()):
        with write_atomically(Path(os.path.realpath(path))) as put:
            yield put
        note_written(name)
        return
    if path.is_dir():
        raise FileError.one("GX902", f"cannot write {name}: it is a directory")
    with tempfile.SpooledTemporaryFile(max_size=IN_MEMORY) as copy:
        yield copy.write
        copy.seek(0)
        _hand_on(copy, name)


def _hand_on(copy: IO[bytes], name: str) -> None:
    """Copy a finished result to stdout, a pipe or a device."""
    stage("")
    if name == STDOUT and sys.stdout is None:
        raise FileError.one("GX902", "cannot write stdout: it is closed")
    try:
        if name == STDOUT:
            shutil.copyfileobj(copy, sys.stdout.buffer)
            sys.stdout.buffer.flush()
        else:
            with open(name, "wb") as stream:
                shutil.copyfileobj(copy, stream)
    except BrokenPipeError:
        raise
    except OSError as error:
        place = "stdout" if name == STDOUT else name
        raise FileError.one("GX902", f"cannot write {place}: {error.strerror}") from None


def check_places(written: Mapping[str, str | None], read: Iterable[str | None]) -> None:
    """Raise UsageError if a file would be written that is read, or one place twice.

    `written` holds names of files by option; links of both kinds are seen through.
    """
    places = [(option, name) for option, name in written.items() if name]
    for option, name in places:
        for other in read:
            if other and STDOUT not in (name, other) and same(name, other):
                raise UsageError.one(
                    "GX727",
                    f"{option} {name} would overwrite {other}, which is read",
                    hint="write elsewhere",
                )
    for k, (option, name) in enumerate(places):
        for before, other in places[:k]:
            if name == other or same(name, other):
                raise excluding(f"{before} {other} and {option} {name}")


def same(name: str, other: str) -> bool:
    """Return whether two names are of one file that can be replaced, be it there or not."""
    if os.path.isfile(name) and os.path.exists(other):
        return is_one_file(name, other)
    return not os.path.exists(name) and os.path.realpath(name) == os.path.realpath(other)
