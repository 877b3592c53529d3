"""The toolpaths on which passes are tried, and how two paths are compared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gcxform.dialect import Dialect
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.toolpath.path import BLOCK_MODES, COLUMNS, Blocks, Kind, Toolpath

HEAD = "G21 G90 G94 G17\n"
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
    "unknown start": HEAD + "G0 Z30\nX20\nG1 X60 F100\nY20\nX120 Y100\n",
}
"""Small programs in the common part of all dialects."""


class Plain(Dialect):
    """The common part of all dialects, on which passes are tried."""

    name = "plain"


class PlainXY(Plain):
    """A control that cuts arcs in the XY plane only."""

    name = "plain-xy"
    arc_planes: ClassVar[frozenset[str]] = frozenset({"XY"})


def paths() -> Iterator[tuple[str, Toolpath]]:
    """Yield the toolpaths on which passes are tried, each with its name."""
    for name, program in PROGRAMS.items():
        reader = WindowReader(Plain)
        window = reader.read(program.encode())
        yield name, Interpreter(Plain).interpret(window, reader.table).path


def locked(path: Toolpath) -> Toolpath:
    """Return a copy of a path in which nothing can be written."""

    def copy(array: NDArray[Any]) -> NDArray[Any]:
        array = np.array(array, order="F")
        array.flags.writeable = False
        return array

    was = path.blocks
    blocks = Blocks(was.first, *(copy(getattr(was, name)) for name in BLOCK_MODES))
    columns = {name: copy(getattr(path, name)) for name in (*COLUMNS, "entry")}
    return path.replace(blocks=blocks, **columns)


def differs(a: Toolpath, b: Toolpath, allowed: float) -> str:
    """Return the name of something in which two paths differ, or nothing."""
    for name in (*COLUMNS, "entry"):
        one, other = getattr(a, name), getattr(b, name)
        if one.shape != other.shape or not np.allclose(one, other, 0.0, allowed, equal_nan=True):
            return name
    for name in BLOCK_MODES:
        if not np.array_equal(getattr(a.blocks, name), getattr(b.blocks, name)):
            return f"blocks.{name}"
    for name in ("axes", "events", "slack", "refit_centres"):
        if getattr(a, name) != getattr(b, name):
            return name
    return ""


def halves(path: Toolpath, line: int) -> tuple[Toolpath, Toolpath]:
    """Return the rows before a line and those from it on, as two windows of a program."""
    cut = int(np.searchsorted(path.source, line))
    rows = np.arange(len(path))
    early = tuple(e for e in path.events if e.line < line)
    late = tuple(replace(e, row=e.row - cut) for e in path.events if e.line >= line)
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
        one = getattr(whole, name)
        if one.shape != joined.shape or not np.allclose(one, joined, 0.0, allowed, equal_nan=True):
            return name
    if len(first) and not np.allclose(second.entry, first.end[-1], 0.0, allowed, equal_nan=True):
        return "entry"
    return ""
