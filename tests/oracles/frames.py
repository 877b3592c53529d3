"""Which coordinates LinuxCNC is in, as its canon calls say: where the machine is with a point.

    machine = rotation @ (point + G92) + work offset + tool

with the rotation about Z. All of it in mm and degrees.
"""

import math
from collections.abc import Mapping

AXES = "XYZABC"
Point = dict[str, float]


class Coordinates:
    """The offsets in force."""

    def __init__(self) -> None:
        self.work = dict.fromkeys(AXES, 0.0)
        self.preset = dict.fromkeys(AXES, 0.0)
        self.tool = dict.fromkeys(AXES, 0.0)
        self.angle = 0.0

    def call(self, name: str, text: str, unit: float) -> bool:
        """Take a canon call; return whether it was about coordinates. `unit` is mm."""
        if name == "SET_XY_ROTATION":
            self.angle = float(text)
        elif name == "SET_G5X_OFFSET":
            self.work = _point(text.split(",")[1:], unit)
        elif name == "SET_G92_OFFSET":
            self.preset = _point(text.split(","), unit)
        elif name == "USE_TOOL_LENGTH_OFFSET":
            self.tool = _point(text.replace(",", " ").split()[:6], unit)
        else:
            return False
        return True

    def machine(self, point: Mapping[str, float]) -> Point:
        """Return the machine coordinates of a point of the program."""
        inner = {a: point[a] + self.preset[a] for a in AXES}
        turned = inner | _turned(inner, self.angle)
        return {a: turned[a] + self.work[a] + self.tool[a] for a in AXES}

    def program(self, machine: Mapping[str, float]) -> Point:
        """Return the coordinates in the program of a point of the machine."""
        outer = {a: machine[a] - self.work[a] - self.tool[a] for a in AXES}
        turned = outer | _turned(outer, -self.angle)
        return {a: turned[a] - self.preset[a] for a in AXES}


def _point(numbers: list[str], unit: float) -> Point:
    values = dict(zip(AXES, map(float, numbers), strict=True))
    return {a: v if a in "ABC" else v * unit for a, v in values.items()}


def _turned(point: Mapping[str, float], degrees: float) -> Point:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {"X": c * point["X"] - s * point["Y"], "Y": s * point["X"] + c * point["Y"]}
