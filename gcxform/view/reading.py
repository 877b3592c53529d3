"""A program as it is shown: its moves, the lines they come from, and the codes in force there."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np

from gcxform.api import joined
from gcxform.contract.options import KinematicsFile
from gcxform.contract.passes import Pass
from gcxform.contract.tilted_planes import with_known_planes
from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.straightened import located, written_out
from gcxform.machine.machine import Machine
from gcxform.modal.interpreter import Interpreted, Interpreter
from gcxform.modal.meaning.tables import FAMILIES, NUMBER
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Modes, Reading
from gcxform.pipeline.plan import Plan
from gcxform.syntax.source import Source
from gcxform.system.arrays import Ints
from gcxform.toolpath.facts import AXIS_POSITIONS, TIP_POSITIONS
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

GROUPS = {
    "motion": "motion",
    "plane": "plane",
    "distance": "incremental",
    "arc-distance": "absolute_centre",
    "feed-mode": "feed_mode",
    "units": "inch",
    "frame": "",
    "cutter-comp": "comp",
}
"""Groups of codes that are shown, and the column of `Modes` that has each; frames have names."""
WORK = "@"
"""What stands for the name of the frame among the codes of a block."""


@dataclass(frozen=True)
class Shown:
    """A program that is shown.

    sha256  of what was written
    text    what was written, and after it the files that it calls
    path    its moves; `source` counts executed blocks, from 0
    line    (blocks,) line of the text, from 0, that each executed block stands for
    tips    whether X, Y and Z are the tip of the tool, whatever the control says
    machine the one that goes along it, where that is known
    mode    (blocks,) index into `modes`, the codes in force after each executed block
    """

    name: str
    sha256: str
    dialect: type[Dialect]
    text: bytes
    path: Toolpath
    line: Ints
    mode: Ints
    modes: tuple[str, ...]
    tips: bool = False
    machine: Machine | None = None


def read(source: Source, dialect: type[Dialect], reading: Reading) -> Shown:
    """Return a program as it is shown. Raises InputError where it is refused."""
    dialect = with_known_planes(dialect, reading)
    return _shown(source, written_out(source, dialect, reading), dialect, reading)


def read_for(plan: Plan, source: Source) -> Shown:
    """Return a program as a pipeline reads it. Raises InputError where it is refused."""
    executed = written_out(source, plan.read_as, plan.machine_reading)
    executed, dialect = plan.without_tip_codes(executed)
    return _shown(source, executed, dialect, plan.reading_at_start(dialect.axes))


def on_machines(plan: Plan, source: Shown, output: Shown) -> tuple[Shown, Shown]:
    """Return a program and what a pipeline made of it, each with its machine.

    Both are told whether they are programs of tips. What a pass makes for a machine of its own goes
    on that.
    """
    reads = any(TIP_POSITIONS in step.requires for step in plan.path_passes)
    writes = reads
    for step in plan.path_passes:
        said = [fact for fact in (TIP_POSITIONS, AXIS_POSITIONS) if fact in step.ensures]
        writes = said[0] is TIP_POSITIONS if said else writes
    others = [each.machine for each in given(plan.path_passes, KinematicsFile)]
    machines = [*([plan.machine] if plan.machine else []), *others] or [None]
    return (
        replace(source, tips=reads, machine=machines[0]),
        replace(output, tips=writes, machine=machines[-1]),
    )


def given(steps: Sequence[Pass], kind: type[Any]) -> list[Any]:
    """Return the options of a kind that steps have."""
    values = [getattr(step, field.name, None) for step in steps for field in fields(step)]
    return [value for value in values if isinstance(value, kind)]


def _shown(source: Source, executed: Source, dialect: type[Dialect], reading: Reading) -> Shown:
    try:
        windows = _interpreted(executed, dialect, reading)
    except InputError as error:
        raise located(error, executed) from None
    path = joined([window.path for window in windows])
    mode, modes = _codes([window.modes for window in windows])
    text = b"".join(source.windows())
    sha256 = hashlib.sha256(text).hexdigest()
    for file in getattr(executed, "files", ()):
        text = text + (b"" if text.endswith(b"\n") else b"\n") + file.text
    line = getattr(executed, "origin", np.arange(len(path.blocks.inch)))
    return Shown(source.name, sha256, dialect, text, path, np.asarray(line), mode, modes)


def _interpreted(source: Source, dialect: type[Dialect], reading: Reading) -> list[Interpreted]:
    interpreter = Interpreter(dialect, reading, reading.axes_of(source, dialect), source.name)
    interpreter.undecided = source.undecided
    reader = WindowReader(dialect)
    texts: Iterable[bytes] = [*source.windows()] or [b""]
    windows = (reader.read(text) for text in texts)
    return [interpreter.interpret(window, reader.table) for window in windows]


def _codes(windows: list[Modes]) -> tuple[Ints, tuple[str, ...]]:
    """Return for each executed block which codes are in force after it, and these."""
    columns = [
        np.concatenate([getattr(modes, column) for modes in windows]).astype(np.int64)
        for column in filter(None, GROUPS.values())
    ]
    key = np.zeros(len(columns[0]), np.int64)
    for column in columns:
        key = key * (int(column.max(initial=0)) + 1) + column
    _, first, mode = np.unique(key, return_index=True, return_inverse=True)
    told = [_told([int(column[k]) for column in columns]) for k in first.tolist()]
    return mode.astype(np.int64), tuple(told)


def _told(numbers: list[int]) -> str:
    """Return the codes of the groups, of which the frame has no number here."""
    numbered = [group for group, column in GROUPS.items() if column]
    codes = dict(zip(numbered, map(_code, numbered, numbers), strict=True))
    return " ".join(codes.get(group, WORK) for group in GROUPS)


def _code(group: str, number: int) -> str:
    """Return the code of a group by its number; empty where none is in force."""
    return next((code for code in FAMILIES[group] if NUMBER[code] == number), "")
