"""The jog test: what is to be seen when a rotary axis is jogged, in words and numbers.

A wrong sign or point is seen by an eye at the machine before it is seen by a spindle.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from gcxform.machine.chain import Chain, Rotary
from gcxform.system.arrays import Floats

SIDES = {
    "+X": "the right",
    "-X": "the left",
    "+Y": "the back",
    "-Y": "the front",
    "+Z": "above",
    "-Z": "below",
}
"""The directions of a mill with a vertical spindle, for somebody in front of it."""
WAYS = {"+Z": "up", "-Z": "down"} | {way: f"to {SIDES[way]}" for way in list(SIDES)[:4]}
STILL = 5e-4  # mm or degrees that are printed as 0
EXACT = 5e-4  # degrees up to which an axis runs along a coordinate


def jog_test(chain: Chain, at: Mapping[str, float], step: float) -> Iterator[str]:
    """Yield lines about each rotary axis, moved by `step` degrees from where all stand.

    `at` are positions by letter, in mm and degrees; what is not there is at 0.
    """
    linear = np.array([at.get(letter, 0.0) for letter in "XYZ"])
    angles = np.array([at.get(letter, 0.0) for letter in chain.letters])
    tip, axis = chain.forward(linear, angles)
    start = _words(chain.letters, angles)
    yield f"at X{linear[0]:g} Y{linear[1]:g} Z{linear[2]:g}{start} the tip is on the workpiece at"
    yield f"  {_point(tip)}, the tool axis is {_vector(axis, 6)}"
    for k, rotary in enumerate(chain.axes):
        yield ""
        yield from _about(rotary, k < len(chain.table))
        moved = angles.copy()
        moved[k] += step
        yield f"  from {rotary.letter}{angles[k]:g} to {rotary.letter}{moved[k]:g}:"
        yield from _seen(chain, (linear, angles, moved), (tip, axis))


def _words(letters: tuple[str, ...], angles: Floats) -> str:
    return "".join(f" {a}{value:g}" for a, value in zip(letters, angles, strict=True))


# --- the axis ---


def _about(rotary: Rotary, table: bool) -> Iterator[str]:
    """Yield what an axis is, and which way it turns."""
    way = np.array(rotary.direction)
    name, off = _nearest(way)
    carried = "table" if table else "head"
    along = "along" if off <= EXACT else f"{off:.3f} degrees off"
    yield f"{rotary.letter} turns the {carried} about a line {along} {name}, {_vector(way, 6)},"
    yield f"  through {_point(np.array(rotary.point))}"
    sense = "counterclockwise" if rotary.sign > 0 else "clockwise"
    hand = "right-handed" if rotary.sign > 0 else "left-handed"
    yield f"  + turns the {carried} {sense}, seen from {name} ({SIDES[name]}): {hand}"
    iso = rotary.sign == (-1 if table else 1)
    yield f"  that is {'as in' if iso else 'against'} ISO 841"
    side = _across(way)
    goes = rotary.sign * np.cross(way, side)
    which, towards = _nearest(side)[0], _nearest(goes)[0]
    yield f"  + moves what is on the {which} side of the axis to {towards} ({WAYS[towards]})"


def _across(way: Floats) -> Floats:
    """Return the coordinate, as a vector (3,), that is most square to an axis, Y before X and Z."""
    order = [1, 0, 2]
    best = min(order, key=lambda k: round(abs(float(way[k])), 2))
    return np.asarray(np.eye(3)[best])


def _nearest(vector: Floats) -> tuple[str, float]:
    """Return the coordinate that a vector (3,) is nearest to, with its sign, and degrees to it."""
    k = int(np.argmax(np.abs(np.round(vector, 9))))
    across = float(np.linalg.norm(np.delete(vector, k)))
    off = float(np.degrees(np.arctan2(across, abs(vector[k]))))
    return f"{'+' if vector[k] > 0 else '-'}{'XYZ'[k]}", off


# --- the tool ---


def _seen(
    chain: Chain,
    position: tuple[Floats, Floats, Floats],
    before: tuple[Floats, Floats],
) -> Iterator[str]:
    """Yield where tip and tool axis go if one axis is jogged alone, and what holds the tip."""
    linear, angles, moved = position
    tip, axis = chain.forward(linear, moved)
    shift = chain.arm(moved) - chain.arm(angles)
    if chain.head:
        yield f"    in the machine the tip moves by   {_vector(shift)} mm"
    yield f"    on the workpiece the tip moves by {_vector(tip - before[0])} mm"
    yield f"      to {_point(tip)}"
    turn = axis - before[1]
    lean = float(np.degrees(2.0 * np.arcsin(min(1.0, float(np.linalg.norm(turn)) / 2.0))))
    if lean > STILL:
        name, _ = _nearest(turn)
        yield f"    on the workpiece the tool leans towards {name}, by {lean:.3f} degrees"
    else:
        yield "    on the workpiece the tool axis stays"
    held = chain.linear(before[0], moved) - linear
    yield f"    the tip is held there if X, Y, Z move by {_vector(held)} mm"


def _point(point: Floats) -> str:
    values = zip("XYZ", (np.round(point, 3) + 0.0).tolist(), strict=True)
    return " ".join(f"{letter}{value:.3f}" for letter, value in values)


def _vector(vector: Floats, digits: int = 3) -> str:
    values = (np.round(vector, digits) + 0.0).tolist()  # + 0.0: no -0
    return f"({', '.join(f'{value:.{digits}f}' for value in values)})"
