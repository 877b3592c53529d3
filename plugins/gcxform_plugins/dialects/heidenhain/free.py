"""Free contours of a TNC (FK): elements of which a drawing says enough, solved from start to end.

An element is a line or an arc; with T it goes on in the direction of the one before. Which data
have one solution is in the facts (TNC 407, p. 5-66; TNC 320, p. 212):

| element | data |
|---|---|
| line | X Y; a direction (AN, or T) with LEN, X or Y |
| arc | its centre, with X Y or CCA; a direction with R, and CCA or X Y; T with X Y |
| arc, FLT, FCT | the arcs with centres and radii: the line that touches both in their senses |
| arc, FLT X Y | the line that leaves the arc and leads there |
| line, FCT R, FLT or FL with AN X Y | the arc that touches both lines |
| line, FCT with centre and R | where the line touches that circle |

What has two solutions is refused, also with FSELECT, whose numbers only the control knows. Each
datum has to agree with the solution: to 0.016 mm and 0.01 degrees. Points are complex numbers.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

NUMBER = r"[-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+)"
HEAD = re.compile(r"(FLT|FL|FCT|FC)(?![A-Z])")
WORD = re.compile(
    rf"(?<![A-Z0-9])(I?(?:X|Y|AN|LEN|CCX|CCY|CCA|R))\s*({NUMBER})(?![\d.,])|(DR|CLSD)\s*([-+])(?![\d.,])"
)
NEAR = 0.016  # mm, as for circles
STRAIGHT = 0.01  # degrees
LEAST = 1e-6  # mm, and radians
TURN = 2 * math.pi
LINES = frozenset(("X", "Y", "IX", "IY", "AN", "LEN"))
"""What is said of lines."""


class OpenError(Exception):
    """Data of which there is not one solution, or that disagree."""


@dataclass(slots=True)
class Element:
    """What is said of an element, and what is found of it.

    data   numbers by word: X Y AN LEN R CCX CCY CCA, with I for steps;  rest: words of other kinds
    left   1 where it turns left, -1 right, 0 for lines and where that is not said
    """

    line: int
    name: str
    data: dict[str, float]
    left: int
    closes: str
    rest: str
    begin: complex = 0j
    end: complex = 0j
    centre: complex | None = None
    along: complex = field(default=1 + 0j)
    """The direction in which it begins."""

    @property
    def tangential(self) -> bool:
        """Whether it goes on in the direction of the one before."""
        return self.name.endswith("T")

    @property
    def arc(self) -> bool:
        """Whether it is an arc."""
        return self.name[1] == "C"

    @property
    def ahead(self) -> complex:
        """The direction in which it ends."""
        if self.centre is None:
            return self.along
        return _unit(self.end - self.centre) * 1j * self.left


def element_of(line: int, text: str) -> Element | None:
    """Return the element that a line says; None for a line of another kind. Raises OpenError."""
    head = HEAD.match(text)
    if head is None:
        return None
    data: dict[str, float] = {}
    signs: dict[str, str] = {}

    def taken(found: re.Match[str]) -> str:
        name = found[1] or found[3]
        if name in data or name in signs:
            raise OpenError(f"{name} stands in this element twice")
        if found[1]:
            data[name] = float(found[2].replace(",", "."))
        else:
            signs[name] = found[4]
        return " "

    rest = WORD.sub(taken, text[head.end() :])
    if data.get("R") == 0.0:
        del data["R"]
        rest += " R0"
    left = {"+": 1, "-": -1, "": 0}[signs.get("DR", "")]
    return Element(line, head[1], data, left, signs.get("CLSD", ""), " ".join(rest.split()))


class Chain:
    """Solves elements one after the other, each from where the one before ends."""

    def __init__(
        self, elements: Sequence[Element], start: complex, ahead: complex | None, unit: float = 1.0
    ) -> None:
        """`ahead` is the direction before them, where there is one; `unit` what 1 is in mm."""
        self.elements = elements
        self.near = NEAR / unit
        self.at, self.ahead = start, ahead
        self.closed: complex | None = None

    def solve(self) -> None:
        """Find the ends of all elements. Raises OpenError."""
        k = 0
        while k < len(self.elements):
            k += self._solved(k)

    def _solved(self, k: int) -> int:
        """Solve the element at k, with those behind it that it takes; return how many these are."""
        one = self.elements[k]
        self._absolute(one, self.at)
        one.begin = self.at
        found = self._arc(one) if one.arc else self._line(one)
        count = 1
        if not found:
            count = self._with_next(k)
        for each in self.elements[k : k + count]:
            _check(each, self.near)
        last = self.elements[k + count - 1]
        self.at, self.ahead = last.end, last.ahead
        return count

    def _absolute(self, one: Element, at: complex) -> None:
        """Make positions of steps, and take the end of a closed contour from where it began."""
        if one.tangential and self.ahead is None and one is self.elements[0]:
            raise OpenError(f"{one.name} behind what has no direction in X and Y")
        if not one.arc and (one.left or one.data.keys() - LINES):
            raise OpenError("a line with the data of an arc")
        if any(name in one.data for name in ("ILEN", "IR", "ICCA", "IAN")):
            raise OpenError(f"{one.name} with an angle or a size by steps")
        for name, value in (("X", at.real), ("Y", at.imag), ("CCX", at.real), ("CCY", at.imag)):
            step = one.data.pop("I" + name, None)
            if step is not None:
                one.data[name] = value + step
        if one.closes == "+":
            self.closed = at
        elif one.closes == "-":
            if self.closed is None:
                raise OpenError("CLSD- without a CLSD+ before it")
            one.data.setdefault("X", self.closed.real)
            one.data.setdefault("Y", self.closed.imag)

    def _direction(self, one: Element) -> complex | None:
        """Return the direction in which an element begins, where that is known."""
        if one.tangential:
            return self.ahead
        return cmath.rect(1, math.radians(one.data["AN"])) if "AN" in one.data else None

    # --- elements by themselves ---

    def _line(self, one: Element) -> bool:
        """Solve a line; return whether its data say it."""
        to, along = _end(one), self._direction(one)
        if to is not None:
            one.end, one.along = to, _unit(to - one.begin)
            self._check_tangent(one)
            return True
        if along is None:
            raise OpenError("a line with less than its data, or with two solutions")
        one.along = along
        if "LEN" in one.data:
            one.end = one.begin + one.data["LEN"] * along
        elif "X" in one.data:
            one.end = one.begin + along * _far(one.data["X"] - one.begin.real, along.real)
        elif "Y" in one.data:
            one.end = one.begin + along * _far(one.data["Y"] - one.begin.imag, along.imag)
        else:
            return False
        return True

    def _arc(self, one: Element) -> bool:
        """Solve an arc; return whether its data say where it ends."""
        to, along, centre = _end(one), self._direction(one), _centre(one)
        if centre is None and along is not None and "R" in one.data:
            _needs_sense(one)
            centre = one.begin + one.left * one.data["R"] * 1j * along
        if centre is None and along is not None and to is not None:
            self._by_tangent(one, along, to)
            return True
        if centre is None:
            raise OpenError("an arc with less than its data, or with two solutions")
        _needs_sense(one)
        one.centre = centre
        one.along = _unit(one.begin - centre) * 1j * one.left
        self._check_tangent(one)
        if to is not None:
            one.end = to
        elif "CCA" in one.data:
            turn = cmath.rect(1, one.left * math.radians(one.data["CCA"]))
            one.end = centre + (one.begin - centre) * turn
        elif {"X", "Y", "LEN"} & one.data.keys():
            raise OpenError("an arc that ends at one coordinate or a chord: it has two solutions")
        else:
            return False
        return True

    def _by_tangent(self, one: Element, along: complex, to: complex) -> None:
        """Solve an arc by its direction and its end."""
        by = to - one.begin
        aside = (along.conjugate() * by).imag
        if abs(aside) <= LEAST * abs(by):
            raise OpenError("an arc to a place straight on")
        radius = abs(by) ** 2 / (2 * aside)
        left = 1 if radius > 0 else -1
        if one.left not in (0, left):
            raise OpenError("an arc that turns against its DR")
        one.left, one.along, one.end = left, along, to
        one.centre = one.begin + radius * 1j * along

    def _check_tangent(self, one: Element) -> None:
        if one.tangential and self.ahead is not None:
            off = abs(math.degrees(cmath.phase(one.along / self.ahead)))
            if off > STRAIGHT:
                raise OpenError(f"{one.name} leaves the direction before it by {off:.3g} degrees")

    # --- elements that the next ones say ---

    def _with_next(self, k: int) -> int:
        one, *behind = self.elements[k : k + 3]
        names = [each.name for each in behind]
        if one.arc and names[:1] == ["FLT"]:
            return self._off_arc(one, behind)
        if not one.arc and names[:1] == ["FCT"]:
            return self._onto_arc(one, behind)
        raise OpenError(f"{one.name} whose end no row of the manual finds")

    def _off_arc(self, one: Element, behind: Sequence[Element]) -> int:
        """Solve an arc that ends where a line leaves it, for a place or for another arc."""
        line = behind[0]
        _check_plain(behind)
        to, centre, radius, count = _end(line), 0j, 0.0, 2
        if to is not None:
            centre = to
        elif line.data or len(behind) < 2 or not behind[1].tangential or not behind[1].arc:
            raise OpenError(
                "FLT behind an open arc, with neither X and Y nor a known FCT behind it"
            )
        else:
            other = behind[1]
            found = _centre(other)
            if found is None or "R" not in other.data:
                raise OpenError("FCT behind two open elements, without its centre and R")
            _needs_sense(other)
            centre, radius = found, other.left * other.data["R"]
        assert one.centre is not None
        own = one.left * abs(one.begin - one.centre)
        by, off = centre - one.centre, radius - own
        if abs(by) <= abs(off) * (1 + LEAST):
            raise OpenError("no line touches both arcs in their senses")
        along = _unit(by) * cmath.rect(1, -math.asin(off / abs(by)))
        one.end = one.centre - own * 1j * along
        line.begin, line.along = one.end, along
        line.end = centre - radius * 1j * along
        return count

    def _onto_arc(self, one: Element, behind: Sequence[Element]) -> int:
        """Solve a line that ends where an arc begins which touches it."""
        arc = behind[0]
        _check_plain(behind)
        _needs_sense(arc)
        centre = _centre(arc)
        if "R" not in arc.data or arc.data["R"] <= 0:
            raise OpenError("FCT behind an open line, without R")
        radius = arc.left * arc.data["R"]
        if centre is not None:
            one.end = centre - radius * 1j * one.along
            _check_ahead(one)
            return 1
        if len(behind) < 2 or behind[1].arc or arc.data.keys() != {"R"} or arc.closes:
            raise OpenError("FCT with R alone behind an open line, and no line behind it")
        line = behind[1]
        to, along = _end(line), None
        if "AN" in line.data:
            along = cmath.rect(1, math.radians(line.data["AN"]))
        if to is None or along is None:
            raise OpenError("a line behind an open arc, without AN, X and Y")
        across = (one.along.conjugate() * along).imag
        if abs(across) <= LEAST:
            raise OpenError("an arc between lines that do not turn")
        first, second = one.begin + radius * 1j * one.along, to + radius * 1j * along
        far = ((second - first).conjugate() * along).imag / across
        middle = first + far * one.along
        one.end = middle - radius * 1j * one.along
        arc.begin, arc.centre, arc.along = one.end, middle, one.along
        arc.end = line.begin = middle - radius * 1j * along
        line.end, line.along = to, along
        _check_ahead(one)
        _check_ahead(line)
        return 3


def _check_plain(behind: Sequence[Element]) -> None:
    """Refuse elements that say by steps, or by CLSD, from where only they tell."""
    for each in behind:
        if any(name.startswith("I") for name in each.data):
            raise OpenError("steps from where only the next element tells")
        if not each.arc and (each.closes or each.left or each.data.keys() - LINES):
            raise OpenError("a line with the data of an arc, or with CLSD, behind an open element")


def _end(one: Element) -> complex | None:
    return complex(one.data["X"], one.data["Y"]) if {"X", "Y"} <= one.data.keys() else None


def _centre(one: Element) -> complex | None:
    if {"CCX", "CCY"} <= one.data.keys():
        return complex(one.data["CCX"], one.data["CCY"])
    if {"CCX", "CCY"} & one.data.keys():
        raise OpenError("a centre of one coordinate")
    return None


def _needs_sense(one: Element) -> None:
    if not one.left:
        raise OpenError(f"{one.name} without DR+ or DR-")


def _unit(by: complex) -> complex:
    if abs(by) <= LEAST:
        raise OpenError("an element of no length")
    return by / abs(by)


def _far(by: float, along: float) -> float:
    """Return how far a line goes until a coordinate has changed by so much. Raises OpenError."""
    if abs(along) <= LEAST or by / along <= 0:
        raise OpenError("a line that does not come to its coordinate")
    return by / along


def _check_ahead(one: Element) -> None:
    """Refuse a line that would have to go back."""
    by = one.end - one.begin
    if abs(by) <= LEAST or abs(math.degrees(cmath.phase(by / one.along))) > STRAIGHT:
        raise OpenError("elements that do not meet ahead")


def _check(one: Element, near: float) -> None:
    """Refuse data that the solution does not agree with."""
    by = one.end - one.begin
    found = {"X": one.end.real, "Y": one.end.imag, "LEN": abs(by)}
    if one.centre is not None:
        radii = [abs(point - one.centre) for point in (one.begin, one.end)]
        if abs(radii[0] - radii[1]) > near:
            raise OpenError("an arc whose start and end are not as far from its centre")
        found |= {"CCX": one.centre.real, "CCY": one.centre.imag, "R": radii[0]}
        turn = one.left * cmath.phase((one.end - one.centre) / (one.begin - one.centre)) % TURN
        wanted = math.radians(one.data.get("CCA", 0.0))
        if not 0 <= wanted <= TURN + LEAST:
            raise OpenError("CCA beyond a whole turn")
        if "CCA" in one.data and not wanted:
            raise OpenError("CCA of 0")
        if "CCA" in one.data and abs(cmath.phase(cmath.rect(1, turn - wanted))) > math.radians(
            STRAIGHT
        ):
            raise OpenError("CCA that its arc does not have")
    for name, value in found.items():
        if abs(one.data.get(name, value) - value) > near:
            raise OpenError(f"{name} that its element does not have")
    if "AN" in one.data:
        off = cmath.phase(one.along / cmath.rect(1, math.radians(one.data["AN"])))
        if abs(math.degrees(off)) > STRAIGHT:
            raise OpenError("AN that its element does not have")
