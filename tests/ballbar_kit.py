"""Exact circular tests with RTCP on, by the matrices of scipy: shares nothing with the estimator.

The machine of the reference, section 5, and its eight errors: M_T(A, C) = Tr(PA) Tr(d) Rz Ry Rx
Rx(-A) Tr(o) Tr(0, dyCA, 0) Ry(beCA) Rz(-C), and a point of the table at zero goes by M_T(A, C)
M_T(0, 0)^-1. The same with B: Ry(-B), dxCB and alCB.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from gcxform.calibrate.ballbar.ballbar import SetUp, Trace, eccentricity, identify
from gcxform.machine.chain import Chain, Rotary

PA, PC = np.array([5.0, -32.0, -95.0]), np.array([5.0, -20.0, -60.0])
SPINDLE = (0.012, -0.009)
LENGTH = 100.0
ERRORS = {
    "A": {
        "dxAY": 0.021,
        "dyAY": -0.034,
        "dzAY": 0.046,
        "alAY": 80e-6,
        "beAY": -110e-6,
        "gaAY": 130e-6,
        "dyCA": -0.027,
        "beCA": 60e-6,
    },
    "B": {
        "dxBY": 0.021,
        "dyBY": -0.034,
        "dzBY": 0.046,
        "alBY": 80e-6,
        "beBY": -110e-6,
        "gaBY": 130e-6,
        "dxCB": -0.027,
        "alCB": 60e-6,
    },
}
X, Y, Z = np.eye(3)


def nominal(tilting="A"):
    """Return the machine that the control knows."""
    way = (1.0, 0.0, 0.0) if tilting == "A" else (0.0, 1.0, 0.0)
    first = Rotary(tilting, way, tuple(PA.tolist()), -1)
    return Chain((first, Rotary("C", (0.0, 0.0, 1.0), tuple(PC.tolist()), -1)))


def shifted(shift):
    found = np.eye(4)
    found[:3, 3] = shift
    return found


def about(axis, angle):
    """Return the matrices (..., 4, 4) of turns about X, Y or Z by angles (...), rad."""
    found = np.zeros((*np.shape(angle), 4, 4))
    found[..., 3, 3] = 1.0
    vectors = np.asarray(angle)[..., None] * np.eye(3)["xyz".index(axis)]
    found[..., :3, :3] = Rotation.from_rotvec(vectors).as_matrix()
    return found


def placed(tilting, errors, tilt, turn):
    """Return the matrices (..., 4, 4) of the table at angles (...) in degrees."""
    pair = f"{tilting}Y"
    d = [errors.get(f"d{axis}{pair}", 0.0) for axis in "xyz"]
    al, be, ga = (errors.get(f"{name}{pair}", 0.0) for name in ("al", "be", "ga"))
    if tilting == "A":
        beside = shifted((0.0, errors.get("dyCA", 0.0), 0.0))
        second = about("y", errors.get("beCA", 0.0))
    else:
        beside = shifted((errors.get("dxCB", 0.0), 0.0, 0.0))
        second = about("x", errors.get("alCB", 0.0))
    stood = shifted(PA + d) @ about("z", ga) @ about("y", be) @ about("x", al)
    tilted = about("x" if tilting == "A" else "y", -np.radians(tilt))
    return stood @ tilted @ shifted(PC - PA) @ beside @ second @ about("z", -np.radians(turn))


def carried(tilting, errors, point, tilt, turn):
    """Return where a point (3,) of the table, as it stands at zero, is at angles in degrees."""
    there = placed(tilting, errors, tilt, turn) @ np.linalg.inv(placed(tilting, errors, 0.0, 0.0))
    return (there @ np.array([*point, 1.0]))[..., :3]


def reading(setup, degrees, errors, tilting="A", spindle=SPINDLE):
    """Return what the bar reads at angles (...), mm."""
    still = np.zeros_like(degrees)
    tilt, turn = (still, degrees) if setup.letter == "C" else (degrees, still)
    held = np.add(setup.ball, LENGTH * np.array(setup.bar))
    ball = carried(tilting, errors, setup.ball, tilt, turn)
    apart = carried(tilting, {}, held, tilt, turn) + np.array([*spindle, 0.0]) - ball
    return np.linalg.norm(apart, axis=-1) - LENGTH


def trace(setup, degrees, errors=None, tilting="A", noise=0.0, rng=None, spindle=SPINDLE):
    """Return the exact trace of a test, with noise if asked for."""
    errors = ERRORS[tilting] if errors is None else errors
    values = reading(setup, np.asarray(degrees, float), errors, tilting, spindle)
    if noise:
        values = values + noise * rng.standard_normal(len(values))
    return Trace(setup, np.asarray(degrees, float), values)


def setups(tilting="A", lever=0.0):
    """Return the four tests: the axis square and along, C square and along.

    Levers of the reference: xe 150, ye 0, ze 80, ze' 120, xeA 60, and y' as given.
    """
    along, aside = (X, Y) if tilting == "A" else (Y, X)
    square = PA + 60.0 * along + 120.0 * Z
    beside = PA + 120.0 * Z + lever * aside
    return [
        SetUp(tilting, tuple(Z), tuple(square.tolist())),
        SetUp(tilting, tuple(along), tuple(beside.tolist())),
        SetUp("C", tuple(X), tuple((PC + 150.0 * X + 80.0 * Z).tolist())),
        SetUp("C", tuple(Z), tuple((PC + 150.0 * X + 80.0 * Z).tolist())),
    ]


def identified(traces, noise=0.001, tilting="A", spindle=SPINDLE):
    """Return what the estimator makes of traces."""
    tests = [eccentricity(one, noise) for one in traces]
    return identify(nominal(tilting), tests, spindle, noise)


def measured(arc=180.0, samples=181, tilting="A", lever=0.0, middle=0.0, **given):
    """Return the four traces, the tilting axis over an arc about its middle and C all around."""
    tilts = middle + np.linspace(-arc / 2.0, arc / 2.0, samples)
    turns = np.linspace(0.0, 360.0, samples)
    return [
        trace(setup, turns if setup.letter == "C" else tilts, tilting=tilting, **given)
        for setup in setups(tilting, lever)
    ]
