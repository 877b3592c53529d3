"""LinuxCNC's canon calls as moves in mm and degrees."""

import re
from dataclasses import dataclass, field

from oracles.frames import AXES, Coordinates, Point

PLANES = {"XY": ("XY", "XYZ"), "XZ": ("ZX", "ZXY"), "YZ": ("YZ", "YZX")}
MODES = {"inverse time": "G93", "units per minute": "G94", "units per revolution": "G95"}
EVENTS = {
    "START_SPINDLE_CLOCKWISE": "M3",
    "START_SPINDLE_COUNTERCLOCKWISE": "M4",
    "STOP_SPINDLE_TURNING": "M5",
    "MIST_ON": "M7",
    "FLOOD_ON": "M8",
    "FLOOD_OFF": "M9",
    "OPTIONAL_PROGRAM_STOP": "M1",
    "CHANGE_TOOL": "M6",
    "PROGRAM_STOP": "M0",
}


@dataclass(frozen=True)
class CanonMove:
    """One canonical motion: mm and degrees, all six axes known, centre for arcs.

    `feed` is the rate that was set: mm/min (G94 and G93, where LinuxCNC has multiplied by the
    length of the path) or mm/rev; its second number is the same in degrees, for moves of rotary
    axes alone. `turns` counts the turns beyond the first. `unit` is the size of the program's
    unit in mm: positions are rounded to 1e-4 of it. `start`, `end` and `centre` are in coordinates
    of the program (X is a radius), `machine` says where `start`, `end` and `centre` are in those of
    the machine.
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
    machine: tuple[Point, ...] = ()


@dataclass
class CanonProgram:
    """Moves, and events as (index of the move before which it happens, text)."""

    moves: list[CanonMove] = field(default_factory=list)
    events: list[tuple[int, str]] = field(default_factory=list)


class Reader:
    """Consumes canon calls; `program` grows."""

    def __init__(self) -> None:
        self.program = CanonProgram()
        self.coordinates = Coordinates()
        self.place = dict.fromkeys(AXES, 0.0)  # of the machine
        self.unit = 1.0
        self.plane = "XY"
        self.mode = "G94"
        self.feed = (0.0, 0.0)  # mm, degrees
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
        elif name == "USE_LENGTH_UNITS":
            self.unit = 25.4 if "INCHES" in text else 1.0
        elif name == "SELECT_PLANE":
            self.plane = text[-2:] if text[-2:] in PLANES else self.plane  # not UV, WU, VW
        elif name == "SET_FEED_RATE":
            rate = float(text)
            self.feed = (rate * self.unit, rate)
        elif name == "COMMENT" and "feed mode set to" in text:
            self.mode = MODES[re.sub(r'.*set to (.*)"', r"\1", text)]
        elif not self.coordinates.call(name, text, self.unit):
            self._event(name, text)
        self.last = name

    @property
    def position(self) -> Point:
        """Where the machine is, in coordinates of the program."""
        return self.coordinates.program(self.place)

    def _move(self, line: int, kind: str, end: Point, **arc: object) -> None:
        start, machine = self.position, (self.place, self.coordinates.machine(end))
        if "centre" in arc:
            centre = dict(zip("XYZ", arc["centre"], strict=True))  # type: ignore[call-overload]
            machine += (self.coordinates.machine(start | centre),)
        self.program.moves.append(
            CanonMove(
                kind,
                start,
                end,
                line,
                self.unit,
                None if kind == "RAPID" else self.feed,
                self.mode,
                PLANES[self.plane][0],
                machine=machine,
                **arc,  # type: ignore[arg-type]
            )
        )
        self.place = machine[1]

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

    def _numbers(self, text: str) -> list[float]:
        return [float(number) for number in text.split(",")]

    def _scaled(self, position: dict[str, float]) -> dict[str, float]:
        return {a: v if a in "ABC" else v * self.unit for a, v in position.items()}
