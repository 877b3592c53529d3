"""Programs as the command line names them: files, folders of them, or `-` for stdin."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from gcxform.diagnostics import FileError
from gcxform.syntax.source import Source
from gcxform.system.places import lies_in

NO_PROGRAMS: Final = re.compile(
    r".*(\.(toml|json|csv|md|pdf|docx?|xlsx?|png|jpe?g|gif|bmp|svg|html?|zip|stl|ste?p|ig[es]+|dxf|dwg"
    r"|py|bak|tbl|ya?ml|xml|ini|cfg|log|tmp|temp|part|partial|filepart|crdownload|sw[op]|orig|lnk)"
    r"|~)",
    re.IGNORECASE | re.DOTALL,
)
"""Names of files in a folder that are none; what is named itself is read whatever its name is."""


def is_program(name: str) -> bool:
    """Whether a file of this name in a folder is taken for a program."""
    return not name.startswith(".") and NO_PROGRAMS.fullmatch(name) is None


def files_of(paths: Iterable[str]) -> list[Path]:
    """Return the files that are named, and those of folders; raises FileError for none.

    Hidden files and folders are left out, and what is named twice is taken once.
    """
    found: dict[str, Path] = {}
    for path in map(Path, paths):
        inside = list(_inside(path)) if path.is_dir() else [path]
        if not inside:
            raise FileError.one("GX901", f"there are no programs in {path}")
        for each in inside:
            found.setdefault(os.path.realpath(each), each)
    return list(found.values())


def _inside(folder: Path) -> Iterator[Path]:
    """Yield the programs of a folder and of those in it, by name; no links that lead out of it."""
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        for name in sorted(filter(is_program, files)):
            path = Path(place, name)
            if path.is_file() and lies_in(path, folder):
                yield path


@contextmanager
def opened(file: str, name: str = "") -> Iterator[Source]:
    """Give the source of a file, or of stdin for `-`; `name`: what messages call it.

    Raises FileError.
    """
    if file == "-" and sys.stdin is None:
        raise FileError.one("GX901", "cannot read stdin: it is closed")
    if file == "-":
        source = Source.copied(sys.stdin.buffer, name or file)
    else:
        source = Source.open(Path(file), name)
    with source.stream:
        yield source
