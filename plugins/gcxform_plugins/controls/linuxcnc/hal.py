"""LinuxCNC's kinematics as machines: the pins of its modules, as HAL files set them.

| module | axes | where they are |
|---|---|---|
| xyzac-trt-kins | A carries C | C at rot-point; A at rot-point + (0, y-offset, z-offset) |
| xyzbc-trt-kins | B carries C | C at rot-point; B at rot-point + (x-offset, 0, z-offset) |
| 5axiskins | head, C carries B | C at 0; B at (0, 0, pivot-length), left-handed |
| maxkins | table C, head B | C at 0; B at (0, 0, pivot-length), left-handed |

The tables of the trt modules turn right-handed, against ISO 841, unless `conventional-directions`
is set. Checked against the forward functions of the modules as installed, but for maxkins, whose
forward function is wrong where C is not 0: against its inverse. A pin that is not set is 0, but for
the pivot length, of which the modules have lengths of their own: it has to be set.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import gcxform as gx
from gcxform.vocabulary import Axis, Machine, control_lines

UNITS = {"mm": Decimal(1), "in": Decimal("25.4")}
TOOL = "tool-offset"
CONVENTIONAL = "conventional-directions"
PIVOT = "pivot-length"
_ROT = ("x-rot-point", "y-rot-point", "z-rot-point")
PINS = {
    "xyzac-trt-kins": (*_ROT, "x-offset", "y-offset", "z-offset", TOOL, CONVENTIONAL),
    "xyzbc-trt-kins": (*_ROT, "x-offset", "y-offset", "z-offset", TOOL, CONVENTIONAL),
    "5axiskins": (PIVOT,),
    "maxkins": (PIVOT,),
}
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
TRUTHS = {"true": 1.0, "yes": 1.0, "on": 1.0, "false": 0.0, "no": 0.0, "off": 0.0}
_HALCMD = re.compile(r"^\s*HALCMD\s*=")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")


def read_hal(path: Path, unit: str) -> Machine:
    """Return the machine whose kinematics a HAL file sets up, or the HALCMD lines of an INI file.

    `unit` is that of the machine, mm or in. Raises FileError, and UsageError with the line for what
    cannot be taken over.
    """
    hal = _Hal(path)
    for line in control_lines(path, "utf-8"):
        hal.take(line)
    module, pins = hal.settings()
    return machine_of(module, pins, path, unit)


class _Hal:
    """What the lines of a file say of kinematics: values of pins, and of signals that pins have."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.modules: set[str] = set()
        self.values: dict[str, tuple[str, gx.Location]] = {}
        self.signals: dict[str, str] = {}
        self.nets: dict[str, tuple[str, gx.Location]] = {}
        self.findings: list[gx.Diagnostic] = []

    def take(self, where: gx.Location) -> None:
        """Take what a line says."""
        words = _HALCMD.sub("", where.text).partition("#")[0].split()
        modules = {word: word.partition(".")[0] for word in words[1:]}
        self.modules |= set(modules.values()) & set(PINS)
        named = [word for word, module in modules.items() if module in PINS and "." in word]
        match words:
            case ["setp", pin, value] if named == [pin]:
                self.values[pin] = (value, where)
            case ["sets", signal, value]:
                self.signals[signal] = value
            case ["net", signal, *_]:
                self.nets |= {pin: (signal, where) for pin in named}
            case _ if named:
                self._find(f"{named[0]} is set by something else than setp, net and sets", where)

    def settings(self) -> tuple[str, dict[str, float]]:
        """Return the module and the values of its pins. Raises UsageError."""
        for pin, (signal, where) in self.nets.items():
            if signal in self.signals:
                self.values[pin] = (self.signals[signal], where)
            elif not pin.endswith(f".{TOOL}"):
                self._find(f"the signal {signal} of {pin} has no value: set it by sets", where)
        pins = {name.partition(".")[2]: self._value(name, *v) for name, v in self.values.items()}
        if len(self.modules) != 1:
            some = " and ".join(sorted(self.modules)) or "none"
            message = f"a machine has one kind of kinematics, here is {some}"
            self._find(message, gx.Location(str(self.path)), f"known: {', '.join(PINS)}")
        for module in self.modules:
            self._check_pivot(module)
        if self.findings:
            raise gx.UsageError(tuple(self.findings))
        return self.modules.pop(), pins

    def _check_pivot(self, module: str) -> None:
        """Add a finding if a module that has a pivot is left with a length of its own."""
        pin = f"{module}.{PIVOT}"
        if PIVOT in PINS[module] and pin not in self.values and pin not in self.nets:
            message = f"{pin} is not set, and then {module} takes a length of its own"
            self._find(message, gx.Location(str(self.path)), f"write setp {pin} 250.0")

    def _value(self, name: str, text: str, where: gx.Location) -> float:
        """Return the value of a pin; add a finding if it has none that can be taken over."""
        module, _, pin = name.partition(".")
        number = _NUMBER.fullmatch(text)
        value = float(text) if number else TRUTHS.get(text.lower(), math.nan)
        if pin not in PINS[module]:
            self._find(f"{name} is not a pin that is known", where)
        elif not math.isfinite(value):
            self._find(f"{text!r} is not a number: write the value here", where)
        elif pin == TOOL and value:
            self._find(f"{name} is the length of a tool", where, "give it as [tool.1]")
        return value

    def _find(self, message: str, where: gx.Location, hint: str = "") -> None:
        self.findings.append(gx.Diagnostic("GX454", message, where, hint))


# --- pins to axes ---


def machine_of(module: str, pins: dict[str, float], file: Path, unit: str = "mm") -> Machine:
    """Return the machine of a module with its pins, which are in mm or in."""
    table, head = _CHAINS[module]
    axes = dict(_axes(module, pins, unit))
    return Machine(file=file, name=module, table=table, head=head, axes=axes)


_CHAINS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "xyzac-trt-kins": (("A", "C"), ()),
    "xyzbc-trt-kins": (("B", "C"), ()),
    "5axiskins": ((), ("C", "B")),
    "maxkins": (("C",), ("B",)),
}


def _axes(module: str, pins: dict[str, float], unit: str) -> Iterator[tuple[str, Axis]]:
    """Yield the rotary axes by their letters."""
    at = {pin: float(Decimal(repr(value)) * UNITS[unit]) for pin, value in pins.items()}
    if module in ("5axiskins", "maxkins"):
        yield "C", Axis(direction=Z, point=(0.0, 0.0, 0.0), sign=1 if module[0] == "5" else -1)
        yield "B", Axis(direction=Y, point=(0.0, 0.0, at[PIVOT]), sign=-1)
        return
    sign = -1 if pins.get(CONVENTIONAL) else 1
    x, y, z = (at.get(pin, 0.0) for pin in _ROT)
    up = z + at.get("z-offset", 0.0)
    if module == "xyzac-trt-kins":
        yield "A", Axis(direction=X, point=(x, y + at.get("y-offset", 0.0), up), sign=sign)
    else:
        yield "B", Axis(direction=Y, point=(x + at.get("x-offset", 0.0), y, up), sign=sign)
    yield "C", Axis(direction=Z, point=(x, y, z), sign=sign)
