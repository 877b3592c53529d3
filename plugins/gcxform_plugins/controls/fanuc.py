"""FANUC's five-axis parameters as machines: type, senses, and where the rotary axes are.

| parameter | says |
|---|---|
| 19680 | 2: both axes in the head; 12: both in the table; 21: one each, the first in the head |
| 19682, 19687 | first and second axis are about X (1), Y (2), Z (3) |
| 19684, 19689 | 0: right-handed, as usual for tools; 1: left-handed, as usual for tables |
| 19685, 19690 | angle of an axis that is not controlled: has to be 0 |
| 19683, 19688 | inclination: has to be 0 |
| 19696 | bits 0 and 1, axes that are not controlled: have to be 0 |
| 19697 | the tool's axis with all axes at 0: has to be 3, +Z |
| 19698, 19699 | angles by which it leans from there: have to be 0 |
| 19700 to 19702 | a point on the first axis of the table |
| 19703 to 19705 | from the first axis of the table to the second |
| 19666 | from the gauge point up to the centre of the tool's rotary axis |
| 19709 to 19711 | from the tool's axis to its rotary axis |
| 19712 to 19714 | from the second axis of the head to the first |

The sources are FANUC's papers on the 30i family; lengths are mm with a decimal point. Without one
they would be increments of 0.001 mm on the 16i and mm on the 30i, so they are refused. None of
these parameters has a direction that was measured: axes run along the coordinates.

A list as the control punches it names the path, `N19700Q1L1P5.0`; that of the path 1 is read.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import gcxform as gx
from gcxform.vocabulary import Axis, Machine, control_lines

TYPE, HOLDER = 19680, 19666
TABLE, BETWEEN, TOOL, HEAD = 19700, 19703, 19709, 19712
ABOUT, SENSE = (19682, 19687), (19684, 19689)
NOUGHT = (19683, 19685, 19688, 19690, 19698, 19699)
IMAGINED, TOWARDS = 19696, 19697
SIDES = {2: "HH", 12: "TT", 21: "HT"}
NEEDED = {"HH": (HOLDER,), "TT": (*range(TABLE, TABLE + 3),), "HT": (HOLDER, TABLE)}
LETTERS = {1: ("A", (1.0, 0.0, 0.0)), 2: ("B", (0.0, 1.0, 0.0)), 3: ("C", (0.0, 0.0, 1.0))}
LENGTHS = {HOLDER, *range(TABLE, TABLE + 6), *range(TOOL, TOOL + 6)}
KNOWN = {TYPE, *ABOUT, *SENSE, *NOUGHT, IMAGINED, TOWARDS, *LENGTHS}
_LINE = re.compile(r"N?\s*(\d+)\s*(?:Q1)?\s*(?:L1)?\s*(?:=|P)\s*([+-]?(?:\d+\.?\d*|\.\d+))")
_OTHER = re.compile(r"N\s*(\d+)\s*[QLASP].*")
Triple = tuple[float, float, float]


@dataclass(frozen=True)
class FanucFiles(gx.ControlFiles):
    """FANUC: the parameters of five-axis kinematics."""

    name: ClassVar[str] = "fanuc"
    file: ClassVar[str] = "PARAMETERS"

    def kinematics(self, path: Path) -> Machine:
        """Take over the parameters 19666 and 19680 to 19714, such as N19700 P5.0, a line each."""
        values = _values(path)
        whole = gx.Location(str(path))
        if found := tuple(gx.Diagnostic("GX454", reason, whole) for reason in _problems(values)):
            raise gx.UsageError(found)
        return _machine(values, path)


def _values(path: Path) -> dict[int, float]:
    """Return the known parameters of a list, a line each: `N19700 P5.0` or `19700 = 5.0`."""
    values: dict[int, float] = {}
    for where in control_lines(path):
        text = where.text.partition("(")[0].strip()
        match, other = _LINE.fullmatch(text), _OTHER.fullmatch(text)
        stated = match or other
        if text in ("", "%") or (stated and int(stated[1]) not in KNOWN):
            continue
        if match is None or (reason := _strange(match, values)):
            reason = reason if match else "not one parameter and its value"
            raise gx.UsageError.one("GX454", reason, where, "write N19700 P5.0")
        values[int(match[1])] = float(match[2])
    return values


def _strange(match: re.Match[str], values: Collection[int]) -> str:
    """Return why a line with a known parameter cannot be read, or nothing."""
    if int(match[1]) in values:
        return "this parameter stands twice"
    if int(match[1]) in LENGTHS and "." not in match[2] and float(match[2]):
        return "a length without a decimal point: its unit is not known"
    return ""


def _problems(values: Mapping[int, float]) -> Iterator[str]:
    """Yield why parameters are no machine that can be taken over."""
    sides = SIDES.get(int(values.get(TYPE, 0)), "")
    missing = [n for n in (*ABOUT, *SENSE, *NEEDED.get(sides, ())) if n not in values]
    yield from (f"parameter {number} is missing" for number in missing)
    rules: list[tuple[tuple[int, ...], Collection[float], str]] = [
        ((TYPE,), SIDES, "has to be 2 (head), 12 (table) or 21 (both)"),
        (ABOUT, LETTERS, "has to be 1, 2 or 3 (about X, Y or Z)"),
        (SENSE, (0, 1), "has to be 0 or 1"),
        (NOUGHT, (0,), "is not 0: describe this machine by hand"),
        ((TOWARDS,), (3, 0), "is not 3 (+Z): describe this machine by hand"),
    ]
    for numbers, admitted, rule in rules:
        for number in numbers:
            absent = 0 if number == TYPE else next(iter(admitted))
            if values.get(number, absent) not in admitted:
                yield f"parameter {number} {rule}"
    if int(values.get(IMAGINED, 0)) % 100:
        yield "parameter 19696 has an axis that is not controlled: describe this machine by hand"
    if len({values.get(number, number) for number in ABOUT}) == 1:
        yield "both axes turn about the same coordinate"


def _machine(values: Mapping[int, float], file: Path) -> Machine:
    """Return the machine of parameters by number."""
    sides = SIDES[int(values[TYPE])]
    letters, axes = [], {}
    for about, sense, point in zip(ABOUT, SENSE, _points(sides, values), strict=True):
        letter, direction = LETTERS[int(values[about])]
        letters.append(letter)
        sign = -1 if values[sense] else 1
        axes[letter] = Axis(direction=direction, point=point, sign=sign)
    table, head = (
        tuple(a for a, own in zip(letters, sides, strict=True) if own == side) for side in "TH"
    )
    return Machine(file=file, name="FANUC", table=table, head=head, axes=axes)


def _points(sides: str, values: Mapping[int, float]) -> tuple[Triple, Triple]:
    """Return a point on the first and on the second axis."""
    table = _vector(values, TABLE)
    swivel = _sum((0.0, 0.0, values.get(HOLDER, 0.0)), _vector(values, TOOL))
    if sides == "TT":
        return table, _sum(table, _vector(values, BETWEEN))
    if sides == "HH":
        return _sum(swivel, _vector(values, HEAD)), swivel
    return swivel, table


def _vector(values: Mapping[int, float], first: int) -> Triple:
    x, y, z = (values.get(first + k, 0.0) for k in range(3))
    return x, y, z


def _sum(one: Triple, other: Triple) -> Triple:
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]
