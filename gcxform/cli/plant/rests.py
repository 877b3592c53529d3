"""What a result rests on: every file that was read for it, and every name that was looked for.

A result stands while all of that is as it was: the same bytes, and no other file under a name that
a subprogram was looked for by.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import field
from typing import Any, Self

from gcxform.cli.plant.stores import names_in, read_named
from gcxform.diagnostics import GcxformError
from gcxform.system.inputs import Visit
from gcxform.values import dataclass

MISSING = ""


@dataclass(frozen=True)
class Rests:
    """Files with their hashes (SHA-256), and for folders the names found of those looked for.

    `searched` has for a folder the names that were looked for and those of them that were there,
    in small letters: controls differ in whether these are names of one file.
    """

    files: dict[str, str] = field(default_factory=dict)
    searched: dict[str, list[list[str]]] = field(default_factory=dict)

    @classmethod
    def of(cls, visit: Visit, called: Any = str) -> Self:
        """Return what was read and looked for in a visit; `called` says how files are named."""
        files = {called(path): digest for path, digest in visit.digests.items()}
        searched = {}
        for folder, wanted in visit.searched.items():
            name = called(folder)
            searched[name] = [sorted(wanted), sorted(wanted & _small(names_in(folder)))]
        return cls(files, searched)

    def __or__(self, other: Rests) -> Rests:
        """Return what rests on both."""
        return Rests({**self.files, **other.files}, {**self.searched, **other.searched})

    def described(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {"files": self.files, "searched": self.searched}


def _small(names: Iterable[str]) -> set[str]:
    return {name.casefold() for name in names}


def digest(data: bytes) -> str:
    """Return the hash of some bytes."""
    return hashlib.sha256(data).hexdigest()


@dataclass
class Present:
    """What is there now; each file is read once, and each folder."""

    files: dict[str, str] = field(default_factory=dict)
    folders: dict[str, set[str]] = field(default_factory=dict)

    def digest(self, name: str) -> str:
        """Return the hash of a file or URL, nothing if it cannot be read."""
        if name not in self.files:
            try:
                self.files[name] = digest(read_named(name))
            except (OSError, GcxformError):
                self.files[name] = MISSING
        return self.files[name]

    def _names(self, folder: str) -> set[str]:
        if folder not in self.folders:
            self.folders[folder] = _small(names_in(folder))
        return self.folders[folder]

    def carries(self, rests: Rests) -> bool:
        """Whether all that a result rests on is as it was."""
        try:
            return all(self.digest(name) == was for name, was in rests.files.items()) and all(
                self._names(folder).intersection(wanted) == set(found)
                for folder, (wanted, found) in rests.searched.items()
            )
        except (OSError, GcxformError):
            return False
