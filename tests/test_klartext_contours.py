"""RND, CHF and CT, with the worked examples of `../shared/reference/klartext.md`, section 3.

Where a rounding is, is what any two lines and a circle that touches them say (TNC 620, p. 291); CT
begins in the direction in which the element before it ends (iTNC 530, 606 42x, p. 225).
"""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from heidenhain_kit import DIALECT, TOOLS, program, read
from reference import klartext_contours
from seeds_kit import LONG, some

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline

CORNER = ("L X+10 Y+40 F100", "L X+40 Y+25", "RND R5", "L X+10 Y+5")
TANGENT = ("L X+0 Y+25 F100", "L X+25 Y+30", "CT X+45 Y+20")
CHAMFER = ("L X+0 Y+0 F100", "L X+40", "CHF 5", "L Y+20")


def plane(lines):
    path = read(program(*lines), tools=TOOLS)
    return path, path.end[:, :2], path.centre[:, :2]


def test_a_corner_is_rounded():
    path, end, centre = plane(CORNER)
    assert end[1:3] == pytest.approx(np.array([(32.2937, 28.8531), (32.8311, 20.2208)]), abs=1e-4)
    assert centre[2] == pytest.approx((30.0576, 24.3810), abs=1e-4)
    assert path.kind.tolist() == [1, 1, 2, 1]


def test_an_arc_goes_on_where_the_line_points():
    path, _, centre = plane(TANGENT)
    assert centre[2] == pytest.approx((28.5714, 12.1429), abs=1e-4)
    assert math.degrees(path.sweep[2]) == pytest.approx(75.750, abs=1e-3)


def test_an_arc_goes_on_where_an_arc_ends():
    path, _, centre = plane(("L X+0 Y+0 F100", "CC X+10 Y+0", "C X+10 Y+10 DR-", "CT X+30 Y+0"))
    assert path.kind[2] == 2
    assert math.degrees(path.sweep[2]) == pytest.approx(53.130, abs=1e-3)
    assert centre[2] == pytest.approx((10.0, -15.0), abs=1e-6)


def test_a_chamfer_cuts_both_lines_along_themselves():
    _, end, _ = plane(CHAMFER)
    assert end.tolist() == [[0, 0], [35, 0], [40, 5], [40, 20]]


def test_steps_count_from_the_corner_and_f_of_a_corner_is_its_own():
    lines = ("L X+0 Y+0 F100", "L X+40", "RND R5 F50", "L IY+20", "RND R3", "L IX-10 IY+5")
    path, end, _ = plane(lines)
    assert end[-1].tolist() == [30, 25]
    assert path.feed.tolist() == [100, 100, 50, 100, 100, 100]


@pytest.mark.parametrize("seed", some(40))
def test_a_rounding_touches_both_lines(seed):
    draw = Random(seed)
    a, b, c = ([round(draw.uniform(-50, 50), 3) for _ in "XY"] for _ in range(3))
    radius = round(draw.uniform(0.1, 3), 3)
    lines = [f"L X{p[0]:+} Y{p[1]:+}" for p in (a, b, c)]
    lines.insert(2, f"RND R{radius}")
    try:
        path, end, centre = plane((f"{lines[0]} F100", *lines[1:]))
    except gx.InputError:
        pytest.skip("longer than a line")
    t, u, v = (np.array(p) for p in (a, b, c))
    for one, other, touch in ((t, u, end[1]), (u, v, end[2])):
        along = (other - one) / np.hypot(*(other - one))
        assert np.dot(touch - centre[2], along) == pytest.approx(0, abs=1e-5)
        assert np.hypot(*(touch - centre[2])) == pytest.approx(radius, abs=1e-6)
        by = touch - one
        assert along[0] * by[1] - along[1] * by[0] == pytest.approx(0, abs=1e-5)
    assert path.sweep[2] < math.pi


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (("L X+0 Y+0 F100", "L X+40", "RND R50", "L Y+20"), "longer"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5", "L X+60"), "do not turn"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5 FU0.2", "L Y+20"), "its size, and F"),
        (("L X+0 Y+0 F100", "L X+40", "CHF 5 FMAX", "L Y+20"), "its size, and F"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5 R6", "L Y+20"), "its size, and F"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5", "L X+10"), "turn back"),
        (("L X+0 Y+0 F100", "L X+40 FMAX", "RND R5", "L Y+20"), "at the feed"),
        (("L X+0 Y+0 F100", "L X+40 Z+1", "RND R5", "L Y+20"), "in X and Y"),
        (("L X+0 Y+0 F100", "L X+40 M9", "RND R5", "L Y+20"), "M function"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5 M8", "L Y+20"), "M function"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5", "LBL 1", "L Y+20"), "anything but a line"),
        (("L X+0 Y+0 F100", "L X+40", "RND R5", "L Y+20 M91"), "M91"),
        (("TOOL CALL 1 Z", "L X+0 Y+0 F100", "L X+40", "RND R5", "L Y+20 RL"), "side"),
        (("L X+0 Y+0 F100", "CC X+0 Y+5", "C X+0 Y+10 DR+", "RND R5", "L X+9"), "line in X and Y"),
        (("L X+0 Y+0 F100", "RND R5", "L X+4"), "where X stands"),
        (("L X+0 Y+0 F100", "L X+4", "CT X+9"), "straight on"),
        (("L X+0 Y+0 F100", "L X+4", "L Z+5", "CT X+9 Y+9"), "no direction"),
        (("L X+0 Y+0 F100", "L X+4 FMAX", "CT X+9 Y+9"), "no direction"),
        (("CC X+45 Y+25", *TANGENT, "C X+45 Y+20 DR+"), "needs a CC"),
    ],
)
def test_what_is_not_certain_is_refused(lines, why):
    with pytest.raises(gx.InputError, match=why):
        plane(lines)


@pytest.mark.parametrize("lines", [CORNER, TANGENT, CHAMFER])
def test_they_stand_where_they_are_written_back(lines):
    text = program(*lines)
    result = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading({})).run(text.encode())
    assert result.text.decode() == text


def drawn(seed):
    """Return a contour: lines, corners between them, arcs that go on, and circles."""
    draw = Random(seed)
    at = [draw.uniform(-20, 20), draw.uniform(-20, 20)]
    lines = [f"L X{at[0]:+.3f} Y{at[1]:+.3f} F100"]
    for _ in range(draw.randint(2, 9)):
        words = [f"{draw.choice(('', 'I'))}{axis}{draw.uniform(-30, 30):+.3f}" for axis in "XY"]
        words = draw.choice((words, words, words[:1], words[1:]))
        feed = draw.choice(("", "", f" F{draw.randint(50, 500)}"))
        kind = draw.choice(("L", "L", "L", "CT", "RND", "CHF"))
        if kind in ("RND", "CHF"):
            size = f"{draw.uniform(0.05, 4):.3f}"
            lines.append(f"{kind} {'R' * (kind == 'RND')}{size}{feed}")
            feed, kind = "", "L"
        lines.append(" ".join([kind, *words]) + feed)
    return lines


def found(lines):
    """Return the elements of a contour as the package reads them, or why it refuses them."""
    try:
        path = read(program(*lines), start={"X": 0.0, "Y": 0.0, "Z": 0.0})
    except gx.InputError as error:
        return str(error)
    rows = zip(path.kind, path.end, path.centre, path.feed, strict=True)
    return [(int(k), complex(*e[:2]), complex(*c[:2]), float(f)) for k, e, c, f in rows]


@pytest.mark.parametrize("seed", some(40 if not LONG else 20_000))
def test_contours_are_those_of_another_reader(seed):
    lines = drawn(seed)
    try:
        wanted = klartext_contours.run(lines)
    except klartext_contours.DoubtfulError:
        wanted = None
    got = found(lines)
    if isinstance(got, str) or wanted is None:
        assert isinstance(got, str) or wanted is not None, lines
        return
    assert [row[0] for row in got] == [row.kind for row in wanted], lines
    for (_, end, centre, feed), row in zip(got, wanted, strict=True):
        assert end == pytest.approx(row.end, abs=1e-5), lines
        assert feed == row.feed, lines
        assert row.centre is None or centre == pytest.approx(row.centre, rel=1e-4, abs=1e-3), lines
