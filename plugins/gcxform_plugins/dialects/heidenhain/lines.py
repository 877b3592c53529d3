"""Blocks of words as lines of Klartext: `L X+10 Y+5 R0 FMAX`, CC and C, TOOL CALL.

One block after the other; what Klartext has no words for is refused by its name. What comes out is
read again, and has to be the program that was written: so nothing here needs to be believed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from decimal import Decimal

import gcxform as gx
from gcxform_plugins.dialects.heidenhain import unsaid
from gcxform_plugins.dialects.heidenhain.drilling import Drilling, tapped
from gcxform_plugins.dialects.heidenhain.fetching import called_with_speed, fetched_ahead, words_of
from gcxform_plugins.dialects.heidenhain.helices import Point, centred, reached, turned
from gcxform_plugins.dialects.heidenhain.kept_cycles import CallsKept
from gcxform_plugins.dialects.heidenhain.numerals import bare, coded, signed, worded
from gcxform_plugins.dialects.heidenhain.words import exact
from gcxform_plugins.dialects.shared.ways import OTHER_RADIUS

BEGIN_PGM = "BEGIN PGM "
GOES_ON = "~ "
"""What ends a line that the next one goes on with, behind a comment too; and blanks."""
AXES = "XYZABCUVW"
LINEAR = "XYZ"
MODES = frozenset(("G80", "G90.1", "G91.1", "G94", "G97", "G54", "G98", "G99"))
"""Codes that say what a TNC does anyway, as far as the reading of it shows."""
LAST = 88  # M functions above are those of the control
TIP = (128, 129)
BEHIND = frozenset((0, 1, 2, 30))
"""M functions that act behind the move of a block of words; all others do before it."""
QUIET = frozenset(("M1", "M7", "M8", "M9"))
"""M functions that leave the spindle as it is."""
TAP = "G33.1"
METRIC = 'put the pass "metric" before'
PLACES = "write the tap in G90 and G17"
PLANES = {"G17": "XY", "G18": "ZX", "G19": "YZ"}
TILTED = frozenset(("G68.2", "G53.1"))
CENTRES = dict(zip("XYZ", "IJK", strict=True))
HALF = 180.001  # degrees: words of half a turn are rounded
SIDES = {"G40": " R0", "G41": " RL", "G42": " RR", "G41.1": " RL", "G42.1": " RR"}
OF_DELTA = {"G43.1": "DL", "G41.1": "DR", "G42.1": "DR"}
"""What TOOL CALL has to have told of the tool, where codes give its measures."""


class Lines(CallsKept):
    """Writes blocks as lines of Klartext.

    place   where the axes stand, in numbers of the program; an axis that is not here is lost
    rounded by how much axes stand beside their words: a helix is said by an angle
    steps   G91 is in force;  tool: that of the last T word;  called: what that calls it
    deltas  DL and DR of that tool, as TOOL CALL says them
    side    that of the last line;  waits: what was said since, for the next line in X and Y
    """

    names_planes = True

    def __init__(self, name: str, inch: bool) -> None:
        super().__init__(re.sub(r"[^A-Z0-9_]", "", name.upper())[:16] or "A", inch)
        self.rounded: dict[str, float] = {}
        self.unit = "INCH" if inch else "MM"
        self.place: dict[str, Decimal] = {}
        self.motion, self.plane = "G0", "G17"
        self.steps = self.over = self.bounded = False
        self.tool = self.called = self.speed = self.spindle = ""
        self.deltas = ""
        self.side = self.waits = " R0"
        self.turns, self.shift = Decimal(0), dict.fromkeys(LINEAR, Decimal(0))

    # --- programs ---

    def opening(self) -> list[str]:
        """Return the first line."""
        return [f"{BEGIN_PGM}{self.name} {self.unit}"]

    def closing(self) -> list[str]:
        """Return the last line."""
        return [f"END PGM {self.name} {self.unit}"]

    def gathered(self, lines: list[tuple[str, int]]) -> Iterable[tuple[str, int]]:
        """Return lines with cycles for the moves of holes; what they are in inches is not read."""
        lines = [*called_with_speed(fetched_ahead(lines))]
        return Drilling(lines).gathered() if self.drills and not self.inch else lines

    def numbered(self, lines: list[str]) -> list[str]:
        """Return lines with their block numbers; those of a cycle's parameters have none."""
        count = iter(range(len(lines)))
        return [line if line[0] == " " else f"{next(count)} {line}" for line in lines]

    def lose(self) -> None:
        """Forget where the axes stand, and whether the spindle turns."""
        self.place, self.spindle = {}, ""

    # --- blocks ---

    def lines(self, block: str) -> list[str]:
        """Return the lines for a block. Raises UnspeakableError."""
        asides, comments, words = self.heard(block)
        if asides and asides[0].startswith(BEGIN_PGM.rstrip()):
            self.name = asides.pop(0)[len(BEGIN_PGM) :]
        text = " ".join(comments)
        comment = text.rstrip(GOES_ON) if text else None
        if asides and unsaid.IN_INCHES in words and not self.inch:
            raise unsaid.in_inches(asides[0])
        words = unsaid.beside(asides, words)
        codes = [coded(*each) for each in words if each[0] in "GM"]
        if TILTED & {*codes} or (asides and "G53" in codes):
            self._modes([code for code in codes if code not in TILTED])
            self._forget(LINEAR)
            return asides
        values = {letter: text for letter, text in words if letter not in "GMNO"}
        found = [*asides, *(self._said(codes, values) if codes or values else ())]
        if comment is not None and found and not found[0].endswith("~"):
            found[0] += f" ; {comment}"
        elif comment is not None:
            found.insert(0, f"; {comment}")
        return found

    def _said(self, codes: list[str], values: dict[str, str]) -> Iterator[str]:
        if self.over:
            raise gx.UnspeakableError("something stands behind the end of the program")
        self._modes(codes)
        functions = [c for c in codes if c[0] == "M" and c != "M6"]
        if own := [c for c in functions if int(c[1:]) > LAST or int(c[1:]) in TIP]:
            raise gx.UnspeakableError(f"{own[0]} has no words in Klartext")
        ahead = [c for c in functions if int(c[1:]) not in BEHIND]
        if "G64" in codes:
            yield from self._tolerance(bare(values.pop("P", "0")))
        if "G4" in codes:
            yield "CYCL DEF 9.0 DWELL TIME"
            yield f"CYCL DEF 9.1 DWELL {bare(values.pop('P', '0'))}"
        yield from self._tools(codes, values)
        yield from (f"M{int(c[1:])}" for c in ahead)
        for code in [c for c in functions if c not in QUIET]:
            self.spindle = code if code in ("M3", "M4") else ""
        yield from self._moves(codes, values)
        for each in [c for c in functions if c not in ahead]:
            yield from self._ends(each)

    def _modes(self, codes: list[str]) -> None:
        """Take codes that stay in force. Raises UnspeakableError for those of no TNC."""
        for code in codes:
            if code in ("G0", "G1", "G2", "G3", TAP):
                self.motion = code
            elif code in ("G17", "G18", "G19"):
                self.plane = code
            elif code in ("G90", "G91"):
                self.steps = code == "G91"
            elif code in ("G20", "G21"):
                if (code == "G20") != self.inch:
                    raise gx.UnspeakableError(*unsaid.ONE_UNIT)
            elif code == "G61":
                raise gx.UnspeakableError(*unsaid.NO_EXACT_PATH)
            elif code[0] == "G" and code not in MODES and code not in ACTS:
                raise unsaid.code_unsaid(code)

    def _tolerance(self, bound: str) -> Iterator[str]:
        """Yield cycle 32; without a tolerance the machine has one of its own, which is as near."""
        if float(bound) > 0:
            self.bounded = True
            yield "CYCL DEF 32.0 TOLERANCE"
            yield f"CYCL DEF 32.1 T{bound}"
        elif self.bounded:
            raise gx.UnspeakableError("G64 without P behind one with P has no words in Klartext")
        else:
            self.left_out["G64"] += 1

    def _tools(self, codes: list[str], values: dict[str, str]) -> Iterator[str]:
        """Yield TOOL CALL for T, M6 and S, TOOL DEF for a T that is fetched for the next change."""
        fetched = "T" in values and "M6" not in codes
        if "T" in values:
            self.tool = bare(values.pop("T"))
            self.called = f'"{self.tool_name}"' if self.tool_name else self.tool
            self.deltas = words_of(self.tool_told, self.inch)
        number, behind, speed = "", "", f" S{bare(values.pop('S'))}" if "S" in values else ""
        if "M6" in codes and not self.tool:
            raise gx.UnspeakableError("M6, and which tool it takes no T has said")
        if "M6" in codes:
            number, self.in_spindle = f" {self.called}", self.tool
            behind = self.deltas
            if "M6" not in self.inert:
                self.lose()
        if "G43" in codes and (length := bare(values.pop("H", self.in_spindle))) != self.in_spindle:
            raise self.other_length(length)
        if told := [c for c in codes if OF_DELTA.get(c, "") not in self.deltas]:
            raise gx.UnspeakableError(f"{told[0]}, and TOOL CALL has told no {OF_DELTA[told[0]]}")
        if "G43.1" in codes:
            values.pop("Z", None)
        if number or speed:
            yield f"TOOL CALL{number} Z{speed}{behind}"
        if fetched:
            yield f"TOOL DEF {self.called}"

    def _ends(self, code: str) -> Iterator[str]:
        if code in ("M2", "M30"):
            self.over = True
        if code == "M0":
            yield "STOP"
        elif code != "M2":
            yield code

    # --- moves ---

    def _moves(self, codes: list[str], values: dict[str, str]) -> Iterator[str]:
        self.waits = self._side(codes, values) or self.waits
        side = self.waits if self.waits != self.side else ""
        feed = self._feed(values)
        if feed and self.motion == "G0" and "G53" not in codes:
            yield f"L{feed}"
            feed = ""
        ends = {axis: Decimal(values.pop(axis)) for axis in AXES if axis in values}
        if frame := next((code for code in codes if code in ("G52", "G68", "G69")), ""):
            yield from self._shifted(ends) if frame == "G52" else self._turned(ends, values)
        elif "G53" in codes:
            yield f"L{worded(ends)} R0{self._rapid(feed)} M91"
            self._forget(ends)
        elif self.motion == TAP and ends:
            yield from self._tap(ends, Decimal(values.pop("K", "0")))
        elif self.motion in ("G2", "G3") and (ends or values):
            yield from self._arc(ends, values, feed)
        elif ends:
            if side and ends.keys().isdisjoint("XY"):
                raise gx.UnspeakableError(f"{side.strip()} in a line without X and Y")
            self.side = self.waits
            yield f"L{self._line(ends)}{side or self._idle(ends)}{self._rapid(feed)}"
        elif feed:
            yield f"L{feed}"
        if left := [letter for letter in values if letter not in "DH"]:
            raise gx.UnspeakableError(f"{left[0]} has no words in Klartext")

    def _tap(self, ends: dict[str, Decimal], pitch: Decimal) -> Iterator[str]:
        """Yield cycle 207 from where the tool stands. Raises UnspeakableError."""
        if self.inch:
            raise gx.UnspeakableError("a tap of a program in inches is not read", METRIC)
        if {*ends} != {"Z"} or self.steps or self.plane != "G17" or self.waits != " R0":
            raise gx.UnspeakableError("a tap by steps, or along another axis than Z in G17", PLACES)
        if "Z" not in self.place or not ends["Z"] < self.place["Z"] or not pitch > 0:
            raise gx.UnspeakableError("a tap from where it is not known, upwards, or without pitch")
        if not self.spindle:
            raise gx.UnspeakableError("a tap, and which way the spindle turns is not said before")
        yield from tapped(self.place["Z"], ends["Z"], pitch if self.spindle == "M3" else -pitch)

    def _side(self, codes: list[str], values: dict[str, str]) -> str:
        """Return R0, RL or RR where a block says it. Raises UnspeakableError."""
        side = next((SIDES[code] for code in codes if code in SIDES), "")
        radius = bare(values.pop("D", self.in_spindle or "0")) if side else ""
        of_delta = not OF_DELTA.keys().isdisjoint(codes)
        if side not in ("", " R0") and radius != self.in_spindle and not of_delta:
            raise gx.UnspeakableError(*OTHER_RADIUS)
        return side

    def _idle(self, ends: dict[str, Decimal]) -> str:
        idle = self.motion == "G0" and self.side == " R0" and not ends.keys().isdisjoint("XY")
        return " R0" if idle else ""

    def _feed(self, values: dict[str, str]) -> str:
        if "F" not in values:
            return ""
        number = Decimal(values.pop("F"))
        return f" F{exact(number * 10 if self.inch else number)}"

    def _rapid(self, feed: str) -> str:
        """Return the feed of a line; F beside a rapid would be one of a cut."""
        if self.motion != "G0":
            return feed
        if feed:
            raise gx.UnspeakableError("F beside a move in the machine has no words in Klartext")
        return " FMAX"

    def _line(self, ends: dict[str, Decimal]) -> str:
        """Return the words of ends: steps as steps, but where a helix ends they would add up."""
        words = ""
        for axis, value in ends.items():
            if self.steps and axis in self.rounded and axis in self.place:
                words += f" {axis}{signed(self.place[axis] + value)}"
            else:
                words += worded({axis: value}, "I" if self.steps else "")
        self._stand(ends)
        return words

    def _stand(self, ends: dict[str, Decimal]) -> None:
        for axis, value in ends.items():
            self.rounded.pop(axis, None)
            if not self.steps:
                self.place[axis] = value
            elif axis in self.place:
                self.place[axis] += value

    def _arc(self, ends: dict[str, Decimal], values: dict[str, str], feed: str) -> Iterator[str]:
        """Yield CC with C or CP, or CR for an arc by its radius. Raises UnspeakableError."""
        sense = " DR+" if self.motion == "G3" else " DR-"
        turns, radius = int(values.pop("P", "1")), values.pop("R", None)
        if not {*PLANES[self.plane]} <= self.place.keys():
            raise gx.UnspeakableError("an arc from where it is not known")
        if self.waits != self.side:
            raise gx.UnspeakableError(*unsaid.FROM_AN_ARC)
        if self.plane != "G17":
            if radius is not None or turns > 1:
                raise gx.UnspeakableError(*unsaid.ASIDE_ARC)
            yield from self._aside(ends, values, f"{sense}{feed}")
            return
        if radius is not None:
            if set(ends) - {"X", "Y"} or turns > 1:
                raise gx.UnspeakableError(*unsaid.HELIX)
            yield f"CR{self._line(ends)} R{signed(Decimal(radius))}{sense}{feed}"
            return
        by = {axis: Decimal(values.pop(letter, "0")) for axis, letter in (("X", "I"), ("Y", "J"))}
        pole = {axis: self.place[axis] + by[axis] for axis in "XY"}
        ends = {axis: to for axis, to in ends.items() if axis in "XY" or not self._stays(axis, to)}
        if set(ends) <= {"X", "Y"} and turns == 1 and not (self.rounded and self._whole(ends)):
            yield f"CC{worded(pole)}"
            yield f"C{self._line(ends)}{sense}{feed}"
            return
        yield from self._helix(ends, pole, turns, f"{sense}{feed}")

    def _helix(
        self, ends: dict[str, Decimal], pole: dict[str, Decimal], turns: int, how: str
    ) -> Iterator[str]:
        """Yield CC and CP, whose circle goes through the words of its end."""
        whole, start = self._whole(ends), self._stands()
        words = worded({a: v for a, v in ends.items() if a not in "XY"}, "I" if self.steps else "")
        self._stand({axis: self._still(axis) for axis in "XY"} | ends)
        end = start if whole else self._stands()
        centre, left = (pole["X"], pole["Y"]), self.motion == "G3"
        short = abs(turned(start, end, centre, left, turns)) <= HALF
        centre = centred(start, end, centre, self.inch, short)
        angle = turned(start, end, centre, left, turns)
        there = reached(start, centre, angle)
        self.rounded |= {a: v - float(self.place[a]) for a, v in zip("XY", there, strict=True)}
        yield f"CC{worded(dict(zip('XY', centre, strict=True)))}"
        yield f"CP IPA{signed(angle)}{words}{how}"

    def _stays(self, axis: str, value: Decimal) -> bool:
        """Whether the word of an axis leads to where it stands."""
        here = not self.rounded.get(axis) and (self.steps or axis in self.place)
        return here and value == self._still(axis)

    def _stands(self) -> Point:
        """Return where X and Y really stand."""
        x, y = (float(self.place[axis]) + self.rounded.get(axis, 0.0) for axis in "XY")
        return x, y

    def _still(self, axis: str) -> Decimal:
        """Return the word of an axis that goes nowhere."""
        return Decimal(0) if self.steps else self.place[axis]

    def _aside(self, ends: dict[str, Decimal], values: dict[str, str], rest: str) -> Iterator[str]:
        """Yield CC and C of an arc out of XY. Raises UnspeakableError."""
        axes = PLANES[self.plane]
        if self.side != " R0":
            raise gx.UnspeakableError(*unsaid.ASIDE_CONTOUR)
        if set(ends) - {*axes}:
            raise gx.UnspeakableError(*unsaid.ASIDE_HELIX)
        start = {axis: self.place[axis] for axis in axes}
        step = start if self.steps else dict.fromkeys(axes, Decimal(0))
        there = {a: ends[a] + step[a] if a in ends else start[a] for a in axes}
        if there == start and not self.rounded.keys().isdisjoint(axes):
            raise gx.UnspeakableError(*unsaid.ASIDE_WHOLE)
        pole = {a: start[a] + Decimal(values.pop(CENTRES[a], "0")) for a in axes}
        self.place |= there
        for axis in axes:
            self.rounded.pop(axis, None)
        yield f"CC{worded(pole)}"
        yield f"C{worded(there)}{rest}"

    def _whole(self, ends: dict[str, Decimal]) -> bool:
        """Whether an arc ends where it starts: C would then be next to nothing behind a helix."""
        return all(value == self._still(a) for a, value in ends.items() if a in "XY")

    def _turned(self, ends: dict[str, Decimal], values: dict[str, str]) -> Iterator[str]:
        """Yield cycle 10, which turns about the zero. Raises UnspeakableError."""
        if any(ends.values()) or (ends and ends.keys() != {"X", "Y"}):
            raise gx.UnspeakableError(*unsaid.TURNED)
        angle = Decimal(values.pop("R", "0"))
        if angle or self.turns:
            yield "CYCL DEF 10.0 ROTATION"
            yield f"CYCL DEF 10.1 ROT{signed(angle)}"
        self.turns = angle
        self._forget("XY")

    def _shifted(self, ends: dict[str, Decimal]) -> Iterator[str]:
        """Yield cycle 7, which is read as a shift of three axes, or as none where they stay."""
        if {*ends} != {*LINEAR} or ends == self.shift:
            raise gx.UnspeakableError(*unsaid.SHIFTED)
        for axis in ends.keys() & self.place.keys():
            self.place[axis] += self.shift[axis] - ends[axis]
        self.shift = ends
        yield "CYCL DEF 7.0 DATUM SHIFT"
        for number, (axis, value) in enumerate(ends.items(), 1):
            yield f"CYCL DEF 7.{number} {axis}{signed(value)}"

    def _forget(self, axes: Iterable[str]) -> None:
        self.place = {axis: at for axis, at in self.place.items() if axis not in axes}


ACTS = frozenset(("G4", "G43", "G43.1", "G64", "G49", "G52", "G53", "G68", "G69", *SIDES))
