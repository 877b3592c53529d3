"""Programs for a SINUMERIK 840D, line by line, as blocks of words.

A line is put in order (`reading.py`), then its blocks are made: what the control does
before the move, here, the move itself (`moves.py`), and what a modal cycle does behind it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.shared.ways import IN_SPINDLE
from gcxform_plugins.dialects.siemens.asides import AROUND, ENTRIES, KONT, named
from gcxform_plugins.dialects.siemens.axes_of_lines import OTHER
from gcxform_plugins.dialects.siemens.contours import Contours
from gcxform_plugins.dialects.siemens.cycles import HOLE, PATH, Drilling
from gcxform_plugins.dialects.siemens.frames import Frame
from gcxform_plugins.dialects.siemens.framing import rounded
from gcxform_plugins.dialects.siemens.going_along import UNITS
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, FRAMES, NOBODYS, STEP, Line
from gcxform_plugins.dialects.siemens.moves import OF_WHICH, rest_of
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY, PlaceError, text_of
from gcxform_plugins.dialects.siemens.tapping import CODE, LINES, SPOS, Tap, tap_at, turned

FEED = "write F in this block, or before"
CHANGE = 6
"""M6, which moves no axis where `inert-m` of the machine file says so."""


class Blocks(Contours):
    """Turns the lines of a SINUMERIK into blocks of words.

    feed_open  a cycle with feeds of its own has been, and F has not been programmed again
    feed_other  of those one was written as moves: what is written may have another feed in force
    spindle    M3 or M4, as it turns, or nothing;  speed: the S in force
    left_out   the names of what goes along to the same control, and is not said to another one
    calls_kept those of cycles that are called as they stand
    owed       the block of an edge that was said beside SUPA, where no word counts by it
    corners    G450 or G451, as it was said;  around: KONT is in force
    """

    feed_open = feed_other = around = False
    spindle = speed = corners = owed = ""

    grammar = ("gcxform_grammars", "siemens")
    number = gx.NUMBER
    signs = re.compile(
        rb"\b(?:TRAORI|TRAFOOF|CYCLE8[0-9]|MCALL|SUPA|CR=|G710|G700|G64[1-5]|CIP|G500|GOTO[FB]\b"
        rb"|DEF (?:REAL|INT)\b|G290|[ABC]SPLINE\b|[SMR][0-9]+[ \t]*=|OS\[|[XYZ]=[-+.0-9])|%_N_"
        rb"|\bMSG *\(\"|=(?:DC|AC|IC|ACP|ACN)\(|^[ \t]*(?:N[0-9]+[ \t]+)?"
        rb"(?:A?(?:TRANS|ROT|SCALE|MIRROR)\b|(?:_[A-Z0-9_]+|[A-Z]{2}[A-Z0-9_]*)[ \t]*\()",
        re.IGNORECASE | re.MULTILINE,
    )

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.read = {**self.read, "tool_name": self._tool_name}
        self.tool_names = gx.ToolNames(self.reading)
        self.left_out = set[str]()
        self.calls_kept: dict[str, None] = {}

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line, the first with its number. Raises InputError."""
        spindle = not self.reading.stays and any(item.name.startswith(SPOS) for item in items)
        if spindle and (tap := tap_at(self.lines, self.line)):
            return self._tapped(tap, items[-1])
        line = Line()
        for item in items:
            self.read.get(item.kind, self.unread)(line, item)
        self._check_feed(line)
        behind = self._take_around(line)
        if line.corner or (self.rounding and line.axes):
            self.take_corner(line)
        try:
            made = [block for block in (*self._made(line), behind) if block]
        except PlaceError as error:
            at = line.alone or self.any_of(line)
            raise self.refusal(error.code, error.message, at, error.hint) from None
        if line.asides and not self.reading.asides:
            self.left_out.update(map(named, line.asides))
        if line.asides and self.reading.asides:
            made[:1] = [
                f"{made[0] if made else ''} {gx.Speller.along(' '.join(line.asides))}".lstrip()
            ]
        if made and line.number:
            made[0] = line.number + made[0]
        return made

    def _tapped(self, tap: Tap, item: gx.Item) -> list[str]:
        """Return the block of a tap in step with the spindle, and pass its lines."""
        if tap.sense != self.spindle or not self.speed or Decimal(tap.speed) != Decimal(self.speed):
            message = f"a tap, with {tap.sense} S{tap.speed} not in force before it"
            self.refuse(message, item, "write it in a line before")
        beside = self.following or self.comp or self.drilling or self.steps or self.edge == NOBODYS
        if beside or self.plane != "XY" or self.frame != Frame() or self.feed_mode in ("93", "95"):
            self.refuse("a tap in steps, in a frame, or beside what changes its way", item)
        self.check_plane(item)
        if (self.changed and self.edge is None) or self.place.known("Z") != Decimal(tap.top):
            self.refuse("a tap that does not come back to where the tool is known to stand", item)
        self.at = self.line + len(LINES)
        self.motion, self.said, self.along, self.feed_open = OTHER, CODE, None, True
        self.feed_other = True
        codes = self.distance_code(Line(), False)
        return [" ".join([*tap.number, *codes, f"G{CODE} Z{tap.bottom} K{tap.pitch}"])]

    def comment(self, text: str) -> str:
        """Return the comment of a block for one of a line, or what the operator is told by it."""
        told = self.reading.asides and text[:1] in "Mm"
        return gx.Speller.along(text) if told else super().comment(text)

    def _check_feed(self, line: Line) -> None:
        """Refuse a cut behind a cycle with feeds of its own, until F is programmed again."""
        self.feed_open &= not line.feed or line.dwell is not None
        self.feed_other &= self.feed_open
        cuts = (line.motion or self.motion) != "0" and line.alone is None and line.pole is None
        if self.feed_open and cuts and (line.axes or line.centres or line.named):
            message = "which feed is in force behind a cycle with its own is not known"
            self.refuse(message, self.any_of(line), FEED)

    def _take_around(self, line: Line) -> str:
        """Take how contours are gone round, and say it there, and again where each begins.

        Return the block of it where the line has blocks of their own; one that stays says it
        itself. Raises InputError for what leads to contours another way.
        """
        said = [each for each in line.asides if each in AROUND]
        ways = [each for each in line.asides if each in ENTRIES]
        self.corners = said[-1] if said else self.corners
        self.around = ways[-1] == KONT if ways else self.around
        begins = self.comp and "comp" in line.groups
        if begins and self.around:
            self.refuse(f"{KONT}: which way leads to the contour is not certain", self.any_of(line))
        if self.reading.stays or not (self.corners and (begins or said)):
            return ""
        line.asides = [each for each in line.asides if each not in AROUND]
        if line.dwell or line.act or line.cycle or line.alone or line.pole:
            return self.corners
        line.codes.append(self.corners)
        return ""

    def _made(self, line: Line) -> Iterator[str]:
        framed = line.alone is not None and line.alone.name in FRAMES
        if framed or line.pole is not None:
            self._check_alone(line)
            if line.pole is not None:
                self.set_pole(line)
            else:
                yield from self.set_frame(line)
            return
        if line.alone is not None:
            self._take_alone(line, line.alone)
        if line.dwell is not None or line.act is not None or line.cycle is not None:
            yield from self._alone(line)
            return
        yield from self._before(line)
        if line.modal is not None and (line.axes or line.centres):
            self.refuse("MCALL beside a move", line.modal, "give it its own line")
        if line.machine is not None and (line.axes or line.centres or line.named or line.middles):
            yield self._in_machine(line)
            return
        yield self.block_of(line)
        yield from line.behind
        if self.drilling is not None and (line.axes or line.centres):
            if not self.drilling.kept:
                self.called_behind.add(self.visit)
            yield from self._holes(self.drilling)

    def _before(self, line: Line) -> Iterator[str]:
        """Yield the blocks of tools and lengths, and take another work offset."""
        yield from line.ahead
        if line.tool or line.changes is not None or line.edge is not None:
            yield from self._tooled(line)
        if self.owed and line.machine is None and not line.says_only("tool", "tool_name", "others"):
            yield self.owed
            self.owed = ""
        if line.work is not None:
            self._shift(line.work[0])

    # --- lines of one thing ---

    def _take_alone(self, line: Line, item: gx.Item) -> None:
        if line.axes or line.centres or line.codes or line.motion:
            self.refuse("this stands in a block of its own", item, "give it its own line")
        if item.name.upper().startswith("CYCLE800") and not self.swivelled:
            self.end_swivel()

    def _check_alone(self, line: Line) -> None:
        """Refuse a frame or a pole beside what is no word of it (PM 631, F 118)."""
        item = line.alone or (line.pole[1] if line.pole else None)
        if not line.says_only("pole" if line.alone is None else "alone", "axes", "named"):
            self.refuse("this stands in a block of its own", item, "give it its own line")

    def _alone(self, line: Line) -> Iterator[str]:
        """Yield the blocks of G4, of what follows the tip, and of a cycle at this place."""
        item = line.dwell or line.cycle or (line.act[1] if line.act else None)
        name = next(name for name in ("dwell", "cycle", "act") if getattr(line, name) is not None)
        if not line.says_only(name, "feed"):
            self.refuse("this stands in a block of its own", item, "give it its own line")
        if line.dwell is not None:
            if not line.feed:
                self.refuse("G4 without F: only seconds are read", item, "write G4 F and seconds")
            yield f"G4 P{line.feed}"
        elif line.act is not None:
            self.following = line.act[0] == "M128"
            if self.following and (self.drilling is not None or self.comp):
                self.refuse("TRAORI under MCALL or compensation", item, "end them before")
            if not self.place.unturned():
                self.place.lose(LINEAR, shifted=False)
            yield from (f"F{line.feed}" if line.feed else "", line.act[0])
        elif self.once is not None:
            yield f"F{line.feed}" if line.feed else ""
            for place in self.holes or (None,):
                yield from self._to_hole(place)
                yield from self._holes(self.once)
            self.once, self.holes = None, []

    def _to_hole(self, place: tuple[Decimal, Decimal] | None) -> Iterator[str]:
        """Yield the way to a hole of a pattern; none to where the axes stand."""
        if place is not None:
            texts = [text_of(rounded(value)) for value in place]
            for axis, text in zip(self.plane, texts, strict=True):
                self.place.absolute(axis, text)
            ends = [axis + text for axis, text in zip(self.plane, texts, strict=True)]
            words = ["G0", *self.outside(False, ends)]
            yield " ".join([*self.distance_code(Line(), False), *words])
            self.said, self.place.moved = "0", True

    def _holes(self, hole: Drilling) -> Iterator[str]:
        """Yield the moves of a cycle where the axes stand. Raises PlaceError."""
        if self.changed and self.edge is None:
            self.refuse("a cycle, and which edge is in force behind M6 is not known")
        if self.edge == NOBODYS:
            self.refuse(OF_WHICH, None, IN_SPINDLE)
        self.check_plane(None)
        self.check_offset(None)
        if (self.feed_other if hole.kept else self.feed_open) and not hole.own_feed:
            self.refuse(
                "which feed is in force behind a cycle with its own is not known", None, FEED
            )
        if hole.kept:
            yield from self._kept_hole(hole)
            return
        for k, (code, text, feed) in enumerate(hole.steps):
            if code == "4":
                yield f"G4 P{text}"
                continue
            self.place.absolute(hole.axis, text)
            words = [f"G{code}", *self.outside(False, [hole.axis + text])]
            words += [f"F{feed}"] if feed else []
            yield " ".join([*([] if k else self.distance_code(Line(), False)), *words])
        self.said, self.feed_open = "0", hole.own_feed
        self.along = None
        self.feed_other = hole.own_feed

    def _kept_hole(self, hole: Drilling) -> Iterator[str]:
        """Yield the block of a cycle that stays as it stands, with the level at which it ends."""
        words: list[str] = []
        ground = self._level(hole, hole.ground) if hole.ground else []
        for _, level, _ in hole.steps:
            words = self._level(hole, level)
        if [word for word in words if word[0] != hole.axis]:
            self.refuse("a cycle that stays as it stands, in a frame that tilts")
        if self.frame != Frame():
            self.in_place[self.line] = UNITS
        yield from self.distance_code(Line(), False)
        ends = [word if "." in word else f"{word}." for word in words]  # else increments, perhaps
        code = PATH if hole.cuts else HOLE
        ends += [f"K{Decimal(words[0][1:]) - Decimal(word[1:]):f}" for word in ground]
        yield " ".join([code, *ends, gx.Speller.aside(hole.kept)])
        self.calls_kept[hole.kept.partition("(")[0].strip().upper()] = None
        self.feed_open |= not hole.of_before
        self.along, self.place.moved = None, True
        if hole.cuts:
            gone = self.plane if words else LINEAR
            self.place.lose(gone, shifted=False)
            self.loses |= {*gone}

    def _level(self, hole: Drilling, level: str) -> list[str]:
        """Return the words that lead the tool along its axis to a level. Raises PlaceError."""
        self.place.absolute(hole.axis, level)
        return self.outside(False, [hole.axis + level])

    # --- tools ---

    def _other(self, line: Line, item: gx.Item, letter: str, number: str) -> None:
        if letter == "M":
            self.spindle = turned([f"M{number.lstrip('0') or '0'}"], self.spindle)
        elif letter == "S":
            self.speed = number
        super()._other(line, item, letter, number)

    def _tool_name(self, line: Line, item: gx.Item) -> None:
        """T="NAME": the tool that the machine file calls so. Raises InputError."""
        if item.names[0] != "T" or line.tool:
            self.refuse(
                f"{item.names[0]} by a name, or a second tool", item, "write T and a number"
            )
        name = self.text_of(item).split('"')[1]
        try:
            line.tool, line.tool_name = self.tool_names.number(name), name
        except gx.UnspeakableError as why:
            self.refuse(str(why), item, why.hint)

    def _by_name(self, line: Line) -> str:
        return self.tool_names.beside(line.tool_name) if line.tool_name else ""

    def _tooled(self, line: Line) -> Iterator[str]:
        """Yield the blocks of T, M6 and D, in this order."""
        if line.tool:
            self.waiting, self.promised = line.tool, ""
            if line.changes is None and self.reading.control.get("tool-change-by") == "T":
                line.changes = line.edge or self.any_of(line) or gx.Item("word", ("T",), (), (0, 0))
        if line.changes is not None:
            yield from self._changed(line, line.changes)
        elif line.tool:
            yield f"T{line.tool}{self._by_name(line)}"
        if line.edge is not None:
            yield from self._edged(line, line.edge)

    def _changed(self, line: Line, item: gx.Item) -> Iterator[str]:
        """Yield the block of M6, and of the edge that is then in force."""
        if line.axes or self.following:
            message = "M6 beside a move, or while TRAORI is in force"
            self.refuse(message, item, "give M6 its own line, with TRAFOOF before")
        yield f"T{line.tool} M6{self._by_name(line)}" if line.tool else "M6"
        self.tool, self.changed, self.edge, self.along = self.waiting, True, None, None
        self.owed = ""
        moves = self.dialect.m_codes[CHANGE].loses_position
        if moves and CHANGE not in self.reading.inert_m:
            self.place.lose(LINEAR + ROTARY)
        setting = self.reading.control.get("edge-after-tool-change")
        agree = setting in (0, 1) and self.promised in ("", str(int(setting)))
        if line.edge is None and setting is not None and agree:
            yield from self._with_edge(str(int(setting)))
        self.promised = ""

    def _edged(self, line: Line, item: gx.Item) -> Iterator[str]:
        """Yield the block of D: behind SUPA, where no word there counts by a length."""
        if line.edge_number not in ("0", "1"):
            message = f"D{line.edge_number} is another cutting edge, of unknown length"
            self.refuse(message, item, "use D1, or give the edge its own tool number")
        if line.changes is None and self.waiting not in (None, self.tool):
            self.promised = line.edge_number
        waits = line.machine is not None and "Z" not in line.axes and line.edge_number == "1"
        for block in self._with_edge(line.edge_number):
            self.owed = block if waits else ""
            yield "" if waits else block

    def _with_edge(self, number: str) -> Iterator[str]:
        """Yield the block for an edge; none for that of a tool which nobody knows."""
        known = number == "0" or self.tool not in (None, "0")
        number = number if known else NOBODYS
        if number == self.edge:
            return
        self.edge = number
        self.place.lose("Z" if self.length_is_along_z else LINEAR)
        if known:
            yield f"G43 H{self.tool}" if number == "1" else "G49"

    # --- frames ---

    def _shift(self, name: str) -> None:
        """Take another work offset."""
        if name != self.work and (self.work or self.place.moved):
            self.place.lose(LINEAR + ROTARY)
            self.lose_pole()
        self.work = name

    def _in_machine(self, line: Line) -> str:
        """Return the block of SUPA: in the coordinates of the machine, without a tool length."""
        self.motion = motion = line.motion or self.motion
        hint = "say where the spindle shall stand: G0 SUPA, absolute words, D0; and TRAFOOF before"
        aside = self.edge in ("1", NOBODYS) and "Z" not in line.axes and self.length_is_along_z
        if not (self.edge == "0" or aside) or self.following:
            message = "SUPA with a tool length or TRAORI in force, or where that is not known"
            self.refuse(message, line.machine, hint)
        arc = line.centres or line.named or line.middles
        if motion not in ("0", "1") or arc or self.comp or self.drilling:
            message = "SUPA needs G0 or G1, and neither compensation nor a cycle"
            self.refuse(message, line.machine, hint)
        words = []
        for axis, (way, number, item) in line.axes.items():
            if way == STEP or (not way and self.steps):
                self.refuse("SUPA in incremental words", item, hint)
            if way not in ("", ABSOLUTE) and (motion != "0" or axis not in ROTARY):
                self.refuse(f"SUPA beside {way} goes a way that is not known", item, hint)
            if way in ("", ABSOLUTE):
                self.place.absolute(axis, number)
            self.place.unwound.discard(axis)
            words.append(axis + number)
        self.place.lose(self.moved_inside(line.axes))
        self.place.moved = True
        self.along = None
        codes = [*self.motion_code(line, motion), *self.distance_code(line, False)]
        return " ".join([*line.codes, *codes, *(["G53"] if words else []), *words, *rest_of(line)])
