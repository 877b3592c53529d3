"""Readings along the body diagonals of a volume, and direct linear tests of its axes.

A body diagonal is named by the signs of the motions on it: `npp` goes down in X and up in Y and Z.
`nnn` is the line of `ppp`, measured from its other end. In the sequential step diagonal (vector
method, C. Wang, Rev. Sci. Instrum. 71 (2000) 3933) the machine moves X, stops, reads, moves Y,
stops, reads, moves Z, stops, reads, and so on; on the way back Z, Y, X. The laser beam lies along
the diagonal, and the reading is the part of the motion along it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, TypeVar

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

Signs = tuple[int, int, int]
FOUR: Final[tuple[Signs, ...]] = ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1))
TOLERANCE: Final = 0.005  # mm: positions that were rounded to 3 decimals, or to 4 in inches


@dataclass(frozen=True, eq=False)
class Leg:
    """One way along a diagonal: positions (n, 3) and deviations (n,), mm, in the order read.

    A deviation is the reading minus its nominal, which is the distance along the ideal diagonal
    from the first position; a constant in all of them means nothing. `forward` is false on the way
    back, which begins where the signs end.
    """

    signs: Signs
    position: Floats
    deviation: Floats
    forward: bool = True

    @property
    def name(self) -> str:
        """The diagonal, as `npp`."""
        return name_of(self.signs)

    @property
    def ahead(self) -> tuple[Floats, Floats]:
        """Positions and deviations in the order of the way out."""
        order = slice(None) if self.forward else slice(None, None, -1)
        return self.position[order], self.deviation[order]


@dataclass(frozen=True, eq=False)
class LinearTest:
    """One run of a direct linear test: deviations (n,) of an axis at its positions (n,), mm."""

    axis: int
    position: Floats
    deviation: Floats


@dataclass(frozen=True, eq=False)
class Volume:
    """The box of the diagonals: its low corner (3,), its sides (3,), both in mm."""

    low: Floats
    travel: Floats
    steps: int

    @property
    def diagonal(self) -> float:
        """The length of the body diagonals in mm."""
        return float(np.linalg.norm(self.travel))

    def along(self) -> Floats:
        """Return (3, steps): how far the nodes behind the first are from the low corner, mm."""
        parts = np.linspace(0.0, 1.0, self.steps + 1)[1:]
        return np.outer(self.travel, parts)

    def nodes(self, axis: int) -> Floats:
        """Return the positions (steps + 1,) of the nodes of an axis, mm."""
        ends = self.low[axis], self.low[axis] + self.travel[axis]
        return np.linspace(*ends, self.steps + 1)


@dataclass(frozen=True, eq=False)
class Diagonals:
    """The ways along the four diagonals of one volume."""

    volume: Volume
    legs: tuple[Leg, ...]

    @property
    def lines(self) -> tuple[Signs, ...]:
        """The set-ups of the laser: each diagonal with its sense, once."""
        return tuple(dict.fromkeys(leg.signs for leg in self.legs))


def name_of(signs: Signs) -> str:
    """Return the name of a diagonal, as `npp`."""
    return "".join("p" if sign > 0 else "n" for sign in signs)


def beam(signs: Signs, travel: Floats) -> Floats:
    """Return the unit vector (3,) along a diagonal of a box with sides `travel` (3,)."""
    along = np.array(signs) * travel
    unit: Floats = along / np.linalg.norm(along)
    return unit


def sideways(signs: Signs, travel: Floats) -> Floats:
    """Return two unit vectors (2, 3) square to a diagonal and to each other.

    The first is level (in the plane XY); a beam is misaligned by an angle towards each.
    """
    along = beam(signs, travel)
    level = np.cross((0.0, 0.0, 1.0), along)
    level /= np.linalg.norm(level)
    return np.array((level, np.cross(along, level)))


# --- checks ---

Item = TypeVar("Item")
Where = Callable[[int, int, str], Location | None]
"""The place of a reading: which leg, which of its rows, which column (`x`, `diagonal` ...)."""


def nowhere(leg: int, row: int, column: str) -> Location | None:
    """Return no place: the readings are not from a file."""
    return None


class _Fault(NamedTuple):
    row: int
    column: str
    message: str
    hint: str = ""


def step_diagonals(legs: Sequence[Leg], where: Where = nowhere) -> Diagonals:
    """Return the measurement of sequential steps that the legs are. Raises InputError.

    Steps have to go X, Y, Z in turn (Z, Y, X on the way back), all steps of an axis have to be
    equal (GX472), and the four diagonals have to be those of one volume (GX473).
    """
    _check_each(legs, _sequence_fault, where)
    return _of_one_volume(legs, [(len(leg.position) - 1) // 3 for leg in legs], where)


def plain_diagonals(legs: Sequence[Leg], where: Where = nowhere) -> Diagonals:
    """Return the measurement of four lengths: what is between the ends of a leg is left out."""
    _check_each(legs, _end_fault, where)
    return _of_one_volume(legs, [1] * len(legs), where)


def _check_each(
    legs: Sequence[Leg], fault_of: Callable[[Leg], _Fault | None], where: Where
) -> None:
    """Raise InputError with what is wrong with the legs."""
    found = [
        Diagnostic("GX472", fault.message, where(k, fault.row, fault.column), fault.hint)
        for k, leg in enumerate(legs)
        if (fault := fault_of(leg))
    ]
    if found:
        raise InputError(tuple(found))


def _sequence_fault(leg: Leg) -> _Fault | None:
    """Return what is wrong with the stops of a leg of sequential steps."""
    count = len(leg.position)
    if count < 4:
        least = "at least 4 are needed: the start, and a step of each axis"
        message = f"the diagonal {leg.name} has {count} readings; {least}"
        return _Fault(0, "diagonal", message)
    if fault := _end_fault(leg):
        return fault
    turn = (0, 1, 2) if leg.forward else (2, 1, 0)
    moved = np.diff(leg.position, axis=0)
    usual = np.median(moved[: (count - 1) // 3 * 3].reshape(-1, 3, 3), axis=0)
    apart = np.abs(usual) > TOLERANCE
    if (count - 1) % 3 == 0 and (apart == np.eye(3, dtype=np.bool_)[list(turn)]).all():
        return _stop_fault(leg, usual)
    return _turn_fault(leg, moved, turn)


def _turn_fault(leg: Leg, moved: Floats, turn: Sequence[int]) -> _Fault:
    """Return the first move that is not of the axis whose turn it is."""
    order = ", ".join(AXES[axis] for axis in turn)
    hint = f"steps go {order} in turn; another run of the same diagonal has another name in `run`"
    for k, step in enumerate(moved):
        due = turn[k % 3]
        moving = [int(axis) for axis in np.flatnonzero(np.abs(step) > TOLERANCE)]
        if moving != [due]:
            wrong = next((axis for axis in moving if axis != due), due)
            moves = " and ".join(AXES[axis] for axis in moving) or "nothing"
            message = f"where {AXES[due]} is due the diagonal {leg.name} moves {moves}"
            return _Fault(k + 1, AXES[wrong].lower(), message, hint)
    message = f"the diagonal {leg.name} ends within a step, {len(moved)} readings after its start"
    return _Fault(len(moved), "diagonal", message, hint)


def _stop_fault(leg: Leg, usual: Floats) -> _Fault | None:
    """Return the first stop that is off the equal steps (3, 3) which are usual on the leg."""
    steps = np.tile(usual, ((len(leg.position) - 1) // 3, 1))
    due = np.concatenate((np.zeros((1, 3)), np.cumsum(steps, axis=0)))
    due += np.median(leg.position - due, axis=0)
    wrong = np.argwhere(np.abs(leg.position - due) > TOLERANCE)
    if not len(wrong):
        return None
    row, axis = (int(k) for k in wrong[0])
    at, wanted = _mm(leg.position[row, axis]), _mm(due[row, axis])
    message = f"on the diagonal {leg.name} {AXES[axis]} is {at} mm where {wanted} is due"
    hint = "the steps of an axis have to be equal, or the mirror leaves the beam"
    return _Fault(row, AXES[axis].lower(), message, hint)


def _end_fault(leg: Leg) -> _Fault | None:
    """Return what is wrong with the ends of a leg: too few, or not along its signs."""
    last = len(leg.position) - 1
    if last < 1:
        message = f"the diagonal {leg.name} has one reading; needed are its start and its end"
        return _Fault(0, "diagonal", message)
    sense = 1 if leg.forward else -1
    for axis, sign in enumerate(leg.signs):
        way = float(leg.position[-1, axis] - leg.position[0, axis])
        if way * sign * sense <= TOLERANCE:
            goes = f"by {_mm(way)} mm" if abs(way) > TOLERANCE else "nowhere"
            due = "up" if sign * sense > 0 else "down"
            back = "" if leg.forward else " on the way back"
            message = f"on the diagonal {leg.name}{back} {AXES[axis]} goes {goes} and not {due}"
            return _Fault(last, AXES[axis].lower(), message)
    return None


def _of_one_volume(legs: Sequence[Leg], steps: Sequence[int], where: Where) -> Diagonals:
    """Return the legs with their volume; InputError (GX473) if they do not belong together."""
    if not legs:
        raise InputError.one("GX473", "there is no diagonal")
    corners = [np.sort(leg.position[[0, -1]], axis=0) for leg in legs]
    low, high = corners[0]
    for k, (corner, count) in enumerate(zip(corners, steps, strict=True)):
        if count != steps[0]:
            message = f"the diagonal {legs[k].name} has {count} steps and {legs[0].name} {steps[0]}"
            raise InputError.one("GX473", message, where(k, 0, "diagonal"))
        for axis in np.flatnonzero((np.abs(corner - corners[0]) > TOLERANCE).any(axis=0)):
            letter = AXES[axis]
            message = (
                f"the diagonal {legs[k].name} goes from {_mm(corner[0, axis])} to "
                f"{_mm(corner[1, axis])} mm in {letter}, and {legs[0].name} from "
                f"{_mm(low[axis])} to {_mm(high[axis])}"
            )
            raise InputError.one("GX473", message, where(k, 0, letter.lower()))
    lines = {_line(leg.signs) for leg in legs}
    if missing := [name_of(signs) for signs in FOUR if signs not in lines]:
        are = "is" if len(missing) == 1 else "are"
        what = f"the diagonal{'s' * (len(missing) > 1)} {' and '.join(missing)} {are} missing"
        first = where(0, 0, "diagonal")
        place = Location(first.file) if first else None
        raise InputError.one("GX473", what, place, "needed: ppp, npp, pnp and ppn")
    return Diagonals(Volume(low, high - low, steps[0]), tuple(legs))


def _line(signs: Signs) -> Signs:
    """Return the signs by which a line of four is called: of two senses that with more p."""
    x, y, z = signs
    return signs if x + y + z > 0 else (-x, -y, -z)


def _mm(value: float) -> str:
    return f"{value:.6g}"
