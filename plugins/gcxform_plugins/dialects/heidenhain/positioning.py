"""The words of one positioning block of a TNC, sorted: coordinates, feed, M functions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.words import ROTARY, Words
from gcxform_plugins.dialects.shared.own_functions import INERT, OF_BUILDER

AT_START = {13: ("M3", "M8"), 14: ("M4", "M8")}
"""What M functions become that act at the start of their block, where that is not themselves."""
AT_END = {0: ("M5", "M0"), 1: ("M1",), 5: ("M5",), 6: ("M6",), 9: ("M9",), 129: ("M129",)}
ENDS = (2, 30)
CALLS = 99
TURNS = {3: "M3", 13: "M3", 4: "M4", 14: "M4"}
LEAVES_SPINDLE = frozenset({1, 7, 8, 9, 91, 99, 126, 127, 128, 129})
TELLS_SPINDLE = frozenset({0, 2, 3, 4, 5, 6, 13, 14, 30})
LONGEST_M = 4  # digits
MACHINE = 91
BUILDERS = 92
CHANGES = 6
STOPS, LEAVES_TIP = 0, 129
NEVER_BESIDE = (6, 91, 128, 129)
SHORTEST = frozenset({126, 127})
SILENT = frozenset({90, 102, 107, 108, 111, 113, 115, 117, 137, 145})
"""Rounding of corners, messages, and M functions that cancel what is refused here."""
ROUNDS = 90
MOVES_ZERO = frozenset({115, 145})
"""Those of them behind which coordinates are others, if what they cancel has been."""
FIRST_OF_CONTROL = 89  # M functions below are those of the machine's builder
POINT_OF_M92 = "X, Y, Z = ... in [home.M92] of the machine file say where, in its coordinates"
WHY = {
    89: "it calls a cycle behind each block",
    92: "it counts from a point of the machine that its builder has set",
    94: "it reduces what rotary axes show, so that they count from elsewhere",
    97: "it cuts contours in a way of its own",
    98: "it cuts contours in a way of its own",
    101: "it changes the tool by itself",
    103: "it changes the feed of moves downwards",
    109: "it changes the feed along arcs",
    110: "it changes the feed along arcs",
    114: "it moves the axes by what the builder's kinematics say",
    116: "feeds of rotary axes then depend on how far the tool is from them",
    118: "the handwheel then moves the axes as well",
    120: "it changes the contour by the radius of the tool",
    124: "it leaves points out",
    130: "it leaves the tilted plane out",
    136: "it is a feed per turn of the spindle, in a unit that is not certain",
    138: "it chooses which rotary axes are followed",
    140: "it retracts along the tool by what only the control knows",
    144: "it moves the axes by what the builder's kinematics say",
}


@dataclass(slots=True)
class Said:
    """What a block says. `feed` is its F word, `before` and `after` are blocks of M functions.

    `machine` is M91, or M92, which counts from the place `counts_from`.
    """

    axes: list[gx.Item] = field(default_factory=list)
    feed: str = ""
    rapid: gx.Item | None = None
    sense: str = ""
    side: gx.Item | None = None
    radius: str = ""
    machine: gx.Item | None = None
    counts_from: Mapping[str, float] | None = None
    leaves: bool = False
    calls: gx.Item | None = None
    changes: bool = False
    before: list[str] = field(default_factory=list)
    after: list[str] = field(default_factory=list)
    end: str = ""


class Saying(Words):
    """Sorts the words of positioning blocks."""

    def said(self, items: Sequence[gx.Item]) -> Said:
        """Return what the words behind a path function say. Raises InputError."""
        said, last = Said(), 0
        for item in items:
            kind = item.kind
            if kind == "axis":
                said.axes.append(item)
            elif kind == "m":
                last = self._function(item, said)
                continue
            elif kind == "feed":
                if last == 128:  # it limits the moves that keep the tip in its place
                    self.number_of(item)
                elif said.feed:
                    raise self.refusal("GX203", "F stands here twice", item)
                else:
                    said.feed = self.feed_word(self.number_of(item))
            else:
                self._other(item, said)
            last = 0
        if said.rapid and said.feed:
            raise self.refusal("GX202", "F and FMAX in one block", said.rapid)
        return said

    def _other(self, item: gx.Item, said: Said) -> None:
        """Take what is neither a coordinate nor a feed nor an M function."""
        if item.kind == "fast":
            said.rapid = item
        elif item.kind == "auto":
            if not self.tool_feed:
                raise self.refusal("GX204", "no TOOL CALL gives the feed of FAUTO", item)
            said.feed, self.feed, self.feed_lost = f" F{self.tool_feed}", self.tool_feed, False
        elif item.kind == "dr":
            if said.sense:
                raise self.refusal("GX203", "DR stands here twice", item)
            said.sense = "G3" if item.name[-1] == "+" else "G2"
        elif item.kind == "radius":
            self._radius(item, said)
        elif item.kind == "per":
            self.refuse(f"{item.name} is a feed per turn or per tooth", item)
        elif item.kind == "comp":
            self._side(item, said)
        elif item.kind == "bare":
            self._bare(item)
        else:
            text = item.name.strip()
            raise self.refusal("GX101", f"{text[:20]!r} does not fit here", item)

    def _bare(self, item: gx.Item) -> None:
        """Take R, F or M without a number, as old controls list what was not entered.

        Whether R is then R0, or the side as before, is certain only where both are the same.
        """
        if item.name.upper() == "R":
            self.refuse_beside("R alone", item)

    def _radius(self, item: gx.Item, said: Said) -> None:
        """Take the radius of CR, or R0."""
        number = self.number_of(item)
        if not float(number):
            self._side(item, said)
            return
        if said.radius:
            raise self.refusal("GX203", "R stands here twice", item)
        said.radius = number

    def _side(self, item: gx.Item, said: Said) -> None:
        if said.side is not None:
            raise self.refusal("GX203", "the side of the contour stands here twice", item)
        said.side = item

    # --- M functions ---

    def _function(self, item: gx.Item, said: Said) -> int:
        """Take an M function, and return its number."""
        text = self.number_of(item)
        if not text.isdigit() or len(text) > LONGEST_M:
            raise self.refusal("GX101", f"M{text} is no M function", item)
        code = int(text)
        self.spindle = self.spindle if code in LEAVES_SPINDLE else TURNS.get(code, "")
        self.untold &= code not in TELLS_SPINDLE
        if code in NEVER_BESIDE:
            self.refuse_beside(f"M{code}", item)
        if code == CHANGES:
            self.check_along("M6, which changes the tool as the machine's builder has it", item)
        if code in (MACHINE, BUILDERS):
            self._in_the_machine(code, item, said)
        elif code == CALLS:
            said.calls = item
        elif code in ENDS:
            said.end = f"M{code}"
        elif code in AT_END:
            said.after += self._at_end(code)
            said.leaves |= code == 129
            said.changes |= code == CHANGES
        elif code in SHORTEST:
            self.shortest = code == 126
            said.before += self.along(f"M{code}")
        elif code in SILENT:
            said.before += self._silent(code, item)
        else:
            said.before += self._at_start(code, item)
        return code

    def _in_the_machine(self, code: int, item: gx.Item, said: Said) -> None:
        """Take M91, or M92 where the machine file says from where that counts."""
        if said.machine:
            raise self.refusal("GX203", "M91 or M92 stands here twice", item)
        said.machine = item
        if code == MACHINE:
            return
        said.counts_from = self.reading.homes.get("M92")
        if self.reading.stays or not said.counts_from:
            self.refuse(f"M92 is not resolved: {WHY[BUILDERS]}", item, POINT_OF_M92)

    def _silent(self, code: int, item: gx.Item) -> list[str]:
        """Return the block of an M function that moves nothing, where it goes along."""
        if code in MOVES_ZERO:
            self.ends(f"M{code}", item)
        if code == ROUNDS:
            self.check_along("M90, which acts in its own block", item)
        return self.along(f"M{code}")

    def _at_start(self, code: int, item: gx.Item) -> tuple[str, ...]:
        """Return the blocks of an M function that acts at the start of its block."""
        if code == 128:
            return self.switch(True)
        if code >= FIRST_OF_CONTROL:
            self.refuse(
                f"M{code} is not resolved: {WHY.get(code, 'what it does is not known')}", item
            )
        own = code not in AT_START and code not in self.dialect.m_codes
        if own and code not in self.reading.inert_m:
            self.refuse(f"M{code} is not resolved: {OF_BUILDER}", item, INERT.format(code))
        return AT_START.get(code, (f"M{code}",))

    def _at_end(self, code: int) -> Sequence[str]:
        """Return the blocks of an M function that acts at the end of its block.

        M0 stops the coolant as well (TNC 155, p. 15), which no other word does at once: it goes
        along as it stands, and so does M129 where nothing follows the tip.
        """
        goes = code == STOPS or (code == LEAVES_TIP and not self.following)
        return (self.along(f"M{code}") if goes else ()) or AT_END[code]

    def switch(self, on: bool) -> tuple[str, ...]:
        """Follow the tip, or leave it, and return the block of it.

        Where axes are turned X, Y and Z then count otherwise.
        """
        if on and self.following:
            return ()
        turned = any(float(self.place.get(axis, "nan")) % 360 for axis in self.turned())
        if on and (self.turn or self.mirrored):
            self.refuse("M128 in turned or mirrored coordinates", None)
        if on != self.following and turned:
            self.lose("XYZ")
        self.following = on
        return ("M128",) if on else ("M129",)

    def turned(self) -> list[str]:
        """Return the rotary axes of the program."""
        return [axis for axis in ROTARY if axis in self.moved or axis in self.place]
