"""What calibrations leave: residuals over the angle of an axis, polar and magnified.

In the middle of the ring is the fit; away from the centre is positive. Readings that were left out
stand as crosses.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from gcxform.calibrate.ballbar.ballbar import Eccentricity, Identified
from gcxform.calibrate.ballbar.file import bar_name
from gcxform.calibrate.bundle.bundle import Bundled
from gcxform.calibrate.rotary.axis import Placed
from gcxform.calibrate.rotary.check import components
from gcxform.errormodel.model import AXES
from gcxform.plot.canvas import AFTER, BEFORE, MEAN, figure, magnified, styled
from gcxform.system.arrays import Flags, Floats

if TYPE_CHECKING:
    from matplotlib.figure import Figure

UM = 1000.0  # per mm
COLOURS = (BEFORE, AFTER, MEAN)
MARKS = ("o", "^", "s")
AROUND = np.arange(0.0, 361.0, 5.0)  # degrees
WIDTH = 4.2  # inches, of a diagram


@styled
def placed(found: Placed, letter: str, title: str) -> Figure:
    """Return the residuals of ball centres of one axis: away from it, around it, along it."""
    made = figure(WIDTH + 1.0, WIDTH + 0.8, title)
    axes = made.add_subplot(1, 1, 1, projection="polar")
    parts = dict(zip(("radial", "tangential", "axial"), UM * components(found).T, strict=True))
    _points(axes, letter, found.centres.degrees, parts, found.kept)
    return made


@styled
def bundled(found: Bundled, title: str) -> Figure:
    """Return the residuals of a bundle in X, Y and Z, over the angle of each axis."""
    letters = found.chain.letters
    made = figure(WIDTH * len(letters) + 1.0, WIDTH + 0.8, title)
    parts = dict(zip(AXES, UM * found.residuals.T, strict=True))
    for k, letter in enumerate(letters):
        axes = made.add_subplot(1, len(letters), k + 1, projection="polar")
        _points(axes, letter, found.layout.poses.degrees[:, k], parts, found.kept)
    return made


@styled
def circled(found: Identified, title: str) -> Figure:
    """Return the traces of circular tests about their circles, and what is left of them below."""
    count = len(found.tests)
    made = figure(3.6 * count, 8.0, title)
    for k, test in enumerate(found.tests):
        name = f"test {k + 1}: {test.setup.letter}, bar {bar_name(test.setup)}"
        _trace(made.add_subplot(2, count, k + 1, projection="polar"), test, name)
        if test.trace is not None:
            axes = made.add_subplot(2, count, count + k + 1, projection="polar")
            part = {f"{name} residual": UM * test.residuals}
            used = np.ones(len(test.residuals), dtype=bool)
            _points(axes, test.setup.letter, test.trace.degrees, part, used)
    return made


def _trace(axes: Any, test: Eccentricity, name: str) -> None:
    """Draw a trace without its constant, and the eccentric circle of its fit."""
    turns = np.radians(AROUND)
    fitted = UM * np.column_stack([np.cos(turns), np.sin(turns)]) @ test.value
    most = float(np.abs(fitted).max())
    axes.plot(turns, fitted, color=MEAN, label="fit", gid=f"{name} fit")
    if test.trace is not None:
        read = UM * (test.trace.readings - test.fitted[2])
        most = max(most, float(np.abs(read).max()))
        radians = np.radians(test.trace.degrees)
        axes.plot(radians, read, color=BEFORE, label="reading", gid=f"{name} reading")
    division = magnified(axes, most)
    cosine, sine = (UM * test.value).tolist()
    axes.set_title(f"{name}, {division:g} um/div\ncosine {cosine:+.2f}  sine {sine:+.2f} um")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.1, -0.1))


def _points(
    axes: Any, letter: str, degrees: Floats, parts: Mapping[str, Floats], kept: Flags
) -> None:
    """Draw residuals, um, over the angle of an axis; those not kept as crosses, near the rim."""
    turns = np.radians(degrees)
    most = max(float(np.abs(values[kept]).max()) for values in parts.values())
    for (name, values), colour, mark in zip(parts.items(), COLOURS, MARKS, strict=False):
        style: dict[str, Any] = {"color": colour, "linestyle": "none", "markersize": 4.0}
        axes.plot(turns[kept], values[kept], mark, gid=f"{letter} {name}", label=name, **style)
        if not kept.all():
            out = np.clip(values[~kept], -1.5 * most, 1.5 * most)
            axes.plot(turns[~kept], out, "x", gid=f"{letter} {name} left out", **style)
    division = magnified(axes, most)
    axes.set_title(f"residuals over {letter}, {division:g} um/div")
    axes.legend(loc="lower left", bbox_to_anchor=(-0.1, -0.1))
