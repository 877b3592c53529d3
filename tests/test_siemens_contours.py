"""Corners and tangents of a SINUMERIK against the geometry of their manual, in complex numbers.

RND, CHR, CHF: Fundamentals 11/2006 p. 194; CT: NC programming 12/2019 p. 201. The reader here looks
at one word at a time and shares nothing with that of the dialect.
"""

from __future__ import annotations

import cmath
import math
import random
import re

import pytest
from gcxform_plugins.passes.absolute import Absolute
from seeds_kit import some

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
PLANES = {"G17": "XYIJ", "G18": "ZXKI", "G19": "YZJK"}
NEAR = 8e-4  # mm: what three decimals leave of a place
ROUND = 5e-3


def drawn(seed):
    """Return lines of a contour, and its elements: target, word of the corner, whether by CT."""
    r = random.Random(seed)
    plane = r.choice([*PLANES])
    a, b = PLANES[plane][:2]
    lines, elements, at = [f"G710 {plane} G90 G94 G54", "G0 X0 Y0 Z0", "F100"], [], 0j
    for k in range(r.randint(3, 6)):
        to = at + complex(r.randint(4, 20) * r.choice([-1, 1]), r.randint(-20, 20))
        tangent = k > 0 and r.random() < 0.2 and not elements[-1][1]
        corner = r.choice(["RND=2", "CHR=1", "CHF=3", ""]) if not tangent else ""
        by = to - at
        steps = f"{a}=IC({by.real:g}) {b}=IC({by.imag:g})"
        words = steps if r.random() < 0.3 else f"{a}{to.real:g} {b}{to.imag:g}"
        elements.append((to, corner, tangent))
        lines.append(" ".join(filter(None, ["CT" if tangent else "G1", words, corner])))
        at = to
    return [*lines, "M30"], elements


def path(elements):
    """Return the moves of a contour: kind, end, centre; None where the manual leaves one open."""
    found, start, along = [], 0j, None
    ends = [to for to, _, _ in elements]
    for k, (to, corner, tangent) in enumerate(elements):
        if tangent:
            side = ((to - start) * along.conjugate()).imag
            if abs(side) < 1e-6:
                return None
            centre = start + along * 1j * abs(to - start) ** 2 / (2 * side)
            found.append(("ccw" if side > 0 else "cw", to, centre))
            along = (to - centre) * (1j if side > 0 else -1j)
            start, along = to, along / abs(along)
            continue
        along = (to - start) / abs(to - start)
        if not corner:
            found.append(("line", to, None))
            start = to
            continue
        if k + 1 == len(elements) or elements[k + 1][2]:
            return None
        name, size = corner.split("=")
        u, v = -along, (ends[k + 1] - to) / abs(ends[k + 1] - to)
        angle, size = abs(cmath.phase(v / u)), float(size)
        if min(angle, math.pi - angle) < 1e-5:
            return None
        half = angle / 2
        back = {"CHR": size, "CHF": size / 2 / math.sin(half), "RND": size / math.tan(half)}[name]
        if back > min(abs(to - start), abs(ends[k + 1] - to)):
            return None
        middle = (u + v) / abs(u + v)
        found.append(("line", to + back * u, None))
        turn = "ccw" if (v * along.conjugate()).imag > 0 else "cw"
        centre = to + middle * size / math.sin(half)
        round_ = name == "RND"
        found.append((turn if round_ else "line", to + back * v, centre if round_ else None))
        start = to + back * v
    return found


def moves(text, plane):
    """Return the cuts of a program of words: kind, end, centre."""
    a, b, i, j = PLANES[plane]
    at, kind, found = dict.fromkeys("XYZ", 0.0), "", []
    kinds = {"G0": "rapid", "G1": "line", "G2": "cw", "G3": "ccw"}
    for line in text.splitlines():
        words = re.findall(r"([A-Z])(-?[\d.]+)", line)
        kind = next((kinds[x + y] for x, y in words if x + y in kinds), kind)
        values = {x: float(y) for x, y in words if x in "XYZIJK"}
        start = complex(at[a], at[b])
        at |= {x: y for x, y in values.items() if x in at}
        if values and kind != "rapid":
            arc = kind != "line"
            centre = start + complex(values.get(i, 0), values.get(j, 0)) if arc else None
            found.append((kind, complex(at[a], at[b]), centre))
    return found


def run(lines):
    """Return what a contour becomes in words."""
    made = Pipeline(DIALECTS["siemens"], DIALECTS["linuxcnc"], (Absolute(),), Reading())
    return made.run("\n".join([*lines, ""]).encode()).text.decode()


DRAWN = {seed: path(drawn(seed)[1]) for seed in range(600)}
OPEN = [seed for seed, wanted in DRAWN.items() if wanted is None]
SAID = [seed for seed, wanted in DRAWN.items() if wanted is not None]


@pytest.mark.parametrize("k", some(40))
def test_contours_are_those_of_the_manual(k):
    lines, _ = drawn(SAID[k])
    wanted, found = DRAWN[SAID[k]], moves(run(lines), lines[0].split()[1])
    assert [kind for kind, _, _ in found] == [kind for kind, _, _ in wanted]
    for (_, end, centre), (_, to, about) in zip(found, wanted, strict=True):
        assert abs(end - to) < NEAR
        assert about is None or abs(centre - about) < ROUND * max(1, abs(about - to))


@pytest.mark.parametrize("k", some(10))
def test_what_the_manual_leaves_open_is_refused(k):
    with pytest.raises(gx.InputError, match="GX210"):
        run(drawn(OPEN[k])[0])
