"""LinuxCNC's canon calls as moves in mm and degrees.

Positions are in the active program coordinates: what G5x, G92, rotation and tool length shift is
taken off. A call that changes one of these changes the numbers of the place where the tool stands.
"""

import math
import re
from dataclasses import dataclass, field, replace

AXES = "XYZABC"
CALL = re.compile(r"\s*(?:\d+\s+)?N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")
SHIFTS = {
    "SET_G5X_OFFSET": "g5x",
    "SET_G92_OFFSET": "g92",
    "USE_TOOL_LENGTH_OFFSET": "tool",
    "SET_XY_ROTATION": "rotation",
}
TOUCHING = {"STRAIGHT_PROBE": "PROBE", "RIGID_TAP": "TAP"}
PLANES = {"XY": ("XY", "XYZ"), "XZ": ("ZX", "ZXY"), "YZ": ("YZ", "YZX")}
MODES = {"inverse time": "G93", "units per minute": "G94", "units per revolution": "G95"}
TOLD = {
    "MESSAGE",
    "LOG",
    "WAIT",
    "SET_MOTION_CONTROL_MODE",
    "SET_NAIVECAM_TOLERANCE",
    "SET_MOTION_OUTPUT_BIT",
    "CLEAR_MOTION_OUTPUT_BIT",
    "SET_AUX_OUTPUT_BIT",
    "CLEAR_AUX_OUTPUT_BIT",
    "SET_AUX_OUTPUT_VALUE",
    "SET_MOTION_OUTPUT_VALUE",
    "DISABLE_FEED_OVERRIDE",
    "DISABLE_SPEED_OVERRIDE",
    "SET_SPINDLE_MODE",
}
EVENTS = {
    "START_SPINDLE_CLOCKWISE": "M3",
    "START_SPINDLE_COUNTERCLOCKWISE": "M4",
    "STOP_SPINDLE_TURNING": "M5",
    "MIST_ON": "M7",
    "FLOOD_ON": "M8",
    "FLOOD_OFF": "M9",
    "OPTIONAL_PROGRAM_STOP": "M1",
    "CHANGE_TOOL": "M6",
    "ORIENT_SPINDLE": "M19",
    "PROGRAM_STOP": "M0",
}


@dataclass(frozen=True)
class CanonMove:
    """One canonical motion: mm and degrees, all six axes known, centre for arcs.

    `kind` is RAPID, LINE, ARC_CW, ARC_CCW; PROBE ends where it touches, at the latest at `end`; TAP
    goes to `end` and back; SPLINE is one piece of a curve whose numbers are not printed. `feed` is
    the rate that was set: mm/min (G94 and G93, where LinuxCNC has multiplied by the length of the
    path) or mm/rev; its second number is the same in degrees, for moves of rotary axes alone.
    `turns` counts the turns beyond the first. `unit` is the size of the program's unit in mm:
    positions are rounded to 1e-4 of it. `machine` says where `start`, `end` and `centre` are in
    coordinates of the machine.
    """

    kind: str
    start: dict[str, float]
    end: dict[str, float]
    line: int
    unit: float
    feed: tuple[float, float] | None = None
    feed_mode: str = "G94"
    plane: str = "XY"
    centre: tuple[float, float, float] | None = None
    turns: int = 0
    machine: tuple[dict[str, float], ...] = ()


@dataclass
class CanonProgram:
    """Moves, and events as (index of the move before which it happens, text).

    `told` is all that is no motion, the events among them, in its order.
    """

    moves: list[CanonMove] = field(default_factory=list)
    events: list[tuple[int, str]] = field(default_factory=list)
    told: list[tuple[int, str]] = field(default_factory=list)


@dataclass(frozen=True)
class Shifts:
    """What lies between the coordinates of the program and those of the machine: mm, degrees."""

    g5x: tuple[float, ...] = (0.0,) * 6
    g92: tuple[float, ...] = (0.0,) * 6
    tool: tuple[float, ...] = (0.0,) * 6
    rotation: float = 0.0

    def to_machine(self, at: dict[str, float]) -> dict[str, float]:
        """Return machine coordinates: G92 inside the rotation, G5x and tool outside."""
        shifted = {a: at[a] + self.g92[k] for k, a in enumerate(AXES)}
        turned = _turned(shifted, self.rotation)
        return {a: turned[a] + self.g5x[k] + self.tool[k] for k, a in enumerate(AXES)}

    def to_program(self, at: dict[str, float]) -> dict[str, float]:
        """Return program coordinates of a place in machine coordinates."""
        shifted = {a: at[a] - self.g5x[k] - self.tool[k] for k, a in enumerate(AXES)}
        turned = _turned(shifted, -self.rotation)
        return {a: turned[a] - self.g92[k] for k, a in enumerate(AXES)}


def _turned(at: dict[str, float], degrees: float) -> dict[str, float]:
    if not degrees:
        return at
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return at | {"X": at["X"] * c - at["Y"] * s, "Y": at["X"] * s + at["Y"] * c}


def parsed(text: str) -> CanonProgram:
    """Return the program of a recorded output, as of `rs274 -g`; lines are not known."""
    reader = Reader()
    for call in filter(None, map(CALL.match, text.splitlines())):
        reader.call(0, *call.groups())
    return reader.program


class Reader:
    """Consumes canon calls; `program` grows."""

    def __init__(self) -> None:
        self.program = CanonProgram()
        self.position = dict.fromkeys(AXES, 0.0)
        self.shifts = Shifts()
        self.unit = 1.0
        self.plane = "XY"
        self.mode = "G94"
        self.feed = (0.0, 0.0)  # mm, degrees
        self.pitch: float | None = None  # mm per turn of the spindle, in a thread or a tap
        self.changing = False  # inside a tool change, which stops the spindle
        self.shuttled = False
        self.ending = False  # inside M2 or M30, which stop spindle and coolant
        self.ended = False
        self.last = ""  # the previous call

    def call(self, line: int, name: str, text: str) -> None:
        """Take one canon call which came from `line`."""
        if self.ended:
            return
        if name.startswith(("STRAIGHT_TRAVERSE", "STRAIGHT_FEED")):
            end = dict(zip(AXES, self._numbers(text), strict=True))
            self._move(line, "LINE" if name.endswith("FEED") else "RAPID", self._scaled(end))
        elif name == "ARC_FEED":
            self._arc(line, self._numbers(text))
        elif name in TOUCHING:
            self._touch(line, TOUCHING[name], self._numbers(text))
        elif name in ("START_SPEED_FEED_SYNC", "STOP_SPEED_FEED_SYNCH"):
            self.pitch = float(text.split(",")[0]) * self.unit if text else None
        elif name == "NURBS_FEED":
            self._move(line, "SPLINE", self.position)
        elif name in SHIFTS:
            self._shift(SHIFTS[name], self._numbers(text))
        elif not self._mode(name, text):
            self._event(name, text)
        if name in TOLD and not self.ending:
            self.program.told.append((len(self.program.moves), f"{name} {text}"))
        self.last = name

    def _mode(self, name: str, text: str) -> bool:
        """Take a call that sets a mode; False if it is none."""
        if name == "USE_LENGTH_UNITS":
            self.unit = 25.4 if "INCHES" in text else 1.0
        elif name == "SELECT_PLANE":
            self.plane = text[-2:] if text[-2:] in PLANES else self.plane  # not UV, WU, VW
        elif name == "SET_FEED_RATE":
            rate = float(text)
            self.feed = (rate * self.unit, rate)
        elif name == "COMMENT" and "feed mode set to" in text:
            self.mode = MODES[re.sub(r'.*set to (.*)"', r"\1", text)]
        else:
            return False
        return True

    def _touch(self, line: int, kind: str, numbers: list[float]) -> None:
        """Take a probing move, or a tap, which comes back to where it began."""
        start = self.position
        end = start | self._scaled(dict(zip(AXES, numbers, strict=False)))
        self._move(line, kind, end)
        if kind == "TAP":
            self.position = start

    def _shift(self, name: str, numbers: list[float]) -> None:
        """Take another offset or rotation: the tool stands where it stood, under other numbers."""
        at = self.shifts.to_machine(self.position)
        if name == "rotation":
            self.shifts = replace(self.shifts, rotation=numbers[0])
        else:  # the first number of G5x says which one it is
            values = dict(zip(AXES, numbers[name == "g5x" :], strict=False))
            self.shifts = replace(self.shifts, **{name: tuple(self._scaled(values).values())})
        self.position = self.shifts.to_program(at)

    def _move(self, line: int, kind: str, end: dict[str, float], **arc: object) -> None:
        feed, mode = self.feed, self.mode
        if self.pitch is not None:
            feed, mode = (self.pitch, self.pitch), "G95"
        start = self.position
        machine = self.shifts.to_machine(start), self.shifts.to_machine(end)
        if "centre" in arc:
            centre = dict(zip("XYZ", arc["centre"], strict=True))  # type: ignore[call-overload]
            machine += (self.shifts.to_machine(start | centre),)
        self.program.moves.append(
            CanonMove(
                kind,
                start,
                end,
                line,
                self.unit,
                None if kind == "RAPID" else feed,
                mode,
                PLANES[self.plane][0],
                machine=machine,
                **arc,  # type: ignore[arg-type]
            )
        )
        self.position = end

    def _arc(self, line: int, numbers: list[float]) -> None:
        axes = PLANES[self.plane][1]
        first, second, centre1, centre2, rotation, normal, *rotary = numbers
        end = dict(zip(axes, (first, second, normal), strict=True))
        end = self._scaled(end | dict(zip("ABC", rotary, strict=True)))
        plane_centre = (centre1 * self.unit, centre2 * self.unit, self.position[axes[2]])
        at = dict(zip(axes, plane_centre, strict=True))
        kind = "ARC_CW" if rotation < 0 else "ARC_CCW"
        self._move(
            line,
            kind,
            {axis: end[axis] for axis in AXES},
            centre=(at["X"], at["Y"], at["Z"]),
            turns=int(abs(rotation)) - 1,
        )

    def _event(self, name: str, text: str) -> None:
        if name == "SET_SPINDLE_MODE" and self.last == "STOP_SPINDLE_TURNING":
            self.ending = True
            self.program.events.pop()
            self.program.told.pop()
        elif name == "START_CHANGE":
            self.changing = True
        elif name == "PALLET_SHUTTLE":
            self.shuttled = True
        elif name == "PROGRAM_END":
            self._say("M30" if self.shuttled else "M2")
            self.ended = True
        elif name == "SELECT_TOOL":
            self._say(f"T{int(text)}")
        elif name == "SET_SPINDLE_SPEED":
            self._say(f"S{float(text.split(',')[1]):.10g}")
        elif name == "DWELL":
            self._say(f"DWELL {float(text):.10g}")
        elif (
            name in EVENTS
            and not self.ending
            and not (name == "STOP_SPINDLE_TURNING" and self.changing)
        ):
            stop = name == "PROGRAM_STOP" and self.shuttled
            self._say("M60" if stop else EVENTS[name])
            self.changing = self.shuttled = False

    def _say(self, text: str) -> None:
        self.program.events.append((len(self.program.moves), text))
        self.program.told.append((len(self.program.moves), text))

    def _numbers(self, text: str) -> list[float]:
        return [float(number) for number in text.replace(",", " ").split()]

    def _scaled(self, position: dict[str, float]) -> dict[str, float]:
        return {a: v if a in "ABC" else v * self.unit for a, v in position.items()}
