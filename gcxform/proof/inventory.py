"""Proves that what a program holds besides its moves is held by what was written for it.

Assignments: the same number of them, in order, in blocks of the same lines, and of two values v, w
|v - w| <= |v| 10^(1 - d), d the digits that the control keeps. What stands behind the end: the same
bytes, by SHA-256, if the dialect is the same. The rest is counted, in kinds
(`gcxform/modal/inventory.py`), on both sides. A value that only the machine knows is the same if it
is the same text.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field
from hashlib import sha256
from math import isnan

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.contract.passes import PassContext
from gcxform.diagnostics import Diagnostic, GcxformError, InputError, Location, VerificationError
from gcxform.dialect.arithmetic import Key
from gcxform.dialect.dialect import Dialect
from gcxform.flow.executed import Executed
from gcxform.modal.expressions.value import written
from gcxform.modal.interpreter import Interpreted
from gcxform.modal.inventory import KINDS, Account, Tally, kind_of, nothing_held
from gcxform.modal.line_notes import Assigned, Assignments, WayHome
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.program_end import Ending
from gcxform.proof.trace import Trace
from gcxform.stamps.comment import without_lines
from gcxform.syntax.scan import Window
from gcxform.system.arrays import Ints
from gcxform.toolpath.path import Event, Form
from gcxform.values import dataclass

MESSAGE = "(...)"
Wrong = tuple[str, int, int]
"""What is wrong, the line of the source and the line of the output, both from 0."""


def assignments_differ(
    old: Assignments, new: Assignments, trace: Trace, context: PassContext
) -> Wrong | None:
    """Return what is wrong with the parameters that a window sets; None if nothing is.

    They get the same values, in order, in the blocks of the same lines: to as many digits as the
    control takes.
    """
    if context.source is not context.target:
        old = Assignments.of([each for each in old if _lasts(each.key, context)])
    known = context.target.flow_rule.arithmetic
    near = 10.0 ** (1 - known.digits) if known is not None else 0.0
    if not (old or new) or _same(old, new, trace, near):
        return None
    for before, after in zip(old, new, strict=False):
        line = trace.line_of(after.line)
        close = abs(before.value - after.value) <= abs(before.value) * near
        close |= isnan(before.value) and isnan(after.value)
        same = (before.line, before.key, before.text) == (line, after.key, after.text)
        if not same or not close:
            message = f"{_said(before)} of the source became {_said(after)}, or moved"
            return message, before.line, after.line
    if len(old) == len(new):
        return None
    rest = [*old][len(new)] if len(old) > len(new) else [*new][len(old)]
    line = rest.line if len(old) > len(new) else trace.line_of(rest.line)
    return f"the assignment {_said(rest)} is missing or too many", line, 0


def _same(old: Assignments, new: Assignments, trace: Trace, near: float) -> bool:
    """Whether assignments with known values are the same, as columns."""
    if len(old) != len(new):
        return False
    close = np.abs(old.value - new.value) <= np.abs(old.value) * near  # nan is not
    return bool(
        close.all()
        and np.array_equal(new.named_by(old.names), old.which)
        and np.array_equal(trace.lines_of(new.line), old.line)
    )


def _lasts(key: Key, context: PassContext) -> bool:
    """Whether an assignment of the source has to stand in the output."""
    own, known = context.source.flow_rule.arithmetic, context.target.flow_rule.arithmetic
    acts = own is not None and own.acts(key)
    said = known is not None and known.can_say(key) and (own is None or own.owns(key))
    return context.source is context.target or acts or said


def _gone(what: str) -> str:
    return "a comment that is not executed" if what == MESSAGE else "left out"


def _said(one: Assigned) -> str:
    return one.text or f"{written(one.key)}={one.value:.10g}"


def not_taken(
    error: GcxformError, context: PassContext, file: str, text: Window, source: Ints
) -> GcxformError:
    """Return why the target would refuse the output, at the lines of the source.

    Of another control that is a refusal of the program: a code may not stand there beside what it
    may stand beside here. The control of the source took it, so there the writer is wrong.
    """
    found = []
    for each in error.diagnostics:
        line = max(each.where.line - 1 - text.first_line, 0) if each.where else 0
        written = text.line(line).decode("latin-1").strip() if line < len(text) else ""
        message = f"{context.target.name} would refuse what is written, {written!r}: {each.message}"
        where = Location(file, int(source[line]) + 1 if line < len(source) else 0)
        hint = "" if "[input]" in each.hint else each.hint  # that is said of another program
        hint = hint or (put_before("cutter-comp") if each.code == "GX230" else "")
        found.append(Diagnostic(each.code, message, where, hint))
    if isinstance(error, InputError) and context.source is not context.target:
        return InputError(tuple(found))
    return VerificationError(tuple(found))


@dataclass(frozen=True, slots=True)
class Written:
    """What an output is as a file, so far.

    held     what it holds, (kinds,)
    behind   the hash of what stands behind its end
    no_end   why the target would refuse it if it were over here; nothing if it would not
    """

    held: Ints = field(default_factory=nothing_held)
    behind: str = field(default_factory=lambda: sha256().hexdigest())
    no_end: str = ""


class Whole:
    """Is shown the windows of an output."""

    def __init__(self, target: type[Dialect]) -> None:
        self.ending = Ending(target)
        self.tally = Tally()
        self.behind = sha256()

    def add(self, window: Window, table: MeaningTable, live: int) -> Written:
        """Return what the output is with one more window, of which `live` lines are executed."""
        self.ending.look(window, table)
        self.tally.add(table, window.shape)
        self.behind.update(behind_end(window, live))
        wrong = "".join(each.message for each in self.ending.wrong)
        return Written(self.tally.total, self.behind.hexdigest(), wrong)


def behind_end(window: Window, live: int) -> bytes:
    """Return the text of a window behind the end of the program, where `live` lines are before.

    Stamps are left out: they are taken out and written anew, and have a proof of their own.
    """
    return without_lines(window.text[int(window.start[live]) :]) if live < len(window) else b""


class Others:
    """Looks for other programs behind the end of the one that is transformed.

    Its number is enough for a control to run one, while what LinuxCNC has behind an end is of that
    file alone.
    """

    def __init__(self, dialect: type[Dialect], file: str) -> None:
        self.looks = dialect.flow_rule.language == "macro-b"
        self.file = file
        self.tally = Tally()
        self.begins = -1

    def refuse_moving(self, window: Window, table: MeaningTable, live: int) -> None:
        """Raise InputError for one that moves: of a window, whose `live` lines are executed."""
        shape = window.shape[live:]
        if not self.looks or not len(shape):
            return
        moves = self.tally.lines(table, shape, "motions")
        if self.begins < 0:
            begins = self.tally.lines(table, shape, "definitions")
            if not len(begins):
                return
            self.begins = int(begins[0]) + live + window.first_line
            moves = moves[moves > begins[0]]
        if len(moves):
            message = "a program begins here that this one does not call: it would stay as it is"
            hint = "what steps do to positions is said of a whole file: give it a file of its own"
            raise InputError.one("GX226", message, Location(self.file, self.begins + 1), hint)


class Books:
    """Keeps account of what the windows of a source hold, and closes it with the output's.

    `executed` is what its calls and loops have done, if it has any: they set parameters too.
    """

    def __init__(
        self, context: PassContext, switches: frozenset[str], executed: Executed | None
    ) -> None:
        self.context = context
        self.executed = executed
        self.switches = switches
        self.crossing = context.source is not context.target
        self.held, self.behind, self.live, self.skipped = Tally(), Tally(), Tally(), Tally()
        self.set_aside = self.done = self.inner = self.given = self.rigid = 0
        self.assigned: list[tuple[Key, float]] = []
        self.text_behind = sha256()
        self.said: Counter[tuple[str, str]] = Counter()

    def add(self, window: Window, table: MeaningTable, read: Interpreted, given: int) -> None:
        """Take a window of the source into account; `given` are blocks that the user adds."""
        self.held.add(table, window.shape)
        self.live.add(table, window.shape[: read.live])
        self.behind.add(table, window.shape[read.live :])
        live = window.shape[: read.live]
        self.skipped.add(table, live[live != read.shape])
        if self.crossing:
            self.set_aside += sum(not _lasts(each.key, self.context) for each in read.assigned)
        self.text_behind.update(behind_end(window, read.live))
        events = read.path.events
        ways = {n + window.first_line: to for n, to in read.homed.items()}
        self._say(events, [each.text for each in read.unknown], ways)
        self.done += sum(event.what in self.switches for event in events)
        self.given += given
        if self.context.saying.makes_taps_rigid:
            self.rigid += int((read.path.form == Form.SYNCHRONISED).sum()) // 2
        self.inner += given + sum(event.within for event in events)
        if self.executed is not None:
            self.assigned += [(each.key, each.value) for each in read.assigned]

    def _say(
        self, events: Sequence[Event], unknown: Sequence[str], ways: Mapping[int, WayHome]
    ) -> None:
        """Take note of what the target says otherwise, or not at all; `ways` are home, by line.

        What only the machine can compute, `unknown`, is an event besides that of its block.
        """
        saying = self.context.saying
        if saying.crosses or saying.drop or saying.m_codes:
            named = [self._named(event, ways.get(event.line)) for event in events]
            self.said += Counter(each for each in named if each[0] != each[1])
            told = [text for text in unknown if text[0] in "(;" and not saying.instead(text)]
            self.said -= Counter({(MESSAGE, ""): len(told)})

    @property
    def sentences(self) -> list[str]:
        """What the target says otherwise, or not at all, and how often."""
        target = self.context.target.name
        return [
            f"{what} is {f'said as {said}' if said else _gone(what)} for {target}: {count}"
            for (what, said), count in self.said.items()
        ]

    def _named(self, event: Event, way: WayHome | None) -> tuple[str, str]:
        """Return an event of the source with its words, and what stands for it."""
        saying = self.context.saying
        if way is not None and way.code == event.what and saying.moves_home(*way.asked):
            return event.what, saying.machine
        if event.what[0] in "(;":
            return MESSAGE, saying.instead(event.what) and MESSAGE
        taken = "".join(address for address, _ in event.values)
        said = " ".join(
            filter(None, (saying.instead(event.what), saying.words_of(event.what, taken)))
        )
        return " ".join(filter(None, (event.what, taken))), said

    def _account_said(self, account: Account) -> None:
        """Let the account have what is said otherwise, or left out, by its name."""
        dialects = self.context.source, self.context.target
        for (what, said), count in self.said.items():
            rule = f"{what} is {said or 'left out'} in {self.context.target.name}"
            for name, dialect, sign in ((what, dialects[0], -1), (said, dialects[1], 1)):
                if kind := kind_of(name.split(" ")[0], dialect):
                    account.rule_of(rule, kind, sign * count)

    def close(self, output: Written, path_modes: int) -> tuple[Account, str]:
        """Return the account, and what is wrong with it: nothing if it balances.

        `path_modes` of the output stand around cycles, as the proof of the moves has found.
        """
        source, target = self.held.total, self.context.target.name
        account = Account(source, output.held)
        if self.executed is not None:
            account.source = self.executed.held
            self.executed.explain(account, source)
        if self.crossing:
            account.rule("behind the end of the program", -self.behind.total)
            account.rule("skipped because of a slash", -self.skipped.total)
            account.rule_of(f"no parameter of {target}", "assignments", -self.set_aside)
            if not self.context.target.program_rule.has_program_number:
                named = -self.live.total
                account.rule(f"no name of programs in {target}", named, ("definitions",))
        self._account_said(account)
        account.rule_of("done by a step instead of the control", "m_codes", -self.done)
        account.rule_of("M29 before taps that were G33.1", "m_codes", self.rigid)
        account.rule("moves cut, joined or written out by steps", account.rest, ("motions",))
        account.rule_of("G61 and G64 around cycles written out", "path_modes", path_modes)
        if self.inner:
            kinds = ("stops", "m_codes", *(("path_modes",) if self.given else ()))
            account.rule("cycles written out, and blocks that are given", account.rest, kinds)
        if not self.crossing and output.behind != self.text_behind.hexdigest():
            return account, "what stands behind the end of the program has changed"
        return account, self._wrong(account)

    def _wrong(self, account: Account) -> str:
        """Return why an account does not balance; nothing if it does."""
        for kind, count in zip(KINDS, account.rest.tolist(), strict=True):
            if count:
                how = "more" if count > 0 else "fewer"
                return f"the output has {abs(count)} {how} {kind} than the source accounts for"
        if self.executed is not None and not self.executed.agrees(self.assigned):
            return "the parameters that last are not those that the calls and loops have set"
        return ""
