"""The door for files that are read whole: pipelines, machines, error models, tables of data.

What comes through it is a regular file of some size, which did not change while it was read. Two
more things are known at the door, because every file passes it: which files a run has read, so that
none of them is overwritten by a result; and which of them the user has named, so that a file cannot
send the run to places where its user did not point it.
"""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import field
from typing import TYPE_CHECKING

from gcxform.diagnostics import Location, UsageError
from gcxform.system.limits import how_to_raise, limits
from gcxform.system.places import lies_in
from gcxform.values import dataclass

if TYPE_CHECKING:
    from pathlib import Path

STDIN = "/dev/stdin"  # a name for it, also where there is no such file
CHUNK = 1 << 20
UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
UTF16 = (
    "it is UTF-16, which > of PowerShell writes: -o FILE in the place of > FILE keeps bytes, "
    "and an editor saves it as UTF-8"
)
CHANGED = "it changed while it was read"
ALLOW = "copy it there, or say --allow-outside"


def is_utf16(head: bytes) -> bool:
    """Whether a text begins as UTF-16 does: with its mark, or with zeros in just each second byte.

    Zeros by themselves are the leader of a paper tape.
    """
    pairs = head[: len(head) // 2 * 2]
    high, low = pairs[1::2], pairs[::2]
    zeros = (all(low) and not any(high)) or (all(high) and not any(low))
    return head[:2] in UTF16_MARKS or (len(pairs) > 4 and zeros)


@dataclass
class Visit:
    """What came through the door for one command: who is who, and where they lie."""

    anywhere: bool = False
    read: set[tuple[int, int]] = field(default_factory=set)
    roots: set[str] = field(default_factory=set)  # folders that files may point into
    digests: dict[str, str] = field(default_factory=dict)  # of what was read, if they are `kept`
    searched: dict[str, set[str]] = field(default_factory=dict)  # folders: names looked for
    kept: bool = False


_VISIT: ContextVar[Visit | None] = ContextVar("visit", default=None)


@contextmanager
def visit(kept: bool = False, anywhere: bool = False) -> Iterator[Visit]:
    """Watch what is read until the block ends; outside of a visit files may name any others.

    What was allowed for a visit is allowed for those within it; `anywhere` allows it. `kept`: what
    was read is known afterwards by its hashes (SHA-256).
    """
    around = _VISIT.get()
    found = Visit(anywhere or (around is not None and around.anywhere), kept=kept)
    folder = os.path.realpath(os.curdir)
    if folder != os.path.dirname(folder):  # everything is inside of the root of the file system
        found.roots.add(folder)
    token = _VISIT.set(found)
    try:
        yield found
    finally:
        _VISIT.reset(token)


def allow_outside() -> None:
    """Let the files of this visit name others anywhere."""
    if (now := _VISIT.get()) is not None:
        now.anywhere = True


def is_anywhere() -> bool:
    """Whether the files of this visit may name others anywhere."""
    return (now := _VISIT.get()) is not None and now.anywhere


def is_read(path: Path) -> bool:
    """Whether a file was read through the door in this visit, under whatever name."""
    now = _VISIT.get()
    if now is None or not now.read:
        return False
    try:
        found = os.stat(path)
    except OSError:
        return False
    return (found.st_dev, found.st_ino) in now.read


def referred(folder: Path, name: str, where: Location | None) -> Path:
    """Return the path of a file that a file in a folder names, relative to it.

    Raises UsageError if it lies where the user has pointed to nothing; `where` it is named.
    """
    path = folder / name
    now = _VISIT.get()
    if now is None or now.anywhere:
        return path
    if not any(lies_in(path, root) for root in now.roots):
        message = f"{name!r} lies outside of the folder of the file that names it"
        raise UsageError.one("GX760", message, where, ALLOW)
    return path


def check_kind(path: Path) -> os.stat_result:
    """Raise OSError for what is no regular file, before anybody opens it: a pipe would wait."""
    found = os.fstat(0) if _is_stdin(path) else os.stat(path)
    if stat.S_ISDIR(found.st_mode):
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR))
    if not stat.S_ISREG(found.st_mode) and not _is_stdin(path):
        raise OSError(errno.EINVAL, f"it is {kind_of(found.st_mode)}, not a regular file")
    if found.st_size > limits().file_size:
        raise too_large()
    return found


def _is_stdin(path: Path) -> bool:
    return path.as_posix() == STDIN


def kind_of(mode: int) -> str:
    """Return what a file is that is not a regular one, in words."""
    kinds = {stat.S_IFIFO: "a pipe", stat.S_IFSOCK: "a socket", stat.S_IFDIR: "a directory"}
    return kinds.get(stat.S_IFMT(mode), "a device")


def too_large() -> OSError:
    """Return the error about a file that is larger than any of its kind."""
    what = f"it has more than {limits().file_size} bytes; {how_to_raise('file_size')}"
    return OSError(errno.EFBIG, what)


def read(path: Path) -> bytes:
    """Return the bytes of a file. Raises OSError, also for what is none, or changes meanwhile."""
    check_kind(path)
    waits = _is_stdin(path)
    handle = 0 if waits else os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    with open(handle, "rb", buffering=0, closefd=not waits) as stream:
        before = os.fstat(handle)
        parts, size = [], 0
        while chunk := stream.read(CHUNK):
            parts.append(chunk)
            size += len(chunk)
            if size > limits().file_size:
                raise too_large()
        if is_changed(before, os.fstat(handle), size):
            raise OSError(errno.EBUSY, CHANGED)
    data = b"".join(parts)
    _note(path, before, data)
    return data


def is_changed(before: os.stat_result, after: os.stat_result, size: int) -> bool:
    """Whether a regular file was written to while `size` bytes were read from it."""
    if not stat.S_ISREG(before.st_mode):
        return False
    same = before.st_mtime_ns == after.st_mtime_ns and before.st_ctime_ns == after.st_ctime_ns
    return not same or size != after.st_size


def note_search(folder: Path, names: Iterable[str]) -> None:
    """Remember which names were looked for in a folder, whether they are there or not."""
    if (now := _VISIT.get()) is not None and now.kept:
        now.searched.setdefault(str(folder), set()).update(name.casefold() for name in names)


def _note(path: Path, found: os.stat_result, data: bytes) -> None:
    """Remember what was read. What a file has named lies in a known folder; else the user has."""
    now = _VISIT.get()
    if now is None:
        return
    if now.kept:
        from hashlib import sha256

        now.digests[str(path)] = sha256(data).hexdigest()
    now.read.add((found.st_dev, found.st_ino))
    now.roots.add(os.path.dirname(os.path.realpath(path)))
