"""Axes that are turned before any code says whether the control follows the tip.

The first such code may end what began before the program: words before it are then those of tips.
So a program is refused that turns axes there, and has such codes; it may have windows between them.
"""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import InputError, Location
from gcxform.modal.frames.planes import TURN
from gcxform.modal.lines import Lines
from gcxform.modal.state import TURNED, State
from gcxform.system.arrays import Flags, Floats
from gcxform.toolpath.path import Kind, Toolpath

MESSAGE = "axes are turned, and whether the control follows the tip is not known"
SAY = 'switch it before; or say what holds: tip-at-start = "off" in [control] of the machine file'
ROTARY = "ABC"
KEPT = frozenset({"tip-kept-on", "tip-kept-off"})


def refuse_unsaid(lines: Lines, before: State, path: Toolpath) -> None:
    """Refuse axes turned before the first code that is read and stays. Raises InputError."""
    kept = any(code.act in KEPT for code in lines.dialect.m_codes.values())
    if not kept or before.frames.following is not None:
        return
    memory = lines.state.memory
    if not memory[TURNED] and len(path):
        unsaid = np.array([frame.following is None for frame in path.frames])[path.frame]
        rows = np.flatnonzero(unsaid & _turned(path, lines.reading.rotary))[:1]
        memory[TURNED] = int(path.source[rows[0]]) + 1 if len(rows) else 0
    if memory[TURNED] and lines.state.frames.following is not None:
        where = Location(lines.findings.file, memory[TURNED])
        raise InputError.one("GX330", MESSAGE, where, SAY)


def _turned(path: Toolpath, rotary: str) -> Flags:
    """Return the rows (n,) in which axes of the machine are turned, or turn while the tool cuts.

    `rotary` are its letters; where no machine file has them, those of rotary axes.
    """
    columns = [k for k, axis in enumerate(path.axes) if axis in (rotary or ROTARY)]
    first, last = path.start[:, columns], path.end[:, columns]
    turns = (np.nan_to_num(last - first) != 0.0).any(axis=1) & (path.kind != Kind.RAPID)
    return np.asarray((_off(first) | _off(last)).any(axis=1) | turns)


def _off(angles: Floats) -> Flags:
    """Return which angles (degrees) are neither 0 nor whole turns; nan is not."""
    return np.asarray(np.nan_to_num(np.mod(angles, TURN)) != 0.0)
