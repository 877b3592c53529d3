"""Fagor CNC 8065 and 8070, mill (`blocks.py` makes blocks of it).

It is written from itself: lines that are not changed keep their bytes. By passes that keep
positions what is refused below is kept as it stands, with all that is lost behind it; by others it
is refused (`in_place.py`).

Sources: [M] programming manual of the 8070, Ref. 1709, by page; [V02] that of its software V02.0x;
[Q] quick reference of the 8065; [55] programming manual of the 8055 M, V02.2x; [post] the open
post-processor of Autodesk for DMS routers with a Fagor; [8070] the control service of the 4DIAC
runtime for the 8070; [stone] the open CAM of a bridge saw with a Fagor; [isg]
infosys.beckhoff.com, TF5200, of a control whose words are near; [doc] public tables of the manuals
of 8055 and 8065; [K] not looked up. What no source says is refused.

| what | Fagor 8065 |
|---|---|
| motion at start | a parameter decides: an axis word before any motion code is refused |
| `X10I` | incremental whatever G90 says [doc]; `X10 I5` and `X10I5` have a centre |
| P1=, `P1 += 2`, XP1, X[P1*2] | computed [M 50]; a block that sets and reads one: refused |
| a parameter that nothing has set, V.A., V.G. | only the control knows it |
| V.P., V.S. | variables of the program [K] |
| SIN, COS, TAN, ASIN, ACOS, ATAN, ARG | in degrees; ARG from 0 to 360 [55 390] |
| INT, FRACT, FUP, ROUND, MOD | below zero, and of halves: refused |
| `-2**2`, EXP, LOG, operators of bits | refused |
| `[P1==1]*[P2>3]`, `+` | and, or [M 50]; values that are nearly the same: refused |
| $IF $ELSEIF $ELSE, $WHILE, $DO $ENDDO | structures [isg] |
| $FOR | its end: `[control] for-end`; its parameter is lost behind it |
| $SWITCH | a case that does not end with $BREAK: refused |
| $GOTO N10, $GOTO [NAME] | in the same program, and into no structure |
| `%L NAME` | a local subroutine, before the program [M 32, Q 45]; it ends with #RET, M17, M29 |
| LL NAME, L, #CALL | in this file, in one beside it, in either |
| P0 to P99 in them | `[control] subroutine-locals`: the caller's, or their own; by #PCALL own [K] |
| `X10I 5` | may be either: refused |
| `X10I Y5` | X counts from the last coordinates in the program, which must be there; else refused |
| `X=10` | the same as X10; names of more than a letter (`X1=10`) are refused |
| steps behind D, or another work offset | refused until their axis has been told | |
| arc centre | from the start; with G6 from the work zero: both words, for one block [doc] |
| arc centre, a word less | is 0 [doc] |
| full circle | end repeated, or left out; with R refused |
| helix | Z beside I and J; K beside them is a pitch: refused |
| start and end radius | may differ by 0.01 mm, the usual value of a parameter |
| R | an arc of less than half a circle, of more where it is negative |
| polar words R, Q | about the part zero, or G30 I J; read in G17 [M 68, V02 101] |
| G70, G71 behind G30 | where the pole is then is not known |
| Q420 | is Q60 [M 68]; in G91, and with an I, both count on from the last polar place |
| one of them left out | is that of the last move, which must have been a polar one [V02 101] |
| an arc with Q | about its I J, or about the pole; Q360 in G91 is a circle [V02 101] |
| `X30 Q45` | a line at an angle, to a coordinate [M 70]; with G2 and G3 refused |
| G73 Q I J, G73 | a turn about I J, or the part zero; none [V02 139]; of a turned one: refused |
| behind it | both axes of the plane are told first, by a line; so it is written, too |
| G8, G9 | tangent arc, arc through three points: refused |
| `G4 K2` | 2 seconds, alone in its block [post]; on an 8055 hundredths; other forms are refused |
| G5, G7, G50, G61 | how corners are taken: G64, G61, G64, G64 of the blocks; G60 for one block |
| G61 where corners are not rounded yet | refused: it may be for one block alone |
| G17, G18, G19 | planes; G20 gives the plane other axes: refused |
| D1 in G18, G19 | length across the plane: refused without `[control] tool-length-axis = "Z"` |
| G41, G42 | the radius of the tool of D1; how corners are gone round is the control's |
| G53 | cancels the work offset up to the next G54 to G59 [post]: a move there is refused |
| `#MCS ON`, `#MCS OFF` | lines to places of the machine, behind D0 and in G90; else refused |
| G54 to G59, `G159=1` to 6 | the same offsets: G159=1 is ORGT[1] [8070], and so is G54 [stone] |
| G71 | millimetres |
| G70 | inches, refused but for `[control] inch-feeds` = inches: no source says what F is |
| G81 Z I | a hole at each place: `drilling.py`; with K refused; other cycles refused [55 162] |
| G80, G98, G99 | end it; behind each hole the initial plane, the reference plane [55 162] |
| the same control, line by line | G81 and what is under it stay |
| the same control, other places | these change; with other levels the holes are written as moves |
| G92, G93, G96 | refused: another zero, a time in place of the feed, a speed that follows an axis |
| G10 to G14, G72 | mirror and scale: refused |
| G43, G44, G49 | are of the 8055: refused |
| tool change | `T5 M6`; it runs a program of the machine: where the axes stand is not known |
| tool length | `D1` is that of the tool in the spindle, whatever its number [post]; D0 is none |
| D1 with T0, or with no tool change before | refused |
| D2 and more | another edge of the tool: refused |
| no D behind M6 | which is in force is not certain: moves are refused up to a D |
| D between T and M6 | holds from M6 on; moves before M6 are refused |
| other M codes | of the machine: refused, but for `inert-m`; for a Fagor the line stays |
| T, M6, D beside a move | M6 and D: refused |
| `#RTCP ON`, `#RTCP OFF` | the control follows the tip, or not; other forms are refused |
| those, in `volumetric` | stay, and tips are corrected |
| `#KIN ID[1]` | chooses what is in the machine file; while following, or a second one: refused |
| `#TLC ON [2]` | a tool that is 2 longer than the program was made for [isg]: refused |
| `#CS`, `#ACS`, `#CSROT`, `#TOOL ORI`, `#SELECT ORI` | inclined planes: refused, but for OFF |
| `#TRAFO ON` | of ISG and Beckhoff; there D names a tool, and G8 and G9 are no arcs: refused |
| `#HSC`, `#ROUNDPAR`, `#SLOPE`, `#FLUSH`, `#MSG` | move nothing, and are left out |
| these and G50, where moves become others for a Fagor | they go along; G61 is refused |
| `[CONTERROR P1]` there | goes along with the value of P1, where lines are written out |
| the same control, other places: R Q | stay, or become X and Y; one word alone always does |
| P100 and more, V.S. there | set as before; only a program that is written whole sets none |
| `#TIME`, and all else behind `#` | refused |
| `;`, `( )`, `(` to the end of the line | comments |
| NR, #RPT, #MCALL, #EXEC | refused |
| `(IF`, `(CALL`, `(P1=3` | statements of an 8055: refused |
| `%name` | the name of the program, at its head; another program is refused |
| `[NAME]`, `N10:` | labels |
| `/` | a switch of the control decides; `/1` is refused |
| rotary axes | are taken to count on, and to go where they are told: no shortest way |
| after M2, M30 | nothing is executed |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fagor.in_place import InPlace


class Fagor(gx.Dialect):
    """Fagor 8065 and 8070, mill."""

    name = "fagor"
    axes = "XYZABCUVW"
    translator = InPlace
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G95": gx.Code("feed-mode"),
        "G97": v.inert("spindle-mode", act="rpm"),
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        "G61": v.inert("path", act="exact-path"),
        "G64": v.inert("path", act="blend"),
        "G43": v.frame("tool-length", "length", "H"),
        "G53": v.frame("non-modal", "machine"),
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        "G68": v.frame("rotation", "rotate", v.AXES + "R"),
        "G69": v.frame("rotation", "no-rotate"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", act="change-tool", loses_position=True),
        128: gx.MCode("tip", barrier=v.FOLLOWING),
        129: gx.MCode("tip"),
        9001: gx.MCode("along"),
        9000: gx.MCode("kept", takes="P"),
    }
    chosen: ClassVar[Mapping[str, str]] = dict.fromkeys(
        "ABC", "rotary axes go where they are told, whichever way is shorter"
    )
    flow_rule = gx.FlowRule(
        lookup=gx.LookupRule(names=("{name}",), endings=("", ".nc", ".fst"), any_case=True)
    )
    settings = (
        gx.Setting("for-end", "fagor: $FOR runs for its last value", ("included", "excluded")),
        gx.Setting("inch-feeds", "fagor: what F is behind G70", ("inches",)),
        gx.Setting("subroutine-locals", "fagor: P0 to P99 in LL, L, #CALL", ("shared", "own")),
    )
    program_rule = gx.ProgramRule(has_percent=False, has_program_number=False)
    block_rule = gx.BlockRule(
        words="DFHIJKNPQRST",
        m_order_chosen=True,
        unknown_m=gx.MCode("user", loses_position=True),
    )
    numbers = gx.NumberFormat(mm=4, inch=5, angle=4)
    feed_rule = gx.FeedRule(change_clears=True)
    arc_rule = gx.ArcRule(absolute=0.01)
    tip_rule = gx.TipRule(
        switches={"tip-on": "M128", "tip-off": "M129"},
        spelled={"M128": "#RTCP ON", "M129": "#RTCP OFF"},
    )
