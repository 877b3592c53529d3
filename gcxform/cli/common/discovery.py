"""The pipeline of a folder: `gcxform.toml` beside a program, or above it, as linters look for it.

Looked at are the folder of the program and those above it, up to the root of a repository or the
home of the user, which are the last. What is found is said, so that nobody wonders where a program
went; a file that belongs to somebody else is refused, for it may have been left there to be found.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from gcxform.diagnostics import Location, UsageError
from gcxform.system.places import is_trusted

NAME: Final = "gcxform.toml"
ROOTS: Final = (".git", ".hg", ".svn")
"""What lies in the root of a repository."""


def pipeline_above(program: Path) -> Path | None:
    """Return the pipeline file of the folder of a program, None if there is none.

    A link is not followed: the folder is the one in which the program is named. Raises UsageError
    for a file that somebody else may have put there.
    """
    for folder in upwards(Path(os.path.abspath(program)).parent):
        found = folder / NAME
        if found.is_file():
            _check_owner(found)
            return _short(found)
    return None


def upwards(folder: Path) -> Iterator[Path]:
    """Yield a folder and those above it, until one that no folder above is a matter of."""
    home = os.path.realpath(os.path.expanduser("~"))
    for each in (folder, *folder.parents):
        yield each
        if os.path.realpath(each) == home or any((each / root).exists() for root in ROOTS):
            return


def _check_owner(found: Path) -> None:
    """Refuse a file of somebody who is neither this user nor the system."""
    if not is_trusted(found):
        message = f"{found} was found above the program, and belongs to somebody else"
        raise UsageError.one("GX750", message, Location(str(found)), f"-p {found} if it is meant")


def _short(found: Path) -> Path:
    """Return a path as seen from the current folder, where it is below that."""
    here = Path.cwd()
    return found.relative_to(here) if found.is_relative_to(here) else found
