"""The program that probes balls at planned poses, and the centres of what it touched.

Each ball is touched along the probe, and from four sides across it through its centre: square to
each other, half way between where its post may be when table or head are tilted. From two opposite
touches comes the centre along their line, whatever the radius; from the one along the probe, which
need not be over the middle, its height by the radius of ball and stylus together. Where the spindle
is upright that is from above; a head that turns takes all of it along. Positions are those of the
axes: no tool length, and a work offset of 0, so that nothing has to be known to read the touches.
Where no probe is named they are those of the tip, and the work offset has to make them so. A probe
that is turned does not move while it touches, so X, Y and Z move as its tip does.

Nothing in the program is computed by the control, because what a probe finds could not be read
again.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from gcxform.calibrate.bundle.bundle import Poses
from gcxform.calibrate.bundle.clearance import hangs, least_height
from gcxform.diagnostics import InputError, Location, UsageError
from gcxform.errormodel.model import AXES
from gcxform.machine.chain import Chain
from gcxform.system.arrays import Floats
from gcxform.values import dataclass

TOUCHES: Final = 5
ANGLE: Final = 0.01  # degrees; a log that says others belongs to other poses
ORDER: Final = "XYZABC"  # of the columns of a log
OF_AXES: Final = "(POSITIONS OF THE AXES: G54 HAS TO BE 0, NO TOOL LENGTH AND NO RTCP IN FORCE)"
OF_TIP: Final = (
    "(POSITIONS OF THE TIP: G54 HAS TO HAVE THE LENGTH OF THE PROBE, NO TOOL LENGTH AND NO RTCP)"
)
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
    height, over = _height(chain, poses, probing)
    blocks = _Blocks(style, height)
    blocks.lines += ["%", "O1"] if dialect == "fanuc" else []
    blocks.lines += [
        f"(BALLS AT {len(poses.points)} POSES, {TOUCHES} TOUCHES EACH)",
        OF_AXES if any(chain.tip) else OF_TIP,
        "(MOVES BETWEEN THE TOUCHES ARE NOT GUARDED: TRY THEM WITH CARE)",
        *(["(THE HEAD TURNS: START WITH ALL ROTARY AXES AT 0)"] if chain.head else []),
        *([] if over else ["(THE TABLE LIFTS BALLS ABOVE THE TIP WHILE IT TURNS: MIND THEIR WAY)"]),
        "G21 G90 G94 G17 G40 G49 G54",
        *style.head,
    ]
    for k in range(len(poses.points)):
        blocks.lines.append(f"(POSE {k + 1}, BALL {poses.ball[k]})")
        _probe_pose(blocks, chain, poses.points[k], poses.degrees[k], probing)
    blocks.up()
    return "\n".join([*blocks.lines, *style.tail]) + "\n"


def _height(chain: Chain, poses: Poses, probing: Probing) -> tuple[float, bool]:
    """Return where Z is while axes turn, as high as it goes, and whether that is above all balls.

    A head has to be. A table that tilts may lift a ball higher than Z goes, somewhere else; so for
    it only the poses themselves have to be lower. Raises UsageError (GX491).
    """
    if hangs(chain, poses.degrees):
        message = "between the poses the head may turn past the horizontal"
        hint = "limit the axes of the head in the machine file, or allow less tilt"
        raise UsageError.one("GX491", message, hint=hint)
    tips = chain.tip_at(poses.points, poses.degrees)
    balls = np.array([tips[poses.ball.index(name)] for name in poses.balls])
    room, high = probing.radius + probing.clearance, chain.travel[2][1]
    over = least_height(chain, balls, poses.degrees, room)
    if not np.isfinite(high):
        return float(np.ceil(over + 100.0)), True
    least = over if chain.head else float(poses.points[:, 2].max()) + room
    if high < least:
        message = f"Z has to be at {least:.1f} to be above the balls, and it goes up to {high:g}"
        hint = "put the balls lower, or take a shorter probe; a head that turns needs more"
        raise UsageError.one("GX491", message, hint=hint)
    return float(high), high >= over


def _probe_pose(
    blocks: _Blocks, chain: Chain, centre: Floats, degrees: Floats, probing: Probing
) -> None:
    """Write the blocks that probe a ball at a pose: along the probe, then from the sides."""
    outside, inside = probing.radius + probing.clearance, probing.radius - probing.clearance
    along = chain.spindle(degrees[None, :])[0]
    above = centre + outside * along
    blocks.up()
    blocks.turn(dict(zip(chain.letters, degrees.tolist(), strict=True)))
    blocks.rapid("XY", above)
    blocks.feed(above)
    blocks.touch(centre + inside * along)
    blocks.feed(above)
    for side in sides(chain, degrees):
        blocks.feed(above + outside * side)
        blocks.feed(centre + outside * side)
        blocks.touch(centre + inside * side)
        blocks.feed(centre + outside * side)
        blocks.feed(above + outside * side)


class _Blocks:
    """The blocks of a program, in which only those coordinates are written that change."""

    def __init__(self, style: Style, up: float) -> None:
        self.style = style
        self.height = np.array([0.0, 0.0, up])
        self.lines: list[str] = []
        self._at: dict[str, str] = {}

    def up(self) -> None:
        """Go to where axes may turn."""
        self.rapid("Z", self.height)

    def turn(self, degrees: Mapping[str, float]) -> None:
        """Turn all rotary axes."""
        self.lines.append(" ".join(["G0", *(f"{a}{_number(d)}" for a, d in degrees.items())]))

    def rapid(self, letters: str, place: Floats) -> None:
        """Go to some coordinates of a place."""
        self._go("G0", letters, place)

    def feed(self, place: Floats) -> None:
        """Go to a place in a straight line."""
        self._go("G1", "XYZ", place, f"F{_number(FEEDS['way'])}")

    def touch(self, place: Floats) -> None:
        """Probe towards a place. It ends before, and the way back writes whatever moved."""
        self._go(self.style.probe, "XYZ", place, f"F{_number(FEEDS['probe'])}")
        if self.style.after:
            self.lines.append(self.style.after)

    def _go(self, code: str, letters: str, place: Floats, *after: str) -> None:
        there = {a: _number(float(place[AXES.index(a)])) for a in letters}
        words = [f"{a}{text}" for a, text in there.items() if text != self._at.get(a)]
        self._at |= there
        if words:
            self.lines.append(" ".join([code, *words, *after]))


def sides(chain: Chain, degrees: Floats) -> Floats:
    """Return the directions (4, 3) across the probe from which a ball is touched at angles (m,).

    Opposite ones are beside each other. The post of the ball points out of the table.
    """
    along, up = chain.spindle(degrees[None, :])[0], chain.upwards(degrees[None, :])[0]
    toward = up - (up @ along) * along
    if np.linalg.norm(toward) <= 1e-9:
        near = np.eye(3)[int(np.abs(along).argmin())]
        toward = near - (near @ along) * along
    toward /= np.linalg.norm(toward)
    turns = np.radians([45.0, 225.0, 135.0, 315.0])[:, None]
    return np.asarray(np.cos(turns) * toward + np.sin(turns) * np.cross(along, toward))


# --- what was touched ---


def centres(chain: Chain, plan: Poses, touches: Floats, radius: float, file: str) -> Poses:
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
    along = chain.spindle(plan.degrees)
    aside = found[:, 1:].sum(axis=1) / 2.0  # of two middles; across, both sides cancel
    aside -= (aside * along).sum(axis=1, keepdims=True) * along
    if (far := np.linalg.norm(aside, axis=1)).max() >= radius:
        message = f"the ball of pose {int(far.argmax()) + 1} is {far.max():.3g} mm from its plan"
        raise InputError.one("GX492", message, Location(file))
    height = (found[:, 0] * along).sum(axis=1) - np.sqrt(radius**2 - far**2)
    points = plan.points + aside + height[:, None] * along
    return replace(plan, points=points)


def _check_angles(chain: Chain, plan: Poses, touches: Floats, file: str) -> None:
    for k, letter in enumerate(chain.letters):
        column = ORDER.index(letter)
        if column >= touches.shape[1]:
            continue
        away = touches[:, column] - np.repeat(plan.degrees[:, k], TOUCHES)
        wrong = np.flatnonzero(np.abs(np.remainder(away + 180.0, 360.0) - 180.0) > ANGLE)
        if len(wrong):
            message = f"{letter} stood at {touches[wrong[0], column]:g} degrees, not as planned"
            raise InputError.one("GX492", message, Location(file, int(wrong[0]) + 1))


def parse_touches(text: str, file: str) -> Floats:
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


def _number(value: float) -> str:
    """Return a number with its point, three decimals at most, never -0."""
    text = f"{value:.3f}".rstrip("0")
    return "0." if text in ("-0.", "0.") else text
