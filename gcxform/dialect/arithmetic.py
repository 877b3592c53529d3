"""How a control computes: operators, functions, and which parameters belong to programs.

Controls differ in what the same expression is worth, so a dialect names its own `Arithmetic`.
`RS274` is LinuxCNC's, as its stand-alone interpreter executes it. `MACRO_B` is Fanuc's as it is
commonly known: what is known in two ways (the range of an arctangent, logic, the rounding of
halves below zero and of negative numbers) has no value here.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import field
from typing import Any

import numpy as np

from gcxform.dialect.machine_parameters import FANUC, MachineParameters, NamedParameters, among
from gcxform.values import dataclass

PI = np.longdouble("3.14159265358979323846264338327950288")
NEAR = 1e-9  # of a number: so far may another control's arithmetic be off
EQUAL = 1e-4  # numbers that differ by less are equal to LinuxCNC
ROUNDED = "round it in a block before, #100=ROUND[...] for one, and name that here"
INTEGER = 1e-4  # LinuxCNC takes what is as near to a whole number for that number
LARGEST_INT = 2.0**31

Key = int | str
"""What names a parameter: its number, or its name in small letters without blanks."""
Operator = Callable[[float, float], float]
Function = Callable[..., float]
COLUMNS: dict[Function, Callable[..., Any]] = {
    operator.mul: operator.mul,
    operator.add: operator.add,
    operator.sub: operator.sub,
}
"""Functions that are the same, bit by bit, for every element of arrays; nan: it has no value."""


class NoValueError(Exception):
    """An expression without a value, or without one that is known: why, and what to do.

    `lost`: it has a value, and only the machine knows it, so that what it goes into is lost.
    """

    def __init__(
        self, message: str, hint: str = "", code: str = "GX221", lost: bool = False
    ) -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint
        self.code = code
        self.lost = lost


@dataclass(frozen=True, slots=True)
class Arithmetic:
    """What a control can compute, and how.

    own           numbers of the parameters that a program may use as it likes
    named         whether parameters may have names
    system        names that belong to the control
    whole         addresses whose computed value must be a whole number
    whole_slip    how far from one it may be
    not_in_words  functions that do something else in a word than in an assignment
    beside_words  an assignment may stand beside words and other assignments; all of them take
                  effect after their block
    local         numbers of the parameters that end with their call, or with the program
    digits        significant digits of a number that may be written; 17 are all there are
    machine       what is known of the parameters that belong to the control
    """

    operators: Mapping[str, Operator]
    functions: Mapping[str, Function]
    own: tuple[range, ...]
    named: bool
    system: frozenset[str]
    whole: str
    whole_slip: float
    not_in_words: frozenset[str] = frozenset()
    beside_words: bool = True
    local: range = range(0)
    digits: int = 17
    machine: MachineParameters = field(default_factory=lambda: MachineParameters())

    def owns(self, key: Key) -> bool:
        """Return whether a parameter belongs to programs, and not to the control."""
        if isinstance(key, int):
            return any(key in numbers for numbers in self.own)
        return self.named and key.split("[")[0] not in self.system

    def may_be_given(self, key: Key) -> bool:
        """Return whether a value of a parameter may be told that the program does not set."""
        return self.owns(key) or (isinstance(key, str) and key.startswith(self.machine.names.given))

    def sets(self, key: Key) -> bool:
        """Return whether a program may set a parameter, and what changes by it is followed."""
        return self.owns(key) or among(key, self.machine.outputs) or self.writes_table(key)

    def writes_table(self, key: Key) -> bool:
        """Return whether a parameter is an entry of the control's table of tools, or of zeros."""
        return among(key, self.machine.lengths) or among(key, self.machine.zeros)

    def behind(self, key: Key, value: float) -> dict[Key, float]:
        """Return parameters behind an assignment: only the control knows those of its own."""
        return {key: value if self.owns(key) else math.nan}

    def cell(self, key: Key) -> Key:
        """Return the name by which a parameter is known here that has another one."""
        aliases = self.machine.aliases
        own = (int(key) - off for each, off in aliases if among(key, (each,)))
        return next(filter(self.owns, own), key)

    def exists(self, key: Key) -> bool:
        """Return whether a parameter has a value, if only the machine may know which."""
        if isinstance(key, int):
            return 0 < key <= self.machine.highest
        named = self.named and key.split("[")[0] not in self.machine.names.hidden
        return named and (key.startswith("_") or not self.owns(key))

    def hangs_on(self, key: Key) -> str:
        """Return on what of a program the value of a parameter depends, as `Unknown` has it."""
        known = self.machine
        if self.owns(key) or among(key, known.signals):
            return ""
        if isinstance(key, str) and key.split("[")[0] in known.names.signals:
            return ""
        if key in known.motion:
            return "motion"
        return "units" if among(key, known.measured) else "place"

    def outlives(self, key: Key) -> bool:
        """Return whether a parameter keeps its value when the program that has set it is over."""
        return key not in self.local if isinstance(key, int) else key.startswith("_")

    def acts(self, key: Key) -> bool:
        """Return whether a control does something when a program sets a parameter."""
        return not self.owns(key) and not among(key, self.machine.counters)

    def can_say(self, key: Key) -> bool:
        """Return whether an assignment to a parameter can be written, and lasts as long here."""
        return self.owns(key) and self.outlives(key)


def whole(value: float, slip: float = INTEGER) -> int:
    """Return the whole number that a value stands for. Raises NoValueError."""
    nearest = math.floor(value + 0.5)
    if abs(value - nearest) > slip:
        raise NoValueError(f"{value:.10g} is not a whole number", ROUNDED)
    return nearest


# --- LinuxCNC ---


def _divide(a: float, b: float) -> float:
    if b == 0:
        raise NoValueError("this divides by zero")
    return a / b


COLUMNS[_divide] = lambda a, b: np.where(b == 0, np.nan, np.divide(a, b))


def _modulo(a: float, b: float) -> float:
    """Return what is left of a, never negative."""
    if b == 0:
        raise NoValueError("this divides by zero")
    rest = math.fmod(a, b)
    return rest if rest >= 0 else rest + abs(b)


def _power(a: float, b: float) -> float:
    if a < 0 and b != math.floor(b):
        raise NoValueError("a negative number has no power that is not whole")
    if a == 0 and b < 0:
        raise NoValueError("this divides by zero")
    return float(math.pow(a, b))


def _root(a: float) -> float:
    if a < 0:
        raise NoValueError("a negative number has no square root")
    return math.sqrt(a)


def _logarithm(a: float) -> float:
    if a <= 0:
        raise NoValueError("only positive numbers have a logarithm")
    return math.log(a)


def _round(a: float) -> float:
    """Return the nearest whole number; halves go away from zero."""
    if abs(a) >= LARGEST_INT - 1:
        raise NoValueError("the number is too large to be rounded")
    return math.copysign(math.floor(abs(a) + 0.5), a)


def _radians(a: float) -> np.longdouble:
    """Return an angle of degrees in radians, with the digits that LinuxCNC takes for it."""
    return np.longdouble(np.longdouble(a) * PI / 180)


def _turning(function: Callable[[np.longdouble], np.longdouble]) -> Function:
    """Return a function of an angle in degrees."""

    def turning(a: float) -> float:
        return float(function(_radians(a)))

    def columns(a: Any) -> Any:
        return function(a.astype(np.longdouble) * PI / 180).astype(np.float64)

    COLUMNS[turning] = columns
    return turning


def _angle(function: Callable[[np.longdouble], np.longdouble], name: str) -> Function:
    """Return a function that gives an angle in degrees, of a number between -1 and 1."""

    def angle(a: float) -> float:
        if not -1 <= a <= 1:
            raise NoValueError(f"{name} takes numbers from -1 to 1, and this is {a:.10g}")
        return float(function(np.longdouble(a)) * 180 / PI)

    return angle


def _arctangent(y: float, x: float) -> float:
    return float(np.arctan2(np.longdouble(y), np.longdouble(x)) * 180 / PI)


def _equal(a: float, b: float) -> bool:
    return abs(a - b) < EQUAL


SYSTEM_NAMES = """
_a _abs_a _abs_b _abs_c _abs_u _abs_v _abs_w _abs_x _abs_y _abs_z _absolute _adaptive_feed _b _c
_call_level _ccomp _coord_system _current_pocket _current_tool _feed _feed_hold _feed_override
_flood _hal _ijk_absolute_mode _imperial _incremental _ini _inverse_time _lathe_diameter_mode
_lathe_radius_mode _line _metric _mist _motion_mode _plane _remap_level _retract_old_z
_retract_r_plane _rpm _selected_pocket _selected_tool _speed_override _spindle_css_mode _spindle_cw
_spindle_on _spindle_rpm_mode _task _tool_offset _u _units_per_minute _units_per_rev _v _value
_value_returned _vmajor _vminor _w _x _y _z
"""


SIGNAL_NAMES = frozenset(
    f"_{name}"
    for name in (
        *("hal", "ini", "task", "vmajor", "vminor", "mist", "flood"),
        *("current_tool", "selected_tool", "current_pocket", "selected_pocket"),
        *("spindle_on", "spindle_cw", "feed_override", "speed_override"),
        *("adaptive_feed", "feed_hold"),
    )
)
"""Names of LinuxCNC that mean the same in any unit, mode and place."""

RS274 = Arithmetic(
    operators={
        "**": _power,
        "*": operator.mul,
        "/": _divide,
        "MOD": _modulo,
        "+": operator.add,
        "-": operator.sub,
        "EQ": lambda a, b: float(_equal(a, b)),
        "NE": lambda a, b: float(not _equal(a, b)),
        "GT": lambda a, b: float(a > b),
        "GE": lambda a, b: float(a >= b),
        "LT": lambda a, b: float(a < b),
        "LE": lambda a, b: float(a <= b),
        "AND": lambda a, b: float(a != 0 and b != 0),
        "OR": lambda a, b: float(a != 0 or b != 0),
        "XOR": lambda a, b: float((a != 0) != (b != 0)),
    },
    functions={
        "ABS": abs,
        "ACOS": _angle(np.arccos, "ACOS"),
        "ASIN": _angle(np.arcsin, "ASIN"),
        "ATAN/": _arctangent,
        "COS": _turning(np.cos),
        "EXP": math.exp,
        "FIX": lambda a: float(math.floor(a)),
        "FUP": lambda a: float(math.ceil(a)),
        "LN": _logarithm,
        "ROUND": _round,
        "SIN": _turning(np.sin),
        "SQRT": _root,
        "TAN": _turning(np.tan),
    },
    own=(range(1, 5001),),
    named=True,
    system=frozenset(SYSTEM_NAMES.split()),
    whole="DHLT",
    whole_slip=INTEGER,
    local=range(1, 31),
    machine=MachineParameters(
        outputs=(range(5061, 5071), range(5599, 5600)),
        signals=(range(5070, 5071), range(5399, 5401), range(5599, 5600)),
        names=NamedParameters(
            signals=SIGNAL_NAMES,
            given=("_ini[", "_hal["),
            hidden=frozenset({"_line", "_call_level", "_remap_level"}),
        ),
        motion=frozenset({"_motion_mode"}),
        measured=(range(5061, 5070), range(5161, 5400), range(5401, 5411)),
        highest=5601,
    ),
)


# --- Fanuc ---


def _settled(a: float, why: str) -> float:
    """Return a number, unless the last digit of another arithmetic could make it a whole one."""
    if a != math.floor(a) and abs(a - math.floor(a + 0.5)) < NEAR * max(1.0, abs(a)):
        raise NoValueError(f"{why}: the last digit of {a:.10g} decides")
    return a


def _truncated(function: Callable[[float], int]) -> Function:
    def truncated(a: float) -> float:
        if a < 0 and a != math.floor(a):
            raise NoValueError("controls take this of a negative number in two ways")
        return float(function(_settled(a, "a fraction is dropped")))

    return truncated


def _round_clearly(a: float) -> float:
    """Return the nearest whole number; an exact half above zero goes up (Haas 96-8000 p. 116)."""
    off = abs(a - math.floor(a) - 0.5)
    if off < NEAR * max(1.0, abs(a)) and (off or a < 0):
        raise NoValueError(f"{a:.10g} is about a half, or one below zero: known in two ways")
    return _round(a)


def _whole_modulo(a: float, b: float) -> float:
    if a < 0 or b <= 0 or a != math.floor(a) or b != math.floor(b):
        raise NoValueError("MOD of other than positive whole numbers is known in two ways")
    return math.fmod(a, b)


def _upper(function: Function) -> Function:
    """Return a function whose angles below zero a parameter of the control may turn by 360."""

    def upper(*arguments: float) -> float:
        angle = float(function(*arguments))
        if angle < 0:
            message = f"the angle is {angle:.10g} or {angle + 360:.10g}, as a parameter says"
            raise NoValueError(message)
        return angle

    return upper


def _pole(a: float) -> float:
    if abs(math.cos(math.radians(a))) < NEAR:
        raise NoValueError("the tangent of a right angle is infinite")
    return float(np.tan(_radians(a)))


MACRO_B = Arithmetic(
    operators={
        "*": operator.mul,
        "/": _divide,
        "MOD": _whole_modulo,
        "+": operator.add,
        "-": operator.sub,
    },
    functions={
        "ABS": abs,
        "ACOS": _angle(np.arccos, "ACOS"),
        "ASIN": _upper(_angle(np.arcsin, "ASIN")),
        "ATAN/": _upper(_arctangent),
        "COS": _turning(np.cos),
        "EXP": math.exp,
        "FIX": _truncated(math.floor),
        "FUP": _truncated(math.ceil),
        "LN": _logarithm,
        "POW": _power,
        "ROUND": _round_clearly,
        "SIN": _turning(np.sin),
        "SQRT": _root,
        "TAN": _pole,
    },
    own=(range(1, 34), range(100, 200), range(500, 1000)),
    named=False,
    system=frozenset(),
    whole="DFHLPST",
    whole_slip=0.0,
    not_in_words=frozenset({"ROUND"}),
    beside_words=False,
    local=range(1, 34),
    digits=12,
    machine=FANUC,
)
