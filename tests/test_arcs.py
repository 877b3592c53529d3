"""The pass `arcs`, held against an oracle of its own: points along both paths, in order.

Programs are read by the reference interpreter, or by LinuxCNC's; both paths become dense rows of
points, and a table decides whether one can be followed along the other without ever being farther
away than allowed (the discrete Frechet distance).
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arcs_kit import SPACING, arcs, ended, follows, points, polylines
from gcxform_plugins.passes.arcs.fit import Fit, Limits
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import rs274
from properties.test_laws import at, point_of
from reference.interpreter import Move, interpret
from seeds_kit import DRAWN, some
from test_verify import Change, dropped, inserted, said, swapped
from test_verify import run as lie

import gcxform as gx
from gcxform.deviations.runs import Runs, deviation_of_runs, runs_of
from gcxform.pipeline.certify import certificate
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

EXAMPLES = Path(__file__).parents[1] / "examples" / "lddm"
ROUNDING = 0.004  # mm; what three decimals may add along an arc
SOME = settings(max_examples=max(DRAWN // 2, 1), deadline=None)
FEW = settings(SOME, max_examples=max(DRAWN // 8, 1))


def run(chain: str, program: bytes, dialect: str = "linuxcnc") -> gx.Result:
    return gx.Pipeline.parse(chain, dialect).run(program, verify="full")


def check(program: bytes, result: gx.Result, tolerance: float) -> None:
    """Check that a program goes where another one goes, within a tolerance."""
    before, after = interpret(program, "linuxcnc"), interpret(result.text, "linuxcnc")
    limit = tolerance + ROUNDING + SPACING
    assert follows(points(before.moves), points(after.moves), limit)
    ends = [
        [point_of(p.moves[i - 1].end) if i else None for i, _ in p.events] for p in (before, after)
    ]
    for old, new in zip(*ends, strict=True):
        assert (old is None) == (new is None)
        assert old is None or new is None or math.dist(old, new) <= ROUNDING


# --- the laws ---


@SOME
@given(arcs(), st.booleans())
def test_arcs_made_lines_become_arcs_again(drawn: tuple[bytes, int], in_one_chain: bool) -> None:
    program, count = drawn
    if in_one_chain:
        result = run("segment chord-error=0.01 | arcs tolerance=0.011", program)
    else:
        lines = run("segment chord-error=0.01", program).text
        result = run("arcs tolerance=0.011", lines)
    moves = interpret(result.text, "linuxcnc").moves
    assert sum(move.centre is not None for move in moves) == count
    assert len(moves) == 1 + 2 * count
    check(program, result, 0.021)


@SOME
@given(polylines(), st.sampled_from((0.001, 0.01, 0.1)), st.integers(2, 5))
def test_lines_are_followed(program: bytes, tolerance: float, fewest: int) -> None:
    result = run(f"arcs tolerance={tolerance} min-lines={fewest}", program)
    check(program, result, tolerance)


@FEW
@given(polylines(), st.sampled_from((0.01, 0.1)))
def test_lines_are_followed_in_distances(program: bytes, tolerance: float) -> None:
    relative = gx.read(program, "linuxcnc").path
    ends = np.diff(np.vstack([np.zeros(3), relative.end[:, :3]]), axis=0)
    lines = ["G21 G91 G94 G17", "G90 G0 X0 Y0 Z0", "G91 G1 F100"]
    lines += ["X{:.3f} Y{:.3f} Z{:.3f}".format(*end) for end in ends[1:]]
    check(ended(lines), run(f"arcs tolerance={tolerance}", ended(lines)), tolerance)


@FEW
@given(polylines())
def test_windows_do_not_matter_to_the_law(program: bytes) -> None:
    source, texts = Source.of_bytes(program), list[bytes]()
    job = Run(gx.Pipeline.parse("arcs tolerance=0.1", "linuxcnc"), source, "full")
    job.over(Output(texts.append, None), lambda _: None, 200)
    check(
        program, gx.Result(b"".join(texts), certificate(job, Output(texts.append, None)), []), 0.1
    )


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
@FEW
@given(st.lists(st.one_of(polylines(), arcs().map(lambda drawn: drawn[0])), min_size=8, max_size=8))
def test_linuxcnc_goes_where_the_lines_went(programs: list[bytes]) -> None:
    chain = "segment chord-error=0.01 | arcs tolerance=0.05"
    texts = [run(chain, program).text for program in programs]
    for program, canon in zip(programs, rs274.run_many(texts), strict=True):
        assert not isinstance(canon, rs274.Rejected), (canon, program)
        moves = [m for m in canon.moves if m.start != m.end]
        ours: list[Any] = interpret(program, "linuxcnc").moves
        theirs = [_with_sweep(move) for move in moves]
        assert follows(points(ours[1:]), points(theirs), 0.06 + ROUNDING + SPACING)


def _with_sweep(move: rs274.CanonMove) -> Move:
    if move.centre is None:
        return Move(move.kind, move.start, move.end, move.line)
    u, v = ("XYZ".index(a) for a in {"XY": "XY", "ZX": "ZX", "YZ": "YZ"}[move.plane])
    p, q = point_of(move.start), point_of(move.end)
    angles = [math.atan2(x[v] - move.centre[v], x[u] - move.centre[u]) for x in (p, q)]
    sense = -1 if move.kind == "ARC_CW" else 1
    sweep = (angles[1] - angles[0]) * sense % math.tau
    return Move(
        move.kind, move.start, move.end, move.line,
        plane=move.plane, centre=move.centre, sweep=sweep,
    )  # fmt: skip


# --- the fit by itself ---


@SOME
@given(st.integers(0, 10**6), st.sampled_from((3, 5, 9)))
def test_what_is_certified_is_near(seed: int, count: int) -> None:
    """What `Fit` calls near is near, along the whole run and in its order."""
    choose = np.random.default_rng(seed)
    tolerance = 0.2
    bend, wobble = choose.uniform(-0.8, 0.8), choose.choice([0.0, 0.1, 0.3])
    heading = np.cumsum(np.full(count, bend) + choose.normal(0, wobble, count))
    way = np.stack([np.cos(heading), np.sin(heading), np.full(count, 0.3)], 1)
    way *= choose.uniform(0.2, 1.6, (count, 1)) * choose.choice([1.0, 1.0, 1.0, -0.2], (count, 1))
    way[:, 2] += choose.choice([0.0, 0.2]) * choose.normal(0, 1, count)
    corners = np.vstack([np.zeros(3), np.cumsum(way, axis=0)])
    found = Fit(corners.T, Limits(tolerance, 0.01, 1e3, 6.1, 0.001)).arcs(
        np.array([0]), np.array([count])
    )
    if not found.curved[0]:
        return
    ends = [dict(zip("XYZ", corner, strict=True)) for corner in corners.tolist()]
    lines = [Move("LINE", p, q, 1) for p, q in pairwise(ends)]
    kind = "ARC_CCW" if found.sense[0] > 0 else "ARC_CW"
    centre = (float(found.centre[0, 0]), float(found.centre[1, 0]), 0.0)
    arc = Move(kind, ends[0], ends[-1], 1, centre=centre, sweep=float(found.sweep[0]))
    assert math.dist(at(arc, 1.0), corners[-1]) < 1e-9
    assert follows(points(lines), points([arc]), tolerance + SPACING / 2)


def test_no_distance_of_a_run_is_larger_than_its_bound() -> None:
    """Ways that have more or less to do with one another: the bound is above their distance."""
    finite = 0
    for seed in (seeds := some(150)):
        choose = np.random.default_rng(seed)
        programs = [ended(_wandering(choose, wobble)) for wobble in choose.choice([0.02, 0.5], 2)]
        if seed % 2:
            programs[1] = run("segment arcs=split arc-step=40", programs[1]).text
        one, other = (gx.read(program, "linuxcnc").path for program in programs)
        owner = np.minimum(np.arange(len(other)), 1)
        runs = Runs(owner, owner * (len(one) - 1), np.empty(0, np.int64))
        bound = float(deviation_of_runs(one, other, runs).distance[1:].max())
        finite += math.isfinite(bound)
        ways = [points(interpret(program, "linuxcnc").moves[1:]) for program in programs]
        assert not math.isfinite(bound) or follows(ways[0], ways[1], bound + SPACING), seed
    assert finite > len(seeds) // 2


def _wandering(choose: np.random.Generator, wobble: float) -> list[str]:
    """Return lines and arcs from the origin to about X9, the way there more or less straight."""
    lines, place = ["G21 G90 G94 G17", "G0 X0 Y0 Z0", "F100"], np.zeros(3)
    for x in range(1, 4):
        end = np.round([3.0 * x, *choose.normal(0, wobble, 2)], 3)
        code = choose.choice(["G1", "G1", "G2", "G3"])
        words = "X{:.3f} Y{:.3f} Z{:.3f}".format(*end)
        if code != "G1":
            chord = math.dist(place[:2], end[:2])
            words += f" R{chord * choose.uniform(0.8, 4.0):.3f}"
        lines.append(f"{code} {words}")
        place = end
    return lines


def test_a_straight_line_is_no_arc() -> None:
    program = ended(["G21 G90 G94 G17", "G0 X0 Y0 Z0", "G1 F100"] + [f"X{k}" for k in range(1, 50)])
    assert run("arcs tolerance=0.1", program).text == program


def test_what_a_line_could_stand_for_is_no_arc() -> None:
    """Six lines on a radius of 100 mm: 0.045 mm between arc and chord, less than the tolerance."""
    bend = [f"X{100 * math.sin(k / 100):.3f} Y{k * k / 200:.3f}" for k in range(1, 7)]
    program = ended(["G21 G90 G94 G17", "G0 X0 Y0 Z0 F100", f"G1 {bend[0]}", *bend[1:]])
    assert run("arcs tolerance=0.1", program).text == program
    assert b"G3" in run("arcs tolerance=0.03", program).text


def test_the_motion_code_is_stated_again_behind_an_arc() -> None:
    lines = ["G21 G90 G94 G17", "G0 X0 Y0 Z0 F100", *(f"G1 {bend}" for bend in BEND), "X20"]
    result = run("arcs tolerance=0.02", ended(lines))
    assert result.text.splitlines()[-3:] == [ARC.encode(), b"G1 X20.", b"M2"]


def test_a_zigzag_along_an_arc_stays() -> None:
    """Each line breaks by 17 degrees to one side and the other: near an arc, and yet none."""
    size = [20, *[20 + 0.22 * (-1) ** k for k in range(1, 9)], 20]
    bend = [(r * math.cos(0.15 * k), r * math.sin(0.15 * k)) for k, r in enumerate(size)]
    lines = ["G1 X{:.3f} Y{:.3f}".format(*point) for point in bend]
    program = ended(["G21 G90 G94 G17", "G0 X20 Y0 Z0 F100", *lines])
    assert run("arcs tolerance=0.3 min-lines=6", program).text == program
    smooth = [
        f"G1 X{20 * math.cos(0.15 * k):.3f} Y{20 * math.sin(0.15 * k):.3f}" for k in range(10)
    ]
    program = ended(["G21 G90 G94 G17", "G0 X20 Y0 Z0 F100", *smooth])
    assert b"G3" in run("arcs tolerance=0.3 min-lines=6", program).text


def test_an_arc_does_not_end_inside_another_block() -> None:
    """Three blocks go round one circle, more than once: each stays the block that it was."""
    turns = ["G3 X0 Y-10 I-10 J0 F100", "G3 X-10 Y0 I0 J10", "G3 X0 Y-10 I10 J0"]
    program = ended(["G21 G90 G94 G17", "G0 X10 Y0 Z0", *turns, "G1 Y-12 X5"])
    result = run("segment chord-error=0.01 | arcs tolerance=0.02", program)
    ends = [point_of(move.end)[:2] for move in interpret(result.text, "linuxcnc").moves]
    assert ends == [(10, 0), (0, -10), (-10, 0), (0, -10), (5, -12)]


def test_what_the_lddm_compensation_made_gets_small_again() -> None:
    program = (EXAMPLES / "arc_in.nc").read_bytes()
    model = f"volumetric model={EXAMPLES / 'model.toml'} part-origin=0,0,0 outside=extrapolate"
    spec = "absolute | segment chord-error=2um | " + model
    start = {"Z": 0.0}
    chains = [gx.Pipeline.parse(text, "fanuc") for text in (spec, spec + " | arcs tolerance=5um")]
    made = [
        gx.Pipeline(p.source, p.target, p.passes, reading=type(p.reading)(start=start)).run(program)
        for p in chains
    ]
    counts = [result.text.count(b"\n") for result in made]
    assert counts[1] * 4 < counts[0], counts
    assert made[1].certificate.largest["deviation"] <= 0.01


# --- the proof, fed with texts that somebody tampered with ---

BEND = [f"X{10 * math.sin(a / 10):.3f} Y{10 - 10 * math.cos(a / 10):.3f}" for a in range(1, 11)]
ROUND = ended(
    ["G21 G90 G94 G17", "G0 X0 Y0 Z0 F100", f"G1 {BEND[0]}", *BEND[1:], "M8", "X20", "Y20", "X0"]
)
ARC = "G3 X8.415 Y4.597 I-0.0008 J10.002"

TAMPERED: dict[str, tuple[Change, str]] = {
    "the sense": (said("G3 X8", "G2 X8"), "off"),
    "a line in the place of the arc": (said(ARC, "G1 X8.415 Y4.597"), "off"),
    "another circle": (said(ARC, "G3 X8.415 Y4.597 R9.8"), "off"),
    "the arc ends early": (said(ARC, "G3 X7.833 Y3.784 I-0.0008 J10.002"), "."),
    "the arc is missing": (dropped(2), "."),
    "there and back": (said(ARC, ARC + "\nG2 X0 Y0 I-8.415 J5.403\n" + ARC), "."),
    "a line behind the arc is missing": (dropped(13), "."),
    "M8 before the arc": (inserted("M8", 1), "M8"),
    "M8 behind a line more": (swapped(3), "."),
    "another feed": (said(ARC, ARC + " F101"), "feed"),
}


def tampered(change: Change, program: bytes) -> None:
    lie(change, "arcs tolerance=0.02", program)


def test_nothing_is_wrong_with_the_program_itself() -> None:
    tampered(iter, ROUND)  # type: ignore[arg-type]
    assert ARC.encode() in run("arcs tolerance=0.02", ROUND).text


@pytest.mark.parametrize("name", TAMPERED)
def test_a_text_tampered_with_is_refused(name: str) -> None:
    change, message = TAMPERED[name]
    with pytest.raises(gx.VerificationError, match=message):
        tampered(change, ROUND)


def test_an_event_inside_a_run_does_not_go_behind_it() -> None:
    bends = [f"G1 {BEND[0]}", *BEND[1:5], "M8", *BEND[5:], "X20"]

    def one_arc(lines: list[tuple[bytes, int]]) -> list[tuple[bytes, int]]:
        new = [(ARC.encode() + b"\n", 2), (b"M8\n", 7), (b"G1 X20.\n", 13), (b"M2\n", 14)]
        return lines[:2] + new

    with pytest.raises(gx.VerificationError, match="M8"):
        tampered(one_arc, ended(["G21 G90 G94 G17", "G0 X0 Y0 Z0 F100", *bends]))


@pytest.mark.parametrize(
    "line",
    ["X3 F200", "G0 X3", "G93 X3 F2\nG94 F100", "G55 X3", "G52 X1\nG1 X2", "A5 X3", "/X3"],
)
def test_what_is_not_alike_is_in_no_run(line: str) -> None:
    """A row is taken for a part of a run only if all along the run the same holds."""
    program = ended(["G21 G90 G94 G17", "G54 G0 X0 Y0 Z0 A0", "G1 X1 F100", "X2", line, "X4"])
    path = gx.read(program, "linuxcnc", block_delete="execute").path
    plain = runs_of(path, np.array([0, 1]))
    assert plain.through.tolist() == ([0, 4] if line == "/X3" else [0, 2])
    assert plain.left.tolist() == ([] if line == "/X3" else [3, 4])
