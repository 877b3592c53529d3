"""Outside corners under compensation: what programs say of them (G450, G451), rapids there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Ints

ENDS = "-corners"


@dataclass(frozen=True)
class Said:
    """How corners are joined by the last code before each row of a contour; "" where none was.

    There are no rows where nothing is said of any.
    """

    rows: Ints
    ways: tuple[str, ...]

    @property
    def only(self) -> str:
        """The way of the first contour, if something is said of all of them."""
        return self.ways[0] if self.ways and "" not in self.ways else ""

    def check(self, path: gx.Toolpath, taken: str) -> None:
        """Refuse contours whose program says another way than the one taken. Raises InputError."""
        for row, way in zip(self.rows.tolist(), self.ways, strict=True):
            if way not in ("", taken):
                message = f'the program says corners = "{way}" here, and not "{taken}"'
                hint = f'say corners = "{way}", if it is so for all contours'
                raise path.refuse("GX740", np.array([row]), message, hint)


def corners_said(path: gx.Toolpath, context: gx.PassContext) -> Said:
    """Return what the program says of the corners of its contours."""
    rows = np.flatnonzero(path.side)
    said = codes_of(context.source)
    told = [(event.row, said[event.what]) for event in path.events if event.what in said]
    if not told:
        return Said(rows[:0], ())
    ways = ["", *(way for _, way in told)]
    last = np.searchsorted([row for row, _ in told], rows, "right")
    return Said(rows, tuple(ways[k] for k in last.tolist()))


def codes_of(dialect: type[gx.Dialect]) -> Mapping[str, str]:
    """Return the codes of a control that say how corners are joined, with the way."""
    acts = {name: code.act for name, code in dialect.codes.items()}
    return {name: act.removesuffix(ENDS) for name, act in acts.items() if act.endswith(ENDS)}


def refuse_rapid_corners(path: gx.Toolpath, around: Ints) -> None:
    """Refuse rapids among the rows that an arc leads to around an outside corner.

    How they are joined there is known of no control that leaves its corners to a parameter.
    Straight past it, as LinuxCNC does, the tool would cut into the corner.
    """
    wrong = around[path.kind[around] == gx.Kind.RAPID]
    if len(wrong):
        message = "a rapid around an outside corner, of which it is not known how it is joined"
        raise path.refuse("GX232", wrong, message, "go around the corner with G1")
