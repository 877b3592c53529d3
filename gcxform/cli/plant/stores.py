"""Where programs lie and results go: folders of this system, or URLs that fsspec knows.

What is stored appears under its name when it is whole. A program of a URL is copied with the
programs that lie beside it, for a program is a folder: what it calls may be among them.
"""

from __future__ import annotations

import os
import tempfile
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import Any, Final
from uuid import uuid4

from gcxform.cli.common.programs import files_of, is_program
from gcxform.diagnostics import FileError, UsageError
from gcxform.system.files import sync_folder
from gcxform.values import dataclass

SCHEME: Final = "://"
MOST_BESIDE: Final = 1 << 28
"""Bytes of a folder of a URL that are copied with a program of it."""


class Store(ABC):
    """A folder of results; names are relative to it, with slashes. Methods raise OSError."""

    @abstractmethod
    def read(self, name: str) -> bytes:
        """Return what is there. Raises FileNotFoundError."""

    @abstractmethod
    def write(self, name: str, data: bytes) -> None:
        """Put something there, whole or not at all, as far as the system stays on its feet."""

    @abstractmethod
    def staging(self, name: str) -> AbstractContextManager[str]:
        """Give the name of a file of this system; what is in it at the end is put there, safely."""

    @abstractmethod
    def move(self, name: str, to: str) -> None:
        """Give what is there another name, in place of what has it."""

    @abstractmethod
    def drop(self, name: str) -> None:
        """Take away what is there, if anything is."""

    @abstractmethod
    def names(self, folder: str) -> list[str]:
        """Return the names in a folder; none if it is not there."""


@dataclass(frozen=True)
class LocalStore(Store):
    """A folder of this system."""

    root: Path

    def read(self, name: str) -> bytes:
        """Return what is there. Raises OSError."""
        return (self.root / name).read_bytes()

    def write(self, name: str, data: bytes) -> None:
        """Put something there, whole or not at all. Raises OSError."""
        place = self._place(name)
        part = place.with_name(f"{place.name}.{uuid4().hex}.part")
        part.write_bytes(data)
        os.replace(part, place)

    @contextmanager
    def staging(self, name: str) -> Iterator[str]:
        """Give the name of the file: who writes into it sees to its bytes being on the disk."""
        yield str(self._place(name))

    def _place(self, name: str) -> Path:
        place = self.root / name
        place.parent.mkdir(parents=True, exist_ok=True)
        return place

    def move(self, name: str, to: str) -> None:
        """Give what is there another name, in place of what has it. Raises OSError."""
        place = self._place(to)
        os.replace(self.root / name, place)
        sync_folder(place.parent)

    def drop(self, name: str) -> None:
        """Take away what is there, if anything is. Raises OSError."""
        (self.root / name).unlink(missing_ok=True)

    def names(self, folder: str) -> list[str]:
        """Return the names in a folder; none if it is not there."""
        with suppress(FileNotFoundError):
            return sorted(os.listdir(self.root / folder))
        return []


@dataclass(frozen=True)
class RemoteStore(Store):
    """A folder of a file system of fsspec."""

    files: Any
    root: str

    def _at(self, name: str) -> str:
        return f"{self.root}/{name}"

    def read(self, name: str) -> bytes:
        """Return what is there. Raises OSError."""
        found: bytes = self.files.cat_file(self._at(name))
        return found

    def write(self, name: str, data: bytes) -> None:
        """Put something there under a name of its own, then under the one it gets."""
        part = self._at(f"{name}.{uuid4().hex}.part")
        self.files.makedirs(part.rpartition("/")[0], exist_ok=True)
        self.files.pipe_file(part, data)
        self.files.mv(part, self._at(name))

    @contextmanager
    def staging(self, name: str) -> Iterator[str]:
        """Give the name of a file that is copied there."""
        with tempfile.TemporaryDirectory(prefix="gcxform-") as folder:
            part = Path(folder, "part")
            yield str(part)
            if part.exists():
                self.write(name, part.read_bytes())

    def move(self, name: str, to: str) -> None:
        """Give what is there another name, in place of what has it."""
        self.files.makedirs(self._at(to).rpartition("/")[0], exist_ok=True)
        self.files.mv(self._at(name), self._at(to))

    def drop(self, name: str) -> None:
        """Take away what is there, if anything is."""
        with suppress(FileNotFoundError):
            self.files.rm_file(self._at(name))

    def names(self, folder: str) -> list[str]:
        """Return the names in a folder; none if it is not there."""
        with suppress(FileNotFoundError):
            found = self.files.ls(self._at(folder), detail=False, refresh=True)
            return sorted(str(each).rpartition("/")[2] for each in found)
        return []


def is_url(name: str) -> bool:
    """Whether a name is for fsspec, and none of this system."""
    return SCHEME in name


def store_of(root: str) -> Store:
    """Return the store of a folder or of a URL. Raises UsageError."""
    if not is_url(root):
        return LocalStore(Path(root))
    files, path = _of_url(root)
    return RemoteStore(files, path.rstrip("/"))


def _of_url(url: str) -> tuple[Any, str]:
    """Return the file system of a URL and the path in it. Raises UsageError and FileError."""
    try:
        import fsspec
    except ImportError:
        message = f"{url} is read and written by fsspec, which is not installed"
        raise UsageError.one("GX752", message, hint="pip install 'gcxform[dask]'") from None
    try:
        files, path = fsspec.core.url_to_fs(url)
    except (ImportError, ValueError) as error:
        raise UsageError.one("GX752", f"{url}: {str(error).partition(chr(10))[0]}") from None
    except Exception as error:  # whatever the file system of a URL says when it cannot be reached
        raise FileError.one("GX901", f"cannot reach {url}: {error}") from None
    return files, path


def programs_below(name: str) -> Iterator[tuple[str, str]]:
    """Yield the programs that a name stands for, each with its place below it. Raises FileError."""
    if not is_url(name):
        folder = os.path.isdir(name)
        for file in files_of([name]):
            place = file.relative_to(name) if folder else Path(file.name)
            yield str(file), place.as_posix()
        return
    files, root = _of_url(name)
    scheme = name.partition(SCHEME)[0] + SCHEME
    try:
        inside = sorted(files.find(root)) if files.isdir(root) else [root]
    except Exception as error:  # as above
        raise FileError.one("GX901", f"cannot read {name}: {error}") from None
    for path in inside:
        below = path.removeprefix(root).strip("/")
        hidden = any(part.startswith(".") for part in below.split("/"))
        if not below or (is_program(path.rpartition("/")[2]) and not hidden):
            yield scheme + path.removeprefix(scheme), below or path.rpartition("/")[2]


@contextmanager
def at_hand(program: str) -> Iterator[tuple[str, Callable[[str], str]]]:
    """Give the file in which a program is, and what says how files of its folder are called.

    Raises FileError.
    """
    if not is_url(program):
        yield program, str
        return
    with tempfile.TemporaryDirectory(prefix="gcxform-") as here:
        folder, _, name = program.rpartition("/")
        _copy_folder(folder, name, Path(here))
        real = os.path.realpath(here)

        def called(path: str) -> str:
            inside = os.path.realpath(path)
            rest = os.path.relpath(inside, real).replace(os.sep, "/")
            return path if rest.startswith("..") else folder if rest == "." else f"{folder}/{rest}"

        yield str(Path(here, name)), called


def _copy_folder(folder: str, program: str, here: Path) -> None:
    """Copy a program and the programs beside it. Raises FileError."""
    files, root = _of_url(folder)
    try:
        for each in files.ls(root, detail=True):
            name = str(each["name"]).rpartition("/")[2]
            beside = each["type"] == "file" and is_program(name)
            if name == program or (beside and (each.get("size") or 0) <= MOST_BESIDE):
                (here / name).write_bytes(files.cat_file(each["name"]))
    except Exception as error:  # whatever the file system of a URL says
        raise FileError.one("GX901", f"cannot read {folder}: {error}") from None
    if not (here / program).exists():
        raise FileError.one("GX901", f"cannot read {folder}/{program}: it is not there")


def read_named(name: str) -> bytes:
    """Return the bytes of a file or of a URL. Raises OSError, FileError and UsageError."""
    if not is_url(name):
        return Path(name).read_bytes()
    files, path = _of_url(name)
    found: bytes = files.cat_file(path)
    return found


def names_in(folder: str) -> list[str]:
    """Return the names in a folder or URL; none if it is not there."""
    if not is_url(folder):
        return LocalStore(Path(folder)).names("")
    files, path = _of_url(folder)
    return RemoteStore(files, path.rstrip("/")).names("")
