"""What each pass promises, held against an oracle that knows nothing of gcxform.

Generated programs go through a pipeline. The reference interpreter reads what went in and what came
out; the machine is where a command and a scalar interpolation of the error say it is. It must be
beside the move of the program that the command came from.
"""

from __future__ import annotations

import itertools
import math
import re
from bisect import bisect_right
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from reference.interpreter import Move, Program, interpret
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.pipeline.chain_text import parse_chain
from gcxform.plugin.registry import default_registry
from gcxform.testing.strategies import programs

EXAMPLES = DRAWN
SOME = settings(
    max_examples=EXAMPLES, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck)
)
FEW = settings(SOME, max_examples=max(EXAMPLES // 2, 1))
PARTS = [k / 8 for k in range(1, 9)]  # of a command at which the machine is looked at
PLANES = {"XY": (0, 1, 2), "ZX": (2, 0, 1), "YZ": (1, 2, 0)}
SLACK = 1e-6  # mm; arithmetic, and pieces of undone arcs
FEED = 3e-4  # relative

Point = tuple[float, float, float]
Where = Callable[[Point], Point]  # where the machine is with a command


# --- the oracle: where the machine is, and how far that is from a move ---


def as_commanded(command: Point) -> Point:
    return command


def point_of(position: dict[str, float]) -> Point:
    return tuple(position.get(axis, math.nan) for axis in "XYZ")  # type: ignore[return-value]


def at(move: Move, part: float) -> Point:
    """Return the point of a move at a part of its way."""
    a, b = point_of(move.start), point_of(move.end)
    point = [p + part * (q - p) for p, q in zip(a, b, strict=True)]
    if move.centre is not None:
        u, v, _ = PLANES[move.plane]
        middle = move.centre[u], move.centre[v]
        r0, r1 = math.dist((a[u], a[v]), middle), math.dist((b[u], b[v]), middle)
        turn = move.sweep * (-1 if move.kind == "ARC_CW" else 1)
        angle = math.atan2(a[v] - middle[1], a[u] - middle[0]) + part * turn
        radius = r0 + part * (r1 - r0)
        point[u] = middle[0] + radius * math.cos(angle)
        point[v] = middle[1] + radius * math.sin(angle)
    return point[0], point[1], point[2]


def candidates(move: Move, point: Point) -> Iterator[float]:
    """Yield the parts of a move that may be nearest to a point."""
    a, b = point_of(move.start), point_of(move.end)
    if move.centre is None:
        square = math.dist(a, b) ** 2
        along = sum((p - q) * (r - q) for p, q, r in zip(point, a, b, strict=True))
        yield min(max(along / square, 0.0), 1.0) if square else 1.0
        return
    u, v, _ = PLANES[move.plane]
    sign = -1 if move.kind == "ARC_CW" else 1
    first = math.atan2(a[v] - move.centre[v], a[u] - move.centre[u])
    here = math.atan2(point[v] - move.centre[v], point[u] - move.centre[u])
    ahead = (here - first) * sign % math.tau
    yield from (0.0, 1.0)
    yield from (x / move.sweep for x in np.arange(ahead, move.sweep, math.tau).tolist())


def off_move(move: Move, point: Point, enough: float) -> float:
    """Return the distance of a point from a move; any number up to `enough` is as good."""
    best, part = min((math.dist(at(move, part), point), part) for part in candidates(move, point))
    step = 0.01
    while best > enough and step > 1e-9:  # a helix is nearest beside the point at the same angle
        trials = [min(max(part + step * k, 0.0), 1.0) for k in (-1, -0.5, 0.5, 1)]
        nearer, place = min((math.dist(at(move, trial), point), trial) for trial in trials)
        best, part, step = (nearer, place, step) if nearer < best else (best, part, step / 2)
    return best


def known(move: Move) -> bool:
    return set("XYZ") & set(move.end) <= set(move.start)


def check_path(before: Program, after: list[tuple[int, Move]], where: Where, budget: float) -> None:
    """Check that commands keep the machine beside the moves of the lines they came from."""
    pieces = {
        line: [move for _, move in group]
        for line, group in itertools.groupby(after, key=lambda item: item[0])
    }
    assert set(pieces) <= {move.line for move in before.moves}
    assert [line for line, _ in after] == sorted(line for line, _ in after)
    for move in before.moves:
        if move.line in pieces:
            check_move(move, pieces[move.line], where, budget + SLACK)
        else:
            assert math.dist(point_of(move.start), point_of(move.end)) <= budget + SLACK, move


def check_move(move: Move, pieces: list[Move], where: Where, budget: float) -> None:
    """Check the pieces that stand for one move: path, end, kind and feed."""
    assert (move.kind == "RAPID") == all(piece.kind == "RAPID" for piece in pieces)
    end = where(point_of(pieces[-1].end))
    gap = [abs(p - q) for p, q in zip(end, point_of(move.end), strict=True) if not math.isnan(q)]
    assert math.hypot(*gap) <= budget, (move, pieces[-1])
    for axis in set(move.end) - set("XYZ"):
        assert abs(pieces[-1].end[axis] - move.end[axis]) <= 1e-3, move
    if all(piece.feed is not None for piece in pieces):
        check_feed(move, pieces)
    if move.kind == "RAPID" or not known(move):
        return
    for piece in pieces:
        for part in PARTS:
            point = where(at(piece, part))
            if not any(map(math.isnan, point)):
                assert off_move(move, point, budget) <= budget, (move, piece, part)


def check_feed(move: Move, pieces: list[Move]) -> None:
    assert {piece.feed_mode for piece in pieces} == {move.feed_mode}
    assert move.feed is not None
    if move.feed_mode == "G93":
        time = sum(1 / piece.feed for piece in pieces if piece.feed)
        assert time == pytest.approx(1 / move.feed, rel=1e-3)
    else:
        # A move of rotary axes alone has its feed in degrees.
        assert all(piece.feed == pytest.approx(move.feed, rel=FEED) for piece in pieces), move


def error_of(model: gx.AxisFunctions, clamp: bool, origin: Point) -> Where:
    """Return where a machine with this error is with a command, one number at a time."""
    columns = [None if f is None else (f.position.tolist(), f.values.tolist()) for f in model.axes]

    def where(command: Point) -> Point:
        machine = list(command)
        for value, shift, column in zip(command, origin, columns, strict=True):
            if column is not None:
                for k, e in enumerate(interpolated(*column, value + shift, clamp)):
                    machine[k] += e
        return machine[0], machine[1], machine[2]

    return where


def interpolated(
    nodes: list[float], values: list[list[float]], x: float, clamp: bool
) -> list[float]:
    """Return the values at x: linear between nodes, beyond them constant or continued."""
    x = min(max(x, nodes[0]), nodes[-1]) if clamp else x
    cell = min(max(bisect_right(nodes, x) - 1, 0), len(nodes) - 2)
    part = (x - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
    return [a + part * (b - a) for a, b in zip(values[cell], values[cell + 1], strict=True)]


# --- running ---


def chain_of(text: str) -> list[Any]:
    return list(parse_chain(text, Path.cwd(), default_registry()))


def pipeline(steps: list[Any], source: str, target: str = "", **options: Any) -> gx.Pipeline:
    find = default_registry().dialect
    return gx.Pipeline(find(source), find(target or source), tuple(steps), **options)


def transformed(chain: gx.Pipeline, program: bytes) -> gx.Result | None:
    """Run with full verification; None if the program is refused. What is wrong raises."""
    try:
        return chain.run(program, verify="full")
    except gx.VerificationError:
        raise
    except gx.InputError:
        return None


def follow(chain: gx.Pipeline, program: bytes, where: Where = as_commanded) -> gx.Result | None:
    """Run a chain and check what it writes with the oracle."""
    result = transformed(chain, program)
    if result is None:
        return None
    before = interpret(program, chain.source.name)
    after = interpret(result.text, chain.target.name)
    moves = [(result.source_map[move.line - 1] + 1, move) for move in after.moves]
    inch = re.search(rb"[gG] *2 *0(?![.0-9])", result.text) is not None
    check_path(before, moves, where, chain.limit(inch))
    assert [text for _, text in after.events] == [text for _, text in before.events]
    return result


# --- the passes ---

CHAINS = {
    "absolute": "absolute",
    "metric": "metric",
    "both": "metric | absolute",
    "plane": "plane chord-error=5um",
    "chords": "segment chord-error=5um",
    "short chords": "segment chord-error=50um max-length=7mm",
    "short arcs": "segment arcs=split arc-step=20deg",
    "short pieces": "segment arcs=split max-length=9mm",
    "all": "metric | absolute | segment chord-error=20um max-length=25mm",
}


@pytest.mark.parametrize("name", CHAINS)
def test_a_chain_follows_the_program(name: str) -> None:
    chain = pipeline(chain_of(CHAINS[name]), "linuxcnc")
    done = []

    @FEW
    @given(program=programs(max_blocks=15))
    def check(program: bytes) -> None:
        done.append(follow(chain, program) is not None)

    check()
    assert sum(done) > 0.7 * len(done)  # few are refused, and ten are drawn


@st.composite
def models(draw: st.DrawFn) -> gx.AxisFunctions:
    """Draw a model of nine functions on nodes that are not evenly spaced."""
    axes = []
    for _ in "XYZ":
        gaps = draw(st.lists(st.integers(5, 90), min_size=1, max_size=7))
        nodes = np.cumsum([-draw(st.integers(0, 200)), *gaps]).astype(float)
        steps = st.integers(-80, 80)  # 1e-3 of a gap at most
        rise = [[draw(steps) * gap * 1e-5 for _ in "XYZ"] for gap in gaps]
        values = np.cumsum([[draw(steps) * 1e-4 for _ in "XYZ"], *rise], axis=0)
        axes.append(gx.AxisFunction(nodes, values) if draw(st.integers(0, 9)) else None)
    return gx.AxisFunctions(tuple(axes))  # type: ignore[arg-type]


@pytest.mark.parametrize("outside", [gx.Outside.CLAMP, gx.Outside.EXTRAPOLATE])
@pytest.mark.parametrize("split", ["adaptive", "nodes"])
@pytest.mark.parametrize("tolerance", [None, 0.02])
@pytest.mark.parametrize("origin", [0.0, 12.5])
def test_a_compensated_machine_follows_the_program(
    outside: gx.Outside, split: str, tolerance: float | None, origin: float
) -> None:
    done = []

    @settings(SOME, max_examples=max(EXAMPLES // 8, 1))
    @given(program=programs(max_blocks=10), model=models())
    def check(program: bytes, model: gx.AxisFunctions) -> None:
        made = default_registry().passes["volumetric"]
        step = made(
            model=ModelFile(Path("drawn.toml"), model, "0" * 64),
            outside=outside,
            split=split,
            tolerance=tolerance,
            max_correction=10.0,
            max_extrapolation=1000.0,
            part_origin=(origin, 0.0, -origin),
        )
        where = error_of(model, outside is gx.Outside.CLAMP, (origin, 0.0, -origin))
        chain = pipeline([*chain_of("absolute"), step], "linuxcnc")
        done.append(follow(chain, program, where) is not None)

    check()
    assert sum(done) > 0.5 * len(done)


# --- further laws ---


NAMES = st.sampled_from(("linuxcnc", "fanuc", "haas", "grbl"))
SOURCES = NAMES.flatmap(lambda name: st.tuples(st.just(name), programs(name, max_blocks=12)))


@FEW
@given(source=SOURCES)
def test_absolute_leaves_its_own_output_as_it_is(source: tuple[str, bytes]) -> None:
    name, program = source
    chain = pipeline(chain_of("absolute"), name)
    if (once := transformed(chain, program)) is not None:
        assert chain.run(once.text).text == once.text


@SOME
@given(source=SOURCES, target=NAMES)
def test_a_program_means_the_same_in_another_dialect(
    source: tuple[str, bytes], target: str
) -> None:
    """Programs that the target cannot say are refused; others do what they did."""
    name, program = source
    keeps = re.sub(rb"[mM] *0*6(?![0-9])", b"M5", program)  # a Fanuc loses its position there
    follow(pipeline([], name, target), keeps.upper())


def test_a_fanuc_gets_no_lower_case() -> None:
    result = pipeline([], "linuxcnc", "fanuc").run(b"g21 g90 g94\ng1 x1 y2 z3 f100\nm2\n")
    assert result.text == result.text.upper()


@FEW
@given(program=programs(max_blocks=15))
def test_metric_leaves_angles_and_counts(program: bytes) -> None:
    result = transformed(pipeline(chain_of("metric"), "linuxcnc"), program)
    if result is not None:
        for letters in ("ABC", "NSTP", "M"):
            assert words(result.text, letters) == words(program, letters)


def words(program: bytes, letters: str) -> list[tuple[str, float]]:
    text = re.sub(r"\([^)]*\)|;[^\n]*|[ \t]", "", program.decode("latin-1").upper())
    found = re.findall(rf"([{letters}])([+-]?[0-9.]+)", text)
    return [(letter, round(float(value), 3)) for letter, value in found]


ORDERS = sorted(
    itertools.permutations(("absolute", "metric", "segment chord-error=9um", "plane"), 3)
)


@FEW
@given(program=programs(max_blocks=10), order=st.sampled_from(ORDERS))
def test_the_order_of_passes_does_not_matter_or_is_refused(
    program: bytes, order: tuple[str, ...]
) -> None:
    try:
        chain = pipeline(chain_of(" | ".join(order)), "linuxcnc")
    except gx.UsageError:
        return
    follow(chain, program)


# --- single programs ---


def text_of(chain: str, program: str, dialect: str = "linuxcnc", **options: Any) -> str:
    result = pipeline(chain_of(chain), dialect, **options).run(program.encode(), verify="full")
    return result.text.decode()


@pytest.mark.parametrize("chain", ["absolute", "segment arcs=split max-length=0.4mm"])
def test_distances_do_not_drift(chain: str) -> None:
    """10,000 distances that no decimal fraction of a piece is exact for."""
    steps = ["X1 Y.1", "X-1 Y.1"] * 5000
    program = "\n".join(["G21 G90 G94 G0 X0 Y0 Z0", "G91 G1 X0 F100", *steps, "M2", ""])
    after = interpret(text_of(chain, program).encode(), "linuxcnc")
    assert len(after.moves) >= 10_000
    assert point_of(after.moves[-1].end) == pytest.approx((0.0, 1000.0, 0.0), abs=0.6e-4)
    lengths = {round(m.end["Y"] / 0.1 % 1, 3) for m in after.moves if m.end["X"] in (0.0, 1.0)}
    assert lengths <= {0.0, 0.999, 0.001, 1.0}


def test_a_motion_code_that_no_longer_holds_is_stated() -> None:
    """The first arc is too short to write; the second would be a line without its code."""
    program = "G21 G17 G90 G0 X0 Y0 Z0\nG1 X10 F100\nG91\nG2 X.00004 Y0 R.02\nX10 Y0 I5\nM2\n"
    lines = text_of("absolute", program).splitlines()
    assert lines[-2].startswith("G2 X20.")


def test_centres_count_from_the_start_as_it_is_written() -> None:
    """The start is written 4.9 um off where it was; the centre must not be moved with it."""
    program = "G21 G17 G90 G0 X0 Y0 Z0\nG91 G1 X0.0049 F100\nG2 X0 I5.003 J0\nM2\n"
    text = text_of("absolute", program, decimals=dict.fromkeys("XYZIJK", 2))
    assert "G2 X0. Y0. I5.01 J0." in text or "G2 X0. I5.01 J0." in text


MODEL = Path(__file__).parents[2] / "examples" / "lddm" / "model.toml"


@pytest.mark.parametrize("wrong", ["no error", "another origin", "turned round"])
def test_the_oracle_sees_a_machine_that_is_elsewhere(wrong: str) -> None:
    """It passes with the model that was compensated for, and with no other."""
    chain = pipeline(chain_of(f"volumetric model={MODEL} part-origin=100,100,100"), "linuxcnc")
    program = b"G21 G90 G17 G0 X0 Y0 Z0\nG1 X90 Y80 F100\nG3 X50 Y80 I-20 J0\nG1 Z200\nM2\n"
    model = ModelFile.load(MODEL).model
    assert isinstance(model, gx.AxisFunctions)
    right = error_of(model, False, (100.0, 100.0, 100.0))
    assert follow(chain, program, right)
    machines: dict[str, Where] = {
        "no error": as_commanded,
        "another origin": error_of(model, False, (0.0, 0.0, 0.0)),
        "turned round": lambda c: tuple(2 * p - q for p, q in zip(c, right(c), strict=True)),  # type: ignore[return-value]
    }
    with pytest.raises(AssertionError):
        follow(chain, program, machines[wrong])
