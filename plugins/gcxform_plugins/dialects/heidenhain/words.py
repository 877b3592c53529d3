"""What a TNC knows while it runs a program, and the words that its blocks become.

Numbers are texts wherever nothing is computed, so that they keep their digits.
"""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Any

import gcxform as gx

LINEAR = "XYZ"
ROTARY = "ABC"
LONGEST = 20  # characters of a number
MM = 25.4  # of an inch
COMPUTED = 8  # decimals of mm, inch or degrees: far below what the control resolves
HEAD = re.compile(r"[/\d \t]*")
"""What stands before a statement."""
LENGTHS = re.compile(r"BLK|TOOL\s+DEF|CYCLE?\s+DEF\s*32\.[1-9]", re.IGNORECASE)
"""What has lengths in it, in the unit of the program."""
STAYS = "`absolute`, which compensates nothing, leaves the line as it stands"
UNKNOWN = "say where the axes stand: start = { X = ... } in [input], or begin with absolute values"


def plain(number: str) -> str:
    """Return a number as blocks have it: with a point, and without a plus."""
    return number.replace(",", ".").removeprefix("+")


def written(value: float | Decimal) -> str:
    """Return a computed number: no exponent, and no more decimals than it needs."""
    text = f"{value:.{COMPUTED}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def exact(value: Decimal) -> str:
    """Return a sum of numbers of the program, with all of its digits."""
    text = f"{value:f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def goes_on(line: str) -> bool:
    """Whether the next line goes on with the statement: `~` ends it, or stands before a comment."""
    return line.rstrip().endswith("~") or line.partition(";")[0].rstrip().endswith("~")


Point = tuple[float, float]
Element = tuple[str, Point, Point | None]


class Words(gx.Translator):
    """The state that statements of a TNC share.

    place     where the axes stand, as the program counts it; an axis that is not here is lost
    lost      the line, from 1, in which the program has lost axes last, by axis
    pole      the two coordinates of CC, as numbers of the program
    polar     PR and PA that were programmed last, None after other moves
    polar_at  PR and PA that lines lead to by steps; None where they do to several places
    last      code, start and centre of the element that ends where the axes stand; None where that
              has no direction in X and Y
    moved     axes that have moved to a place of the workpiece since the program began
    counts_from  the preset that cycle 247 has named, None before
    side      G41 or G42 where RL or RR is in force
    spindle   M3 or M4, as it turns; nothing where it stands, or that is not known
    untold    whether it turns has not been said since a tap
    plane     G17, G18 or G19, as blocks have it
    deltas    DL and DR of the tool in the spindle, as TOOL CALL has said
    turn      degrees by which X and Y are turned;  mirrored: the axes that are; None: not known
    untilted  PLANE SPATIAL with angles of 0 is in force
    over      whether the program has ended
    q         what parameters are worth, by their names; None where only the control knows
    computes  something was computed, or decided: lines are no more what they say by themselves
    """

    grammar = ("gcxform_grammars", "heidenhain")
    number = gx.NUMBER_OR_COMMA
    signs = re.compile(rb"\bBEGIN[ \t]+PGM\b", re.IGNORECASE)

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self.place: dict[str, str] = {}
        self.lost: dict[str, int] = {}
        self.pole: dict[str, str] = {}
        self.polar: tuple[float, float] | None = None
        self.last: Element | None = None
        self.polar_at: dict[int, tuple[str, str] | None] = {}
        self.moved: set[str] = set()
        self.counts_from: Decimal | None = None
        self.motion, self.plane = "", "G17"
        self.feed = ""
        self.tool_feed = ""
        self.feed_lost = False
        self.inch = False
        self.following = False
        self.shortest = False
        self.side = self.spindle = ""
        self.untold = False
        self.deltas: dict[str, Decimal] = {}
        self.turn: Decimal | None = Decimal(0)
        self.mirrored: str | None = ""
        self.in_spindle = ""
        self.tool_names = gx.ToolNames(self.reading)
        self.over = self.computes = self.untilted = False
        self.q: dict[str, float | None] = {
            f"Q{number}": value
            for number, value in self.reading.parameters.items()
            if number.isdigit()
        }

    # --- numbers ---

    def number_of(self, item: gx.Item) -> str:
        """Return the number of an item, or of its parameter. Raises InputError."""
        if not item.numbers:
            self.computes = True
            return self.value_of(item.names[-1], item)
        if len(item.numbers[0]) > LONGEST:
            raise self.refusal("GX219", "a number beyond what the control takes", item)
        return plain(item.numbers[0])

    def value_of(self, name: str, item: gx.Item) -> str:
        """Return the number that a parameter with its sign stands for. Raises InputError."""
        raise NotImplementedError

    def stands_at(self, axis: str, item: gx.Item, what: str = "") -> Decimal:
        """Return where an axis stands. Raises InputError where that is not known."""
        if axis not in self.place:
            message = f"{what or item.name} counts from where {axis} stands, which is not known"
            hint = UNKNOWN
            if axis in self.lost:
                hint = f"write {axis} absolute before: what line {self.lost[axis]} does loses it"
            raise self.refusal("GX207", message, item, hint)
        return Decimal(self.place[axis])

    def reached(self, item: gx.Item) -> tuple[str, str]:
        """Return the axis of a coordinate, and the number that it leads to."""
        number, name = self.number_of(item), item.names[0]
        if name[0] != "I":
            return name, number
        axis = name[1:]
        return axis, exact(self.stands_at(axis, item) + Decimal(number))

    def ends(self, what: str, item: gx.Item) -> None:
        """Take what ends a function that is refused here, so that it ends nothing."""

    def refuse_beside(self, what: str, item: gx.Item) -> None:
        """Refuse what is not read while the tool is beside the contour. Raises InputError."""
        if self.side:
            self.refuse(f"{what} under radius compensation", item, "write R0 in a line before")

    # --- what goes along ---

    def along(self, text: str = "") -> list[str]:
        """Return the block of what goes along where all is written anew for a TNC; else nothing.

        Without a text that is the statement of this line, as it stands. Its code makes it an event,
        which moves keep their place by; in inches it says so, where lengths go along.
        """
        said = text or self.statement
        block = f"{'P1 ' if self.inch and LENGTHS.match(said) else ''}{gx.Speller.along(said)}"
        return [block] if self.reading.asides else []

    @property
    def statement(self) -> str:
        """The statement of this line, as it stands."""
        return HEAD.sub("", self.lines[self.line].partition(";")[0], 1).rstrip(" \t")

    def all_along(self, *texts: str) -> list[str]:
        """Return the blocks of several statements that go along, each in a line of its own."""
        return [block for text in texts for block in self.along(text)]

    def check_along(self, what: str, item: gx.Item) -> None:
        """Refuse what does more than to move, and would be gone. Raises InputError."""
        if self.reading.asides:
            self.refuse(f"{what}, where all lines are written anew", item, STAYS)

    def stands(self, what: str) -> list[str]:
        """Return the block of a statement that goes along, and in its own line alone."""
        self.in_place[self.line] = what
        return self.along()

    # --- words ---

    def feed_word(self, number: str) -> str:
        """Return F in the unit of blocks: programs in inches have tenths of inches."""
        if self.inch:
            number = exact(Decimal(number).scaleb(-1))
        self.feed, self.feed_lost = number, False
        return f" F{number}"

    def moving(self, code: str) -> str:
        """Return a motion code where another one is in force."""
        if code == self.motion:
            return ""
        self.motion = code
        return code

    def in_plane(self, code: str) -> str:
        """Return the code of a plane with a blank behind it, where another one is in force."""
        if code == self.plane:
            return ""
        self.plane = code
        return f"{code} "

    def lose(self, axes: str | None = None) -> None:
        """Forget where axes stand, all of them if none are named."""
        lost = LINEAR + ROTARY if axes is None else axes
        self.lost |= dict.fromkeys(lost, self.line + 1)
        for axis in lost:
            self.place.pop(axis, None)
        self.last = None
        if not {"X", "Y"}.isdisjoint(lost):
            self.polar = None
