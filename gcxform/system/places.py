"""Where a file lies, and which names no file can have, on systems that differ in both."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Final

_DEVICES: Final = re.compile(r"(CON|PRN|AUX|NUL|COM[1-9¹²³]|LPT[1-9¹²³]|CONIN\$|CONOUT\$) *", re.I)
"""The names of devices in every folder of Windows, whatever their ending (Microsoft, "Naming
Files, Paths, and Namespaces")."""
_NO_NAME: Final = re.compile(r'[<>:"|?*\x00-\x1f]')


def lies_in(path: str | Path, folder: str | Path) -> bool:
    """Whether a path, with its links followed, is a folder or lies in it.

    Folders are asked for what they are and not only for their letters: file systems of macOS and
    Windows take no notice of case, and Windows knows a place by several drives and shares.
    """
    real, root = Path(os.path.realpath(path)), os.path.realpath(folder)
    return any(_same_folder(str(each), root) for each in (real, *real.parents))


def _same_folder(one: str, other: str) -> bool:
    if os.path.normcase(one) == os.path.normcase(other):
        return True
    try:
        found, wanted = os.stat(one), os.stat(other)
    except OSError:
        return False
    return bool(wanted.st_ino) and os.path.samestat(found, wanted)  # 0: a share that has no numbers


def is_one_file(one: str, other: str) -> bool:
    """Whether two names of files that are there are of one file. Raises OSError.

    Some shares number a file by how its name is spelt: of two names that differ in their letters
    alone both are there, and their folder lists one of them.
    """
    if os.path.samefile(one, other):
        return True
    (folder, name), (beside, again) = os.path.split(one), os.path.split(other)
    if name == again or name.casefold() != again.casefold() or not lies_in(folder or ".", beside):
        return False
    return not {name, again} <= {*os.listdir(folder or ".")}


def why_no_name(path: Path) -> str:
    """Return why a file cannot have its name on this system, nothing if it can.

    Windows would write to a device, into a stream that is hidden behind another file, or under
    another name, and say nothing.
    """
    if sys.platform != "win32":
        return ""
    name = path.name
    if _DEVICES.fullmatch(name.partition(".")[0]):
        return f"{name} is the name of a device in Windows"
    if found := _NO_NAME.search(name):
        return f"Windows has no files with {found[0]!r} in their name"
    return "Windows would drop the point or the blank at its end" if name[-1:] in (".", " ") else ""


def is_trusted(path: Path) -> bool:
    """Whether a file belongs to this user or to the system. Raises OSError.

    Windows has no such owners: who may write where is a matter of its lists.
    """
    return not hasattr(os, "getuid") or os.stat(path).st_uid in (0, os.getuid())
