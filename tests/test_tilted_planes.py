"""Planes in space and followed tips on tables that turn: published poses, and quaternions."""

from __future__ import annotations

import csv
import random
import re
from pathlib import Path

import pytest
from quaternions import Device, Line, linear_for, rotated

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.pipeline.chain_text import parse_chain
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.view.reading import read

TOOL = 150.0
AXES = {
    "AC_table": [("A", (1, 0, 0), (0, -20, -60)), ("C", (0, 0, 1), (10, 5, 0))],
    "BC_table": [("B", (0, 1, 0), (15, 0, -80)), ("C", (0, 0, 1), (-5, 8, 0))],
    "nutB_C_table45": [("B", (0, 1, 1), (0, -30, -90)), ("C", (0, 0, 1), (0, 0, 0))],
}
"""The tables of `../shared/data/planes/README.md`, from the base outwards, with sign -1."""
FREE = "is free in this plane"


def machine(
    tmp_path: Path, name: str, work: list[float], gauge: tuple[float, ...], words: str = "workpiece"
) -> Machine:
    lines = ["format = 1", f"table = {[axis[0] for axis in AXES[name]]}", "[tool.1]"]
    lines += [f"length = {TOOL}", f'[control]\ntip-words = "{words}"', "[work-offset.G54]"]
    lines += [f"{axis} = {place!r}" for axis, place in zip("XYZ", work, strict=True)]
    for letter, direction, point in AXES[name]:
        lines += [f"[axis.{letter}]", f"direction = {[float(d) for d in direction]}"]
        lines += [f"point = {[float(p) for p in point]}", "sign = -1", "limits = [-360.0, 360.0]"]
    lines.insert(1, f"gauge-point = {list(gauge)}")
    file = tmp_path / "machine.toml"
    file.write_text("\n".join(lines) + "\n", "utf-8")
    return load_machine(file)


def reached(machine: Machine, rotary: str, plane: str, point: str) -> list[float]:
    """Return where X, Y and Z of the machine stand at a point of a plane, and the rotary axes."""
    return led_to(machine, f"{rotary}\n{plane}\nG53.1\nG43 H1 {point}")


def led_to(machine: Machine, blocks: str, dialect: str = "fanuc", unit: str = "G21") -> list[float]:
    """Return where the axes of the machine stand behind blocks."""
    text = f"{unit} G90 G54 G17 G0\n{blocks}\nM30\n"
    control = default_registry().dialect(dialect)
    path = gx.Program(text.encode(), control, Reading().on(machine)).path
    work = machine.work_offsets["G54"]
    return [path.end[-1][k] + work.get(axis, 0.0) for k, axis in enumerate(path.axes)]


def test_published_poses(shared: Path, tmp_path: Path) -> None:
    """All poses of tables: 26 of two attitudes and one with a free axis; the other is refused."""
    file = shared / "data" / "planes" / "vectors.csv"
    rows = [*csv.DictReader(file.read_text("utf-8").splitlines())]
    rows = [row for row in rows if row["machine"] in AXES and "G68.2" in row["statement"]]
    rows = [row for row in rows if "K" not in row["evidence"].split(";")]
    good, free = 0, list[str]()
    for row in rows:
        work = [float(row[f"work_{axis}"]) for axis in "xyz"]
        device = machine(tmp_path, row["machine"], work, (0.0, 0.0, 0.0))
        plane = re.sub(r"([IJK]-?\d+)(?= |$)", r"\1.", row["statement"].split("; ")[1])
        point = " ".join(f"{axis}{float(row['p' + axis.lower()])}" for axis in "XYZ")
        for n in "12":
            if not row[f"sol{n}"]:
                continue
            try:
                found = reached(device, row[f"sol{n}"], plane, point)
            except gx.GcxformError as error:
                free.append(f"{row['status']}: {error}")
            else:
                assert found[:3] == pytest.approx([*map(float, row[f"xyz{n}"].split())], abs=2e-6)
                good += 1
    assert good == 27
    assert [FREE in said and said.startswith("pole") for said in free] == [True]


def by_quaternions(name: str, gauge: tuple, work: list, plane: list, point: list, angles: list):
    """Return X, Y and Z of the machine for a point of a plane, without numpy or the package."""
    x, y, z, i, j, k = plane
    way = rotated(point, (0, 0, 1), k)
    way = rotated(rotated(way, (1, 0, 0), j), (0, 0, 1), i)
    at = [o + v for o, v in zip((x, y, z), way, strict=True)]
    return tip_by_quaternions(name, gauge, work, at, angles)


def tip_by_quaternions(name: str, gauge: tuple, work: list, point: list, angles: list):
    """Return the same for a point of the workpiece, in its coordinates at rotary angles of 0."""
    tip = tuple(w + g + p for w, g, p in zip(work, gauge, point, strict=True))
    lines = [Line(letter, "T", axis, place, -1) for letter, axis, place in AXES[name]]
    held = (gauge[0], gauge[1], gauge[2] - TOOL)
    return linear_for(Device(name, held, lines), tip, angles)


@pytest.mark.parametrize("seed", range(40))
def test_a_point_of_a_plane_is_where_quaternions_say(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    name = draw.choice([*AXES])
    gauge = tuple(draw.uniform(-50, 50) for _ in "XYZ")
    work, plane, point = ([round(draw.uniform(-80, 80), 3) for _ in range(n)] for n in (3, 3, 3))
    plane += [
        round(draw.uniform(low, high), 3) for low, high in ((-179, 179), (5, 85), (-179, 179))
    ]
    start = [round(draw.uniform(-90, 90), 2) for _ in "AC"]
    letters = [axis[0] for axis in AXES[name]]
    said = " ".join(f"{letter}{angle}" for letter, angle in zip(letters, start, strict=True))
    words = " ".join(f"{a}{v}" for a, v in zip("XYZIJK", plane, strict=True))
    there = " ".join(f"{a}{v}" for a, v in zip("XYZ", point, strict=True))
    found = reached(machine(tmp_path, name, work, gauge), said, f"G68.2 {words}", there)
    want = by_quaternions(name, gauge, work, plane, point, found[3:])
    assert found[:3] == pytest.approx(want, abs=1e-7)
    normal = rotated(rotated((0, 0, 1), (1, 0, 0), plane[4]), (0, 0, 1), plane[3])
    for (_, axis, _), angle in reversed([*zip(AXES[name], found[3:], strict=True)]):
        normal = rotated(normal, axis, -angle)
    assert normal == pytest.approx((0, 0, 1), abs=1e-8)


@pytest.mark.parametrize("words", ["workpiece", "machine"])
@pytest.mark.parametrize("seed", range(20))
def test_a_tip_is_where_quaternions_say(seed: int, words: str, tmp_path: Path) -> None:
    draw = random.Random(seed)
    name = draw.choice([*AXES])
    gauge = tuple(draw.uniform(-50, 50) for _ in "XYZ")
    work, shift, point = ([round(draw.uniform(-80, 80), 3) for _ in "XYZ"] for _ in range(3))
    angles = [round(draw.uniform(-90, 90), 2) for _ in "AC"]
    letters = [axis[0] for axis in AXES[name]]
    said = " ".join(f"{letter}{angle}" for letter, angle in zip(letters, angles, strict=True))
    away, there, back = (
        " ".join(f"{axis}{value}" for axis, value in zip("XYZ", at, strict=True))
        for at in (shift, point, [0.0, 0.0, 0.0])
    )
    device = machine(tmp_path, name, work, gauge, words)
    moves = f"G43.4 H1 {back} {said}\nG91 {there}\nG90"
    found = led_to(device, f"{said}\nG52 {away}\n{moves}")
    at = [s + p for s, p in zip(shift, point, strict=True)]
    want = tip_by_quaternions(name, gauge, work, at, angles)
    if words == "machine":
        want = [w + p for w, p in zip(work, at, strict=True)]
        want[2] += TOOL
    assert found == pytest.approx([*want, *angles], abs=1e-7)


@pytest.mark.parametrize(("file", "name"), [("ac", "AC_table"), ("bc", "BC_table")])
def test_a_cam_says_a_point_in_a_plane_and_as_a_tip(
    file: str, name: str, shared: Path, tmp_path: Path
) -> None:
    """The programs state a point twice, which is one if tips are of the workpiece at angles 0."""
    (program,) = shared.glob(f"corpus/programs/fanuc/*/fixtures/milling/fanuc/test_5ax_{file}_*.nc")
    device = machine(tmp_path, name, [11.0, -7.0, 40.0], (0.0, 0.0, 0.0))
    lines = [line.partition(" ")[2] for line in program.read_text().splitlines()]
    at = next(n for n, line in enumerate(lines) if line.startswith("G68.2"))
    rotary, _, plane, turn, point, leave, tip, there = lines[at - 2 : at + 6]
    assert (turn, leave, tip) == ("G53.1", "G69", "G43.4 H02")
    before = led_to(device, f"{rotary}\n{plane}\n{turn}\n{point}\n{leave}")
    behind = led_to(device, f"{rotary}\n{tip}\n{there}")
    assert behind[:2] == pytest.approx(before[:2], abs=1e-3)


def test_a_plane_is_compared_and_shown_where_it_leads(tmp_path: Path) -> None:
    """The shipped example, read by itself, is the same as its plain moves for another control."""
    example = Path(__file__).parents[1] / "examples" / "three-plus-two"
    machine, program = (
        load_machine(example / "machine.toml", default_registry().machines),
        example / "wedge.nc",
    )
    chain, registry = "cycles | offsets | absolute", default_registry()
    fanuc, linuxcnc = (registry.dialect(name) for name in ("fanuc", "linuxcnc"))
    steps = parse_chain(chain, tmp_path, registry)
    plain = gx.Pipeline(fanuc, linuxcnc, tuple(steps), machine=machine).run(program)
    reading = Reading(start={"X": 0.0, "Y": 0.0, "Z": 300.0}).on(machine)
    one = gx.Program(program.read_bytes(), fanuc, reading)
    other = gx.Program(plain.text, linuxcnc, reading)
    found = gx.compare(one, other)
    assert found.deviation < 5e-5
    assert found.parted is None
    assert found.matched > 20
    assert read(Source.of_bytes(one.text, "wedge.nc"), fanuc, reading).path.end[
        -1
    ] == pytest.approx(one.path.end[-1], nan_ok=True)
