"""HEIDENHAIN TNC 640 and iTNC 530 in Klartext.

Lines that are not changed keep their bytes. By passes that keep positions what is refused below is
kept as it stands, with all that is lost behind it; by others, words are changed where they stand.
Where a page of a manual is named, that is where it is said; [K] is known from practice only.

| what | TNC | said |
|---|---|---|
| F | stays in force; FMAX is for its block only, and F before it holds again | [K] |
| F in inches | tenths of an inch per minute; degrees where only rotary axes move | 640, p. 343 |
| FAUTO, and AUTO as Q206 or Q208 | the feed of the last TOOL CALL | [K] |
| MAX as Q208 | out in rapid | programs of a CAM |
| R, F, M without a number | nothing was entered; R beside a contour: refused | programs |
| `IX+5` | from where X stands; others in the block may be absolute | TNC 407, p. 5-44 |
| CC | `IX` from the last place of the tool, nothing: that place | TNC 360, p. 5-16 |
| C | about CC; the end may be 0.016 mm off; end as start: a full circle | TNC 320, p. 155 |
| CR | R below 0: more than half a turn | iTNC 530, p. 207 |
| DR+ | counter-clockwise, from X to Y | iTNC 530, p. 207 |
| CP | IPA is the whole angle, of many turns in a helix; its sign is that of DR | TNC 430, p. 153 |
| CP IPA there | as C there; no more than one turn; PA, helices: refused | programs of a CAM |
| polar angles | from +X towards +Y | TNC 310 Pilot, p. 8 |
| helices by C | refused: helices are polar only | TNC 430, p. 153 |
| CC and C in Z and X, or Y and Z | the circle is there, with any tool axis | iTNC 530, p. 222 |
| DR+ there | from Z towards X, from Y towards Z | TNC 310 Pilot, p. 8 |
| such circles by CR, CP, CT, with one coordinate, under RL or M128 | refused | |
| RL, RR | the contour, as G41 and G42: `cutter-comp` must be told corners and entry | 640, p. 201 |
| RL, RR, R0 | only in lines with X or Y; much is refused while on | 620 ISO, p. 154 |
| RND, CHF | between lines in X and Y, before any offset; F is their own | 620, p. 291 |
| CHF | its length is that along each line (a simulator of TNC 426) | |
| CT | from the direction in which the element before it ends | iTNC 530, p. 225 |
| CC behind RND, CHF, CT, CR | whether it holds is not known: write it again | |
| the first move in RL or RR, and R0 | end and begin square to the contour | 620 ISO, p. 146 |
| APPR, DEP | as `approach.py` says | TNC7 |
| FK | where its data have one solution, as `free.py` says; else refused | TNC 407, p. 5-66 |
| LN | refused | |
| M3 M4 M8 M13 M14 | at the start of their block | TNC 155, p. 15 |
| M0 M2 M5 M6 M9 M30 | at the end of their block; M0 stops the spindle | TNC 155, p. 15 |
| M91 | coordinates of the machine, without the tool length | TNC 426 B, p. 122 |
| M92 | as M91, from a point that [home.M92] of the machine file says | TNC 426 B, p. 122 |
| M94, M116, M140 MB 5, M144 and their like | refused | |
| M140 MB MAX | to the end of travel along Z, as a move in the machine: [home.M140] | [K] |
| M126 | shorter way on axes that show less than 360: from 180 refused, or unknown | 620, p. 566 |
| M128 | from the start of its block; its F limits other moves | TNC 410, p. 169 |
| M129 | from the end of its block | TNC 410, p. 169 |
| M91, TOOL CALL | are refused under M128, as the manual asks | 620, p. 340 |
| F TCP, AXIS POS | feed of the tip, angles of axes: as M128; F CONT, SPAT refused | 640, p. 400 |
| M128, M129, TCPM, to the same control | stay, and so does all behind AXIS SPAT or VECTOR | |
| tips behind them, in `volumetric` | are those of a machine with errors: `followed.py` there | |
| PATHCTRL AXIS | tip on a line, axes in proportion; VECTOR is refused | iTNC 530, p. 516 |
| TOOL CALL | tool, length, S, F; without number S and F only | [K] |
| TOOL CALL "NAME" | the tool that the machine file calls so; to a TNC any goes along | |
| its DL, DR | added to length and radius, which must be known; DR2: refused | iTNC 530, p. 183 |
| DL and DR to a TNC | go along in TOOL CALL; a length that is not known stays so | |
| TOOL DEF | no move; must not contradict the machine file; a number alone is T | iTNC 530, p. 183 |
| tool 0 | has no length | 640, p. 170 |
| CALL LBL n REP k | k more runs; `REP 10/10` is how old programs count | [K] |
| CALL LBL n | to LBL 0; 8 deep | TNC 370, p. 6-9 |
| LBL 0 to which no call has led | passed over, which the certificate says | a simulator |
| END PGM | ends the program, as M2 and M30 do | [K] |
| that, behind a label that CALL LBL has led to | the same, if nothing stands between | a shop |
| cycle 7 | the zero is elsewhere, by axes; `IX` adds to its shift; tables: refused | TNC 426, 640 |
| TRANS DATUM | as cycle 7; not beside it | TNC7, D6 of the facts |
| cycle 10, TRANS ROTATION | X and Y are turned about the zero; `IROT` adds | TNC 320, p. 258 |
| cycle 8, TRANS MIRROR | axes are mirrored at it; RL, RR: refused | simulator of TNC 426 |
| an axis behind them | is where it is told to go next | TNC 320, p. 258 |
| both at once, another shift under them, scales but 1 | refused | |
| cycle 9 | a dwell in seconds | 640, p. 631 |
| cycle 32 | T is how far the path may be off, as G64 P; its other lines: nothing | 620, p. 276 |
| other M below 89 | of the builder: refused, but for `inert-m`; `absolute` keeps the line | |
| cycle 32 without T | the builder's tolerance, known to none: G61, no tolerance | klartext-portal |
| PLANE RESET STAY | cancels what is refused here | [K] |
| PLANE SPATIAL with angles of 0, STAY | the same where no axis is turned | [K] |
| these with TURN or MOVE | nothing where rotary axes are at 0; else, and MB: refused | 620 |
| an axis that turns under PLANE SPATIAL | refused: words allow for it | 530 technical, p. 761 |
| PLANE that tilts, on a table of the machine file | a plane: `tilting.py`, `planes.py` | 620 |
| its PROJECTED, RELATIV, AXIAL, and cycle 19; on a head; without a table | refused | |
| its attitude | that of SEQ; else the one in limits, or the nearer one if that is certain | TNC7 |
| STAY | X, Y and Z may not move before the axes stand as Q120 to Q122 say | 320, p. 258 |
| TURN | the rotary axes alone turn | 620, p. 556 |
| MOVE, MB | X, Y and Z are where only the machine knows | 620, p. 556 |
| TABLE ROT, COORD ROT | turn an axis that is free, or the words; without either: refused | TNC7 |
| X, Y and Z behind PLANE | are in the plane once they are told, X and Y together | 320, p. 258 |
| in a plane M91, M128, a preset, a shift, a rotation | refused; a shift may end there | |
| that, SCL 1, M115, M145 behind a kept line | kept: it may end what moved the zero | |
| cycle 247 | the preset that it names before the first move; another one later is refused, | [K] |
| | but where `[control] presets` lists both: each is the work offset in its place | |
| such another one, by `offsets` in the same language | refused: its cycle goes along | |
| the place of G54 beside it | refused, but where `[control] presets` lists its number | [K] |
| rotary axes behind that one | stand where they did: `start` counts from it as well | |
| cycle 1 | strokes from where the tool stands, to 0.6 mm before them in rapid | TNC 407, p. 8-4 |
| cycles 200, 205 | strokes as `holes.py` says; the feed behind a cycle must be programmed | [K] |
| holes of other controls, in mm | cycle 200 in one stroke, called by M99 | `drilling.py` |
| cycle 207 | a tap in step with the spindle, for which M3 or M4 is said | TNC 320, p. 238 |
| the spindle behind it | is not certain: to be said before anything cuts | [K] |
| cycles 201, 203, 240, 220, 221 | as `holes.py` says; several rows, Q301=0: refused | 640, p. 162 |
| PATTERN DEF POS, CYCL CALL PAT FMAX | the places in their order; from Q203 + Q204 only | 640 |
| other patterns, CYCL CALL POS, PAT with F | refused | |
| cycles 300 to 399 | of the builder: refused, but for `[control] inert-cycle` of that number | |
| other cycles | refused | |
| Q, QL, QR | known once the program has set them; Q100 to Q199 are the control's | 620, p. 285 |
| Q108 | the radius of the tool in the machine file, with DR | 530 49x-03, p. 612 |
| formulas | brackets, signs, functions, `^` to the right, products, sums | TNC7 |
| a function | takes the operand behind it: `SQ 10 - 3^3` is 73 | iTNC 530, p. 602 |
| `-3^2`, SGN 0, `%` below zero | refused | |
| FN 13, ANG | the angle from b to a, 0 to 360 | 640, p. 384 |
| FN 9 to 12 | jumps; values nearly equal (1e-9): refused; out of a call: a setting | 640, p. 294 |
| REP behind a jump out of it | refused | |
| FN 15, 16, 38 | a comment | |
| FN 18, 27, 28; texts, QS | what they set only the control knows | |
| FN 14, 17, 19, 20, 29 and others | refused | |
| Q200 to Q211 set behind cycle 200 | whether it then counts is not known: refused | |
| CALL PGM, SEL PGM | `NAME.H` beside the program; Q are the same there, QL its own | 640, p. 102 |
| a line without a number behind `~`, but of a cycle, a pattern or a formula | refused | |
| lines in brackets before BEGIN PGM | are none of the program | |
| a number of more than 20 characters | refused | |
| a file without END PGM, M2 or M30 | refused: it breaks off | |

By passes that change positions such lines stand as they do, and in no program that is written anew:

| what stands | what is known behind it |
|---|---|
| cycles 202, 204, 206, 209, 241; 200, 201, 203, 205, 240 if not read | Z, by Q203, Q200, Q204 |
| cycle 207 | the same, where a machine is compensated; else it is read |
| X and Y behind 202 and 204, which go beside the hole | are lost |
| those, behind a rapid that no pass corrects (Z is not known) | refused |
| those that lean by more than `lean`, at Q201, or below the part (204: Q250, Q252) | refused |
| FN 14, 19, 20, 26, 29, 37; FN 15, 16, 27, 38 of parameters; QR of many digits | all |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.heidenhain.in_place import InPlace


class Heidenhain(gx.Dialect):
    """HEIDENHAIN TNC 640 and iTNC 530, Klartext, mill."""

    name = "heidenhain"
    axes = "XYZABCUVW"
    translator = InPlace
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        **{code: gx.Code("cutter-comp", takes="D", lengths="D") for code in ("G41.1", "G42.1")},
        "G33.1": gx.Code("motion"),
        "G43": v.frame("tool-length", "length", "H"),
        "G43.1": v.frame("tool-length", "length-vector", v.AXES),
        **{code: v.barrier("transform", v.TRANSFORM, "PIJK") for code in ("G68.2", "G53.1")},
        "G50.1": v.frame("mirror", "no-mirror", v.AXES),
        "G51.1": v.frame("mirror", "mirror", v.AXES),
        "G52": v.frame("non-modal", "local", v.AXES),
        "G53": v.frame("non-modal", "machine"),
        "G65.1": v.bores("XYZ"),
        "G61": v.inert("path", act="exact-path"),  # what no T says: nearer than any tolerance
        "G64": v.inert("path", "P", "P", act="blend"),
        "G68": v.frame("rotation", "rotate", v.AXES + "RIJK"),
        "G69": v.frame("rotation", "no-rotate"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True),
        128: gx.MCode("tip", barrier=v.FOLLOWING),
        129: gx.MCode("tip"),
        9001: gx.MCode("along", takes="P"),
        9000: gx.MCode("kept", loses_position=True, takes="P"),
    }
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True))
    settings = (
        gx.NumbersSetting("presets", "heidenhain: those of cycle 247 that are G54, G55 ... here"),
        gx.Setting("label-jumps", "heidenhain: LBL 0 behind a jump out of a call", ("return",)),
        gx.NumberSetting("inert-cycle", "heidenhain: which of cycles 300 to 399 moves no axis"),
    )
    flow_rule = gx.FlowRule(lookup=gx.LookupRule(names=("{name}",), endings=(".H",), any_case=True))
    numbers = gx.NumberFormat(mm=4, inch=5, angle=4)
    cutter_comp = gx.CutterComp(entry="next")
    arc_rule = gx.ArcRule(absolute=0.016, turns="P")
    tip_rule = gx.TipRule(
        switches={"tip-on": "M128", "tip-off": "M129"},
        planes={"G68.2": "define-plane", "G53.1": "turn-to"},
        follows_at_start=False,  # a new program resets M128: TNC 410/426/430, ISO, p. 169
    )
