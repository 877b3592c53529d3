"""Haas NGC, milling: the language of Fanuc with settings in the place of parameters.

Nothing here was executed on a Haas. *Manual* is what Haas prints in its manuals and on its help
pages, *course* in its courses for programmers; *known* is common knowledge that nobody checked, so
that what hangs on it is an option or refused. What is not named here is as in `fanuc`.

| what | Haas | known from |
|---|---|---|
| a distance without a point | Setting 162: refused, or `[input] increment` | manual |
| R and Q without a point | not named for Setting 162: refused in calculator input | manual |
| F without a point | Settings 77, 162: refused, or `[input] feed-increment` | manual |
| its IS-B | 0.001 mm/min, 0.0001 inch/min: the default of Setting 77 | manual |
| G4 P | an integer is ms, with a point it is seconds; no X, no U | known |
| small letters | are read as capitals | known |
| program number | O and five digits at most | manual |
| block | 256 characters | known |
| `Z5. /M8` | the switch decides on what is behind the slash: coolant, else refused | course |
| two codes of a group | as Fanuc: the last is taken | known |
| start and end radius | 0.001 inch is said of alarm 303: taken as 0.01 mm | known |
| M5 M9 M89, M0 M1 M2 M30 | act after the motion of their block, a cycle too | known |
| G154, G110 to G129 | more work offsets: as Fanuc's G54.1 | manual |
| G10 L20 | sets G154 P1, P2 ... | manual |
| G10 L10 to L13 | as Fanuc's: lengths and radii of tools are not known from there on | manual |
| G28 | without axis words every axis goes home at once | manual |
| a tool length behind G28 | cancelled, or not: it says both, so that it is not known | manual |
| G53 | goes in G0 or in G1, whichever is in force | manual |
| G52, G92 | Setting 33: refused unless `[control] g52 = "fanuc"` says that it is FANUC | manual |
| canned cycles | L counts the holes, L0 stores | known |
| G73 G83 by I, J, K, or with P | stay as they are, to the same control; else refused | manual |
| a cycle without X and Y | Setting 28: stays, or `cycle-without-place = "drills"` | manual |
| G12 G13, G47 | pockets and engraving: kept, places are lost behind them, no offsets | manual |
| G150, drilling | cycles: refused by name | manual |
| G70 G71 G72 | drill holes of the cycle in force at places of their own: as these | manual |
| G31 | as Fanuc's | manual |
| G35 G36 G37 G136 | move to a signal and write an offset: kept, both are lost | manual |
| `,C`, `,R` | as Fanuc's, by examples (fliphtml5.com, osspz/qdbf p. 16) | course |
| G68, G101, G100 | as Fanuc's G68, G51.1, G50.1; G101 with zeros only; G51 is refused | manual |
| G107 G112 G113 G253 to G255 G268 G269 | another frame: refused | manual |
| G234 while no axis turns | as G43.4 of a Fanuc: its coordinates turn with the table | manual |
| G103, G187 | look-ahead, smoothness: change no position; E is a length | manual |
| M97 M98 M99 | executed where what they call is found, as Fanuc; P of M98 holds no count | manual |
| M99 P | a jump in its own program, also behind `[...]` or `IF [...]` (96-8000 p. 118) | manual |
| G65 | as Fanuc's, nine deep; L keeps what the macro did to its variables; list II | manual |
| AND OR XOR in brackets | bits of whole parts | manual |
| null EQ 0 | true or not: refused, or `[control] null-compare` | known |
| #10000 to #10999 | may be set; #10100 and above are other names of #100 to #999 | manual |
| M96 M198 | jumps at an input, other programs: refused | manual |
| M16 | is M6 | known |
| M29, M48, M49 | are no tapping mode and no overrides: as any unknown M code | known |
| G141, G143, G161 to G169, G174, G184 | five axes: refused by name | manual |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fanuc import TOOL_TABLE, Fanuc

# fmt: off
NOT_HERE = frozenset((
    "G2.2", "G3.2", "G5", "G5.1", "G6.2", "G7.1", "G8", "G10.6", "G11", "G12.1", "G13.1", "G15",
    "G16", "G22", "G23", "G27", "G30", "G33", "G34", "G43.1", "G43.4", "G43.5", "G50.1", "G51.1",
    "G53.1", "G54.1", "G54.2", "G54.4", "G62", "G63", "G66", "G66.1", "G67", "G68.2", "G68.3",
    "G68.4", "G92.1", "G96", "G97",
))
# fmt: on
"""Codes of Fanuc's table that a Haas mill does not have."""
NOT_HERE_M = frozenset((29, 48, 49))
MORE_OFFSETS = tuple(f"G{number}" for number in range(110, 130) if number not in (112, 113))
CYCLES = {number: replace(one, takes="PQL") for number, one in Fanuc.cycle_rule.cycles.items()}
CYCLES |= {n: replace(CYCLES[n], takes="PQIJKL", open_words="PIJK") for n in (73, 83)}
OWN = v.MACRO_B.machine
ARITHMETIC = replace(
    v.with_logic(v.MACRO_B, bits=True),
    whole=v.MACRO_B.whole.replace("F", ""),
    machine=replace(
        OWN,
        outputs=(*OWN.outputs, range(10000, 11000)),
        counters=(*OWN.counters, range(10000, 11000)),
        lengths=OWN.lengths[:4],
        aliases=((range(10100, 11000), 10_000),),
        signals=(*OWN.signals, range(1601, 2001)),
    ),
)
"""#10100 is another name of #100 (NGC). Tables of its variables list #10000 to #10149 as general
ones, and no other name of #1 to #33: #10000 to #10099 may be set, and are not read. #1601 and
above: flutes and the like of tools."""
PATTERNS = ("G70", "G71", "G72")
FIVE_AXIS_CYCLES = ("G153", "G155", *(f"G{n}" for n in (161, 162, 163, 164, 165, 166, 169)))


class Haas(Fanuc):
    """Haas mill, NGC."""

    name = "haas"
    grammar = ("gcxform_grammars", "haas")
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in Fanuc.codes.items() if name not in NOT_HERE},
        "G100": v.frame("mirror", "no-mirror", "XYZABC"),
        "G101": v.frame("mirror", "mirror", "XYZABC"),
        "G103": v.inert("non-modal", "P", act="look-ahead"),
        "G113": v.barrier("transform", v.TRANSFORM),
        "G187": v.inert("non-modal", "PE", "E", act="look-ahead"),
        "G154": Fanuc.codes["G54.1"],
        **{code: v.frame("frame", "work") for code in MORE_OFFSETS},
        **{code: v.cuts("ZDIJKLPQR") for code in ("G12", "G13")},
        **{code: v.cuts("XYIJKL") for code in PATTERNS},
        "G150": v.barrier("cycle", v.CYCLE, "DIJKLPQR"),
        "G77": v.barrier("cycle", v.CYCLE, "IJKLPQR"),
        "G47": v.cuts("XYZEDIJKPRQ"),
        **{code: v.barrier("cycle", v.CYCLE, "EIJKLPQR") for code in FIVE_AXIS_CYCLES},
        **{code: v.barrier("cycle", v.SYNCHRONISED, "EIJKLPQR") for code in ("G174", "G184")},
        "G141": v.barrier("cutter-comp", v.COMP, "DIJK"),
        "G143": v.barrier("tool-length", v.LENGTH, "H"),
        "G234": v.barrier("tool-length", v.FOLLOWING, "H"),
        **{code: v.barrier("transform", v.TRANSFORM, "IJKPQ") for code in ("G268", "G269")},
        **{code: v.barrier("transform", v.TRANSFORM) for code in ("G253", "G254", "G255")},
        **{code: Fanuc.codes["G37"] for code in ("G35", "G136")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **{number: code for number, code in Fanuc.m_codes.items() if number not in NOT_HERE_M},
        **{number: gx.MCode("brake") for number in (10, 11, 12, 13)},
        16: Fanuc.m_codes[6],
        19: gx.MCode("spindle", takes="PR"),
        **{number: gx.MCode("conveyor") for number in (31, 33)},
        **{number: gx.MCode("coolant-place") for number in (34, 35)},
        **{number: gx.MCode("gear") for number in (41, 42)},
        88: gx.MCode("coolant"),
        89: gx.MCode("coolant", after=True),
        **{number: gx.MCode("stop", after=True, barrier=v.CALL, takes="PQ") for number in (46, 96)},
        97: gx.MCode("stop", after=True, barrier=v.CALL, takes="PL"),
    }
    chosen: ClassVar[Mapping[str, str]] = {"M16": "M16 is M6"}
    settings = (gx.Setting("cycle-without-place", "haas: Setting 28", ("drills",)),)
    program_rule = replace(Fanuc.program_rule, has_title=False, number_digits=5)
    text_rule = replace(Fanuc.text_rule, lower_case=True, line_length=256)
    block_rule = replace(Fanuc.block_rule, words=Fanuc.block_rule.words + "UVW")
    flow_rule = replace(
        Fanuc.flow_rule,
        calls_own_lines=True,
        m99_jumps=True,
        arithmetic=ARITHMETIC,
        macro_levels=9,
        repeats_keep=True,
        argument_list="II",
        null_compare="",
        words_first=False,
    )
    point_rule = replace(
        Fanuc.point_rule,
        # «G01 X1.5 Y3.7 F20.» is F#4 behind #4=20: Haas, on-line manual, Address Substitution
        feed_required=True,
        feed_steps={"IS-B": (1000.0, 10_000.0)},
        calculator_words="XYZABCEFIJKUW",
        dwell={"P": 0.001},
        dwell_in_seconds=True,
    )
    motion_rule = replace(
        Fanuc.motion_rule,
        g28_without_axes=True,
        g28_ends_length=True,
        g53_is_rapid=False,
        m_over_hole=False,
    )
    offset_rule = replace(
        Fanuc.offset_rule,
        names={code: f"G154 P{int(code[1:]) - 109}" for code in MORE_OFFSETS},
        g10_l20="G154",
        g10_tools=TOOL_TABLE - {1},
        g52_known=False,
        mirrors_at_zero=True,
    )
    tip_rule = replace(
        Fanuc.tip_rule,
        codes={"G234": "G43"},
        vector_codes={},
        unfollowed={"G268": "plane", "G253": "plane", "G269": "no-plane", "G234": "tip"},
        planes={"G234": "follow-tip"},
    )
    cycle_rule = replace(
        Fanuc.cycle_rule,
        cycles=CYCLES,
        repeats="L",
        alone="cycle-without-place",
        patterns=frozenset(PATTERNS),
    )
