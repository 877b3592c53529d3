"""ETALON's exchange format, variant "Vendor": what TRAC-CAL and its kin hand to controls."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np

import gcxform as gx
from gcxform_plugins.formats.shared import parameters
from gcxform_plugins.formats.shared.parameters import Order, Parameters, Said, Tool, Values

WORDS = r"\[[^\]]*\]|[{}=]|[^\s{}=\[\]]+"


@dataclass(frozen=True)
class Etalon(gx.ErrorFormat):
    """ETALON exchange files, variant "Vendor": a block for each ISO 230-1 parameter.

    A block is `[C0Y]` with `VALUE = ...`, or `[EXX]` with `Gridpoints = { position value ... }`;
    `//` begins a comment. Positions are mm, values mm and rad. Errors of rotary axes are refused.
    """

    values: Values
    order: Order = None
    tool: Tool = None

    name: ClassVar[str] = "etalon"
    suffixes: ClassVar[tuple[str, ...]] = (".exchange",)
    control: ClassVar[str] = (
        "ISG kernel or TF5280, file_format[i] = ETALON_EXCHANGE; the chain in this order of axes, "
        "workpiece_axes empty, negate off for errors"
    )

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file begins with a block of a parameter."""
        text = gx.head_of(path)
        block = r"^\s*\[[EXYZABC][XYZABC0][XYZABC]\]"
        return bool(re.search(block, text, re.M) and re.search("Gridpoints|VALUE", text, re.I))

    @property
    def _said(self) -> Said:
        return Said(self.name, self.values, self.order, self.tool)

    def read(self, path: Path) -> gx.AxisFunctions | gx.RigidBody:
        """Return the functions of the file."""
        rows = gx.text_rows(path, WORDS, "//")
        if not rows:
            raise gx.UsageError.one("GX417", "the file is empty", gx.Location(str(path)))
        found = Parameters()
        at = 0
        while at < len(rows):
            at = _block(rows, at, found)
        return found.model(self._said)

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return a block for each function."""
        lines = []
        for axis, position, values in parameters.functions_of(self._said, model):
            texts = [parameters.written(row) for row in values]
            for k, column in enumerate(parameters.COLUMNS[: values.shape[1]]):
                lines += [f"[E{column}{axis}]", "Gridpoints = {"]
                for where, row in zip(position.tolist(), texts, strict=True):
                    lines.append(f"  {gx.decimal(where)} {row[k]}")
                lines += ["}", ""]
        return {"": "\n".join(lines)}


def _block(rows: list[gx.TextRow], at: int, found: Parameters) -> int:
    """Read one block and return the number of the row behind it."""
    head = rows[at]
    if not re.fullmatch(r"\[.*\]", head.word(0)) or len(head.words) > 1:
        raise head.refuse("GX417", f"{head.word(0)!r} is not the head of a block, [EXX]", 0)
    name = head.word(0)[1:-1].strip()
    found.claim(name, head, 0)
    if at + 1 == len(rows):
        raise head.refuse("GX418", f"{name} has no value", 0)
    row = rows[at + 1]
    key, equals = row.word(0).lower(), row.word(1)
    if key == "value" and equals == "=" and len(row.words) == 3:
        if name[0] == "E":
            raise row.refuse("GX417", f"{name} is a function, and needs Gridpoints", 0)
        found.squareness[name] = row.number(2)
        return at + 2
    if key != "gridpoints" or equals != "=" or row.word(2) != "{" or len(row.words) != 3:
        raise row.refuse("GX417", "neither VALUE = nor Gridpoints = {", 0)
    if name[0] != "E":
        raise row.refuse("GX482", f"{name} over a position is not supported", 0)
    return _points(rows, at + 2, name, found)


def _points(rows: list[gx.TextRow], at: int, name: str, found: Parameters) -> int:
    """Read the points of a function and return the number of the row behind their brace."""
    last = next((k for k in range(at, len(rows)) if rows[k].word(0) == "}"), len(rows))
    if last == len(rows):
        raise rows[at - 1].refuse("GX418", f"the points of {name} have no end", 2)
    lines = rows[at:last]
    if bad := [f for row in lines for f in gx.number_findings(row, 2)]:
        raise gx.UsageError(tuple(bad))
    numbers = np.array([row.numbers(2) for row in lines]).reshape(-1, 2)
    parameters.checked_function(lines or [rows[last]], numbers, 0)
    found.functions[name] = numbers[:, 0], numbers[:, 1]
    return last + 1
