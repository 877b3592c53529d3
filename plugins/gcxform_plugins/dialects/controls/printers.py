"""Printers by their firmware: what is certain where `marlin`, which reads them all, must refuse.

| what | RepRapFirmware 3 | Klipper | Prusa 8-bit | Smoothie |
|---|---|---|---|---|
| E is a distance | by M83 | by M83 or G91 | by M83 | by the last of M83, M82, G90, G91 |
| G4 | P in ms, S in s | P in ms | as RepRapFirmware | P and S are added |
| G10, G11 | may lift Z: refused | a retraction without Z: kept | refused | refused |
| G92 alone | refused | refused: it sets all axes | refused | refused |
| arcs in XY | by I and J, or R | by I and J | by I and J | by I and J |
| small letters | as capitals | as capitals | as capitals | a shell command: refused |
| other words on a line | refused | `NAME=...`: refused | refused | refused |

RepRapFirmware as a mill, in CNC mode (M453; StringParser.cpp): parentheses are comments, and a
line that begins with an axis goes on with G0 to G3, which is refused here. T runs tfree, tpre and
tpost, which may move, and puts the offset of the tool in force (G10 P), along any axis.

Sources: `gcode_move.py`, `gcode_arcs.py`, `firmware_retraction.py` of Klipper, as executed;
RepRapFirmware 3.5, Prusa-Firmware and Smoothieware, as read; for `marlin2`, whose E is as that of
Smoothie, the pages of Marlin on M82, M83, G90 and G91. How fine arcs are cut is not known.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.marlin import Marlin

NO_R = Marlin.block_rule.words.replace("R", "")
M_WITHOUT_R: Mapping[int, gx.MCode] = {
    number: replace(code, takes=code.takes.replace("R", ""))
    for number, code in Marlin.m_codes.items()
}
"""R is no radius here, and no other word: an arc by one would not be cut."""
LIFTS = "it retracts, and lifts Z where the printer is set so"


class Marlin2(Marlin):
    """Marlin 2, by its documentation: E is a distance by the last of M83, M82, G90, G91."""

    name = "marlin2"
    kin = "marlin"
    motion_rule = replace(Marlin.motion_rule, extruder="last")


class Rrf(Marlin):
    """RepRapFirmware 3, as a printer."""

    name = "rrf"
    kin = "marlin"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Marlin.codes,
        **{code: v.barrier("non-modal", LIFTS, "XYZPRSL") for code in ("G10", "G11")},
        **{code: v.barrier("rotation", v.TRANSFORM, "XYRI") for code in ("G68", "G69")},
    }
    text_rule = replace(Marlin.text_rule, comments=";")
    block_rule = replace(Marlin.block_rule, words="FIJKLPRSTBQ")
    motion_rule = replace(Marlin.motion_rule, extruder="own")


class RrfCnc(Rrf):
    """RepRapFirmware 3, as a mill (M453)."""

    name = "rrf-cnc"
    kin = "marlin"
    grammar = ("gcxform_grammars", "rrf_cnc")
    axes = "XYZ"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Rrf.codes,
        **{f"G{n}": v.ISO[f"G{n}"] for n in range(54, 60)},
        "G92": v.frame("non-modal", "preset", "XYZ"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **{n: code for n, code in Rrf.m_codes.items() if code.group not in ("extrusion", "limits")},
        453: gx.MCode("said"),
    }
    text_rule = replace(Rrf.text_rule, comments=";(")
    block_rule = replace(Rrf.block_rule, words="FIJKLPRSBQT")
    motion_rule = replace(Rrf.motion_rule, extruder="")
    offset_rule = replace(Rrf.offset_rule, known_at_start=False)
    tool_rule = gx.ToolRule(t_changes=True)


class Prusa(Marlin):
    """Prusa's 8-bit firmware, of MK2 and MK3."""

    name = "prusa"
    kin = "marlin"
    m_codes = M_WITHOUT_R
    block_rule = replace(Marlin.block_rule, words=NO_R)
    motion_rule = replace(Marlin.motion_rule, extruder="own")


class Klipper(Marlin):
    """Klipper."""

    name = "klipper"
    kin = "marlin"
    m_codes = M_WITHOUT_R
    block_rule = replace(Marlin.block_rule, words=NO_R)
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Marlin.codes,
        **{code: v.inert("retraction") for code in ("G10", "G11")},
    }
    differs: ClassVar[Mapping[str, str]] = {
        **Marlin.differs,
        "G10": "it retracts (firmware_retraction.py)",
        "G11": "it retracts (firmware_retraction.py)",
    }
    text_rule = replace(Marlin.text_rule, comments=";")
    point_rule = gx.PointRule(dwell={"P": 0.001})
    motion_rule = replace(Marlin.motion_rule, extruder="either")


class Smoothieware(Marlin):
    """Smoothieware, as a printer."""

    name = "smoothieware"
    kin = "marlin"
    grammar = ("gcxform_grammars", "smoothieware")
    m_codes = M_WITHOUT_R
    block_rule = replace(Marlin.block_rule, words=NO_R)
    text_rule = replace(Marlin.text_rule, comments=";", lower_case=False)
    motion_rule = replace(Marlin.motion_rule, extruder="last")
