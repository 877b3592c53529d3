"""Plane geometry of arcs: centre from a radius, radius rule, sweep."""

import math

Point = tuple[float, float]
INCH = 25.4


def centre_from_radius(start: Point, end: Point, radius: float, clockwise: bool) -> Point:
    """Return the centre for an R word; a radius a little short of half the chord is half of it.

    A positive radius gives the arc of at most half a turn, a negative one the other.
    """
    dx, dy = end[0] - start[0], end[1] - start[1]
    chord = math.hypot(dx, dy)
    height = math.sqrt(max(0.0, radius * radius - chord * chord / 4))
    side = 1.0 if clockwise == (radius > 0) else -1.0  # +1: to the right of start -> end
    return (
        (start[0] + end[0]) / 2 + side * height * dy / chord,
        (start[1] + end[1]) / 2 - side * height * dx / chord,
    )


def sweep(start: Point, end: Point, centre: Point, clockwise: bool, fuzz: float) -> float:
    """Return the swept angle in radians, in (fuzz, 2 pi + fuzz]; start == end is a full turn."""
    first = math.atan2(start[1] - centre[1], start[0] - centre[0])
    last = math.atan2(end[1] - centre[1], end[0] - centre[0])
    angle = (first - last if clockwise else last - first) % math.tau
    return angle + math.tau if angle <= fuzz else angle


def radii_agree(start_radius: float, end_radius: float, dialect: str, inch: bool) -> bool:
    """Tell whether the control accepts these radii (mm) of an arc with a programmed centre."""
    unit = INCH if inch else 1.0
    difference = abs(start_radius - end_radius)
    if dialect == "linuxcnc":
        limit = (0.00282843 if inch else 0.0282843) * unit
        smallest = (0.00005 if inch else 0.00127) * unit
        return (
            min(start_radius, end_radius) >= smallest * (1 - 1e-9)
            and difference <= max(limit, 0.001 * max(start_radius, end_radius))
            and difference <= 100 * limit
        )
    if dialect == "grbl":
        return difference <= min(0.5, max(0.005, 0.001 * start_radius))
    return difference <= FANUC_TOLERANCE and start_radius > 0


def radius_reaches(radius: float, chord: float, dialect: str, inch: bool) -> bool:
    """Tell whether an R word (mm, signed) spans the chord (mm) for the control."""
    slack = {"linuxcnc": 0.00005 * INCH if inch else 0.00127}.get(dialect, 0.0)
    return chord / 2 - abs(radius) <= slack


FANUC_TOLERANCE = 0.01  # mm; parameter 3410, the low end of what machines are set to
FUZZ = {
    "linuxcnc": 1e-6,
    "grbl": 5e-7,
    "fanuc": 1e-9,
    "haas": 1e-9,
}  # rad: below this an arc is a full turn
