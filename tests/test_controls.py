"""Kinematics taken over from LinuxCNC, against its own modules where installed, and from FANUC."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
import pytest
from cli_kit import call
from gcxform_plugins.controls.fanuc import FanucFiles
from gcxform_plugins.controls.linuxcnc.hal import machine_of, read_hal
from gcxform_plugins.controls.siemens import SiemensFiles
from oracles.linuxcnc_kins import kinematics

import gcxform as gx
from gcxform.cli import machine as verb
from gcxform.diagnostics import FileError, UsageError
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Axis, Machine, Tool
from gcxform.machine.text import to_toml
from gcxform.plugin.contributions import Offered
from gcxform.plugin.registry import Registry

COUNT = 1000
TRT = {
    "x-rot-point": 12.0,
    "y-rot-point": 1.25,
    "z-rot-point": 60.0,
    "x-offset": 7.5,
    "y-offset": -4.75,
    "z-offset": -19.75,
}
LENGTH = 120.0
WORLD = {"A": 3, "B": 4, "C": 5}


def poses():
    draw = np.random.default_rng(8)
    return draw.uniform(-300.0, 300.0, (COUNT, 3)), draw.uniform(-170.0, 170.0, (COUNT, 2))


def module(name, pins):
    """Return a module of LinuxCNC with its pins, and its machine as it is taken over."""
    found = kinematics(name)
    for pin, value in pins.items():
        found.set(f"{name}.{pin}", value)
    return found, machine_of(name, pins, Path(name))


def world(tip, angles, letters):
    found = np.zeros((len(tip), 9))
    found[:, :3] = tip
    found[:, [WORLD[letter] for letter in letters]] = angles
    return found


def flagged(conventional):
    """Whether the installed modules know `conventional-directions`: pins are made at loading."""
    return "xyzac-trt-kins.conventional-directions" in kinematics("xyzac-trt-kins").pins() or (
        not conventional
    )


# --- LinuxCNC (K8) ---


@pytest.mark.parametrize("conventional", [0.0, 1.0])
@pytest.mark.parametrize("name", ["xyzac-trt-kins", "xyzbc-trt-kins"])
def test_trunnions_as_linuxcnc_moves_them(name, conventional):
    """K8: import of trt definitions with either direction flag reproduces their forward."""
    if not flagged(conventional):
        pytest.skip("the LinuxCNC installed has no conventional-directions")
    found, machine = module(name, TRT)
    if conventional:
        found.set(f"{name}.conventional-directions", True)
        machine = machine_of(name, TRT | {"conventional-directions": 1.0}, Path(name))
    found.set(f"{name}.tool-offset", LENGTH)
    linear, angles = poses()
    tip, _ = chain_of(machine, Tool(length=LENGTH)).forward(linear, angles)
    tip[:, 2] += LENGTH  # LinuxCNC tells where the gauge point would be
    told = found.forward(np.hstack([linear, angles]))
    assert np.abs(told[:, :3] - tip).max() < 1e-9
    if conventional or name == "xyzac-trt-kins":  # the inverse of xyzbc is wrong in some releases
        back = found.inverse(world(tip, angles, machine.table))
        assert np.abs(back[:, :3] - linear).max() < 1e-9


def test_the_flag_of_a_trunnion_turns_its_table_around():
    """K8, where the installed modules have no flag: the sense of all angles is the other one."""
    found, machine = module("xyzac-trt-kins", TRT)
    other = machine_of("xyzac-trt-kins", TRT | {"conventional-directions": 1.0}, Path("x"))
    found.set("xyzac-trt-kins.tool-offset", 0.0)
    linear, angles = poses()
    told = found.forward(np.hstack([linear, angles]))
    tip, _ = chain_of(other).forward(linear, -angles)
    assert np.abs(told[:, :3] - tip).max() < 1e-9
    assert [axis.sign for axis in other.axes.values()] == [-1, -1]
    assert [axis.sign for axis in machine.axes.values()] == [1, 1]


def test_the_fork_head_as_linuxcnc_moves_it():
    """K8 for 5axiskins: its B is left-handed."""
    found, machine = module("5axiskins", {"pivot-length": 250.0})
    linear, angles = poses()
    tip, _ = chain_of(machine).forward(linear, angles)
    told = found.forward(np.hstack([linear, angles[:, ::-1]]))
    assert np.abs(told[:, :3] - tip).max() < 1e-9
    back = found.inverse(world(tip, angles, machine.head))
    assert np.abs(back[:, :3] - linear).max() < 1e-9


def test_maxkins_as_linuxcnc_inverts_it():
    """K8 for maxkins: its forward is right only where C is 0, so its inverse is asked."""
    _, machine = module("maxkins", {"pivot-length": 250.0})
    found = kinematics("maxkins")
    linear, angles = poses()
    chain = chain_of(machine)
    tip, _ = chain.forward(linear, angles)
    back = found.inverse(world(tip, angles, chain.letters))
    assert np.abs(back[:, :3] - linear).max() < 1e-9
    angles[:, 0] = 0.0
    tip, _ = chain.forward(linear, angles)
    joints = np.hstack([linear, np.zeros((COUNT, 1)), angles[:, ::-1]])
    assert np.abs(found.forward(joints)[:, :3] - tip).max() < 1e-9


HAL = """# a machine
loadrt [KINS]KINEMATICS
net tool motion.tooloffset.z => xyzac-trt-kins.tool-offset
setp xyzac-trt-kins.x-rot-point 12 # from the drawing
HALCMD = net :y-offset xyzac-trt-kins.y-offset gui.y-offset
HALCMD = sets :y-offset -4.75
setp xyzac-trt-kins.conventional-directions TRUE
"""


def hal(folder, text):
    (folder / "mill.hal").write_text(text)
    return folder / "mill.hal"


def test_a_hal_file(tmp_path):
    machine = read_hal(hal(tmp_path, HAL), "mm")
    assert (machine.table, machine.head) == (("A", "C"), ())
    assert machine.axes["A"] == Axis(direction=(1.0, 0, 0), point=(12.0, -4.75, 0), sign=-1)
    assert machine.axes["C"] == Axis(direction=(0, 0, 1.0), point=(12.0, 0, 0), sign=-1)
    inches = read_hal(hal(tmp_path, HAL), "in")
    assert inches.axes["A"].point == (304.8, -120.65, 0.0)


def test_a_fork_head_in_a_hal_file(tmp_path):
    machine = read_hal(hal(tmp_path, "setp 5axiskins.pivot-length 10\n"), "in")
    assert (machine.table, machine.head) == ((), ("C", "B"))
    assert machine.axes["B"].point == (0.0, 0.0, 254.0)


def test_the_machine_file_that_is_written_reads_back(tmp_path):
    machine = read_hal(hal(tmp_path, HAL), "mm")
    (tmp_path / "m.toml").write_text(to_toml(machine, ["a comment"]))
    back = load_machine(tmp_path / "m.toml")
    assert chain_of(back) == chain_of(machine)
    assert back.name == "xyzac-trt-kins"


def test_all_of_an_axis_reads_back(tmp_path):
    axes = {
        "X": Axis(limits=(-300.0, 0.1), max_speed=9000.0),
        "C": Axis(direction=(0, 0, 1.0), point=(0.1, 1 / 3, 9), sign=1, wrap=360.0),
    }
    machine = Machine(
        file=tmp_path / "m.toml",
        name='a "mill"',
        table=("C",),
        gauge_point=(0, 0, 1 / 7),
        axes=axes,
    )
    machine.file.write_text(to_toml(machine), "utf-8")
    assert load_machine(machine.file) == machine


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("x-rot-point 12", "x-rot-point [TRT]X", 4, "'[TRT]X' is not a number"),
        ("x-rot-point 12", "x-rotpoint 12", 4, "x-rotpoint is not a pin that is known"),
        ("setp xyzac-trt-kins.x-rot-point 12", "linksp s xyzac-trt-kins.x-rot-point", 4, "by some"),
        ("sets :y-offset", "sets :other", 5, "the signal :y-offset of xyzac-trt-kins.y-offset has"),
        ("TRUE", "1\nsetp xyzac-trt-kins.tool-offset 5", 8, "tool-offset is the length of a tool"),
        ("TRUE", "1\nsetp 5axiskins.pivot-length 5", 0, "here is 5axiskins and xyzac-trt-kins"),
        (HAL, "loadrt trivkins\n", 0, "here is none"),
        (HAL, "loadrt 5axiskins\n", 0, "5axiskins.pivot-length is not set"),
        (HAL, "[KINS]\nKINEMATICS = maxkins\n", 0, "maxkins.pivot-length is not set"),
    ],
)
def test_a_hal_file_that_is_refused(tmp_path, old, new, line, message):
    assert old in HAL
    with pytest.raises(UsageError) as caught:
        read_hal(hal(tmp_path, HAL.replace(old, new)), "mm")
    found = caught.value.diagnostics[0]
    assert found.code == "GX454"
    assert found.where.line == line
    assert message in found.message


def test_a_file_that_is_not_there(tmp_path):
    for read in (
        lambda p: read_hal(p, "mm"),
        FanucFiles().kinematics,
        SiemensFiles("A,C").kinematics,
    ):
        with pytest.raises(FileError, match="cannot read"):
            read(tmp_path / "none")
    (tmp_path / "binary").write_bytes(b"\xff\xfe")
    with pytest.raises(FileError, match="not UTF-8"):
        read_hal(tmp_path / "binary", "mm")


# --- FANUC ---

TABLES = """%
N19680 P12
N19682 P1
N19687 P3
N19684 P1 (left-handed)
19689 = 1
N19700 P5.0
N19701 P-32.
N19702 P-95.0
N19704 P12.0
N19705 P35.0
N1320 P500.0
"""


def fanuc(folder, text):
    (folder / "parameters.txt").write_text(text)
    return FanucFiles().kinematics(folder / "parameters.txt")


def test_two_tables(tmp_path):
    machine = fanuc(tmp_path, TABLES)
    assert (machine.table, machine.head) == (("A", "C"), ())
    assert machine.axes["A"] == Axis(direction=(1.0, 0, 0), point=(5.0, -32.0, -95.0), sign=-1)
    assert machine.axes["C"] == Axis(direction=(0, 0, 1.0), point=(5.0, -20.0, -60.0), sign=-1)


def test_a_list_as_the_control_punches_it(tmp_path):
    """Each with its path; and parameters of axes, of other numbers, are passed over."""
    punched = TABLES.replace(" P", "Q1L1P").replace("%\n", "%\nN01320Q1A1P9.0A2P-9.0\n", 1)
    assert "N19700Q1L1P5.0\n" in punched
    more = "N19697Q1L1P3\nN19696Q1L1P00100000\nN19703P0\n"
    assert fanuc(tmp_path, punched + more) == fanuc(tmp_path, TABLES)


HEADS = """N19680P2
N19682P3
N19687P1
N19684P0
N19689P0
N19666P150.0
N19710P2.5
N19714P60.0
"""


def test_two_axes_in_the_head(tmp_path):
    machine = fanuc(tmp_path, HEADS)
    assert (machine.table, machine.head) == ((), ("C", "A"))
    assert machine.axes["A"] == Axis(direction=(1.0, 0, 0), point=(0.0, 2.5, 150.0), sign=1)
    assert machine.axes["C"] == Axis(direction=(0, 0, 1.0), point=(0.0, 2.5, 210.0), sign=1)


def test_one_axis_each_the_first_in_the_head(tmp_path):
    text = HEADS.replace("80P2", "80P21").replace("82P3", "82P2").replace("87P1", "87P3")
    machine = fanuc(tmp_path, text + "N19700P1.5\nN19702P9.\n")
    assert (machine.table, machine.head) == (("C",), ("B",))
    assert machine.axes["B"].point == (0.0, 2.5, 150.0)
    assert machine.axes["C"].point == (1.5, 0.0, 9.0)


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("P12\n", "P3\n", 0, "19680 has to be 2 (head), 12 (table) or 21 (both)"),
        ("N19680 P12\n", "", 0, "19680 has to be"),
        ("N19684 P1 (left-handed)\n", "", 0, "19684 is missing"),
        ("N19701 P-32.\n", "", 0, "19701 is missing"),
        ("N19682 P1\n", "N19682 P4\n", 0, "19682 has to be 1, 2 or 3"),
        ("N19687 P3\n", "N19687 P1\n", 0, "the same coordinate"),
        ("19689 = 1", "19689 = 2", 0, "19689 has to be 0 or 1"),
        ("%\n", "%\nN19685 P45.0\n", 0, "19685 is not 0"),
        ("%\n", "%\nN19680 P12\n", 3, "stands twice"),
        ("%\n", "%\nN19680 A1\n", 2, "not one parameter and its value"),
        ("N19700 P5.0", "N19700Q1L1P5.0L2P1.0", 7, "not one parameter and its value"),
        ("N19700 P5.0", "N19700 P5000", 7, "without a decimal point"),
        ("%\n", "%\nN19697 P1\n", 0, "19697 is not 3 (+Z)"),
        ("%\n", "%\nN19698 P30.0\n", 0, "19698 is not 0"),
        ("%\n", "%\nN19696 P00100001\n", 0, "19696 has an axis that is not controlled"),
    ],
)
def test_fanuc_parameters_that_are_refused(tmp_path, old, new, line, message):
    assert old in TABLES
    with pytest.raises(UsageError) as caught:
        fanuc(tmp_path, TABLES.replace(old, new))
    found = caught.value.diagnostics[0]
    assert (found.code, found.where.line) == ("GX454", line)
    assert message in found.message


# --- the command line ---


@dataclass(frozen=True)
class Lists(gx.ControlFiles):
    name = "lists"

    @staticmethod
    def tools(path, units):
        return {1: Tool(length=5.0)}


def test_a_control_that_has_tools_alone_is_not_offered(monkeypatch):
    known = Registry(controls=Offered({"lists": Lists, "fanuc": FanucFiles}))
    monkeypatch.setattr(verb, "default_registry", lambda *kinds: known)
    assert (Lists.reads("kinematics"), Lists.reads("tools")) == (False, True)
    assert verb.Controls("import").list_commands(click.Context(verb.command)) == ["fanuc"]


def test_import_on_the_command_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    hal(tmp_path, HAL)
    assert call("machine", "import", "linuxcnc", "mill.hal").exit_code == 2
    done = call("machine", "import", "linuxcnc", "--units", "mm", "-o", "m.toml", "mill.hal")
    assert done.exit_code == 0, done.stderr
    assert chain_of(load_machine(tmp_path / "m.toml")).letters == ("A", "C")
    (tmp_path / "p.txt").write_text(TABLES)
    done = call("machine", "import", "fanuc", "p.txt")
    assert done.stdout.startswith("# From p.txt.")
    assert "GX727" in call("machine", "import", "fanuc", "-o", "p.txt", "p.txt").stderr
