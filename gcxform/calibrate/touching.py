"""The program that probes balls at planned poses, and the centres of what it touched.

Each ball is touched from above, and from four sides at the height of its centre: square to each
other, half way between where its post may be when the table is tilted. From two opposite touches
comes the centre along their line, whatever the radius; from the one above, which need not be above
the middle, its height by the radius of ball and stylus together. Positions are those of the axes:
no tool length, and a work offset of 0, so that nothing has to be known to read the touches.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from gcxform.calibrate.bundle import Poses
from gcxform.diagnostics import InputError, Location, UsageError
from gcxform.machine.chain import Chain
from gcxform.machine.errors import AXES, FloatArray

TOUCHES: Final = 5
ANGLE: Final = 0.01  # degrees; a log that says others belongs to other poses
ORDER: Final = "XYZABC"  # of the columns of a log
FEEDS: Final = {"way": 1000.0, "probe": 100.0}  # mm/min


@dataclass(frozen=True)
class Style:
    """How a control is told to probe: its code, what is written around, how it ends."""

    probe: str
    head: tuple[str, ...]
    tail: tuple[str, ...]
    after: str = ""


STYLES: Final = {
    "linuxcnc": Style("G38.2", ("(PROBEOPEN touches.txt)",), ("(PROBECLOSE)", "M2")),
    "fanuc": Style("G31", (), ("M30", "%"), "M0 (NOTE THE SKIP POSITION, #5061 TO #5063)"),
}
"""LinuxCNC writes what it touches to a file; on other controls the operator reads it."""


@dataclass(frozen=True)
class Probing:
    """Lengths in mm: the radii of ball and stylus together, the way on either side of a touch."""

    radius: float
    clearance: float


def probing_program(
    chain: Chain, poses: Poses, probing: Probing, dialect: str, after: str | None = None
) -> str:
    """Return the program, with a block `after` each touch. Raises UsageError (GX491)."""
    style = STYLES[dialect]
    style = style if after is None else replace(style, after=after)
    up = _height(chain, poses, probing)
    lines = ["%", "O1"] if dialect == "fanuc" else []
    lines += [
        f"(BALLS AT {len(poses.points)} POSES, {TOUCHES} TOUCHES EACH)",
        "(POSITIONS OF THE AXES: G54 HAS TO BE 0 AND NO TOOL LENGTH IN FORCE)",
        "(MOVES BETWEEN THE TOUCHES ARE NOT GUARDED: TRY THEM WITH CARE)",
        "G21 G90 G94 G17 G40 G49 G54",
        *style.head,
        f"G0 Z{_number(up)}",
    ]
    for k in range(len(poses.points)):
        lines += _pose(chain, poses, k, probing, style, up)
    return "\n".join([*lines, f"G0 Z{_number(up)}", *style.tail]) + "\n"


def _height(chain: Chain, poses: Poses, probing: Probing) -> float:
    """Return where Z is while the table turns: as high as it goes, or well above all balls."""
    high = chain.travel[2][1]
    top = float(poses.points[:, 2].max()) + probing.radius + probing.clearance
    if np.isfinite(high):
        if high < top:
            raise UsageError.one("GX491", "there is no room above the highest ball")
        return float(high)
    return float(np.ceil(top + 100.0))


def _pose(
    chain: Chain, poses: Poses, k: int, probing: Probing, style: Style, up: float
) -> Iterator[str]:
    """Yield the blocks that probe a ball at a pose."""
    centre, degrees = poses.points[k], poses.degrees[k]
    pairs = zip(chain.letters, degrees.tolist(), strict=True)
    turn = " ".join(f"{letter}{_number(angle)}" for letter, angle in pairs)
    outside, inside = probing.radius + probing.clearance, probing.radius - probing.clearance
    upwards, way = np.array([0.0, 0.0, 1.0]), _number(FEEDS["way"])
    above = _words("Z", centre + outside * upwards)
    yield f"(POSE {k + 1}, BALL {poses.ball[k]})"
    yield f"G0 Z{_number(up)}"
    yield f"G0 {turn}"
    yield f"G0 {_words('XY', centre)}"
    yield f"G1 {above} F{way}"
    yield from _touch(style, _words("Z", centre + inside * upwards))
    yield f"G1 {above} F{way}"
    for side in sides(chain, degrees):
        yield f"G1 {_words('XY', centre + outside * side)}"
        yield f"G1 {_words('Z', centre)}"
        yield from _touch(style, _words("XY", centre + inside * side))
        yield f"G1 {_words('XY', centre + outside * side)} F{way}"
        yield f"G1 {above}"


def _touch(style: Style, words: str) -> Iterator[str]:
    yield f"{style.probe} {words} F{_number(FEEDS['probe'])}"
    if style.after:
        yield style.after


def sides(chain: Chain, degrees: FloatArray) -> FloatArray:
    """Return the directions (4, 3) in X and Y from which a ball is touched at angles (m,).

    Opposite ones are beside each other. The post of the ball points out of the table.
    """
    ends = chain.onto_machine(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]), degrees[None, :])
    x, y, _ = (ends[0] - ends[1]).tolist()
    toward = float(np.arctan2(y, x)) if np.hypot(x, y) > 1e-9 else 0.0
    turns = toward + np.radians([45.0, 225.0, 135.0, 315.0])
    return np.column_stack([np.cos(turns), np.sin(turns), np.zeros(4)])


# --- what was touched ---


def centres(chain: Chain, plan: Poses, touches: FloatArray, radius: float, file: str) -> Poses:
    """Return the centres that touches (5 n, 3 and more) in mm tell at the poses (n) of a plan.

    Columns after the third are A, B and C, if there are any, and are compared. Raises InputError
    (GX492) for touches that are not those of the plan.
    """
    count = len(plan.points)
    if len(touches) != TOUCHES * count:
        message = f"{len(touches)} touches are not {TOUCHES} at each of {count} poses"
        raise InputError.one("GX492", message, Location(file))
    _check_angles(chain, plan, touches, file)
    found = touches[:, :3].reshape(count, TOUCHES, 3) - plan.points[:, None]
    aside = found[:, 1:, :2].sum(axis=1) / 2.0  # of two middles; across, both sides cancel
    if (far := np.linalg.norm(aside, axis=1)).max() >= radius:
        message = f"the ball of pose {int(far.argmax()) + 1} is {far.max():.3g} mm from its plan"
        raise InputError.one("GX492", message, Location(file))
    points = plan.points.copy()
    points[:, :2] += aside
    points[:, 2] += found[:, 0, 2] - np.sqrt(radius**2 - far**2)
    return replace(plan, points=points)


def _check_angles(chain: Chain, plan: Poses, touches: FloatArray, file: str) -> None:
    for k, letter in enumerate(chain.letters):
        column = ORDER.index(letter)
        if column >= touches.shape[1]:
            continue
        away = touches[:, column] - np.repeat(plan.degrees[:, k], TOUCHES)
        wrong = np.flatnonzero(np.abs(np.remainder(away + 180.0, 360.0) - 180.0) > ANGLE)
        if len(wrong):
            message = f"{letter} stood at {touches[wrong[0], column]:g} degrees, not as planned"
            raise InputError.one("GX492", message, Location(file, int(wrong[0]) + 1))


def parse_touches(text: str, file: str) -> FloatArray:
    """Return the numbers (n, m) of a log of touches, a line each. Raises InputError (GX492)."""
    rows: list[list[float]] = []
    for number, line in enumerate(text.splitlines(), 1):
        try:
            row = [float(part) for part in line.replace(",", " ").split()]
        except ValueError:
            row = []
        if len(row) < 3 or not np.isfinite(row).all() or (rows and len(row) != len(rows[0])):
            message = "the line is not X, Y and Z of a touch, as the lines before it"
            raise InputError.one("GX492", message, Location(file, number, 1, line, len(line)))
        rows.append(row)
    return np.array(rows).reshape(len(rows), -1)


def _words(letters: Sequence[str], place: FloatArray) -> str:
    return " ".join(f"{a}{_number(float(place[AXES.index(a)]))}" for a in letters)


def _number(value: float) -> str:
    """Return a number with its point, three decimals at most, never -0."""
    text = f"{value:.3f}".rstrip("0")
    return "0." if text in ("-0.", "0.") else text
