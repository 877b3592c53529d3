"""DL and DR of TOOL CALL: the length and the radius are those of the table and theirs.

The offset is R + DR of TOOL CALL + DR of the table (iTNC 530, p. 183).
"""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.passes.absolute import Absolute
from gcxform_plugins.passes.cutter_comp.cutter_comp import Corners, CutterComp
from heidenhain_kit import DIALECT, TOOLS, program, read

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

ISO = default_registry().dialect("linuxcnc")
MOVES = ("L X+1 Y+1 Z+5 FMAX",)


@pytest.mark.parametrize(("unit", "mm"), [("MM", 1.0), ("INCH", 25.4)])
def test_the_length_of_a_tool_is_longer_by_dl(unit, mm):
    def height(delta):
        return read(program(f"TOOL CALL 2 Z {delta}", *MOVES, unit=unit), tools=TOOLS).end[0, 2]

    assert height("DL+0.5") - height("") == pytest.approx(0.5 * mm)
    assert height("DL-0,25 DR+1") - height("DL+0") == pytest.approx(-0.25 * mm)


def test_it_ends_with_the_tool():
    path = read(program("TOOL CALL 2 Z DL+0.5", "TOOL CALL 2 Z", *MOVES), tools=TOOLS)
    assert path.end[0, 2] == read(program("TOOL CALL 2 Z", *MOVES), tools=TOOLS).end[0, 2]


def offset(delta, *lines, unit="MM"):
    """Return how far beside a contour along X the centre of a tool of 10 mm goes."""
    tools = {1: Tool(length=0.0, radius=10.0)}
    lines = (f"TOOL CALL 1 Z {delta}", "L X-30 Y-30 Z+5 R0 FMAX", *lines)
    passes = Absolute(), CutterComp(corners=Corners.ARC)
    made = Pipeline(DIALECT, ISO, passes, Reading({}, tools=tools))
    path = gx.read(made.run(program(*lines, unit=unit).encode()).text, ISO, tools=tools).path
    return np.round(path.end[:, :2], 3).tolist()


@pytest.mark.parametrize(("delta", "radius"), [("", 10), ("DR+0.5", 10.5), ("DR-2.25", 7.75)])
def test_a_contour_is_beside_it_by_the_radius_with_dr(delta, radius):
    contour = "L X+0 Y+0 RL F100", "L X+100", "L X+100 Y-50 R0"
    assert offset(delta, *contour)[1:3] == [[0, radius], [100, radius]]
    away = "APPR LN X+0 Y+0 LEN5 RL F100", "L X+100", "L X+100 Y-50 R0"
    assert offset(delta, *away)[1:3] == [[0, radius + 5], [0, radius]]


def test_dr_is_in_inches_where_the_program_is():
    contour = "L X+0 Y+0 RL F100", "L X+10", "L X+10 Y-5 R0"
    assert offset("DR+0.1", *contour, unit="INCH")[1] == [0, pytest.approx(12.54)]
