"""What a bundle found: lines for a person, comments, and a report.

As in `gcxform/calibrate/rotary/report.py`.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gcxform.calibrate.bundle.bundle import LINEAR, Bundled
from gcxform.calibrate.rotary.axis import ILL
from gcxform.calibrate.rotary.check import two_digits
from gcxform.calibrate.rotary.predicted_check import Check, astray, predicted, spreads, worded
from gcxform.calibrate.rotary.report import WIDTH, located
from gcxform.system.arrays import Floats
from gcxform.version import VERSION

SEEN = 3.0
"""An error of the linear axes is seen above this many standard deviations."""


def lines(found: Bundled) -> list[str]:
    """Return what was found, for a person."""
    poses = found.layout.poses
    said = [
        f"{int(found.kept.sum())} poses of {len(poses.points)}, {len(poses.balls)} "
        f"ball{'s' * (len(poses.balls) > 1)}, {len(found.unknowns)} unknowns, condition "
        f"{found.condition:.1f}",
        f"residuals: {1e3 * found.rms:.3g} um a coordinate, the noise is {1e3 * found.noise:.3g} "
        "um",
    ]
    for letter in found.chain.letters:
        said += [f"axis {letter}: {line}" for line in _axis(found, letter)]
    said += _linear(found)
    said += [worded(check(found, letter), letter) for letter in found.chain.letters]
    return said + [f"warning: {line}" for line in _warnings(found)]


def _warnings(found: Bundled) -> list[str]:
    before = found.layout.chain.axes
    axes = zip(found.chain.letters, before, found.chain.axes, strict=True)
    said = [line for a, was, own in axes for line in astray(a, was, np.array(own.point))]
    return said + found.scatter.warnings + _outliers(found)


def check(found: Bundled, letter: str) -> Check:
    """Return the check of an axis at the angles that were measured, with the first ball."""
    k, before, chain = found.chain.letters.index(letter), found.layout.chain, found.chain
    first = 4 * len(chain.axes)
    ball = np.array(chain.tip) if k >= len(chain.table) else found.unknowns[first : first + 3]
    part = found.covariance[4 * k : 4 * k + 4, 4 * k : 4 * k + 4]
    degrees = np.unique(found.layout.poses.degrees[:, k])
    return predicted(before.axes[k], chain.axes[k], part, ball, degrees)


def expected(found: Bundled) -> list[str]:
    """Return how well a plan will tell the axes, before anything is measured."""
    poses = found.layout.poses
    said = [
        f"{len(poses.points)} poses, {len(poses.balls)} ball{'s' * (len(poses.balls) > 1)}, "
        f"{len(found.unknowns)} unknowns, condition {found.condition:.1f}; with a noise of "
        f"{1e3 * found.noise:.3g} um"
    ]
    for k, letter in enumerate(found.chain.letters):
        shift, tilt = (max(part.tolist()) for part in _spread(found, k))
        said.append(
            f"axis {letter}: +- {two_digits(1e3 * shift)} um, {two_digits(1e6 * tilt)} urad"
        )
    for name in LINEAR[: found.layout.linear]:
        unit = "ppm" if name.startswith("scale") else "urad"
        said.append(f"{name}: +- {two_digits(1e6 * found.spread(name))} {unit}")
    if found.condition > ILL:
        said.append(
            f"warning: badly conditioned (above {ILL:.0f} is poor): the limits leave the axes too "
            "little of a turn where these balls stand"
        )
    return said


def comments(found: Bundled, letter: str, file: str) -> list[str]:
    """Return what stands above the values of an axis in a machine file."""
    name = "".join(c if c.isprintable() else "?" for c in Path(file).name)
    head = (
        f"with all axes by {int(found.kept.sum())} ball centres of {name}; noise "
        f"{1e3 * found.noise:.3g} um (residuals {1e3 * found.rms:.3g} um)"
    )
    said = [head, *_axis(found, letter), *(f"warning: {w}" for w in found.scatter.warnings)]
    return [piece for line in said for piece in textwrap.wrap(line, WIDTH, subsequent_indent="  ")]


def _axis(found: Bundled, letter: str) -> list[str]:
    k = found.chain.letters.index(letter)
    return located(found.chain.axes[k], *_spread(found, k))


def _spread(found: Bundled, k: int) -> tuple[Floats, Floats]:
    """Return the standard deviations of point (3,), mm, and direction (3,) of an axis."""
    return spreads(found.layout.chain.axes[k], found.covariance, k)


def _linear(found: Bundled) -> list[str]:
    said = []
    for name in LINEAR[: found.layout.linear]:
        value, spread = _pair(found, name)
        seen = "" if abs(value) <= SEEN * spread else ": it belongs into the error model"
        unit = "ppm" if name.startswith("scale") else "urad"
        said.append(f"{name}: {1e6 * value:.3g} +- {two_digits(1e6 * spread)} {unit}{seen}")
    return said


def _outliers(found: Bundled) -> list[str]:
    said = []
    for row in np.flatnonzero(~found.kept).tolist():
        where = found.layout.poses.where(row)
        line = "" if where is None else f" (line {where.line})"
        size = 1e3 * float(np.linalg.norm(found.residuals[row]))
        said.append(
            f"outlier, left out: centre {row + 1}{line} is off by {size:.3g} um, "
            f"{found.standardised[row]:.1f} standard deviations"
        )
    return said


def _pair(found: Bundled, name: str) -> tuple[float, float]:
    value = float(found.unknowns[found.layout.names.index(name)])
    return value, found.spread(name)


def report(found: Bundled, file: str, conditions: Mapping[str, Any]) -> dict[str, Any]:
    """Return all that was found, as plain values."""
    axes = {}
    for k, axis in enumerate(found.chain.axes):
        shift, tilt = _spread(found, k)
        axes[axis.letter] = {
            "direction": {"value": list(axis.direction), "sd": tilt.tolist()},
            "point": {"value": list(axis.point), "sd": shift.tolist()},
            "sign": axis.sign,
        }
    linear = {name: _pair(found, name) for name in LINEAR[: found.layout.linear]}
    return {
        "method": "ball centres at poses of all rotary axes",
        "gcxform": VERSION,
        "units": "mm; directions, squareness and scales rad or mm per mm",
        "file": file,
        "noise": found.noise,
        "scatter": found.scatter.report(),
        "axes": axes,
        "linear": {name: {"value": value, "sd": sd} for name, (value, sd) in linear.items()},
        "unknowns": dict(zip(found.layout.names, found.unknowns.tolist(), strict=True)),
        "covariance": {"order": list(found.layout.names), "matrix": found.covariance.tolist()},
        "check": {
            letter: {name: part.tolist() for name, part in check(found, letter)._asdict().items()}
            for letter in found.chain.letters
        },
        "condition": found.condition,
        "redundancy": found.redundancy,
        "rms": found.rms if math.isfinite(found.rms) else None,
        "residuals": found.residuals.tolist(),
        "used": found.kept.tolist(),
        "warnings": _warnings(found),
        "conditions": dict(conditions),
    }
