"""The folders of a hot folder, and how a file goes from one to the next.

    DIR/NAME                 dropped by anybody
    DIR/.gcxform/claimed/    taken: one that is dropped under the same name meanwhile is another one
    OUT/.gcxform-.../NAME    the result, proved and whole, before it appears
    DIR/.gcxform/proofs/NAME its certificate
    DIR/.gcxform/ready/NAME  a note that the result is whole: where it is, and where it goes
    OUT/NAME                 the result: it is moved here, by which it is published
    DIR/done/NAME            the program, and its certificate beside it
    DIR/failed/NAME          a program that is refused, and why beside it

Every step is one rename, so that a process that is killed leaves one of these states behind. Who
comes next reads them: a note whose result has gone from its first place was published, and is not
published again; what is claimed and has no note is done anew, for nobody has seen a result of it.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import Final

from gcxform.cli.watching.whole_files import BESIDE
from gcxform.diagnostics import FileError, UsageError
from gcxform.system.files import sync_folder, write_atomically
from gcxform.values import dataclass

HIDDEN: Final = ".gcxform"
LONGEST: Final = 255  # bytes of a name that file systems take
TEXT, CERTIFICATE = BESIDE


@dataclass(frozen=True)
class Note:
    """That the result of a program is whole: where it is, where it goes, how the program is filed.

    `said` is the line that is said of it when it is done.
    """

    name: str
    staged: Path
    out: Path
    filed: str
    said: str


@dataclass(frozen=True)
class Folders:
    """The folders of a hot folder; `out` is where results go."""

    folder: Path
    out: Path

    @property
    def done(self) -> Path:
        """Where programs are put that were done."""
        return self.folder / "done"

    @property
    def failed(self) -> Path:
        """Where programs are put that were refused."""
        return self.folder / "failed"

    @property
    def claimed(self) -> Path:
        """Where programs are while they are worked on."""
        return self.folder / HIDDEN / "claimed"

    @property
    def ready(self) -> Path:
        """Where notes are of results that are whole."""
        return self.folder / HIDDEN / "ready"

    @property
    def proofs(self) -> Path:
        """Where certificates are before their programs are filed."""
        return self.folder / HIDDEN / "proofs"

    @property
    def lock(self) -> Path:
        """The file that the one watcher of a folder has locked."""
        return self.folder / HIDDEN / "lock"

    @cached_property
    def staged(self) -> Path:
        """Where results are before they appear: beside their place, a folder for each watcher."""
        digest = hashlib.sha256(os.fsencode(os.path.realpath(self.folder))).hexdigest()
        return self.out / f"{HIDDEN}-{digest[:8]}"

    def make(self) -> None:
        """Make what is not there. Raises FileError, and UsageError for places that cannot be."""
        if not self.folder.is_dir():
            raise FileError.one("GX901", f"there is no folder {self.folder} to be watched")
        out, hidden = (os.path.realpath(each) for each in (self.out, self.folder / HIDDEN))
        taken = {os.path.realpath(each) for each in (self.folder, self.done, self.failed)}
        if out in taken or Path(out).is_relative_to(hidden):
            message = f"results in {self.out} would be taken for programs, or for those done"
            raise UsageError.one("GX751", message, hint="-o with another folder")
        own = self.claimed, self.ready, self.proofs, self.staged
        for each in (self.out, self.done, self.failed, *own):
            try:
                each.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                reason = error.strerror or error
                raise FileError.one("GX902", f"cannot make the folder {each}: {reason}") from None

    # --- from one to the next ---

    def claim(self, name: str) -> bool:
        """Take a program; return whether it was there to be taken. Raises OSError."""
        try:
            os.rename(self.folder / name, self.claimed / name)
        except FileNotFoundError:
            return False
        return True

    def give_back(self, name: str) -> bool:
        """Put a program back where it was dropped, unless there is another one by now."""
        return moved(self.claimed / name, self.folder / name)

    def note(self, note: Note) -> None:
        """Write down that a result is whole. Raises FileError."""
        text = {"staged": str(note.staged), "out": str(note.out)}
        text |= {"filed": note.filed, "said": note.said}
        with write_atomically(self.ready / note.name) as put:
            put(json.dumps(text).encode())
        sync_folder(self.ready)

    def finish(self, note: Note) -> None:
        """Publish a result if that has not happened, and file its program. Raises OSError."""
        if note.staged.exists():
            os.replace(note.staged, note.out)
            sync_folder(note.out.parent)
        claimed, proof = self.claimed / note.name, self.proofs / note.name
        if proof.exists():
            os.replace(proof, self.done / beside(note.filed, CERTIFICATE))
        if claimed.exists() and not moved(claimed, self.done / note.filed):
            file_away(claimed, self.done)
        sync_folder(self.done)
        (self.ready / note.name).unlink(missing_ok=True)

    def notes(self) -> Iterator[Note]:
        """Yield the notes of programs that did not come to their end. Raises FileError, OSError."""
        for name in sorted(os.listdir(self.ready)):
            if name.startswith("."):
                (self.ready / name).unlink(missing_ok=True)  # never came to be a note
                continue
            try:
                said = json.loads((self.ready / name).read_bytes())
                yield Note(
                    name, Path(said["staged"]), Path(said["out"]), said["filed"], said["said"]
                )
            except (ValueError, KeyError, TypeError):
                message = f"the note {self.ready / name} is damaged"
                hint = f"look whether {self.out} has the result, then take the note away"
                raise FileError.one("GX901", message, hint=hint) from None

    def left_claimed(self) -> list[str]:
        """Return the programs that somebody has claimed who did not come to their end."""
        names = sorted(os.listdir(self.claimed))
        for name in names:
            if same_file(self.claimed / name, self.folder / name):  # it was being given back
                (self.claimed / name).unlink()
        return [name for name in names if (self.claimed / name).exists()]

    def sweep(self) -> None:
        """Take away what belongs to results that never became whole."""
        noted = {note.name for note in self.notes()}
        for folder in (self.staged, self.proofs):
            for name in set(os.listdir(folder)) - noted:
                (folder / name).unlink(missing_ok=True)

    def drop(self, name: str) -> None:
        """Take away what was made of a program that comes to nothing."""
        for folder in (self.staged, self.proofs):
            (folder / name).unlink(missing_ok=True)


def moved(source: Path, target: Path) -> bool:
    """Move a file to a name that nobody has; return whether it was free. Raises OSError.

    A name that the file has already, since somebody was stopped halfway, is free. Where a file has
    one name only it is renamed: systems have many numbers for that, and what else may be wrong
    keeps it from being renamed as well.
    """
    try:
        os.link(source, target)
    except FileExistsError:
        if not same_file(source, target):
            return False
    except OSError:
        if os.path.lexists(target):
            return False
        os.rename(source, target)
        return True
    os.unlink(source)
    return True


def same_file(one: Path, other: Path) -> bool:
    """Whether two names are of one file."""
    try:
        return os.path.samestat(os.lstat(one), os.lstat(other))
    except OSError:
        return False


def file_away(source: Path, folder: Path) -> str:
    """Move a file into a folder under a free name, and return that. Raises OSError."""
    while not moved(source, folder / (name := free_name(folder, source))):
        pass
    return name


def free_name(folder: Path, source: Path) -> str:
    """Return the name of a file for a folder: numbered if another one has it."""
    stem, ending = os.path.splitext(source.name)
    free, number = source.name, 1
    while os.path.lexists(folder / free) and not same_file(folder / free, source):
        number += 1
        free = f"{_cut(stem, LONGEST - len(os.fsencode(ending)) - 8)}.{number}{ending}"
    return free


def beside(name: str, ending: str) -> str:
    """Return the name of what is put beside a program; it begins with the program's."""
    return f"{_cut(name, LONGEST - len(ending))}{ending}"


def _cut(name: str, most: int) -> str:
    """Return as much of a name as there is room for, in bytes."""
    while len(os.fsencode(name)) > most:
        name = name[:-1]
    return name
