"""A real control: LinuxCNC's interpreter and kinematics modules move what gcxform has converted.

On one side LinuxCNC reads the program of tips and follows the tip, by definition in straight lines
between the points that its interpreter gives. On the other it reads the program that `rtcp` has
made of it and moves all joints in proportion, as it does without following the tip; where that
takes the tip is what the forward function of its own module says. The realtime modules are those
installed, loaded without LinuxCNC around them (`oracles/linuxcnc_kins.py`). (Issue 5, "a real
control", for xyzac-trt and 5axiskins.)
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.controls.linuxcnc.hal import machine_of
from oracles import rs274
from oracles.linuxcnc_kins import kinematics
from rtcp_kit import ROUNDED, aside, between

import gcxform as gx
from gcxform.machine.text import to_toml

DOME = Path(__file__).parents[1] / "examples" / "rtcp-loop" / "dome.nc"
NUMBER = 97
LENGTH = 25.4 * rs274.tool(NUMBER)[2]  # mm
ZERO = np.array([-41.25, 17.5, 33.125])  # G54
PINS = {
    "xyzac-trt-kins": {
        "x-rot-point": 12.0,
        "y-rot-point": 1.25,
        "z-rot-point": 60.0,
        "x-offset": 7.5,
        "y-offset": -4.75,
        "z-offset": -19.75,
    },
    "5axiskins": {"pivot-length": 250.0},
}
AXES = {"xyzac-trt-kins": "XYZAC", "5axiskins": "XYZBC"}
CHECKED = 9  # places of a block
PRINTED = 2e-4  # mm, of four decimals as the interpreter prints them
PIPELINE = """format = 1
[input]
dialect = "linuxcnc"
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
rapids = "ends"
[output]
decimals = {decimals}
"""


def program(name):
    """Return the dome for this machine: its tilting axis, its tool, its work offset set."""
    lines = DOME.read_text().splitlines()[2:-1]  # without the signs and the number of a FANUC
    text = "\n".join(lines).replace("H1 ", f"H{NUMBER} ").replace("T1 M6\n", "")
    if name == "5axiskins":
        text = text.replace("A", "B")
    return text.encode() + b"\n"


def moved(text, name):
    """Return where LinuxCNC's interpreter takes X, Y, Z and two angles (n, 5), and what moves are.

    G54 is set as the machine file has it.
    """
    set_offset = "G10 L2 P1 " + " ".join(f"{a}{v}" for a, v in zip("XYZ", ZERO, strict=True))
    found = rs274.run(set_offset.encode() + b"\n" + text)
    ends = [[move.machine[1][a] for a in AXES[name]] for move in found.moves]
    return np.array(ends), [move.kind for move in found.moves]


def module(name):
    """Return LinuxCNC's module as this machine has it, with the tool."""
    found = kinematics(name)
    for pin, value in PINS[name].items():
        found.set(f"{name}.{pin}", value)
    if name == "5axiskins":  # there the pivot is meant with the tool
        found.set("5axiskins.pivot-length", PINS[name]["pivot-length"] + LENGTH)
    else:
        found.set(f"{name}.tool-offset", LENGTH)
    return found


def converted(folder, name, tolerance, decimals=4):
    """Return the program of axes, and the lines that its blocks came from."""
    machine = to_toml(machine_of(name, PINS[name], Path(name)))
    machine += "[axis.X]\n[axis.Y]\n[axis.Z]\n[work-offset.G54]\n" + "".join(
        f"{a} = {v}\n" for a, v in zip("XYZ", ZERO, strict=True)
    )
    (folder / "machine.toml").write_text(f"{machine}[tool.{NUMBER}]\nlength = {LENGTH!r}\n")
    said = PIPELINE.format(tolerance=tolerance, decimals=decimals)
    (folder / "p.toml").write_text(said)
    return gx.Pipeline.load(folder / "p.toml").run(program(name), "full")


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("tolerance", [0.01, 0.002])
@pytest.mark.parametrize("name", AXES)
def test_linuxcnc_moves_the_tip_along_the_program(tmp_path, name, tolerance):
    """The tip is within the tolerance of its lines at nine places of every block."""
    control = module(name)
    result = converted(tmp_path, name, tolerance)
    (wanted, _), (joints, kinds) = moved(program(name), name), moved(result.text, name)
    owners = np.searchsorted(*blocks_of(wanted, joints), side="left")
    worst = 0.0
    for k in [k for k in range(1, len(joints)) if kinds[k] == "LINE"]:
        told = control.forward(between(joints[k - 1], joints[k], CHECKED))
        line = wanted[owners[k] - 1, :3], wanted[owners[k], :3]
        worst = max(worst, float(aside(told[:, :3], *line).max()))
    assert worst <= tolerance + ROUNDED + PRINTED
    assert worst >= 0.5 * tolerance  # and it is used
    assert len(joints) > 3 * len(wanted)


def blocks_of(wanted, joints):
    """Return at which block of the output each move of the program ends, and all block numbers.

    The angles of the program come back in the output, in their order; where only X, Y, Z move the
    output is as long as the program.
    """
    ends, place = [], 0
    for k, pose in enumerate(wanted):
        turns = k and np.abs(pose[3:] - wanted[k - 1, 3:]).max() > 1e-9
        while turns and np.abs(joints[place, 3:] - pose[3:]).max() > 1e-3:
            place += 1
        ends.append(place)
        place += 1
    assert ends[-1] == len(joints) - 1
    return np.array(ends), np.arange(len(joints))


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("name", AXES)
def test_linuxcnc_puts_its_joints_where_the_converted_program_does(tmp_path, name):
    """Following the tip, at the points of the program: its own inverse, against our joints."""
    control = module(name)
    wanted, _ = moved(program(name), name)
    joints, _ = moved(converted(tmp_path, name, 0.01).text, name)
    ends, _ = blocks_of(wanted, joints)
    world = np.zeros((len(wanted), 9))
    world[:, :3] = wanted[:, :3]
    world[:, ["XYZABC".index(letter) for letter in AXES[name][3:]]] = wanted[:, 3:]
    theirs = control.inverse(world)[:, :5]
    away = np.abs(theirs[:, :3] - joints[ends, :3]).max()
    assert away <= 0.0005 + PRINTED
    assert np.abs(theirs[:, :3] - wanted[:, :3]).max() > 50.0  # there is something to convert


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_uncut_blocks_would_leave_their_lines():
    """What the test must be able to see: the program itself, moved joint by joint."""
    name = "xyzac-trt-kins"
    control, (wanted, kinds) = module(name), moved(program(name), name)
    world = np.zeros((len(wanted), 9))
    world[:, :3], world[:, [3, 5]] = wanted[:, :3], wanted[:, 3:]
    joints = control.inverse(world)[:, [0, 1, 2, 3, 5]]
    joints = np.column_stack([joints[:, :3], wanted[:, 3:]])
    worst = 0.0
    for k in [k for k in range(1, len(joints)) if kinds[k] == "LINE"]:
        told = control.forward(between(joints[k - 1], joints[k], CHECKED))
        worst = max(worst, float(aside(told[:, :3], wanted[k - 1, :3], wanted[k, :3]).max()))
    assert worst > 0.3
