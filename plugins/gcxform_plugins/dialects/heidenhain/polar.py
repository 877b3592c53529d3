"""Polar coordinates of a TNC: LP and CP, about the place of CC."""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Decimal
from math import atan2, ceil, cos, degrees, hypot, radians, sin

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.moves import CENTRES, Moves
from gcxform_plugins.dialects.heidenhain.positioning import Said
from gcxform_plugins.dialects.heidenhain.words import exact, written

TURN = 360.0
LEAST_ANGLE = 1e-4  # degrees, the last decimal of the control: less is neither an arc nor a turn


def around(angle: float) -> tuple[float, float]:
    """Return cosine and sine of an angle (degrees), exact for quarters of a turn."""
    quarters = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
    known = quarters.get(angle % TURN)
    return known or (cos(radians(angle)), sin(radians(angle)))


class Polar(Moves):
    """Turns blocks in polar coordinates into moves."""

    def polar_line(self, items: Sequence[gx.Item]) -> list[str]:
        """LP: a line to polar coordinates about CC."""
        said, path = self.said(items[1:]), items[0]
        pole = self._pole(path)
        given, ends = self._polar_words(said)
        if said.machine:
            self.refuse("LP with M91", said.machine)
        radius = given.get("PR")
        if radius is None:
            radius = self._last_polar(path)[0] + given.get("IPR", 0.0)
        angle = given["PA"] if "PA" in given else self._angle(path) + given.get("IPA", 0.0)
        ends |= self._at(pole, radius, angle)
        words = "".join(f" {axis}{number}" for axis, number in ends.items())
        block = self._straight(said, ends, words)
        self.polar = radius, angle
        if given.keys() & {"IPR", "IPA"}:
            place = written(radius), written(angle)
            known = self.polar_at.setdefault(self.line, place)
            self.polar_at[self.line] = place if known == place else None
        return self._all(said, block)

    def polar_circle(self, items: Sequence[gx.Item]) -> list[str]:
        """CP: a circle about CC by its angle, with IZ a helix; IPA may be many turns."""
        said, path = self.said(items[1:]), items[0]
        pole = self._pole(path)
        given, ends = self._polar_words(said)
        if len(given) != 1 or not given.keys() <= {"PA", "IPA"}:
            raise self.refusal("GX213", "CP takes PA or IPA, and nothing else of the polar", path)
        axes = self._plane_of(path)
        self._check_plane(axes, path)
        if axes != "XY" and (ends or "IPA" not in given or abs(given["IPA"]) > TURN):
            self.refuse("CP out of XY by PA, with another axis, or of many turns", path)
        x, y = (float(self.stands_at(a, path)) - float(pole[a]) for a in axes)
        radius, begin = hypot(x, y), self._angle(path, axes)
        sense = 1.0 if said.sense == "G3" else -1.0
        turn = given["IPA"] if "IPA" in given else sense * ((given["PA"] - begin) * sense % TURN)
        self._check_turn(turn, sense, path, "IPA" in given)
        turns = ceil(abs(turn) / TURN)
        words = "".join(
            f" {CENTRES[axis]}{exact(Decimal(pole[axis]) - Decimal(self.place[axis]))}"
            for axis in sorted(axes)
        )
        if turn % TURN:
            ends |= self._at(pole, radius, begin + turn, axes)
        words += f" P{turns}" if turns > 1 else ""
        block = self._arc(said, path, ends, words)
        self.polar = (radius, begin + turn) if axes == "XY" else None
        return self._all(said, block)

    def _check_turn(self, turn: float, sense: float, path: gx.Item, by_turn: bool) -> None:
        """Refuse turns against DR, and those of which it is not certain how many they are."""
        if turn * sense < 0:
            self.refuse("CP turns against its DR", path)
        rest = abs(turn) % TURN
        near = min(rest, TURN - rest)
        if near < LEAST_ANGLE and (near or not turn or not by_turn):
            self.refuse(f"CP turns by {turn:g} degrees", path)

    def _polar_words(self, said: Said) -> tuple[dict[str, float], dict[str, str]]:
        """Return PR and PA and their like, and the end along Z."""
        names = [item.name.removeprefix("I") for item in said.axes]
        if len({*names}) < len(names):
            raise self.refusal("GX203", "a coordinate stands here twice", said.axes[0])
        given: dict[str, float] = {}
        ends: dict[str, str] = {}
        for item in said.axes:
            if "P" in item.name:
                given[item.name] = float(self.number_of(item))
                continue
            axis, number = self.reached(item)
            if axis != "Z":
                self.refuse(f"{item.name} beside polar coordinates", item)
            ends[axis] = number
        return given, ends

    def _last_polar(self, path: gx.Item) -> tuple[float, float]:
        if self.polar is None:
            raise self.refusal("GX213", f"{path.name} without PR behind other moves", path)
        return self.polar

    def _angle(self, path: gx.Item, axes: str = "XY") -> float:
        """Return the angle of where the axes stand, from the first of two towards the other."""
        if self.polar is not None:
            return self.polar[1]
        pole = self._pole(path)
        x, y = (float(self.stands_at(a, path) - Decimal(pole[a])) for a in axes)
        if not (x or y):
            raise self.refusal("GX213", "the axes stand at the pole, which has no angle", path)
        return degrees(atan2(y, x))

    def _at(
        self, pole: dict[str, str], radius: float, angle: float, axes: str = "XY"
    ) -> dict[str, str]:
        """Return both axes of polar coordinates."""
        away = around(angle)
        return {
            axis: written(float(pole[axis]) + radius * part)
            for axis, part in zip(axes, away, strict=True)
        }
