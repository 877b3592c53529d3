"""Free contours of a TNC as lines and arcs: each block is one, where `free.py` has solved it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.approach import CODES, Approaches
from gcxform_plugins.dialects.heidenhain.contours import BARE
from gcxform_plugins.dialects.heidenhain.free import LEAST, Chain, Element, OpenError, element_of
from gcxform_plugins.dialects.heidenhain.words import MM, Point, written

NUMBERED = re.compile(r"\s*(?:\d+\s+)?(.*?)\s*")
FREE = re.compile(r"\s*(?:\d+\s+)?F[LC]T?(?![A-Z])")
UNREAD = re.compile(
    r"I?P[RA]|P[123][XY]|PD[XY]|PAR|DP|D(?=[-+\d])|R(?:X|Y|PR|PA|AN|CC)|FSELECT|CCP"
)
HINT = "let the CAM write the contour in lines and arcs"


class FreeContours(Approaches):
    """Solves free contours."""

    def __init__(self, *program: Any) -> None:
        super().__init__(*program)
        self._solved: dict[int, Element] = {}

    def free(self, item: gx.Item) -> list[str]:
        """FL, FLT, FC, FCT: an element; FPOL alone says nothing. Raises InputError."""
        if item.name.startswith("FPOL"):
            self.pole, self.polar = {}, None
            return []
        if self.reading.stays or self.begins is not None or self.following or self.shortest:
            self.refuse("a free contour is not resolved here", item)
        if self.line not in self._solved:
            self._solved = self._chain(item, self.line, complex(*self._stands(item)))
        one = self._solved.pop(self.line)
        said = self.said(self.items_in(f"L {one.rest}")[1:])
        if said.axes or said.rapid or said.machine or said.radius or said.sense:
            self.refuse(f"{one.name} with {one.rest[:20]}", item, HINT)
        self.keep_side(said)
        self._check_feed()
        if self._turns():
            self.refuse("a corner at a free contour", item, HINT)
        self.place |= {"X": written(one.end.real), "Y": written(one.end.imag)}
        self.moved |= {"X", "Y"}
        self.pole, self.polar = {}, None
        return self._all(said, f"{self._element_of(one)}{said.feed}")

    def _element_of(self, one: Element) -> str:
        """Return the block of an element."""
        code = CODES[float(one.left)] if one.arc else "G1"
        centre = None if one.centre is None else (one.centre.real, one.centre.imag)
        self.last = code, (one.begin.real, one.begin.imag), centre
        words = f"{self.in_plane('G17')}{self.moving(code)}".rstrip()
        words += f" X{self.place['X']} Y{self.place['Y']}"
        if one.centre is not None:
            by = one.centre - one.begin
            words += f" I{written(by.real)} J{written(by.imag)}"
        return words.lstrip()

    def _leads(self, path: gx.Item, point: Point) -> Point:
        """Return the direction in which the next element goes; that of a free contour as well."""
        at = self.at
        while at < len(self.lines) and BARE.fullmatch(self.lines[at]):
            at += 1
        if at == len(self.lines) or not FREE.match(self.lines[at].upper()):
            return super()._leads(path, point)
        self._solved = self._chain(path, at, complex(*point))
        along = self._solved[at].along
        return along.real, along.imag

    def _chain(self, item: gx.Item, first: int, begin: complex) -> dict[int, Element]:
        """Return the elements from a line on, solved. Raises InputError."""
        try:
            elements = [*self._elements(first)]
            tangential = elements[0].tangential and self.last is not None
            ahead = complex(*self._along(item)) if tangential else None
            Chain(elements, begin, ahead, MM if self.inch else 1.0).solve()
            _check_whole(elements)
        except OpenError as why:
            self.refuse(f"a free contour: {why}", item, HINT)
        return {one.line: one for one in elements}

    def _elements(self, first: int) -> Iterator[Element]:
        """Yield the elements of lines from one on, up to a line of another kind."""
        for line in range(first, len(self.lines)):
            if BARE.fullmatch(self.lines[line]):
                continue
            text = NUMBERED.fullmatch(self.lines[line].upper().partition(";")[0])
            one = element_of(line, text[1]) if text else None
            if one is None:
                return
            unread = UNREAD.search(one.rest)
            if unread:
                raise OpenError(f"{unread[0]} in a free contour")
            yield one


def _check_whole(elements: Sequence[Element]) -> None:
    """Refuse arcs that end where they begin, but for those of 360 degrees."""
    for one in elements:
        if one.arc and abs(one.end - one.begin) <= LEAST and one.data.get("CCA") != 360:
            raise OpenError("an arc that ends where it begins")
