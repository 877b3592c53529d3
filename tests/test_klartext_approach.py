"""APPR and DEP, with the worked examples of `../shared/reference/klartext.md`, section 5.

What is compared is the path of the tool's centre, as `cutter-comp` finds it: the manual says it of
that. The reference is written from the manual's pictures, in complex numbers.
"""

from __future__ import annotations

import cmath
import math
import re
from random import Random

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.cutter_comp.cutter_comp import Corners, CutterComp
from heidenhain_kit import DIALECT, program, read
from seeds_kit import LONG, some

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

ISO = default_registry().dialect("linuxcnc")


def centre(*lines, radius=10.0, start="L X-10 Y-10 Z+5 R0 FMAX"):
    """Return the ends of the moves of the tool's centre behind the start."""
    tools = {1: Tool(length=0.0, radius=radius)}
    text = program("TOOL CALL 1 Z", start, *lines).encode()
    made = Pipeline(
        DIALECT, ISO, (Absolute(), CutterComp(corners=Corners.ARC)), Reading({}, tools=tools)
    )
    path = gx.read(made.run(text).text, ISO, tools=tools).path
    return path.end[1:, :2], path


def near(*points):
    return pytest.approx(np.array(points), abs=2e-4)


SQUARE = ("L Y+95", "L X+95", "L Y+5", "L X+5")


def test_a_line_goes_on_along_the_contour_and_off_it():
    end, path = centre("APPR LT X+5 Y+5 LEN10 RL F100", *SQUARE, "DEP LT LEN10", "L X-30 Y-30 FMAX")
    assert end[:2] == near((-5, -5), (-5, 5))
    assert end[-3:-1] == near((5, -5), (-5, -5))
    assert path.kind[1] == 0  # as fast as the move before
    assert (end.min(), end.max()) == pytest.approx((-30, 105))


RIGHT = ("L X+20 Y+35", "L X+60 Y+35", "L X+60 Y-40 R0 FMAX")


@pytest.mark.parametrize(
    ("block", "points"),
    [
        ("LN X+10 Y+20 LEN+15", [(22.4808, 11.6795), (10, 20)]),
        ("CT X+10 Y+20 CCA180 R+10", [(26.6410, 8.9060), (10, 20)]),
        ("LCT X+10 Y+20 R10", [(20.9515, 4.8053), (10, 20)]),
        ("LT X+10 Y+20 LEN15", [(1.6795, 7.5192), (10, 20)]),
    ],
)
def test_the_ways_on_to_a_contour_with_a_tool_of_no_radius(block, points):
    end, _ = centre(f"APPR {block} RR F100", *RIGHT, radius=1e-9, start="L X+40 Y+10 Z+5 R0 F200")
    assert end[:2] == near(*points)


def test_a_line_goes_into_an_arc_and_out_of_one():
    end, path = centre("APPR LCT X+5 Y+5 R5 RL F100", *SQUARE, "DEP LCT X-40 Y-30 R5", "L IX+3")
    assert end[:2] == near((-5.2860, 3.3333), (-5, 5))
    assert path.centre[2, :2] == pytest.approx((-10, 5))
    assert path.kind[1:4].tolist() == [1, 3, 1]
    assert end[-2:] == near((-40, -30), (-37, -30))
    assert path.feed[1] == 100  # the manual: LCT goes to its arc at the feed of the block


def test_a_height_is_reached_beside_the_contour():
    lines = ("L X-40 Y-30 F100", "APPR LN X+5 Y+5 Z-3 LEN7 RL", *SQUARE, "L X-30 Y-30 R0 FMAX")
    _, path = centre(*lines)
    assert path.end[2:5].tolist() == [[-12, 5, 5], [-12, 5, -3], [-5, 5, -3]]


def test_a_place_may_be_said_by_an_angle():
    lines = ("CC X+5 Y+5", "APPR PLT PR+10 PA+90 LEN3 RL F90", "L Y+95", "L X-30 Y+99 R0 FMAX")
    end, _ = centre(*lines, start="L X-40 Y+0 Z+5 R0 FMAX")
    assert end[:3] == near((-5, 12), (-5, 15), (-5, 95))


@pytest.mark.parametrize(
    ("lines", "why"),
    [
        (("APPR LT X+5 Y+5 LEN10 R0 F100", *SQUARE), "without RL or RR"),
        (("APPR CT X+5 Y+5 R5 RL F100", *SQUARE), "takes CCA and R"),
        (("APPR CT X+5 Y+5 CCA90 R-5 RL F100", *SQUARE), "within the radius"),
        (("APPR LT X+5 Y+5 Z-5 LEN10 RL F100", *SQUARE), "another Z"),
        (("APPR LT X+5 Y+5 LEN10 RL F100", "CT X+9 Y+9"), "before anything but L or C"),
        (("APPR LT X+5 Y+5 LEN10 RL F100", *SQUARE, "DEP LT LEN5", "L IX+5 Y+3"), "counts from"),
        (("APPR LT X+5 Y+5 LEN10 RL F100", *SQUARE, "DEP LCT X+9 Y+9 Z+9 R5"), "another Z"),
        (("APPR LT X+5 Y+5 LEN10 RL F100", *SQUARE, "DEP LCT X+1 Y-9 R5"), "no line there"),
        (("APPR LCT X+5 Y+5 R5 RL", *SQUARE), "feed"),
        (("DEP LT LEN5",), "behind no element"),
        (("APPR LT X+5 Y+5 LEN-1 RL F100", *SQUARE), "0 or below"),
    ],
)
def test_what_is_not_certain_is_refused(lines, why):
    with pytest.raises(gx.GcxformError, match=why):
        centre(*lines)


def test_a_height_at_which_speed_is_not_known():
    block = "APPR LN X+5 Y+5 Z-3 LEN7 RL F100"
    for before in ("L X-40 Y-30 F50", "L X-40 Y-30 FMAX"):
        with pytest.raises(gx.GcxformError, match="another Z"):
            centre("L X+0 F70", before, block, *SQUARE)


def test_they_need_the_radius_of_the_tool():
    text = program("TOOL CALL 1 Z", "L X-9 Y-9 FMAX", "APPR LN X+5 Y+5 LEN2 RL F9", "L Y+9")
    with pytest.raises(gx.InputError, match="radius is not known"):
        read(text, tools={1: Tool(length=0.0, radius=math.nan)})


def test_they_stand_where_they_are_written_back():
    way = ("APPR LT X+5 Y+5 LEN10 RL F100", *SQUARE, "DEP LT LEN10", "L X-30 Y-30 R0 FMAX")
    text = program("L X-9 Y-9 R0 FMAX", *way)
    result = Pipeline(DIALECT, DIALECT, (Absolute(),), Reading({})).run(text.encode())
    assert result.text.decode() == text


def reference(shape, start, point, along, left, tool, size, turn):
    """Return where the centre meets the way on, where the contour, and about what it turns."""
    side = along * 1j * left
    first = point + side * tool
    if shape == "LT":
        return first - along * size, first, None
    if shape == "LN":
        return first + side * size, first, None
    about = first + side * size
    if shape == "CT":
        spin = left if size > 0 else -left
        return about + (first - about) * cmath.exp(-1j * spin * turn), first, about
    by = about - start  # the right angle is on the circle over the line to the centre
    far, reach = abs(by), math.sqrt(abs(by) ** 2 - size**2)
    for sign in (1, -1):
        touch = start + by / far * complex(reach, sign * size) * reach / far
        if ((touch - start) / (1j * left * (touch - about))).real > 0:
            return touch, first, about
    raise AssertionError


@pytest.mark.parametrize("seed", some(40 if not LONG else 20_000))
def test_they_go_as_by_another_reader(seed):
    """On to a line and off it: the way off is the way on of the line turned back."""
    draw = Random(seed)
    number = lambda low, high: round(draw.uniform(low, high), 3)  # noqa: E731
    a, b, begin, leaves = (complex(number(-50, 50), number(-50, 50)) for _ in range(4))
    tool, side = number(0.5, 6), draw.choice(("RL", "RR"))
    left = 1 if side == "RL" else -1
    ways, words = [], []
    for kinds in (("LT", "LN", "CT", "LCT"),) * 2:
        shape = draw.choice(kinds)
        size, turn = number(0.5, 9), number(5, 355)
        size = -size - tool if shape == "CT" and draw.random() < 0.3 else size
        said = {"LT": f"LEN{size}", "LN": f"LEN+{size}", "LCT": f"R{size}"}
        words.append(said.get(shape, f"CCA{turn} R{size}"))
        ways.append((shape, size, math.radians(turn)))
    xy = lambda p: f"X{p.real:+} Y{p.imag:+}"  # noqa: E731
    off = f" {xy(leaves)}" if ways[1][0] == "LCT" else ""
    lines = (
        f"APPR {ways[0][0]} {xy(a)} {words[0]} {side} F100",
        f"L {xy(b)}",
        f"DEP {ways[1][0]}{off} {words[1]} F70",
        "L X+99 Y+99 FMAX",
    )
    along = (b - a) / abs(b - a)
    try:
        end, path = centre(*lines, radius=tool, start=f"L {xy(begin)} Z+5 R0 F50")
    except gx.GcxformError as error:
        if not re.search("no line there|no arc|in the plane|tool.s radius of", str(error)):
            raise
        return
    meets, first, about = reference(ways[0][0], begin, a, along, left, tool, *ways[0][1:])
    parts, last, behind = reference(ways[1][0], leaves, b, -along, -left, tool, *ways[1][1:])
    wanted = [meets, first, last, parts] + ([leaves] if off else []) + [99 + 99j]
    found = [complex(*p) for p in end]
    found = [p for k, p in enumerate(found) if k == 0 or abs(p - found[k - 1]) > 1e-6]
    assert found == pytest.approx(wanted, abs=5e-4), lines
    if about is not None:
        assert complex(*path.centre[2, :2]) == pytest.approx(about, abs=2e-3), lines
    if behind is not None:
        assert complex(*path.centre[4, :2]) == pytest.approx(behind, abs=2e-3), lines
    wanted_feed = 100.0 if ways[0][0] == "LCT" else 50.0
    assert path.feed[1:6].tolist()[:4] == [wanted_feed, 100, 100, 70], lines
