"""Finds the files that a control would take for the subprograms of a program.

A program is a folder: what it calls stands in files beside it, or in folders that the user names.
Nothing outside of these is opened: a file is found among the names that a folder lists, so a name
that has a path in it finds none, and a link that leads out is refused.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path

from gcxform.dialect.program_rules import LookupRule
from gcxform.system import inputs
from gcxform.system.places import lies_in
from gcxform.values import dataclass

SHOWN = 3  # files that a message names


@dataclass(frozen=True, slots=True)
class Found:
    """A file with a subprogram: what messages call it, and its bytes."""

    name: str
    text: bytes


class LookupFailedError(Exception):
    """A file that may be meant cannot be taken; the sentence says why."""


class Folders:
    """The folders of one program, and what was found in them; `suffix` is that of the program.

    Names are looked at in the order of the rule of the dialect. All files that fit are read: of
    two that differ nobody knows which one the control has.
    """

    def __init__(self, folders: Sequence[Path], rule: LookupRule, suffix: str = "") -> None:
        self.folders = tuple(dict.fromkeys(folders))
        self.rule = rule
        self.suffix = suffix
        self._names: dict[Path, tuple[str, ...]] = {}

    def of_number(self, number: int) -> Iterator[Found]:
        """Yield the files whose names say a program number. Raises LookupFailedError."""
        yield from self._found([each.format(n=number) for each in self.rule.numbers])

    def of_name(self, name: str) -> Iterator[Found]:
        """Yield the files of a subprogram that is called by a name. Raises LookupFailedError."""
        yield from self._found([each.format(name=name) for each in self.rule.names])

    def _found(self, stems: Sequence[str]) -> Iterator[Found]:
        endings = dict.fromkeys((*self.rule.endings, *([self.suffix] * self.rule.own_ending)))
        wanted = {self._spelt(f"{stem}{ending}") for stem in stems for ending in endings}
        for folder in self.folders:
            inputs.note_search(folder, wanted)
            for name in self._listed(folder):
                if self._spelt(name) in wanted:
                    yield _read(folder, name)

    def _spelt(self, name: str) -> str:
        return name.casefold() if self.rule.any_case else name

    def _listed(self, folder: Path) -> tuple[str, ...]:
        """Return the names in a folder, in order. Raises LookupFailedError."""
        if folder not in self._names:
            try:
                self._names[folder] = tuple(sorted(os.listdir(folder)))
            except OSError as error:
                raise LookupFailedError(f"cannot read {folder}: {error.strerror}") from None
        return self._names[folder]


def _read(folder: Path, name: str) -> Found:
    """Return a file of a folder. Raises LookupFailedError for what is none, or leads out."""
    path = folder / name
    real = os.path.realpath(path)
    if not lies_in(real, folder):
        raise LookupFailedError(f"{path} is a link to a place outside of its folder")
    try:
        return Found(str(path), inputs.read(Path(real)))
    except OSError as error:
        raise LookupFailedError(f"cannot read {path}: {error.strerror or error}") from None


def only(found: Sequence[Found], what: str) -> Found | None:
    """Return the file that was found, None if none was; raises LookupFailedError if they differ."""
    if len({each.text for each in found}) > 1:
        names = " and ".join(each.name for each in found[:SHOWN])
        raise LookupFailedError(f"{what} stands in more than one file: {names}")
    return found[0] if found else None
