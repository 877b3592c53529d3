"""What a program has switched on before a line: codes, tool, spindle, coolant, word by word.

Modal groups that the interpreter follows are in its state; everything else is remembered here as it
was written. `HANDLED` says how each group is restated; a code of any other group cannot be, and a
restart after it is refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from enum import Enum
from typing import Final

import numpy as np

from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import Meaning
from gcxform.modal.meaning.tables import CYCLES, FAMILIES, NUMBER
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import Block, Number, Word
from gcxform.toolpath.path import Event
from gcxform.values import dataclass


class How(Enum):
    """How the codes of a group are restated before a restart."""

    LAST = "the last one of the group"
    EACH = "the last one of each code"
    OWN = "as tool, spindle or coolant"
    NOTHING = "they leave nothing behind"


HANDLED: Final[Mapping[str, How]] = {
    "cutter-comp": How.NOTHING,  # no restart is inside it
    "tool-length": How.LAST,
    "path": How.LAST,
    "retract": How.LAST,
    "diameter": How.LAST,
    "spindle-mode": How.LAST,
    "cycle": How.LAST,
    "stroke": How.LAST,
    "mirror": How.LAST,
    "rotation": How.LAST,
    "scaling": How.LAST,
    "polar": How.LAST,
    "cancel": How.EACH,
    "non-modal": How.EACH,
    "override": How.EACH,
    "brake": How.EACH,
    "conveyor": How.EACH,
    "gear": How.EACH,
    "tool": How.OWN,
    "spindle": How.OWN,
    "coolant": How.OWN,
    "stop": How.NOTHING,
}
RESTATED: Final[Mapping[str, tuple[str, ...]]] = {
    **FAMILIES,
    "motion": ("G0", "G1", "G2", "G3", "G80"),
    "frame": (*(f"G{n}" for n in range(54, 60)), "G59.1", "G59.2", "G59.3"),
}
"""The modal codes that are in the interpreter's state and that a preamble states."""
ACTS_RESTATED: Final = frozenset(
    {
        *("work", "no-length", "length", "home", "machine"),
        *("no-rotate", "no-scale", "no-mirror", "no-polar"),
    }
)
"""What codes that act on the frame may do before a restart: the rest is not restated."""
ACTS_LEFT: Final = frozenset({"define-plane", "orient", "swivel", "turn-to", "follow-tip"})
"""What others leave behind no restart is in: a plane, or a tip."""
ACTS_ENDED: Final = frozenset({"rotate", "scale", "mirror", "polar", "local"})
"""What others leave behind has to be at its end: by G69, G50, G50.1, G15, or G52 with zeros."""
ONE_BLOCK: Final = frozenset({"G4", "G9", "G28", "G30", "G53"})
"""Codes that hold for one block."""
COOLANT_OFF: Final[Mapping[str, tuple[str, ...]]] = {"M9": ("M7", "M8"), "M89": ("M88",)}


@dataclass
class Memory:
    """What a program has switched on. Texts are copies of the words of the program.

    codes     by code or group: the text, and whether the program was in inches there
    length    the tool length in force, which the first move along Z states
    ready     the T word last programmed; `loaded` that of the last tool change, None: none so far
    unsafe    the first line (from 1) after which no restart is safe, and why
    turned    the same of words that are turned or shifted, which only hold until they are no more
    """

    dialect: type[Dialect]
    codes: dict[str, tuple[str, bool]] = field(default_factory=dict)
    ready: str | None = None
    loaded: tuple[str, str] | None = None
    speed: str | None = None
    spindle: str | None = None
    coolant: list[str] = field(default_factory=list)
    length: str = ""
    unsafe: tuple[int, str] | None = None
    turned: tuple[int, str] = (0, "")

    def look(self, shape: Shape, meaning: Meaning, line: int) -> None:
        """Note what blocks of a shape hold that cannot be restated; `line` has it, from 1."""
        for word in shape.block.words:
            reason = self._reason(word)
            code = self.dialect.codes.get(_name(word))
            if reason and code is not None and code.act in ACTS_ENDED:
                self.turned = max(self.turned, (line, reason))
            elif reason:
                self.refuse(line, reason)

    def refuse(self, line: int, reason: str) -> None:
        """Note why no restart is safe behind a line, from 1; the first of all is kept."""
        if self.unsafe is None or line < self.unsafe[0]:
            self.unsafe = line, reason

    def _reason(self, word: Word) -> str:
        """Return why a word keeps a restart from being safe, nothing if it does not."""
        if not isinstance(word.value, Number) or word.address not in "GM":
            return ""
        name = _name(word)
        if word.address == "G":
            code = self.dialect.codes.get(name)
            if code is None or (
                code.effect is Effect.MODAL and name in RESTATED.get(code.group, ())
            ):
                return ""
            if code.act in ACTS_RESTATED | ACTS_LEFT or NUMBER.get(name) in CYCLES:
                return ""
            known = code.effect in (Effect.INERT, Effect.DWELL) and code.group in HANDLED
            return "" if known else f"{name} was in force, which is not restated"
        m_code = self.dialect.m_codes.get(int(word.value.value), self.dialect.block_rule.unknown_m)
        known = m_code is None or m_code.group in HANDLED
        return "" if known else f"{name} switched something that is not restated"

    def take(self, event: Event, block: Block, inch: bool) -> None:
        """Take over an event; `block` is that of its line."""
        what = event.what
        if what == "T":
            self.ready = words_of(block, "T")
        elif what == "S":
            self.speed = words_of(block, "S")
        elif what == "D":
            self.codes["D"] = words_of(block, "D"), inch
        elif what[0] == "G" and what not in ONE_BLOCK:
            code = self.dialect.codes[what]
            if code.act == "work" or HANDLED.get(code.group) is How.NOTHING:
                return
            if code.act in ACTS_LEFT and code.group not in HANDLED:
                return
            how = HANDLED.get(code.group)
            self._enter(what if how is How.EACH else code.group, block, event, inch)
            if code.group == "tool-length":
                self.length = self.codes.pop("tool-length")[0] if code.act == "length" else ""
            if any(letter == "S" for letter, _ in event.values):
                self.speed = None
        elif what[0] == "M":
            self._m_code(event, block, inch)

    def _enter(self, key: str, block: Block, event: Event, inch: bool) -> None:
        """Remember a code behind all others."""
        self.codes.pop(key, None)
        letters = "".join(letter for letter, _ in event.values)
        self.codes[key] = words_of(block, letters, event.what), inch

    def _m_code(self, event: Event, block: Block, inch: bool) -> None:
        code = self.dialect.m_codes.get(int(event.what[1:]), self.dialect.block_rule.unknown_m)
        if code is None:
            return
        text = words_of(block, "".join(letter for letter, _ in event.values), event.what)
        if code.group == "tool":
            numbered = any(letter == "Q" for letter, _ in event.values)
            self.loaded = ("" if numbered else self.ready or "", text)
        elif code.group == "spindle":
            self.spindle = text
        elif code.group == "coolant":
            self._coolant(event.what)
        elif HANDLED.get(code.group) is How.EACH:
            self._enter(event.what, block, event, inch)
        if code.ends:
            self.spindle, self.coolant = "M5", ["M9"]

    def _coolant(self, code: str) -> None:
        off = COOLANT_OFF.get(code)
        self.coolant = [other for other in self.coolant if other not in (off or (code,))]
        self.coolant = [other for other in self.coolant if other not in COOLANT_OFF]
        if off is None or not self.coolant:
            self.coolant.append(code)


def _name(word: Word) -> str:
    """Return the code that a word is, "" for an expression."""
    number = word.value
    return f"{word.address}{round(number.value, 6):g}" if isinstance(number, Number) else ""


def words_of(block: Block, letters: str, code: str = "") -> str:
    """Return a code of a block with the words of some letters, as they are written there."""
    return " ".join(_texts(block, letters, code))


def _texts(block: Block, letters: str, code: str) -> Iterator[str]:
    for word in block.words:
        if not isinstance(word.value, Number):
            continue
        if word.address in letters or (code and _name(word) == code):
            yield block.text[word.start : word.end].upper()


def shapes_seen(shape: np.ndarray) -> Iterator[tuple[int, int]]:
    """Yield the shapes of some lines, each with the first line that has it."""
    numbers, first = np.unique(shape, return_index=True)
    yield from zip(numbers.tolist(), first.tolist(), strict=True)
