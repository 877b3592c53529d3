"""What of the language a program uses, named for a person."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from gcxform.dialect.dialect import ROTARY, Dialect
from gcxform.toolpath.angles import TURN
from gcxform.toolpath.path import Plane, Toolpath

CODES: Final[Mapping[str, str]] = {
    "incremental": "G91",
    "inch": "G20",
    "absolute centres": "G90.1",
    "inverse time": "G93",
    "feed per turn": "G95",
    "canned cycles": "G73 G74 G76 G77 G81 G82 G83 G84 G85 G86 G87 G88 G89",
    "pockets and patterns": "G12 G13 G70 G71 G72 G150",
    "cutter compensation": "G41 G42 G41.1 G42.1 G141",
    "tool length": "G43 G44 G43.1 G43.2 G143",
    "tool centre point control": "G43.4 G43.5 G234",
    "machine coordinates": "G53",
    "reference moves": "G27 G28 G29 G30",
    "shifted coordinates": "G10 G52 G92",
    "rotation, scaling, mirror": "G51 G51.1 G68 G101",
    "tilted planes": "G68.2 G68.3 G68.4 G53.1 G253 G254 G268",
    "probing": "G31 G35 G36 G37 G38.2 G38.3 G38.4 G38.5 G136",
    "tied to the spindle": "G33 G33.1 G34 G63 G174 G184 M29",
    "constant surface speed": "G96",
    "subprograms": "M97 M98 M198 G65 G66",
}
"""Codes by what they are used for; one counts where the dialect has it."""
EXTENDED_OFFSETS = ("G54.1", "G154", "G59.1", "G59.2", "G59.3")
STANDARD_OFFSETS = tuple(f"G{n}" for n in range(54, 60))
SMALL = 1e-6  # mm, rad


def by_code(codes: Mapping[str, int], dialect: type[Dialect]) -> list[str]:
    """Return the features that the codes of a program show, each with its codes."""
    known = {c for c in codes if c in dialect.codes or c[0] == "M"}
    found = []
    for feature, names in CODES.items():
        if used := [name for name in names.split() if name in known]:
            found.append(f"{feature} ({' '.join(used)})")
    offsets = [name for name in (*STANDARD_OFFSETS, *EXTENDED_OFFSETS) if name in known]
    if len(offsets) > 1:
        found.append(f"work offsets ({' '.join(offsets)})")
    return found


def by_path(path: Toolpath) -> set[str]:
    """Return the features that a path shows."""
    found = set()
    if path.has_arcs:
        found.add("arcs")
        arcs = np.flatnonzero(path.is_arc)
        normal = np.array([plane.axes[2] for plane in Plane])[path.plane[arcs]]
        rise = path.end[arcs, normal] - path.start[arcs, normal]
        if (np.abs(np.nan_to_num(rise)) > SMALL).any():
            found.add("helices")
        if (path.sweep[arcs] > TURN - SMALL).any():
            found.add("full circles")
        if (path.plane[arcs] != 0).any():
            found.add("arcs in other planes")
    if path.has_splines:
        found.add("splines")
    for axis, end, start in zip(path.axes, path.end.T, path.start.T, strict=True):
        if axis in ROTARY and (np.abs(end - start) > SMALL).any():
            found.add("rotary axes")
    return found
