"""Real programs that switch with M428 and M429, as LinuxCNC ships them, beside its own kinematics.

LinuxCNC's interpreter reads the program of tips, in which the codes stand for nothing that moves,
and the program of axes that `rtcp` has made of it. Where the axes of the second take the tip is
what the forward function of LinuxCNC's module says, with the tool length that is in force on each
line; it has to be where the first is. (Issue 5, "a real control".)
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.controls.linuxcnc.hal import machine_of
from oracles import rs274
from oracles.linuxcnc_kins import kinematics
from rtcp_kit import ROUNDED, aside, between
from test_real_control import AXES, CHECKED, LENGTH, NUMBER, PRINTED, ZERO

import gcxform as gx
from gcxform.machine.text import to_toml
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

DEMOS = Path("corpus/programs/linuxcnc/LinuxCNC-linuxcnc/vismach/5axis/table-rotary-tilting/demos")
TOLERANCE = 0.01
NAMES = {"boat-xyzbc.ngc": "xyzbc-trt-kins", "boat-xyzac.ngc": "xyzac-trt-kins"}
ROTARY = AXES | {"xyzbc-trt-kins": "XYZBC"}
PINS = {"x-rot-point": 12.0, "y-rot-point": 1.25, "z-rot-point": 60.0, "z-offset": -19.75}
OFFSET = {"xyzbc-trt-kins": {"x-offset": 7.5}, "xyzac-trt-kins": {"y-offset": -4.75}}
CONTROL = '[control]\ntip-on = "M428"\ntip-off = "M429"\n'
PIPELINE = """format = 1
[input]
dialect = "linuxcnc"
start = {{ {start} }}
[machine]
file = "machine.toml"
[[pass]]
use = "absolute"
[[pass]]
use = "segment"
chord-error = "1 um"
[[pass]]
use = "rtcp"
tolerance = {tolerance}
rapids = "{rapids}"
tip-codes = "read"
[output]
decimals = 4
"""


def boat(shared, name):
    """Return a program as it is published."""
    return (shared / DEMOS / name).read_bytes()


def steps_of(folder, name, rapids="ends"):
    """Return the pipeline for a machine of LinuxCNC that begins at its own zero."""
    module, start = NAMES[name], [*-ZERO, 0.0, 0.0]
    machine = to_toml(machine_of(module, PINS | OFFSET[module], Path(name))) + CONTROL
    machine += "[axis.X]\n[axis.Y]\n[axis.Z]\n[work-offset.G54]\n" + "".join(
        f"{a} = {v}\n" for a, v in zip("XYZ", ZERO, strict=True)
    )
    (folder / "machine.toml").write_text(f"{machine}[tool.1]\nlength = {LENGTH!r}\n")
    said = ", ".join(f"{a} = {v}" for a, v in zip(ROTARY[module], start, strict=True))
    text = PIPELINE.format(start=said, tolerance=TOLERANCE, rapids=rapids)
    (folder / "p.toml").write_text(text)
    return replace(gx.Pipeline.load(folder / "p.toml"), stamp=False)


def moves_of(text, letters):
    """Return the moves of a program, and where they end (n, 5) in machine coordinates.

    The codes that switch are left out, and the tool is the one of the table with its length.
    """
    lines = re.sub(r"M42[89]|%", "", text.decode()).replace("H1 ", f"H{NUMBER} ").split("\n")
    lines[0] = "G10 L2 P1 " + " ".join(f"{a}{v}" for a, v in zip("XYZ", ZERO, strict=True))
    moves = rs274.run("\n".join(lines).encode()).moves
    ends = np.array([[move.machine[1][a] for a in letters] for move in moves])
    return moves, ends


def lengths_of(text):
    """Return the tool length in force on each line of a program."""
    found, length = [], 0.0
    for line in text.decode().splitlines():
        length = LENGTH if "G43" in line else 0.0 if "G49" in line else length
        found.append(length)
    return np.array(found)


def control_of(name):
    """Return LinuxCNC's module as the machine has it."""
    module = NAMES[name]
    found = kinematics(module)
    for pin, value in (PINS | OFFSET[module]).items():
        found.set(f"{module}.{pin}", value)
    return found


def tips(control, name, joints, length):
    """Return where the control says that it is (n, 3), with a tool length."""
    control.set(f"{NAMES[name]}.tool-offset", float(length))
    return control.forward(joints)[:, :3]


def apart(control, name, text, result):
    """Return how far tips are at most from their lines (mm), and at the ends of rapids."""
    letters = ROTARY[NAMES[name]]
    (source, wanted), (moves, joints) = moves_of(text, letters), moves_of(result.text, letters)
    owner, length = [result.source_map[move.line - 1] for move in moves], lengths_of(text)
    number = {move.line - 1: at for at, move in enumerate(source)}
    before, cut, ends = np.vstack([np.zeros(5), joints]), 0.0, 0.0
    for k, (line, move) in enumerate(zip(owner, moves, strict=True)):
        at = number[line]
        begin = wanted[at - 1, :3] if at else np.zeros(3)
        way = between(before[k], joints[k], CHECKED)
        told = tips(control, name, way, length[line])
        if move.kind == "LINE":
            cut = max(cut, away(told, source[at], begin, wanted[at, :3]))
        if [*owner, None][k + 1] != line:
            ends = max(ends, float(np.linalg.norm(told[-1] - wanted[at, :3])))
            assert joints[k, 3:] == pytest.approx(wanted[at, 3:], abs=1e-3)
    assert owner == sorted(owner)
    assert set(owner) == set(number)  # each of the moves is there
    return cut, ends


def away(points, move, begin, end):
    """Return how far (mm) points are at most from a line, or from the circle of an arc."""
    if move.kind == "LINE":
        return float(aside(points, begin, end).max())
    assert move.plane == "XY"
    spokes = points[:, :2] - [move.machine[2][a] for a in "XY"]
    return float(np.abs(np.linalg.norm(spokes, axis=1) - np.linalg.norm(spokes[-1])).max())


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("name", NAMES)
def test_the_whole_boat_is_made(tmp_path, shared, name):
    """Unchanged, with every move in it: the tip on its lines, the ends of rapids where they are."""
    text = boat(shared, name)
    result = steps_of(tmp_path, name).run(text, "full")
    assert result.certificate.verified
    control = control_of(name)
    cut, ends = apart(control, name, text, result)
    assert ends <= 2 * ROUNDED + PRINTED
    assert 0.5 * TOLERANCE <= cut <= TOLERANCE + ROUNDED + PRINTED
    assert b"M42" not in result.text


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_another_length_would_be_seen(tmp_path, shared):
    """What the test must be able to see: the length called one line later."""
    name = "boat-xyzbc.ngc"
    text, result = boat(shared, name), steps_of(tmp_path, name).run(boat(shared, name))
    later = text.replace(b"G43 H1 Z5.0", b"Z5.0").replace(b"Z3.573", b"G43 H1 Z3.573", 1)
    _, ends = apart(control_of(name), name, later, result)
    assert ends > 1.0


@pytest.mark.parametrize("size", [1000, 5000])
def test_windows_of_the_boat_are_alike(tmp_path, shared, size):
    """The length and what is followed go from window to window."""
    name, parts = "boat-xyzbc.ngc", []
    text, steps = boat(shared, name), steps_of(tmp_path, name)
    Run(steps, Source.of_bytes(text), "on").over(Output(parts.append, None), abs, size)
    assert b"".join(parts) == steps.run(text).text


def test_without_rapids_by_their_ends_the_length_is_refused(tmp_path, shared):
    """The first rapid turns axes, and behind it the length changes."""
    name = "boat-xyzbc.ngc"
    with pytest.raises(gx.InputError, match=r"GX330.*\n?.*rapid") as error:
        steps_of(tmp_path, name, "refuse").run(boat(shared, name))
    assert error.value.diagnostics[0].where.line in (11, 12)
