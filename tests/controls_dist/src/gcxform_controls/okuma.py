"""Okuma OSP, milling. From what published post-processors write; the rest is refused by name.

| what | Okuma | known from |
|---|---|---|
| work offset | `G15 Hn`; G54 to G59 are lengths of axes: not read | post (2026) |
| tool length | `G56 Hn`, ended by G53 | post |
| G16 H, G28, G30 P | for one block in the machine; home positions 1 to 32: refused | post |
| G4 F | its unit is a setting of the machine: refused | a note in the post |
| G71 Z, G73 to G89 | cycles with levels of their own: refused | post |
| centre of an arc | incremental | post |
| end | M2 | post |
| coolant | M7 mist, M8 flood, M9 off, M50 through the tool, M51 air | post |
"""

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

GONE = ("G4", "G49", *(f"G{n}" for n in range(54, 60)))
UNIT = "what F of a dwell counts is a setting of the machine"
HERE = "it goes to a place of the machine for its block"
LEVELS = "its levels are those of G71, M53 and M54"
CYCLES = (71, 73, 74, 76, 81, 82, 83, 84, 85, 86, 87, 88, 89)


class Okuma(gx.Dialect):
    """Okuma OSP mill, as posts write for it."""

    name = "okuma"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in v.ISO.items() if name not in GONE},
        "G4": v.barrier("non-modal", UNIT, "F"),
        "G15": v.frame("frame", "work", "H"),
        "G16": v.barrier("non-modal", HERE, "H"),
        **{code: v.barrier("non-modal", v.HOME, "P") for code in ("G28", "G30")},
        "G56": v.frame("tool-length", "length", "H"),
        "G53": v.frame("tool-length", "no-length"),
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        "G61": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G95": gx.Code("feed-mode"),
        **{f"G{n}": v.barrier("cycle", LEVELS, "PQRIJK") for n in CYCLES},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True),
        **{code: gx.MCode("coolant") for code in (50, 51)},
    }
    initial: ClassVar[Mapping[str, str]] = {**gx.Dialect.initial, "frame": "G15 H1"}
    differs: ClassVar[Mapping[str, str]] = {
        "G15": "H says which work offset (post of 2026)",
        "G53": "it ends a tool length (post of 2014)",
        "G56": "H says which tool length (post of 2014)",
        "initial": "the work offset has a number in H",
        "offset_rule.g10_offsets": "there is no G10",
    }
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True))
    cutter_comp = gx.CutterComp(stored=True)
    offset_rule = gx.OffsetRule(g10_offsets=())
