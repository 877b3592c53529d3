"""Keeps the calls and loops of a program in its output, where source and target have the same."""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.emit.emitter import Emitted
from gcxform.modal.inventory import Account
from gcxform.modal.state import Reading
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.text_passes import TextRun
from gcxform.proof.findings import Findings
from gcxform.syntax.source import Source
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.emit.folding import Folded
    from gcxform.emit.spelled import Spelled
    from gcxform.flow.walk import Walked


@dataclass
class Structure:
    """Gathers what is written for the blocks of one program, and folds it at its end.

    `why` is what had to be written out, in sentences.
    """

    plan: Plan
    given: Source
    source: Walked
    takes_stamps: bool
    parts: list[Emitted] = field(default_factory=list)
    why: tuple[str, ...] = ()

    @classmethod
    def of(cls, plan: Plan, given: Source, source: Source, takes_stamps: bool) -> Structure | None:
        """Return what keeps the structure of a program; None where it is written out."""
        if plan.structure != "keep" or plan.source is not plan.target:
            return None
        if source is given:
            return None
        from gcxform.flow.walk import Walked

        if not isinstance(source, Walked):
            return None
        return cls(plan, given, source, takes_stamps)

    @property
    def text(self) -> bytes:
        """All that was written for the blocks that are executed."""
        return b"".join(part.text for part in self.parts)

    @property
    def lines(self) -> Ints:
        """The block of each of its lines."""
        return np.concatenate([np.empty(0, np.int64), *(part.source for part in self.parts)])

    @property
    def lines_read(self) -> int:
        """How many lines the program has."""
        return self.source.walk.listing.own

    def fold(self) -> Folded | None:
        """Return the program with its structure; None where it is written out as a whole."""
        from gcxform.emit.definitions import beside
        from gcxform.emit.folding import WholeError, fold

        try:
            folded = fold(self._spelled(), self.takes_stamps)
            self._ask_text_passes(folded)
        except WholeError as why:
            self.why = (f"the whole program: {why}",)
            return beside(self._spelled(), self.takes_stamps)
        self.why = folded.why
        return folded

    def _spelled(self) -> Spelled:
        from gcxform.emit.spelled import Spelled

        return Spelled(
            self.source.walk, self.source.text, self.source.origin, self.text, self.lines
        )

    def _ask_text_passes(self, folded: Folded) -> None:
        """Raise WholeError where a pass that changes text does not take calls and loops."""
        from gcxform.emit.folding import WholeError

        run = TextRun(self.plan.text_passes, self.plan.target, self.source.name)
        try:
            run.edit(folded.text, list(folded.lines), True)
        except InputError as error:
            raise WholeError(error.diagnostics[0].message) from None

    def prove(self, folded: Folded, reading: Reading, account: Account, findings: Findings) -> None:
        """Check that a program executes what has been proved. Raises VerificationError.

        What was said of the executed blocks is said of the program then.
        """
        from gcxform.proof.structure import check_executed, check_kept, held_by

        target = self.plan.target
        proved = self._spelled().new(0, self.source.walk.blocks)
        written = Source.of_bytes(folded.text, self.given.name)
        written.folder, written.suffix = self.given.folder, self.given.suffix
        known = self.source if self._is_as_read(folded, reading) else None
        check_executed(written, folded.lines, proved, target, reading, known)
        gone = None if folded.whole else folded.gone
        check_kept(folded.text, self.source.walk, gone, self.given.name)
        held = held_by(folded.text, target)
        account.rule("definitions, calls and loops that are kept", held - account.output)
        account.output = held
        findings.output_line = self._line_in(folded, findings.output_line)

    def _is_as_read(self, folded: Folded, reading: Reading) -> bool:
        """Whether a program is the one that was read, and is executed on the same machine."""
        same = replace(self.plan.machine_reading, units=reading.units) == reading
        same &= self.plan.read_as is self.plan.target
        return same and b"".join(self.given.windows()) == folded.text

    def _line_in(self, folded: Folded, line: int) -> int:
        """Return the line of a program, from 1, for one of the text that was proved; 0 for none."""
        if not line:
            return 0
        of = int(self.source.origin[self.lines[line - 1]])
        return folded.lines.index(of) + 1 if of in folded.lines else 0
