"""`volumetric min-length`: no shorter piece is cut, and the tolerance holds, or it is refused.

Where the machine goes is said by the scalar interpolation of `test_volumetric`.
"""

from __future__ import annotations

import itertools
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from test_rigid import rigid
from test_rigid_pass import PROGRAM, pipeline
from test_volumetric import MODEL, exact, moves_of, residual
from test_volumetric import pipeline as chain_of

import gcxform as gx

HERE = f"volumetric model={MODEL} part-origin=0,0,0"
# Starts and ends just beside nodes (48 in X, 30 in Y, 45 in Z): greedy cuts leave crumbs there.
LINES = b"""\
G54 G90
G01 F3000
X0. Y0. Z0.
X47. Y31. Z44.
X240.5 Y200. Z270.4
X470. Y1. Z3.
X3. Y320. Z449.
X240.2 Y321.
X1.
M30
"""
TOLERANCES = (0.0003, 0.0006, 0.001, 0.002, 0.004)
LEAST = (5.0, 20.0, 50.0, 100.0)


def lengths(program: bytes, commands: list) -> list[float]:
    """Return the lengths of the pieces of lines that were cut."""
    lines = [line for line, _ in commands]
    pairs = itertools.pairwise(commands)
    return [math.dist(a, b) for (_, a), (line, b) in pairs if lines.count(line) > 1]


def says(error: gx.InputError, tolerance: float, least: float) -> bool:
    """Return whether an error names the move, the tolerance, what it needs and what is allowed."""
    (found,) = error.diagnostics
    needed = float(re.search(r"a piece of ([0-9.]+) mm", found.message)[1])
    assert needed < least
    assert f"within {tolerance * 1000:g} um" in found.message
    assert f"min-length, which is {least:g} mm" in found.message
    return found.code == "GX315" and found.where.line in range(4, 10)


def test_lines_are_long_and_right_or_refused() -> None:
    seen = {"refused": 0, "other": 0, "same": 0}
    for tolerance, least in itertools.product(TOLERANCES, LEAST):
        options = f" tolerance={tolerance}mm"
        free = exact(chain_of(HERE + options), LINES)
        chain = chain_of(f"{HERE}{options} min-length={least}mm")
        try:
            commands = exact(chain, LINES)
        except gx.InputError as error:
            seen["refused"] += says(error, tolerance, least)
            continue
        assert min(lengths(LINES, commands), default=least) >= least - 0.1
        assert residual(LINES, commands) <= tolerance
        assert len(commands) >= len(free)
        seen["same" if commands == free else "other"] += 1
    assert min(seen.values()) > 0, seen
    assert sum(seen.values()) == len(TOLERANCES) * len(LEAST)


def test_without_tolerance_the_promise_is_what_is_kept() -> None:
    """Exact lines would need crumbs; within the promise of 1 um they do not."""
    chain = chain_of(f"{HERE} min-length=20mm")
    commands = exact(chain, LINES)
    assert min(lengths(LINES, exact(chain_of(HERE), LINES))) < 5
    assert min(lengths(LINES, commands)) >= 19.9
    assert residual(LINES, commands) <= 1e-3 == chain.path_passes[0].promise


@pytest.mark.parametrize("inverse", ["", "inverse = true\n"])
def test_arcs_and_curved_models(tmp_path: Path, inverse: str) -> None:
    """The run proves itself; here only the lengths are looked at, and that some are refused."""
    model = rigid(1, size=0.02, angle=60e-6)
    refused = written = 0
    for tolerance, least in itertools.product((0.0005, 0.002, 0.008), (2.0, 10.0, 40.0, 100.0)):
        options = f"{inverse}tolerance = {tolerance}\nmin-length = {least}"
        chain = pipeline(tmp_path, model, options)
        try:
            result = chain.run(PROGRAM)
        except gx.InputError as error:
            (found,) = error.diagnostics
            shortest = float(re.search(r"a piece of ([0-9.]+) mm", found.message)[1])
            refused += found.code == "GX315" and shortest < least
            continue
        written += 1
        path = gx.read(result.text, "linuxcnc").path
        owner = np.array([result.source_map[line] for line in path.source])
        for row in np.flatnonzero(np.bincount(owner)[owner] > 1):
            way = np.linalg.norm((path.end - path.start)[row, :3])
            if path.kind[row] > gx.Kind.LINE:
                radius = np.linalg.norm((path.start[row, :3] - path.centre[row])[:2])
                way = radius * path.sweep[row]
            assert way >= least - 0.1
    assert refused
    assert written
    assert refused + written == 12


def test_an_arc_is_divided_otherwise_before_it_is_refused(tmp_path: Path) -> None:
    """Pieces as long as they can be leave a short one; equal ones, and more of them, do not."""
    model = rigid(2, size=0.02, angle=60e-6)
    program = b"G21 G17 G90 G94 G54\nT1 M6\nG43 H1\nG0 X0 Y0 Z0\nF500\nG2 X0 Y0 I60\nM2\n"
    free = pipeline(tmp_path, model, "tolerance = 0.002").run(program)
    shortest = min(arcs(free))
    assert len(arcs(free)) > 3
    assert max(arcs(free)) > 1.1 * shortest
    chain = pipeline(tmp_path, model, f"tolerance = 0.002\nmin-length = {1.05 * shortest}")
    equal = arcs(chain.run(program))
    assert np.ptp(equal) < 0.1
    assert min(equal) > 1.04 * shortest
    chain = pipeline(tmp_path, model, f"tolerance = 0.002\nmin-length = {4 * shortest}")
    with pytest.raises(gx.InputError) as caught:
        chain.run(program)
    assert caught.value.diagnostics[0].where.line == 6


def arcs(result: gx.Result) -> list[float]:
    """Return the lengths of the arcs in what was written, about a circle of 60 mm."""
    path = gx.read(result.text, "linuxcnc").path
    return (60.0 * path.sweep[path.kind > gx.Kind.LINE]).tolist()


def test_short_moves_stay_as_they_are() -> None:
    assert len(moves_of(LINES)) == 7
    program = LINES.replace(b"X47. Y31. Z44.", b"X0.5\nX1.\nX47. Y31. Z44.")
    chains = (chain_of(f"{HERE} tolerance=0.01mm{least}") for least in ("", " min-length=5mm"))
    plain, least = (replace(chain, stamp=False).run(program).text for chain in chains)
    assert plain == least
