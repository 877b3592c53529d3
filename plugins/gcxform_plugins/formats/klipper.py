"""Klipper's bed meshes and skew corrections, as they stand in printer.cfg."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, NamedTuple

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Floats
from gcxform_plugins.formats.shared import height_points as heightpoints

POINTS_AT_MOST = 10_000  # on an axis: a slip in a count must not ask for all memory
SAVED = r"#\*#"  # how Klipper marks the lines that it saves itself
WORDS = rf"(?<!\S){SAVED}|\[[^\]]*\]|[^\s=:,\[\]]+|[=:]"
Profile = Annotated[str, gx.Option("name of the profile, where the file has several")]


@dataclass(frozen=True)
class KlipperMesh(gx.ErrorFormat):
    """Klipper bed meshes: a [bed_mesh NAME] profile of a printer.cfg, straight between the points.

    Between its points Klipper bends a mesh as mesh_x_pps and mesh_y_pps say; here it is straight,
    which is what is written: both are 0.
    """

    profile: Profile = ""

    name: ClassVar[str] = "klipper-mesh"
    suffixes: ClassVar[tuple[str, ...]] = (".cfg",)
    control: ClassVar[str] = "Klipper, BED_MESH_PROFILE LOAD=... after the lines are in printer.cfg"

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file has a profile of a mesh."""
        return path.suffix.lower() in cls.suffixes and _has(path, "bed_mesh")

    def read(self, path: Path) -> gx.Lattice:
        """Return the height map of the profile."""
        section = _section(path, "bed_mesh", self.profile)
        version = section.number("version")
        if version != 1:
            row = section.keys["version"]
            raise row.refuse("GX482", f"version {version:g} of meshes is not known")
        x, y = (_positions(section, letter) for letter in "xy")
        height = _heights(section, len(x), len(y))
        return heightpoints.surface(x, y, height)

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the section of a profile."""
        x, y, height = heightpoints.heights(self.name, model)
        heightpoints.even(self.name, "X", x)
        heightpoints.even(self.name, "Y", y)
        keys = {"version": "1", "points": ""}
        lines = [
            f"[bed_mesh {self.profile or 'default'}]",
            *(f"{k} = {v}" for k, v in keys.items()),
        ]
        lines = [line.rstrip() for line in lines]
        lines += ["  " + ", ".join(gx.decimal(z) for z in row) for row in height.tolist()]
        for letter, nodes in (("x", x), ("y", y)):
            lines.append(f"min_{letter} = {gx.decimal(nodes[0])}")
            lines.append(f"max_{letter} = {gx.decimal(nodes[-1])}")
            lines += [f"{letter}_count = {len(nodes)}", f"mesh_{letter}_pps = 0"]
        return {"": "\n".join([*lines, "algo = direct", "tension = 0.2"]) + "\n"}


@dataclass(frozen=True)
class KlipperSkew(gx.ErrorFormat):
    """Klipper skew corrections: a [skew_correction NAME] profile of a printer.cfg.

    Klipper commands x - y xy_skew - z (xz_skew - xy_skew yz_skew) and y - z yz_skew, which is
    exact for the error (y xy_skew + z xz_skew, z yz_skew, 0) of a command.
    """

    profile: Profile = ""

    name: ClassVar[str] = "klipper-skew"
    suffixes: ClassVar[tuple[str, ...]] = (".cfg",)
    control: ClassVar[str] = "Klipper, SKEW_PROFILE LOAD=... after the lines are in printer.cfg"

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file has a profile of skew."""
        return path.suffix.lower() in cls.suffixes and _has(path, "skew_correction")

    def read(self, path: Path) -> gx.Linear:
        """Return the skew of the profile."""
        section = _section(path, "skew_correction", self.profile)
        matrix = np.zeros((3, 3))
        for (to, by), key in _SKEWS.items():
            matrix[to, by] = section.number(key)
        return gx.Linear(matrix, np.zeros(3))

    def write(self, model: gx.ErrorModel) -> dict[str, str]:
        """Return the section of a profile."""
        if not isinstance(model, gx.Linear):
            raise gx.cannot_hold(self.name, f"a model of the kind {model.kind!r}")
        rest = model.matrix.copy()
        rest[tuple(np.transpose(list(_SKEWS)))] = 0.0
        if rest.any():
            raise gx.cannot_hold(self.name, "errors of scale: it holds squareness alone")
        if (model.matrix @ model.origin).any():
            raise gx.cannot_hold(self.name, "an origin other than 0, 0, 0")
        lines = [f"[skew_correction {self.profile or 'default'}]"]
        lines += [f"{k} = {gx.decimal(model.matrix[at], 15)}" for at, k in _SKEWS.items()]
        return {"": "\n".join(lines) + "\n"}


_SKEWS = {(0, 1): "xy_skew", (0, 2): "xz_skew", (1, 2): "yz_skew"}


class _Section(NamedTuple):
    """One section of a printer.cfg: its keys with their lines, and the lines below each."""

    head: gx.TextRow
    keys: Mapping[str, gx.TextRow]
    below: Mapping[str, list[gx.TextRow]]

    def key(self, name: str) -> gx.TextRow:
        """Return the line of a key, or refuse a section without it."""
        if name not in self.keys:
            raise self.head.refuse("GX417", f"the section lacks {name!r}", 0)
        return self.keys[name]

    def number(self, name: str) -> float:
        """Return the finite number of a key."""
        row = self.key(name)
        if len(row.words) != 3:
            raise row.refuse("GX418", f"{name} is one number", min(len(row.words), 3))
        value = row.number(2)
        if not np.isfinite(value):
            raise row.refuse("GX412", f"{name} is {row.word(2)}", 2)
        return value


def _has(path: Path, kind: str) -> bool:
    """Return whether a file of any length has a section of a kind."""
    try:
        text = path.read_text("utf-8", "replace")
    except (OSError, ValueError):
        return False
    return re.search(rf"^(?:{SAVED})?\s*\[{kind}\s+[^\]]+\]", text, re.M) is not None


def _section(path: Path, kind: str, profile: str) -> _Section:
    """Return the profile that is asked for, or the only one. Raises UsageError."""
    found: dict[str, _Section] = {}
    section = None
    key = ""
    for row in map(_unmarked, gx.text_rows(path, WORDS)):
        first = row.word(0)
        if first.startswith("["):
            head = first[1:-1].split()
            section = _Section(row, {}, {}) if head[:1] == [kind] and len(head) == 2 else None
            if section is not None:
                found[head[1]] = section
        elif section is not None and row.word(1) in ("=", ":"):
            key = first
            section.keys[key] = row  # type: ignore[index]
            section.below[key] = []  # type: ignore[index]
        elif section is not None and first and not first.startswith(("#", ";")):
            section.below.get(key, []).append(row)
    if profile and profile in found:
        return found[profile]
    if profile or len(found) != 1:
        names = ", ".join(found) or "none"
        message = f"which profile of {kind}? The file has: {names}"
        raise gx.UsageError.one("GX480", message, gx.Location(str(path)), "profile=NAME")
    return next(iter(found.values()))


def _unmarked(row: gx.TextRow) -> gx.TextRow:
    """Return a line without Klipper's mark of saved lines."""
    if re.fullmatch(SAVED, row.word(0)):
        return gx.TextRow(row.file, row.line, row.text, row.words[1:])
    return row


def _positions(section: _Section, letter: str) -> Floats:
    """Return the positions of the points on an axis."""
    low, high = (section.number(f"{end}_{letter}") for end in ("min", "max"))
    count = section.number(f"{letter}_count")
    row = section.keys[f"{letter}_count"]
    if not 2 <= count <= POINTS_AT_MOST or count != int(count):
        raise row.refuse("GX417", f"{row.word(2)} is not a number of points", 2)
    if not low < high:
        row = section.keys[f"max_{letter}"]
        raise row.refuse("GX408", f"{letter} does not rise from {low:g} to {high:g}", 2)
    return np.linspace(low, high, int(count))


def _heights(section: _Section, across: int, along: int) -> Floats:
    """Return the heights (along, across) of the points: a line for each position on Y."""
    head = section.key("points")
    rows = section.below["points"]
    if len(rows) != along:
        message = f"there are {len(rows)} rows of points for {along} positions on Y"
        raise head.refuse("GX483", message, 0)
    if found := [f for row in rows for f in gx.number_findings(row, across)]:
        raise gx.UsageError(tuple(found))
    height = np.array([row.numbers(across) for row in rows])
    for i, j in np.argwhere(~np.isfinite(height)).tolist():
        raise rows[i].refuse("GX412", f"the point holds {rows[i].word(j)}", j)
    return height
