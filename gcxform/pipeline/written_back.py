"""Writes programs in the language they were read in, where it is not one of words; proves them."""

from __future__ import annotations

from dataclasses import field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from gcxform.diagnostics import InputError, SpellingError
from gcxform.emit.emitter import Emitted
from gcxform.modal.inventory import Account
from gcxform.modal.state import Reading
from gcxform.pipeline.chain import facts_after
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.structure import Structure
from gcxform.proof.findings import Findings
from gcxform.stamps.chain import Marks
from gcxform.stamps.comment import sealed_anew, without_lines
from gcxform.syntax.source import Source, lines_in
from gcxform.toolpath.facts import ABSOLUTE, NO_CYCLES
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.emit.folding import Folded
    from gcxform.flow.speller import Speller
    from gcxform.flow.translated import Translated


WHOLE = "the whole program: "
COUNTED = "{} is not what a loop that is written out made of it: nothing may read it behind the end"


@dataclass
class WrittenBack:
    """Gathers what is written for the blocks of one program, and spells it at its end."""

    plan: Plan
    given: Source
    source: Translated
    marks: Marks
    parts: list[Emitted] = field(default_factory=list)
    why: tuple[str, ...] = ()

    @classmethod
    def of(cls, plan: Plan, given: Source, source: Source, marks: Marks) -> WrittenBack | None:
        """Return what writes a program in its own language; None where that is another's."""
        if plan.source is not plan.target or plan.source.translator is None:
            return None
        from gcxform.flow.translated import Translated

        if not isinstance(source, Translated):
            return None
        return cls(plan, given, source, marks)

    @property
    def lines_read(self) -> int:
        """How many lines the program has."""
        return self.source.translator.own

    def fold(self) -> Folded:
        """Return the program. Raises InputError where a line cannot be spelled."""
        from gcxform.emit.folding import Folded
        from gcxform.emit.respelling import counting_lines, refuse_kept, respelled
        from gcxform.proof.respelled import check_kept

        given, facts = b"".join(self.given.windows()), facts_after(self.plan.path_passes)
        refuse_kept(self.source, facts)
        counting, text = frozenset[int](), given
        if ABSOLUTE in facts:
            counting = counting_lines(self.source.translator)
        if counting or not self._stays:
            blocks: list[list[bytes]] = [[] for _ in self.source.origin]
            for part in self.parts:
                for line, block in zip(part.text.splitlines(), part.source.tolist(), strict=True):
                    blocks[block].append(line)
            written = [line for part in self.parts for line in part.text.splitlines()]
            check_kept(self.source, written, self.plan.target)
            text = respelled(given, self.source, blocks, counting)
        return Folded(text, tuple(range(lines_in(text) if text else 0)), (), ())

    def sealed(self, text: bytes) -> bytes:
        """Return a proved program with its seal: its stamps stay where they stand."""
        return sealed_anew(text) if self.marks.read.fits else text

    @property
    def _stays(self) -> bool:
        """Whether what was written for the blocks is what they were."""
        return b"".join(part.text for part in self.parts) == self.source.text

    def prove(self, folded: Folded, reading: Reading, account: Account, findings: Findings) -> None:
        """Check that a program says what has been proved. Raises GcxformError."""
        from gcxform.proof.respelled import check_respelled

        del account
        written = Source.of_bytes(folded.text, self.given.name)
        written.folder, written.suffix = self.given.folder, self.given.suffix
        blocks = [line for part in self.parts for line in part.text.splitlines()]
        known = self.source if self._is_as_read(folded, reading) else None
        check_respelled(written, blocks, self.plan.target, reading, known)
        if findings.output_line:
            of = [line for part in self.parts for line in part.source.tolist()]
            findings.output_line = self.source.line_of(of[findings.output_line - 1] + 1)

    def _is_as_read(self, folded: Folded, reading: Reading) -> bool:
        """Whether a program is the one that was read, byte for byte, and by the same machine."""
        same = replace(self.plan.machine_reading, units=reading.units) == reading
        return same and b"".join(self.given.windows()) == folded.text


@dataclass
class SpelledOut:
    """Gathers what is written for a control with a language of its own, and says it in that."""

    plan: Plan
    given: Source
    source: Source
    kind: type[Speller]
    marks: Marks
    parts: list[Emitted] = field(default_factory=list)
    why: tuple[str, ...] = ()
    told: tuple[str, ...] = ()
    back: Folded | None = None

    @classmethod
    def of(cls, plan: Plan, given: Source, source: Source, marks: Marks) -> SpelledOut | None:
        """Return what writes a program in another language; None where that is one of words."""
        kind = getattr(plan.target.translator, "speller", None)
        if kind is None or plan.copies:
            return None
        why = (f"{WHOLE}{plan.whole}",) if plan.whole else ()
        return cls(plan, given, source, kind, marks, why=why)

    @property
    def lines_read(self) -> int:
        """How many lines the program has."""
        return lines_in(b"".join(self.given.windows()))

    def fold(self) -> Folded:
        """Return the program, in its own lines where it can be.

        Raises InputError for a block that cannot be said.
        """
        if not self._goes_back:
            return self._spelled_out()
        try:
            self.back = self._in_its_lines()
            self.why = self.back.why
        except SpellingError as error:
            self.why = (f"{WHOLE}{told(error, self.given)}",)
            self.back = None
        return self.back or self._spelled_out()

    @property
    def _goes_back(self) -> bool:
        """Whether a program may come back in its own lines: it is written for its own control."""
        from gcxform.flow.translated import Translated
        from gcxform.flow.translation import Translator

        own = self.plan.machine_reading.asides and not self.plan.whole
        if not own or self.plan.structure != "keep" or not isinstance(self.source, Translated):
            return False
        return type(self.source.translator).changed_line is not Translator.changed_line

    def _in_its_lines(self) -> Folded:
        """Return the program in its own lines, compared with what is proved.

        Raises SpellingError where that is not possible.
        """
        from gcxform.emit.refolding import refolded
        from gcxform.emit.respelling import against_lines
        from gcxform.flow.translated import Translated
        from gcxform.proof.refolded import check_refolded

        assert isinstance(self.source, Translated)
        blocks: list[list[bytes]] = [[] for _ in self.source.origin]
        for part in self.parts:
            for line, block in zip(part.text.splitlines(), part.source.tolist(), strict=True):
                blocks[block].append(line)
        given = b"".join(self.given.windows())
        found = refolded(given, self.source, blocks, self._seals, bool(self.marks.read))
        reading = self.plan.reading_of_output(self.plan.machine_reading)
        written = Source.of_bytes(found.text, self.given.name)
        written.folder, written.suffix = self.given.folder, self.given.suffix
        reading = replace(reading, crosses=True)
        against = against_lines(self.source.translator, facts_after(self.plan.path_passes))
        lost = check_refolded(
            written, self._blocks, self.source, self.plan.target, reading, against
        )
        self.told = (COUNTED.format(", ".join(lost)),) if lost else ()
        return found

    def _spelled_out(self) -> Folded:
        """Return the program, written anew. Raises InputError for a block that cannot be said."""
        from gcxform.emit.folding import Folded
        from gcxform.emit.spelled_out import spelled_out

        self._refuse_apart()
        lines = [line for part in self.parts for line in part.source.tolist()]
        inch, anew = self.plan.first_units == "in", self.plan.machine_reading.asides
        text, of, left_out = spelled_out(
            self._blocks.splitlines(keepends=True),
            lines,
            self.kind,
            self.given.name,
            inch,
            self.plan.inert,
            anew,
            self._seals,
            not (anew and NO_CYCLES in facts_after(self.plan.path_passes)),
            self.plan.machine_reading.tool,
        )
        name = self.plan.target.name
        self.told = tuple(f"{code} is left out for {name}: {n}" for code, n in left_out.items())
        self.told += tuple(getattr(getattr(self.source, "translator", None), "anew", ()))
        own = [self.source.line_of(line + 1) - 1 for line in of]
        return Folded(text + self._others, (*own, *self._lines_of_others), (), ())

    def _refuse_apart(self) -> None:
        """Refuse lines that may stand in their place alone. Raises InputError."""
        from gcxform.emit.respelling import refusal
        from gcxform.flow.translated import Translated

        if not isinstance(self.source, Translated):
            return
        (anew, *_) = (*self.why, f"{WHOLE}structure = {self.plan.structure}")
        for line, why in self.source.translator.in_place.items():
            message = f"{why}, and the program is written anew: {anew.removeprefix(WHOLE)}"
            raise InputError(refusal(self.source, line, message).diagnostics)

    def sealed(self, text: bytes) -> bytes:
        """Return a proved program with the digits of its seal."""
        return sealed_anew(text, self.marks.seal) if self._seals else text

    @property
    def _lines_of_others(self) -> list[int]:
        """Lines of other programs in the file, in the same language, from 0."""
        from gcxform.flow.translated import Translated

        if not (self.plan.machine_reading.asides and isinstance(self.source, Translated)):
            return []
        return [line for other in self.source.translator.others for line in other]

    @property
    def _others(self) -> bytes:
        """These lines."""
        end = b"\r\n" if b"\r\n" in self._blocks else b"\n"
        lines = getattr(self.source, "lines", ())
        return b"".join(lines[k].encode("latin-1") + end for k in self._lines_of_others)

    @cached_property
    def _blocks(self) -> bytes:
        """What was written, which is asked for when all of it is there."""
        return b"".join(part.text for part in self.parts)

    @cached_property
    def _seals(self) -> bool:
        """Whether a seal is wanted: there is a stamp."""
        return self.marks.seal != "" and without_lines(self._blocks) != self._blocks

    def prove(self, folded: Folded, reading: Reading, account: Account, findings: Findings) -> None:
        """Check that a program is the one that has been proved. Raises VerificationError."""
        from gcxform.proof.spelled_out import check_spelled_out

        del account
        written = Source.of_bytes(folded.text, self.given.name)
        if self.back is None:
            known = replace(reading, crosses=True)
            check_spelled_out(written, self._blocks, self.plan.target, known)
        if findings.output_line:
            of = [line for part in self.parts for line in part.source.tolist()]
            line = self.source.line_of(of[findings.output_line - 1] + 1) - 1
            findings.output_line = next((k + 1 for k, n in enumerate(folded.lines) if n == line), 1)


def told(error: InputError, source: Source) -> str:
    """Return what an error says first, with its line."""
    (first, *_) = error.diagnostics
    if first.where is None or not first.where.line:
        return first.message
    file = "" if first.where.file == source.name else f" of {first.where.file}"
    return f"line {first.where.line}{file}: {first.message}"


def structure_of(
    plan: Plan, given: Source, source: Source, marks: Marks
) -> Structure | WrittenBack | SpelledOut | None:
    """Return what hands a program on as it was programmed; None where its blocks are written."""
    back = WrittenBack.of(plan, given, source, marks) or SpelledOut.of(plan, given, source, marks)
    return Structure.of(plan, given, source, bool(marks.read)) if back is None else back
