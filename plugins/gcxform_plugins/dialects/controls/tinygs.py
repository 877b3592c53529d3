"""TinyG and g2core, as their own parsers execute programs.

From `gcode_parser`, `plan_arc` and `canonical_machine` of TinyG 0.97 and of g2core 100, and from
their manuals (Gcode-Support, Gcodes). Where builds differ, what only some of them do is refused.

| what | TinyG | g2core |
|---|---|---|
| comments | go to the end of the line, `(` too | `(` may stand anywhere |
| `(MSG` | shows; `({` is JSON of g2core | as TinyG |
| `/` | deletes the block, but not behind a blank: refused | deletes the block |
| `%` | empties the queue as it comes in: refused | begins a comment: alone it says nothing |
| `!` `~` | act as they come in, also in a comment | as TinyG |
| a move beside G4, G92.1 or their like | is left out: refused | as TinyG |
| F beside G20, G21 | is read in the unit before | as TinyG |
| feed | along X Y Z where they move, else along the rotary axes | as TinyG |
| A, B, C | degrees; in radius mode lengths, which is a setting | as TinyG |
| arcs in XZ | turn the wrong way, or too far: refused | no correction: refused |
| full circle | only without the axes of its plane | as TinyG; G2 and G3 differ otherwise |
| P of an arc | is refused: it adds turns, by the manual one less | as TinyG |
| R of an arc | is refused: builds differ for a negative one | positive and negative |
| a rotary axis beside an arc | turns at its first chord: refused | as TinyG |
| centre across the plane | refused | dropped beside one in it |
| start and end radius | refused beyond 1 mm, or beyond 0.005 mm and 0.1 % | as TinyG |
| G90.1 G91.1 | builds read G90, G91: refused | G90.1 counts from the machine's zero: refused |
| G93 | builds read F as minutes: refused | F in every block; G94 then needs a new one |
| G10 | L2 alone; L20 is taken for L2: refused | L2; L20 forgets G92: refused |
| G28 G30 | move all axes, by a point of another kind in each build: refused | as TinyG |
| G92.2 G92.3 | share a switch with G92: refused | as TinyG |
| G43, tool lengths | none | some builds: refused |
| G61 G61.1 G64 | exact path, exact stop, exact path | as TinyG |
| M6 | moves nothing | as TinyG |
| behind M2, M30 | G80 G17 G90 G94 G54, no shift; execution goes on | as TinyG |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

AXES = "XYZABC"
CENTRES = "builds count centres in more than one way behind it"
MINUTES = "builds count F in more than one way"
SWITCHES = "it moves to the switches"
SWITCH = "it shares a switch with G92"


class TinyG(gx.Dialect):
    """TinyG 0.97."""

    name = "tinyg"
    kin = "grbl"
    grammar = ("gcxform_grammars", "tinyg")
    axes = AXES
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G61": v.inert("path", act="exact-path"),
        "G61.1": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G93": v.barrier("feed-mode", MINUTES),
        **{code: v.barrier("arc-distance", CENTRES) for code in ("G90.1", "G91.1")},
        "G10": v.frame("non-modal", "set-work", AXES + "LP"),
        "G92": v.frame("non-modal", "preset", AXES),
        "G92.1": v.frame("non-modal", "preset-clear"),
        **{code: v.barrier("non-modal", SWITCH) for code in ("G92.2", "G92.3")},
        **{code: v.barrier("non-modal", v.HOME) for code in ("G28", "G30")},
        **{code: v.inert("non-modal") for code in ("G28.1", "G30.1")},
        **{code: v.barrier("non-modal", SWITCHES) for code in ("G28.2", "G28.4")},
        "G28.3": v.barrier("non-modal", v.SHIFT),
        "G53": v.frame("non-modal", "machine"),
        "G38.2": v.barrier("motion", v.PROBE),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", act="change-tool"),
        60: gx.MCode("stop", after=True),
        **{code: gx.MCode("override", takes="P") for code in (48, 49, 50, 51)},
    }
    chosen: ClassVar[Mapping[str, str]] = dict.fromkeys(
        "ABC", "words of rotary axes are degrees (axis mode 1)"
    )
    differs: ClassVar[Mapping[str, str]] = {
        "G28.1": "G28, which would go there, is refused (canonical_machine)",
        "G30.1": "G30, which would go there, is refused (canonical_machine)",
        "program_rule.resets_at_end": "the motion is cancelled, and not G1 (canonical_machine)",
    }
    program_rule = gx.ProgramRule(
        has_percent=False,
        has_program_number=False,
        block_delete="skip",
        stops_at_end=False,
        resets_at_end={
            "motion": "G80",
            "plane": "G17",
            "distance": "G90",
            "feed-mode": "G94",
            "frame": "G54",
            "units": "G21",
        },
        shift_ends=True,
    )
    text_rule = gx.TextRule(
        line_length=254,
        comments="(;",
        active_comments=("MSG", "{"),
        telling_comments=("MSG",),
        acts_anywhere="!~%\x18",
        parenthesis_ends=True,
    )
    block_rule = gx.BlockRule(words="FIJKLNPST", one_action="all")
    feed_rule = gx.FeedRule(before_units=True, of_linear_axes=True, along_lines=True)
    arc_rule = gx.ArcRule(
        absolute=0.005,
        relative=0.001,
        largest=1.0,
        planes=frozenset({"XY", "YZ"}),
        circle="none",
        turns_axes=False,
    )
    offset_rule = gx.OffsetRule(g10_ignores_g91=True)


class G2core(TinyG):
    """g2core, build 100."""

    name = "g2core"
    grammar = ("gcxform_grammars", "g2core")
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **TinyG.codes,
        "G93": v.ISO["G93"],
        "G91.1": gx.Code("arc-distance"),
        **{code: v.barrier("tool-length", v.LENGTH, "H") for code in ("G43", "G43.2")},
        **{code: v.barrier("motion", v.PROBE) for code in ("G38.3", "G38.4", "G38.5")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **TinyG.m_codes,
        **{
            code: gx.MCode("user", barrier="it sets what a comment in JSON says")
            for code in (100, 101)
        },
    }
    program_rule = replace(
        TinyG.program_rule,
        drops_percent=True,
        resets_at_end={
            **{k: c for k, c in TinyG.program_rule.resets_at_end.items() if k != "units"},
            "arc-distance": "G91.1",
        },
    )
    text_rule = replace(TinyG.text_rule, acts_anywhere="!~\x18", parenthesis_ends=False)
    block_rule = replace(TinyG.block_rule, words="FHIJKLNPRST")
    feed_rule = replace(TinyG.feed_rule, mode_clears=True)
    arc_rule = replace(TinyG.arc_rule, third="dropped")
