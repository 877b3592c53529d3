"""Splines: what LinuxCNC makes of their words, and the lines that `segment` makes of them.

The points of LinuxCNC's preview judge the reading. Points taken closely along curve and lines, by
powers of t instead of control points, judge the cutting and the bound of the proof.
"""

from __future__ import annotations

import random
import re
from itertools import pairwise

import numpy as np
import pytest
from oracles import preview
from seeds_kit import DRAWN

import gcxform as gx
from gcxform.testing.generate import Options, program
from gcxform.toolpath.path import Toolpath

COUNT = 3 * DRAWN
START = dict.fromkeys("XYZABC", 0.0)
CLOSE = 1e-6  # mm; the preview prints all digits
FINE = np.linspace(0.0, 1.0, 1001)
CHANGE = re.compile(r"[mM]\s*0*6(?![0-9.])|[tT]\s*\d+")  # the preview has no tools, and dies
NO_ROTARY = Options(splines=True, rotary=False)

judged = pytest.mark.skipif(not preview.available(), reason="the module gcode is not installed")


def drawn(seed: int, options: Options = NO_ROTARY) -> str:
    source = program(random.Random(seed).randint, options).decode("latin-1")
    return CHANGE.sub("", source)


def curve(start, control, end, t):
    """Return points (k, d) of a spline by powers of t."""
    a, b, c, d = start, control[0], control[1], end
    powers = [a, 3 * (b - a), 3 * (a - 2 * b + c), d - 3 * c + 3 * b - a]
    return sum(np.outer(t**k, p) for k, p in enumerate(powers))


# --- reading ---

STRICTER = ("I and J are left out", "stands here twice")
"""A series that is interrupted, and P or Q twice: LinuxCNC sees that if the first is above -1."""


@judged
def test_splines_go_where_linuxcnc_draws_them():
    sources = [drawn(seed) for seed in range(COUNT)]
    cubic = quadratic = 0
    for source, moves in zip(sources, preview.preview(sources), strict=True):
        assert not isinstance(moves, str), (moves, source)
        path = gx.read(source.encode("latin-1"), "linuxcnc", start=START).path
        drawn_by_line = dict(moves)
        for row in np.flatnonzero(path.is_spline).tolist():
            points = np.array(drawn_by_line[int(path.source[row]) + 1])
            t = np.arange(1, len(points) + 1) / len(points)
            ours = curve(path.start[row, :3], path.control[row], path.end[row, :3], t)
            assert np.abs(ours - points)[:, :2].max() < CLOSE, (row, source)
            cubic, quadratic = cubic + (len(points) == 60), quadratic + (len(points) == 45)
    assert cubic > COUNT
    assert quadratic > COUNT / 3


def broken(source: str, pick: random.Random) -> str:
    """Return a program with one word taken out of a block of a spline, or one put into it."""
    lines = source.splitlines()
    splines = [k for k, line in enumerate(lines) if re.search(r"[gG] *0*5(\.1)?(?![0-9.])", line)]
    if not splines:
        return source
    at = pick.choice(splines)
    if pick.random() < 0.5:
        lines[at] = re.sub(rf"(?i){pick.choice('XYIJPQ')} *[-+0-9. ]+", " ", lines[at], count=1)
    else:
        word = pick.choice(["I1", "J1", "K1", "P1", "Q1", "R1", "L1", "Z1", "A1", "G18", "G19"])
        lines[at] = lines[at].split("(")[0].split(";")[0] + " " + word
    return "\n".join(lines) + "\n"


@judged
def test_what_linuxcnc_refuses_is_refused():
    """All that LinuxCNC refuses is, and little else."""
    sources = [broken(drawn(seed), random.Random(seed)) for seed in range(COUNT)]
    refused = 0
    for source, theirs in zip(sources, preview.preview(sources), strict=True):
        try:
            gx.read(source.encode("latin-1"), "linuxcnc", start=START).path  # noqa: B018
            ours = ""
        except gx.InputError as error:
            ours = str(error)
        if isinstance(theirs, str):
            assert ours, (theirs, source)
            refused += 1
        else:
            assert not ours or any(text in ours for text in STRICTER), (ours, source)
    assert refused > COUNT / 4


# --- splines of weights and knots, as lines for another control ---


def knotted(pick: random.Random) -> str:
    """Return a program with one spline of weights and knots, on the lines from 3 on."""
    order, count = pick.randint(3, 6), pick.randint(6, 12)
    reach, unit = pick.choice([(0.02, "G20"), (1.0, "G20"), (40.0, "G21"), (300.0, "G21")])
    first = pick.choice([f"P{pick.choice([0.5, 2])} ", "P1 ", "", None])
    points = [
        f"X{pick.uniform(-reach, reach):.4f} Y{pick.uniform(-reach, reach):.4f}"
        f" P{pick.choice([1, 1, 0.2, 3, 7.5])}"
        for _ in range(count)
    ]
    head = f"G5.2 L{order}" + (" " if first is None else f" {first}\n")
    blocks = [f"{head}{points[0]}", *points[1:], "G5.3"]
    body = "\n".join(blocks)
    return f"{unit} G90 G94 G17 F100\nG0 X0 Y0 Z0\n{body}\nG1 X0 Y0 Z0\nM2\n"


def as_lines(source: str, stays: bool) -> Toolpath:
    """Return the path of the lines that a program gets for its spline.

    A GRBL gets them unasked; where the control `stays` they are those of a step that makes lines.
    """
    from gcxform_plugins.passes.segment import Segment

    from gcxform.plugin.registry import default_registry

    kinds, target = default_registry().dialects, "linuxcnc" if stays else "grbl"
    numbers, steps = gx.NumberFormat(mm=4, inch=6), (Segment(chord_error=0.002),) * stays
    pipeline = gx.Pipeline(kinds["linuxcnc"], kinds[target], steps, numbers=numbers)
    result = pipeline.run(source.encode())
    assert result.certificate.verified
    said = [each for each in result.certificate.assumed if "become lines" in each]
    assert bool(said) != stays
    return gx.read(result.text, target, start=START).path


@judged
def test_splines_of_weights_become_lines_beside_what_linuxcnc_draws():
    """No point that LinuxCNC draws is far from the lines, and no line is far from its points."""
    sources = [knotted(random.Random(seed)) for seed in range(DRAWN // 4)]
    pairs = zip(sources, preview.preview(sources), strict=True)
    for number, (source, moves) in enumerate(pairs):
        assert not isinstance(moves, str), (moves, source)
        drawn = np.array([[0.0, 0.0], *(p[:2] for _, points in moves[1:-1] for p in points)])
        lines = as_lines(source, number % 2 == 1).end[1:-1, :2]
        corners = np.vstack([[[0.0, 0.0]], lines])
        assert apart(drawn, corners).max() < 0.002 + 2e-4, source
        sag = np.hypot(*np.diff(drawn, 2, axis=0).T).max()
        assert apart(lines, drawn).max() < sag + 2e-4, source


# --- cutting, and its proof ---


def one_spline(pick: random.Random) -> Toolpath:
    """Return a path of one spline of some kind: loops, cusps, lines there and back among them."""
    reach = pick.choice([0.01, 1.0, 30.0, 500.0])
    words = [round(pick.uniform(-reach, reach), 4) for _ in range(6)]
    kind = pick.randrange(6)
    if kind == 0:  # closed
        words[:2] = [0.0, 0.0]
    elif kind == 1:  # a cusp: the inner control points crossed over
        x, y = words[:2]
        words[2:] = [round(x, 3), round(y, 3) + 1, -round(x, 3), 1 - round(y, 3)]
    elif kind == 2:  # along one line, there and back
        x, y = words[:2]
        words[2:] = [2 * x, 2 * y, -3 * x, -3 * y]
    elif kind == 3:  # control points at the ends
        words[2:] = [0.0] * 4
    x, y, i, j, p, q = words
    text = f"G21 G90 G94 F100\nG0 X1 Y2 Z3\nG5 X{1 + x:.4f} Y{2 + y:.4f}"
    text += f" I{i:.4f} J{j:.4f} P{p:.4f} Q{q:.4f}\nM2\n"
    return gx.read(text.encode(), "linuxcnc").path


def context() -> gx.PassContext:
    from gcxform.plugin.registry import default_registry

    dialect = default_registry().dialect("linuxcnc")
    return gx.PassContext(dialect, dialect, dialect.numbers)


def segment(path: Toolpath, **options) -> Toolpath:
    from gcxform_plugins.passes.segment import Segment

    return Segment(**options).apply(path, context())


def apart(points, corners):
    """Return the distances (k,) of points from a chain of lines between corners."""
    best = np.full(len(points), np.inf)
    for a, b in pairwise(corners):
        way = b - a
        square = way @ way
        part = np.clip((points - a) @ way / square, 0, 1) if square else np.zeros(len(points))
        off = points - (a + part[:, None] * way)
        best = np.minimum(best, np.hypot(*off.T))
    return best


def between_points(path: Toolpath) -> float:
    """Return how far (mm) the curve of row 1 may be from the lines between its close points."""
    points = np.vstack([path.start[1, :2], path.control[1, :, :2], path.end[1, :2]])
    second = np.hypot(*np.diff(points, 2, axis=0).T).max()
    return float(0.75 * second / (len(FINE) - 1) ** 2) + 1e-9


def both_ways(path: Toolpath, lines: Toolpath) -> tuple[float, float]:
    """Return how far the curve of row 1 is from its lines, and they from it, by close points."""
    corners = np.vstack([lines.start[1, :2], lines.end[1:, :2]])
    points = curve(path.start[1, :2], path.control[1, :, :2], path.end[1, :2], FINE)
    there = float(apart(points, corners).max())
    middle = np.vstack([corners, (corners[1:] + corners[:-1]) / 2])
    back = float(apart(middle, points).max())
    return there, back


@pytest.mark.parametrize("chord_error", [0.001, 0.02, 0.5])
def test_lines_stay_within_the_chord_error(chord_error):
    most = 0.0
    for seed in range(40):
        path = one_spline(random.Random(seed))
        lines = segment(path, chord_error=chord_error)
        if len(lines) > 400:
            continue
        there, back = both_ways(path, lines)
        assert max(there, back) <= chord_error, seed
        owner = np.minimum(np.arange(len(lines)), 1)
        bound = float(gx.deviation(path, lines, owner).distance.max())
        assert max(there, back) - between_points(path) <= bound <= chord_error, seed
        most = max(most, there / chord_error)
    assert most > 0.5, "finer than it has to be"


def test_pieces_are_no_longer_than_asked():
    for seed in range(40):
        path = one_spline(random.Random(seed))
        lines = segment(path, chord_error=10.0, max_length=5.0)
        way = (lines.end - lines.start)[1:, :3]
        assert np.sqrt((way**2).sum(axis=1)).max() <= 5.0 + 1e-9, seed


def test_the_bound_is_one_of_any_lines():
    """Whatever lines are put beside a spline: the bound is no less than what is measured."""
    pick = np.random.default_rng(1)
    for seed in range(60):
        path = one_spline(random.Random(seed))
        lines = segment(path, chord_error=0.3)
        if len(lines) > 200:
            continue
        end = lines.end.copy()
        end[1:, :2] += pick.normal(0, pick.choice([0.001, 0.1, 3.0]), (len(end) - 1, 2))
        lines = lines.replace(end=np.asfortranarray(end))
        there, back = both_ways(path, lines)
        bound = gx.deviation(path, lines, np.minimum(np.arange(len(lines)), 1)).distance.max()
        assert max(there, back) - between_points(path) <= bound, seed


def test_splines_beside_splines():
    for seed in range(60):
        path = one_spline(random.Random(seed))
        owner = np.arange(len(path))
        assert gx.deviation(path, path, owner).distance.max() == 0.0
        shift = np.zeros((2, 2, 3))
        shift[1, seed % 2, seed % 3] = 0.7
        other = path.replace(control=path.control + shift)
        bound = float(gx.deviation(path, other, owner).distance.max())
        assert bound == pytest.approx(0.7)
        points = [curve(p.start[1, :3], p.control[1], p.end[1, :3], FINE) for p in (path, other)]
        assert np.sqrt(((points[0] - points[1]) ** 2).sum(axis=1)).max() <= bound


def test_what_is_no_line_is_far_from_a_spline():
    path = one_spline(random.Random(5))
    owner = np.arange(len(path))
    line = segment(path, chord_error=1e6)
    assert len(line) == len(path)
    assert np.isinf(gx.deviation(line, path, owner).distance[1]), "a spline for a line"
    higher = line.end.copy()
    higher[1, 2] += 0.5
    bound = gx.deviation(path, line.replace(end=higher), owner).distance[1]
    assert bound >= 0.5
    unknown = line.end.copy()
    unknown[1, 2] = np.nan
    assert np.isinf(gx.deviation(path, line.replace(end=unknown), owner).distance[1])
