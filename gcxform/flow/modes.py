"""M70 to M73 of LinuxCNC: modes that are stored and come back, written out as plain blocks.

The control restores F and S first, rounded to a tenth and to a whole number, and codes after them;
motion codes stay as they are. Whether an
offset of G92 or G52 counts is restored as G92.2 or G92.3, and not how large it is. What cannot
be said again by its code alone (a tool length, cutter compensation, a path tolerance) is refused
where it would have to be.
"""

from __future__ import annotations

import math
import re
from functools import lru_cache

from gcxform.flow.run_state import RunState
from gcxform.syntax.tree import Block, Number
from gcxform.values import dataclass

STORING = re.compile(rb"[Mm][ \t0]*7[ \t]*[0-3]|#[ \t]*<[ \t]*_rpm", re.IGNORECASE)
"""What all lines have that store modes or read the speed."""
UNITS, FEED, SPEED, SPINDLE, MIST, FLOOD = "units", "F", "S", "spindle", "M7", "M8"
DECIMALS = {FEED: 1, SPEED: 0}
"""With how many decimals the control writes what it restores."""
OPEN = "?"
"""What stands for F, S or a spindle that only the machine knows, with a number of its own."""
PRESET = "G92"
COUNTS, COUNTS_NOT = "G92.3", "G92.2"
PRESETS = {
    "G92": COUNTS,
    "G52": COUNTS,
    COUNTS: COUNTS,
    "G92.1": COUNTS_NOT,
    COUNTS_NOT: COUNTS_NOT,
}
"""What each code does to whether the offset of G92 counts: LinuxCNC's parameter 5210."""
RESTORED = ("plane", "distance", "arc-distance", "feed-mode", "frame", "retract")
"""Groups whose codes are written again, with units; those of others must not differ."""
LEFT = frozenset({"motion", "cycle", "non-modal", "stop", "tool", "modal-store", "output", "user"})
STORE, FORGET, RESTORE, STORE_FOR_CALL = 70, 71, 72, 73
Codes = dict[str, str]


@lru_cache(maxsize=2)
def _stores(text: bytes) -> bool:
    """Whether modes are stored anywhere in a program: asked at each of its kept loops."""
    return STORING.search(text) is not None


@dataclass(slots=True)
class Level:
    """What a call has stored; `comes_back`: at its return, by M73."""

    stored: Codes | None = None
    comes_back: bool = False


class StoredModes:
    """Follows the codes in force along the executed blocks, and writes those that come back."""

    def __init__(self, program: RunState) -> None:
        self.program = program
        self.levels = [Level()]
        initial = program.dialect.initial
        self.now: Codes = {
            group: initial[group] for group in (*RESTORED, UNITS) if group in initial
        }
        self.now |= {SPINDLE: "M5", MIST: "", FLOOD: "", "cutter-comp": "G40"}
        self.now |= {PRESET: COUNTS_NOT}
        self.seen = self.open = 0

    def enter(self) -> None:
        """Begin a call, which has nothing stored."""
        self.levels.append(Level())

    def leave(self) -> None:
        """End a call; restore what M73 has stored in it."""
        level = self.levels.pop()
        if level.comes_back and level.stored is not None:
            self._restore(level.stored)

    def has_stored(self) -> bool:
        """Whether the call that runs has stored modes."""
        return self.levels[-1].stored is not None

    def act(self, block: Block, codes: set[int | None]) -> bool:
        """Do what M70 to M73 do; return whether the block was one of them."""
        asked = codes & {STORE, FORGET, RESTORE, STORE_FOR_CALL}
        if not asked:
            return False
        if sum(word.address != "N" for word in block.words) > 1:
            raise self.program.refusal("GX210", "a block that stores modes does something else")
        level = self.levels[-1]
        stored = level.stored
        if RESTORE not in asked:
            level.stored = None if FORGET in asked else self._in_force()
            level.comes_back |= STORE_FOR_CALL in asked
        elif stored is None:
            raise self.program.refusal("GX223", "nothing is stored here that M72 could restore")
        else:
            self._restore(stored)
        return True

    # --- what only the machine knows ---

    def touched_by(self, text: bytes) -> frozenset[str]:
        """Return of which groups codes stand in a text; nothing where no modes come back."""
        if not _stores(self.program.listing.window.text):
            return frozenset()
        self._in_force()
        mine, self.now = self.now, dict.fromkeys(self.now, "")
        for line in re.split(r"[\r\n]+", text.decode("latin-1")):
            if line.strip():
                self._look(self.program.dialect.load_grammar().parse(line))
        found = frozenset(group for group, code in self.now.items() if code)
        if any(code in text.upper() for code in (b"M9", b"M09")):
            found |= {MIST, FLOOD}
        self.now = mine
        return found

    def open_up(self, groups: frozenset[str]) -> None:
        """Take codes of groups for not known any more."""
        for group in sorted(groups):
            self._in_force()
            self.open += 1
            self.now[group] = f"{OPEN}{self.open}"

    # --- what is in force ---

    def speed(self) -> float:
        """Return the S word in force; nan if none was written."""
        speed = self._in_force().get(SPEED, OPEN)
        return math.nan if speed.startswith(OPEN) else float(speed)

    def _in_force(self) -> Codes:
        """Return the codes in force after the blocks that have been executed."""
        fresh = b"".join(self.program.text[self.seen :])
        self.seen = len(self.program.text)
        grammar = self.program.dialect.load_grammar()
        for line in re.split(r"[\r\n]+", fresh.decode("latin-1")):
            if line.strip():
                block = grammar.parse(line)
                if self.program.stands(block):
                    self._look(block)
        return dict(self.now)

    def _look(self, block: Block) -> None:
        """Note the codes of a block, those that take words with these."""
        number = {w.address: w.value.text for w in block.words if isinstance(w.value, Number)}
        for word in block.words:
            if word.address in (FEED, SPEED):
                self.open += 1
                self.now[word.address] = number.get(word.address, f"{OPEN}{self.open}")
        for word in block.words:
            if word.address in "GM" and isinstance(word.value, Number):
                self._note(f"{word.address}{word.value.value:g}", number)

    def _note(self, name: str, number: dict[str, str]) -> None:
        dialect = self.program.dialect
        if name in ("M7", "M8", "M9"):
            self.now |= {MIST: "", FLOOD: ""} if name == "M9" else {name: name}
            return
        if name == "M6" and self.now[SPINDLE] != "M5":
            self.open += 1  # stopped, but for machines with TOOL_CHANGE_WITH_SPINDLE_ON
            self.now[SPINDLE] = f"{OPEN}{self.open}"
        if name in PRESETS:
            self.now[PRESET] = PRESETS[name]
        code = dialect.codes.get(name) or dialect.m_codes.get(int(float(name[1:])))
        if code is None or code.group in LEFT:
            return
        if code.group in (SPINDLE, *RESTORED, UNITS):
            self.now[code.group] = "M5" if name == "M19" else name  # it stops the spindle
        else:
            taken = (f" {a}{number[a]}" for a in code.takes if a in number)
            self.now[code.group] = name + "".join(taken)

    # --- what comes back ---

    def _restore(self, stored: Codes) -> None:
        """Write the blocks that restore modes, in the order of the control."""
        now = self._in_force()
        differ = {group for group in now if not _same(group, now[group], stored.get(group))}
        self._refuse_unknown(differ, now, stored)
        feed = [_rounded(a, stored[a]) for a in (FEED, SPEED) if a in differ]
        codes = [stored[group] for group in RESTORED if group in differ]
        units = [stored[UNITS]] if UNITS in differ else []
        preset = [stored[PRESET]] if PRESET in differ else []
        for words in (units, feed, codes, preset, *self._machine_codes(differ, stored)):
            if words:
                self.program.write_line(" ".join(words))

    def _refuse_unknown(self, differ: set[str], now: Codes, stored: Codes) -> None:
        known = {*RESTORED, UNITS, SPINDLE, MIST, FLOOD, FEED, SPEED, PRESET}
        for group in sorted(differ):
            before = stored.get(group, "")
            if group not in known or group not in stored or before.startswith(OPEN):
                told = before if before and not before.startswith(OPEN) else "what was before"
                message = f"{group} would have to go back to {told}"
                raise self.program.refusal("GX210", f"the modes are restored here: {message}")

    def _machine_codes(self, differ: set[str], stored: Codes) -> list[list[str]]:
        """Return the M codes that bring spindle and coolant back, by block.

        M7 and M8 are of one modal group: a block may have one of them.
        """
        found = [stored[SPINDLE]] if SPINDLE in differ else []
        second: list[str] = []
        if differ & {MIST, FLOOD}:
            on = [stored[code] for code in (MIST, FLOOD) if stored[code]]
            off = any(code in differ and not stored[code] for code in (MIST, FLOOD))
            found += (["M9"] if off and not on else []) + on[:1]
            second = on[1:]
            if off and on:
                raise self.program.refusal("GX210", "one of two coolants would go off here")
        return [found, second]


def _same(group: str, now: str, stored: str | None) -> bool:
    """Whether what is in force is what was stored."""
    if group in DECIMALS and stored is not None and OPEN not in (now[0], stored[0]):
        return float(now) == float(stored)
    return now == stored


def _rounded(address: str, number: str) -> str:
    """Return F or S as the control restores it."""
    return f"{address}{float(number):.{DECIMALS[address]}f}".removesuffix(".0")
