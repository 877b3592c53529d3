"""What a watcher does with a program: each one exactly once, whatever ends the watcher."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import field
from pathlib import Path
from typing import Any, Final

from gcxform.cli.common.failures import reported
from gcxform.cli.common.findings import described
from gcxform.cli.common.several import Outcome
from gcxform.cli.common.transform import Job
from gcxform.cli.watching.folders import (
    TEXT,
    Folders,
    Note,
    beside,
    file_away,
    free_name,
)
from gcxform.cli.watching.whole_files import Look
from gcxform.diagnostics import Diagnostic, FileError, GcxformError, render_all, shown
from gcxform.stamps.chain import DONE
from gcxform.values import dataclass

SOON, LATE = 1.0, 60.0  # s: after which what could not be done is tried again, first and at most
UNREADABLE: Final = "GX901"
Runs = Callable[[Job], Outcome]


@dataclass(frozen=True)
class Told:
    """What became of a program: a line, and the same as plain values."""

    line: str
    values: dict[str, Any]
    findings: tuple[Diagnostic, ...] = ()
    exit_code: int = 0


@dataclass
class Work:
    """Takes programs, runs them, and files them.

    `runs` runs one, `checks` raises InputError for one that is not to be run, `said` makes the line
    about one that was, and `tell` says what became of it.
    """

    folders: Folders
    runs: Runs
    checks: Callable[[Path], None]
    said: Callable[[Outcome], str]
    tell: Callable[[Told], None]
    like: Job = field(default_factory=lambda: Job("", None, quiet=True))
    clock: Callable[[], float] = time.monotonic
    later: dict[str, tuple[float, float]] = field(default_factory=dict)
    left: dict[str, Look] = field(default_factory=dict)
    complaints: dict[str, str] = field(default_factory=dict)
    exit_code: int = 0

    @property
    def waits(self) -> bool:
        """Whether something could not be done yet."""
        return bool(self.later)

    def recover(self) -> None:
        """Bring to its end what a watcher before has begun. Raises FileError and OSError."""
        for note in list(self.folders.notes()):
            self._attempt(note.name)
        for name in self.folders.left_claimed():
            if name not in self.later:
                self._attempt(name)
        self.folders.sweep()

    def again(self) -> None:
        """Try once more what could not be done, where it is time."""
        for name, (due, _) in list(self.later.items()):
            if self.clock() >= due:
                self._attempt(name)

    def take(self, name: str) -> None:
        """Do a program that is whole; leave one alone that was done by this very pipeline."""
        path = self.folders.folder / name
        if name in self.later or self.left.get(name) == (look := Look.at(path)):
            return  # one of its name is not finished yet, or it is known
        if look is not None and self._is_done(path):
            self._leave(name, look)
            return
        try:
            taken = self.folders.claim(name)
        except OSError as error:
            self._complain(name, f"cannot be taken: {error.strerror or error}")
            return
        if taken:
            self._attempt(name)

    # --- one program ---

    def _is_done(self, path: Path) -> bool:
        try:
            self.checks(path)
        except GcxformError as error:
            return error.diagnostics[0].code == DONE
        return False

    def _leave(self, name: str, look: Look | None) -> None:
        if look is not None:
            self.left[name] = look
        self._tell(name, "done-before", "done already by this very pipeline, left alone")

    def _attempt(self, name: str) -> None:
        """Bring a program that is claimed to its end, or try later."""
        try:
            note = next((each for each in self.folders.notes() if each.name == name), None)
            if note is None:
                self._run(name)
            else:
                self._finish(note)
        except (FileError, OSError, MemoryError) as error:
            self._postpone(name, error)
            return
        self.later.pop(name, None)
        self.complaints.pop(name, None)

    def _run(self, name: str) -> None:
        """Run a claimed program. Raises FileError and OSError for what is not its fault."""
        claimed = self.folders.claimed / name
        before, filed = Look.at(claimed), free_name(self.folders.done, claimed)
        if before is None:
            return  # somebody has taken it away
        staged = self.folders.staged / name
        try:
            outcome = self.runs(self._job(name, claimed, staged))
        except (FileError, OSError, MemoryError) as error:
            if not _is_its_own(error):
                raise
            self._fail(name, error)
        except Exception as error:
            if isinstance(error, GcxformError) and error.diagnostics[0].code == DONE:
                self._give_back(name)
            else:
                self._fail(name, error)
        else:
            if Look.at(claimed) != before:  # whoever had it open has gone on
                self._give_back(name)
                return
            said = self.said(outcome)
            self._warn(filed, outcome)
            note = Note(name, staged, self.folders.out / name, filed, said)
            self.folders.note(note)
            self._finish(note, outcome)

    def _job(self, name: str, claimed: Path, staged: Path) -> Job:
        places = str(claimed), str(staged), str(self.folders.proofs / name)
        return Job(*places, verify=self.like.verify, quiet=True, name=shown(name))

    def _finish(self, note: Note, outcome: Outcome | None = None) -> None:
        """Publish what is whole. Raises OSError."""
        self.folders.finish(note)
        done = {} if outcome is None else outcome.described()
        self._tell(note.name, "written", note.said, done | {"output": str(note.out)})

    def _warn(self, filed: str, outcome: Outcome) -> None:
        """Write beside a program what is odd about it."""
        if outcome.done is not None and outcome.done.certificate.warnings:
            text = render_all(outcome.done.certificate.warnings) + "\n"
            place = self.folders.done / beside(filed, TEXT)
            place.write_text(text, "utf-8", "backslashreplace")

    def _fail(self, name: str, error: Exception) -> None:
        """File a program that is refused, with the reason beside it. Raises OSError."""
        claimed = self.folders.claimed / name
        text, code, findings = reported(error)
        self.folders.drop(name)
        filed = free_name(self.folders.failed, claimed)
        reason = self.folders.failed / beside(filed, TEXT)
        reason.write_text(text + "\n", "utf-8", "backslashreplace")
        filed = file_away(claimed, self.folders.failed)
        self.exit_code = max(self.exit_code, code)
        first = text.splitlines()[0]
        told = {"file": name, "state": "failed", "reason": str(reason)}
        self.tell(Told(f"{shown(name)}: failed   {first}", told, findings, code))

    def _give_back(self, name: str) -> None:
        """Put a program back; where another one of its name has come, put it to those done."""
        self.folders.drop(name)
        if not self.folders.give_back(name):
            file_away(self.folders.claimed / name, self.folders.done)

    # --- not now ---

    def _postpone(self, name: str, error: Exception) -> None:
        """Try a program again later: a disk is full, or a share has gone."""
        _, pause = self.later.get(name, (0.0, SOON / 2))
        pause = min(2 * pause, LATE)
        self.later[name] = self.clock() + pause, pause
        self._complain(name, f"not now   {reported(error)[0].splitlines()[0]}")

    def _complain(self, name: str, what: str) -> None:
        """Say once what keeps a program from being done."""
        if self.complaints.get(name) != what:
            self.complaints[name] = what
            self._tell(name, "waits", what)

    def _tell(self, name: str, state: str, what: str, values: dict[str, Any] | None = None) -> None:
        told = {**(values or {}), "file": name, "state": state}
        self.tell(Told(f"{shown(name)}: {what}", told))


def _is_its_own(error: Exception) -> bool:
    """Whether it is the program that cannot be read, and not the system that fails."""
    return (
        isinstance(error, FileError)
        and error.diagnostics[0].code == UNREADABLE
        and bool(error.diagnostics[0].hint)  # a limit is passed; all else is of the system
    )


def document(told: Told) -> dict[str, Any]:
    """Return what became of a program as a document of the verb."""
    said: dict[str, Any] = {"format": 1, "verb": "watch", "exit_code": told.exit_code}
    said["findings"] = [described(each) for each in told.findings]
    return {**said, "programs": [told.values]}
