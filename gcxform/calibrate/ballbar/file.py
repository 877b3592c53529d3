"""CSV files of circular tests while RTCP is on.

Their common form is that of `gcxform/calibrate/csv_text.py`.

    axis, bar, X [mm], Y [mm], Z [mm], angle [deg], reading [um]
    A,    Z,   65,     -32,    25,     -90,         12.3
    A,    X,   65,     -32,    25,     -90,         4.1

A row for each reading: the axis that turns (the others stand at 0), the direction of the bar from
the table ball to the spindle ball and the place of the table ball, both with all rotary axes at 0,
the angle as commanded, and the reading, positive where the bar is longer. Rows of one axis, bar and
place are one test; `test` tells repeated ones apart. Where eccentricities are known already

    axis, bar, X [mm], Y [mm], Z [mm], cosine [um], sine [um]

has a row for each test: the reading is a constant + cosine x cos(angle) + sine x sin(angle). Of
readings at four angles the cosine is half of that at 0 less that at 180, and the sine half of that
at 90 less that at 270 (or -90).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from gcxform.calibrate.ballbar.ballbar import BAR, Eccentricity, SetUp, Trace, eccentricity
from gcxform.calibrate.csv_text import CsvTable, parse_csv, read_csv
from gcxform.calibrate.diagonal.file import CONDITIONS
from gcxform.calibrate.rotary.ball_file import conditions
from gcxform.diagnostics import InputError
from gcxform.errormodel.model import AXES
from gcxform.machine.chain import Triple

BARS: Final[dict[str, Triple]] = {
    "X": (1.0, 0.0, 0.0),
    "Y": (0.0, 1.0, 0.0),
    "Z": (0.0, 0.0, 1.0),
    "-X": (-1.0, 0.0, 0.0),
    "-Y": (0.0, -1.0, 0.0),
    "-Z": (0.0, 0.0, -1.0),
}
SETUP: Final = ("axis", "bar", "x", "y", "z")
TRACES: Final = ("angle", "reading")
GIVEN: Final = ("cosine", "sine")


class MeasuredCircles(NamedTuple):
    """A file as read: its name, the tests, what was carried (column: least, mean, most)."""

    file: str
    tests: tuple[Eccentricity, ...]
    conditions: dict[str, dict[str, Any]]


def read_circles(path: Path, noise: float, length: float = BAR) -> MeasuredCircles:
    """Return the tests of a file; the noise of a reading and the length of the bar are in mm.

    Raises FileError, and InputError with the place.
    """
    return _measured(read_csv(path), noise, length)


def parse_circles(text: str, noise: float, length: float = BAR) -> MeasuredCircles:
    """Return the same from a text."""
    return _measured(parse_csv(text), noise, length)


def _measured(table: CsvTable, noise: float, length: float) -> MeasuredCircles:
    given = GIVEN[0] in table.headings or GIVEN[1] in table.headings
    columns = GIVEN if given else TRACES
    table.refuse_unknown(["test", *SETUP, *columns], CONDITIONS)
    table.need(*SETUP, *columns)
    tests = (_given if given else _traced)(table, noise, length)
    return MeasuredCircles(table.file, tests, conditions(table))


def _given(table: CsvTable, noise: float, length: float) -> tuple[Eccentricity, ...]:
    values = np.column_stack([table.lengths(name) for name in GIVEN])
    covariance = noise**2 * np.eye(2)
    rows = zip(_setups(table, length), values, strict=True)
    return tuple(
        Eccentricity(setup, value, covariance, None, table.where(k))
        for k, (setup, value) in enumerate(rows)
    )


def _traced(table: CsvTable, noise: float, length: float) -> tuple[Eccentricity, ...]:
    degrees, readings = table.angles("angle"), table.lengths("reading")
    keys = list(zip(table.texts("test"), _setups(table, length), strict=True))
    tests = []
    for key in dict.fromkeys(keys):
        rows = [k for k, other in enumerate(keys) if other == key]
        trace = Trace(key[1], degrees[rows], readings[rows], partial(_where, table, rows))
        tests.append(eccentricity(trace, noise))
    return tuple(tests)


def _where(table: CsvTable, rows: Sequence[int], row: int) -> Any:
    return table.where(rows[row])


def _setups(table: CsvTable, length: float) -> list[SetUp]:
    """Return the set-up of every row. Raises InputError (GX471)."""
    letters = [text.upper() for text in table.texts("axis")]
    bars = [text.upper().lstrip("+") for text in table.texts("bar")]
    for name, texts, known in (("axis", letters, [*"ABC"]), ("bar", bars, [*BARS])):
        for row, text in enumerate(texts):
            if text not in known:
                message = f"{text!r} is not one of {', '.join(known)}"
                raise InputError.one("GX471", message, table.where(row, name))
    places = np.column_stack([table.lengths(axis.lower()) for axis in AXES]).tolist()
    return [
        SetUp(letter, BARS[bar], (x, y, z), length)
        for letter, bar, (x, y, z) in zip(letters, bars, places, strict=True)
    ]


def bar_name(setup: SetUp) -> str:
    """Return the direction of a bar as files have it."""
    return next(name for name, bar in BARS.items() if math.dist(bar, setup.bar) < 1e-9)


def circles_csv(traces: Sequence[Trace]) -> str:
    """Return traces as a file that reads back as the same bits; readings in mm."""
    lines = ["axis,bar,X [mm],Y [mm],Z [mm],angle [deg],reading [mm]"]
    for trace in traces:
        start = [trace.setup.letter, bar_name(trace.setup), *map(repr, trace.setup.ball)]
        for angle, reading in zip(trace.degrees.tolist(), trace.readings.tolist(), strict=True):
            lines.append(",".join([*start, repr(angle), repr(reading)]))
    return "\n".join(lines) + "\n"
