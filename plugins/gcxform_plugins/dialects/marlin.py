"""Printers: Marlin, and what Prusa, RepRapFirmware, Klipper and Smoothie read like it.

| what | printers |
|---|---|
| block | one command, G or M with its words: a second one is not heard, and refused |
| motion | is not modal: each block says G0, G1, G2 or G3 |
| E | filament, mm; it goes with the move in proportion, along an arc with the angle |
| E after G90, G91, M82, M83 | firmware differs; refused where that decides |
| E at start | counts from 0, as after power-up; G92 E sets it |
| G28 | goes to the switches: X, Y and Z stand nowhere known until they are programmed |
| G4 | P in ms, S in s |
| comments | `;`; `(...)` on a line of its own: a command that is not known, and does nothing |
| a letter without a number | names an axis to G28 and M84, and is nothing to a move |
| line | at most 96 characters with blanks; here 64 without blanks and comments |
| arcs | in XY, by I and J, K is dropped; how fine the firmware cuts them is not known here |
| G29 alone | it probes the bed: X, Y and Z stand nowhere known; with words it is refused |
| G20, G5, G10, G11, G92 alone, T | firmware differs: refused |
| M codes of heaters, fans, motors, limits | move nothing |

Sources: the pages of Marlin's documentation on each code; for E the sources of Prusa,
RepRapFirmware and Smoothie, and Klipper as executed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

HEAT = (104, 109, 140, 190, 141, 191)
FAN = (106, 107)
MOTORS = (17, 18, 84)
LIMITS = (201, 203, 204, 205, 900)
SAID = (73, 105, 108, 114, 115, 300, 413)
GONE = ("G93", "G94", "G20", "G40", "G49", "G80", *(f"G{n}" for n in range(54, 60)))


class Marlin(gx.Dialect):
    """Printers: Marlin and its like, with an extruder."""

    name = "marlin"
    grammar = ("gcxform_grammars", "marlin")
    axes = "XYZE"
    differs: ClassVar[Mapping[str, str]] = {
        "G20": "Smoothie does not read E in inches",
        "G28": "it goes to the switches, and takes letters without numbers",
        "G29": "it probes the bed",
        "m_codes": "a file ends where it ends",
    }
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{code: what for code, what in v.ISO.items() if code not in GONE},
        "G92": v.frame("non-modal", "preset", "XYZE"),
        "G28": v.frame("non-modal", "home"),
        "G29": v.frame("non-modal", "home"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        0: v.ISO_M[0],
        1: v.ISO_M[1],
        **{code: gx.MCode("spindle", takes="S") for code in (3, 4, 5)},
        **{code: gx.MCode("coolant") for code in (7, 8, 9)},
        82: gx.MCode("extrusion"),
        83: gx.MCode("extrusion"),
        **{code: gx.MCode("heat", takes="SRPBIF") for code in HEAT},
        **{code: gx.MCode("fan", takes="SP") for code in FAN},
        **{code: gx.MCode("motors", takes="S") for code in MOTORS},
        **{code: gx.MCode("limits", takes="XYZESPRTJBKQ") for code in LIMITS},
        **{code: gx.MCode("said", takes="PRSQ") for code in SAID},
    }
    program_rule = gx.ProgramRule(has_percent=False, has_program_number=False)
    text_rule = gx.TextRule(line_length=64, length_without_blanks=True, comments=";(")
    block_rule = gx.BlockRule(words="FIJKPRSTBQ", one_command=True)
    point_rule = gx.PointRule(dwell={"P": 0.001, "S": 1.0})
    numbers = gx.NumberFormat(mm=5, inch=6)
    motion_rule = gx.MotionRule(g28_without_axes=True)
    arc_rule = gx.ArcRule(planes=frozenset({"XY"}), third="dropped")
    tool_rule = gx.ToolRule(t_selects=False)
    offset_rule = gx.OffsetRule(known_at_start=True, g10_offsets=())
