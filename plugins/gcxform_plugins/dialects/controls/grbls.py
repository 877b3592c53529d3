"""Descendants of GRBL 1.1h: what they read otherwise, from their sources.

| what | grblHAL (core, `gcode.c`) | FluidNC (`GCode.cpp`) |
|---|---|---|
| `/` | a switch, or `$B`, decides | refused |
| block | at most 256 characters | at most 127, with blanks and comments |
| `;` inside parentheses | is text | ends the block all the same |
| comments | `(MSG,` shows | `(MSG` `(PRINT,` `(DEBUG,` show |
| G49 beside axis words | leaves them to the motion | as GRBL |
| arcs | P counts turns; a full circle needs no axis word | P counts turns |
| more work offsets | G59.1 to G59.3 | G59.1 to G59.3 |
| tool change | M6 may move; M61 Q | M6 may move; M61 Q |
| inputs, outputs | M62 to M68, by what is built | M62 to M68; E, Q |
| lengths | G43 H G43.2 from its table, if there is one | G43.1 alone |
| G98 G99 | kept | refused |
| cycles, G5, G50, G51, G33, G76, G65 | ways of their own, or the build decides: refused | refused |
| G64, G61.1, G41, G42, G7, G96 | the build decides: refused | refused |
| after M2, M30 | as GRBL | as GRBL |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.grbl import Grbl

MORE = ("G59.1", "G59.2", "G59.3")
CHANGE: Mapping[int, gx.MCode] = {
    6: gx.MCode("tool", loses_position=True, act="change-tool"),
    61: gx.MCode("tool", takes="Q", act="set-tool"),
    **{code: gx.MCode("output", takes="PQELR") for code in range(62, 69)},
}
FIVE = "XYZABC"
TURNING = replace(Grbl.arc_rule, turns="P")
OFFSETS = replace(Grbl.offset_rule, g10_offsets=(*Grbl.offset_rule.g10_offsets, *MORE))


class GrblHAL(Grbl):
    """grblHAL, as its core is built without options."""

    name = "grblhal"
    kin = "grbl"
    axes = FIVE
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Grbl.codes,
        **{code: v.frame("frame", "work") for code in MORE},
        **{code: v.inert("retract") for code in ("G98", "G99")},
        "G95": gx.Code("feed-mode"),
        "G10": v.frame("non-modal", "set-work", FIVE + "LPR"),
        "G92": v.frame("non-modal", "preset", FIVE),
        "G43": v.frame("tool-length", "length", "H"),
        "G43.1": v.frame("tool-length", "length-vector", FIVE),
        "G43.2": v.frame("tool-length", "length-add", "H"),
        **{f"G{n}": v.barrier("motion", v.CYCLE, "PQRL") for n in (73, 81, 82, 83, 85, 86, 89)},
        **{code: v.barrier("motion", "it cuts a spline", "IJPQ") for code in ("G5", "G5.1")},
        **{code: v.barrier("motion", v.SYNCHRONISED, "EHIJKLPQR") for code in ("G33", "G76")},
        **{code: v.barrier("scaling", v.TRANSFORM, FIVE) for code in ("G50", "G51")},
        "G65": v.barrier("non-modal", v.CALL, "ABCDEFHIJKMPQRSTXYZ"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Grbl.m_codes,
        **CHANGE,
        **{code: gx.MCode("override", takes="P") for code in (48, 49, 50, 51, 53)},
        60: gx.MCode("stop", after=True),
    }
    program_rule = replace(Grbl.program_rule, block_delete="")
    text_rule = replace(
        Grbl.text_rule,
        line_length=256,
        length_without_blanks=False,
        active_comments=("MSG,",),
        telling_comments=("MSG,",),
    )
    block_rule = replace(Grbl.block_rule, words="DEFHIJKLNPQRST")
    arc_rule = replace(TURNING, circle="", third="")
    offset_rule = replace(OFFSETS, g10_tools=frozenset((1, 10, 11)))
    tool_rule = replace(Grbl.tool_rule, g49_takes_axes=False, lengths_aside=True)


class FluidNC(Grbl):
    """FluidNC 3."""

    name = "fluidnc"
    kin = "grbl"
    grammar = ("gcxform_grammars", "fluidnc")
    axes = FIVE
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Grbl.codes,
        **{code: v.frame("frame", "work") for code in MORE},
        "G10": v.frame("non-modal", "set-work", FIVE + "LP"),
        "G92": v.frame("non-modal", "preset", FIVE),
        "G43.1": v.frame("tool-length", "length-vector", FIVE),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {**Grbl.m_codes, **CHANGE}
    text_rule = replace(
        Grbl.text_rule,
        line_length=127,
        length_without_blanks=False,
        semicolon_ends=True,
        active_comments=("MSG", "PRINT,", "DEBUG,"),
        telling_comments=("MSG", "PRINT,", "DEBUG,"),
    )
    block_rule = replace(Grbl.block_rule, words="EFIJKLNPQRST")
    arc_rule = TURNING
    offset_rule = OFFSETS
