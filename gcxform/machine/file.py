"""Machine files: TOML that says what a machine is, read and checked.

Lengths are mm and angles degrees; a file may write them as strings with a unit (`"5 um"`,
`"80 urad"`).

A direction and its opposite are the same axis if the sign goes with it: every direction is turned
so that its largest component is positive.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import msgspec

from gcxform.config.quantities import (
    ANGLE,
    AXIS_LETTERS,
    LENGTH,
    ROTARY_AXES,
    Quantity,
    quantity_of,
)
from gcxform.config.to_fill_in import split_open
from gcxform.config.toml_text import TomlText, convert, did_you_mean, read_toml
from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.errormodel.model_file import CODES, check_version
from gcxform.machine import control
from gcxform.machine import kinds as presets
from gcxform.machine.control import HOME, WORK_OFFSET
from gcxform.machine.formats import NONE, Known, ProgramSettings, reader_findings
from gcxform.machine.machine import (
    Axis,
    Machine,
    MachineFile,
    Offset,
    Tool,
)
from gcxform.machine.presets import with_preset
from gcxform.system.inputs import referred
from gcxform.values import dataclass

FILLED_IN = ("control", "tool", "work-offset", "home")
"""The tables in which a value may be left to be filled in."""
EXAMPLES = {"axis": "X", "work-offset": "G54", "home": "G28", "tool": "1"}
Keys = tuple[str | int, ...]
TOOL = re.compile("[0-9]{1,9}")


def load_machine(path: Path, known: Known = NONE) -> Machine:
    """Return the machine of a TOML file, which may name kinematics and controls that are known.

    Raises UsageError, with the place in the file, for all that is wrong with it.
    """
    document, still_open = split_open(read_toml(path, CODES), FILLED_IN)
    check_version(document, "machines")
    document, taken = with_preset(document, known.presets)
    file = _converted(_without_units(document))
    named = tuple(presets.findings(document, file, known.kinematics))
    file = presets.filled(file, known.kinematics)
    if found := named or tuple(_findings(document, file, known)):
        raise UsageError(found)
    programs = _programs(document, file, known)
    return Machine(
        file=path,
        name=file.name or path.stem,
        table=tuple(file.table),
        head=tuple(file.head),
        gauge_point=file.gauge_point,
        errors=_named(document, "errors", file.errors),
        axes={letter: _normalised(axis) for letter, axis in file.axis.items()},
        work_offsets={
            control.offset_in_blocks(code): _given(offset)
            for code, offset in file.work_offset.items()
        },
        homes={code: _given(place) for code, place in file.home.items()},
        tools=_tools(document, file, known),
        control=control.settings_of(file.control) | control.codes_of(programs.codes),
        inert_m=control.inert_of(file.control),
        open=still_open,
        taken=taken,
        subprograms=programs.folders,
        told=dict(programs.parameters),
    )


def _named(document: TomlText, key: str, name: str | None) -> Path | None:
    """Return a file that the machine file names. Raises UsageError if it lies elsewhere."""
    if name is None:
        return None
    if "\0" in name:
        message = f"{key}: no file is called {name!r}"
        raise UsageError.one(document.codes.wrong_value, message, document.where(key))
    return referred(Path(document.file).parent, name, document.where(key))


def _programs(document: TomlText, file: MachineFile, known: Known) -> ProgramSettings:
    """Return what the file of the control says of programs that the machine file names."""
    place = _named(document, "ini", file.ini)
    return known.controls[file.ini_control].programs(place) if place else ProgramSettings()


def _tools(document: TomlText, file: MachineFile, known: Known) -> dict[int, Tool]:
    """Return the tools of the file, and before them those of the table it names."""
    tools: dict[int, Tool] = {}
    place = _named(document, "tool-table", file.tool_table)
    if place is not None and file.tool_table_units is not None:
        reader = known.controls[file.tool_table_control]
        tools |= reader.tools(place, file.tool_table_units)
    twice = [number for number in file.tool if int(number) in tools]
    if twice:
        message = f"the tool {twice[0]} stands in {file.tool_table} as well"
        raise UsageError.one("GX437", message, document.where("tool", twice[0]))
    return tools | {int(n): _with_radius(tool, file) for n, tool in file.tool.items()}


def _given(offset: Offset) -> dict[str, float]:
    """Return the coordinates of a work offset which are given."""
    return {k: float(v) for k, v in msgspec.structs.asdict(offset).items() if v is not None}


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
        case ("gauge-point", int()) | ("tool", _, "length" | "radius" | "d" | "x" | "y"):
            return LENGTH
        case ("axis", _, "point", int()):
            return LENGTH
        case ("axis", str(letter), "limits", int()) | ("work-offset" | "home", _, str(letter)):
            return quantity_of(letter)
        case ("axis", _, "wrap") | ("inclination",):
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


def _findings(document: TomlText, file: MachineFile, known: Known) -> Iterator[Diagnostic]:
    """Yield what is wrong with a machine whose values have the right types."""
    for letter, axis in file.axis.items():
        if letter not in AXIS_LETTERS:
            yield from document.unknown_key(("axis", letter), AXIS_LETTERS).diagnostics
            continue
        yield from _axis_findings(letter, axis, partial(document.where, "axis", letter))
    yield from _chain_findings(document, file)
    yield from _offset_findings(document, file)
    yield from _table_findings(document, file, known)
    yield from _tool_findings(document, file)
    if control.undeclared(file.control):
        tuple(known.dialects.values())  # loads them all, and what they declare
    yield from control.findings(document, file.control)


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
            where = document.where(chain if file.kinematics is None else "kinematics", k)
            if letter not in rotary:
                message = f"{chain} names {letter!r}, which is not a rotary axis of this machine"
                hint = f"add [axis.{letter}]" if letter in ROTARY_AXES else ""
                yield Diagnostic("GX435", message, where, hint or did_you_mean(letter, rotary))
            elif letter in seen:
                message = f"the axis {letter} stands twice in table and head"
                yield Diagnostic("GX435", message, where)
            elif file.axis[letter].point is None:
                stated = letter in document.values.get("axis", {})
                place = where if not stated else document.where("axis", letter, "point")
                message = f"the point of axis {letter} is missing"
                yield Diagnostic("GX452", message, place, "give a point on its line, in mm")
            seen.add(letter)


def _offset_findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    for code, offset in file.work_offset.items():
        other = control.offset_in_blocks(code)
        if other != code and other in file.work_offset:
            where = document.where("work-offset", code)
            yield Diagnostic("GX436", f"{code} and {other} are one work offset", where)
        if not WORK_OFFSET.fullmatch(code):
            yield Diagnostic(
                "GX436",
                f"{code!r} is not a work offset",
                document.where("work-offset", code),
                'known: G54 to G59, "G59.1" to "G59.3", "G54.1 P1"; quote a name with a point',
            )
        yield from _strange_axes(document, file, ("work-offset", code), offset)
    for code, place in file.home.items():
        if not HOME.fullmatch(code):
            where = document.where("home", code)
            yield Diagnostic(
                "GX436",
                f"{code!r} is not a home position",
                where,
                'known: G28, G30, "G30 P2", M140, M92',
            )
        yield from _strange_axes(document, file, ("home", code), place)


def _strange_axes(
    document: TomlText, file: MachineFile, keys: tuple[str, str], place: Offset
) -> Iterator[Diagnostic]:
    """Yield the axes of a place which the machine does not have; X, Y and Z it always has."""
    said = {*"XYZ", *file.axis} if file.axis else AXIS_LETTERS
    known = [letter for letter in AXIS_LETTERS if letter in said]
    for letter in _given(place):
        if letter not in known:
            yield from document.unknown_key((*keys, letter), known).diagnostics


def _table_findings(document: TomlText, file: MachineFile, known: Known) -> Iterator[Diagnostic]:
    if file.ini is not None:
        named = partial(document.where, "ini-control")
        yield from reader_findings(document, file.ini_control, "programs", known, named)
    if file.tool_table is None:
        return
    named = partial(document.where, "tool-table-control")
    yield from reader_findings(document, file.tool_table_control, "tools", known, named)
    if file.tool_table_units is None:
        yield Diagnostic(
            document.codes.missing_key,
            "the unit of the tool table is missing: the table is in that of its machine",
            document.where("tool-table"),
            'add tool-table-units = "mm" or "in"',
        )


def _tool_findings(document: TomlText, file: MachineFile) -> Iterator[Diagnostic]:
    numbers: set[int] = set()
    for number, tool in file.tool.items():
        where = document.where("tool", number)
        if not TOOL.fullmatch(number):
            yield Diagnostic("GX437", f"{number!r} is not a tool number", where)
        elif int(number) in numbers:
            yield Diagnostic("GX437", f"the tool {int(number)} stands twice", where)
        else:
            numbers.add(int(number))
        for key, value in (("radius", tool.radius), ("d", tool.d)):
            if value < 0.0:
                message = f"{key} of tool {number} is {value:g}, it cannot be negative"
                yield Diagnostic("GX434", message, document.where("tool", number, key))
        yield from _d_findings(document, file, number, tool)


def _d_findings(
    document: TomlText, file: MachineFile, number: str, tool: Tool
) -> Iterator[Diagnostic]:
    """Yield why it is not known what D calls: a radius beside it, or nothing that says what it is.

    A parameter decides: 5004#2 of a Fanuc, Setting 40 of a Haas.
    """
    where = document.where("tool", number, "d")
    if math.isnan(tool.d):
        return
    if not math.isnan(tool.radius):
        yield Diagnostic("GX437", f"the tool {number} has a radius and d: give one of them", where)
    if control.D_IS not in file.control:
        message = f"whether d of tool {number} is its diameter or its radius is not said"
        hint = 'say so in [control] of this file: d-is is "diameter" or "radius"'
        yield Diagnostic("GX437", message, where, hint)


def _with_radius(tool: Tool, file: MachineFile) -> Tool:
    """Return a tool with its radius, where what D calls is given instead."""
    if math.isnan(tool.d):
        return tool
    half = file.control[control.D_IS] == "diameter"
    return msgspec.structs.replace(tool, radius=tool.d / 2 if half else tool.d, d=math.nan)


def _normalised(axis: Axis) -> Axis:
    """Return the axis with a direction of length 1, the same whichever way round it was given.

    A rotary axis is a line: turned around, together with its sign, it is the same axis.
    """
    if axis.direction is None:
        return axis
    length = math.hypot(*axis.direction)
    largest = max(axis.direction, key=abs)
    flip = -1 if axis.sign is not None and largest < 0.0 else 1
    x, y, z = (flip * part / length + 0.0 for part in axis.direction)
    sign = None if axis.sign is None else flip * axis.sign
    return msgspec.structs.replace(axis, direction=(x, y, z), sign=sign)
