"""CSV files of circular tests; see `gcxform/calibrate/csv_text.py` for their common form.

    plane, sense, radius [mm], feed [mm/min], angle [deg], reading [um]
    XY,    ccw,   100,         1000,          0.25,        3.517
    XY,    cw,    100,         1000,          359.75,      3.525

A row for each reading, actual less nominal radius. The angle is that of the place as commanded,
from the first axis of the plane towards the second; in a run in the sense cw it falls. Where `ccw
[um]` and `cw [um]` stand in place of sense and reading, a row has both senses. Where there are
coordinates

    plane, sense,  X [mm],  Y [mm],  Z [mm]
    XY,    probed, 131.204, 80.011,  25

the points of an instrument that measures them are readings about their least-squares circle; those
of a probe that touched a ring or a bore (probed) are so with the other sign: it is the displayed
place that is off by as much as the tool is the other way. What holds for all rows may be said once
(`Given`); a column for it must then not be there. `centre X [mm]` and so on are where the circle
was, and `test` tells tests of one set-up apart. Columns that begin with temperature, pressure or
humidity go to the report.

Of Renishaw's result files (.b5r and others) no page says what is in them, and they are refused; of
its exports of readings, as of any other, `Layout` says which columns there are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from gcxform.calibrate.circles.causes import PLANES, SetUp
from gcxform.calibrate.circles.circles import SENSES, Run
from gcxform.calibrate.circles.deviations import least_squares_circle
from gcxform.calibrate.csv_text import OWN, CsvTable, Layout, read_csv
from gcxform.calibrate.diagonal.file import CONDITIONS
from gcxform.calibrate.rotary.ball_file import conditions
from gcxform.diagnostics import InputError, Location
from gcxform.errormodel.model import AXES
from gcxform.machine.chain import Triple
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass

CLOSED: Final = (".b5r", ".b5t", ".b20", ".b20t")
FEEDS: Final = {"mm/min": 1.0 / 60.0, "mm/s": 1.0, "m/min": 1000.0 / 60.0, "in/min": 25.4 / 60.0}
CENTRE: Final = ("centre x", "centre y", "centre z")
TURN: Final = 361.0  # degrees: a run beyond has its way in, or out, with it
RADII: Final = (0.1, 100_000.0)  # mm: beyond, a number is one of another unit, or a slip
SAID: Final = ("test", "plane", "radius", "feed", *CENTRE)


@dataclass(frozen=True)
class Given:
    """What is said of all rows: lengths in mm, the feed in mm/s.

    `cw_angles` is `position` or `travelled`, what the angles of cw runs are that rise; `arc` are
    the angles between which readings are taken, degrees.
    """

    plane: str | None = None
    radius: float | None = None
    feed: float | None = None
    centre: Triple | None = None
    cw_angles: str | None = None
    arc: tuple[float, float] | None = None


class MeasuredCircles(NamedTuple):
    """A file as read: its name, the tests, what was carried (column: least, mean, most)."""

    file: str
    tests: tuple[tuple[SetUp, tuple[Run, ...]], ...]
    conditions: dict[str, dict[str, Any]]


def read_circles(path: Path, given: Given, layout: Layout = OWN) -> MeasuredCircles:
    """Return the tests of a file. Raises FileError, and InputError with the place."""
    if path.suffix.lower() in CLOSED:
        raise InputError.one(
            "GX470",
            f"what is in {path.suffix} files is not published, so that they are not read",
            Location(str(path)),
            "export the readings as text, and say which columns it has: --columns 'angle [deg], "
            "ccw [um], cw [um]'",
        )
    return measured(read_csv(path, layout), given)


def measured(table: CsvTable, given: Given) -> MeasuredCircles:
    """Return the tests of a table. Raises InputError with the place."""
    table.refuse_unknown(
        [*SAID, "sense", "angle", "reading", "ccw", "cw", "x", "y", "z"], CONDITIONS
    )
    setups = _setups(table, given)
    tests = []
    for setup in dict.fromkeys(setups):
        rows = np.flatnonzero([other == setup for other in setups])
        tests.append(_test(table, setup, rows, given))
    return MeasuredCircles(table.file, tuple(tests), conditions(table))


# --- set-ups ---


def _setups(table: CsvTable, given: Given) -> list[SetUp]:
    """Return the set-up of every row; a radius of 0 is one that the points will tell."""
    _refuse_twice(table, given)
    count = len(table)
    planes = [text.upper() for text in table.texts("plane")]
    if "plane" not in table.headings:
        planes = [_needed(table, "plane", given.plane)] * count
    for row, plane in enumerate(planes):
        if plane not in PLANES:
            message = f"{plane!r} is not one of {', '.join(PLANES)}"
            hint = "ZX has its angles from Z to X" if plane == "XZ" else ""
            raise InputError.one("GX471", message, table.where(row, "plane"), hint)
    radii = _column(table, "radius", _radius(table, given))
    for row, radius in enumerate(radii):
        if radius and not RADII[0] <= radius <= RADII[1]:
            message = f"a radius of {radius:g} mm is none of a circular test"
            raise InputError.one("GX471", message, table.where(row, "radius"))
    feeds: list[float | None] = [given.feed] * count
    if "feed" in table.headings:
        feeds = [*_above_nothing(table, "feed", table.scaled("feed", "a feed", FEEDS))]
    centres = _centres(table, given)
    names = table.texts("test")
    rows = zip(planes, radii, feeds, centres, names, strict=True)
    return [SetUp(*row) for row in rows]


def _refuse_twice(table: CsvTable, given: Given) -> None:
    """Raise InputError for what the table has a column of and is said besides."""
    for name, column in (("plane", "plane"), ("radius", "radius"), ("feed", "feed")):
        if getattr(given, name) is not None and column in table.headings:
            message = f"the table has a column {column!r}, and --{name} is given"
            where = table.heading_place(column)
            raise InputError.one("GX470", message, where, f"leave out --{name}, or the column")
    if given.centre is not None and CENTRE[0] in table.headings:
        message = "the table has columns of the centre, and --centre is given"
        where = table.heading_place(CENTRE[0])
        raise InputError.one("GX470", message, where, "leave out --centre, or the columns")


def _needed(table: CsvTable, name: str, value: Any) -> Any:
    if value is None:
        message = f"the table has no column {name!r}"
        hint = f"add it, or say it for all rows: --{name}"
        raise InputError.one("GX470", message, table.heading_place(), hint)
    return value


def _radius(table: CsvTable, given: Given) -> float:
    """Return the radius that holds where there is no column of it; points tell it themselves."""
    points = "x" in table.headings or "y" in table.headings
    if given.radius is None and points:
        return 0.0
    known = given.radius if "radius" not in table.headings else 0.0
    return float(_needed(table, "radius", known))


def _column(table: CsvTable, name: str, value: float) -> list[float]:
    if name not in table.headings:
        return [value] * len(table)
    return _above_nothing(table, name, table.lengths(name))


def _above_nothing(table: CsvTable, name: str, values: Floats) -> list[float]:
    """Return the values of a column. Raises InputError (GX471) unless all are above 0."""
    for row in np.flatnonzero(~(values > 0.0)).tolist():
        message = f"a {name} is above 0"
        raise InputError.one("GX471", message, table.where(row, name))
    return [*values.tolist()]


def _centres(table: CsvTable, given: Given) -> list[Triple | None]:
    if not any(name in table.headings for name in CENTRE):
        return [given.centre] * len(table)
    table.need(*CENTRE)
    places = np.column_stack([table.lengths(name) for name in CENTRE])
    return [(x, y, z) for x, y, z in places.tolist()]


# --- runs ---


def _test(table: CsvTable, setup: SetUp, rows: Ints, given: Given) -> tuple[SetUp, tuple[Run, ...]]:
    """Return one test: its set-up, with what its points tell of it, and its runs."""
    if "angle" not in table.headings:
        return _of_points(table, setup, rows)
    wide = "ccw" in table.headings or "cw" in table.headings
    columns = _wide(table, rows) if wide else _long(table, rows)
    runs = [_run(table, sense, own, values, given) for sense, own, values in columns]
    return setup, tuple(runs)


def _long(table: CsvTable, rows: Ints) -> Iterator[tuple[int, Ints, Floats]]:
    table.need("sense", "angle", "reading")
    senses, readings = _senses(table), table.lengths("reading")
    for sense in dict.fromkeys(senses[rows].tolist()):
        own = rows[senses[rows] == sense]
        yield sense, own, readings[own]


def _wide(table: CsvTable, rows: Ints) -> Iterator[tuple[int, Ints, Floats]]:
    for name in ("sense", "reading"):
        if name in table.headings:
            message = f"{name!r} stands beside 'ccw' or 'cw', which say it already"
            raise InputError.one("GX470", message, table.heading_place(name))
    for name in ("ccw", "cw"):
        if name in table.headings:
            yield SENSES[name], rows, table.lengths(name)[rows]


def _senses(table: CsvTable) -> Ints:
    table.need("sense")
    words = [text.lower() for text in table.texts("sense")]
    for row, word in enumerate(words):
        if word not in SENSES:
            message = f"{word!r} is not one of {', '.join(SENSES)}"
            raise InputError.one("GX471", message, table.where(row, "sense"))
    return np.array([SENSES[word] for word in words])


def _run(table: CsvTable, sense: int, rows: Ints, readings: Floats, given: Given) -> Run:
    """Return a run with its angles as places, in the arc that is asked for."""
    degrees = table.angles("angle")[rows]
    if sense < 0:
        degrees = _of_place(table, rows, degrees, given.cw_angles)
    elif sense > 0 and _rising(-degrees):
        raise InputError.one(
            "GX477",
            "the angles of the counter-clockwise run fall",
            table.where(int(rows[0]), "angle"),
            "rows stand in the order of travel: turn them around, or the sense is cw",
        )
    if given.arc is not None:
        low, high = given.arc
        keep = (degrees >= low) & (degrees <= high)
        if not keep.any():
            message = f"no reading of this run is between {low:g} and {high:g} degrees"
            raise InputError.one("GX477", message, table.where(int(rows[0]), "angle"))
        degrees, rows, readings = degrees[keep], rows[keep], readings[keep]
    if len(degrees) and np.ptp(degrees) > TURN:
        raise InputError.one(
            "GX477",
            f"a run goes from {degrees.min():g} to {degrees.max():g} degrees, more than a turn",
            table.where(int(rows[0]), "angle"),
            "the way in and out is no part of the test: say which angles are, --arc 0,360",
        )
    return Run(sense, degrees, readings, partial(_where, table, rows))


def _of_place(table: CsvTable, rows: Ints, degrees: Floats, said: str | None) -> Floats:
    """Return the angles of a clockwise run as places; where they rise it must be said."""
    if not _rising(degrees) or said == "position":
        return degrees
    if said == "travelled":
        return -degrees
    raise InputError.one(
        "GX477",
        "the angles of the clockwise run rise: they are those of the way travelled, or the rows "
        "are sorted by place",
        table.where(int(rows[0]), "angle"),
        "say which: --cw-angles position, or --cw-angles travelled",
    )


def _rising(degrees: Floats) -> bool:
    """Return whether angles mostly rise from row to row."""
    return float(np.sum(np.sign(np.diff(degrees)))) > 0.0


def _of_points(table: CsvTable, setup: SetUp, rows: Ints) -> tuple[SetUp, tuple[Run, ...]]:
    """Return a test of coordinates: about its centre, or that of all its points."""
    names = [letter.lower() for letter in setup.letters]
    table.need("sense", *names)
    points = np.column_stack([table.lengths(name) for name in names])[rows]
    senses = _senses(table)[rows]
    try:
        centre, radius = least_squares_circle(points)
    except ValueError as error:
        raise InputError.one("GX477", str(error), table.where(int(rows[0]))) from None
    setup = _placed(table, setup, rows, (centre, radius))
    away = points - centre  # and not from where the circle should be: that is second order
    degrees = np.degrees(np.arctan2(away[:, 1], away[:, 0])) % 360.0
    longer = np.hypot(*away.T) - setup.radius
    runs = []
    for sense in dict.fromkeys(senses.tolist()):
        own = senses == sense
        sign = 1.0 if sense else -1.0
        where = partial(_where, table, rows[own])
        runs.append(Run(sense, degrees[own], sign * longer[own], where))
    return setup, tuple(runs)


def _placed(table: CsvTable, setup: SetUp, rows: Ints, circle: tuple[Floats, float]) -> SetUp:
    """Return a set-up with the centre and radius of a circle, where it has none of its own."""
    centre, radius = circle
    place = setup.centre
    if place is None:
        found = np.zeros(3)
        other = ({0, 1, 2} - set(PLANES[setup.plane])).pop()
        found[list(PLANES[setup.plane])] = centre
        if AXES[other].lower() in table.headings:
            found[other] = table.lengths(AXES[other].lower())[rows].mean()
        x, y, z = found.tolist()
        place = (x, y, z)
    stated = bool(setup.radius)
    return SetUp(setup.plane, setup.radius or radius, setup.feed, place, setup.name, stated)


def _where(table: CsvTable, rows: Ints, row: int) -> Location:
    return table.where(int(rows[row]))


# --- and back ---


def circles_csv(tests: Sequence[tuple[SetUp, Sequence[Run]]]) -> str:
    """Return tests as a file that reads back as the same readings."""
    lines = [
        "plane,sense,radius [mm],feed [mm/min],centre X [mm],centre Y [mm],centre Z [mm],"
        "angle [deg],reading [mm]"
    ]
    for setup, runs in tests:
        if setup.feed is None or setup.centre is None:
            raise ValueError("a test without feed or place is not written")
        place = [setup.radius, round(60.0 * setup.feed, 9), *setup.centre]
        for run in runs:
            start = ",".join([setup.plane, run.name.lower(), *map(repr, place)])
            rows = zip(run.degrees.tolist(), run.readings.tolist(), strict=True)
            lines += [f"{start},{angle!r},{reading!r}" for angle, reading in rows]
    return "\n".join(lines) + "\n"
