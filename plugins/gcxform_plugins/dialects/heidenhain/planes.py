"""PLANE: where it tilts nothing, and where a table that is known turns onto the plane.

Without a tilt its lines go along. With one words count in the plane once the rotary axes stand as
it asks; which attitude that is, `tilting.py` says, and where words then lead,
`gcxform/modal/frames/planes.py`. STAY turns nothing: lines behind it do, by Q120 to Q122 or by
numbers, and until then nothing else may move. TURN turns the rotary axes alone. MOVE leads X, Y and
Z along, MB draws the tool back before: where they then are only the machine knows.

Of an axis behind PLANE it is not certain that it is in the plane before it has been told to go
somewhere (TNC 320, cycles, p. 258): so X and Y count together, or not at all.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from typing import Any, NoReturn

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.cycles import Cycles
from gcxform_plugins.dialects.heidenhain.datums import VALUE
from gcxform_plugins.dialects.heidenhain.numerals import worded
from gcxform_plugins.dialects.heidenhain.positioning import Said
from gcxform_plugins.dialects.heidenhain.tilting import (
    ALIKE,
    EQUALLY_NEAR,
    WORDS,
    Attitude,
    TiltError,
    euler,
    matrix_of,
)
from gcxform_plugins.dialects.heidenhain.words import LINEAR, ROTARY, exact, written

NUMBER = rf"(?:{VALUE}|[+-]?\s*Q[LR]?\d+)"
OPTION = (
    rf"(?:F\s*MAX|F\s*AUTO|F\s*{NUMBER}|(?:SEQ|SYM)\s*[+-]|(?:TABLE|COORD)\s+ROT"
    rf"|(?:DIST|ABST)\s*{NUMBER}|MB\s*(?:MAX|{NUMBER}))"
)
SAID = re.compile(rf"PLANE\s+([A-Z]+)(\s.*?)?\s+(STAY|TURN|MOVE)((?:\s+{OPTION})*)\s*")
WORD = re.compile(rf"(P\d[XYZ]|[A-Z]+)\s*({NUMBER})")
FEED = re.compile(rf"\sF\s*(?:{NUMBER}|AUTO)")
SIGN = re.compile(r"\s(SEQ|SYM)\s*([+-])")
TABLE, DRAWS_BACK = re.compile(r"\s(TABLE|COORD)\s"), re.compile(r"\s(?:MB|DIST|ABST)(?![A-Z])")
PLANE, TURN, LEAVE = "G68.2", "G53.1", "G69"
"""The codes of blocks that say a plane, turn the table onto it, and leave it."""
WORDS_OF = dict(zip(ROTARY, "IJK", strict=True))
ANGLES = dict(zip(ROTARY, ("Q120", "Q121", "Q122"), strict=True))
MOVING = re.compile(r"CYCLE?\s+CALL|F(?:LT?|CT?)(?![A-Z])")
FOLLOWS = re.compile(r"FUNCTION\s+TCPM")
CALLS, RETRACTS, IN_MACHINE = {"89", "99"}, "140", {"91", "92"}
ALONE = "PLANE turns no rotary axis but {}"
STARTS = "say where they stand: start = {{ {} }} in [input]"
NO_TABLE = (
    "it tilts the plane, and how the machine's tables turn is not known",
    "give a machine file that says which tables it has, and where their axes are",
)
OTHERS = "PLANE beside a contour, a rotation, a mirror image, or a tip that is followed"
LED = "MOVE and MB lead X, Y and Z to where only the machine knows"
TURN_FIRST = "turn them there in a line of their own before, as L A+Q120 C+Q122 R0 FMAX"
RESET_FIRST = "write PLANE RESET STAY before"
ROTARY_ALONE = frozenset(ROTARY)
OPEN, WAITS, STANDS = "the datum was set anew in it", "the axes do not stand in it yet", ""


@dataclass(frozen=True, slots=True)
class Tilt:
    """A tilted plane: the words of its block, the angles that it asks for, and `why` not yet."""

    words: str
    angles: dict[str, float]
    why: str = WAITS


class Planes(Cycles):
    """Reads PLANE; `tilt` is the plane in force, None without one."""

    tilt: Tilt | None = None

    def plane_of(self, item: gx.Item) -> list[str]:
        """PLANE: what tilts nothing goes along; the table turns onto what does."""
        found = SAID.fullmatch(item.name)
        if found is None:
            self._unresolved(item)
        kind, words, how, options = found[1], found[2] or "", found[3], found[4]
        if kind == "RESET" and not words.strip():
            return self._left(item, how, options) if self.tilt else self._untilted(item, found)
        if kind not in WORDS:
            self._unresolved(item)
        said = self._words(item, kind, words)
        null = kind == "SPATIAL" and not any(said.values())
        if null and self.tilt is None and (self._is_upright() or not self._follows()):
            return self._untilted(item, found)
        if not self._follows():
            self._unresolved(item, *(() if self.reading.stays else NO_TABLE))
        return self._tilted(item, kind, said, how, options)

    def _unresolved(self, item: gx.Item, why: str = "", *hints: str) -> NoReturn:
        name = item.name.strip()[:40]
        self.refuse(f"{name}: {why}" if why else f"{name} is not resolved", item, *hints)

    def _words(self, item: gx.Item, kind: str, text: str) -> dict[str, float]:
        """Return the numbers by which a plane is said. Raises InputError."""
        said: dict[str, float] = {}
        rest = text.strip()
        while rest and (word := WORD.match(rest)) is not None:
            number = word[2]
            said[word[1]] = float(
                self.parameter(number, item) if "Q" in number else number.replace(",", ".")
            )
            rest = rest[word.end() :].strip()
        if rest or said.keys() != {*WORDS[kind]}:
            self._unresolved(item)
        return said

    def _follows(self) -> bool:
        """Whether a tilt may be followed: on its own control, or folded; on a known table."""
        reading = self.reading
        own = reading.asides or reading.turns_plainly or not reading.crosses
        return own and not reading.stays and reading.tables is not None

    # --- without a tilt ---

    def _is_upright(self) -> bool:
        """Whether all rotary axes are known to be at 0."""
        axes = self._axes()
        return bool(axes) and not any(float(self.place.get(axis, "nan")) for axis in axes)

    def _axes(self) -> list[str]:
        return sorted({*self.reading.rotary, *self.turned()})

    def _untilted(self, item: gx.Item, found: re.Match[str]) -> list[str]:
        """Return the blocks of PLANE that tilts nothing. Raises InputError for what may, or moves.

        TURN and MOVE lead the rotary axes to 0, which is nothing where they stand there.
        """
        kind, how, options = found[1], found[3], found[4]
        if " MB" in options:
            self._unresolved(item)
        self.ends(f"PLANE {kind}", item)
        axes, spatial = self._axes(), kind != "RESET"
        open_ = [axis for axis in axes if axis not in self.place]
        turned = any(Decimal(self.place[axis]) for axis in axes if axis in self.place)
        if how != "STAY":
            self.assumed[ALONE.format(" and ".join(axes))] = None
            if turned or open_ or not axes or self.following:
                self._refuse_turned(item, axes, open_)
        elif spatial and (turned or self.following or (open_ and not self.reading.stays)):
            self._refuse_turned(item, axes, open_)
        self.untilted = spatial
        self.q |= dict.fromkeys(ANGLES.values())
        if spatial and not open_:
            self.q |= {ANGLES[axis]: 0.0 for axis in axes}
        if FEED.search(options):
            self.feed_lost = True
        return self.along()

    def _refuse_turned(self, item: gx.Item, axes: Sequence[str], open_: Sequence[str]) -> NoReturn:
        """Refuse PLANE where an axis is turned, or may be: `open_` are those that may."""
        known = axes and not open_
        places = ", ".join(f"{axis} = 0" for axis in axes or "AC")
        why = "an axis is turned" if known else "whether an axis is turned is not known"
        told = known or {*self.moved, *self.lost}.intersection(open_ or ROTARY)
        hint = () if told else (STARTS.format(places),)
        self._unresolved(item, why, *hint)

    # --- into a plane ---

    def _tilted(
        self, item: gx.Item, kind: str, said: dict[str, float], how: str, options: str
    ) -> list[str]:
        """Return the blocks of PLANE that tilts. Raises InputError."""
        if self.following or self.side or self.turn != 0 or self.mirrored != "":
            self.refuse(OTHERS, item, "end these before")
        moves = self._is_led(item, how, options)
        try:
            matrix = matrix_of(kind, said)
            attitude = self._attitude(options)
            angles = attitude.angles(matrix)
        except TiltError as error:
            self._unresolved(item, error.message, *error.hints)
        if attitude.by_example:
            self.assumed[EQUALLY_NEAR.format(attitude.master)] = None
        zero = "".join(f" {axis}0" for axis in LINEAR)
        turns = "".join(f" {letter}{written(angle)}" for letter, angle in self._said(matrix))
        blocks = [LEAVE] if self._is_in_plane() else []
        self.tilt = Tilt(f"G90 {PLANE}{zero}{turns}", angles)
        self.untilted = False
        self.q |= dict.fromkeys(ANGLES.values())
        self.q |= {ANGLES[axis]: float(written(angle)) for axis, angle in angles.items()}
        self.lose(LINEAR)
        self.pole = {}
        if how == "STAY":
            return [*blocks, *self._goes(), *self.stood()]
        return [*blocks, *self._onto(gone=moves, beside=self.statement)]

    @staticmethod
    def _said(matrix: Any) -> list[tuple[str, float]]:
        return [*zip("IJK", euler(matrix), strict=True)]

    def _attitude(self, options: str) -> Attitude:
        """Return what chooses the attitude for a line."""
        sign, rot = SIGN.search(options), TABLE.search(options)
        standing = {axis: float(self.place[axis]) for axis in ROTARY if axis in self.place}
        chain = self.reading.tables
        assert chain is not None  # else no plane is followed
        name, way = (sign[1], sign[2]) if sign else ("", "")
        return Attitude(chain, way, name == "SYM", rot[1] if rot else "", standing)

    def _is_led(self, item: gx.Item, how: str, options: str) -> bool:
        """Whether PLANE moves X, Y and Z itself. Raises InputError."""
        back, feeds = DRAWS_BACK.search(options), FEED.search(options)
        if how == "STAY" and (back or feeds):
            self._unresolved(item)
        moves = how == "MOVE" or back is not None
        if moves and self.reading.turns_plainly:
            self.refuse(LED, item, "let the CAM draw the tool back by lines, and turn by TURN")
        if feeds and self.reading.turns_plainly:
            self._unresolved(item, "it turns at a feed", "say FMAX in its place")
        self.feed_lost |= feeds is not None
        return moves

    def _goes(self) -> list[str]:
        """Return the block of a line of PLANE that turns nothing: it is gone with the plane."""
        return [LEAVE] if self.reading.turns_plainly else self.along()

    def stood(self) -> list[str]:
        """Return the blocks of a plane that waits, once the rotary axes stand as it asks."""
        tilt = self.tilt
        if tilt is None or tilt.why != WAITS:
            return []
        return [] if self._lacks() else self._onto()

    def turned_in_tilt(self, said: Said, ends: dict[str, str]) -> str | None:
        """Return the block of a line that turns axes onto a plane; None of one that does not.

        It stays in the machine, so that no X, Y or Z comes into its line. Where it does nothing but
        to turn all of them onto the plane, in rapid, that is what the plane's own block does.
        """
        if (
            self._is_in_plane()
            and ROTARY_ALONE.issuperset(ends)
            and ends.items() <= self.place.items()
        ):
            return ""  # they stand there, and no X, Y or Z may come into this line either
        if self.tilt is None or self.tilt.why != WAITS:
            return None
        self.place.update(ends)
        self.moved.update(ends)
        if not said.rapid:
            self._check_feed()
        elif not said.after and not self._lacks():
            return ""
        self.motion = "G0" if said.rapid else "G1"
        turned = worded({axis: Decimal(number) for axis, number in ends.items()})
        words = "".join(f" {axis}{number}" for axis, number in ends.items())
        way = f" F{exact(Decimal(self.feed).scaleb(self.inch))}" if said.feed else ""
        line = f"L{turned} R0{' FMAX' if said.rapid else way}"
        code = "" if self.reading.turns_plainly else "G53 "
        return f"{code}{self.motion}{words}{said.feed}{self._aside(line)}"

    def _lacks(self) -> bool:
        """Whether an axis stands elsewhere than a plane asks, if not in a whole turn of it."""
        assert self.tilt is not None
        away = (float(self.place.get(a, "nan")) - angle for a, angle in self.tilt.angles.items())
        return not all(abs(math.remainder(each, 360.0)) <= ALIKE for each in away)

    def _onto(self, gone: bool = False, beside: str = "") -> list[str]:
        """Return the blocks of a plane in which the axes stand, or turn to now.

        `gone`: X, Y and Z are then where only the machine knows. `beside` is the line that turns
        them; without one this line has done it.
        """
        assert self.tilt is not None
        tilt = self.tilt = replace(self.tilt, why=STANDS)
        if beside:
            self.place |= {axis: written(angle) for axis, angle in tilt.angles.items()}
            self.moved |= {*tilt.angles}
        self.motion = "G0"
        self.loses |= {*LINEAR} if gone else set()
        turned = {axis: Decimal(self.place[axis]) for axis in tilt.angles}
        line = "" if beside else f"L{worded(turned)} R0 FMAX"
        words = "".join(f" {WORDS_OF[axis]}{exact(angle)}" for axis, angle in turned.items())
        plane = f"{self.in_plane('G17')}{tilt.words}{self._aside(beside)}"
        return [plane, f"G0 {TURN}{words}{self._aside(line)}"]

    def _aside(self, line: str) -> str:
        """Return a line that goes along beside its block, which words take the place of if any."""
        stays = line and self.reading.asides and not self.reading.turns_plainly
        return f" {gx.Speller.aside(line)}" if stays else ""

    def _is_in_plane(self) -> bool:
        return self.tilt is not None and self.tilt.why == STANDS

    # --- in a plane, and out of it ---

    def check_tilt(self, items: Sequence[gx.Item]) -> None:
        """Refuse moves where a plane leads nowhere yet, or out of it. Raises InputError."""
        if self.tilt is None:
            return
        first = items[0]
        functions = {item.numbers[0].lstrip("0") for item in items if item.kind == "m"}
        if IN_MACHINE & functions:
            self.refuse("M91 or M92 in a tilted plane: some controls refuse it", first, RESET_FIRST)
        if "128" in functions or FOLLOWS.match(first.name):
            self.refuse("M128 or TCPM in a tilted plane", first, RESET_FIRST)
        if self.tilt.why == STANDS:
            return
        axes = [item.name for item in items if item.kind == "axis"]
        rotary = first.name == "L" and all(axis in ROTARY for axis in axes)
        moves = first.kind in ("path", "onto") and not rotary
        moves |= first.kind == "text" and MOVING.match(first.name) is not None
        if moves or RETRACTS in functions or CALLS & functions:
            hint = TURN_FIRST if self.tilt.why == WAITS else RESET_FIRST
            self.refuse(f"a move in a tilted plane, and {self.tilt.why}", first, hint)

    def check_one_axis(self, ends: Sequence[str]) -> None:
        """Let go of X and Y where one of them goes into a plane without the other."""
        alone = len({"X", "Y"}.intersection(ends)) == 1 and not {"X", "Y"} <= self.place.keys()
        if self.tilt is not None and alone and not {"X", "Y"} <= {*ends, *self.place}:
            self.loses |= {*LINEAR}

    def preset(self, item: gx.Item, given: dict[int, Decimal]) -> list[str]:
        """Cycle 247, which may end a plane. Raises InputError."""
        if self.tilt is not None:
            self.refuse("a preset in a tilted plane", item, RESET_FIRST)
        return super().preset(item, given)

    def in_tilt(self) -> bool:
        """Whether lines are in a plane by more than their words."""
        there = self._is_in_plane() and {"X", "Y"} <= self.place.keys()
        return self.tilt is not None and not there

    def shifted_in_tilt(self, item: gx.Item, shift: dict[str, str]) -> list[str]:
        """Return the blocks that leave a plane in which the datum is set anew.

        Only if all shifts end it does not matter in which order they are taken.
        """
        if self.tilt is None:
            return []
        if any(map(float, shift.values())):
            self.refuse("a datum shift in a tilted plane", item, RESET_FIRST)
        blocks = [LEAVE] if self._is_in_plane() else []
        self.tilt = replace(self.tilt, why=OPEN)
        self.lose(LINEAR)
        return blocks

    def _left(self, item: gx.Item, how: str, options: str) -> list[str]:
        """Return the blocks of PLANE RESET behind a plane."""
        assert self.tilt is not None
        moves, axes = self._is_led(item, how, options), [*self.tilt.angles]
        blocks = [LEAVE] if self._is_in_plane() or self.reading.turns_plainly else []
        self.tilt = None
        self.q |= dict.fromkeys(ANGLES.values())
        self.lose(LINEAR)
        self.pole = {}
        if how == "STAY":
            return [*(() if self.reading.turns_plainly else self.along()), *blocks]
        self.place |= dict.fromkeys(axes, "0")
        self.motion = "G0"
        self.loses |= {*LINEAR} if moves else set()
        words = "".join(f" {axis}0" for axis in axes)
        code = "G0" if self.reading.turns_plainly else "G53 G0"
        return [*blocks, f"{code}{words}{self._aside(self.statement)}"]
