"""The toolpaths on which passes are tried, and how two paths are compared."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect.dialect import Dialect
from gcxform.dialect.move_rules import ArcRule
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.toolpath.columns import COLUMNS
from gcxform.toolpath.path import BLOCK_MODES, Kind, Toolpath

HEAD = "G21 G90 G94 G17\n"


def polygon(plane: str, lines: int, rise: float = 0.0) -> str:
    """Return the lines of a polygon from X60 Y50 Z20 back to there, on a radius of 10 mm.

    It is clockwise for a negative number of lines; `rise` (mm) is what each line goes up.
    """
    first, second = plane[0], plane[1]
    normal = next(axis for axis in "XYZ" if axis not in plane)
    place = {"X": 60.0, "Y": 50.0, "Z": 20.0}
    text = []
    for nth in range(1, abs(lines) + 1):
        angle = 2 * np.pi * nth / lines
        u, v = place[first] - 10 + 10 * np.cos(angle), place[second] + 10 * np.sin(angle)
        up = f" {normal}{place[normal] + rise * nth:.4f}" if rise else ""
        text.append(f"G1 {first}{u:.4f} {second}{v:.4f}{up}\n")
    return "".join(text) + (f"{normal}{place[normal]:g}\n" if rise else "")


PROGRAMS: dict[str, str] = {
    "no block": "",
    "no move": HEAD + "M3 S100\n",
    "one row": HEAD + "G0 X20 Y30 Z40\n",
    "lines": HEAD + "G0 X10 Y10 Z50\nG1 Z10 F100\nX190\nY190 Z120\nX10 Y10 Z10\nG0 Z50\nG1 X10\n",
    "arcs": HEAD
    + "G0 X60 Y50 Z20\nG2 X50 Y40 I-10 J0 F200\nG3 X50 Y40 I10 J0 Z30\nG2 X70 Y60 R25\n"
    + "G18 G3 X80 Z20 I0 K-10\nG2 X80 Z20 I15 K0\nG19 G2 Y70 Z30 J10 K0\nG3 Y110 Z70 J40 K0\n",
    "events": HEAD
    + "T1 M6\nS500 M3\nG0 X20 Y20 Z20 M8\nG1 X150 F300 M5\nG4 P0.5\nG3 X150 Y60 I0 J20 M0\nM9\n",
    "inches": "G20 G90 G94 G17\nG0 X1 Y1 Z1\nG1 X5 Y4 F10\nG91 G2 X1 Y-1 J-1\nG1 X-1.5\n",
    "incremental": HEAD
    + "G0 X20 Y20 Z20\nG91 G1 X30 F100\nY40 Z-5\nG3 X-10 Y10 I-10\nG90 G0 X20\n",
    "inverse time": HEAD + "G0 X20 Y20 Z20\nG93 G1 X180 F2\nG3 X160 Y40 I-20 F4\nG94 G1 X20 F100\n",
    "rotary": HEAD + "G0 X20 Y20 Z20 A0 B0 C0\nG1 X180 A45 F100\nC-90\nG2 X160 Y0 I-20 B10\n",
    "tilting": HEAD + "G0 X20 Y20 Z20 A0 C0\nG93 G1 X180 A45 F2\nY60 C-90 F3\nG94 Z30 F100\n",
    "many lines": HEAD
    + "G0 X60 Y50 Z20\nF200\n"
    + polygon("XY", 24)
    + "M8\n"
    + polygon("XY", -30, 2.0)
    + "F250\nG18\n"
    + polygon("ZX", -24)
    + "G19\n"
    + polygon("YZ", 12)
    + "X60.5\nX61\nX61.5\nX62\nX62 Y51\n",
    "unknown start": HEAD + "G0 Z30\nX20\nG1 X60 F100\nY20\nX120 Y100\n",
}
"""Small programs in the common part of all dialects."""


class Plain(Dialect):
    """The common part of all dialects, on which passes are tried."""

    name = "plain"


class PlainXY(Plain):
    """A control that cuts arcs in the XY plane only."""

    name = "plain-xy"
    arc_rule = ArcRule(planes=frozenset({"XY"}))


@cache
def paths() -> tuple[tuple[str, Toolpath], ...]:
    """Return the toolpaths on which passes are tried, each with its name."""
    found = []
    for name, program in PROGRAMS.items():
        reader = WindowReader(Plain)
        window = reader.read(program.encode())
        found.append((name, Interpreter(Plain).interpret(window, reader.table).path))
    return tuple(found)


def locked(path: Toolpath) -> Toolpath:
    """Return a copy of a path in which nothing can be written."""

    def copy(array: NDArray[Any]) -> NDArray[Any]:
        array = np.array(array, order="F")
        array.flags.writeable = False
        return array

    was = path.blocks
    modes: dict[str, Any] = {name: copy(getattr(was, name)) for name in BLOCK_MODES}
    blocks = replace(was, **modes)
    columns = {name: copy(getattr(path, name)) for name in (*COLUMNS, "entry")}
    return path.replace(blocks=blocks, **columns)


def differs(a: Toolpath, b: Toolpath, allowed: float) -> str:
    """Return the name of something in which two paths differ, or nothing."""
    for name in (*COLUMNS, "entry"):
        one, other = getattr(a, name), getattr(b, name)
        if not _close(one, other, allowed):
            return name
    for name in BLOCK_MODES:
        if not np.array_equal(getattr(a.blocks, name), getattr(b.blocks, name)):
            return f"blocks.{name}"
    for name in ("axes", "events", "slack", "refit_centres"):
        if getattr(a, name) != getattr(b, name):
            return name
    return ""


def _close(one: NDArray[Any], other: NDArray[Any], allowed: float) -> bool:
    """Tell whether columns are of one shape and as near as that; most are the same."""
    if one.shape != other.shape:
        return False
    same = one.dtype == other.dtype and one.tobytes() == other.tobytes()  # nan is nan
    return same or np.allclose(one, other, 0.0, allowed, equal_nan=True)


def halves(path: Toolpath, line: int) -> tuple[Toolpath, Toolpath]:
    """Return the rows before a line and those from it on, as two windows of a program."""
    cut = int(np.searchsorted(path.source, line))
    rows = np.arange(len(path))
    early = tuple(e for e in path.events if e.line < line)
    late = tuple(e.at(e.row - cut) for e in path.events if e.line >= line)
    first, second = path.take(rows[:cut]), path.take(rows[cut:])
    entry = np.array(path.end[cut - 1] if cut else path.entry)
    rapid = bool(cut) and bool(path.kind[cut - 1] == Kind.RAPID)
    second = second.replace(events=late, entry=entry, after_rapid=rapid)
    return first.replace(events=early), second


def differs_joined(whole: Toolpath | None, parts: list[Toolpath | None], allowed: float) -> str:
    """Return the name of a column in which a path differs from its two parts, or nothing."""
    assert whole is not None
    first, second = (part for part in parts if part is not None)
    for name in COLUMNS:
        joined = np.concatenate([getattr(first, name), getattr(second, name)])
        if not _close(getattr(whole, name), joined, allowed):
            return name
    if len(first) and not np.allclose(second.entry, first.end[-1], 0.0, allowed, equal_nan=True):
        return "entry"
    return ""
