"""Fanuc 0i and 30i series, milling. What depends on a parameter of the machine is an option.

| what | Fanuc |
|---|---|
| a distance without a point | parameters 1013 and 3401#0 decide: `[input] increment` |
| `;` at the end of a line | is the end of the block, which the line end says as well |
| text behind % in its line | is a title, not read (B-64014EN p. 21, B-63524EN p. 649) |
| motion at start | parameter 3402: taken as unknown, so the first move needs its code |
| units, distance mode at start | parameters: taken as G21 G90, and the certificate says so |
| units of a program for a TNC | must be stated: its first line says MM or INCH |
| `Z5. /M8` | coolant a switch decides on, as posts for Fanucs write it; else refused |
| two codes of a group | the last is taken |
| arc centre | incremental only; no centre at all: refused (parameter 3403 decides what is cut) |
| R together with I J K | refused |
| start and end radius | parameter 3410: taken as 0.01 mm |
| F without a point | mm/min; in inch, G93 or G95 refused, unless it is said what it counts |
| G93 F1 | 0.001 a minute in IS-B and IS-C, 1 in calculator input (16/18 manual) |
| G4 P, P of cycles | ms, also in calculator input; in IS-A, IS-C to IS-E not known |
| another unit or feed mode | the feed is not known until it is programmed |
| M0 M1 M2 M30 M98 M99 | act after the motion of their block |
| M5, M9 with a motion | the machine's PLC decides, commonly after it: taken as after |
| M0 M1 M5 M9 beside a cycle | act over the first hole (15i-MA manual, "Miscellaneous function") |
| an M code not listed | may run a macro: positions and variables are unknown after it |
| words beside it, and beside M6 | may be those of a macro (6080 to 6089): never changed |
| M codes listed in `[control] inert-m` | move no axis and set no variable |
| `X50. ,R5.`, `Y50. ,C3.` | an arc, a chamfer in the corner (cnclearning.com, p=1015): followed |
| the block behind a corner | has to be a G1 with a way (alarms 51 and 52): else refused by name |
| no room for it, a turn below 1 degree | it stops, or has no corner there: refused |
| a corner with another F behind it, G93, M0 or M9 | what is done when is not known: refused |
| a corner at an arc, at G41, in G16; `,A` | is not followed: refused |
| G41, G42 | D stays in force, D0 is none; the file has radii, or `d` and `d-is` (5004#2) |
| G41, G42, G40 with an arc | refused: alarm 34 |
| G43 without Z | moves Z or shifts zero: Z is lost, or `[control] tool-length-alone` says which |
| G43 without H | takes the H that is in force |
| H by itself | another length, or the radius of G41: parameter 5001 decides; Z is not known |
| G10 L2 P0, L20 | shifts all work offsets; sets G54.1 P1, P2 ... |
| G10 L1, L10 to L13 | kept; the lengths and radii of tools are not known from there on |
| tool change | moves axes: positions are unknown after it, but for `inert-m = [6]` |
| canned cycles | R, Z, P, Q stay until the cycle mode ends; K0 stores them without drilling |
| R, Z of G90 behind G91 | levels still, or distances: refused, or `cycle-levels = "stay"` |
| L of a cycle | counts holes in the format of a Series 15: `[control] cycle-repeats = "L"` |
| `A90.` in a cycle, also alone | turns on the way to the hole, and drills: shops index so |
| G73, G83 between pecks | parameters 5114, 5115: must be given, unless the blocks are copied |
| G82, G89 without P | how long they dwell is not known: refused, unless the blocks are copied |
| G76 | the shift in the hole is a parameter's: stays, to the same control; else refused |
| G87, G88 | depend on parameters or on the operator: refused |
| `%` in a comment | ends the file there: none is written from programs of other controls |
| M29 | the tap that follows is in step with the spindle: it moves nothing itself |
| G74, G84 for a SINUMERIK, a TNC, LinuxCNC | in step with the spindle: `taps = "in-step"` |
| G96 | changes the speed of the spindle and no path |
| G30 | as G28, to the point that `[home."G30 P2"]` names, or to one that is not known |
| G43.5 with I J K | the tool axis at the end of a line, on the table (19696#5 is 0, or PS5459) |
| some of its I J K left out | they are 0; all left out: the tool keeps its direction |
| G68.2 to G68.4, G53.1, G43.4 | stay, positions lost, where no pass asks where that is |
| G68.2 X Y Z I J K, then G53.1 | turns a table onto a plane: `gcxform/modal/frames/planes.py` |
| G43.4 while no axis turns | words of a tip on a table: `gcxform/modal/frames/followed_tips.py` |
| G31 | ends at its target at the latest; the axes named then stand nowhere known |
| G36, G37 | measure a tool and write its offset: refused |
| G33, G34, G63 | threads and taps with a feed whose meaning changes: refused |
| G50 S, G92 S, G71 P Q and their like | are of lathes: the program is refused as one (GX234) |
| G27, G29, G60 | over, from or past points that the program does not tell: refused |
| M98 M99 | executed where the program is in the file or in one beside it, which its number names |
| L of M98 | counts, or the digits of P before four |
| local variables across M98 | shared (macro executor B-62093E-1 p. 32) |
| G65 | new ones, null but for those given by letter (16i B-63684EN p. 278); four deep |
| G65 of what is not found | stays; positions, variables, offsets, G0, G90, F are lost behind it |
| G65 P9810, G100, M50, T | `[control.macro]` says how it ends, and what a code calls |
| G36 G37 | move to a signal and write an offset: kept, places and offsets are lost |
| G65 L2 | the second run finds arguments anew or not: refused, or `[control] macro-repeat` |
| I, J, K again in G65 | list II or not (6008#7): refused, or `[control] argument-list` |
| G66 G67 | calls behind each G0 and G1 with axis words; behind arcs, cycles, G28: refused |
| M198 G66.1 | calls of other programs, or with each block: refused |
| a variable that nothing has set | is null, or is left from before: lost, unless given |
| a null variable | leaves its word out, is 0 in expressions, equal to null alone (M700V p. 314) |
| a computed distance | in mm, rounded to `[input] increment`; else lost where that decides |
| an assignment beside words | when it acts is not certain: refused |
| AND OR XOR | of conditions in brackets; of other numbers, and without brackets: refused |
| BIN BCD | whole numbers from 0; ADP: refused |
| FIX, FUP, MOD of negative numbers, ROUND of halves below 0 | known in two ways: refused |
| ATAN, ASIN below 0 | a parameter may add 360 degrees: refused |
| ROUND in a word | rounds to the increment of the word: refused |
| computed S T F D H L P | must be whole numbers |
| #1000 and above | belong to the control: what they go into is lost; outputs, timers may be set |
| #4001 to #4003, #4005 to #4007, #4014, #4109, #4120 | modes that the program states, F and T |
| #5001 to #5003 | where X, Y and Z stand, in plain coordinates; else lost |
| #3000 | an alarm: nothing behind it is executed |
| #2001, #5221, #7001, #10001, #14001 ... | tables that may be set: lengths, zeros are lost behind |
| IF WHILE GOTO | executed, or kept where only the machine decides; almost equal: refused |
| POPEN DPRNT BPRNT PCLOS | alone in a block; kept, what they print is set before |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

BOTTOM, _, CLEARANCE, RETRACT = v.Level

SHIFTS = "the direction in which its tool is shifted is a parameter of the machine"
BY_HAND = "the operator takes the tool out of the hole by hand"
TAP = (*v.tap(v.FORWARD, v.REVERSE, CLEARANCE), v.rapid(RETRACT))
TAP_LEFT = (*v.tap(v.REVERSE, v.FORWARD, CLEARANCE), v.rapid(RETRACT))
BORE = (v.feed(BOTTOM), v.feed(CLEARANCE), v.rapid(RETRACT))
BORE_DWELL = (v.feed(BOTTOM, v.DWELL), v.feed(CLEARANCE), v.rapid(RETRACT))
CYCLES = {
    73: v.Cycle(v.DRILL, pecks="break", needs="Q", takes="PQK"),
    74: v.Cycle(TAP_LEFT, takes="PQK", open_words="Q"),
    76: v.Cycle(v.DRILL_DWELL, takes="PQK", refused=SHIFTS),
    81: v.Cycle(v.DRILL, takes="PQK"),
    82: v.Cycle(v.DRILL_DWELL, needs="P", takes="PQK"),
    83: v.Cycle(v.DRILL, pecks="clear", needs="Q", takes="PQK"),
    84: v.Cycle(TAP, takes="PQK", open_words="Q"),
    85: v.Cycle(BORE, takes="PQK"),
    86: v.Cycle(v.BORE_STOP, takes="PQK", spindle=(1, -1)),
    87: v.Cycle(takes="PQK", refused=SHIFTS),
    88: v.Cycle(takes="PQK", refused=BY_HAND),
    89: v.Cycle(BORE_DWELL, needs="P", takes="PQK"),
}
FILES = gx.LookupRule(
    numbers=("O{n}", "O{n:04}", "O{n:05}", "O{n:08}", "{n}", "{n:04}", "{n:05}"),
    endings=("", ".nc", ".cnc", ".tap"),
    own_ending=True,
    any_case=True,
    by_name=True,
)
TOOL_TABLE = frozenset((1, 10, 11, 12, 13))
CYCLE_RULE = v.CycleRule(CYCLES, stays=v.Staying(words=True), stores=True, turns=True, repeats="K")


class Fanuc(gx.Dialect):
    """Fanuc 0i/30i/31i mill."""

    name = "fanuc"
    grammar = ("gcxform_grammars", "fanuc")
    axes = "XYZABCUVW"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G80": v.inert("cycle"),
        "G95": gx.Code("feed-mode"),
        "G61": v.inert("path", act="exact-stop"),
        "G62": v.inert("path"),
        "G64": v.inert("path", act="blend"),
        "G63": v.barrier("path", v.SYNCHRONISED),
        "G9": v.at_end("non-modal"),
        "G8": v.inert("non-modal", "P", act="look-ahead"),
        "G5": v.inert("non-modal", "PQR", act="look-ahead"),
        "G5.1": v.inert("non-modal", "PQR", act="look-ahead"),
        **{code: v.inert("retract") for code in ("G98", "G99")},
        "G97": v.inert("spindle-mode", act="rpm"),
        "G96": v.inert("spindle-mode", "SP"),
        **{code: v.inert("cancel", act="cancel") for code in ("G67", "G13.1", "G23")},
        "G22": v.inert("stroke", "XYZIJK", "XYZIJK"),
        "G10": v.frame("non-modal", "set-work", v.AXES + "LPRQIJK"),
        "G52": v.frame("non-modal", "local", v.AXES),
        "G92": v.frame("non-modal", "preset", v.AXES),
        **{code: v.barrier("non-modal", v.SHIFT, "LPRQ") for code in ("G10.6", "G11", "G92.1")},
        "G28": v.frame("non-modal", "home"),
        "G53": v.frame("non-modal", "machine"),
        **{code: v.barrier("non-modal", v.HOME, "PR") for code in ("G27", "G29", "G60")},
        "G30": v.frame("non-modal", "home", "P"),
        "G54.1": v.frame("frame", "work", "P"),
        **{code: v.barrier("frame", v.SHIFT, "P") for code in ("G54.2", "G54.4")},
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        "G43": v.frame("tool-length", "length", "H"),
        "G44": v.frame("tool-length", "length-negative", "H"),
        "G43.1": v.barrier("tool-length", v.LENGTH, "HIJK"),
        **{code: v.barrier("tool-length", v.FOLLOWING, "HIJK") for code in ("G43.4", "G43.5")},
        "G15": v.frame("polar", "no-polar"),
        "G16": v.frame("polar", "polar"),
        "G50": v.frame("scaling", "no-scale"),
        "G51": v.frame("scaling", "scale", v.AXES + "PIJK"),
        "G50.1": v.frame("mirror", "no-mirror", v.AXES),
        "G51.1": v.frame("mirror", "mirror", v.AXES),
        "G68": v.frame("rotation", "rotate", v.AXES + "RIJK"),
        "G69": v.frame("rotation", "no-rotate"),
        **{
            code: v.barrier("transform", v.TRANSFORM, "PRIJKQ")
            for code in ("G68.2", "G68.3", "G68.4", "G53.1")
        },
        **{
            code: v.barrier("transform", v.TRANSFORM, "PRIJKQ")
            for code in ("G7.1", "G12.1", "G107", "G112")
        },
        **{f"G{number}": gx.Code("cycle") for number in CYCLES},
        **{code: v.barrier("motion", v.SYNCHRONISED, "PQR") for code in ("G33", "G34")},
        **{code: v.barrier("motion", "it cuts a spline", "PRK") for code in ("G6.2",)},
        **{code: v.barrier("motion", "it cuts a spiral", "IJKRLPQ") for code in ("G2.2", "G3.2")},
        "G31": v.frame("non-modal", "probe", "PQ"),
        **{code: v.measures("ABCDEFHIJKLPQRSTUVWXYZ") for code in ("G36", "G37")},
        "G65": v.call("macro", "ABCDEFHIJKLMPQRSTUVW"),
        **{code: v.barrier("macro", v.CALL, "ABCDEFHIJKLMPQRSTUVW") for code in ("G66", "G66.1")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        5: gx.MCode("spindle", after=True),
        9: gx.MCode("coolant", after=True),
        6: gx.MCode("tool", loses_position=True, takes="PQ"),
        **{code: gx.MCode("override") for code in (48, 49)},
        19: gx.MCode("spindle"),
        29: gx.MCode("tapping"),
        **{code: gx.MCode("stop", after=True, barrier=v.CALL, takes="PL") for code in (98, 198)},
        99: gx.MCode("stop", after=True, ends=True, takes="P"),
    }
    chosen: ClassVar[Mapping[str, str]] = {
        "G43": "a tool length is along Z (parameter 5001)",
        "G44": "a tool length is along Z (parameter 5001)",
        "M29": "M29 makes the next tap rigid and moves nothing (parameter 5210)",
    }
    program_rule = gx.ProgramRule(has_title=True, unit_is_set=True)
    text_rule = gx.TextRule(lower_case=False, asides=True, acts_anywhere="%")
    block_rule = gx.BlockRule(
        last_code_wins=True,
        mill=True,
        m_order_chosen=True,
        unknown_m=gx.MCode("user", loses_position=True, takes="PQ"),
    )
    flow_rule = gx.FlowRule(
        "macro-b",
        v.with_logic(v.MACRO_B),
        macro_levels=4,
        lookup=FILES,
        null_compare="distinct",
        words_first=True,
    )
    point_rule = gx.PointRule(required=True, dwell={"X": 1.0, "U": 1.0, "P": 0.001})
    feed_rule = gx.FeedRule(change_clears=True)
    motion_rule = gx.MotionRule(g53_is_rapid=True, corners="CR", m_over_hole=True)
    arc_rule = gx.ArcRule(absolute=0.01)
    cutter_comp = gx.CutterComp(stored=True)
    offset_rule = gx.OffsetRule(g10_l20="G54.1", g10_tools=TOOL_TABLE, g10_p0="all")
    tool_rule = gx.ToolRule(length_may_move=True, h_stays=True)
    tip_rule = gx.TipRule(
        codes={"G43.4": "G43"},
        vector_codes={"G43.5": "G43"},
        unfollowed={**dict.fromkeys(("G68.2", "G68.3", "G68.4", "G53.1"), "plane"), "G43.4": "tip"},
        planes={"G68.2": "define-plane", "G53.1": "orient", "G43.4": "follow-tip"},
    )
    cycle_rule: ClassVar[v.CycleRule] = CYCLE_RULE
