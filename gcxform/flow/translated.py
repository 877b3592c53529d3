"""The blocks of a program in a language of its own, with the lines that they stand for."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import replace
from itertools import compress
from operator import itemgetter
from typing import Any

import numpy as np

from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import Dialect
from gcxform.flow.annexed import lines_of
from gcxform.flow.executed import WrittenOut
from gcxform.flow.translation import Translator, translator_of
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source
from gcxform.syntax.undecided import Undecided
from gcxform.system.arrays import Ints


class Translated(WrittenOut):
    """The blocks of a program in another language; what is said about them shows its lines.

    `text` is all blocks, `visits` (blocks,) the number of the execution of a line that each is of.
    """

    def __init__(
        self,
        source: Source,
        translator: Translator,
        text: bytes,
        origin: list[int],
        visits: Ints,
        lost: Mapping[int, str],
    ) -> None:
        files = tuple(translator.annexed.files) if translator.annexed is not None else ()
        lines, undecided = np.array(origin, np.int64), Undecided(lost=lost)
        super().__init__(source, text, lines, translator.assumed, files, undecided)
        self.lines = translator.lines
        self.translator = translator
        self.text = text
        self.visits = visits

    def frame_at(self, visit: int) -> Any:
        """Return the frame by which words of a line count in an execution; None without any."""
        at = bisect_right(self.translator.framed, visit, key=itemgetter(0))
        return self.translator.framed[at - 1][1] if at else None

    def executed_lines(self) -> Ints:
        """Return the line of each execution (visits,), those without blocks too; the first is 1.

        In place 0 there is none.
        """
        starts = [visit for visit, _ in self.translator.jumps]
        counts = np.diff([*starts, self.translator.visit])
        firsts = np.array([line for _, line in self.translator.jumps], np.int64)
        steps = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
        return np.concatenate([[-1], np.repeat(firsts, counts) + steps])

    def shown(self, where: Location) -> Location:
        """Return a place in the program, all of its line, for one in the blocks."""
        text = self.lines[self.line_of(where.line) - 1]
        start = len(text) - len(text.lstrip())
        width = max(1, len(text.strip()))
        file, line = self.place_of(where.line)
        return replace(where, file=file, line=line, column=start + 1, text=text, width=width)


def translated(source: Source, dialect: type[Dialect], reading: Reading) -> Translated:
    """Return the blocks of a program. Raises InputError where it is refused."""
    found, refused = translated_so_far(source, dialect, reading)
    if refused is not None:
        raise refused
    return found


def translated_so_far(
    source: Source, dialect: type[Dialect], reading: Reading
) -> tuple[Translated, InputError | None]:
    """Return the blocks of a program up to the line that is refused, and why it is."""
    whole = b"".join(source.windows())
    lines = lines_of(whole)
    if lines and not lines[-1]:
        lines.pop()
    beside = () if source.folder is None else (source.folder,)
    reading = replace(reading, subprograms=(*beside, *reading.subprograms))
    kind, stay = translator_of(dialect), frozenset[int]()
    while True:
        translator = kind([*lines], source.name, dialect, reading)
        translator.stay = stay
        blocks, origin, visits, lost, refused = _run(translator)
        if translator.again <= stay:
            break
        stay |= translator.again
    end = "\r\n" if lines[:1] and whole[len(lines[0]) :].startswith(b"\r\n") else "\n"
    joined = end.join([*blocks, ""]).encode("latin-1")
    made = Translated(source, translator, joined, origin, np.array(visits, np.int64), lost)
    return made, refused


def _run(
    translator: Translator,
) -> tuple[list[str], list[int], list[int], dict[int, str], InputError | None]:
    """Return blocks, their lines and executions, what is lost before them, and a refusal."""
    blocks: list[str] = []
    origin: list[int] = []
    visits: list[int] = []
    lost: dict[int, str] = {}
    try:
        for line, found in translator.run():
            if translator.loses_behind:
                translator.lose_behind()
            if translator.loses:
                lost[len(blocks)] = "".join(sorted(translator.loses))
                translator.loses.clear()
            whole = "" not in found
            blocks += found if whole else filter(None, found)
            if whole and len(found) == 1:  # there are many: two ranges take as long again
                origin.append(line)
                visits.append(translator.visit)
                continue
            lines = range(line, line + len(found))
            times = range(translator.visit - len(found) + 1, translator.visit + 1)
            origin += lines if whole else compress(lines, found)
            visits += times if whole else compress(times, found)
    except InputError as error:
        return blocks, origin, visits, lost, error
    return blocks, origin, visits, lost, None
