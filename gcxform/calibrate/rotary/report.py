"""What a calibration of a rotary axis found: lines for a person, comments, and a report.

Lengths are mm and angles degrees or, where they are small, rad in the report; lines have um, urad.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from gcxform.calibrate.rotary.axis import OUTLYING, Placed, arc, without_each
from gcxform.calibrate.rotary.check import (
    advice,
    checked_angles,
    components,
    dial,
    dial_spread,
    harmonics,
    named,
    rotary_of,
    standing,
    two_digits,
    warnings,
)
from gcxform.calibrate.rotary.circle import spread
from gcxform.calibrate.rotary.predicted_check import astray
from gcxform.machine.axis_text import MARK
from gcxform.machine.chain import Rotary
from gcxform.machine.machine import Axis
from gcxform.system.arrays import Floats
from gcxform.version import VERSION

WIDTH: Final = 98 - len(MARK)


def lines(found: Placed, letter: str, before: Axis | None = None) -> list[str]:
    """Return what was found, for a person; `before` is the axis as the machine file has it."""
    degrees = found.centres.degrees
    free = found.free
    return [
        f"axis {letter}: {int(found.kept.sum())} centres of {len(degrees)}, arc {arc(degrees):.4g} "
        f"degrees, radius {found.figure.radius:.4f} mm, condition {found.condition:.1f}",
        *_result(found),
        f"residuals: {1e3 * found.rms:.3g} um a coordinate, the noise is {1e3 * found.noise:.3g} um"
        f"; largest {found.standardised[found.kept].max():.1f} standard deviations",
        _leaving_out(found),
        f"circle without the angles: centre {_um(free.centre - found.figure.centre)} um away, "
        f"radius {1e3 * (float(free.radius) - found.figure.radius):+.3g} um",
        _check(found, letter, before),
        *(f"warning: {warning}" for warning in astray(letter, before, found.point)),
        *(f"warning: {warning}" for warning in warnings(found)),
        *(f"next: {line}" for line in advice(found, before.limits if before else None)),
    ]


def expected(found: Placed, letter: str) -> list[str]:
    """Return how well a plan will tell an axis, before anything is measured."""
    sd = np.sqrt(np.diag(found.covariance).clip(0.0))
    shift, tilt = 1e3 * float(sd[:3].max()), 1e6 * float(sd[3:].max())
    return [
        f"axis {letter}: {len(found.centres)} centres, arc {arc(found.centres.degrees):.4g} "
        f"degrees, radius {found.figure.radius:.4g} mm, condition {found.condition:.1f}; with a "
        f"noise of {1e3 * found.noise:.3g} um +- {two_digits(shift)} um, {two_digits(tilt)} urad",
        *(f"warning: {warning}" for warning in warnings(found)),
    ]


def comments(found: Placed, file: str) -> list[str]:
    """Return what stands above the values in a machine file."""
    # A name of a file may hold anything; a control character would end the comment.
    name = "".join(c if c.isprintable() else "?" for c in Path(file).name)
    head = f"by {int(found.kept.sum())} of {len(found.centres)} ball centres of {name}, "
    poor = [f"warning: {line}" for line in warnings(found)]
    arcs = f"arc {arc(found.centres.degrees):.4g} degrees at {found.figure.radius:.1f} mm; "
    noise = f"noise {1e3 * found.noise:.3g} um (residuals {1e3 * found.rms:.3g} um)"
    said = [head + arcs + noise, *_result(found), *poor]
    return [piece for line in said for piece in textwrap.wrap(line, WIDTH, subsequent_indent="  ")]


def located(axis: Placed | Rotary, shift: Floats, tilt: Floats) -> list[str]:
    """Return where an axis is, with standard deviations (3,) of point (mm) and direction (rad)."""
    direction = ", ".join(f"{part:.7f}" for part in axis.direction)
    point = " ".join(f"{a}{v:.4f}" for a, v in zip("XYZ", axis.point, strict=True))
    return [
        f"direction ({direction}) +- ({_list(1e6 * tilt)}) urad, sign {axis.sign:+d}",
        f"point {point} mm +- ({_list(1e3 * shift)}) um; it may be shifted along the axis",
    ]


def _result(found: Placed) -> list[str]:
    sd = np.sqrt(np.diag(found.covariance).clip(0.0))
    return located(found, sd[:3], sd[3:])


def _leaving_out(found: Placed) -> str:
    point, direction = (np.linalg.norm(part, axis=1) for part in without_each(found))
    if not np.isfinite(point).any():
        return "leaving one out: the others alone do not determine the axis"
    row = int(np.nanargmax(point))
    return (
        f"leaving one out: the point moves by at most {1e3 * point[row]:.3g} um "
        f"({named(found, row)}), the direction by {1e6 * np.nanmax(direction):.3g} urad"
    )


def _check(found: Placed, letter: str, before: Axis | None) -> str:
    angles = checked_angles(found)
    spread = dial_spread(found, angles)
    worst = int(spread.argmax())
    said = (
        f"check with RTCP on, the ball at rest, {letter} turned by {angles[worst]:g} degrees: the "
        f"dial is predicted to read 0 +- {1e3 * spread[worst]:.3g} um"
    )
    old = _believed(letter, before)
    if old is None:
        return said
    shown = np.linalg.norm(
        dial(rotary_of(found, letter), old, found.point + standing(found), angles), axis=1
    )
    at = int(shown.argmax())
    return f"{said}; with the axis as it was {1e3 * shown[at]:.3g} um, at {angles[at]:g} degrees"


def _believed(letter: str, axis: Axis | None) -> Rotary | None:
    if axis is None or axis.direction is None or axis.point is None or axis.sign is None:
        return None
    return Rotary(letter, axis.direction, axis.point, axis.sign)


def report(
    found: Placed,
    letter: str,
    file: str,
    conditions: Mapping[str, Any],
    before: Axis | None = None,
) -> dict[str, Any]:
    """Return all that was found, as plain values; what is not known is None."""
    angles = checked_angles(found)
    point, direction = without_each(found)
    sd = np.sqrt(np.diag(found.covariance).clip(0.0))
    return {
        "method": "ball centres at angles of a rotary axis",
        "gcxform": VERSION,
        "units": "mm; angles degrees; directions and their deviations rad",
        "file": file,
        "axis": letter,
        "turns": "table" if found.tip is None else "head",
        "noise": found.noise,
        "scatter": found.scatter.report(),
        "direction": {"value": found.direction.tolist(), "sd": sd[3:].tolist()},
        "point": {"value": found.point.tolist(), "sd": sd[:3].tolist()},
        "sign": found.sign,
        "covariance": {
            "order": [*"XYZ", "direction X", "direction Y", "direction Z"],
            "matrix": found.covariance.tolist(),
        },
        "radius": found.figure.radius,
        "arc": arc(found.centres.degrees),
        "condition": found.condition,
        "redundancy": found.redundancy,
        "rms": found.rms,
        "singular": found.free.singular.tolist(),
        "free-circle": _free(found),
        "centres": _centres(found, point, direction),
        "harmonics": harmonics(found),
        "check": {"angles": angles.tolist(), "sd": dial_spread(found, angles).tolist()},
        "warnings": [*astray(letter, before, found.point), *warnings(found)],
        "advice": [*advice(found, before.limits if before else None)],
        "conditions": dict(conditions),
    }


def _free(found: Placed) -> dict[str, Any]:
    """Return the circle without the angles."""
    free = found.free
    both, of_radius = spread(found.centres.points[found.kept], free, found.scatter.effective)
    sd = np.sqrt(np.diag(both).clip(0.0)).tolist()
    return {
        "centre": {"value": free.centre.tolist(), "sd": sd[:3]},
        "direction": {"value": free.direction.tolist(), "sd": sd[3:]},
        "radius": {"value": float(free.radius), "sd": math.sqrt(float(of_radius))},
    }


def _centres(found: Placed, point: Any, direction: Any) -> list[dict[str, Any]]:
    parts = components(found)
    return [
        {
            "angle": float(found.centres.degrees[k]),
            "radial": float(parts[k, 0]),
            "tangential": float(parts[k, 1]),
            "axial": float(parts[k, 2]),
            "standardised": float(found.standardised[k]),
            "outlier": bool(found.standardised[k] > OUTLYING),
            "used": bool(found.kept[k]),
            "without": {"point": _size(point[k]), "direction": _size(direction[k])},
        }
        for k in range(len(found.centres))
    ]


def _size(vector: Any) -> float | None:
    size = float(np.linalg.norm(vector))
    return size if math.isfinite(size) else None


def _list(values: Any) -> str:
    return ", ".join(map(two_digits, values))


def _um(vector: Any) -> str:
    return f"{1e3 * float(np.linalg.norm(vector)):.3g}"
