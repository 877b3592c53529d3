"""`volumetric` with angular errors under a head that turns: the tip of the exact machine.

The linear axes are the matrices of `htm.py` and the head those of scipy: no code of the package,
and no first order. Both are followed along every block in small steps, and the tip is compared with
where it shall be when the rotary axes stand where they do.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from htm import actual
from hypothesis import given, settings
from hypothesis import strategies as st
from kinematics_kit import matrices
from rtcp_kit import GAUGE, LENGTH, ZERO, chain_of_kind, machine_text, positions, program
from test_rigid import lattice, rigid, scalar

import gcxform as gx
from gcxform.emit.emitter import Emitted
from gcxform.errormodel.functions import AxisFunction
from gcxform.errormodel.model_text import to_toml
from gcxform.errormodel.rigid import RigidBody
from gcxform.errormodel.sum import Sum
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

HEADS = ["cb-fork", "c-table-b-head", "nutating-head"]
HELD = np.array([0.0, 0.0, -LENGTH])
SECOND_ORDER = 3e-5  # mm; what the model of first order leaves of the exact machine
ROUNDED = 2e-6  # mm; six decimals of five axes
STEPS = 41


def levers(chain, angles):
    """Return the ways (n, 3) from the gauge point to the tip."""
    head = np.tile(np.eye(4), (len(angles), 1, 1))
    for k, axis in enumerate(chain.head, len(chain.table)):
        head = head @ matrices(axis, angles[:, k])
    return (head @ np.array([*GAUGE + HELD, 1.0]))[:, :3] - GAUGE


def exact(model, chain, words):
    """Return where the axes stand in effect (n, 3), as words, when they are commanded to words."""
    machine, ways = words[:, :3] - HELD + ZERO, levers(chain, words[:, 3:])
    if isinstance(model, RigidBody):
        functions = {a: scalar(f) for a, f in zip("XYZ", model.axes, strict=True)}
        pivots = {a: np.zeros(3) for a in "XYZ"}
        pairs = zip(machine, ways, strict=True)
        tips = np.array([actual("XYFZ", m, functions, pivots, way) for m, way in pairs])
        return tips - ways + HELD - ZERO
    return words[:, :3] + model.error(machine, gx.Outside.EXTRAPOLATE, ways)


def steps_of(folder: Path, kind, model, options="", decimals=6) -> gx.Pipeline:
    """Return a pipeline of `volumetric` alone."""
    parts = model.models if isinstance(model, Sum) else ()
    for number, part in enumerate(parts):
        (folder / f"{number}.toml").write_text(to_toml(part))
    named = [f"{number}.toml" for number in range(len(parts))]
    added = f'format = 1\nkind = "sum"\nmodels = {named}\n'
    (folder / "model.toml").write_text(added if parts else to_toml(model))
    (folder / "machine.toml").write_text(machine_text(kind, chain_of_kind(kind, 12)))
    (folder / "p.toml").write_text(
        'format = 1\n[input]\ndialect = "fanuc"\n[machine]\nfile = "machine.toml"\n'
        '[[pass]]\nuse = "absolute"\n[[pass]]\nuse = "volumetric"\nmodel = "model.toml"\n'
        f'outside = "extrapolate"\n{options}\n[output]\nstamp = false\ndecimals = {decimals}\n'
    )
    return gx.Pipeline.load(folder / "p.toml")


def walk(seed, count=6, turned=60.0):
    """Return poses (n, 5) of a path that turns the head as it goes."""
    poses = np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 5))
    return (poses * [150.0, 150.0, 150.0, turned, turned]).round(3)


def farthest(model, chain, text, result, letters, inverse=False):
    """Return how far (mm) the exact machine is from the source at the angles where it is."""
    old, new = positions(text, letters), positions(result.text, letters)
    owner = np.array(result.source_map)
    share = np.linspace(0.0, 1.0, STEPS)[:, None]
    worst = 0.0
    for line in range(4, len(old) - 1):
        way = old[line] - old[line - 1]
        for row in np.flatnonzero(owner == line):
            written = new[row - 1] + share * (new[row] - new[row - 1])
            axis = 3 + int(np.argmax(np.abs(way[3:])))
            part = (written[:, axis] - old[line - 1, axis]) / way[axis]
            source = old[line - 1] + part[:, None] * way
            if inverse:
                found = exact(model, chain, source) - written[:, :3]
            else:
                found = exact(model, chain, written) - source[:, :3]
            worst = max(worst, float(np.linalg.norm(found, axis=1).max()))
    return worst


@pytest.mark.parametrize("kind", HEADS)
@pytest.mark.parametrize("tolerance", [None, 0.0005, 0.002, 0.01])
@pytest.mark.parametrize("inverse", [False, True])
def test_the_tip_of_the_exact_machine_under_a_turning_head(tmp_path, kind, tolerance, inverse):
    """The tip is within the tolerance at 41 places of each piece; the proof says so as well."""
    chain = chain_of_kind(kind, 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = rigid(1, size=0.004, angle=60e-6, tool=(1.0, -2.0, -30.0))
    model = RigidBody(model.axes, "XYZ", model.at, (0.0, 0.0, 0.0))
    options = "" if tolerance is None else f"tolerance = {tolerance}\n"
    text = program(walk(4), letters, "F5.")
    steps = steps_of(tmp_path, kind, model, options + "inverse = true" * inverse)
    result = steps.run(text, "full")
    allowed = (tolerance or 0.001) + ROUNDED + SECOND_ORDER
    assert farthest(model, chain, text, result, letters, inverse) <= allowed
    assert lever_matters(model, chain, text, letters) > 0.004
    assert result.certificate.largest["deviation"] <= steps.limit()


def lever_matters(model, chain, text, letters):
    """Return by how much (mm) the errors of the ends of blocks change with their angles."""
    words = positions(text, letters)[4:-1]
    still = words * [1.0, 1.0, 1.0, 0.0, 0.0]
    off = exact(model, chain, words) - exact(model, chain, still)
    return float(np.linalg.norm(off, axis=1).max())


def turned_only(rolls):
    """Return a model with the same turns (rad) everywhere: nothing but a head bends its error."""
    values = np.tile([0.0, 0.0, 0.0, *rolls], (2, 1))
    flat = AxisFunction(np.array([-900.0, 900.0]), np.zeros((2, 6)))
    return RigidBody((AxisFunction(np.array([-900.0, 900.0]), values), flat, flat))


@pytest.mark.parametrize("inverse", [False, True])
def test_where_only_the_head_bends_the_error(tmp_path, inverse):
    """A way of rho r (1 - cos) is cut as often as the tolerance needs, and not at all above it."""
    chain = chain_of_kind("c-table-b-head", 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = turned_only((0.0, 1e-4, 0.0))
    text = program(np.array([[0, 0, 0, 0, -70.0], [40.0, 0, 0, 0, 70.0]]), letters, "F5.")
    ways = levers(chain, np.array([[0.0, -70.0], [0.0, 70.0], [0.0, 0.0]]))
    bulge = 1e-4 * float(np.linalg.norm(ways[2] - ways[:2].mean(axis=0)))
    counts = []
    for tolerance in (bulge / 20, bulge / 5, 1.4 * bulge):
        options = f"tolerance = {tolerance}\n" + "inverse = true" * inverse
        result = steps_of(tmp_path, "c-table-b-head", model, options).run(text, "full")
        found = farthest(model, chain, text, result, letters, inverse)
        assert found <= tolerance + ROUNDED + 1e-6
        counts.append(result.source_map.count(4))
    assert counts[2] == 1
    for tolerance, count in zip((bulge / 20, bulge / 5), counts, strict=False):
        fewest = np.sqrt(bulge / tolerance) / np.sqrt(2.0)  # chords may be off to both sides
        assert fewest <= count <= 3 * fewest


@pytest.mark.parametrize("seed", [87, 162, 206])
def test_turns_alone_share_their_time_by_angles(tmp_path, seed):
    """Where the linear axes are only corrected, what they go says nothing of the time."""
    chain = chain_of_kind("nutating-head", 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = rigid(seed, size=0.004, angle=300e-6)
    options = "tolerance = 0.0003\nmax-correction = 2.0"
    steps = steps_of(tmp_path, "nutating-head", model, options, decimals=4)
    text = program(walk(seed, 4, turned=170.0) * [0, 0, 0, 1, 1], letters, "F5.")
    result = steps.run(text, "full")
    paces = {}
    new = positions(result.text, letters)
    for row, line in enumerate(result.source_map[:-1]):
        if line >= 4:
            feed = float(result.text.decode().splitlines()[row].rsplit("F", 1)[1])
            angle = np.linalg.norm(new[row, 3:] - new[row - 1, 3:])
            paces.setdefault(line, []).append(angle * feed)
    assert len(paces) == 3
    assert all(np.ptp(pace) <= 0.01 * max(pace) for pace in paces.values())
    with pytest.raises(gx.VerificationError, match="faster or slower"):
        with_two_feeds_changed(steps, text)


def with_two_feeds_changed(steps, text):
    """Run a pipeline whose emitter takes half the time of a piece, and gives it to the next."""
    job = Run(steps, Source.of_bytes(text), "full")
    assert job.stages is not None
    emitter = job.stages.emitter
    emit = emitter.emit

    def lying(*task):
        emitted = emit(*task)
        lines = emitted.text.splitlines(keepends=True)
        sources = emitted.source.tolist()
        at = next(k for k, line in enumerate(sources) if line == 4)
        assert sources[at + 1] == 4
        times = [1.0 / float(line.rsplit(b"F", 1)[1]) for line in lines[at : at + 2]]
        for k, time in enumerate((0.5 * times[0], times[1] + 0.5 * times[0])):
            words = lines[at + k].rsplit(b"F", 1)[0]
            lines[at + k] = words + b"F%.4f\n" % (1.0 / time)
        return Emitted(b"".join(lines), emitted.source, np.zeros(len(sources), np.int64))

    emitter.emit = lying
    job.over(Output(lambda text: None, None), lambda _: None, 1 << 19)


@pytest.mark.parametrize("tolerance", [0.001, 0.01])
def test_arcs_under_a_head_that_stands_turned(tmp_path, tolerance):
    """Circles with the head at an angle stay arcs, and the exact tip stays on them."""
    chain = chain_of_kind("cb-fork", 12)
    letters = ("X", "Y", "Z", *chain.letters)
    text = (
        b"G21 G90 G94 G17 G54\nG0 X0. Y0. C0. B0.\nG43 H1 Z0.\nG0 X50. C35. B-40.\n"
        b"G1 Y10. F500.\nG2 X50. Y110. J50.\nG3 X-30. Y30. I-80.\nM30\n"
    )
    model = rigid(3, size=0.004, angle=60e-6)
    result = steps_of(tmp_path, "cb-fork", model, f"tolerance = {tolerance}").run(text, "full")
    source, told = (gx.read(t, "fanuc").path for t in (text, result.text))
    owner = np.array([result.source_map[line] for line in told.source])
    worst, arcs = 0.0, np.flatnonzero(told.is_arc)
    for row in arcs:
        of = np.flatnonzero(source.source == owner[row])[-1]
        share = np.linspace(0.0, 1.0, STEPS)
        words = np.zeros((STEPS, 5))
        words[:, :3] = gx.points_on_arcs(told, np.full(STEPS, row), share)
        words[:, 3:] = told.end[row, [told.axes.index(letter) for letter in letters[3:]]]
        assert words[0, 3] == 35.0
        tip = exact(model, chain, words)
        centre = source.centre[of, :2]
        radius = np.linalg.norm(source.start[of, :2] - centre)
        off = np.hypot(np.linalg.norm(tip[:, :2] - centre, axis=1) - radius, tip[:, 2])
        worst = max(worst, float(off.max()))
    assert 2 <= len(arcs) < 30
    assert worst <= tolerance + ROUNDED + SECOND_ORDER


def test_a_work_offset_turns_the_head_as_well(tmp_path):
    """With B30 in the work offset, B0 of the program is the head at 30 degrees."""
    chain = chain_of_kind("c-table-b-head", 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = rigid(1, size=0.004, angle=60e-6)
    poses = walk(8)
    shifted = poses - [0.0, 0.0, 0.0, 0.0, 30.0]
    steps = steps_of(tmp_path, "c-table-b-head", model)
    wanted = steps.run(program(poses, letters, "F5."), "full")
    machine = tmp_path / "machine.toml"
    machine.write_text(machine.read_text().replace("[tool.1]", "B = 30.0\n[tool.1]"))
    shifted_steps = gx.Pipeline.load(tmp_path / "p.toml")
    found = shifted_steps.run(program(shifted.round(3), letters, "F5."), "full")
    ends = []
    for result in (wanted, found):
        last = {line: row for row, line in enumerate(result.source_map)}
        rows = [last[line] for line in range(3, 3 + len(poses))]
        ends.append(positions(result.text, letters)[rows, :3])
    assert np.abs(ends[0] - ends[1]).max() < 2e-6


@pytest.mark.parametrize("kind", HEADS)
def test_before_the_head_turns_nothing_is_different(tmp_path, kind):
    """Blocks at 0 degrees are those of a machine without rotary axes, byte for byte."""
    chain = chain_of_kind(kind, 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = rigid(2, size=0.004, angle=60e-6)
    still, turned = walk(5) * [1, 1, 1, 0, 0], walk(6)
    texts = [program(poses, letters, "F5.") for poses in (still, np.vstack([still, turned]))]
    steps = steps_of(tmp_path, kind, model, "tolerance = 0.001")
    one, other = (steps.run(text, "full") for text in texts)
    lines = one.text.splitlines()[:-1]
    assert other.text.splitlines()[: len(lines)] == lines
    plain = machine_text(kind, chain_of_kind(kind, 12))
    bare = plain[: plain.index("kinematics")] + plain[plain.index("gauge-point") :]
    begin, stop = bare.index("[axis.Z]") + len("[axis.Z]\n"), bare.index("[work-offset")
    (tmp_path / "machine.toml").write_text(bare[:begin] + bare[stop:])
    assert gx.Pipeline.load(tmp_path / "p.toml").run(texts[0], "full").text == one.text


class Undone:
    """What the undo of `volumetric` was given in a run, and what it made of it."""

    def __init__(self, monkeypatch, steps) -> None:
        kind = next(type(p) for p in steps.path_passes if p.name == "volumetric")
        self.found, undo = [], kind.undo

        def recorded(step, path, context):
            self.found.append((path, undo(step, path, context)))
            return self.found[-1][1]

        monkeypatch.setattr(kind, "undo", recorded)

    def farthest(self, model, chain, inverse):
        """Return how far (mm) the pieces are from the curves they stand for, and may be."""
        worst, allowed = 0.0, 0.0
        share = np.linspace(0.0, 1.0, 9)[:, None, None]
        for path, made in self.found:
            allowed = max(allowed, made.slack - path.slack)
            columns = [path.axes.index(letter) for letter in ("X", "Y", "Z", *chain.letters)]
            key = {
                (s, n): row for row, (s, n) in enumerate(zip(path.source, path.nth, strict=True))
            }
            pieces = [(s, n) for s, n in zip(made.source, made.nth, strict=True)]
            of = np.array([key[piece] for piece in pieces], int)
            rows = np.flatnonzero((made.kind == gx.Kind.LINE) & path.starts_known[of])
            begin, stop = path.start[of[rows]][:, columns], path.end[of[rows]][:, columns]
            first, last = made.start[rows][:, columns], made.end[rows][:, columns]
            here = first + share * (last - first)
            axis = 3 + np.argmax(np.abs(stop - begin)[:, 3:], axis=1)
            which = np.arange(len(rows))
            way = (stop - begin)[which, axis]
            part = (here[:, which, axis] - begin[which, axis]) / way
            curve = begin + part[..., None] * (stop - begin)
            curve = moved(model, chain, curve.reshape(-1, 5), inverse)
            off = np.linalg.norm(here[..., :3].reshape(-1, 3) - curve, axis=1)
            assert np.isfinite(off).all()
            worst = max(worst, float(off.max(initial=0.0)))
        return worst, allowed


def moved(model, chain, positions, inverse):
    """Return where the machine is with positions (n, 5) of the axes; the inverse: with which."""
    ways, shift = levers(chain, positions[:, 3:]), 0.0
    for _ in range(30 if inverse else 1):
        place = positions[:, :3] + shift + ZERO
        error = model.error(place, gx.Outside.EXTRAPOLATE, ways)
        shift = -error if inverse else error
    return positions[:, :3] + shift


@pytest.mark.parametrize("kind", HEADS)
@pytest.mark.parametrize("inverse", [False, True])
@pytest.mark.parametrize("still", [False, True])
def test_the_undo_is_as_near_to_the_curve_as_it_says(tmp_path, monkeypatch, kind, inverse, still):
    """In pieces: 9 places of each, for lines in long turns; where the linear axes stand as well."""
    chain = chain_of_kind(kind, 12)
    letters = ("X", "Y", "Z", *chain.letters)
    farthest_of_all = 0.0
    for seed in range(3):
        model = rigid(seed, size=0.004, angle=300e-6) if seed else lattice(7, (5, 4, 4))
        options = "max-correction = 2.0\ntolerance = 0.05\n" + "inverse = true" * inverse
        steps = steps_of(tmp_path, kind, model, options)
        seen = Undone(monkeypatch, steps)
        poses = walk(seed, 4, turned=80.0) * ([0, 0, 0, 1, 1] if still else [1, 1, 1, 1, 1])
        steps.run(program(poses, letters, "F5."), "full")
        worst, allowed = seen.farthest(model, chain, inverse)
        assert seen.found
        assert worst <= allowed + 1e-9
        farthest_of_all = max(farthest_of_all, worst)
    assert farthest_of_all > 1e-7


MODELS = st.sampled_from(["rigid", "lattice", "sum"])


@given(MODELS, st.sampled_from(HEADS), st.integers(0, 99), st.sampled_from([0.0005, 0.003]))
@settings(max_examples=12)
def test_any_model_under_any_head(tmp_path_factory, made, kind, seed, tolerance):
    """Between its nodes and beyond them, whatever is added: within the tolerance, and proved."""
    chain = chain_of_kind(kind, 12)
    letters = ("X", "Y", "Z", *chain.letters)
    model = {
        "rigid": lambda: rigid(seed, size=0.004, angle=60e-6),
        "lattice": lambda: lattice(seed, (5, 4, 4), turns=True),
        "sum": lambda: Sum((rigid(seed), lattice(seed, (4, 1, 3), turns=True))),
    }[made]()
    folder = tmp_path_factory.mktemp("turned")
    steps = steps_of(folder, kind, model, f"tolerance = {tolerance}\nmax-correction = 1.0")
    text = program(walk(seed), letters, "F5.")
    result = steps.run(text, "full")
    found = farthest(model, chain, text, result, letters)
    assert found <= tolerance + ROUNDED + SECOND_ORDER
