"""Writes a program whose positions became others in its own lines, in a language of its own.

Its blocks have been written one after the other, and go back into the lines that they are for
(`own_lines.py`). What is not executed stays. A line that becomes another each time it is executed
is written out with the smallest loop around it, or in the place of the call that leads there
(`unrolling.py`); what is set there is set there still. What comes out is read again and compared
with the blocks (`gcxform/proof/refolded.py`): where anything cannot be said so, the program is
written anew.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from operator import itemgetter
from pathlib import PurePath

from gcxform.emit.folding import Folded
from gcxform.emit.own_lines import OwnLines
from gcxform.emit.respelling import refusal, runs
from gcxform.emit.unrolling import Unit, Walk
from gcxform.flow.annexed import BYTE_ORDER_MARK, LINE_END
from gcxform.flow.translated import Translated
from gcxform.stamps.comment import OPEN_SEAL, is_stamp

SLASHED = "a slash: a switch decides on a line that has become another"
OTHERS = "this line would change, and stands in another program"
UNSAID = "what this line became cannot be said in its place"
CALLS = "what is called behind this line would be another"
DIFFERS = "this line becomes another each time it is executed"
SETS = "what this line sets cannot be said where it is written out"
ROUNDS = 12
"""So often more has to be written out, and then no more."""
Lines = tuple[tuple[str, int], ...]
"""Lines, each with the line, from 0, that it is for."""


def refolded(
    given: bytes, source: Translated, blocks: list[list[bytes]], seals: bool, takes_stamps: bool
) -> Folded:
    """Return a program for its blocks as they were written: lists of lines, by block.

    `seals`: a seal that is still open goes behind it; `takes_stamps`: its own stamps are taken out.
    Raises SpellingError where a line cannot be spelled, or would differ between its executions.
    """
    folding = _Refolding(source, blocks)
    folding.spell()
    return folding.joined(given, seals, takes_stamps)


class _Refolding:
    """One program whose blocks go back into its lines: `new` is what those become, by line."""

    def __init__(self, source: Translated, blocks: list[list[bytes]]) -> None:
        self.source, self.translator = source, source.translator
        self.whole = [each.decode("latin-1") for each in source.text.splitlines()]
        written = [[each.decode("latin-1").rstrip() for each in lines] for lines in blocks]
        self.stamps = [each for lines in written for each in lines if is_stamp(each)]
        self.written = [[each for each in lines if not is_stamp(each)] for lines in written]
        self.runs = [(int(source.visits[run[1]]), *run) for run in runs(source)]
        self.new: dict[int, Lines] = {}
        self.units: list[Unit] = []

    def spell(self) -> None:
        """Find what each line becomes. Raises SpellingError."""
        walk: Walk | None = None
        for _ in range(ROUNDS):
            wrong = self._round(walk)
            if not wrong:
                return self._check_slashed()
            walk = walk or Walk(self.source)
            more: list[Unit] = []
            for visit, why in wrong.items():
                if not more or visit > more[-1].end:
                    more.append(walk.unit(visit, why))
            self.units = walk.together([*self.units, *more])
        raise refusal(self.source, self.units[-1].first, UNSAID)

    def _check_slashed(self) -> None:
        """Refuse lines with a slash that have become others: a switch decides on these alone."""
        for line in self.translator.slashed():
            stays = ((self.source.lines[line], line),)
            if self.new.get(line, stays) != stays:
                raise refusal(self.source, line, SLASHED)

    def _round(self, walk: Walk | None) -> dict[int, str]:
        """Spell all lines; return executions that cannot stay in their place, and why."""
        lines = OwnLines(self.source, self.whole, self.written)
        self.new, wrong = {}, dict[int, str]()
        units = iter(sorted(self.units, key=lambda each: each.begin))
        unit, behind = next(units, None), 0
        for visit, line, first, stop in self.runs:
            if visit <= behind:
                continue
            if unit is not None and visit >= unit.begin:
                assert walk is not None
                self._write_out(walk, unit, lines)
                behind, unit = unit.end, next(units, None)
                if visit <= behind:
                    continue
            text = lines.spelled(line, first, stop)
            why = self._spell_one(text, line)
            if not why and len(text or ()) > 1 and visit in self.translator.called_behind:
                why = CALLS
            if why:
                wrong[visit] = self._named(line, why)
        return wrong

    def _named(self, line: int, why: str) -> str:
        file, number = self.translator.place_of(line)
        of = "" if file == self.source.name else f" of {PurePath(file).name}"
        return f"line {number}{of}: {why}"

    def _spell_one(self, text: tuple[str, ...] | None, line: int) -> str:
        """Take what an execution of a line becomes; return why that cannot be."""
        if text is None:
            return UNSAID
        if text != (self.source.lines[line],) and not self.translator.is_own(line):
            return OTHERS
        made = tuple((each, line) for each in text)
        return DIFFERS if self.new.setdefault(line, made) != made else ""

    def _write_out(self, walk: Walk, unit: Unit, lines: OwnLines) -> None:
        """Put what is executed in the place of the lines of a unit. Raises SpellingError."""
        first = bisect_left(self.runs, unit.begin, key=itemgetter(0))
        stop = bisect_left(self.runs, unit.end + 1, first, key=itemgetter(0))
        runs = {run[0]: run for run in self.runs[first:stop]}
        made: list[tuple[str, int]] = []
        own = frozenset(map(int, walk.lines[unit.begin : unit.end + 1]))
        for visit in range(unit.begin, unit.end + 1):
            line = int(walk.lines[visit])
            said, run = self.translator.sets(line, visit), runs.get(visit)
            if said is None:
                raise refusal(self.source, line, SETS)
            texts = () if run is None else lines.written_out(*run[1:], own)
            if texts is None:
                raise refusal(self.source, line, UNSAID)
            if run is not None and self.translator.stands_alone(line):
                said = []
            made += [(each, line) for each in (*said, *texts)]
        if made:
            made[0] = (self.translator.headed(unit.first, made[0][0]), made[0][1])
        for line in range(unit.first, unit.last + 1):
            self.new[line] = tuple(made) if line == unit.first else ()

    @property
    def why(self) -> Iterator[str]:
        """What is written out, and why, in sentences."""
        for unit in self.units:
            lines = f"line {unit.first + 1}, and what it calls"
            if unit.last > unit.first:
                lines = f"lines {unit.first + 1} to {unit.last + 1}"
            yield f"{lines}: {unit.why}"

    # --- the program ---

    def joined(self, given: bytes, seals: bool, takes_stamps: bool) -> Folded:
        """Return the program, and of each of its lines the one that it is for."""
        head = BYTE_ORDER_MARK if given.startswith(BYTE_ORDER_MARK) else b""
        ends = LINE_END.search(given)
        between = ends[0] if ends else b"\n"
        first, last = self.translator.margins()
        stamps = [each for text in self.stamps for each in self._comment(text)]
        seal = self._comment(f"({OPEN_SEAL})") if seals else []
        found, of, line = [head], list[int](), -1
        for line, (old, end) in enumerate(_lines_of(given[len(head) :])):
            margin = [*(stamps if line == first else ()), *(seal if line == last else ())]
            texts = [(each, line) for each in margin] + [*self._of_line(line, old, takes_stamps)]
            ended = [*[between] * (len(texts) - 1), end]
            found += [t.encode("latin-1") + e for (t, _), e in zip(texts, ended, strict=False)]
            of += [line for _, line in texts]
        if last > line and seal:
            found += [b"" if found[-1].endswith((b"\n", b"\r")) else between]
            found += [each.encode("latin-1") + between for each in seal]
            of += [of[-1] if of else 0] * len(seal)
        text = b"".join(found)
        if of != [*range(line + 1)]:
            text = self.translator.renumbered(text.decode("latin-1")).encode("latin-1")
        return Folded(text, tuple(of), (), tuple(self.why))

    def _of_line(self, line: int, old: str, takes_stamps: bool) -> Lines:
        if takes_stamps and is_stamp(old):
            return ()
        new = self.new.get(line, ((old, line),))
        return ((old, line),) if new == ((self.source.lines[line], line),) else new

    def _comment(self, text: str) -> list[str]:
        speller = self.translator.speller
        return speller("", False).lines(text) if speller is not None else []


def _lines_of(body: bytes) -> Iterator[tuple[str, bytes]]:
    """Yield lines and what ends each."""
    at = 0
    for end in LINE_END.finditer(body):
        yield body[at : end.start()].decode("latin-1"), end[0]
        at = end.end()
    if at < len(body):
        yield body[at:].decode("latin-1"), b""
