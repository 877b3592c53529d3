"""Frames of a program for a SINUMERIK as they act: words inside become words outside of them.

Blocks are written in the coordinates outside of the programmable frame, so they mean the same to
any control. To the same control by passes that keep positions nothing of this is needed: words
stay words of the frame, and the line that sets it stays as it is (`axes_of_lines.py`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal

from gcxform_plugins.dialects.siemens.arcs import CENTRES
from gcxform_plugins.dialects.siemens.frames import NEAR, ONE, PLAIN, ZERO, Frame, frame_of
from gcxform_plugins.dialects.siemens.line import ABSOLUTE, Line
from gcxform_plugins.dialects.siemens.place import LINEAR, ROTARY, PlaceError, text_of
from gcxform_plugins.dialects.siemens.polar import Polar

FINEST = Decimal("1e-9")
BEFORE = "write TRANS before, in a line of its own"


class Framing(Polar):
    """Follows the programmable frame."""

    def set_frame(self, line: Line) -> Iterator[str]:
        """Take an instruction for the frame; it moves nothing. Raises PlaceError."""
        assert line.alone is not None
        name = line.alone.name
        if line.axes.keys() - {*LINEAR} or line.named.keys() - {"RPL"}:
            self.refuse(f"{name} beside what is no word of it", line.alone, "give it its own line")
        if any(way not in ("", ABSOLUTE) for way, _, _ in line.axes.values()):
            self.refuse(f"{name} in steps", line.alone, PLAIN)
        if self.drilling is not None or self.comp or self.following:
            self.refuse(f"{name} under MCALL, compensation or TRAORI", line.alone, PLAIN)
        words = {axis: Decimal(number) for axis, (_, number, _) in line.axes.items()}
        angle = Decimal(line.named["RPL"][0]) if "RPL" in line.named else None
        base = name.removeprefix("A")
        made = frame_of(base, words, angle, self.plane) if words or angle is not None else Frame()
        if name != base:
            if base.startswith("ROT") and not self.frame.rigid:
                self.refuse("AROT in a frame that grows axes by factors that differ", line.alone)
            made = self.frame @ made
        old = self.frame
        self.place.seen_anew(lambda point: made.inside(old.point(point)))
        self.frame = made
        self.lose_pole()
        yield from ()

    def _quiet(self, name: str, given: Sequence[str]) -> bool:
        """Whether a call moves nothing; what ends swivelling may end a frame."""
        quiet = super()._quiet(name, given)
        if quiet and name == "CYCLE800" and self.frame != Frame():
            self.refuse("CYCLE800 in a frame of the program, which it may end", None, BEFORE)
        return quiet

    def end_swivel(self) -> None:
        """Let go of rotary axes that are turned: whether they turn back is the builder's choice."""
        turned = set() if self.place.unturned() else self.place.named & {*ROTARY}
        self.place.lose(turned, shifted=False)
        self.loses |= turned

    def outside(self, steps: bool, words: Sequence[str]) -> list[str]:
        """Return axis words as they are outside of the frame. Raises PlaceError."""
        if self.frame == Frame():
            return [*words]
        named = {w[0]: Decimal(w[1:]) for w in words if w[0] in LINEAR}
        matrix, linear = self.frame.matrix, range(3)
        rows = [k for k in linear if any(matrix[k][LINEAR.index(a)] for a in named)]
        if steps:
            values = self.frame.turned([named.get(axis, ZERO) for axis in LINEAR])
        else:
            known = [self.place.known(axis) for axis in LINEAR]
            for k in (k for row in rows for k in linear if matrix[row][k] and known[k] is None):
                message = f"a frame that turns, and where {LINEAR[k]} stands in it is not known"
                raise PlaceError("GX207", message, "tell X, Y and Z behind ROT")
            values = self.frame.point([value or ZERO for value in known])
        made = [LINEAR[k] + text_of(rounded(values[k])) for k in rows]
        return [*made, *(w for w in words if w[0] not in LINEAR)]

    def arc_outside(self, motion: str, arc: Sequence[str]) -> tuple[str, list[str]]:
        """Return the code of an arc and its words, as they are outside of the frame."""
        if self.frame == Frame():
            return motion, [*arc]
        growth = self.frame.in_plane(self.plane)
        if growth is None or self.said_centres or "G90.1" in arc:
            message = "an arc in a frame that tilts it, grows its axes by factors that differ, or"
            self.refuse(f"{message} of an unknown start", None, PLAIN)
        axes = {CENTRES[axis]: LINEAR.index(axis) for axis in LINEAR}
        given = [w for w in arc if w[0] in axes]
        vector = [ZERO] * 3
        for word in given:
            vector[axes[word[0]]] = Decimal(word[1:])
        turned = self.frame.turned(vector)
        letters = [CENTRES[axis] for axis in self.plane] if given else []
        words = [letter + text_of(rounded(turned[axes[letter]])) for letter in letters]
        for word in (w for w in arc if w not in given):
            radius = word[0] == "R"
            words.append("R" + text_of(Decimal(word[1:]) * abs(growth)) if radius else word)
        return ({"2": "3", "3": "2"}[motion] if growth < 0 else motion), words

    def moved_inside(self, axes: Iterable[str]) -> list[str]:
        """Return the axes of the program that are elsewhere when axes of the machine have moved."""
        turned = any(self.frame.matrix[i][k] for i in range(3) for k in range(3) if i != k)
        return [*axes, *(LINEAR if turned else ())]

    @property
    def keeps_radii(self) -> bool:
        """Whether what is left of the way is so outside, and as far."""
        growth = self.frame.in_plane(self.plane)
        return growth is not None and abs(growth - ONE) <= NEAR


def rounded(value: Decimal) -> Decimal:
    """Return a computed position with as many decimals as are written."""
    return value.quantize(FINEST)
