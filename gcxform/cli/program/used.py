"""What of a machine a program uses: work offsets, tools, reference points, codes of its maker."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from gcxform.catalogue.questions import Question
from gcxform.dialect.dialect import LINEAR, Dialect
from gcxform.modal.meaning.meaning import Act, Meaning
from gcxform.modal.reader import windows_of
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source

Lines = dict[str, int]
"""The line, from 1, on which something is first used, by its name."""
LENGTHS = frozenset({"length", "length-negative", "length-add", "vectors"})
ANY = "*"


@dataclass
class Used:
    """What a program names of its machine, as machine files call it; executed or not."""

    first_offset: str = "G54"
    offsets: Lines = field(default_factory=dict)
    lengths: Lines = field(default_factory=dict)
    radii: Lines = field(default_factory=dict)
    homes: Lines = field(default_factory=dict)
    user_codes: Lines = field(default_factory=dict)
    axes: str = "XYZ"

    def named(self, question: Question) -> Iterator[Question]:
        """Yield the questions that one of all tools, or of a place, stands for in this program."""
        table, name, *key = question
        if table == "tool" and name == ANY:
            numbers = self.radii if key == ["radius"] else self.lengths
            yield from ((table, number, *key) for number in numbers)
        elif table in ("work-offset", "home"):
            of_table = self.offsets or {self.first_offset: 0}
            if table == "home":
                of_table = self.homes
            names = list(of_table) if name == ANY else [name]
            yield from ((table, one, axis) for one in names for axis in self.axes)
        else:
            yield question


def used_by(source: Source, dialect: type[Dialect]) -> Used:
    """Return what a program uses of its machine, as far as numbers are written there."""
    used = Used(dialect.initial["frame"])
    used.axes = "".join(axis for axis in source.axes(dialect.axes) if axis in LINEAR)
    if dialect.translator is not None:
        return used
    for window, reader in windows_of(source, dialect):
        reader.table.update()
        for number in np.unique(window.shape).tolist():
            meaning = reader.table.meanings[number]
            if meaning.acts or meaning.compensates or "D" in meaning.slots:
                _look(used, dialect, window, meaning, np.flatnonzero(window.shape == number))
    return used


def _look(
    used: Used, dialect: type[Dialect], window: Window, meaning: Meaning, lines: np.ndarray
) -> None:
    """Note what the lines of one shape use."""
    for line in lines.tolist():
        at = window.first_line + line + 1
        values = window.value[int(window.first_number[line]) :]
        for act in meaning.acts:
            words = {letter: float(values[slot]) for letter, slot in act.slots}
            _act(used, dialect, act, words, at)
        radius = float(values[meaning.slots["D"]]) if "D" in meaning.slots else 0.0
        if meaning.compensates and not meaning.is_length("D") and radius > 0:
            used.radii.setdefault(f"{radius:g}", at)


def _act(used: Used, dialect: type[Dialect], act: Act, words: dict[str, float], line: int) -> None:
    """Note what one code uses; `words` are those that it takes."""
    if act.name == "work":
        name = dialect.offset_rule.names.get(act.code, act.code)
        named = [f" {letter}{value:.0f}" for letter, value in words.items()]
        used.offsets.setdefault(name + "".join(named), line)
    elif act.name in LENGTHS and words.get("H", 0.0) > 0:
        used.lengths.setdefault(f"{words['H']:g}", line)
    elif act.name == "home":
        second = f" P{words['P']:.0f}" if "P" in words else ""
        used.homes.setdefault(act.code + second, line)
    elif act.name == "user-code":
        used.user_codes.setdefault(act.code, line)
