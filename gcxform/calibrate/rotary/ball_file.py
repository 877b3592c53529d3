"""CSV files of ball centres; see `gcxform/calibrate/csv_text.py` for their common form.

    angle [deg], X [mm],   Y [mm],   Z [mm]
    0,           363.5312, 51.2288,  128.9411
    45,          287.0892, 235.7834, 128.9533

A row for each position of the axis: the angle as commanded (deg or rad), and the centre of the ball
in machine coordinates. The other rotary axes stand at 0. Columns whose names begin with
temperature, pressure or humidity go to the report, with their units.

For a bundle there is a column for each rotary axis of the machine, and `ball` tells balls apart:

    ball, A [deg], C [deg], X [mm],  Y [mm],  Z [mm]
    1,    -30,     45,      82.7912, 40.1623, -35.9984
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gcxform.calibrate.bundle.bundle import Poses
from gcxform.calibrate.csv_text import CsvTable, parse_csv, read_csv
from gcxform.calibrate.diagonal.file import CONDITIONS
from gcxform.calibrate.rotary.axis import Centres
from gcxform.errormodel.model import AXES


class MeasuredBalls(NamedTuple):
    """A file as read: its name, the centres, what was carried (column: least, mean, most)."""

    file: str
    centres: Centres
    conditions: dict[str, dict[str, Any]]


def read_balls(path: Path) -> MeasuredBalls:
    """Return the centres of a file. Raises FileError, and InputError with the place."""
    return _measured(read_csv(path))


def parse_balls(text: str) -> MeasuredBalls:
    """Return the same from a text."""
    return _measured(parse_csv(text))


def _measured(table: CsvTable) -> MeasuredBalls:
    names = ["angle", *(axis.lower() for axis in AXES)]
    table.refuse_unknown(names, CONDITIONS)
    table.need(*names)
    points = np.column_stack([table.lengths(name) for name in names[1:]])
    centres = Centres(table.angles("angle"), points, table.where)
    return MeasuredBalls(table.file, centres, conditions(table))


class MeasuredPoses(NamedTuple):
    """The same for balls at poses of several axes."""

    file: str
    poses: Poses
    conditions: dict[str, dict[str, Any]]


def read_poses(path: Path, letters: Sequence[str]) -> MeasuredPoses:
    """Return balls at poses of some axes. Raises FileError, and InputError with the place."""
    table = read_csv(path)
    turns, names = [letter.lower() for letter in letters], [axis.lower() for axis in AXES]
    table.refuse_unknown(["ball", *turns, *names], CONDITIONS)
    table.need(*turns, *names)
    points = np.column_stack([table.lengths(name) for name in names])
    degrees = np.column_stack([table.angles(name) for name in turns])
    poses = Poses(degrees, tuple(table.texts("ball")), points, table.where)
    return MeasuredPoses(table.file, poses, conditions(table))


def poses_csv(poses: Poses, letters: Sequence[str]) -> str:
    """Return poses as a file that reads back as the same bits."""
    lines = [",".join(["ball", *(f"{a} [deg]" for a in letters), *(f"{a} [mm]" for a in AXES)])]
    rows = zip(poses.ball, poses.degrees.tolist(), poses.points.tolist(), strict=True)
    lines += [",".join([ball, *map(repr, [*angles, *point])]) for ball, angles, point in rows]
    return "\n".join(lines) + "\n"


def conditions(table: CsvTable) -> dict[str, dict[str, Any]]:
    """Return what was carried: of each column its unit, least, mean and most."""
    found: dict[str, dict[str, Any]] = {}
    for heading in table.headings.values():
        if heading.name.startswith(CONDITIONS):
            values = table.numbers(heading.name)
            least, mean, most = values.min(), values.mean(), values.max()
            found[heading.name] = {
                "unit": heading.unit,
                "least": float(least),
                "mean": round(float(mean), 6),
                "most": float(most),
            }
    return found


def balls_csv(centres: Centres) -> str:
    """Return centres as a file that reads back as the same bits."""
    lines = ["angle [deg],X [mm],Y [mm],Z [mm]"]
    for angle, point in zip(centres.degrees.tolist(), centres.points.tolist(), strict=True):
        lines.append(",".join(map(repr, [angle, *point])))
    return "\n".join(lines) + "\n"


def read_plan(path: Path, letters: Sequence[str], axis: str | None = None) -> Poses:
    """Return the poses of either kind of file: of one axis, the others at 0, if it is named.

    Raises FileError, and InputError with the place.
    """
    if axis is None:
        return read_poses(path, letters).poses
    centres = read_balls(path).centres
    degrees = np.zeros((len(centres), len(letters)))
    degrees[:, letters.index(axis)] = centres.degrees
    return Poses(degrees, ("1",) * len(centres), centres.points, centres.where)


def plan_csv(poses: Poses, letters: Sequence[str], axis: str | None = None) -> str:
    """Return poses as either kind of file, which reads back as the same bits."""
    if axis is None:
        return poses_csv(poses, letters)
    return balls_csv(Centres(poses.degrees[:, letters.index(axis)], poses.points))
