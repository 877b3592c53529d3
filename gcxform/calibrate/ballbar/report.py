"""What circular tests found of rotary axes: lines for a person, comments, and a report.

As in `gcxform/calibrate/rotary/report.py`. The check afterwards turns one axis with RTCP on, the
ball of the first test of the axis at rest on the table and the spindle's dial on it, as in
`gcxform/calibrate/rotary/check.py`.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from gcxform.calibrate.ballbar.ballbar import Eccentricity, Identified
from gcxform.calibrate.ballbar.file import bar_name
from gcxform.calibrate.ballbar.locations import Named, locations, of_trunnion
from gcxform.calibrate.rotary.axis import ILL, arc, condition
from gcxform.calibrate.rotary.check import two_digits
from gcxform.calibrate.rotary.predicted_check import Check, predicted, spreads, worded
from gcxform.calibrate.rotary.report import WIDTH, located
from gcxform.machine.chain import Rotary
from gcxform.system.arrays import Floats
from gcxform.version import VERSION

AROUND: Final = np.arange(0.0, 360.0, 10.0)
"""Where the check is predicted if only eccentricities are known, degrees."""


def lines(found: Identified) -> list[str]:
    """Return what was found, for a person."""
    said = [_test(k, test) for k, test in enumerate(found.tests, 1)]
    for letter in found.letters:
        said += [f"axis {letter}: {line}" for line in _axis(found, letter)]
    named = of_trunnion(found) or locations(found)
    return [
        *said,
        *(_error(named, k) for k in range(len(named.names))),
        *(worded(check(found, letter), letter) for letter in found.letters),
        *(f"warning: {line}" for line in warnings(found)),
        *(f"next: {line}" for line in advice(found)),
    ]


def comments(found: Identified, letter: str, file: str) -> list[str]:
    """Return what stands above the values of an axis in a machine file."""
    name = "".join(c if c.isprintable() else "?" for c in Path(file).name)
    head = (
        f"by {len(found.tests)} circular tests of {name}, RTCP on; noise {1e3 * found.noise:.3g} um"
    )
    said = [head, *_axis(found, letter), *(f"warning: {line}" for line in warnings(found))]
    return [piece for line in said for piece in textwrap.wrap(line, WIDTH, subsequent_indent="  ")]


def _test(number: int, test: Eccentricity) -> str:
    setup = test.setup
    place = " ".join(f"{a}{v:g}" for a, v in zip("XYZ", setup.ball, strict=True))
    cosine, sine = (1e3 * test.value).tolist()
    sd = ", ".join(two_digits(1e3 * math.sqrt(v)) for v in np.diag(test.covariance).tolist())
    said = (
        f"test {number}: {setup.letter}, bar {bar_name(setup)}, ball {place}: cosine {cosine:+.3f} "
        f"sine {sine:+.3f} +- ({sd}) um"
    )
    if test.trace is None:
        return said
    degrees = test.trace.degrees
    return (
        f"{said}; {len(degrees)} readings, arc {arc(degrees):.4g} degrees, condition "
        f"{condition(degrees):.1f}, residuals {1e3 * test.rms:.3g} um"
    )


def _axis(found: Identified, letter: str) -> list[str]:
    k = found.letters.index(letter)
    return located(found.chain.axes[k], *_spread(found, k))


def _spread(found: Identified, k: int) -> tuple[Floats, Floats]:
    """Return the standard deviations of point (3,), mm, and direction (3,) of an axis."""
    return spreads(found.believed.table[k], found.covariance, k)


def _error(named: Named, k: int) -> str:
    shift = named.names[k][0] in "dXYZ"
    scale, unit = (1e3, "um") if shift else (1e6, "urad")
    spread = two_digits(scale * float(named.deviation[k]))
    return f"{named.names[k]}: {scale * float(named.value[k]):+.2f} +- {spread} {unit}"


# --- the check ---


def check(found: Identified, letter: str) -> Check:
    """Return what the dial is predicted to read with an axis as it was found, and as it was."""
    k = found.letters.index(letter)
    believed, true = found.believed.table[k], found.chain.table[k]
    test = next(test for test in found.tests if test.setup.letter == letter)
    degrees = AROUND if test.trace is None else np.unique(test.trace.degrees)
    part = found.covariance[4 * k : 4 * k + 4, 4 * k : 4 * k + 4]
    return predicted(believed, true, part, np.array(test.setup.ball), degrees)


# --- what is to be said ---


def warnings(found: Identified) -> Iterator[str]:
    """Yield what whoever believes the result has to know."""
    if found.spindle == (0.0, 0.0):
        yield (
            "the spindle ball is taken to be on the spindle: what it is off goes into the points "
            "of the axes (--spindle-ball)"
        )
    yield from found.scatter.warnings
    for k, test in enumerate(found.tests, 1):
        poor = 0.0 if test.trace is None else condition(test.trace.degrees)
        if poor > ILL:
            yield f"test {k} is badly conditioned: {poor:.0f} (above {ILL:.0f} is poor)"
        if test.trace is not None and not math.isfinite(test.rms):
            yield f"test {k} has no redundancy: nothing tests its three readings"
    if found.solution.redundancy == 0 and all(test.trace is None for test in found.tests):
        yield "no redundancy: as many eccentricities as unknowns, and nothing tests them"


def advice(found: Identified) -> Iterator[str]:
    """Yield what makes the next measurement better."""
    for k, axis in enumerate(found.believed.table):
        shift, tilt = (1e3 * float(_spread(found, k)[0].max()), 1e6 * _spread(found, k)[1].max())
        levers = [_lever(axis, test) for test in found.tests if test.setup.letter == axis.letter]
        yield (
            f"{axis.letter} is known to {two_digits(shift)} um and {two_digits(float(tilt))} urad; "
            f"that of the direction goes with 1 / distance of the ball, here {max(levers):.4g} mm "
            "at most, and both with the arc"
        )


def _lever(axis: Rotary, test: Eccentricity) -> float:
    lever = np.subtract(test.setup.ball, axis.point)
    return float(np.linalg.norm(np.cross(lever, axis.direction)))


def report(found: Identified, file: str, conditions: Mapping[str, Any]) -> dict[str, Any]:
    """Return all that was found, as plain values."""
    relative = of_trunnion(found)
    return {
        "method": "circular tests of rotary axes with RTCP on",
        "gcxform": VERSION,
        "units": "mm; angles degrees; directions and errors of them rad",
        "file": file,
        "noise": found.noise,
        "scatter": found.scatter.report(),
        "spindle-ball": list(found.spindle),
        "tests": [_reported(test) for test in found.tests],
        "axes": {letter: _of_axis(found, letter) for letter in found.letters},
        "locations": _named(locations(found)),
        "trunnion": None if relative is None else _named(relative),
        "redundancy": found.solution.redundancy,
        "check": {
            letter: {name: part.tolist() for name, part in check(found, letter)._asdict().items()}
            for letter in found.letters
        },
        "warnings": [*warnings(found)],
        "advice": [*advice(found)],
        "conditions": dict(conditions),
    }


def _reported(test: Eccentricity) -> dict[str, Any]:
    setup, trace = test.setup, test.trace
    said: dict[str, Any] = {
        "axis": setup.letter,
        "bar": bar_name(setup),
        "ball": list(setup.ball),
        "cosine-sine": {"value": test.value.tolist(), "covariance": test.covariance.tolist()},
    }
    if trace is not None:
        said |= {
            "arc": arc(trace.degrees),
            "condition": condition(trace.degrees),
            "rms": test.rms if math.isfinite(test.rms) else None,
            "angles": trace.degrees.tolist(),
            "residuals": test.residuals.tolist(),
        }
    return said


def _of_axis(found: Identified, letter: str) -> dict[str, Any]:
    k = found.letters.index(letter)
    axis = found.chain.table[k]
    shift, tilt = _spread(found, k)
    return {
        "direction": {"value": list(axis.direction), "sd": tilt.tolist()},
        "point": {"value": list(axis.point), "sd": shift.tolist()},
        "sign": axis.sign,
    }


def _named(named: Named) -> dict[str, Any]:
    values = zip(named.names, named.value.tolist(), named.deviation.tolist(), strict=True)
    return {
        "errors": {name: {"value": value, "sd": sd} for name, value, sd in values},
        "covariance": {"order": list(named.names), "matrix": named.covariance.tolist()},
    }
