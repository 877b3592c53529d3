"""Every kind of picture against one that was looked at: small, grey, and with tolerance.

What is compared is ink, blurred by some pixels: another rendering of letters passes, and a curve or
a label that is missing does not, which is shown by planting it. `UPDATE_PICTURES=1` draws them
anew; look at each before it is committed.
"""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np
import pytest
from ball_kit import around, clean, skew
from circle_kit import ROUGH, both, fitted, run
from scipy.ndimage import gaussian_filter, shift
from simulate_kit import EXAMPLE

from gcxform import plot
from gcxform.calibrate.circles.machine import Identified
from gcxform.calibrate.rotary.axis import locate
from gcxform.errormodel.model_file import load_model
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine
from gcxform.plot.canvas import STYLE
from gcxform.plugin.registry import default_registry
from gcxform.simulate.circles import Circles
from gcxform.simulate.drives import Drives
from gcxform.simulate.figures import Positioning
from gcxform.simulate.heat import Heat
from gcxform.simulate.virtual import Outcome

matplotlib = pytest.importorskip("matplotlib")

FOLDER = Path(__file__).parent / "pictures"
EXAMPLES = EXAMPLE.parents[1]
DOTS = 56  # per inch
BLUR = 1.6  # pixels
ALIKE = 0.055  # of ink, where a picture differs most
DRIVES = Drives(lag=(0.004, 0.0, 0.0), backlash=(0.008, -0.003, 0.0), stick=(2.0, 0.0, 0.0))


def sheet():
    slopes = {"EXY": 5e-5, "EXX": 4e-5}
    runs = both("XY", np.arange(0.5, 360.0, 1.0), 2e-4, slopes=slopes, drives=DRIVES)
    return plot.sheets(Identified((fitted(runs, noise=2e-4),), "Y"), "a circle")


def circles():
    def found(**machine):
        paths = []
        for sense in (-1, 1):
            angle = np.radians(ROUGH)
            radius = 100.0 + run("XY", sense, ROUGH, **machine).readings
            paths.append(radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))
        return Circles(100.0, *paths)

    before = {"XY": found(slopes={"EXY": 5e-5}, drives=DRIVES)}
    return plot.circles(Outcome(None, None, before, {"XY": found(drives=DRIVES)}), "a ballbar")


def positions():
    rng, target = np.random.default_rng(2), np.linspace(0.0, 400.0, 9)
    runs = 1e-3 * rng.standard_normal((2, 9, 5))
    bent = (2e-5 * target)[:, None]
    before = {"X": Positioning(target, bent + runs[0], bent + 0.003 + runs[1])}
    after = {"X": Positioning(target, runs[0], 0.003 + runs[1])}
    return plot.positioning(Outcome(None, None, before, after), "positioning")


def heat():
    turn = np.linspace(0.0, 4.0 * np.pi, 200)
    path = np.column_stack([60.0 * np.cos(turn), 40.0 * np.sin(turn), 4.0 * turn])
    path = np.vstack([[60.0, 0.0, 60.0], path])
    rapid = np.arange(len(path) - 1) == 0
    line = np.arange(len(path) - 1) + 3
    most = 0.002 + 0.01 * np.abs(np.sin(0.3 * np.append(0.0, turn[1:])))
    before = Heat(path[:-1], path[1:], most, rapid, line, "line 77")
    after = Heat(path[:-1], path[1:], 0.1 * most, rapid, line, "line 78")
    return plot.heat(before, after, "part.nc")


def model(name):
    return plot.model(load_model(EXAMPLES / name / "model.toml"), name)


def machine(name):
    loaded = load_machine(EXAMPLES / name, default_registry().machines)
    return plot.chain(chain_of(loaded, next(iter(loaded.tools.values()))), loaded.name)


PICTURES = {
    "sheet": sheet,
    "ballbar": circles,
    "positioning": positions,
    "heat": heat,
    "nine-functions": lambda: model("lddm"),
    "trunnion": lambda: machine("rtcp-loop/set.toml"),
    "residuals": lambda: plot.placed(locate(clean(skew(), around(9), noise=0.002), 0.002), "A", ""),
}


def image(figure):
    """Return a picture as grey pixels, 0 to 255."""
    from PIL import Image

    stream = io.BytesIO()
    with matplotlib.rc_context(STYLE):
        figure.savefig(stream, format="png", dpi=DOTS)
    return Image.open(stream).convert("L")


def ink(picture):
    return gaussian_filter(1.0 - np.asarray(picture, np.float64) / 255.0, BLUR)


def unlike(one, other):
    """Return by how much the ink of two pictures differs where it differs most."""
    if one.size != other.size:
        return 1.0
    return float(np.abs(ink(one) - ink(other)).max())


def reference(name):
    from PIL import Image

    return Image.open(FOLDER / f"{name}.png").convert("L")


PLANTED = {
    "sheet": ("test 1 cw", "backlash X"),
    "ballbar": ("XY before ccw", "+X"),
    "positioning": ("X before mean down", "deviation, um"),
    "heat": ("before worst", "12.00 um, line 77"),
    "nine-functions": ("EYX", "EYX, um"),
    "trunnion": ("A+", "A+ (table)"),
    "residuals": ("A tangential", "270°"),
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_is_like_the_one_that_was_looked_at(name):
    """And one in which a curve or a label is missing is not."""
    figure = PICTURES[name]()
    drawn = image(figure)
    if os.environ.get("UPDATE_PICTURES"):
        drawn.quantize(64).save(FOLDER / f"{name}.png", optimize=True)
    known = reference(name)
    assert unlike(drawn, known) < ALIKE
    figure.set_layout_engine("none")  # as it is laid out, without what is missing
    for artist in planted(figure, *PLANTED[name]):
        artist.set_visible(False)
        assert unlike(image(figure), known) > ALIKE
        artist.set_visible(True)


def planted(figure, curve, label):
    """Return the curve of a name, and the text of some words."""
    lines = [line for axes in figure.axes for line in axes.lines if line.get_gid() == curve]
    words = [text for text in figure.findobj(matplotlib.text.Text) if text.get_text() == label]
    return lines[0], words[0]


def test_letters_that_are_drawn_a_little_elsewhere_pass():
    known = reference("nine-functions")
    for way in ((0.3, 0.0), (0.0, -0.3)):
        from PIL import Image

        moved = shift(np.asarray(known, np.float64), way, cval=255.0)
        assert unlike(Image.fromarray(np.clip(moved, 0, 255).astype(np.uint8)), known) < ALIKE
