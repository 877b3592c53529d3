"""Mach3, milling. *Post*: what published post-processors write; *known*: nobody has checked it.

| what | Mach3 | known from |
|---|---|---|
| I, J, K at the start | from the start of the arc: a setting, so that it is assumed | post |
| G4 P | seconds or milliseconds: a setting, refused | post |
| G28.1 | moves to the switches: refused | known |
| G68, G50, G51, G15, G16 | turn and scale by words of their own: refused | known |
| cycles, G12, G13 | steps are not known: refused | known |
| M6 | runs a macro that may move: positions are lost | known |
| lengths | G43 H, G49 | post |
| G61, G64 | exact stop and constant velocity | known |
"""

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

UNIT = "whether P counts seconds or milliseconds is a setting"
SWITCHES = "it moves to the switches"
CYCLES = (73, 81, 82, 83, 84, 85, 86, 88, 89)


class Mach3(gx.Dialect):
    """Mach3 mill, as posts write for it."""

    name = "mach3"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G4": v.barrier("non-modal", UNIT, "P"),
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        "G95": gx.Code("feed-mode"),
        "G61": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        **{code: v.inert("retract") for code in ("G98", "G99")},
        "G10": v.frame("non-modal", "set-work", "XYZABCLP"),
        "G52": v.frame("non-modal", "local", "XYZABC"),
        "G92": v.frame("non-modal", "preset", "XYZABC"),
        "G92.1": v.frame("non-modal", "preset-clear"),
        "G28": v.frame("non-modal", "home"),
        "G30": v.frame("non-modal", "home"),
        "G28.1": v.barrier("non-modal", SWITCHES),
        "G53": v.frame("non-modal", "machine"),
        "G43": v.frame("tool-length", "length", "H"),
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        **{f"G{n}": v.barrier("motion", v.CYCLE, "PQRL") for n in CYCLES},
        **{code: v.barrier("non-modal", v.TRANSFORM) for code in ("G15", "G16", "G50", "G51")},
        **{code: v.barrier("non-modal", v.TRANSFORM, "RI") for code in ("G68", "G69")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True),
        **{code: gx.MCode("override") for code in (48, 49)},
        98: gx.MCode("stop", after=True, barrier=v.CALL, takes="PQL"),
        99: gx.MCode("stop", after=True, barrier=v.CALL),
    }
    chosen: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("G2", "G3"), "I, J and K count from the start of the arc (IJ Mode), but after G90.1"
    )
    text_rule = gx.TextRule(comments="(;", active_comments=("MSG,",), telling_comments=("MSG,",))
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True, takes="PQS"))
    offset_rule = gx.OffsetRule()
