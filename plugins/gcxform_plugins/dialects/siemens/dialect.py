"""SINUMERIK 840D sl and SINUMERIK ONE, milling, in its own language (G290).

Programs of words are written for it (`lines.py`), holes as CYCLE81 and CYCLE82 behind MCALL where
their moves are the same and D says a length (`gathering.py`). From itself it is written by passes
that keep positions: lines that are not changed keep their bytes, and what is refused below is then
kept as it stands, with all that is lost behind it.

| what | SINUMERIK | known from |
|---|---|---|
| `X10`, `X=10` | the same; names of more than one letter and numbers need the `=` | PM 52 |
| `X1=`, `S1=`, `M2=` | another axis or spindle: refused | |
| `X=AC()`, `X=IC()` | absolute, incremental, for this word, whatever G90 and G91 say | 808D 53 |
| both kinds in a block | steps become absolute; refused where the axis may stand anywhere | |
| `I J K` | from the start, also in G90; `I=AC()` is the centre itself | 808D 53 |
| `A10`, `C370` | to the number; MD30455 may take modulo axes the shorter way | R2 225 |
| `C=DC()` | the shorter way to an angle of 0 to 360; half a turn is refused | [K] |
| `C=ACP()`, `C=ACN()` | up, down; to where the axis stands already: refused | [K] |
| that, from an unknown angle | a rapid goes to the number as written; a cut is refused | |
| plain words behind that | refused while whole turns lie between both numbers | |
| steps behind G54, D, M6, SUPA | SD42440 or SD42442 adds the difference, or not: refused | [K] |
| motion at start | MD20150: refused, but for `[control] motion-at-start` = G0 or G1 | PM 1262 |
| `CR=` | positive for the arc up to half a turn, negative for the longer | OM 579 |
| `AR=` | the opening angle, beside the end or the centre | PM 204 |
| `TURN=n` | n full turns before the arc; of a full circle: refused | PM 205 |
| G110, G111, G112 | the pole, from the last place, from zero, from the pole; else zero | F 118 |
| `AP=`, `RP=` | angle, radius; the pole is the centre of arcs; in G91: refused | 808D 55 |
| `AP=IC()` | on from the last angle about this pole; `RP=IC()`: refused | PM 175 |
| `ANG=` | the angle of a line, beside one coordinate, or two lines up to where they meet | PM 220 |
| `CIP` | an arc over a point; refused in G91, and outside of the plane in force | T 91 |
| `CT` | the arc along the element before it, a line or an arc in the plane | PM 201 |
| `RND=`, `RNDM=` | an arc that touches both lines at the corner to which the line leads | F 194 |
| `CHR=`, `CHF=` | a chamfer: so far along both lines; itself so long | F 194 |
| at arcs, G0, other lines than of plain words | refused | |
| F in the line behind a corner | whose feed it has is a setting: refused, but for FRC= | [K] |
| start and end radius | may differ by 0.01 mm (MD21000) | [K] |
| `G4 F` | seconds, in a block of its own; `G4 S`: refused | [K] |
| G54 to G57, G505 to G599 | work offsets, by number those of other controls: G505 is G58 | [K] |
| G500 | leaves basic frames in force, which only the control knows: moves are refused | K2 741 |
| G53 | so does this: refused, but for `[control] basic-frames = "none"`, where it is SUPA | K2 |
| SUPA, G153 | in machine coordinates; Z only with D0: a tool length may stay | ISO 3-42 |
| SUPA in a frame that turns | where X, Y and Z are in it is not known then | |
| other words beside TRANS, G111, G4, a cycle | refused | |
| TRANS, ROT, SCALE, MIRROR | a new programmable frame, in place of the one before | 808D 56 |
| ATRANS, AROT, ASCALE, AMIRROR | in the frame that is in force: on its right | PM 631, K2 2-67 |
| ROT X Y Z, RPL= | about Z, new Y, new X (RPY); about the axis across the plane | PM 309 |
| behind them | nothing moves; steps are refused until their axis has been told (SD42440) | K2 1-7 |
| arcs in frames that tilt, or do not grow axes alike | refused | |
| ROTS X Y | X stays in the plane of X and Z; the plane falls along X and Y | K2 775 |
| other ROTS, G58, G59, ROT of 90 or more about Y | refused | |
| G710, G700 | mm, inches, also of feeds | 828D 341 |
| G71 | `units` in `[input]`, mm unless said, is the unit of feeds; G70: refused | 828D 341 |
| another feed mode | F has to be programmed again | |
| `T5`, M6, `D1` | the tool is chosen, changed, its length in force: `T5 M6`, `G43 H5` | W1 13 |
| `D0` | no length: `G49`; D2 and more: refused | W1 13 |
| D1 of a tool that nobody knows | Z is refused, until D is said of another one | W1 13 |
| D between T and M6 | behind M6 as the machine file says, or refused | W1 13 |
| D1 in G18, G19 | along Y, X: refused without `[control] tool-length-axis = "Z"` (SD42940) | [K] |
| Z between M6 and D | refused, but for `[control] edge-after-tool-change` = 0 or 1 | W1 13 |
| those of X and Y | read, in G17: length 1 is along Z; steps behind D as well | W1 13 |
| T without M6 | MD22550: refused, but for `[control] tool-change-by` = T or M6 | W1 33 |
| `T="NAME"` | the tool that the machine file calls so; to the same control any goes along | |
| G41, G42 | the radius of the tool of D1; settings decide how contours are met | W1 13 |
| `TRAORI`, `TRAORI(1)`, `TRAFOOF` | X Y Z are those of the tip; the work offset stays | TR 172 |
| those, in `volumetric` | stay, and tips are corrected: `passes/volumetric/followed.py` | |
| other transformations, other arguments | refused | |
| cuts that turn axes then | angles in proportion, or the tool axis on a great circle | PM 674 |
| ORIAXES | in proportion, but with ORIWKS behind which MD21104 decides | PM 674, 1262 |
| ORIVECT, ORIPLANE, ORIMKS, ORIWKS, none | cuts that turn axes: refused | PM 674 |
| `[control] orientation-path = "angles"` | in proportion unless ORIVECT or ORIPLANE is in force | |
| `A3= B3= C3=`, `A2=`, LEAD, TILT | refused | |
| G450, G451 | outside corners by arcs, by lines that meet; `cutter-comp` says the same | W1 |
| KONT | refused with G41 and G42: the way to the contour may be another one | [K] |
| G60, G9 | exact stops | [K] |
| G64, G641 to G645 | corners are rounded: G64, however far | [K] |
| G601 to G603, ADIS | how far: left out | [K] |
| SOFT, BRISK, FFWON, COMPCAD, DYNFINISH ... | how fast, and how smooth: left out | [K] |
| CYCLE832 | left out, with names as `_FINISH`, and with digits | PM 1108 |
| that with two values, and a ten | older cycles switch TRAORI: refused | [K] |
| GROUP_BEGIN, GROUP_END, WORKPIECE | left out: they are for the screen | |
| M40 to M45 | left out: the gear of the spindle | PM 105 |
| all four, where moves are written anew for the same control | they go along | |
| FGROUP(X,Y,Z), FGROUP() | what F is of anyway: left out, or goes along; others: refused | F 105 |
| M7 M8 in one block | both are on: two blocks | [K] |
| CYCLE800 | only alone; empty, or without angles, with two rotary axes at 0 | SW 481 |
| CYCLE800 with angles, on a table | a plane, by _MODE of three turns: `swivelling.py` | SW 481 |
| its _DIR | by the value of `[control] swivel-reference`, or the one attitude in limits | SW 481 |
| its _ST, other than 0 and 10; solid and projected angles; in a frame | refused | [K] |
| its _FR other than 0, its _ST of 10 | X, Y, Z are lost; refused where the call goes | SW 481 |
| CYCLE800() behind turned axes | they are lost: it is up to the builder if they turn back | [K] |
| CYCLE81, CYCLE82 | rapid to RFP + SDIS, feed to DP, dwell, rapid to RTP | C81 |
| GMODE, DMODE, AMODE | 0; the plane in force; absolute, seconds; else refused | X |
| CYCLE89, CYCLE85 | out at the feed, at RFF; behind CYCLE85 F must be programmed again | C81 |
| CYCLE83 | alike strokes; only with VARI, and DIS1 or VRT, and without DAM | C81 |
| SPOS=0, G331, G332, M3 S in four lines | a tap in step with the spindle: `tapping.py` | cncforum |
| MCALL | that behind each line with axis words | C81 |
| HOLES1 under MCALL | from the first on, where the tool is nearer to that; else refused | [K] |
| HOLES2 under MCALL | holes on a circle, in the order of their numbers, by lines | OM 286 |
| DP, DPR | absolute, or below RFP; both: refused; other cycles: refused | C81 |
| CYCLE81(R1, ...), and their like | by what their arguments are worth | |
| R parameters | not known until they are set; a block sets several, left to right | [K] |
| DEF of INT REAL BOOL CHAR STRING, arrays | 0 or empty, from 0, last index first | JP 54 |
| `SET(1, , 3)`, `REP(2)`, `REP(2, 3)` | a gap stays; to the end, or three elements | [K] |
| REAL to INT | as ROUND: halves up; negative halves are refused | JP 54 |
| priorities | of PM 444: comparisons bind last, behind AND, XOR and OR | PM 444 |
| `==`, `>` ... | to 1e-12 of the values; what differs by less has no order (MD10280) | JA 1-23 |
| AND beside comparisons, no brackets | refused where the usual reading differs | PM 444 |
| DIV, TRUNC, ROUNDUP | cut, cut, up also below zero | PM 443, JA 1-70 |
| MOD | of positive whole numbers; others are refused | [K] |
| STRLEN SUBSTR INDEX RINDEX NUMBER ISNUMBER TOUPPER TOLOWER | from 0; -1: not there | JP 74 |
| `<<` | joins texts and numbers; of BOOL and CHAR: refused | JP 74 |
| IF ELSE, WHILE, REPEAT UNTIL, LOOP | as structures, up to the line that ends them | PM |
| FOR | up by one; its variable is lost behind it | [K] |
| GOTOF GOTOB GOTO GOTOC, labels, N numbers | the nearest in the direction | PM |
| CASE OF DEFAULT | by whole numbers, others are refused; on without a DEFAULT | PM |
| a variable set and read in a word of one block | refused | [K] |
| MCALL, and a subprogram | refused, but for `[control] mcall-in-subprograms = "acts"` | [K] |
| REPEAT of a label before it | by `[control] section-repeats`, what P counts | [K] |
| REPEAT of two labels, REPEATB, ENDLABEL, GOTOS, RET with a label | refused | [K] |
| `$AA_IW[X]`, `$P_EP[X]` | where X stands; the first only behind STOPRE | [K] |
| other `$` variables, names that nothing defines | only the control knows them | |
| R parameters and such names in `parameters` of `[input]` | what the user says, until set | |
| `M=QU(8)` | M8, for which nothing waits | [K] |
| these set, in a line that does nothing else | it stays; none of X Y Z A B C moves | [K] |
| `$TC_...=`, `$P_UIFR[...]=` | data of tools lose X, Y, Z; zeros lose all axes | W1 13, K2 741 |
| SETAL, SETMS, FGROUP, ACC[], FA[] | tell, or say how fast: they move nothing | PM |
| PROC, what nobody calls | its parameters are not known; not written anew | |
| RET, what nobody calls | ends the program; written for others or anew: refused, as M17 is | |
| `NAME(...)`, `L10 P2` | `NAME.SPF`, `.MPF` beside the program; VAR is the caller's own | PM |
| `%_N_NAME_MPF` | begins a program; calls find the others of the file; two MPF: refused | PM 43 |
| what is left out of a call | its default in PROC, or 0 | PM |
| CALL "NAME", CALL of a variable, PCALL, EXTCALL | by the last part of the name | JP |
| SAVE | motion, G90 and the frame as before; refused where other modes differ | K2 2-108 |
| MCALL of one, RET with a label, M30 in one, calls of itself | refused | |
| subprograms that are not there, synchronous actions, DEFINE | refused | |
| other M codes | of the machine: refused, but for `inert-m`; for a SINUMERIK they stay | |
| M128, M129 | M codes of the machine: refused, as blocks say TRAORI with them | |
| `/`, `/0` to `/9` | a switch decides: `block-delete` in `[input]` | [K] |
| `MSG("..."<<R1)` | a comment; of unknown values: left out | PM |
| G291 | ISO dialects: refused | PM |

Manuals of Siemens: JA and JP Job planning 03/2006 and 07/2010, PM NC programming 12/2019
(6FC5398-2EP40-0BA0), F Fundamentals 11/2006, 808D Programming 01/2014 (6FC5398-4DP10-0BA1), OM
Operating 05/2017, T Turning 01/2017, K2 Frames and 828D Basic functions 09/2011, ISO Milling
04/2007, W1 Tool offset 11/2006, TR Transformations 06/2019 (A5E47435470B), R2 Axes and spindles
06/2019 (A5E47437747B), SW Swivelling 03/2013; C81 helmancnc.com on CYCLE81; cncforum.net on
G331; X the public specification of NCXchange for Siemens. [K]: not looked up.

To the same control, by passes that keep positions, a line stays that cannot be said in blocks:

| what stays | what is lost behind it |
|---|---|
| a line of words, with values that only the control knows | the axes that it names, and its F |
| CT, ASPLINE, BSPLINE, CSPLINE, POLY, INVCW, INVCCW | those that words name until another motion |
| RND, RNDM, CHF, CHR, TURN, AP, RP, ANG in a line | those that it names; by polar words X Y Z |
| SPOS | A, B, C: the spindle may be one of them |
| POCKET, SLOT, LONGHOLE, CYCLE60 to 64, 70 to 79, 802, 899 | X, Y, Z, and the feed |
| TRANS, ROT ... ATRANS, AROT ..., G53, SUPA, G500, TRAORI, CYCLE800 | all axes |
| DIAMON, DIAM90 | all axes, and all that follows stays: steps may be radii |
| CYCLE81 to 89, 84, 840, HOLES1, HOLES2, CYCLE801 as they are not read | X, Y, Z |
| what may not be executed: IF, WHILE, CASE, what a jump leads over | what it sets, and moves |
| what may be executed again | as well; its lines stay |
| other calls, M codes of the machine, synchronous actions, SETINT | all, modes too |

By passes that change positions (`volumetric`, `cutter-comp`) of these only such lines stay:

| what stays | what is known behind it |
|---|---|
| CYCLE84, 840, 86, 87, 88, and 81 to 89 as they are not read; with MCALL too | it ends at RTP |
| the feed behind 81, 82, 83 with FRF of 1, 87, 88, 89 | that before them |
| those, behind a rapid that no pass corrects (Z is not known) | refused |
| those, deep enough to lean by more than `lean`; AMODE of ones other than 0 and 2 | refused |
| POCKET, SLOT, LONGHOLE, CYCLE60 to 64, 70 to 79, 802, 899 | X, Y and F are lost, or Z as well |
| those, where positions are compensated: their own ways would not be | refused |
| AXN, a contour of labels or numbers of the program, a frame that tilts | refused |
| any of them in a frame, where the program is written anew | refused: frames are gone there |
| SETAL, SETMS, M2=3, S2=, STARTFIFO, DISPLOF, SBLOF | all |
| FL[X]=, ACC[X]=, LIMS=, G25, G26 | all; they stand in their place alone |
| SPOS | A, B and C are lost: the spindle may be one of them |
| G74, G75 | the axes that they name are lost; under TRAORI, MCALL, G41: refused |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.programs import Programs


class Siemens(gx.Dialect):
    """SINUMERIK 840D sl and ONE, milling, in its own language."""

    name = "siemens"
    translator = Programs
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G95": gx.Code("feed-mode"),
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        "G33.1": gx.Code("motion"),
        "G43": v.frame("tool-length", "length", "H"),
        "G53": v.frame("non-modal", "machine"),
        "G54.1": v.frame("frame", "work", "P"),
        **{code: v.barrier("transform", v.TRANSFORM, "PIJK") for code in ("G68.2", "G53.1")},
        "G69": v.frame("rotation", "no-rotate"),
        "G65.1": v.bores("XYZ"),
        "G65.2": v.cuts("XYZ", ends="at XYZ"),
        "G9": v.at_end("non-modal"),
        "G60": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G450": v.inert("corners", act="arc-corners"),
        "G451": v.inert("corners", act="linear-corners"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True, act="change-tool"),
        128: gx.MCode("tip", barrier=v.FOLLOWING),
        129: gx.MCode("tip"),
        17: gx.MCode("stop", after=True, ends=True),
        9001: gx.MCode("along"),
        9000: gx.MCode("kept", takes="P"),
    }
    differs: ClassVar[Mapping[str, str]] = {
        "M17": "returns from a subprogram, and ends a program as M30 does (PM p. 45)"
    }
    chosen: ClassVar[Mapping[str, str]] = dict.fromkeys(
        "ABC", "rotary axes go where they are told, whichever way is shorter (MD30455)"
    )
    flow_rule = gx.FlowRule(
        lookup=gx.LookupRule(names=("{name}",), endings=(".SPF", ".MPF"), any_case=True)
    )
    settings = (
        gx.Setting("basic-frames", "siemens: what G53 and G500 leave in force", ("none",)),
        gx.Setting("motion-at-start", "siemens: motion before any code (MD20150)", ("G0", "G1")),
        gx.Setting("tool-change-by", "siemens: what changes a tool (MD22550)", ("T", "M6")),
        gx.Setting("edge-after-tool-change", "siemens: D behind M6 (MD20270)", (0, 1)),
        gx.Setting("mcall-in-subprograms", "siemens: MCALL drills in subprograms", ("acts",)),
        gx.Setting("section-repeats", "siemens: what P of REPEAT counts", ("further", "in-all")),
        gx.Setting("swivel-reference", "siemens: axis that _DIR of CYCLE800 is about", (*"ABC",)),
        gx.Setting("orientation-path", "siemens: how angles change in TRAORI", ("angles",)),
    )
    block_rule = gx.BlockRule(m_order_chosen=True, unknown_m=gx.MCode("user", loses_position=True))
    feed_rule = gx.FeedRule(change_clears=True)
    arc_rule = gx.ArcRule(turns="P")
    tip_rule = gx.TipRule(
        switches={"tip-on": "M128", "tip-off": "M129"},
        spelled={"M128": "TRAORI", "M129": "TRAFOOF"},
        planes={"G68.2": "define-plane", "G53.1": "swivel"},
    )
