"""From what a command line names to jobs: which programs, and where each result goes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from gcxform.cli.common.outputs import STDOUT, check_places, same
from gcxform.cli.common.programs import files_of
from gcxform.cli.common.request import excluding
from gcxform.cli.common.transform import Job
from gcxform.diagnostics import FileError, UsageError
from gcxform.system.places import lies_in
from gcxform.values import dataclass

SEVERAL = "-o DIR, --in-place, --check or --diff"


@dataclass(frozen=True)
class Places:
    """Where results go: a file or a folder, the place of each program, or nowhere.

    With several programs, certificates and maps go to folders as well.
    """

    output: str | None = None
    in_place: bool = False
    nowhere: bool = False
    certificate: str | None = None
    source_map: str | None = None

    def jobs(self, files: Sequence[str], like: Job, read: Iterable[str | None]) -> list[Job]:
        """Return the jobs of programs, and of those in folders; `like` has the rest of each.

        Raises UsageError for places that cannot be; `read` are files that are not to be replaced.
        """
        if self.nowhere and (self.in_place or self.output):
            raise excluding(f"--check or --diff, which write nothing, and {self._written()}")
        if len(files) == 1 and not os.path.isdir(files[0]):
            jobs = [self._alone(files[0], like)]
        else:
            jobs = list(self._several(files, like))
            if not jobs:
                message = f"there are no programs but those in {self.output}, where results go"
                raise FileError.one("GX901", message, hint="name programs of another folder")
        for job in jobs:
            out = {} if self.in_place else {"-o": job.out}
            beside = {"--certificate": job.certificate, "--map": job.source_map}
            check_places({**out, **beside}, (job.file, *read))
        _check_apart(jobs)
        return jobs

    def _written(self) -> str:
        return "--in-place" if self.in_place else "-o"

    def _alone(self, file: str, like: Job) -> Job:
        """Return the job of one program. Raises UsageError."""
        beside = replace(like, certificate=self.certificate, source_map=self.source_map)
        if self.nowhere:
            return replace(beside, file=file, out=None)
        if self.in_place:
            if self.output is not None and not same(file, self.output):
                raise excluding("--in-place and -o")
            if file == STDOUT:
                raise excluding("--in-place and stdin")
            return replace(beside, file=file, out=file)
        out = self.output or STDOUT
        if file != STDOUT and (os.path.isdir(out) or out.endswith((os.sep, "/"))):
            out = os.path.join(out, os.path.basename(file))
            beside = replace(beside, makes_folders=True)
        return replace(beside, file=file, out=out)

    def _several(self, files: Sequence[str], like: Job) -> Iterator[Job]:
        """Yield the jobs of several programs. Raises UsageError."""
        if STDOUT in files:
            raise excluding("stdin and other programs")
        if self.in_place and self.output is not None:
            raise excluding("--in-place and -o")
        if not (self.nowhere or self.in_place or self.output):
            message = "several programs cannot all be written to stdout"
            raise UsageError.one("GX749", message, hint=SEVERAL)
        mine = [each for each in (self.output, self.certificate, self.source_map) if each]
        for name in mine:
            if os.path.exists(name) and not os.path.isdir(name):
                message = f"{name} is a file, and there are several programs"
                raise UsageError.one("GX749", message, hint="name a folder")
        self._check_elsewhere(files)
        for file, below in _named(files):
            if self.output is not None and lies_in(file, self.output):
                continue  # a result of an earlier run
            put = str(file) if self.in_place else _in(self.output, below)
            yield replace(
                like,
                makes_folders=True,
                file=str(file),
                out=None if self.nowhere else put,
                certificate=_in(self.certificate, below, ".json"),
                source_map=_in(self.source_map, below, ".map.json"),
            )

    def _check_elsewhere(self, files: Iterable[str]) -> None:
        """Raise UsageError for what is named and lies in the folder of the results."""
        for name in files:
            if self.output is not None and lies_in(name, self.output):
                message = f"-o {self.output} would overwrite {name}, which is read"
                raise UsageError.one("GX727", message, hint="write elsewhere, or --in-place")


def _named(files: Sequence[str]) -> Iterator[tuple[Path, Path]]:
    """Yield programs, each with its place below the folder that is named, or its name."""
    known = {os.path.realpath(file): Path(file) for file in files_of(files)}
    for name in files:
        for file in files_of([name]):
            if known.pop(os.path.realpath(file), None) is not None:
                folder = os.path.isdir(name)
                yield file, file.relative_to(name) if folder else Path(file.name)


def _in(folder: str | None, below: Path, ending: str = "") -> str | None:
    return None if folder is None else f"{os.path.join(folder, below)}{ending}"


def _check_apart(jobs: Iterable[Job]) -> None:
    """Raise UsageError where the results of two programs have one place."""
    places: dict[str, str] = {}
    for job in jobs:
        for name in (job.out, job.certificate, job.source_map):
            if name is None or name == STDOUT:
                continue
            first = places.setdefault(os.path.realpath(name), job.file)
            if first != job.file:
                message = f"{first} and {job.file} would both be written to {name}"
                raise UsageError.one("GX749", message, hint="run the folders one after the other")


def make_folders(job: Job) -> None:
    """Make the folders that the results of a job go to, if it asks for that. Raises FileError."""
    for name in (job.out, job.certificate, job.source_map) if job.makes_folders else ():
        folder = os.path.dirname(name) if name else ""
        try:
            if folder:
                os.makedirs(folder, exist_ok=True)
        except OSError as error:
            reason = error.strerror or error
            raise FileError.one("GX902", f"cannot make the folder {folder}: {reason}") from None
