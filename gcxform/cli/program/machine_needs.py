"""What of a machine a program uses: work offsets, tools, reference points, codes of its maker."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import suppress
from dataclasses import field, replace
from typing import Final

import numpy as np

from gcxform.catalogue.questions import Question
from gcxform.contract.own_codes import may_be_said
from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import EXTRUDER, LINEAR, Dialect
from gcxform.flow.straightened import written_out
from gcxform.flow.tool_names import MADE_UP
from gcxform.machine.control import COMP_CORNERS, COMP_ENTRY, HOME, WORK_OFFSET
from gcxform.machine.control import INERT as INERT_M
from gcxform.modal.meaning.calls import NUMBERED
from gcxform.modal.meaning.meaning import Act, Meaning
from gcxform.modal.reader import windows_of
from gcxform.modal.state import Reading
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source
from gcxform.system.distinct import distinct
from gcxform.values import dataclass

Places = dict[str, Location]
"""Where something is first used, by its name."""
LENGTHS = frozenset({"length", "length-negative", "length-add", "vectors", "tip", "follow-tip"})
ANY = "*"
PLACED: Final = LINEAR.replace(EXTRUDER, "")
"""The axes of which a machine file says where zeros and reference points are, but rotary ones."""
LENGTH_ALONE: Question = ("control", "tool-length-alone")
INERT: Question = ("control", INERT_M)


@dataclass
class Used:
    """What a program names of its machine, as machine files call it.

    `own_codes` are M codes that the dialect does not have, `calls` are those that are kept as their
    programs are not at hand; `of_home` are the axes that go there. `length_alone`: a tool length is
    called without a place along it. `changes` are codes that change a tool, which may move axes;
    `control` are settings of it that its codes depend on, but for those that hints ask.
    """

    first_offset: str = "G54"
    offsets: Places = field(default_factory=dict)
    lengths: Places = field(default_factory=dict)
    radii: Places = field(default_factory=dict)
    homes: Places = field(default_factory=dict)
    own_codes: Places = field(default_factory=dict)
    changes: Places = field(default_factory=dict)
    axes: str = "XYZ"
    of_home: dict[str, str] = field(default_factory=lambda: {"M140": "Z"})  # along the tool
    calls: Places = field(default_factory=dict)
    length_alone: bool = False
    control: Places = field(default_factory=dict)

    @property
    def codes(self) -> list[int]:
        """The M codes behind which positions are lost if no machine file says otherwise."""
        return sorted(map(int, {**self.own_codes, **self.changes}))

    def keep_axes(self, letters: Collection[str]) -> None:
        """Keep the axes that a machine file names, if it names any: it takes no others."""
        if letters:
            self.axes = "".join(axis for axis in self.axes if axis in letters)

    def questions(self) -> Iterator[tuple[Question, Location | None]]:
        """Yield what is to be said of all that the program names, with the place of each."""
        whole: tuple[tuple[Question, Places], ...] = (
            (("work-offset", ANY, "X"), self.offsets),
            (("tool", ANY, "length"), self.lengths),
            (("tool", ANY, "radius"), self.radii),
            (("home", ANY, "X"), self.homes),
        )
        for question, places in whole:
            yield from ((q, places.get(q[1])) for q in self.named(question) if places)
        yield from ((("control", name), where) for name, where in self.control.items())

    def named(self, question: Question) -> Iterator[Question]:
        """Yield the questions that one of all tools, or of a place, stands for in this program."""
        table, name, *key = question
        if table == "control" and key and key[0] == ANY:
            yield from ((table, name, call, *key[1:]) for call in self.calls)
            return
        if question == LENGTH_ALONE and not self.length_alone:
            return
        if question == INERT and not self.codes:
            return
        if table == "tool" and name == ANY:
            numbers = self.radii if key == ["radius"] else self.lengths
            yield from ((table, number, *key) for number in numbers)
        elif table in ("work-offset", "home"):
            known = list(self.offsets) or [self.first_offset]
            known = list(self.homes) if table == "home" else known
            for one in known if name == ANY else [name]:
                axes = self.of_home.get(one, PLACED)
                yield from ((table, one, axis) for axis in self.axes if axis in axes)
        else:
            yield question


def used_by(source: Source, dialect: type[Dialect], reading: Reading) -> Used:
    """Return what a program uses of its machine, and what it calls, as far as that is written."""
    used = Used(dialect.initial["frame"])
    named = set("XYZ")
    for stays in (False, True) if reading.stays else (False,):
        with suppress(InputError):  # lines that are kept do not say what they use; or as it stands
            source = written_out(source, dialect, replace(reading, stays=stays))
            break
    for window, reader in windows_of(source, dialect):
        reader.table.update()
        for number in distinct(window.shape).tolist():
            meaning = reader.table.meanings[number]
            named |= {*meaning.axes}
            if meaning.acts or meaning.lost_by or meaning.compensates or "D" in meaning.slots:
                for line in np.flatnonzero(window.shape == number).tolist():
                    _look(used, dialect, _Block(source, window, meaning, line))
    used.axes = "".join(axis for axis in dialect.axes if axis in named and axis in PLACED)
    _look_into_spindle(used, source, dialect)
    _look_at_first_move(used, source, dialect)
    return used


def _look_into_spindle(used: Used, source: Source, dialect: type[Dialect]) -> None:
    """Note the tools that G41 without a D, and G43 without an H, take: those in the spindle."""
    of_comp = not dialect.cutter_comp.stored
    of_length = dialect.tool_rule.g43_takes_spindle_tool
    selected = spindle = 0.0
    for window, reader in windows_of(source, dialect) if of_comp or of_length else ():
        reader.table.update()
        meanings = reader.table.meanings
        asks = [
            (of_comp and m.compensates and "D" not in m.slots, of_length and _takes_no_h(m))
            for m in meanings
        ]
        said = ("T" in m.slots or m.changes_tool for m in meanings)
        known = np.fromiter(map(any, zip(said, map(any, asks), strict=True)), np.bool_, len(asks))
        for line in np.flatnonzero(known[window.shape]).tolist():
            number = int(window.shape[line])
            block = _Block(source, window, meanings[number], line)
            slots = block.meaning.slots
            selected = block.value(slots["T"]) if "T" in slots else selected
            spindle = selected if block.meaning.changes_tool else spindle
            for asked, places in zip(asks[number], (used.radii, used.lengths), strict=True):
                if asked and 0 < spindle < MADE_UP:
                    places.setdefault(f"{spindle:.0f}", block.place)


def _takes_no_h(meaning: Meaning) -> bool:
    """Whether a block has a code of a tool length without the H that says which."""
    return any(
        act.name == "length" and all(letter != "H" for letter, _ in act.slots)
        for act in meaning.acts
    )


def _look_at_first_move(used: Used, source: Source, dialect: type[Dialect]) -> None:
    """Note the work offset that is in force at the start, if axes move before one is named."""
    for window, reader in windows_of(source, dialect):
        reader.table.update()
        meanings = reader.table.meanings
        works = [any(act.name == "work" for act in m.acts) for m in meanings]
        moves = [bool(m.axes) for m in meanings]
        either = np.array([*map(max, works, moves)], np.bool_)[window.shape]
        for line in np.flatnonzero(either)[:1].tolist():
            meaning = meanings[int(window.shape[line])]
            if not works[int(window.shape[line])]:
                place = _Block(source, window, meaning, line).place
                used.offsets.setdefault(used.first_offset, place)
            return


@dataclass(frozen=True)
class _Block:
    """A line of a window."""

    source: Source
    window: Window
    meaning: Meaning
    line: int

    def value(self, slot: int) -> float:
        """Return a number of the line."""
        return float(self.window.value[int(self.window.first_number[self.line]) + slot])

    @property
    def place(self) -> Location:
        """Where it stands."""
        line = self.window.first_line + self.line + 1
        return self.source.shown(Location(self.source.name, line))


def _look(used: Used, dialect: type[Dialect], block: _Block) -> None:
    """Note what a block uses."""
    meaning = block.meaning
    if meaning.call:
        called, slots = meaning.call, dict(meaning.call_slots)
        if called == NUMBERED and "P" in slots:
            called = f"P{block.value(slots['P']):g}"
        if called != NUMBERED and may_be_said(dialect, called):
            used.calls.setdefault(called, block.place)
    for act in meaning.acts:
        _act(used, dialect, act, block)
    number = block.value(meaning.slots["D"]) if "D" in meaning.slots else 0.0
    if meaning.compensates and not meaning.is_length("D") and 0 < number < MADE_UP:
        used.radii.setdefault(f"{number:.0f}", block.place)
    rule = dialect.cutter_comp
    if meaning.compensates and "G41" in dialect.codes:
        for setting, known in ((COMP_CORNERS, rule.corners), (COMP_ENTRY, rule.entry)):
            if not known:
                used.control.setdefault(setting, block.place)
    changes = {number for number, code in dialect.m_codes.items() if code.group == "tool"}
    for number in meaning.lost_by - {-1}:
        codes = used.changes if number in changes else used.own_codes
        codes.setdefault(str(number), block.place)


def _act(used: Used, dialect: type[Dialect], act: Act, block: _Block) -> None:
    """Note what one code of a block uses."""
    words = {letter: block.value(slot) for letter, slot in act.slots}
    if act.name == "work":
        name = dialect.offset_rule.names.get(act.code, act.code)
        named = [f" {letter}{value:.0f}" for letter, value in words.items()]
        name += "".join(named)
        if WORK_OFFSET.fullmatch(name):
            used.offsets.setdefault(name, block.place)
    elif act.name in LENGTHS and 0 < words.get("H", 0.0) < MADE_UP:
        used.lengths.setdefault(f"{words['H']:.0f}", block.place)
        used.length_alone |= dialect.tool_rule.length_may_move and "Z" not in block.meaning.axes
    elif act.name == "offset-of-tool":
        used.lengths.setdefault(f"{words['T']:.0f}", block.place)
    elif act.name == "home":
        name = act.code + (f" P{words['P']:.0f}" if "P" in words else "")
        if not HOME.fullmatch(name):
            return  # of no control's page: a machine file does not know it
        used.of_home[name] = used.of_home.get(name, "") + (block.meaning.axes or PLACED)
        used.homes.setdefault(name, block.place)
