"""Splines that `segment` has cut and `arcs` has joined: arcs beside splines, in the proof."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

import gcxform as gx
from gcxform.diagnostics import VerificationError
from gcxform.emit.emitter import Emitter

CHAIN = "segment chord-error=1um | arcs tolerance=4um"
HEAD = "G21 G90 G17 G94\nG0 X0 Y0 Z0\nG1 F100\n"
CURVES = {
    "cubic": ("G5 I0 J3 P0 Q-3 X10 Y10", [[0, 0], [0, 3], [10, 7], [10, 10]]),
    "loop": ("G5 I20 J10 P-20 Q10 X10 Y0", [[0, 0], [20, 10], [-10, 10], [10, 0]]),
    "cusp": ("G5 I10 J10 P-10 Q10 X10 Y0", [[0, 0], [10, 10], [0, 10], [10, 0]]),
}
QUADRATIC = HEAD + "G5.1 I5 J8 X10 Y4\nG5 I1 J-2 P0 Q3 X20 Y9\nG1 X30\nM2\n"


def run(program: str) -> gx.Result:
    return gx.Pipeline.parse(CHAIN, "linuxcnc").run(program.encode())


def points(text: bytes) -> np.ndarray:
    """Return points along the arcs and lines of a program in the plane, by their words alone."""
    at, found = np.zeros(2), []
    for line in text.decode().splitlines()[3:]:
        words = dict(re.findall(r"([A-Z])(-?[0-9.]+)", line))
        end = np.array([float(words.get(a, v)) for a, v in zip("XY", at, strict=True)])
        t = np.linspace(0.0, 1.0, 41)[:, None]
        if "I" in words or "J" in words:
            arm = np.array([float(words.get(a, 0.0)) for a in "IJ"])
            u, v = -arm, end - at - arm
            sense = 1.0 if words["G"] == "3" else -1.0
            turn = sense * (
                (sense * (np.arctan2(v[1], v[0]) - np.arctan2(u[1], u[0]))) % (2 * np.pi)
            )
            angle = np.arctan2(u[1], u[0]) + t[:, 0] * turn
            there = at + arm + np.hypot(*u) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        else:
            there = at + t * (end - at)
        found.append(there)
        at = end
    return np.concatenate(found)


@pytest.mark.parametrize("name", CURVES)
def test_arcs_are_as_near_to_the_spline_as_the_proof_says(name):
    block, control = CURVES[name]
    result = run(f"{HEAD}{block}\nM2\n")
    assert b"G2" in result.text or b"G3" in result.text
    t = np.linspace(0.0, 1.0, 20001)[:, None]
    p = np.array(control, float)
    curve = (
        (1 - t) ** 3 * p[0] + 3 * (1 - t) ** 2 * t * p[1] + 3 * (1 - t) * t**2 * p[2] + t**3 * p[3]
    )
    off = np.array([np.hypot(*(curve - q).T).min() for q in points(result.text)])
    assert off.max() <= result.certificate.largest["deviation"] + 2e-4 < 0.006


def test_splines_one_after_another():
    assert run(QUADRATIC).certificate.verified


@pytest.mark.parametrize("off", [0.02, -0.02, 0.5])
def test_an_arc_that_leaves_the_spline_is_seen(off, monkeypatch):
    emit = Emitter.emit

    def emitted(*given):
        made = emit(*given)
        arc = re.search(rb"X(\S+) Y(\S+) I(\S+) J(\S+)", made.text)
        assert arc is not None
        x = b"X%.4f" % (float(arc[1]) + off)
        return replace(made, text=made.text.replace(b"X" + arc[1], x, 1))

    monkeypatch.setattr(Emitter, "emit", emitted)
    with pytest.raises(VerificationError):
        run(f"{HEAD}{CURVES['cubic'][0]}\nM2\n")
