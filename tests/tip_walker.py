"""Where the tip goes with a written program, walked finely: plain numpy, from the equations.

The control follows the tip: between two blocks X, Y, Z and the angles change in proportion. At each
step it brings its axes to j = M_T P - M_H t0 (`gcxform/machine/chain.py` states it), they stand at
j + E(j), and the tip is at M_T^-1 (j + E + M_H t0). Of the package only the error of a model is
asked. Programs are read by their words: SINUMERIK, Klartext and Fanuc, absolute, one move a line.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import gcxform as gx

ROUNDED = 5.1e-4  # degrees; so far the angle of a piece may be from where it would be in proportion
WORD = re.compile(r"(?<![A-Z])([XYZABC])\s*([-+]?[0-9]*\.?[0-9]+)")
ON = re.compile(r"TRAORI|M128|FUNCTION TCPM|G43\.4|#RTCP ON|M428")
OFF = re.compile(r"TRAFOOF|M129|RESET TCPM|G49|#RTCP OFF|M429")


@dataclass(frozen=True)
class Turn:
    """A rotary axis: the line it turns about, and with which sign."""

    letter: str
    direction: np.ndarray
    point: np.ndarray
    sign: int

    def matrix(self, degrees):
        """Return (4, 4): x -> point + R (x - point)."""
        angle = np.radians(self.sign * degrees)
        a, b, c = self.direction
        cross = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0.0]])
        turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        found = np.eye(4)
        found[:3, :3], found[:3, 3] = turn, self.point - turn @ self.point
        return found


@dataclass(frozen=True)
class Walked:
    """A machine: rotary axes from the base outwards, its gauge point, tool, and work offset, mm."""

    table: list
    head: list
    gauge: np.ndarray
    length: float
    zero: np.ndarray
    model: object
    origin: np.ndarray

    @classmethod
    def of(cls, chain, gauge, length, zero, model, origin=(0.0, 0.0, 0.0)):
        """Return the machine of the numbers of a chain."""
        table, head = (
            [Turn(a.letter, np.array(a.direction), np.array(a.point), a.sign) for a in side]
            for side in (chain.table, chain.head)
        )
        given = (np.array(each, float) for each in (gauge, zero, origin))
        gauge, zero, origin = given
        return cls(table, head, gauge, length, zero, model, origin)

    def _sides(self, angles):
        found = []
        for side in (self.table, self.head):
            matrix = np.eye(4)
            for axis in side:
                matrix = matrix @ axis.matrix(angles[axis.letter])
            found.append(matrix)
        return found

    def actual(self, words, angles):
        """Return the words (3,) at which the tip is that is commanded to words (3,)."""
        table, head = self._sides(angles)
        tip = np.append(self.gauge - [0.0, 0.0, self.length], 1.0)
        arm = (head @ tip)[:3]
        axes = (table @ np.append(words + self.zero + self.gauge, 1.0))[:3] - arm
        place, lever = axes - self.origin, arm - self.gauge
        error = self.model.error(place[None], gx.Outside.EXTRAPOLATE, lever[None])[0]
        found = np.linalg.solve(table, np.append(axes + error + arm, 1.0))[:3]
        return found - self.zero - self.gauge


def moves(text, letters):
    """Return the ends (n, 3 + m) of the moves while the tip is followed, the first where it is."""
    at = dict.fromkeys("XYZ" + letters, 0.0)
    found, follows = [], False
    for line in text.splitlines():
        line = line.partition(";")[0].upper()
        if OFF.search(line):
            follows = False
        words = {a: float(v) for a, v in WORD.findall(line)}
        at |= {a: v for a, v in words.items() if a in at}
        if words and follows and "FMAX" not in line and "G0 " not in line + " ":
            found.append([at[a] for a in "XYZ" + letters])
        elif words:
            found.append(None)
            found.append([at[a] for a in "XYZ" + letters])
        if ON.search(line) and not OFF.search(line):
            follows = True
    return found


def farthest(source, written, letters, walked, steps=25):
    """Return how far (mm) the tip is off the lines of a source with a written program, at most."""
    lines, pieces = moves(source, letters), moves(written, letters)
    k, worst, compared = 0, 0.0, 0
    for one, other in pairwise(lines):
        if one is None or other is None:
            assert pieces[k] is None or pieces[k + 1] is None, (k, other)
            k += 1
            continue
        first, last = np.array(one), np.array(other)
        begin, done = k, False
        while not done:
            k += 1
            here = np.array(pieces[k])
            done = np.allclose(here[3:], last[3:], atol=6e-4) and (
                np.linalg.norm(here[:3] - last[:3]) < 0.2
            )
        for piece in range(begin, k):
            worst = max(worst, _off(first, last, pieces[piece : piece + 2], letters, walked, steps))
        compared += 1
    assert compared
    assert k == len(pieces) - 1
    return worst


def _off(first, last, ends, letters, walked, steps):
    """Return how far (mm) a walked piece is off the line between two ends, by its angles."""
    a, b = (np.array(each) for each in ends)
    turned = np.abs(last - first)[3:]
    axis = 3 + int(np.argmax(turned))
    worst = 0.0
    for s in np.linspace(0.0, 1.0, steps):
        here = a + s * (b - a)
        tip = walked.actual(here[:3], dict(zip(letters, here[3:], strict=True)))
        way = last[:3] - first[:3]
        along = np.clip((tip - first[:3]) @ way / max(way @ way, 1e-12), 0.0, 1.0)
        if turned.max() > 0.0:
            told = (here[axis] - first[axis]) / (last[axis] - first[axis])
            along = np.clip(along, told - ROUNDED / turned.max(), told + ROUNDED / turned.max())
        worst = max(worst, float(np.linalg.norm(tip - first[:3] - along * way)))
    return worst
