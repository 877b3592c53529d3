"""Programs for a SINUMERIK as they are executed: variables, decisions, jumps, and what is kept.

A line that computes is turned into one of plain words, which is read as any other
(`computing.py`). One that decides says where to go on. What is not understood stays as it stands,
where the program is written for the same control and nothing that is written depends on it: behind
it positions are lost, and what it may have set.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Collection, Iterable, Iterator, Sequence

from lark.exceptions import UnexpectedInput

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.shared.untouched_lines import KEPT
from gcxform_plugins.dialects.siemens.asides import GEARS, QUIET
from gcxform_plugins.dialects.siemens.axes_of_lines import (
    ALL,
    DRILLING,
    OTHER,
    PATHS,
    axes_of,
    words_of,
)
from gcxform_plugins.dialects.siemens.effects import AGAINST, effect_of
from gcxform_plugins.dialects.siemens.line import FRAMES, Line
from gcxform_plugins.dialects.siemens.lines import Lines
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY
from gcxform_plugins.dialects.siemens.scaling import Scaling
from gcxform_plugins.dialects.siemens.structure import code

DECIDES = re.compile(
    r"(?:IF|ELSE|ENDIF|LOOP|ENDLOOP|FOR|ENDFOR|WHILE|ENDWHILE|REPEATB?|UNTIL|CASE|GOTO[BFCS]?|RET)"
    r"(?![A-Z0-9_])"
)
FROM_HERE = re.compile(
    r"(?<![A-Z0-9_])(?:WHEN|WHENEVER|EVERY|DO|SETINT|DEFINE|G0*(?:70|291)|DIAM(?!OF)[A-Z0-9]*)"
    r"(?![A-Z0-9_])"
)
"""What may act on all that follows: synchronous actions, interrupts, macros, another language,
another unit, and diameters, of which steps may be radii (DIAM90)."""
STANDS = (
    "lines {} stand as they do: what they say only the control knows, or no block of words; the "
    "axes that they name are somewhere behind them"
)
UNDEFINED = (
    "names that nothing defines, where a line only sets them, are variables of the control, or "
    "axes beside X, Y, Z, A, B and C"
)
KEEPABLE = frozenset(
    ("GX203", "GX206", "GX207", "GX208", "GX209", "GX210", "GX213", "GX220", "GX221")
)
"""The refusals of what may stand as it is: it is not known, or not read."""
STANDARD = re.compile(
    r"(?:M?CALL[ \t]+)?(?:CYCLE[0-9]+|HOLES[12]|POCKET[1-4]|SLOT[12]|LONGHOLE)[ \t]*\(",
    re.IGNORECASE,
)
"""Cycles of Siemens: they return modes and frames as they were (Cycles 11.02, 1.4)."""
KEEPS = (
    "as they stand: {}; where the axes are behind them is not known, nor what they have set; "
    "units, plane, feed mode and compensation are taken to be as before"
)
MODAL_CALL = re.compile(r"(?<![A-Z0-9_])MCALL(?![A-Z0-9_])", re.IGNORECASE)
UNREAD = gx.Item("flow", ("",), (), (0, 0))
KNOWN = QUIET, frozenset(n for n in v.ISO_M if n not in (128, 129)) | {17} | GEARS
"""Commands and M codes that move nothing."""
FEED_MODES = frozenset(("93", "94", "95"))
STATE = (
    *("motion", "said", "plane", "work", "unit", "steps", "said_steps", "said_centres"),
    *("following", "comp", "changed", "tool", "waiting", "edge", "drilling", "once"),
    *("spindle", "speed", "fed", "feed_mode", "pole", "polar", "orientation"),
    *("feed_open", "feed_other"),
)


class Programs(Scaling):
    """Executes the lines of a program for a SINUMERIK."""

    writes = True
    speller = Lines
    kept = KEPT
    against = AGAINST

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        if not self.reading.stays:
            return self.executed_or_along(items)
        if self.line < self.kept_until:
            return self._perhaps(items) if self.perhaps else self._kept(items, self.kept_why, True)
        self.kept_until, self.perhaps = 0, False
        before = {**vars(self)}
        try:
            if self.unknown_cycle and self._names_axes(items, LINEAR):
                self.refuse(f"{self.unknown_cycle} is called behind this block")
            if self.line in self.stay and self._names_axes(items, ALL):
                self.refuse("only the control knows how often this is executed")
            return [*self.executed(items)]
        except gx.InputError as error:
            (found, *_) = error.diagnostics
            if found.code not in KEEPABLE:
                raise
            vars(self).update({n: before.get(n, getattr(type(self), n, None)) for n in STATE})
            if any(i.kind == "flow" and DECIDES.match(i.name) for i in items):
                self._decides_elsewhere()
            return self._perhaps(items, found.message)

    def _decides_elsewhere(self) -> None:
        """Keep what follows a decision that is not made here, where that is not yet said."""
        if self.kept_until > self.line or self.loops_on:
            self.loops_on = False
            return
        part = self.part_here()
        self.keep_perhaps(*((self.line, self.line) if part is None else (part.first, part.last)))

    def _perhaps(self, items: Sequence[gx.Item], why: str = "") -> list[str]:
        """Return the blocks of a line that is not executed here: none where it moves nothing."""
        effect = self.effect(self.lines[self.line])
        if effect is None:
            return self._kept(items, why or self.kept_why, False)
        self.lose_set(self.line, self.line)
        self.lose_axes(effect)
        self.lose_pole()
        if any(item.kind in ("named", "expression", "array") for item in items):
            self.assumed[UNDEFINED] = None
        return []

    def _names_axes(self, items: Sequence[gx.Item], axes: str) -> bool:
        return any(item.names and item.name in axes for item in self._words_in(items))

    def _words_in(self, items: Sequence[gx.Item], line: int = -1) -> Sequence[gx.Item]:
        """Return all items of a line, of one that computes too; as they are where it is not read.

        Then something among them is not known, and loses all.
        """
        if not any(item.kind in ("expression", "system", "array") for item in items):
            return items
        text = self.lines[self.line if line < 0 else line]
        try:
            return [*words_of(self.tree_of(text), text)]
        except UnexpectedInput:
            return [*items, UNREAD]

    def effect(self, text: str) -> str | None:
        """Return the axes that are lost behind a line that stays; None where it may do anything."""
        return effect_of(self.tree_of, text, lambda name: self._cell(name) is not None)

    def forget(self, lines: range) -> None:
        """Forget what lines may change that are executed again, each of them as before."""
        self.lose_set(lines.start, lines.stop - 1)
        self.lose_pole()
        for line in lines:
            text, effect = self.lines[line], self.effect(self.lines[line])
            if effect is None:
                here = [i for i in self.items(line) if i.kind not in ("comment", "block_delete")]
                effect = axes_of(self._words_in(here, line), *KNOWN)
            self.lose_axes(ALL + "F" if effect is None else effect.replace("T", ""))
            self.place.moved = True
            if effect is None:
                self.motion, self.unsaid, self.work = "", {"distance"}, ""
                self.lose_called(text)
            if effect is None or "T" in effect:
                self.tool = self.waiting = self.edge = None
            if MODAL_CALL.search(code(text)):
                self.unknown_cycle, self.drilling = text.strip(), None

    def _kept(self, items: Sequence[gx.Item], why: str, opaque: bool) -> list[str]:
        """Return the block of a line that stays as it stands."""
        if not items:
            return []
        self.lose_pole()
        items, text = self._words_in(items), self.lines[self.line]
        if FROM_HERE.search(code(text).upper()):
            self.keep_rest(why)
        line = self._codes_of(items)
        axes = None if opaque else self._moved_by(items, line)
        read = axes is not None or (opaque and self._is_read(text, items))
        (self.standing if read else self.kept_lines).append((self.line, why))
        if axes is None:
            opaque |= self._calls(text, items)
            axes = ALL
        if any(item.name == "MCALL" for item in items):
            self.unknown_cycle, self.drilling = text.strip(), None
        self._lose(items, opaque, axes)
        codes = self._modes_of(line, opaque)
        number = zlib.crc32(text.strip().encode("latin-1")) & 0xFFFFF
        if opaque or (self.perhaps and line.motion):
            self.motion = ""
        if opaque or (self.perhaps and "distance" in line.groups):
            self.unsaid = {"distance"}
        return [f"{line.number}{' '.join([*codes, f'{KEPT} P{number}'])}"]

    def _is_read(self, text: str, items: Sequence[gx.Item]) -> bool:
        """Whether a line is understood, although what it is executed in is not known."""
        return self.effect(text) is not None or axes_of(items, *KNOWN) is not None

    def _moved_by(self, items: Sequence[gx.Item], line: Line) -> str | None:
        """Return the axes that a line moves, by its words; None where it may do more."""
        axes = axes_of(items, *KNOWN)
        if axes is None or (self.perhaps and (line.groups - {"motion", "distance"} or line.work)):
            return None
        if self.unknown_cycle and {*axes} & {*LINEAR}:
            return axes + LINEAR if DRILLING.search(self.unknown_cycle) else None
        return axes + (self.drilling.axis if self.drilling is not None and axes else "")

    def _modes_of(self, line: Line, opaque: bool) -> list[str]:
        """Return the codes of a line that stays, and its feed."""
        if line.motion:
            self.motion = line.motion
        motion = self.motion_code(line, self.motion) if self.motion.isdigit() else []
        itself = "G91" in line.codes  # it says so, and stays
        if itself:
            line.codes.remove("G91")
            self.unsaid.add("distance")
            self.steps = self.said_steps
        codes = [*line.codes, *motion]
        if line.feed and line.dwell is None and "F" not in self.loses:
            codes.append(f"F{line.feed}")
        if not itself:  # where it may be another, it is the one that blocks before have said
            codes += self.distance_code(line, self.steps)
        self.said_steps = self.steps
        return codes

    def _calls(self, text: str, items: Sequence[gx.Item]) -> bool:
        """Whether a line may call what sets modes: all but words, assignments and known cycles."""
        if STANDARD.search(text):
            return False
        kinds = ("call", "command", "flow", "array")
        return any(item.kind in kinds or self._is_own(item) for item in items)

    def _is_own(self, item: gx.Item) -> bool:
        """Whether a word calls, or is an M code of the machine's own, which may be a program."""
        number = item.numbers[0] if item.kind == "word" and item.numbers else ""
        own = item.name == "M" and not (number.isdigit() and int(number) in self.dialect.m_codes)
        return item.name in ("L", "P") or (own and item.kind == "word")

    def _codes_of(self, items: Sequence[gx.Item]) -> Line:
        """Return the modes and the number of a line that stays as it stands."""
        line, before = Line(), self.steps
        for item in items:
            if item.kind in ("word", "value") and item.name in ("G", "N", "F"):
                try:
                    self._word(line, item)
                except gx.InputError:
                    self.unsaid.add("distance")
                    self.motion = ""
            elif item.kind == "command" and item.name in PATHS:
                line.motion = OTHER
        if self.perhaps and "distance" in line.groups:  # it may be executed: what was is in force
            self.steps = before
            line.codes[:] = [code for code in line.codes if code not in ("G90", "G91")]
        return line

    def _lose(self, items: Sequence[gx.Item], opaque: bool, axes: str) -> None:
        """Forget what a line may have changed."""
        self.lose_axes(axes.replace("T", ""))
        self.place.moved = True
        if axes.startswith(ALL):
            self.work = ""
        self.lose_set(self.line, self.line)
        if opaque or self.perhaps or any(i.kind == "expression" and i.name == "F" for i in items):
            self.loses.add("F")
        words = {item.name for item in items}
        if opaque or "T" in axes or words & {"T", "M", "D"}:
            self.tool = self.waiting = self.edge = None
        if opaque:
            self.lose_called(self.lines[self.line])

    def closing(self) -> Iterator[str]:
        """Say which lines are kept."""
        if self.kept_lines:
            self.assumed[self._told()] = None
        if self.standing:
            self.assumed[STANDS.format(self._few({line for line, _ in self.standing}))] = None
        return super().closing()

    def _told(self) -> str:
        few = self._few({line for line, _ in self.kept_lines})
        line, why = min(self.kept_lines)
        why = f"line {self._line_named(line)}: {why}"
        return f"lines {few} are kept " + KEEPS.format(why)

    def _few(self, lines: Collection[int]) -> str:
        """Return the first of some lines, and how many there are."""
        first = sorted(lines)[:8]
        more = " and more" if len(lines) > len(first) else ""
        return f"{', '.join(map(self._line_named, first))}{more} ({len(lines)})"

    def _line_named(self, line: int) -> str:
        """Return the number of a line, with its file where that is another one."""
        file, number = self.place_of(line)
        return str(number) if line < self.own else f"{number} of {file}"

    def _moving(self, line: Line) -> str:
        if "distance" in self.unsaid and any(not way for way, _, _ in line.axes.values()):
            message = "G90 or G91 is needed here: what was called before may have changed it"
            self.refuse(message, self.any_of(line), "write G90 in this block")
        turning = [a for a in ROTARY if a in line.axes and self._steps(line.axes[a][0])]
        if self.reading.stays and turning:
            message = f"{turning[0]} goes by a step: which way it goes to a number is a setting"
            self.refuse(f"{message} (MD30455)", self.any_of(line))
        motion = line.motion or self.motion
        if motion == OTHER:
            self.refuse("this path is no line and no arc", self.any_of(line))
        if self.reading.stays and motion != "0" and not (line.feed or self.fed):
            message = "no feed is known to be in force here"
            self.refuse(message, self.any_of(line), "write F in this block")
        return super()._moving(line)

    def _code(self, line: Line, item: gx.Item, number: str) -> None:
        super()._code(line, item, number)
        if number.isdigit() and int(number) in (90, 91):
            self.unsaid.discard("distance")

    def _word(self, line: Line, item: gx.Item) -> None:
        super()._word(line, item)
        self.fed |= item.name == "F"

    def _modal(self, line: Line, item: gx.Item, code: str) -> None:
        super()._modal(line, item, code)
        if code in FEED_MODES and code != self.feed_mode:
            self.feed_mode, self.fed = code, bool(line.feed)

    def _switched(self, line: Line, item: gx.Item, name: str) -> None:
        if self.reading.stays:
            self.refuse(f"{name}: what the words are of changes with it", item)
        super()._switched(line, item, name)

    def _other(self, line: Line, item: gx.Item, letter: str, number: str) -> None:
        codes = self.dialect.m_codes
        quiet = {*codes, *GEARS, *self.reading.inert_m}
        known = not number.isdigit() or int(number) in quiet
        if self.reading.stays and letter == "M" and not known:
            self.refuse(f"M{number} is one of the machine's own", item)
        super()._other(line, item, letter, number)

    def _quiet(self, name: str, given: Sequence[str]) -> bool:
        """Whether a call moves nothing; what it ends may be kept where it was begun."""
        return not (self.reading.stays and name == "CYCLE800") and super()._quiet(name, given)

    def _command(self, line: Line, item: gx.Item) -> None:
        if item.name == "MCALL":
            self.unknown_cycle = ""
        if self.reading.stays and item.name in FRAMES:
            self.refuse(f"{item.name} ends frames that may have been kept", item)
        super()._command(line, item)

    def _tooled(self, line: Line) -> Iterator[str]:
        """Yield the blocks of T, M6 and D; on the same control lengths need not be known."""
        if not self.reading.stays:
            yield from super()._tooled(line)
            return
        if line.tool:
            yield f"T{line.tool}{self._by_name(line)}"
        if line.changes is not None:
            if line.axes:
                self.refuse("M6 beside a move", line.changes, "give M6 its own line")
            yield "M6"
        if line.edge is not None:
            yield f"{KEPT} P{line.edge_number}"
        self.tool = self.edge = None
        self.changed |= line.changes is not None
        self.lose_axes(ALL if line.tool or line.changes is not None else LINEAR)

    def _arc(self, line: Line) -> tuple[str, dict[str, float], list[str]]:
        if self.reading.stays and not all(map(self.place.stands, self.plane)):
            self.refuse("an arc, and where it starts is not known", self.any_of(line))
        if self.reading.stays and self.scales:
            self.refuse("an arc in a program that scales", self.any_of(line))
        return super()._arc(line)

    def _check_tool(self, line: Line) -> None:
        """Ask nothing of the tool where words are words of the same control again."""
        if not self.reading.stays:
            super()._check_tool(line)

    def check_plane(self, item: gx.Item | None) -> None:
        """Ask nothing of the tool where words are words of the same control again."""
        if not self.reading.stays:
            super().check_plane(item)
