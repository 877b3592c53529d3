"""Several programs in one file, as they come from a tape or an archive: `%_N_NAME_MPF` begins each.

The control makes a file of each: the main program is executed, and the others are there to be
called. With more than one main program nobody knows which of them is meant. What others may call,
too, is not changed, as no file beside the program is.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.siemens.asides import LEFT_OUT
from gcxform_plugins.dialects.siemens.calls import Calls
from gcxform_plugins.dialects.siemens.cycles import KEPT

HEADER = re.compile(
    r"[ \t]*%(?:_N_)?(?P<name>[A-Z0-9_]+)_(?P<kind>[A-Z]{3})[ \t]*(?:;.*)?", re.IGNORECASE
)
MAIN, PROGRAMS = "MPF", ("MPF", "SPF")
DATA = "{} in the same file are data of the control, which are not read"
IDLE = "{} in the same file are not called, and stay as they are"
CALLED = "{} in the same file are written out where they are called, and stay as they are"
LEFT = "stay as they are", "are left out: they are programs of a SINUMERIK"
APART = "keep each program in its own file"


class Units(Calls):
    """Executes the main program of a file, and calls the others in it.

    units   name and kind of each, in capitals, and its lines, from its header on
    heads   where they begin, if there are several;  called: where those begin that are called
    """

    def __init__(self, lines: list[str], file: str, dialect: type[gx.Dialect], reading: Any):
        super().__init__(lines, file, dialect, reading)
        self.units = [*units_of(lines)]
        self.called: set[int] = set()
        self.heads: set[int] = set()
        if len(self.units) > 1:
            self.heads |= {lines.start for _, _, lines in self.units}
            self.main = next((u for _, kind, u in self.units if kind == MAIN), self.units[0][2])
            self.at = self.main.start
            self.others = tuple(u for _, _, u in self.units if u != self.main)
            self.annexing()
            self.lines.append("")

    def run(self) -> Iterator[tuple[int, Sequence[str]]]:
        """Yield blocks with the line that they are for. Raises InputError."""
        self._one_is_meant()
        yield from super().run()

    def _one_is_meant(self) -> None:
        """Refuse where it is not said which program is meant. Raises InputError."""
        if not self.units:
            return
        heads = [lines.start for _, kind, lines in self.units if kind == MAIN]
        first = self.units[0][2].start
        if self._has_code(range(first)):
            self._refuse(first, "here another program begins")
        if len(heads) > 1:
            self._refuse(heads[1], "here another main program begins")

    def _has_code(self, lines: Iterable[int]) -> bool:
        return any(item.kind != "comment" for line in lines for item in self.items(line))

    def _refuse(self, line: int, message: str) -> None:
        self.line = line
        raise self.refusal("GX223", message, None, APART)

    def is_own(self, line: int) -> bool:
        """Whether a line is one of the main program."""
        return line in self.main

    @property
    def finds_programs(self) -> bool:
        """Whether there is a place where subprograms may be."""
        return bool(self.heads) or super().finds_programs

    def called_file(self, name: str) -> range | None:
        """Return the lines of a subprogram, in this file or beside it; None without one."""
        beside = super().called_file(name)
        same = [u for other, kind, u in self.units if other == name.upper() and kind in PROGRAMS]
        if not same or same[0] == self.main:
            return beside
        here = range(same[0].start + 1, same[0].stop)
        if len(same) > 1 or (beside is not None and self._texts(beside) != self._texts(here)):
            raise self.refusal("GX227", f"there are two programs with the name {name}", None, APART)
        self.called.add(same[0].start)
        return here

    def _texts(self, lines: Iterable[int]) -> list[str]:
        return [text for line in lines if (text := self.lines[line].strip())]

    def executed(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a line; a header ends the program before it. Raises InputError."""
        if not any(item.kind == "header" for item in items):
            return super().executed(items)
        if self.line in self.heads - {self.main.start}:
            self.at_end()
        elif self._has_code(range(self.part.start, self.line)):
            self._refuse(self.line, "here another program begins")
        goes = self.reading.asides and self.line in (0, self.main.start)
        return [gx.Speller.along(self.text_of(items[0]))] if goes else []

    def closing(self) -> Iterator[str]:
        """Say what was not executed of the file."""
        anew = self.reading.asides
        for text, chosen in (
            (IDLE if anew or self.reading.stays else IDLE.replace(*LEFT), self._others(True)),
            (DATA, self._others(False)),
        ):
            if chosen:
                self.assumed[text.format(", ".join(chosen))] = None
        if anew and (called := self._others(True, called=True)):
            self.told_anew(CALLED.format(", ".join(called)))
        if self.calls_kept:
            self.assumed[KEPT.format(", ".join(sorted(self.calls_kept)))] = None
        if self.left_out:
            self.assumed[LEFT_OUT.format(", ".join(sorted(self.left_out)))] = None
        return iter(())

    def _others(self, programs: bool, called: bool = False) -> list[str]:
        """Return names of other programs of the file, or of data."""
        return [
            f"{name}_{kind}"
            for name, kind, lines in self.units
            if lines in self.others
            and (kind in PROGRAMS) == programs
            and (lines.start in self.called) == called
        ]


def units_of(lines: Sequence[str]) -> Iterator[tuple[str, str, range]]:
    """Yield the programs of a file: name and kind in capitals, and lines."""
    if "%" not in "\n".join(lines):
        return
    found = [(at, HEADER.fullmatch(line)) for at, line in enumerate(lines) if "%" in line]
    heads = [(at, head) for at, head in found if head is not None]
    starts = [*(at for at, _ in heads), len(lines)]
    for (at, head), end in zip(heads, starts[1:], strict=True):
        yield head["name"].upper(), head["kind"].upper(), range(at, end)
