"""`gcxform calibrate circles`: circles in the planes of the linear axes, by any instrument."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from gcxform import plot
from gcxform.cli.calibration.shared import Files, Found, about, found_options, hand_out, path_of
from gcxform.cli.common.options import ABOVE_NOTHING, THREE_LENGTHS, Typed, above_nothing, one_of
from gcxform.cli.common.request import excluding
from gcxform.diagnostics import Location, UsageError
from gcxform.system.option_mark import Option

SEARCH = "search"
_TABLE = """
DATA is a table with a row for each reading, actual less nominal radius, longer is positive:

\b
    plane, sense, radius [mm], feed [mm/min], angle [deg], reading [um]
    XY,    ccw,   100,         1000,          0.25,        3.517
    XY,    cw,    100,         1000,          359.75,      3.525

plane: XY, YZ or ZX; angles are from its first axis towards its second, ccw is so travelled. In
place of sense and reading there may be ccw [um] and cw [um]. Points of an instrument that measures
them, or of a probe that touched a ring or a bore, have coordinates:

\b
    plane, sense,  X [mm],  Y [mm],  Z [mm]
    XY,    probed, 131.204, 80.011,  25

What holds for all rows may be said by options instead: --plane, --radius, --feed, --centre. Columns
centre X [mm], centre Y [mm], centre Z [mm] are where the circle was in the machine; test tells
tests apart. Units: mm, um, nm, m, in; deg, rad; mm/min, m/min, mm/s, in/min.

Exports of other programs, Renishaw's among them, are read by saying which columns there are:
--columns 'angle [deg], ccw [um], cw [um]' --skip 12 --decimal comma. Result files (.b5r) are not
published, and not read.

The model has the squareness of the planes that were measured, the scales with --scale-from (the
axis that is right, or bar, for a calibrated one at two feeds or a probed ring), and straightness
with --straightness model. It ends where the circles did, unless --limits none. Backlash, servo
mismatch, spikes and the rest are reported: no model by position holds them.
"""


class Pitch(Typed):
    """A length above nothing, or the word that looks for one."""

    def __init__(self) -> None:
        super().__init__(f"LENGTH|{SEARCH}", "Length", Option(above=0))

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return mm, or the word. Raises UsageError."""
        return value if value == SEARCH else super().convert(value, param, ctx)


@click.command(
    "circles", epilog=_TABLE, short_help="Circles in XY, YZ, ZX: squareness, scales, and causes."
)
@click.option("--plane", metavar="XY", type=click.Choice(["XY", "YZ", "ZX"]), help="Of all rows.")
@click.option("--radius", type=ABOVE_NOTHING, help="Of all rows: the nominal radius.")
@click.option(
    "--feed",
    metavar="NUMBER",
    type=click.FloatRange(0.0, min_open=True),
    help="Of all rows: the feed, mm/min.",
)
@click.option("--centre", type=THREE_LENGTHS, help="Of all rows: the centre, in the machine.")
@click.option("--columns", metavar="NAMES", default="", help="The columns of a foreign table.")
@click.option(
    "--skip", metavar="N", type=click.IntRange(0), default=0, help="Lines above a foreign table."
)
@one_of("--decimal", words=["point", "comma"], help="What sets off decimals.")
@click.option(
    "--cw-angles",
    type=click.Choice(["position", "travelled"]),
    help="What the angles of clockwise runs are that rise.",
)
@click.option("--arc", metavar="A,B", help="The angles between which readings count, degrees.")
@click.option(
    "--pitch", type=Pitch(), help="Of the screws, for cyclic errors; search looks for pitches."
)
@one_of("--causes", words=["auto", "all"], help="Causes: those the arc tells, or all.")
@one_of(
    "--scale-from", words=["none", "X", "Y", "Z", "bar"], help="Which scale is taken to be right."
)
@above_nothing("--radius-noise", "1 um", "Standard deviation of the radius of a bar or ring.")
@one_of(
    "--straightness",
    words=["report", "model"],
    help="Where bows go; a model of them takes pitches to be even.",
)
@one_of("--limits", words=["circles", "none"], help="Where the model ends.")
@found_options(
    "Standard deviation of a reading.",
    "1 um",
    "Write the error model (TOML).",
    "Draw the sheet: diagrams, figures, causes (SVG or PNG).",
)
def circles(data: str, noise: float, output: str | None, **given: Any) -> None:
    """Turn circles in the planes of the linear axes into squareness, scales, and causes.

    Those of a ballbar, a grid encoder, a probed ring or bore, whole or in part, in both senses.
    Printed are G, F and H of ISO 230-4, and the table of causes with their uncertainties and
    shares: squareness, scale mismatch, backlash, reversal spikes, servo mismatch, lateral play,
    straightness, cyclic errors, and the pivot's offset. One sense alone does not tell squareness
    from servo mismatch, and a model of it is refused.
    """
    from gcxform.calibrate.circles import report as words
    from gcxform.calibrate.circles.circles import Asked, fit
    from gcxform.calibrate.circles.file import Given, read_circles
    from gcxform.calibrate.circles.machine import Identified
    from gcxform.calibrate.csv_text import Layout
    from gcxform.errormodel.model_text import to_toml

    places = Files(output, given["report"], given["plot"])
    places.check(data)
    bent = given["straightness"] == "model"
    if bent and given["limits"] == "none":
        raise excluding("--straightness model and --limits none")
    feed = given["feed"] / 60.0 if given["feed"] else None
    said = Given(
        given["plane"],
        given["radius"],
        feed,
        given["centre"],
        given["cw_angles"],
        _arc(given["arc"]),
    )
    layout = Layout(given["columns"], given["skip"], given["decimal"] == "comma")
    search = given["pitch"] == SEARCH
    asked = Asked(noise, None if search else given["pitch"], search, given["causes"] == "all")
    with about(data):
        measured = read_circles(path_of(data), said, layout)
        tests = tuple(fit(setup, runs, asked) for setup, runs in measured.tests)
        found = Identified(tests, given["scale_from"], given["radius_noise"], bent)
        text = ""
        if output is not None:
            model = found.model(given["limits"] == "circles")
            text = words.comments(found, measured.file) + to_toml(model)
    whole = words.report(found, measured.file, measured.conditions)
    title = Path(measured.file).name
    hand_out(Found(text, whole, words.lines(found), lambda: plot.sheets(found, title)), places)


def _arc(text: str | None) -> tuple[float, float] | None:
    """Return the ends of an arc. Raises UsageError."""
    if text is None:
        return None
    try:
        low, high = (float(part) for part in text.split(","))
    except ValueError:
        low = high = 0.0
    if not low < high:
        message = f"{text!r} is not an arc of two angles that rise"
        raise UsageError.one("GX706", message, Location("--arc"), "write it as 0,360")
    return low, high
