"""Okuma OSP, milling: written from what two posts for it write, and nothing else.

| what | OSP | known from |
|---|---|---|
| work offset | `G15 Hn`, from G15 H1 | post (2026) |
| G54 to G59 | lengths of axes: not codes of this table, but G56 | post (2026) |
| one block in the machine | `G16 Hn`: refused | post (2026) |
| tool length | `G56 Hn`, until G53 | post (2014) |
| way home | G28, G30 P: where that is only the machine knows: refused | post |
| G4 F | its unit is a setting: it stays | a note in the post |
| drilling | levels from G71, M53, M54: refused | post |
| cutter radius | D names an offset | post |
| M codes | M6 changes the tool; M50, M51, M59 coolant, M2 the end | post |
| numbers | a point on every length, for a parameter says what is meant without | post |
"""

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

POSTS = "posts of 2014 and 2026"
PLACE = "it goes to a place that only the machine knows"
DRILLING = ("G71", "G73", "G74", "G76", *(f"G{n}" for n in range(81, 90)))
WORDS = {
    "G15": v.frame("frame", "work", "H"),
    "G56": v.frame("tool-length", "length", "H"),
    "G53": v.frame("tool-length", "no-length"),
    "G4": v.inert("non-modal", "F"),
    "G95": gx.Code("feed-mode"),
    "G61": v.inert("path", act="exact-stop"),
    "G64": v.inert("path", act="blend"),
    "G41": gx.Code("cutter-comp", takes="D"),
    "G42": gx.Code("cutter-comp", takes="D"),
    "G16": v.barrier("non-modal", PLACE, "H"),
    "G28": v.barrier("non-modal", PLACE, "P"),
    "G30": v.barrier("non-modal", PLACE, "P"),
}


class Osp(gx.Dialect):
    """Okuma OSP, a mill."""

    name = "osp"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in v.ISO.items() if code.group != "frame" and name != "G49"},
        **WORDS,
        **{name: v.barrier("cycle", v.CYCLE, "PQRIJK") for name in DRILLING},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True, act="change-tool"),
        **dict.fromkeys((50, 51, 59), gx.MCode("coolant")),
    }
    initial: ClassVar[Mapping[str, str]] = {**gx.Dialect.initial, "frame": "G15 H1"}
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True))
    point_rule = gx.PointRule(required=True)
    offset_rule = gx.OffsetRule(g10_offsets=())
    cutter_comp = gx.CutterComp(stored=True)
    differs: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("G4", "G15", "G53", "G56", "initial", "offset_rule.g10_offsets"), POSTS
    )
