"""Mach3, milling: written from what posts for it write, and nothing else.

| what | Mach3 | known from |
|---|---|---|
| I, J, K | a setting, until G90.1 (from the zero) or G91.1 (from the start of the arc) | post |
| G4 P | seconds or milliseconds, a setting: it stays | post |
| `M6`, other M codes | run a macro, which may move | post |
| G43 H | the length of a tool of the table | post |
| G28, G30, G53 | home, and one block in the machine | post |
| G10 L2, G52, G92 | shift the zero | post |
| G50 | resets scales, in the heads of posts | post |
| cycles | stay as they are; where they end is not known | post |
| G12, G13, G28.1, G31, G68, G70, G71 and the like | move or scale in ways of their own | recalled |
| M98, M99 | subprograms behind M30: refused | post |
"""

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

SETTING = "a setting decides (post)"
OWN = "it does what no post shows"
CYCLES = (73, 76, 81, 82, 83, 84, 85, 86, 88, 89)
OTHER = ("G12", "G13", "G15", "G16", "G28.1", "G31", "G51", "G68", "G69", "G70", "G71")
SHIFTS = {"G10": ("set-work", "XYZABCLP"), "G52": ("local", "XYZABC"), "G92": ("preset", "XYZABC")}


class Mach(gx.Dialect):
    """Mach3, a mill."""

    name = "mach"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        **{name: v.barrier("non-modal", OWN, "IR") for name in OTHER},
        **{f"G{n}": v.cuts("PQRLIJK", "motion") for n in CYCLES},
        **{name: v.frame("non-modal", *said) for name, said in SHIFTS.items()},
        **dict.fromkeys(("G28", "G30"), v.frame("non-modal", "home")),
        **dict.fromkeys(("G98", "G99"), v.inert("retract")),
        **dict.fromkeys(("G41", "G42"), gx.Code("cutter-comp", takes="D")),
        **dict.fromkeys(("G90.1", "G91.1"), gx.Code("arc-distance")),
        "G4": v.inert("non-modal", "P"),
        "G43": v.frame("tool-length", "length", "H"),
        "G50": v.frame("scaling", "no-scale"),
        "G53": v.frame("non-modal", "machine"),
        "G61": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G92.1": v.frame("non-modal", "preset-clear"),
        "G95": gx.Code("feed-mode"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True, act="change-tool"),
        **dict.fromkeys((48, 49), gx.MCode("override")),
        **dict.fromkeys((98, 99), gx.MCode("stop", after=True, barrier=v.CALL, takes="PQL")),
    }
    settings: ClassVar[tuple[gx.Setting, ...]] = (
        gx.Setting("arc-centres", "how I, J and K count (IJ Mode)", ("incremental",)),
    )
    differs: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("G4", *(f"G{n}" for n in CYCLES)), SETTING
    )
    text_rule = gx.TextRule(active_comments=("MSG,",), telling_comments=("MSG,",))
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True, takes="PQS"))
    arc_rule = gx.ArcRule(absolute=0.002, in_inch=2.54, centres_open=True)
