"""What a calibration by diagonals found, for a person and for programs: comments and a report.

Lengths are in mm and angles in rad in the report, as in model files; comments have um and urad.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping
from typing import Any, Final

import numpy as np

from gcxform.calibrate.diagonal.angles import Angles
from gcxform.calibrate.diagonal.plain_diagonal import ANGLES, BLIND, Squareness, spread
from gcxform.calibrate.diagonal.readings import Diagonals, Volume, name_of
from gcxform.calibrate.diagonal.reframe import FRAME
from gcxform.calibrate.diagonal.slopes import together, worded
from gcxform.calibrate.diagonal.step_diagonal import REJECTED, Identified
from gcxform.errormodel.model import AXES
from gcxform.system.arrays import Floats
from gcxform.version import VERSION

UNITS: Final = "mm, rad, mm^2"
SQUARENESS: Final = (("C0Y", -1.0), ("B0Z", 1.0), ("A0Z", -1.0))  # of EXY, EXZ, EYZ slopes
NAMES: Final = tuple(f"E{direction}{axis}" for axis in AXES for direction in AXES)
MEAN_SCALE: Final = "(X^2 sX + Y^2 sY + Z^2 sZ) / (X^2 + Y^2 + Z^2)"
WIDTH: Final = 98
_ASSUMED: Final = {
    True: "free to be misaligned, by two angles each, which were estimated",
    False: "taken to be exactly along the diagonals; 0.1 mrad off would shift the end of a "
    "scale by some 20 um on 0.5 m",
}

Report = dict[str, Any]


# --- reports ---


def step_report(
    found: Identified, files: Mapping[str, Any], conditions: Mapping[str, Any]
) -> Report:
    """Return all that was found, as plain values; what the readings do not tell is None."""
    known, angles = found.determined.reshape(9), Angles(found)
    slopes, spread_of_slopes = found.slopes
    sigma = np.sqrt(np.diag(spread_of_slopes).clip(0.0))
    values = found.functions.reshape(9, -1)
    mean, mean_sd = found.mean_scale
    return {
        **_head("sequential step diagonal", found.diagonals, files),
        "noise": found.assumed.noise,
        "linear-noise": found.assumed.of_linear if found.linear else None,
        "misalignment": "free" if found.assumed.free_beams else "none",
        "observable": _observable(found),
        "redundancy": _redundancy(found),
        "scatter": found.scatter.report(),
        "angles": angles.report(),
        "warnings": [*angles.warnings],
        "repeatability": _number(found.increments.scatter),
        "mean-scale": {"meaning": MEAN_SCALE, **_pair(mean, mean_sd)},
        "scales": {
            axis: _pair(slopes[k], sigma[k]) if known[4 * k] else None
            for k, axis in enumerate(AXES)
        },
        "squareness": _squareness(slopes[3:], sigma[3:]),
        "misalignments": _misalignments(found),
        "functions": {
            name: _function(values[k], found.deviations.reshape(9, -1)[k]) if known[k] else None
            for k, name in enumerate(NAMES)
        },
        "shapes": {
            name: [0.0, *shape]
            for name, shape in zip(NAMES, found.shapes.reshape(9, -1).tolist(), strict=True)
        },
        "covariance": _covariance(found),
        "conditions": dict(conditions),
    }


def plain_report(
    found: Squareness, files: Mapping[str, Any], conditions: Mapping[str, Any]
) -> Report:
    """Return what four lengths tell, as plain values."""
    sigma = spread(found)
    legs = zip(found.diagonals.legs, found.lengths.tolist(), strict=True)
    return {
        **_head("plain diagonal test", found.diagonals, files),
        "noise": found.noise,
        "scatter": found.scatter.report(),
        "warnings": found.scatter.warnings,
        "deviations": [[leg.name, length] for leg, length in legs],
        "squareness": _squareness(found.slopes, sigma[1:]),
        "mean-scale": {"meaning": MEAN_SCALE, **_pair(found.mean_scale, sigma[0])},
        "blind": f"{BLIND}; {ANGLES}",
        "covariance": {
            "order": ["mean scale", "EXY slope", "EXZ slope", "EYZ slope"],
            "matrix": found.covariance.tolist(),
        },
        "conditions": dict(conditions),
    }


def _head(method: str, diagonals: Diagonals, files: Mapping[str, Any]) -> Report:
    volume = diagonals.volume
    return {
        "method": method,
        "gcxform": VERSION,
        "units": UNITS,
        "files": dict(files),
        "frame": FRAME,
        "volume": {
            "low": volume.low.tolist(),
            "travel": volume.travel.tolist(),
            "diagonal": volume.diagonal,
            "steps": volume.steps,
        },
        "nodes": {axis: volume.nodes(k).tolist() for k, axis in enumerate(AXES)},
    }


def _observable(found: Identified) -> Report:
    seen, hidden = found.observable_slopes, found.hidden_slopes
    return {
        "unknowns": found.layout.size,
        "rank": found.solution.rank,
        "slopes": len(seen),
        "of": len(seen) + len(hidden),
        "combinations": [worded(row) for row in seen],
        "hidden": [together(row) for row in hidden],
    }


def _redundancy(found: Identified) -> Report:
    by_step = found.redundancy.tolist()
    return {
        "equations": found.solution.redundancy,
        "rms": _number(found.redundancy_rms),
        "limit": REJECTED * found.assumed.noise,
        "by-step": dict(zip(AXES, by_step, strict=True)),
    }


def _squareness(slopes: Floats, sigma: Floats) -> Report:
    triples = zip(SQUARENESS, slopes, sigma, strict=True)
    return {name: _pair(sign * slope, sd) for (name, sign), slope, sd in triples}


def _misalignments(found: Identified) -> Report | None:
    if found.misalignments is None:
        return None
    angles, sigma = found.misalignments
    triples = zip(found.diagonals.lines, angles.tolist(), sigma.tolist(), strict=True)
    return {name_of(signs): {"level": a[0], "up": a[1], "sd": s} for signs, a, s in triples}


def _function(values: Floats, sigma: Floats) -> Report:
    return {"values": [0.0, *values.tolist()], "sd": [0.0, *sigma.tolist()]}


def _covariance(found: Identified) -> Report:
    """Return the covariance of the values of all functions that are known."""
    steps = found.layout.steps
    known = np.repeat(found.determined.reshape(9), steps)
    order = [f"{name}[{k}]" for name in NAMES for k in range(1, steps + 1)]
    return {
        "order": [label for label, one in zip(order, known, strict=True) if one],
        "matrix": found.covariance[np.ix_(known, known)].tolist(),
    }


def _pair(value: float, sigma: float) -> Report:
    return {"value": float(value), "sd": float(sigma)}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


# --- comments ---


def step_comments(found: Identified, files: Mapping[str, Any]) -> str:
    """Return what stands above a model from step diagonals."""
    slopes, covariance = found.slopes
    sigma = np.sqrt(np.diag(covariance).clip(0.0))
    ratio = found.redundancy_rms
    shown = f"the residuals show {_um(ratio)} um" if math.isfinite(ratio) else "nothing to test it"
    beams = _ASSUMED[found.assumed.free_beams]
    lines = [
        "Errors of the axes by the sequential step diagonal (vector method).",
        *_origin(files, found.diagonals.volume),
        f"Beams: {beams}.",
        f"Noise: {_um(found.assumed.noise)} um a step ({shown})"
        + (f", {_um(found.assumed.of_linear)} um a linear reading." if found.linear else "."),
        *_scales(slopes, sigma),
        *_square_lines(slopes[3:], sigma[3:]),
        "Standard deviations at the nodes behind the first, um:",
    ]
    for name, row in zip(NAMES, found.deviations.reshape(9, -1), strict=True):
        lines.append(f"  {name}  {' '.join(f'{value * 1e3:.2f}' for value in row)}")
    angles = Angles(found)
    lines += [angles.words, *(f"Warning: {line}." for line in angles.warnings)]
    return _commented(lines)


def plain_comments(found: Squareness, files: Mapping[str, Any]) -> str:
    """Return what stands above a model from a plain diagonal test."""
    sigma = spread(found)
    lines = [
        "Squareness by a plain diagonal test; scales and straightness are set to 0.",
        *_origin(files, found.diagonals.volume),
        f"Noise: {_um(found.noise)} um a length.",
        *_square_lines(found.slopes, sigma[1:]),
        f"Mean scale {found.mean_scale * 1e6:.2f} +- {sigma[0] * 1e6:.2f} ppm, not in this model:",
        f"{BLIND}; {ANGLES}.",
        *(f"Warning: {line}." for line in found.scatter.warnings),
    ]
    return _commented(lines)


def _origin(files: Mapping[str, Any], volume: Volume) -> list[str]:
    ends = zip(AXES, volume.low, volume.low + volume.travel, strict=True)
    box = ", ".join(f"{axis} {low:.6g} to {high:.6g}" for axis, low, high in ends)
    names = ", ".join(str(name) for part in files.values() for name in _listed(part))
    return [
        f"Measured: {names}",
        f"Volume: {box} mm in {volume.steps} step{'s' * (volume.steps > 1)}.",
        f"Frame: {FRAME}.",
    ]


def _listed(part: Any) -> Iterable[Any]:
    return part if isinstance(part, list) else [part]


def _scales(slopes: Floats, sigma: Floats) -> list[str]:
    pairs = zip(AXES, slopes, sigma, strict=False)
    said = ", ".join(f"{axis} {s * 1e6:.2f} +- {d * 1e6:.2f}" for axis, s, d in pairs)
    return [f"Scale errors (end points): {said} ppm."]


def _square_lines(slopes: Floats, sigma: Floats) -> list[str]:
    triples = zip(SQUARENESS, slopes, sigma, strict=True)
    said = ", ".join(f"{n} {sign * s * 1e6:.2f} +- {d * 1e6:.2f}" for (n, sign), s, d in triples)
    return [f"Squareness: {said} urad, in the functions of Y and Z."]


def _commented(lines: list[str]) -> str:
    # A name of a file may hold anything; a control character would end the comment.
    kept = ("".join(c if c.isprintable() else "?" for c in line) for line in lines)
    wrapped = (textwrap.wrap(line, WIDTH, subsequent_indent="  ") for line in kept)
    return "".join(f"# {piece}\n" for pieces in wrapped for piece in pieces)


def _um(length: float) -> str:
    return f"{length * 1e3:.3g}"
