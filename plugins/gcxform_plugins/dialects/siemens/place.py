"""Where the axes stand in a program for a SINUMERIK, as far as the program says it.

Only what is mixed, or goes the shortest way, needs it: all else is written as it is programmed.
Positions are the texts of the program, or sums of them, so that nothing is rounded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import Decimal

from gcxform_plugins.dialects.shared.words import text_of as text_of

LINEAR, ROTARY = "XYZ", "ABC"
TURN = Decimal(360)


class PlaceError(Exception):
    """A word that cannot be resolved: code of the catalogue, message, hint."""

    def __init__(self, code: str, message: str, hint: str) -> None:
        super().__init__(message)
        self.code = code
        self.message = message
        self.hint = hint


class Place:
    """Positions of axes in the words of the program, by letter; None is one that is not known.

    shifted   axes whose zero or tool length has changed
    named     axes that the program has named
    unwound   rotary axes that stand whole turns beside the number that the control has
    """

    def __init__(self, start: Mapping[str, float]) -> None:
        self.at: dict[str, str | Decimal | None] = {
            axis: Decimal(repr(float(value))) for axis, value in start.items()
        }
        self.shifted: set[str] = set()
        self.unwound: set[str] = set()
        self.named: set[str] = set(start)
        self.moved = False

    def stands(self, axis: str) -> bool:
        """Whether it is known where an axis stands."""
        return self.at.get(axis) is not None

    def known(self, axis: str) -> Decimal | None:
        """Return where an axis stands; None where that is not known."""
        value = self.at.get(axis)
        return None if value is None else Decimal(value)

    def unturned(self) -> bool:
        """Whether rotary axes are known to stand at 0, and none of those that were named elsewhere.

        Then X, Y and Z are the same numbers with TRAORI and without it.
        """
        angles = [self.known(axis) for axis in self.named & set(ROTARY)]
        return bool(angles) and all(angle == 0 for angle in angles)

    @property
    def rotary_axes(self) -> int:
        """How many rotary axes the program has named."""
        return len(self.named & set(ROTARY))

    def lose(self, axes: Iterable[str], shifted: bool = True) -> None:
        """Forget where axes stand; those that are unwound stay so."""
        for axis in axes:
            self.at[axis] = None
            if shifted:
                self.shifted.add(axis)

    def seen_anew(self, moved: Callable[[Sequence[Decimal]], Sequence[Decimal]]) -> None:
        """Take another frame: nothing moves, and X, Y, Z are elsewhere in it, if that is known."""
        known = [self.known(axis) for axis in LINEAR]
        there = [value for value in known if value is not None]
        found = [*moved(there)] if len(there) == len(known) else [None] * len(known)
        for axis, value in zip(LINEAR, found, strict=True):
            self.at[axis] = value
            self.shifted.add(axis)

    def absolute(self, axis: str, number: str) -> None:
        """Take an absolute word. Raises PlaceError."""
        if axis in self.unwound:
            message = f"{axis} stands whole turns beside the number that the control has"
            raise PlaceError(
                "GX210", message, f"write {axis}=DC(...), the shortest way, for all of its words"
            )
        self._stand(axis, number)
        self.shifted.discard(axis)

    def _stand(self, axis: str, value: str | Decimal) -> None:
        self.at[axis] = value
        self.named.add(axis)

    def step(self, axis: str, number: str) -> None:
        """Take an incremental word. Raises PlaceError."""
        before = self.known(axis)
        if axis in self.shifted:
            message = (
                f"{axis} is incremental behind another work offset, tool length or tool: a setting "
                "of the control decides whether the difference is added (SD42440, SD42442)"
            )
            raise PlaceError("GX210", message, f"tell {axis} absolute before")
        if before is not None:
            self._stand(axis, before + Decimal(number))
        self.named.add(axis)

    def stepped(self, axis: str, number: str) -> str:
        """Return where an incremental word leads to, and go there. Raises PlaceError."""
        self.step(axis, number)
        end = self.known(axis)
        if end is None:
            message = f"{axis} is incremental beside absolute words, and where it stands is open"
            raise PlaceError("GX207", message, f"tell {axis} absolute before")
        return text_of(end)

    def turned(self, axis: str, way: str, number: str, rapid: bool) -> str:
        """Return where DC, ACP or ACN lead to, and go there. Raises PlaceError.

        DC goes the shorter way, ACP and ACN up and down. Where the axis stands nowhere known a
        rapid leads to the number as it is written: only how many whole turns it is away is open.
        """
        wanted = Decimal(number)
        if axis not in ROTARY or not 0 <= wanted <= TURN:
            message = f"{axis}={way}({number}): {way} takes rotary axes to angles from 0 to 360"
            raise PlaceError("GX213", message, "write A, B or C, and an angle of that range")
        before = self.known(axis)
        if before is None and not rapid:
            message = f"{axis}={way}(...) in a cut, and where {axis} stands is not known"
            raise PlaceError(
                "GX207", message, f"turn {axis} in a rapid before, with the tool clear"
            )
        end = wanted if before is None else before + _way(axis, way, before, wanted)
        self._stand(axis, end)
        (self.unwound.add if end != wanted else self.unwound.discard)(axis)
        self.shifted.discard(axis)
        return text_of(end)


def _way(axis: str, way: str, before: Decimal, wanted: Decimal) -> Decimal:
    """Return by how much an axis turns. Raises PlaceError."""
    up = (wanted - before) % TURN
    up += TURN if up < 0 else 0  # of Decimal, the rest has the sign of what is divided
    if way == "ACP" and up:
        return up
    if way == "ACN" and up:
        return up - TURN
    if way != "DC" or up * 2 == TURN:
        message = f"{axis}={way}(...): half a turn, or none, goes either way"
        raise PlaceError("GX210", message, "write the angle as an absolute or incremental number")
    return up if up * 2 < TURN else up - TURN
