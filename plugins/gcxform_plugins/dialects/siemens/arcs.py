"""Arcs of a SINUMERIK whose words are not those of plain arcs: I=AC, AR=, CIP, TURN=."""

from __future__ import annotations

import math
from decimal import Decimal

from gcxform_plugins.dialects.siemens.line import ABSOLUTE, Line
from gcxform_plugins.dialects.siemens.place import Place, PlaceError, text_of

CENTRES = {"X": "I", "Y": "J", "Z": "K"}
NEAR = 0.01  # mm: nearer ends may be full circles to the control
LEAST_BEND = 1e-9
START = "tell all axes of its plane where to go before"


def turns(line: Line, place: Place, plane: str, ends: dict[str, float]) -> str:
    """Return the word for TURN, the count of turns beyond the arc. Raises PlaceError."""
    if "TURN" not in line.named:
        return ""
    number = line.named["TURN"][0]
    if not number.isdigit():
        raise PlaceError("GX213", f"TURN={number} counts no turns", "write a whole number")
    starts = _starts(place, plane)
    if math.dist(starts, [ends.get(a, s) for a, s in zip(plane, starts, strict=True)]) < NEAR:
        message = "TURN= of a full circle: whether the circle itself counts is not known"
        raise PlaceError("GX210", message, "write the circle and the turns as blocks of their own")
    return f"P{int(number) + 1}"


def _starts(place: Place, plane: str) -> list[float]:
    """Return where the axes of an arc stand. Raises PlaceError."""
    found = [place.known(axis) for axis in plane]
    if any(value is None for value in found):
        raise PlaceError("GX208", "an arc, but where it starts is not known", START)
    return [float(value) for value in found if value is not None]


def centre_words(line: Line, place: Place, plane: str) -> tuple[bool, list[str]]:
    """Return whether centres are absolute, and their words. Raises PlaceError.

    Where the arc starts is known, those in AC become distances; else both of them have to be in AC,
    and stay as they are.
    """
    ways = {letter: way for letter, (way, _, _) in line.centres.items()}
    if ABSOLUTE not in ways.values():
        return False, [letter + number for letter, (_, number, _) in line.centres.items()]
    axes = {CENTRES[axis]: axis for axis in plane}
    if not line.centres.keys() <= axes.keys():
        raise PlaceError(
            "GX304", "a centre beside the plane of the arc", "select the plane that is meant before"
        )
    starts = {letter: place.known(axis) for letter, axis in axes.items()}
    if None in starts.values():
        if len(ways) < len(axes) or "" in ways.values():
            raise PlaceError("GX208", "an arc, but where it starts is not known", START)
        return True, [letter + number for letter, (_, number, _) in line.centres.items()]
    words = []
    for letter, (way, number, _) in line.centres.items():
        start = starts[letter] if way == ABSOLUTE else None
        words.append(letter + (number if start is None else text_of(Decimal(number) - start)))
    return False, words


def opened(
    line: Line, place: Place, plane: str, sense: int, ends: dict[str, float]
) -> dict[str, float]:
    """Return the centre as distances, and the end, of an arc by its opening angle.

    Of an end: the centre is beside the middle of the chord, chord / (2 tan(angle / 2)) from it.
    Of a centre: the end is the start, turned about it. Raises PlaceError.
    """
    angle = math.radians(float(line.named["AR"][0]))
    if not 0 < angle < 2 * math.pi:
        raise PlaceError(
            "GX213", "AR= takes angles between 0 and 360", "write I, J, K for a circle"
        )
    (a, b), first, second = _starts(place, plane), *plane
    if line.centres:
        if any(way for way, _, _ in line.centres.values()) or ends.keys() & set(plane):
            raise PlaceError("GX210", "AR= beside an end and a centre", "write I, J and the end")
        i, j = (float(line.centres.get(CENTRES[x], ("", "0"))[1]) for x in plane)
        c, s = math.cos(angle), sense * math.sin(angle)
        return {
            CENTRES[first]: i,
            CENTRES[second]: j,
            first: a + i - c * i + s * j,
            second: b + j - s * i - c * j,
        }
    dx, dy = ends.get(first, a) - a, ends.get(second, b) - b
    if math.hypot(dx, dy) < NEAR:
        raise PlaceError("GX302", "an arc by its angle cannot end where it starts", "write I, J, K")
    side = sense / (2 * math.tan(angle / 2))
    return {CENTRES[first]: dx / 2 - side * dy, CENTRES[second]: dy / 2 + side * dx}


def through(
    line: Line, place: Place, plane: str, ends: dict[str, float]
) -> tuple[str, list[float]]:
    """Return the sense ("2" or "3") and the centre of CIP, as distances. Raises PlaceError.

    The centre is where the perpendicular bisectors of start, middle and end meet.
    """
    across = next(axis for axis in "XYZ" if axis not in plane)
    (a, b) = _starts(place, plane)
    level = place.known(across)
    middles = {axis: _middle(line, axis) for axis in "XYZ"}
    straying = [v for v in (ends.get(across), middles[across]) if v is not None]
    if any(level is None or abs(v - float(level)) > LEAST_BEND for v in straying):
        message = f"CIP leaves the plane of {plane[0]} and {plane[1]}"
        raise PlaceError("GX210", message, "let the CAM write arcs in a plane, or lines")
    m = [middles[x] if middles[x] is not None else s for x, s in zip(plane, (a, b), strict=True)]
    px, py = float(m[0] or 0.0) - a, float(m[1] or 0.0) - b
    qx, qy = ends.get(plane[0], a) - a, ends.get(plane[1], b) - b
    bend = px * qy - py * qx
    if abs(bend) < LEAST_BEND or math.hypot(qx, qy) < NEAR:
        message = "CIP: start, middle and end are on a line, or two of them are one point"
        raise PlaceError("GX302", message, "write a line, or a circle by its centre")
    p, q = px * px + py * py, qx * qx + qy * qy
    centre = [(p * qy - q * py) / (2 * bend), (q * px - p * qx) / (2 * bend)]
    return ("3" if bend > 0 else "2"), centre


def _middle(line: Line, axis: str) -> float | None:
    """Return a coordinate of the point that CIP passes, None where it has no word."""
    if CENTRES[axis] not in line.middles:
        return None
    way, number, _ = line.middles[CENTRES[axis]]
    if way not in ("", ABSOLUTE):
        message = f"{CENTRES[axis]}1={way}(...): what it is counted from is not known for certain"
        raise PlaceError("GX210", message, f"write {CENTRES[axis]}1=AC(...)")
    return float(number)


def decimals(values: dict[str, float]) -> list[str]:
    """Return computed words."""
    return [letter + text_of(Decimal(f"{value:.9f}")) for letter, value in values.items()]
