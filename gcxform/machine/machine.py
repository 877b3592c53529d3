"""Machines: axes with limits and speeds, work offsets and tools, read from a TOML file.

Lengths are mm and angles degrees; a file may write them as strings with a unit (`"5 um"`,
`"80 urad"`). `LENGTH` and `ANGLE` read such strings, here and in the options of passes.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from decimal import Decimal
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.machine.modelfile import CODES, check_format
from gcxform.machine.toolfile import read_tools
from gcxform.tomltext import TomlText, convert, did_you_mean, read_toml

LINEAR_AXES = tuple("XYZUVW")
ROTARY_AXES = tuple("ABC")
AXIS_LETTERS = LINEAR_AXES + ROTARY_AXES
EXAMPLES = {"axis": "X", "work-offset": "G54", "home": "G28", "tool": "1"}

_QUANTITY = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*")
_DEGREES = Decimal("57.29577951308232087679815481410517033240547246656")  # of a radian
_WORK_OFFSET = re.compile(r"G5[4-9](\.[1-9])?( P[0-9]+)?|G154 P[0-9]+")


@dataclass(frozen=True)
class Quantity:
    """A physical quantity: its name, its unit inside gcxform, and what other units are worth."""

    name: str
    base: str
    worth: Mapping[str, Decimal]
    example: str

    def parse(self, text: str, bare: bool = False) -> float:
        """Return a string with a unit, in the base unit; `bare` allows a number alone.

        Raises ValueError with a sentence that follows the name of what is read.
        """
        found = _QUANTITY.fullmatch(text)
        if found is None:
            raise ValueError(f"{text!r} is not {self.article}, such as {self.example}")
        number, unit = found.groups()
        if not unit and not bare:
            raise ValueError(
                f'{text!r} has no unit: write "{number} {self.base}", or {number} without quotes'
            )
        if unit and unit not in self.worth:
            known = ", ".join(name for name in self.worth if name.isascii())
            raise ValueError(f"{unit!r} is not a unit of {self.article}; units are {known}")
        if not math.isfinite(float(number)):
            raise ValueError(f"{number} is too large")
        # Decimal, so that "7 um" is the double nearest to 0.007
        return float(Decimal(number) * self.worth[unit or self.base])

    @property
    def article(self) -> str:
        """The name with its article."""
        return f"a{'n' * (self.name[0] in 'aeio')} {self.name}"


_MICRO = dict.fromkeys(("um", "\N{MICRO SIGN}m", "\N{GREEK SMALL LETTER MU}m"), Decimal("0.001"))
LENGTH = Quantity(
    "length",
    "mm",
    {"mm": Decimal(1), **_MICRO, "m": Decimal(1000), "in": Decimal("25.4")},
    '"5 um", "0.2 mm" or 0.2',
)
ANGLE = Quantity(
    "angle",
    "deg",
    {"deg": Decimal(1), "rad": _DEGREES, "mrad": _DEGREES / 1000, "urad": _DEGREES / 1_000_000},
    '"10 deg", "80 urad" or 10',
)


def quantity_of(axis: str) -> Quantity:
    """Return what the coordinate of an axis is: a length, or an angle for A, B and C."""
    return ANGLE if axis in ROTARY_AXES else LENGTH


INERT = "inert-m"
"""The setting of the control that lists M codes which move nothing."""
Keys = tuple[str | int, ...]
_MARK = "a number, or a string with a unit"
Value = Annotated[float, msgspec.Meta(description=_MARK)]
Triple = tuple[Value, Value, Value]


class Axis(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """An axis: travel (mm or degrees), top speed (mm/min or deg/min), and where a rotary one turns.

    `direction` is a unit vector along the axis and `point` (mm) lies on it, both in machine
    coordinates with all axes at 0; `sign` is +1 where a positive command turns right-handed about
    `direction`, -1 where left-handed; `wrap` is the modulo of the display in degrees.
    """

    limits: tuple[Value, Value] | None = None
    max_speed: float | None = None
    direction: tuple[float, float, float] | None = None
    point: Triple | None = None
    sign: int | None = None
    wrap: Value | None = None


class Tool(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab", kw_only=True):
    """A tool, in mm: length from gauge point to tip, radius, offset of the tip in X and Y."""

    length: Value = 0.0
    radius: Value = 0.0
    x: Value = 0.0
    y: Value = 0.0

    @property
    def vector(self) -> tuple[float, float, float]:
        """From the tip to the gauge point, mm."""
        return float(self.x), float(self.y), float(self.length)


class Offset(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A work offset: the position of its origin by axis, mm and degrees."""

    X: Value | None = None
    Y: Value | None = None
    Z: Value | None = None
    U: Value | None = None
    V: Value | None = None
    W: Value | None = None
    A: Value | None = None
    B: Value | None = None
    C: Value | None = None


class MachineFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True, rename="kebab"):
    """A machine file as it is written."""

    format: int
    name: str = ""
    table: list[str] = []
    head: list[str] = []
    gauge_point: Triple = (0.0, 0.0, 0.0)
    errors: str | None = None
    axis: dict[str, Axis] = {}
    work_offset: dict[str, Offset] = {}
    home: dict[str, Offset] = {}
    tool: dict[str, Tool] = {}
    tool_table: str | None = None
    tool_table_units: Literal["mm", "in"] | None = None
    control: dict[str, str | float | list[int]] = {}


class Machine(msgspec.Struct, frozen=True, kw_only=True):
    """A machine: its axes by letter, work offsets by code (mm, degrees) and tools by number.

    `table` and `head` name the rotary axes from the base to the workpiece and to the spindle;
    `gauge_point` (mm) is that of the spindle with all axes at 0; `errors` is a file. `homes` are
    the machine positions of G28 and G30; `control` has settings that codes depend on; `inert_m` are
    M codes of the machine's own that move no axis and set no variable.
    """

    file: Path
    name: str = ""
    table: tuple[str, ...] = ()
    head: tuple[str, ...] = ()
    gauge_point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    errors: Path | None = None
    axes: dict[str, Axis] = {}
    work_offsets: dict[str, dict[str, float]] = {}
    homes: dict[str, dict[str, float]] = {}
    tools: dict[int, Tool] = {}
    control: dict[str, str | float] = {}
    inert_m: frozenset[int] = frozenset()


def load_machine(path: Path) -> Machine:
    """Return the machine of a TOML file.

    Raises UsageError, with the place in the file, for all that is wrong with it.
    """
    document = read_toml(path, CODES)
    check_format(document, "machines")
    file = _converted(_without_units(document))
    if found := tuple(_findings(document, file)):
        raise UsageError(found)
    return Machine(
        file=path,
        name=file.name or path.stem,
        table=tuple(file.table),
        head=tuple(file.head),
        gauge_point=file.gauge_point,
        errors=None if file.errors is None else path.parent / file.errors,
        axes={letter: _normalised(axis) for letter, axis in file.axis.items()},
        work_offsets={code: _given(offset) for code, offset in file.work_offset.items()},
        homes={code: _given(place) for code, place in file.home.items()},
        tools=_tools(document, file, path),
        control={k: v for k, v in file.control.items() if not isinstance(v, list)},
        inert_m=_listed(file.control.get(INERT, [])),
    )


def _tools(document: TomlText, file: MachineFile, path: Path) -> dict[int, Tool]:
    """Return the tools of the file, and before them those of the table it names."""
    tools: dict[int, Tool] = {}
    if file.tool_table is not None and file.tool_table_units is not None:
        table = read_tools(path.parent / file.tool_table, file.tool_table_units)
        tools = {number: Tool(**values) for number, values in table.items()}
    twice = [number for number in file.tool if int(number) in tools]
    if twice:
        message = f"the tool {twice[0]} stands in {file.tool_table} as well"
        raise UsageError.one("GX437", message, document.where("tool", twice[0]))
    return tools | {int(number): tool for number, tool in file.tool.items()}


def _listed(codes: str | float | list[int]) -> frozenset[int]:
    return frozenset(codes) if isinstance(codes, list) else frozenset()


def _given(offset: Offset) -> dict[str, float]:
    """Return the coordinates of a work offset which are given."""
    return {k: float(v) for k, v in msgspec.structs.asdict(offset).items() if v is not None}


def schema() -> dict[str, Any]:
    """Return the JSON Schema of machine files."""
    found: dict[str, Any] = msgspec.json.schema(MachineFile)
    _admit_strings(found)
    return found


def _admit_strings(node: Any) -> None:
    """Let strings in wherever a number may have a unit, in place."""
    children = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    if isinstance(node, dict) and node.get("description") == _MARK:
        for part in node.get("anyOf", [node]):
            if part.get("type") == "number":
                part["type"] = ["number", "string"]
    for child in children:
        _admit_strings(child)


@dataclass(frozen=True)
class _Part(TomlText):
    """One table of a file, read by itself: msgspec does not tell the keys of a dict."""

    whole: TomlText
    prefix: tuple[str, ...]

    def where(self, *keys: str | int) -> Location:
        return self.whole.where(*self.prefix, *keys)

    def unknown_key(self, keys: Keys, known: Iterable[str]) -> UsageError:
        return self.whole.unknown_key((*self.prefix, *keys), known)


def _converted(document: TomlText) -> MachineFile:
    """Return the file with its types checked, each table that has a name of its own by itself."""
    tables: dict[str, type[msgspec.Struct]] = {
        "axis": Axis,
        "work-offset": Offset,
        "home": Offset,
        "tool": Tool,
    }
    values = {**document.values, **{key: {} for key in tables if key in document.values}}
    read: dict[str, dict[str, Any]] = {}
    found: list[Diagnostic] = []
    for section, config in tables.items():
        raw = document.values.get(section, {})
        named = raw if isinstance(raw, dict) else {}
        if named is not raw:
            message = f"{section}: expected tables, such as [{section}.{EXAMPLES[section]}]"
            found.append(Diagnostic(document.codes.wrong_value, message, document.where(section)))
        for name, value in named.items():
            part = _Part(document.file, "", value, document.codes, document, (section, name))
            try:
                read.setdefault(section.replace("-", "_"), {})[name] = convert(part, config)
            except UsageError as error:
                found += error.diagnostics
    if found:
        raise UsageError(tuple(found))
    return msgspec.structs.replace(convert(replace(document, values=values), MachineFile), **read)


def _quantity_at(keys: Keys) -> Quantity | None:
    """Return what the value at a path of a machine file is, None if it has no unit."""
    match keys:
        case ("gauge-point", int()) | ("tool", _, "length" | "radius" | "x" | "y"):
            return LENGTH
        case ("axis", _, "point", int()):
            return LENGTH
        case ("axis", str(letter), "limits", int()) | ("work-offset" | "home", _, str(letter)):
            return quantity_of(letter)
        case ("axis", _, "wrap"):
            return ANGLE
    return None


def _without_units(document: TomlText) -> TomlText:
    """Return the document with numbers in the place of strings with a unit."""
    found: list[Diagnostic] = []

    def walk(node: Any, keys: Keys) -> Any:
        if isinstance(node, dict):
            return {key: walk(value, (*keys, key)) for key, value in node.items()}
        if isinstance(node, list):
            return [walk(value, (*keys, k)) for k, value in enumerate(node)]
        try:
            return _number(node, _quantity_at(keys))
        except ValueError as error:
            name = keys[-1] if isinstance(keys[-1], str) else keys[-2]
            message = f"{name}: {error}"
            found.append(Diagnostic(document.codes.wrong_value, message, document.where(*keys)))
            return 0.0

    values = walk(document.values, ())
    if found:
        raise UsageError(tuple(found))
    return replace(document, values=values)


def _number(node: Any, quantity: Quantity | None) -> Any:
    """Return a leaf of the file, in the base unit of its quantity; ValueError if it has none."""
    if isinstance(node, float) and not math.isfinite(node):
        raise ValueError(f"{node} is not a finite number")
    if isinstance(node, str) and quantity is not None:
        return quantity.parse(node)
    return node


def _findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    """Yield what is wrong with a machine whose values have the right types."""
    for letter, axis in file.axis.items():
        if letter not in AXIS_LETTERS:
            yield from document.unknown_key(("axis", letter), AXIS_LETTERS).diagnostics
            continue
        yield from _axis_findings(letter, axis, partial(document.where, "axis", letter))
    yield from _chain_findings(document, file)
    yield from _offset_findings(document, file)
    yield from _tool_findings(document, file)
    for name, value in file.control.items():
        if isinstance(value, list) != (name == INERT):
            wanted = "a list of M codes, such as [100, 101]" if name == INERT else "one value"
            message = f"{name}: expected {wanted}"
            yield Diagnostic(document.codes.wrong_value, message, document.where("control", name))


def _axis_findings(
    letter: str, axis: Axis, where: Callable[[str], Location]
) -> Iterator[Diagnostic]:
    rotary = letter in ROTARY_AXES
    if axis.limits is not None and not axis.limits[0] < axis.limits[1]:
        low, high = axis.limits
        message = f"the limits of axis {letter} do not ascend: {low:g}, {high:g}"
        yield Diagnostic("GX431", message, where("limits"), "the lower limit comes first")
    if rotary if axis.direction is None else not any(axis.direction):
        stated = "is missing" if axis.direction is None else "is zero"
        message = f"the direction of axis {letter} {stated}"
        yield Diagnostic("GX432", message, where("direction"), "give a vector along the axis")
    if axis.sign not in (None, -1, 1) or (rotary and axis.sign is None):
        stated = "is missing" if axis.sign is None else f"is {axis.sign}"
        message = f"the sign of axis {letter} {stated}, it has to be -1 or +1"
        hint = "ISO 841: +1 where the axis turns the head, -1 where it turns the table"
        yield Diagnostic("GX433", message, where("sign"), hint)
    for key, value in (("max-speed", axis.max_speed), ("wrap", axis.wrap)):
        if value is not None and not value > 0.0:
            message = f"{key} of axis {letter} is {value:g}, it has to be above 0"
            yield Diagnostic("GX434", message, where(key))


def _chain_findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    """Yield the rotary axes of the two chains which are not there, or stand twice."""
    seen: set[str] = set()
    rotary = [letter for letter in file.axis if letter in ROTARY_AXES]
    for chain, letters in (("table", file.table), ("head", file.head)):
        for k, letter in enumerate(letters):
            where = document.where(chain, k)
            if letter not in rotary:
                message = f"{chain} names {letter!r}, which is not a rotary axis of this machine"
                hint = f"add [axis.{letter}]" if letter in ROTARY_AXES else ""
                yield Diagnostic("GX435", message, where, hint or did_you_mean(letter, rotary))
            elif letter in seen:
                message = f"the axis {letter} stands twice in table and head"
                yield Diagnostic("GX435", message, where)
            seen.add(letter)


def _offset_findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    for code, offset in file.work_offset.items():
        if not _WORK_OFFSET.fullmatch(code):
            yield Diagnostic(
                "GX436",
                f"{code!r} is not a work offset",
                document.where("work-offset", code),
                'known: G54 to G59, "G59.1" to "G59.3", "G54.1 P1"; quote a name with a point',
            )
        known = [letter for letter in AXIS_LETTERS if letter in (file.axis or AXIS_LETTERS)]
        for letter in _given(offset):
            if letter not in known:
                keys = ("work-offset", code, letter)
                yield from document.unknown_key(keys, known).diagnostics


def _tool_findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    if file.tool_table is not None and file.tool_table_units is None:
        yield Diagnostic(
            document.codes.missing_key,
            "the unit of the tool table is missing: the table is in that of its machine",
            document.where("tool-table"),
            'add tool-table-units = "mm" or "in"',
        )
    numbers: set[int] = set()
    for number, tool in file.tool.items():
        where = document.where("tool", number)
        if not re.fullmatch("[0-9]{1,9}", number):
            yield Diagnostic("GX437", f"{number!r} is not a tool number", where)
        elif int(number) in numbers:
            yield Diagnostic("GX437", f"the tool {int(number)} stands twice", where)
        else:
            numbers.add(int(number))
        if tool.radius < 0.0:
            message = f"radius of tool {number} is {tool.radius:g}, it cannot be negative"
            yield Diagnostic("GX434", message, document.where("tool", number, "radius"))


def _normalised(axis: Axis) -> Axis:
    """Return the axis with a direction of length 1."""
    x, y, z = axis.direction or (0.0, 0.0, 1.0)
    length = math.hypot(x, y, z)
    unit = (x / length, y / length, z / length)
    return msgspec.structs.replace(axis, direction=unit) if axis.direction else axis
