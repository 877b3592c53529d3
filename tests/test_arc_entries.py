"""An arc that begins compensation: the path is LinuxCNC's, and the proof sees any other."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import numpy as np
import pytest
import seeds_kit
from oracles import rs274
from test_cutter_comp import path_of, pipeline, proving

import gcxform as gx
from gcxform.toolpath.path import Toolpath

CLOSE = 3e-4  # mm: what five decimals and the print leave
HEAD = "G21 G90 G17 G94 G40 F100\nM3 S100\n"


def entry(seed: int) -> str:
    """Return a program whose compensation begins with an arc, and a tangent or a corner behind."""
    draw = random.Random(seed)
    code, side = draw.choice("23"), draw.choice((1, -1))
    sense, radius = (-1 if code == "2" else 1), draw.uniform(1.3, 12)
    begins, sweep = draw.uniform(0, math.tau), draw.uniform(0.3, 5.5)
    ends = begins + sense * sweep
    start = complex(draw.uniform(-9, 9), draw.uniform(-9, 9))
    way = -radius * complex(math.cos(begins), math.sin(begins))
    end = start + way + radius * complex(math.cos(ends), math.sin(ends))
    turn = draw.choice([0, 0, -side * draw.uniform(0.1, 2.5), side * draw.uniform(0.1, 1)])
    ahead = ends + sense * math.pi / 2 + turn
    along = complex(math.cos(ahead), math.sin(ahead))
    at = [f"X{p.real:.5f} Y{p.imag:.5f}" for p in (start, end, end + 7 * along, end + 12 * along)]
    rise = f" Z{draw.uniform(-3, 3):.3f}" if draw.random() < 0.3 else ""
    begin = f"G{'41' if side > 0 else '42'}.1 D2.54 G{code} {at[1]}{rise}"
    arc = f"{begin} I{way.real:.5f} J{way.imag:.5f}"
    return f"{HEAD}G0 {at[0]} Z0\n{arc}\nG1 {at[2]}\nG40 {at[3]} Z9\nM2\n"


def resolved(text: str) -> bytes | None:
    """Return the path of the centre, None where it is refused."""
    made = replace(pipeline(), numbers=gx.NumberFormat(mm=5, inch=6))
    try:
        return made.run(text.encode(), "full").text
    except gx.InputError:
        return None


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_it_is_that_of_linuxcnc() -> None:
    texts = [entry(seed) for seed in seeds_kit.some(40)]
    made = [(text, found) for text in texts if (found := resolved(text)) is not None]
    assert len(made) > len(texts) / 2
    wanted = rs274.run_many(text.encode() for text, _ in made)
    found = rs274.run_many(text for _, text in made)
    for (text, _), one, other in zip(made, wanted, found, strict=True):
        assert not isinstance(one, rs274.Rejected), text
        assert not isinstance(other, rs274.Rejected), text
        assert [move.kind for move in one.moves] == [move.kind for move in other.moves], text
        for a, b in zip(one.moves, other.moves, strict=True):
            for p, q in zip(a.machine[1:], b.machine[1:], strict=True):
                apart = max(abs(p[axis] - q[axis]) for axis in "XY")
                assert apart < CLOSE * 10, text  # a centre is as far off as its arc is flat


def about(path: Toolpath, x: float, y: float) -> Toolpath:
    """Return a path whose arc, in row 1, is about another centre, with the sweep of that."""
    centre, sweep = np.array(path.centre), np.array(path.sweep)
    centre[1, :2] = x, y
    a, b = path.start[1, :2] - centre[1, :2], path.end[1, :2] - centre[1, :2]
    angle = math.atan2(a[0] * b[1] - a[1] * b[0], a @ b)
    sweep[1] = -angle % math.tau
    return path.replace(centre=centre, sweep=sweep)


TAMPERED = {
    "from elsewhere": lambda path: about(path, *path.centre[1, :2] + [0.01, 0.0]),
    "in another direction": lambda path: about(
        path,
        *path.centre[1, :2] + [0.012, -0.01],  # on the line of points as far from both ends
    ),
    "a turn more": lambda path: path.replace(sweep=path.sweep + math.tau * path.is_arc),
    "the programmed centre": lambda path: about(path, 20.0, 0.0),
}


@pytest.mark.parametrize("name", TAMPERED)
def test_the_proof_sees(name: str) -> None:
    step, context = proving()
    text = f"{HEAD}G0 X10 Y0 Z0\nG41 D1 G2 X20 Y10 I10\nG1 X30\nG40 X40\nM2\n"
    before = path_of(text)
    after = step.apply(before, context)
    step.prove(before, after, context)
    with pytest.raises(gx.VerificationError) as error:
        step.prove(before, TAMPERED[name](after), context)
    assert error.value.diagnostics[0].code == "GX604"
