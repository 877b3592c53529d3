"""CYCLE800 on tables that turn: published poses, and quaternions."""

from __future__ import annotations

import csv
import random
import re
from pathlib import Path

import pytest
from quaternions import rotated
from test_tilted_planes import AXES, TOOL, led_to, tip_by_quaternions

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

ORDERS = {57: "XYZ", 45: "XZY", 54: "YXZ", 30: "YZX", 39: "ZXY", 27: "ZYX"}
UNIT = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1)}


def machine(folder: Path, name: str, work: list[float], by: str, gauge: tuple = (0.0,) * 3):
    lines = ["format = 1", f"gauge-point = {list(gauge)}"]
    lines += [f"table = {[axis[0] for axis in AXES[name]]}", "[tool.1]"]
    lines += [f"length = {TOOL}", "[control]", "edge-after-tool-change = 1"]
    lines += [f'swivel-reference = "{by}"'] * bool(by) + ["[work-offset.G54]"]
    lines += [f"{axis} = {place!r}" for axis, place in zip("XYZ", work, strict=True)]
    for letter, direction, point in AXES[name]:
        lines += [f"[axis.{letter}]", f"direction = {[float(d) for d in direction]}"]
        lines += [f"point = {[float(p) for p in point]}", "sign = -1", "limits = [-181.0, 179.0]"]
    (folder / "machine.toml").write_text("\n".join(lines) + "\n", "utf-8")
    return load_machine(folder / "machine.toml", default_registry().machines)


def reached(machine: Machine, standing: str, cycle: str, point: str) -> list[float]:
    """Return where X, Y and Z of the machine stand at a point of a plane, and the rotary axes."""
    return led_to(machine, f"T1 M6\nG0 {standing}\n{cycle}\nG0 {point}", "siemens", "G710")


def test_published_poses(shared: Path, tmp_path: Path) -> None:
    """Both attitudes of each, as the first axis of the table chooses; none where one is free."""
    file = shared / "data" / "planes" / "vectors.csv"
    rows = [*csv.DictReader(file.read_text("utf-8").splitlines())]
    rows = [row for row in rows if row["machine"] in AXES and "CYCLE800" in row["statement"]]
    good, free = 0, 0
    for row in rows:
        work, by = [float(row[f"work_{axis}"]) for axis in "xyz"], AXES[row["machine"]][0][0]
        device = machine(tmp_path, row["machine"], work, by)
        cycle = row["statement"].split("; ")[1]
        point = " ".join(f"{axis}{float(row['p' + axis.lower()])}" for axis in "XYZ")
        values = [float(each.split()[0][1:]) for each in (row["sol1"], row["sol2"]) if each]
        standing = " ".join(f"{axis[0]}0" for axis in AXES[row["machine"]])
        for n, value in zip("12", values, strict=False):
            way = 1 if value == max(values) else -1
            turned = re.sub(r"-?1(,,0\))$", rf"{way}\1", cycle)
            if row["status"] == "pole":
                with pytest.raises(gx.InputError, match="leaves C free"):
                    reached(device, standing, turned, point)
                free += 1
                continue
            found = reached(device, standing, turned, point)
            assert found[:3] == pytest.approx([*map(float, row[f"xyz{n}"].split())], abs=4e-6)
            good += 1
    assert (good, free) == (GOOD, FREE)


GOOD, FREE = 24, 1


@pytest.mark.parametrize("seed", range(40))
def test_a_point_of_a_plane_is_where_quaternions_say(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)
    name, mode = draw.choice([*AXES]), draw.choice([*ORDERS])
    gauge = tuple(draw.uniform(-50, 50) for _ in "XYZ")
    work, before, behind, point = (
        [round(draw.uniform(-80, 80), 3) for _ in "XYZ"] for _ in range(4)
    )
    angles = [round(draw.uniform(-30, 30), 3) for _ in "XYZ"]
    device = machine(tmp_path, name, work, AXES[name][0][0], gauge)
    numbers = ",".join(map(str, (*before, *angles, *behind, draw.choice((-1, 1)))))
    standing = " ".join(f"{axis[0]}{draw.uniform(-90, 90):.2f}" for axis in AXES[name])
    there = " ".join(f"{a}{v}" for a, v in zip("XYZ", point, strict=True))
    found = reached(device, standing, f'CYCLE800(1,"",0,{mode},{numbers},,1)', there)
    way = [a + b for a, b in zip(behind, point, strict=True)]
    normal: tuple = (0, 0, 1)
    for axis, angle in reversed([*zip(ORDERS[mode], angles, strict=True)]):
        way, normal = rotated(way, UNIT[axis], angle), rotated(normal, UNIT[axis], angle)
    at = [o + v for o, v in zip(before, way, strict=True)]
    assert found[:3] == pytest.approx(
        tip_by_quaternions(name, gauge, work, at, found[3:]), abs=1e-7
    )
    for (_, axis, _), angle in reversed([*zip(AXES[name], found[3:], strict=True)]):
        normal = rotated(normal, axis, -angle)
    assert normal == pytest.approx((0, 0, 1), abs=1e-8)


def test_a_feed_move_behind_is_one(tmp_path: Path) -> None:
    """The table turns in rapid, and a motion code holds on behind it."""
    device = machine(tmp_path, "AC_table", [0.0, 0.0, 0.0], "A")
    lines = ("G710 G90 G54 G17 G94", "T1 M6", "G0 A0 C0", "G1 X1 Y1 Z1 F100")
    lines += ('CYCLE800(0,"",0,57,0,0,0,30,0,0,0,0,0,1,,1)', "X0 Y0 Z5", "M30", "")
    siemens = default_registry().dialect("siemens")
    path = gx.Program("\n".join(lines).encode(), siemens, Reading().on(device)).path
    assert [gx.Kind(kind).name for kind in path.kind[-3:]] == ["LINE", "RAPID", "LINE"]
