"""A reader of contours in Klartext, element by element, in complex numbers: L, RND, CHF, CT, C.

It shares no code with the package, and finds centres in another way: that of a rounding where two
lines beside the given ones meet, that of CT where two perpendiculars do.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

WORD = re.compile(r"(I?[XY]|F|R)([-+]?[0-9.]+)")
LINE, LEFT, RIGHT = 1, 3, 2


class DoubtfulError(Exception):
    """What has no element there, or none that fits."""


@dataclass
class Row:
    """An element of the path: 1 a line, 2 clockwise, 3 counter-clockwise."""

    kind: int
    end: complex
    centre: complex | None
    feed: float


def cross(a: complex, b: complex) -> float:
    return (a.conjugate() * b).imag


def meet(a: complex, along: complex, b: complex, other: complex) -> complex:
    """Return where two lines cross, each by a point and a direction."""
    size = cross(along, other)
    if abs(size) < 1e-6:
        raise DoubtfulError
    return a + along * (cross(b - a, other) / size)


def unit(by: complex) -> complex:
    if not abs(by):
        raise DoubtfulError
    return by / abs(by)


def rounding(a: complex, v: complex, b: complex, radius: float) -> tuple[complex, complex, complex]:
    """Return where a rounding begins and ends, and its centre."""
    one, two = unit(v - a), unit(b - v)
    inside = 1j if cross(one, two) > 0 else -1j
    centre = meet(v + inside * one * radius, one, v + inside * two * radius, two)
    begin, end = (centre - inside * along * radius for along in (one, two))
    if abs(v - begin) > min(abs(v - a), abs(b - v)):
        raise DoubtfulError
    return begin, end, centre


def run(lines: list[str]) -> list[Row]:
    """Return the elements of a contour; the first line leads to its start. Raises DoubtfulError."""
    rows: list[Row] = []
    said = 0j  # the place that was programmed; the last row may end before it
    feed, along, pole = 0.0, 0j, 0j
    for number, line in enumerate(lines):
        words = dict(WORD.findall(line))
        name = re.match(r"[A-Z]+", line)[0]  # type: ignore[index]
        own = float(words["F"]) if "F" in words else feed
        if name in ("RND", "CHF"):
            to = place(lines[number + 1], said)
            begin = rows[-2].end if len(rows) > 1 else 0j
            size = float(words.get("R", line.split()[1].lstrip("R")))
            if name == "RND":
                first, second, centre = rounding(begin, said, to, size)
                kind = LEFT if cross(said - begin, to - said) > 0 else RIGHT
                rows[-1].end = first
                rows.append(Row(kind, second, centre, own))
                continue
            first, second = said - unit(said - begin) * size, said + unit(to - said) * size
            if size > min(abs(said - begin), abs(to - said)) + 1e-9:  # all of a line may go
                raise DoubtfulError
            rows[-1].end = first
            rows.append(Row(LINE, second, None, own))
            continue
        feed = own
        if name == "CC":
            pole = place(line, said)
            continue
        start = rows[-1].end if rows else 0j
        to = place(line, said)
        if name == "L":
            if abs(to - start) > 1e-9 or not rows:  # a chamfer may have taken all of it
                along = unit(to - start)
            rows.append(Row(LINE, to, None, feed))
        elif name == "C":
            kind = LEFT if "DR+" in line else RIGHT
            rows.append(Row(kind, to, pole, feed))
            along = unit(to - pole) * (1j if kind == LEFT else -1j)
        else:
            centre = meet(start, along * 1j, (start + to) / 2, (to - start) * 1j)
            kind = LEFT if cross(along, to - start) > 0 else RIGHT
            rows.append(Row(kind, to, centre, feed))
            along = unit(to - centre) * (1j if kind == LEFT else -1j)
        said = to
    return rows


def place(line: str, said: complex) -> complex:
    """Return where the words of a line lead to from the place that was programmed before."""
    at = {"X": said.real, "Y": said.imag}
    for name, number in WORD.findall(line):
        if name[-1] in "XY":
            at[name[-1]] = at[name[-1]] + float(number) if name[0] == "I" else float(number)
    return complex(at["X"], at["Y"])
