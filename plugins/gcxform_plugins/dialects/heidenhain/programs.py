"""Programs of a TNC that are written for a TNC again: what is not understood stays as it stands.

A line that is kept is a block of its own, behind which no position is known, nor anything else that
it may have set. Where only the control knows where a program goes on, all that follows is kept.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterable, Iterator, Sequence
from operator import attrgetter

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.cycles import AUTO
from gcxform_plugins.dialects.heidenhain.kept_cycles import CALLED
from gcxform_plugins.dialects.heidenhain.lines import Lines
from gcxform_plugins.dialects.heidenhain.parameters import CONTROL, NAMED, key_of
from gcxform_plugins.dialects.heidenhain.positioning import SHORTEST, SILENT
from gcxform_plugins.dialects.heidenhain.runs import Runs
from gcxform_plugins.dialects.heidenhain.spelling import STEPPED, STEPPED_AT, code, spelled
from gcxform_plugins.dialects.heidenhain.words import goes_on, plain
from gcxform_plugins.dialects.shared.untouched_lines import KEEPABLE, KEEPS, KEPT

ROUNDED = re.compile(r"[\s\d/]*(?:RND|CHF|CTP?|FLT|FCT|DEP|AP+R)(?![A-Z])", re.IGNORECASE)
"""Lines that hang on the direction of the move before them."""
DECIDES = re.compile(r"FN\s*(?:9|10|11|12)\s*:|CALL\s+LBL", re.IGNORECASE)
FROM_HERE = re.compile(r"SECTION|DECLARE|FUNCTION\s+MODE", re.IGNORECASE)
POSES = re.compile(r"FUNCTION\s+TCPM.*(?:SPAT|VECTOR)", re.IGNORECASE)
"""Behind these, angles are not where words say (iTNC 530 340 49x, p. 516)."""
TCPM = r"FUNCTION\s+(?:RESET\s+)?TCPM"
QUIET = re.compile(
    rf"(?:TOOL\s+DEF|BLK|TCH|CYCLE?\s+DEF|PATTERN|PLANE|TRANS|RND|CHF|{TCPM})(?![A-Z])"
)
"""Statements that set no parameter but those they name, and no feed."""
PLAIN = re.compile(
    rf"(?:TOOL\s+DEF|BLK|PATTERN|RND|CHF|CYCLE?\s+DEF\s*2\d\d(?!\d)|{TCPM})(?![A-Z])"
)
"""And that neither turn nor tilt what follows, whatever they say."""
SCALES = re.compile(r"CYCLE?\s+DEF\s*(?:11|26)\.[1-9](?!\s*SCL\s*1(?:\.0*)?\s*$)|TRANS\s+SCALE")
HEAD = re.compile(r"[ \t]*(?:[0-9]+[ \t]+)?")
NO_STEPS = re.compile(r"[\s\d/]*(?:\*|(?:CYCLE?[ \t]+DEF|TRANS)(?![A-Z]))", re.IGNORECASE)
"""A structure block, which is a text; and a shift, whose IX adds to what no line of it can say."""
ARCS = re.compile(
    r"(?i)^[\s\d/]*(?:(?:C|CR|CT|CP|CTP|RND|FCT?|SPL)(?![A-Z])|(?:APPR|DEP)\s*P?(?:CT|LCT))"
)
AGAINST = {
    "LINEAR_ONLY": ARCS,
    "XY_ARCS": ARCS,
    "NO_CYCLES": re.compile(r"(?i)^[^;]*?(?:CYCL[ \t]+CALL|(?<![A-Z])M0*(?:89|99)(?![0-9]))"),
}
NUMBERED = re.compile(r"[ \t]*([0-9]+)[ \t]+BEGIN", re.IGNORECASE)
SKIPPED = r"[ \t]*(?:/[ \t]*)?"
"""What stands before the number of a block: the slash of one that may be skipped."""
NUMBER = re.compile(rf"^({SKIPPED})(?:[0-9]+([ \t]*))?")
FREE = re.compile(rf"^{SKIPPED}[0-9]+[ \t]+F[LC]T?(?![A-Z])", re.IGNORECASE | re.MULTILINE)
STATE = (
    *("place", "lost", "pole", "polar", "moved", "motion", "feed", "tool_feed", "feed_lost"),
    *("following", "shortest", "side", "in_spindle", "over", "begun", "axis", "tool", "q", "at"),
    *("shift", "new_shift", "hole", "pecks", "cycle", "bounded", "calls", "left", "repeated"),
    *("selected", "by_cycle", "plane", "places", "turn", "mirrored", "deltas", "refers"),
    *("spindle", "untold", "untilted"),
)
BEGUN = STATE.index("begun")
state_of = attrgetter(*STATE)
CHANGING = frozenset((dict, list, set))
"""The types of what is changed in its place: as it was it is known by a copy alone."""


class Programs(Runs):
    """Executes a program, and keeps what it does not understand where that may stay."""

    writes = True
    speller = Lines
    kept = KEPT
    against = AGAINST
    stepped = STEPPED_AT

    def __init__(self, *program: object) -> None:
        super().__init__(*program)
        self.kept_lines: list[tuple[int, str]] = []
        self.rest_kept = self.tied = ""
        self.aside = self.scaled = self.modal = False

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        if not self.reading.stays:
            return super().blocks(items)
        if self.rest_kept:
            return self._kept(items, self.rest_kept)
        before = [each.copy() if type(each) in CHANGING else each for each in state_of(self)]
        try:
            self._check_beside(items)
            return [*super().blocks(items)]
        except gx.InputError as error:
            (found, *_) = error.diagnostics
            if found.code not in KEEPABLE or not before[BEGUN]:
                raise
            vars(self).update(zip(STATE, before, strict=True))
            text = code(self.lines[self.line])
            if DECIDES.search(text) and "PGM" not in text.upper():
                self._keep_rest(found.message)
            return self._kept(items, found.message)

    def _hangs_on_more(self, rapid: bool) -> bool:
        kept = self.reading.stays and (self.rest_kept or self.modal or self.aside or self.scaled)
        return bool(kept) or super()._hangs_on_more(rapid)

    def _check_beside(self, items: Sequence[gx.Item]) -> None:
        """Refuse to cut what the lines beside it hang on. Raises InputError."""
        path = next((item for item in items if item.kind == "path"), None)
        if path is None:
            return
        if self.modal:
            self.refuse("a cycle is called behind this block (M89)", path)
        if self.aside and not any(i.kind == "comp" or _is_off(i) for i in items):
            self.refuse("on which side of the contour the tool is is not known", path)
        if path.name not in ("L", "LP") and self.scaled:
            self.refuse(f"{path.name} in a scale", path)
        at = self.at
        while at < len(self.lines) and not code(self.lines[at]).strip(" \t0123456789"):
            at += 1
        if at < len(self.lines) and ROUNDED.match(self.lines[at]):
            self.refuse(f"the next line hangs on the direction of this {path.name}", path)

    def switch(self, on: bool) -> tuple[str, ...]:
        """Follow the tip, or leave it; the line stays where the program stays on its control."""
        if self.reading.stays:
            self.refuse(f"M12{8 if on else 9}: what the words are of changes with it")
        return super().switch(on)

    # --- what is kept ---

    def ends(self, what: str, item: gx.Item) -> None:
        """Keep what may end a function of a line that is kept: coordinates are others behind it."""
        if self.kept_lines:
            self.refuse(f"{what} ends what may have been kept", item)

    def _keep_rest(self, why: str) -> None:
        """Keep all that follows; lines before may then be executed again."""
        self.rest_kept = self.tied = why

    def _kept(self, items: Sequence[gx.Item], why: str) -> list[str]:
        """Return the block of a line that stays as it stands."""
        items = [item for item in items if item.kind not in ("seq", "structure")]
        if not items:
            return []
        text = code(self.lines[self.line]).lstrip("/0123456789 \t").rstrip()
        words = text.upper()
        self.kept_lines.append((self.line, why))
        words = " ".join([words, *self._continued()])
        if FROM_HERE.match(words):
            self._keep_rest(why)
        elif POSES.match(words):
            self.rest_kept = why
            if any(DECIDES.search(code(line)) for line in self.lines):
                self.tied = why
        self._lose(items, words)
        number = zlib.crc32(text.encode("latin-1")) & 0xFFFFF
        return [f"{self.moving('G1')} {KEPT} P{number}".lstrip()]

    def _continued(self) -> Iterator[str]:
        """Yield the lines that go on with a line that is kept, and pass them."""
        while goes_on(self.lines[self.at - 1]) and self.at < len(self.lines):
            self.at += 1
            self.kept_lines.append((self.at - 1, self.kept_lines[-1][1]))
            yield code(self.lines[self.at - 1]).upper()

    def _lose(self, items: Sequence[gx.Item], words: str) -> None:
        """Forget what a line may have changed."""
        self.lose()
        self.pole, self.motion, self.plainly = {}, "", False
        said = {item.kind for item in items}
        if "text" in said:
            self.places = []
            if not PLAIN.match(words):
                self.turn = self.mirrored = None
        if "text" in said and not QUIET.match(words):
            self.q, self.side, self.aside = dict.fromkeys(self.q), "", True
            self.feed_lost, self.cycle = True, -1
            self.tool_feed = self.in_spindle = ""
        elif "text" in said:
            named = {key_of(name) for name in NAMED.findall(words)}
            if words.startswith("TCH"):
                named |= {f"Q{number}" for number in CONTROL}
            self.q |= dict.fromkeys(named)
        elif said & {"feed", "per", "auto", "m"}:
            self.feed_lost = True
        if "tool_call" in said:
            self._lose_tool(items)
        if re.search(r"(?<![A-Z])(?:APPR|DEP|R[LR])(?![A-Z])|(?<![A-Z])R0?(?![\d.,A-Z])", words):
            self.side, self.aside = "", True
        called = {item.numbers[0] for item in items if item.kind == "m"}
        self.modal = (self.modal or "89" in called) and "99" not in called
        if words.startswith(("CYCL", "TRANS")):
            self._lose_cycle(words)

    def _lose_tool(self, items: Sequence[gx.Item]) -> None:
        """Forget the tool before, and its feed; along another axis the plane is another one."""
        self.tool_feed = self.in_spindle = self.spindle = ""
        self.assigned(AUTO)
        if any(item.kind == "tool_axis" and item.name != "Z" for item in items):
            self._keep_rest("a tool along another axis than Z")

    def _lose_cycle(self, words: str) -> None:
        """Forget what was defined before: another cycle, or another place of the zero."""
        self.scaled |= SCALES.match(words) is not None
        self.shift, self.turn, self.mirrored = {}, None, None
        if words.startswith("CYCL") and "CALL" not in words:
            self.cycle = -1

    def _side(self, item: gx.Item, said: object) -> None:
        self.aside = False
        super()._side(item, said)  # type: ignore[arg-type]

    # --- writing ---

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks; None where only the machine decides on it."""
        return None if self.tied else spelled(self.lines[line], blocks, self.polar_at.get(line))

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became, with its head and its comment.

        None for one with an M function that no block says: it would be gone.
        """
        unsaid = not self.reading.asides and not all(map(_is_said, self.items(line)))
        if self.tied or unsaid:
            return None
        text = self.lines[line]
        head = HEAD.match(text)
        words = [bare for each in said if (bare := each.partition(";")[0].rstrip())]
        first, comment = " ".join(words[:1]), text[len(code(text)) :]
        begins = f"{first} {comment}".strip()
        return "\n".join([f"{head[0] if head else ''}{begins}", *words[1:]])

    def renumbered(self, text: str) -> str:
        """Return a program with its block numbers anew; those of free contours may name others."""
        if FREE.search(text) or not NUMBERED.match(text.lstrip("\r\n")):
            return text
        count = iter(range(int(NUMBERED.match(text.lstrip("\r\n"))[1]), 10**9))  # type: ignore[index]
        parts = re.split(r"(\r\n|\n|\r)", text)
        continued = False
        for k in range(0, len(parts), 2):
            line = parts[k]
            if line.strip() and not continued:
                parts[k] = NUMBER.sub(lambda m: f"{m[1]}{next(count)}{m[2] or ' '}", line, count=1)
            continued = line.rstrip().endswith("~")
        return "".join(parts)

    def counts(self, line: str) -> bool:
        """Whether a line has a word that counts from where its axis stands."""
        return STEPPED.search(code(line)) is not None and not NO_STEPS.match(line)

    def closing(self) -> Iterator[str]:
        """Say which lines are kept. Raises InputError for a program that breaks off."""
        if self.kept_lines:
            self.assumed[self._told()] = None
        if self.calls_kept:
            self.assumed[CALLED.format(", ".join(map(str, sorted(self.calls_kept))))] = None
        if not self.rest_kept:
            super().closing()
        return iter(())

    def _told(self) -> str:
        lines = sorted({line for line, _ in self.kept_lines})
        few = ", ".join(map(self._named, lines[:8])) + (" and more" if len(lines) > 8 else "")
        line, why = min(self.kept_lines)
        return f"lines {few} ({len(lines)}) are kept " + KEEPS.format(
            f"line {self._named(line)}: {why}"
        )

    def _named(self, line: int) -> str:
        """Return the number of a line, with its file where that is another one."""
        file, number = self.place_of(line)
        return str(number) if line < self.own else f"{number} of {file}"


def _is_off(item: gx.Item) -> bool:
    return item.kind == "radius" and bool(item.numbers) and not float(plain(item.numbers[0]))


def _is_said(item: gx.Item) -> bool:
    """Whether blocks say what an item does: not where M functions are passed over."""
    number = item.numbers[0] if item.kind == "m" else ""
    return not number.isdigit() or int(number) not in SILENT | SHORTEST
