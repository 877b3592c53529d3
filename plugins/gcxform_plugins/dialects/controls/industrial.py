"""Industrial controls, by what published post-processors for them write.

| control | what its relative Fanuc does not |
|---|---|
| Mazak EIA | P of G4 in ms; G5 P2, P0 smooth; G54.1 P1 to P48; pecks pull back by parameter F12; |
| | G43.4 as on a Fanuc (Vortex i manual p. 5-53: table or work coordinates by a parameter) |
| Mitsubishi M700 | P of G4 in ms; M88: coolant through the tool; G43.4 as a Fanuc (M700V p. 477) |
| Brother C00 | P of G4 in s, with a point; G54.1 P1 to P300; M494, M495: coolant through the tool |
| | G100 changes the tool and moves, G77 and G78 tap: refused |
| Hurco ISNC | P of G4 in s; cycles, G2.4 and G3.4 (arcs in space), G54.1, G5: refused |
| GSK | P of G4 in ms; M88 as Mitsubishi; no G54.1 |
| Syntec | P of G4 in ms; G70, G71 are units; M88, M89: coolant through the tool; G120.1, G121: |
| | smoothing; G54 P7 to P100, M98 H, G10: refused |

| what | Okuma OSP, milling | known from |
|---|---|---|
| work offset | `G15 Hn`; G54 to G59 are lengths of axes: not read | post (2026) |
| tool length | `G56 Hn`, ended by G53 | post |
| G16 H, G28, G30 P | for one block in the machine; home positions 1 to 32: refused | post |
| G4 F | its unit is a setting of the machine: it stays | a note in the post |
| G71 Z, G73 to G89 | cycles with levels of their own: refused | post |
| `X=VC1+10`, `VC1=5`, IF, GOTO, CALL, NOEX | refused | programs |
| centre of an arc | incremental | post |
| end | M2 | post |
| coolant | M7 mist, M8 flood, M9 off, M50 through the tool, M51, M59 air | post |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fanuc import Fanuc

CHANGE = "it changes the tool and moves, in an order that is not known"
LEVELS = "its levels are those of G71, M53 and M54"
HERE = "it goes to a place of the machine for its block"
GONE = ("G4", "G49", *(f"G{n}" for n in range(54, 60)))
HURCO_GONE = ("G54.1", "G54.2", "G54.4", "G5", "G5.1", "G8")
SPACE = "it cuts an arc in space"
BY_H = "posts for it call by H"

NO_PLANES = replace(Fanuc.tip_rule, planes={})
"""Which of two attitudes the others take is not known."""
TIPS = replace(NO_PLANES, planes={"G43.4": "follow-tip"})
"""A tip needs none: its axes stand."""
UNTITLED = replace(Fanuc.program_rule, has_title=False)
NO_ASIDES = replace(Fanuc.text_rule, asides=False)
CALLS_ALONE = replace(Fanuc.flow_rule, words_first=False)
NO_CORNERS = replace(Fanuc.motion_rule, corners="")
"""What the others put into a corner by `,R` and `,C` is not looked up: refused."""
NO_TURNS = replace(Fanuc.cycle_rule, turns=False)
"""Nor what words of rotary axes do in a cycle."""


class Mazak(Fanuc):
    """Mazak EIA/ISO (Matrix, Smooth), as posts write for it."""

    name = "mazak"
    kin = "fanuc"
    motion_rule = NO_CORNERS
    cycle_rule = NO_TURNS
    tip_rule = TIPS
    flow_rule = CALLS_ALONE
    program_rule = UNTITLED
    text_rule = NO_ASIDES
    point_rule = replace(Fanuc.point_rule, dwell={"X": 1.0, "P": 0.001})


class Mitsubishi(Fanuc):
    """Mitsubishi M700, M70 and M80 (MELDAS), as posts write for it."""

    name = "mitsubishi"
    kin = "fanuc"
    motion_rule = NO_CORNERS
    cycle_rule = NO_TURNS
    tip_rule = TIPS
    flow_rule = CALLS_ALONE
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {**Fanuc.m_codes, 88: gx.MCode("coolant")}


class Gsk(Mitsubishi):
    """GSK, milling, as a post writes for it."""

    name = "gsk"
    tip_rule = NO_PLANES
    codes: ClassVar[Mapping[str, gx.Code]] = {
        name: code for name, code in Fanuc.codes.items() if name not in ("G54.1", "G54.2", "G54.4")
    }
    offset_rule = replace(Fanuc.offset_rule, g10_l20="")


class Syntec(Fanuc):
    """Syntec, milling, as a post writes for it."""

    name = "syntec"
    kin = "fanuc"
    motion_rule = NO_CORNERS
    cycle_rule = NO_TURNS
    tip_rule = NO_PLANES
    flow_rule = CALLS_ALONE
    program_rule = UNTITLED
    text_rule = NO_ASIDES
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{n: code for n, code in Fanuc.codes.items() if not n.startswith(("G54.", "G10"))},
        **{code: gx.Code("units") for code in ("G70", "G71")},
        **{code: v.inert("look-ahead", "PQ", act="look-ahead") for code in ("G120.1", "G121")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Fanuc.m_codes,
        **{code: gx.MCode("coolant") for code in (88, 89)},
        98: gx.MCode("stop", after=True, barrier=BY_H, takes="PLH"),
    }
    offset_rule = replace(Fanuc.offset_rule, g10_l20="")
    chosen: ClassVar[Mapping[str, str]] = {
        **Fanuc.chosen,
        **dict.fromkeys(("G20", "G21"), "G20 and G21 as on a Fanuc: posts write G70 and G71"),
    }
    differs: ClassVar[Mapping[str, str]] = {
        "G70": "it is inches (post)",
        "G71": "it is millimetres (post)",
        "G120.1": "smoothing (post)",
        "G121": "no smoothing (post)",
    }


class Brother(Fanuc):
    """Brother CNC-C00 and D00 (Speedio), as posts write for it."""

    name = "brother"
    kin = "fanuc"
    motion_rule = NO_CORNERS
    cycle_rule = NO_TURNS
    tip_rule = NO_PLANES
    flow_rule = CALLS_ALONE
    program_rule = UNTITLED
    text_rule = NO_ASIDES
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Fanuc.codes,
        "G100": v.barrier("non-modal", CHANGE, "THSD"),
        **{code: v.barrier("cycle", v.SYNCHRONISED, "IJLRQ") for code in ("G77", "G78")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Fanuc.m_codes,
        494: gx.MCode("coolant"),
        495: gx.MCode("coolant", after=True),
    }
    point_rule = replace(Fanuc.point_rule, dwell={"P": 1.0})
    differs: ClassVar[Mapping[str, str]] = {
        "point_rule.dwell": "P is in seconds, with a point (post)"
    }


class Hurco(Fanuc):
    """Hurco ISNC; BNC, whose cycles count distances, is refused by its codes."""

    name = "hurco"
    kin = "fanuc"
    motion_rule = NO_CORNERS
    tip_rule = NO_PLANES
    flow_rule = CALLS_ALONE
    program_rule = UNTITLED
    text_rule = NO_ASIDES
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in Fanuc.codes.items() if name not in HURCO_GONE},
        **{
            name: v.barrier("cycle", v.CYCLE, "PQRIJKL")
            for name, code in Fanuc.codes.items()
            if code.group == "cycle" and name != "G80"
        },
        **{code: v.barrier("motion", SPACE, "IJK") for code in ("G2.4", "G3.4")},
    }
    point_rule = replace(Fanuc.point_rule, dwell={"P": 1.0})
    offset_rule = replace(Fanuc.offset_rule, g10_l20="")
    differs: ClassVar[Mapping[str, str]] = {"point_rule.dwell": "P is in seconds (post)"}


class Okuma(gx.Dialect):
    """Okuma OSP mill, as posts write for it."""

    name = "okuma"
    kin = "fanuc"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in v.ISO.items() if name not in GONE},
        "G4": v.inert("non-modal", "F"),
        "G15": v.frame("frame", "work", "H"),
        "G16": v.barrier("non-modal", HERE, "H"),
        **{code: v.barrier("non-modal", v.HOME, "P") for code in ("G28", "G30")},
        "G56": v.frame("tool-length", "length", "H"),
        "G53": v.frame("tool-length", "no-length"),
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        "G61": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G95": gx.Code("feed-mode"),
        **{f"G{n}": v.barrier("cycle", LEVELS, "PQRIJK") for n in (71, 73, 74, 76, *range(81, 90))},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True, act="change-tool"),
        **{code: gx.MCode("coolant") for code in (50, 51, 59)},
    }
    initial: ClassVar[Mapping[str, str]] = {**gx.Dialect.initial, "frame": "G15 H1"}
    differs: ClassVar[Mapping[str, str]] = {
        "G4": "what F counts is a setting of the machine (note in a post)",
        "G15": "H says which work offset (post of 2026)",
        "G53": "it ends a tool length (post of 2014)",
        "G56": "H says which tool length (post of 2014)",
        "initial": "the work offset has a number in H",
        "offset_rule.g10_offsets": "there is no G10",
    }
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True))
    point_rule = gx.PointRule(required=True)
    cutter_comp = gx.CutterComp(stored=True)
    offset_rule = gx.OffsetRule(g10_offsets=())
