"""`volumetric inverse=true`: from commands to where the machine goes, and the way back.

The oracles are a scalar interpolation of the published tables, a machine of exact matrices, and
commands found point by point.
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.passes.volumetric.forward.window import Window
from htm import actual
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from test_rigid import lattice, rigid, scalar
from test_rigid_pass import LENGTH, OFFSET, PROGRAM, SECOND_ORDER, pipeline, point
from test_volumetric import MODEL, distance_to_line, machine_at, moves_of

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import Outside
from gcxform.errormodel.model_text import to_toml
from gcxform.errormodel.rigid import RigidBody
from gcxform.plugin.registry import default_registry

INVERSE = f"volumetric model={MODEL} part-origin=0,0,0 inverse=true"
LINES = b"G1 X0 Y0 Z0 F500\nX480 Y330 Z450\nX120 Y48 Z60\nY330\nX0\nX47.99 Z450\nX48.01 Z0\nM2\n"
STEPS = 60


def step(model: object, folder: Path, **options: object) -> gx.Pass:
    (folder / "model.toml").write_text(to_toml(model))
    file = ModelFile.load(folder / "model.toml")
    made = default_registry().pass_("volumetric")
    return made(model=file, part_origin=(0.0, 0.0, 0.0), inverse=True, **options)


# --- where the machine goes ---


@pytest.mark.parametrize("tolerance", ["", " tolerance=0.5um", " tolerance=2um", " tolerance=8um"])
def test_what_is_written_is_where_the_machine_goes(tolerance: str) -> None:
    result = gx.Pipeline.parse(INVERSE + tolerance, "linuxcnc").run(LINES, verify="full")
    allowed = {"": 0.0, " tolerance=0.5um": 5e-4, " tolerance=2um": 2e-3}.get(tolerance, 8e-3)
    told, wanted = moves_of(LINES), moves_of(result.text)
    off = 0.0
    for (_, a), (line, b) in itertools.pairwise(told):
        pieces = itertools.pairwise(wanted)
        ways = [(p, q) for (_, p), (row, q) in pieces if result.source_map[row] == line]
        for part in np.linspace(0, 1, STEPS):
            command = tuple(p + part * (q - p) for p, q in zip(a, b, strict=True))
            off = max(off, min(distance_to_line(machine_at(command), *way) for way in ways))
    assert off <= allowed * 1.001 + 0.9e-4  # rounding to four decimals
    assert max(math.dist(machine_at(end), end) for _, end in told) > 0.02


@pytest.mark.parametrize("tolerance", [0.0005, 0.01])
def test_the_tip_of_the_exact_machine_is_on_what_is_written(tmp_path, tolerance) -> None:
    model = rigid(1, size=0.004, angle=60e-6, tool=(0.0, 0.0, 0.0))
    chain = pipeline(tmp_path, model, f"inverse = true\ntolerance = {tolerance}")
    result = chain.run(PROGRAM)
    told, written = (gx.read(text, "linuxcnc").path for text in (PROGRAM, result.text))
    owner = np.array([result.source_map[line] for line in written.source])
    functions = {a: scalar(f) for a, f in zip("XYZ", model.axes, strict=True)}
    tool, pivots = np.array([0.0, 0.0, -LENGTH]), {a: np.zeros(3) for a in "XYZ"}
    worst = 0.0
    for row in range(2, len(told)):
        pieces = np.flatnonzero(owner == told.source[row])
        for part in np.linspace(0, 1, STEPS):
            gauge = point(told, row, part) + OFFSET - tool
            tip = actual("XYFZ", gauge, functions, pivots, tool) - OFFSET
            worst = max(worst, nearest(written, pieces, tip))
    assert worst <= tolerance + 0.5e-5 * math.sqrt(3) + SECOND_ORDER


# --- there and back ---


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("tolerance", ["", "tolerance = 0.002"])
def test_compensated_and_inverted_gives_the_program_back(tmp_path, seed, tolerance) -> None:
    model = rigid(seed, size=0.01, angle=60e-6) if seed % 2 else lattice(seed, (5, 4, 6))
    more = f'{tolerance}\noutside = "extrapolate"\n'
    second = f'[[pass]]\nuse = "volumetric"\nmodel = "model.toml"\ninverse = true\n{more}'
    chain = pipeline(tmp_path, model, more + second)
    result = chain.run(PROGRAM)
    promised = 2 * (0.002 if tolerance else 0.001)
    assert result.certificate.budget["steps"] == pytest.approx(promised)
    before, after = (gx.read(text, "linuxcnc") for text in (PROGRAM, result.text))
    found = gx.compare(before, after, promised + 2e-5)
    assert found.parted is None
    assert found.deviation <= promised + 2e-5


def test_facts_turn_round() -> None:
    """What a program holds, its user says by the pass that takes it for that."""
    forward = f"volumetric model={MODEL} part-origin=0,0,0"
    for chain in (INVERSE, f"{forward} | {INVERSE}", f"{INVERSE} | {forward}"):
        gx.Pipeline.parse(chain, "linuxcnc")
    for chain in (f"{INVERSE} | {INVERSE}", f"{forward} | {forward}"):
        with pytest.raises(gx.UsageError) as caught:
            gx.Pipeline.parse(chain, "linuxcnc")
        assert caught.value.diagnostics[0].code == "GX725"


# --- the undo ---


def steep(seed: int, kind: str) -> object:
    """Return a model hundred times as bad as a machine: what is missed is seen."""
    rng = np.random.default_rng(seed)
    nodes = np.linspace(-100, 100, 9) + rng.uniform(-8, 8, 9)
    shifts = rng.uniform(-0.15, 0.15, (3, 9, 3))
    if kind == "straight":
        return AxisFunctions(tuple(AxisFunction(nodes, shift) for shift in shifts))
    turns = rng.uniform(-5e-4, 5e-4, (3, 9, 3))
    both = np.concatenate([shifts / 5, turns], axis=2)
    return RigidBody(tuple(AxisFunction(nodes, values) for values in both))


near = st.integers(-80, 80).map(float) | st.floats(-80, 80)
places = st.tuples(near, near, near)


def commands(model, places: np.ndarray, outside: Outside) -> np.ndarray:
    """Return c with c + E(c) = place, by Newton's way with slopes taken from differences."""
    found = places.copy()
    for _ in range(60):
        found = found + 0.8 * (places - found - model.error(found, outside))
    assert np.abs(found + model.error(found, outside) - places).max() < 1e-9
    return found


@settings(max_examples=12, deadline=None, phases=[Phase.explicit, Phase.generate])
@given(st.integers(0, 5), st.sampled_from(["straight", "curved"]), st.lists(places, max_size=3))
def test_the_undo_is_the_command_everywhere(tmp_path_factory, seed, kind, corners) -> None:
    """Lines along nodes, across corners of cells, hardly beyond a node: all are followed."""
    model = steep(seed, kind)
    made = step(model, tmp_path_factory.mktemp("m"), outside=Outside.CLAMP)
    along = float(model.nodes[0][2]) + 0.01
    corners = [*corners, (along, -70.0, -50.0), (along, 70.0, 60.0)]
    text = "".join(f"G1 F100 X{x:.6f} Y{y:.6f} Z{z:.6f}\n" for x, y, z in corners)
    text += "G2 X0 Y0 Z0 R90\nG17 G2 X40 Y10 I20 J5\nG18 G3 X0 Z20 Y30 I-20 K10\n"
    path = gx.read(f"G21 G90 G94\n{text}M2\n".encode(), "linuxcnc").path
    undone = made.undo(path, gx.Pipeline.parse("absolute", "linuxcnc").context)
    owner = np.searchsorted(path.source, undone.source)
    for row in range(1, len(path)):
        pieces = np.flatnonzero(owner == row)
        places = np.array([point(path, row, part) for part in np.linspace(0, 1, 25)])
        for place in commands(model, places, Outside.CLAMP):
            off = nearest(undone, pieces, place)
            assert off <= undone.slack + 1e-8, (row, off, undone.slack)


def nearest(path, pieces: np.ndarray, place: np.ndarray) -> float:
    """Return the distance of a place from the nearest pieces."""
    ends = np.vstack([path.start[pieces, :3], path.end[pieces, :3]])
    order = np.argsort(((ends - place) ** 2).sum(axis=1))[:6]
    return min(beside(path, piece, place) for piece in set(pieces[order % len(pieces)].tolist()))


def beside(path, row: int, place: np.ndarray) -> float:
    """Return the distance of a place from a row: sampled where it is an arc."""
    if path.kind[row] <= gx.Kind.LINE:
        a, b = path.start[row, :3], path.end[row, :3]
        way = b - a
        length = float(way @ way)
        part = np.clip((place - a) @ way / length, 0, 1) if length else 0.0
        return float(np.linalg.norm(place - a - part * way))
    parts = np.linspace(0, 1, 200)
    points = gx.points_on_arcs(path, np.full(len(parts), row), parts)
    nearest = int(np.argmin(((points - place) ** 2).sum(axis=1)))
    a, b = points[max(nearest - 1, 0)], points[min(nearest + 1, len(points) - 1)]
    way = b - a
    part = np.clip((place - a) @ way / float(way @ way), 0, 1)
    return float(np.linalg.norm(place - a - part * way)) - float(way @ way) / 8 / 4


def test_a_wrong_path_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the program says already, or the error subtracted, is no place of the machine."""
    chain = gx.Pipeline.parse(INVERSE, "linuxcnc")
    chain.run(LINES)
    for sign in (0.0, -1.0):
        monkeypatch.setattr(Window, "commanded", lambda s, p, t, k=sign: p + k * s.step.error(p, t))
        with pytest.raises(gx.VerificationError):
            chain.run(LINES)


def test_what_does_not_go_with_the_inverse() -> None:
    for more in ("outside=zero", "iterations=2"):
        with pytest.raises(gx.UsageError) as caught:
            gx.Pipeline.parse(f"{INVERSE} {more}", "linuxcnc")
        assert caught.value.diagnostics[0].code == "GX713"
