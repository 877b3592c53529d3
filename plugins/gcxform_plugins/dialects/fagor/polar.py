"""Polar words of a Fagor, and its rotation: R and Q become X and Y, G73 a turn about a point.

The pole is the part zero, or where G30 has put it (8070, Ref. 1709, 3.5.2). All of this is read in
G17, where I and J are those of X and Y for certain.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from decimal import Decimal
from math import cos, radians, sin

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables
from gcxform_plugins.dialects.fagor.blocks import PLANES, Blocks
from gcxform_plugins.dialects.fagor.places import code_of, quiet

SHIFTS = tables.WORK | {"G53", "G70", "G71", "G92", "G158", "G159"}
ARCS = frozenset(("G2", "G3"))
TURN = 360.0
NEAR = 1e-9
DECIMALS = 9
NOT_KNOWN = "write X and Y before, in the same coordinates"
QUARTERS = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}


def around(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle (degrees), exact for quarters of a turn."""
    known = QUARTERS.get(angle % TURN)
    return known or (cos(radians(angle)), sin(radians(angle)))


class Polar(Blocks):
    """Turns polar words into those of X and Y.

    pole     where it is, None where that is not certain;  polar: R and Q of the last move, if it
             was a polar one
    turned   G73 is in force;  untold: axes that have to be told before anything counts from them
    """

    def __init__(self, *given: object) -> None:
        super().__init__(*given)
        self.pole: tuple[float, float] | None = (0.0, 0.0)
        self.polar: tuple[float, float] | None = None
        self.plane = ""
        self.turned = False
        self.untold: set[str] = set()

    def cartesian(self, items: Sequence[gx.Item]) -> Sequence[gx.Item]:
        """Return the items of a block without polar words. Raises InputError."""
        codes = {code_of(item): item for item in items if item.kind in ("code", "numbered")}
        if PLANES & codes.keys():
            self.plane = next(iter(PLANES & codes.keys()))
            self.pole = (0.0, 0.0)
        if not quiet([item for item in items if item.name not in ("R", "Q")]):
            self.polar = None
            shifts = codes.keys() & SHIFTS or any(item.kind == "statement" for item in items)
            self.pole = None if shifts and self.pole != (0.0, 0.0) else self.pole
        if "G73" in codes or "G30" in codes:
            return items
        named = {item.name: item for item in items if item.kind in ("word", "incremental")}
        axes = named.keys() & {*"XY"}
        if "Q" in named or ("R" in named and not named.keys() & {*"XYZ"}):
            self.places.follow()
            if axes and "R" not in named and len(axes) == 1:
                items = self._by_angle(items, named, next(iter(axes)), codes.keys())
            else:
                items = self._polar(items, named, codes.keys())
        elif named.keys() & {*"XYIJR"}:
            self.polar = None
        self._tell(items)
        return items

    def _tell(self, items: Sequence[gx.Item]) -> None:
        """Take note of axes that are told behind a turn. Raises InputError."""
        if not self.untold:
            return
        moved = {i.name: i for i in items if i.kind in ("word", "incremental")}
        mine = [moved[a] for a in sorted(self.untold & moved.keys())]
        steps = any(i.kind == "incremental" for i in mine) or self.incremental
        arc = moved.keys() & {*"IJR"}
        if (mine or arc) and (len(mine) < len(self.untold) or steps or arc):
            item = next(iter(moved.values()))
            self.refuse("behind G73 both axes of the plane are told first, by a line", item)
        if mine:
            self.untold = set()

    # --- points ---

    def _motion(self, codes: Collection[str], item: gx.Item) -> str:
        named = [code for code in ("G0", "G1", "G2", "G3") if code in codes]
        motion = named[0] if named else self.places.motion
        if not motion:
            self.refuse("polar words, and which motion is in force is not known", item)
        return motion

    def _polar(
        self, items: Sequence[gx.Item], named: dict[str, gx.Item], codes: Collection[str]
    ) -> Sequence[gx.Item]:
        """Return a block with X and Y for R and Q."""
        item = named.get("Q") or named["R"]
        motion = self._motion(codes, item)
        if sum(i.kind in ("word", "incremental") for i in items) > len(named):
            raise self.refusal("GX203", "a word stands here twice", item)
        if self.plane != "G17" or self.pole is None or named.keys() & {"X", "Y"}:
            self.refuse("polar words outside of G17, beside X or Y, or about an unknown pole", item)
        steps = self._steps(codes)
        before = self.polar
        radius, angle = (self._one(named, letter, steps, item) for letter in "RQ")
        if radius < -NEAR or (motion in ARCS and "Q" not in named):
            self.refuse("a radius below 0, or an arc without Q", item)
        self.polar = radius, angle
        rest = [i for i in items if i.name not in ("R", "Q") or i.kind == "code"]
        x, y = (p + radius * f for p, f in zip(self.pole, around(angle), strict=True))
        whole = motion in ARCS and self._circle(named, steps, before, item)
        ends = [] if whole else self._ends(x, y, steps, before, item)
        if motion in ARCS and not named.keys() & {*"IJ"}:
            rest += [_code("G6"), _word("I", self.pole[0]), _word("J", self.pole[1])]
        return [*rest, *ends]

    def _steps(self, codes: Collection[str]) -> bool:
        if "G90" in codes or "G91" in codes:
            return "G91" in codes
        return self.incremental

    def _one(self, named: dict[str, gx.Item], letter: str, steps: bool, at: gx.Item) -> float:
        """Return R or Q of the end. Raises InputError."""
        item, last = named.get(letter), self.polar
        if item is not None and not (steps or item.kind == "incremental"):
            value = float(item.numbers[0])
            return value if letter == "R" else _within(value)
        self.count_on()
        if last is None:
            self.refuse(f"{letter} counts from a place that is no polar one", at, "write R and Q")
        before = last[letter == "Q"]
        return before + (float(item.numbers[0]) if item is not None else 0.0)

    def _circle(
        self,
        named: dict[str, gx.Item],
        steps: bool,
        before: tuple[float, float] | None,
        item: gx.Item,
    ) -> bool:
        """Whether an arc is a full circle: 360 degrees in steps. Raises InputError."""
        if steps or named["Q"].kind == "incremental":
            turn = abs(float(named["Q"].numbers[0]))
            if turn > TURN or (turn == TURN and "R" in named):
                self.refuse("an arc of more than a turn", item)
            return turn == TURN
        if before is not None and self.polar is not None:
            gap = abs(before[1] - self.polar[1]) % TURN
            same = min(gap, TURN - gap) <= NEAR and abs(before[0] - self.polar[0]) <= NEAR
            if same:
                self.refuse("an arc to where it starts: a full circle, or none", item)
        return False

    def _ends(
        self, x: float, y: float, steps: bool, before: tuple[float, float] | None, item: gx.Item
    ) -> list[gx.Item]:
        """Return the words of an end, in the distance mode of its block."""
        if not steps:
            return [_word("X", x), _word("Y", y)]
        if before is None or self.pole is None:
            self.refuse("a step from a place that is no polar one", item)
        cx, cy = around(before[1])
        return [
            _word("X", x - self.pole[0] - before[0] * cx),
            _word("Y", y - self.pole[1] - before[0] * cy),
        ]

    def _by_angle(
        self, items: Sequence[gx.Item], named: dict[str, gx.Item], axis: str, codes: Collection[str]
    ) -> Sequence[gx.Item]:
        """Return a line to a coordinate by its angle: `X30 Q45` (Ref. 1709, 3.5.3)."""
        item, at = named["Q"], self.places.at
        steps = self._steps(codes) or named[axis].kind == "incremental"
        if self._motion(codes, item) in ARCS or self.plane != "G17" or item.kind != "word":
            self.refuse("a coordinate and an angle, but of a line in G17", item)
        if not {"X", "Y"} <= at.keys() or self.incremental != self._steps(codes):
            self.refuse("an angle from a place that is not known", item, NOT_KNOWN)
        self.count_on()
        value = float(named[axis].numbers[0])
        step = value if steps else value - float(at[axis])
        along, across = around(float(item.numbers[0]))
        by, other = (along, across) if axis == "X" else (across, along)
        if step * by <= 0 or abs(by) <= NEAR:
            self.refuse("an angle that does not lead to this coordinate", item)
        found = step * other / by
        beside = "Y" if axis == "X" else "X"
        self.polar = None
        end = found if self._steps(codes) else float(at[beside]) + found
        return [*(i for i in items if i is not item), _word(beside, end)]

    # --- poles and turns ---

    def preset(self, items: Sequence[gx.Item]) -> list[str] | None:
        """Return the blocks of G30 and G73, None for other blocks. Raises InputError."""
        codes = {code_of(item): item for item in items if item.kind == "code"}
        name = next((name for name in ("G30", "G73") if name in codes), "")
        if not name:
            return None
        words = {i.name: float(i.numbers[0]) for i in items if i.kind == "word" and i.name != "N"}
        given = {"G30": [{"I", "J"}], "G73": [{"I", "J", "Q"}, {"Q"}, set()]}[name]
        alone = len(items) == 1 + len(words) and words.keys() in given
        if not alone or self.plane != "G17" or self.incremental:
            self.refuse(f"{name} is read alone in its block, in G17 and G90", codes[name])
        centre = words.get("I", 0.0), words.get("J", 0.0)
        self.polar = None
        if name == "G30":
            self.pole = centre
            return []
        if (self.turned and words) or self.pole != (0.0, 0.0):
            self.refuse("G73 upon G73 or G30: which is first is not certain", codes[name])
        self.untold = {"X", "Y"}
        self.places.lose()
        self.turned = bool(words)
        if not words:
            return ["G69"]
        x, y, r = (_text(v) for v in (*centre, words["Q"]))
        return [f"G68 X{x} Y{y} R{r}"]


def _within(angle: float) -> float:
    """Return an angle without whole turns: Q420 is Q60, Q-420 is Q-60 (Ref. 1709, 3.5.2)."""
    return angle - TURN * int(angle / TURN) if abs(angle) > TURN else angle


def _text(value: float) -> str:
    text = format(Decimal(repr(value)).quantize(Decimal(1).scaleb(-DECIMALS)), "f")
    text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _word(letter: str, value: float) -> gx.Item:
    return gx.Item("word", (letter,), (_text(value),), (0, 0))


def _code(name: str) -> gx.Item:
    return gx.Item("code", (name,), (), (0, 0))
