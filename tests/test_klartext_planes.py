"""PLANE on tables that turn: published poses, the manual's examples, and trying all angles."""

from __future__ import annotations

import csv
import random
from collections.abc import Sequence
from pathlib import Path

import pytest
from reference import klartext_planes as reference
from test_tilted_planes import AXES, TOOL

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

LIMITS = "limits = [-180.0, 179.0]"


def machine(folder: Path, name: str, work: list[float], limits: str = LIMITS) -> Machine:
    lines = ["format = 1", f"table = {[axis[0] for axis in AXES[name]]}", "[tool.1]"]
    lines += [f"length = {TOOL}", "[work-offset.G54]"]
    lines += [f"{axis} = {place!r}" for axis, place in zip("XYZ", work, strict=True)]
    for letter, direction, point in AXES[name]:
        lines += [f"[axis.{letter}]", f"direction = {[float(d) for d in direction]}"]
        lines += [f"point = {[float(p) for p in point]}", "sign = -1", limits]
    (folder / "machine.toml").write_text("\n".join(lines) + "\n", "utf-8")
    return load_machine(folder / "machine.toml", default_registry().machines)


def reached(machine: Machine, *lines: str) -> list[float]:
    """Return where X, Y and Z of the machine stand behind lines, and its rotary axes."""
    said = ["BEGIN PGM A MM", "TOOL CALL 1 Z S1000", *lines, "END PGM A MM"]
    text = "\n".join(f"{n} {line}" for n, line in enumerate(said)) + "\n"
    path = gx.Program(
        text.encode(), default_registry().dialect("heidenhain"), Reading().on(machine)
    ).path
    work = machine.work_offsets["G54"]
    stands = {a: path.end[-1][k] + work.get(a, 0.0) for k, a in enumerate(path.axes)}
    return [stands[axis] for axis in ("X", "Y", "Z", *machine.table)]


def alike(found: list[float], angles: Sequence[float], by: float) -> bool:
    """Whether angles are the same, but for whole turns."""
    return all(abs((f - a + 180) % 360 - 180) < by for f, a in zip(found, angles, strict=True))


def test_published_poses(shared: Path, tmp_path: Path) -> None:
    """Both attitudes of each on tables, by SEQ; where one is free its axis stays, by COORD ROT."""
    file = shared / "data" / "planes" / "vectors.csv"
    rows = [*csv.DictReader(file.read_text("utf-8").splitlines())]
    rows = [row for row in rows if row["machine"] in AXES and "PLANE" in row["statement"]]
    good = 0
    for row in rows:
        device = machine(tmp_path, row["machine"], [float(row[f"work_{a}"]) for a in "xyz"])
        start = "L " + " ".join(f"{axis[0]}+0" for axis in AXES[row["machine"]]) + " R0 FMAX"
        point = "L " + " ".join(f"{a}{float(row['p' + a.lower()])}" for a in "XYZ") + " FMAX"
        for n, sign in ("1", "+"), ("2", "-"):
            if row[f"sol{n}"]:
                plane = f"{row['statement']} FMAX SEQ{sign} COORD ROT"
                found = reached(device, start, plane, point)
                assert found[:3] == pytest.approx([*map(float, row[f"xyz{n}"].split())], abs=4e-6)
                good += 1
    assert good == GOOD


GOOD = 15


@pytest.mark.parametrize("seed", range(30))
def test_a_point_of_a_plane_is_where_trying_all_angles_says(seed: int, tmp_path: Path) -> None:
    """By STAY, with Q120 to Q122, and by TURN; behind a shift, and the zero of the preset."""
    draw = random.Random(seed)
    name = draw.choice([*AXES])
    table = AXES[name]
    work, shift, point = ([round(draw.uniform(-80, 80), 3) for _ in "XYZ"] for _ in range(3))
    angles = [round(draw.uniform(-35, 35), 3), *(round(draw.uniform(-170, 170), 3) for _ in "BC")]
    said, plane = "SPATIAL SPA{} SPB{} SPC{}", reference.spatial
    if draw.random() < 0.4:
        said, plane = "EULER EULPR{} EULNU{} EULROT{}", reference.euler
        angles = [angles[1], round(draw.uniform(5, 80), 3), angles[2]]
    elif draw.random() < 0.9:
        angles[1] = round(angles[1] / 5, 3)
    matrix, sign = plane(*angles), draw.choice((-1, 1))
    how = draw.choice(("STAY", "TURN FMAX"))
    names = {"A": "Q120", "B": "Q121", "C": "Q122"}
    lines = [
        f"L {' '.join(f'{a[0]}{draw.uniform(-90, 90):.2f}' for a in table)} R0 FMAX",
        f"TRANS DATUM AXIS {' '.join(f'{a}{v}' for a, v in zip('XYZ', shift, strict=True))}",
        f"PLANE {said.format(*angles)} {how} SEQ{'+' if sign > 0 else '-'}",
        *[f"L {' '.join(f'{a[0]}+{names[a[0]]}' for a in table)} R0 FMAX"] * (how == "STAY"),
        f"L {' '.join(f'{a}{v}' for a, v in zip('XYZ', point, strict=True))} FMAX",
    ]
    normal = [row[2] for row in matrix]
    turned = reference.searched(table, matrix, sign)
    if reference.off(table, turned, normal) > 1e-7:
        with pytest.raises(gx.InputError, match=r"in no attitude|no attitude with"):
            reached(machine(tmp_path, name, work), *lines)
        return
    found = reached(machine(tmp_path, name, work), *lines)
    assert alike(found[3:], turned, 1e-5)
    tip = [sum(v) for v in zip(work, shift, reference.led(matrix, point), strict=True)]
    x, y, z = reference.carried(table, found[3:], tip)
    assert found[:3] == pytest.approx([x, y, z + TOOL], abs=1e-6)


EXAMPLE = "PLANE SPATIAL SPA+0 SPB+45 SPC+0 TURN FMAX"


@pytest.mark.parametrize(
    ("limits", "start", "way", "ends"),
    [
        ("wrap = 360.0", (0, 0), "", (45, 90)),
        ("wrap = 360.0", (0, 0), " SEQ-", (-45, -90)),
        ("wrap = 360.0", (0, 0), " SYM-", (-45, -90)),
        ("wrap = 360.0", (0, -105), "", (-45, -90)),
        ("wrap = 360.0", (0, -105), " SEQ+", (45, 90)),
        ("limits = [-90.0, 10.0]", (0, 0), "", (-45, -90)),
        ("limits = [-90.0, 10.0]", (0, 0), " SEQ+", None),
    ],
)
def test_the_example_of_the_manual(
    limits: str, start: tuple, way: str, ends: tuple | None, tmp_path: Path
) -> None:
    """SPB+45 on a table A that carries C (iTNC 530 ISO, p. 404); limits of A only."""
    device = machine(tmp_path, "AC_table", [0.0, 0.0, 0.0], limits)
    text = (tmp_path / "machine.toml").read_text("utf-8").rpartition("limits")
    if text[1]:
        (tmp_path / "machine.toml").write_text(f"{text[0]}wrap = 360.0\n", "utf-8")
        device = load_machine(tmp_path / "machine.toml", default_registry().machines)
    lines = f"L A{start[0]} C{start[1]} R0 FMAX", f"{EXAMPLE}{way}", "L X+1 Y+2 Z+3 R0 FMAX"
    if ends is None:
        with pytest.raises(gx.InputError, match="within its limits"):
            reached(device, *lines)
        return
    found = reached(device, *lines)[3:]
    assert alike(found, ends, 1e-7)


@pytest.mark.parametrize(
    ("plane", "ends"),
    [
        ("SPATIAL SPA+45 SPB+0 SPC+90", (45, 90)),
        ("EULER EULPR+90 EULNU+45 EULROT+0", (45, 90)),
        ("VECTOR BX+0 BY+2 BZ+0 NX+3 NY+0 NZ+3", (45, 90)),
        ("POINTS P1X+5 P1Y+0 P1Z+0 P2X+5 P2Y+9 P2Z+0 P3X+4 P3Y+4 P3Z+1", (45, 90)),
    ],
)
def test_one_plane_said_in_four_ways(plane: str, ends: tuple, tmp_path: Path) -> None:
    device = machine(tmp_path, "AC_table", [0.0, 0.0, 0.0])
    lines = "L A0 C0 R0 FMAX", f"PLANE {plane} TURN FMAX SEQ+", "L X+1 Y+2 Z+3 R0 FMAX"
    assert reached(device, *lines)[3:] == pytest.approx(ends)
    first = reached(device, lines[0], "PLANE SPATIAL SPA+45 SPB+0 SPC+90 TURN FMAX SEQ+", lines[2])
    assert reached(device, *lines) == pytest.approx(first)
