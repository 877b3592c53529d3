"""LinuxCNC (RS274/NGC), as its stand-alone interpreter `rs274` 2.9 executes programs.

| what | LinuxCNC |
|---|---|
| motion at start | none: an axis word before any motion code is refused |
| two codes of a group, a word twice | refused |
| arc centre | incremental, or absolute (in work coordinates) after G90.1 |
| full circle | end repeated, or plane words left out |
| turns of an arc | P n: n - 1 full turns more |
| start and end radius | may differ by 0.0282843 mm, or by 0.1 % and 2.82843 mm |
| the same in G20 | 0.00282843 in, or 0.1 % and 0.282843 in |
| G1, G2, G3 alone | executed: refused without a feed, arcs without words (`rs274`) |
| G93, G94, G95 | set the feed to zero, also when re-stated |
| feed | along X Y Z; in degrees where only rotary axes move; in G93 no less than 0.1 per minute |
| `G20 F10` | F is in the unit before; after G20, G21 the feed in mm/min stays |
| CR without LF | is a blank |
| M5, M9 | act before the motion of their block |
| after M2, M30 | nothing is executed |
| a file without end | refused (`gcxform check` says so), but if it stands between two % signs |
| G41 D, G42 D | tool D of the table, or the tool in the spindle; the table is the machine file's |
| G41.1 D, G42.1 D | the diameter itself; a negative one swaps the side |
| G41, G42 | refused when on already, and in YZ; on, many codes are refused |
| G40 | the next move is no arc |
| outside corners | are joined by arcs; turns below 0.05 rad are taken for none |
| tool change | the axes stay, as far as the interpreter knows |
| G98, G99 at start | G99 |
| canned cycles | R, Z, P, Q stay within one cycle; from below R first up; 0.254 mm between pecks |
| G74, G84 in G18, G19 | the axes of the feed moves are mixed up: refused |
| G70 to G72.2 | cut the contour of a subprogram: kept with it, places are lost behind |
| G76 | a thread in passes, with Z, P, I, J and K: copied; it ends at its Z |
| G5 | a cubic Bezier curve in G17: I J from its start, P Q from its end, also in G91 and G90.1 |
| G5 without I J | minus the P Q of the G5 before; with no G5 directly before: refused |
| G5.1 | a quadratic one: I J from its start |
| G5, G5.1 | refused: other planes, axes but X and Y, one of two words, neither X nor Y; in G93 |
| after G5, G5.1 | no motion code is in force |
| G5.2, G5.3 | a spline of weights and knots in G17 and G90: copied; lines for other controls |
| G33 | needs a turning spindle, an axis word and K in every block; F beside it is refused |
| G33.1 | to the end and back to the start; no rotary words |
| G38.2 to G38.5 | end at the target at the latest; the axes named then stand nowhere known |
| G96 | changes the speed of the spindle and no path |
| M70, M71, M73 | change nothing that a main program notices |
| M70 to M73 | executed: modes, F, S, spindle and coolant come back as plain words |
| M62 to M68, M66 | outputs and inputs: the axes stand still |
| assignments | take effect after their block: `#1=#2 #2=#1` swaps |
| expressions | a sign binds to its number, `**` goes from the left, numbers within 1e-4 are EQ |
| a parameter that nothing has set | refused unless given: the control may have a value left |
| #5001 and above, `#<_x>` and its like | belong to the control: refused, but for #5420 to #5428 |
| #5599 | switches (DEBUG,) on and off: may be set |
| M words in a block | four at most |
| T, M61 | a tool that is not in the table, where one is given, is refused |
| `$` | beside S or what turns a spindle; only the first spindle is known |
| M100 to M199 | run a program of the machine: refused, but for `user-codes` and `inert-m` |
| @ and ^ | polar words: become X and Y; in G7, G18, G19, and in G91 with L, refused |
| comments | `(MSG,` `(PRINT,` `(LOG,` `(PROBEOPEN` `(ABORT,` and their like are executed |
| O-words, M98 M99 | executed; what the interpreter gets wrong is refused |
| what they call | is found as the interpreter does, in files of small letters and .ngc too |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

BOTTOM, MIDDLE, CLEARANCE, RETRACT = v.Level

MIXED_UP = "LinuxCNC 2.9 mixes the axes up and feeds to another point"
BORE = (v.feed(BOTTOM), v.feed(CLEARANCE), v.rapid(RETRACT))
BORE_STOP = (v.feed(BOTTOM, v.DWELL, v.STOP), v.rapid(RETRACT, v.RESUME))
BORE_BACK = (
    v.rapid(CLEARANCE, v.STOP, v.ORIENT, shifted=True),
    v.rapid(BOTTOM, shifted=True),
    v.rapid(BOTTOM, v.RESUME),
    v.feed(MIDDLE),
    v.feed(BOTTOM, v.STOP, v.ORIENT),
    v.rapid(BOTTOM, shifted=True),
    v.rapid(RETRACT, shifted=True),
    v.rapid(RETRACT, v.RESUME),
)
BORE_HALT = (v.feed(BOTTOM, v.DWELL, v.STOP, v.HALT, v.RESUME),)
BORE_DWELL = (v.feed(BOTTOM, v.DWELL), v.feed(RETRACT))
TAP, TAP_LEFT = v.tap(v.FORWARD, v.REVERSE), v.tap(v.REVERSE, v.FORWARD)
CYCLES = {
    73: v.Cycle(v.DRILL, pecks="break", needs="Q", takes="QL"),
    74: v.Cycle(TAP_LEFT, takes="P", spindle=(-1,), xy_only=MIXED_UP),
    76: v.Cycle(refused="it is a thread"),
    81: v.Cycle(v.DRILL, takes="L"),
    82: v.Cycle(v.DRILL_DWELL, needs="P", takes="PL"),
    83: v.Cycle(v.DRILL, pecks="clear", needs="Q", takes="QL"),
    84: v.Cycle(TAP, takes="PL", spindle=(1,), xy_only=MIXED_UP),
    85: v.Cycle(BORE, takes="L"),
    86: v.Cycle(BORE_STOP, needs="P", takes="PL", spindle=(1, -1)),
    87: v.Cycle(BORE_BACK, needs="IJK", takes="IJKL", spindle=(1, -1)),
    88: v.Cycle(BORE_HALT, needs="P", takes="PL", spindle=(1, -1)),
    89: v.Cycle(BORE_DWELL, needs="P", takes="PL"),
}
CYCLE_RULE = v.CycleRule(
    CYCLES,
    peck_return=0.254,
    peck_clearance=0.254,
    rises_first=True,
    stays=v.Staying(dwell=True),
    one_plane=False,
    initial_level=False,
    taps_float=True,
)
FILES = gx.LookupRule(names=("{name}",), endings=(".ngc",))
USER_CODE = gx.MCode("user", takes="PQ", act="user-code", loses_position=True)
# fmt: off
ACTIVE = (
    "MSG,", "DEBUG,", "PRINT,", "LOG,", "LOGOPEN,", "LOGAPPEND,", "LOGCLOSE", "PROBEOPEN",
    "PROBECLOSE", "ABORT,", "PY,",
)
# fmt: on
TELLING = ("MSG,", "DEBUG,", "PRINT,", "LOG,", "LOGOPEN,", "LOGAPPEND,", "LOGCLOSE")


class LinuxCNC(gx.Dialect):
    """LinuxCNC 2.9, RS274/NGC."""

    name = "linuxcnc"
    grammar = ("gcxform_grammars", "linuxcnc")
    axes = "XYZABCUVW"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G95": gx.Code("feed-mode"),
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        **{code: v.frame("frame", "work") for code in ("G59.1", "G59.2", "G59.3")},
        "G61": v.inert("path", "PQ", "PQ", act="exact-path"),
        "G61.1": v.inert("path", "PQ", "PQ", act="exact-stop"),
        "G64": v.inert("path", "PQ", "PQ", act="blend"),
        **{code: v.inert("retract") for code in ("G98", "G99")},
        "G7": v.frame("diameter", "diameter"),
        "G8": v.frame("diameter", "diameter"),
        "G97": v.inert("spindle-mode", act="rpm"),
        "G96": v.inert("spindle-mode", "DS"),
        "G10": v.frame("non-modal", "set-work", v.AXES + "LPRIJQ"),
        "G52": v.frame("non-modal", "local", v.AXES),
        "G92": v.frame("non-modal", "preset", v.AXES),
        "G92.1": v.frame("non-modal", "preset-clear"),
        "G92.2": v.frame("non-modal", "preset-suspend"),
        "G92.3": v.frame("non-modal", "preset-restore"),
        **{code: v.frame("non-modal", "home") for code in ("G28", "G30")},
        **{code: v.frame("non-modal", "store-home") for code in ("G28.1", "G30.1")},
        "G53": v.frame("non-modal", "machine"),
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")},
        **{code: gx.Code("cutter-comp", takes="D", lengths="D") for code in ("G41.1", "G42.1")},
        "G43": v.frame("tool-length", "length", "H"),
        "G43.1": v.frame("tool-length", "length-vector", v.AXES),
        "G43.2": v.frame("tool-length", "length-add", "H"),
        **{code: gx.Code("motion") for code in ("G5", "G5.1", "G5.2", "G5.3")},
        **{f"G{number}": gx.Code("motion") for number in CYCLES if number != 76},
        "G76": gx.Code("motion", takes="EH"),
        **{code: gx.Code("motion") for code in ("G33", "G33.1")},
        **{code: gx.Code("motion") for code in ("G38.2", "G38.3", "G38.4", "G38.5")},
        **{
            code: v.cuts("XZDEIKPQR", "motion")
            for code in ("G70", "G71", "G71.1", "G71.2", "G72", "G72.1", "G72.2")
        },
        **{
            code: v.barrier("plane", "its plane has no arcs")
            for code in ("G17.1", "G18.1", "G19.1")
        },
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", act="change-tool"),
        60: gx.MCode("stop", after=True),
        19: gx.MCode("spindle", takes="RPQ"),
        61: gx.MCode("tool", takes="Q", act="set-tool"),
        **{code: gx.MCode("override", takes="P") for code in (48, 49, 50, 51, 52, 53)},
        **{code: gx.MCode("output", takes="PQELR") for code in (62, 63, 64, 65, 66, 67, 68)},
        **{code: gx.MCode("modal-store") for code in (70, 71, 73)},
        72: gx.MCode("modal-store", barrier="it restores modes that were stored before"),
        98: gx.MCode("stop", barrier=v.CALL, takes="PL"),
        99: gx.MCode("stop", barrier=v.CALL),
        **{code: USER_CODE for code in range(100, 200)},
    }
    chosen: ClassVar[Mapping[str, str]] = {
        "M6": "a tool change leaves the axes where they are (no TOOL_CHANGE_POSITION)"
    }
    program_rule = gx.ProgramRule(spindle_stands=True, needs_end=True)
    text_rule = gx.TextRule(
        lone_cr_is_blank=True,
        line_length=252,
        comments="(;",
        active_comments=ACTIVE,
        telling_comments=TELLING,
    )
    block_rule = gx.BlockRule(
        words="DEFHIJKLNPQRST@^$",
        number_first=True,
        one_action="axes",
        most_m_words=4,
        m_first=True,
        spindle_words=frozenset({"S", "M3", "M4", "M5", "M19", "M51", "G95", "G96", "G97"}),
    )
    flow_rule = gx.FlowRule("o-words", v.RS274, lookup=FILES)
    numbers = gx.NumberFormat(mm=4, inch=5, angle=4)
    feed_rule = gx.FeedRule(
        mode_clears=True,
        before_units=True,
        of_linear_axes=True,
        along_lines=True,
        least_inverse_rate=0.1,
        turns_need_speed=True,
    )
    motion_rule = gx.MotionRule(
        lone_codes_count=True, g28_without_axes=True, rounds_corners=True, cycles_stop=True
    )
    arc_rule = gx.ArcRule(
        absolute=0.0282843,
        relative=0.001,
        largest=2.82843,
        smallest=0.00127,
        r_short=0.00127,
        in_inch=2.54,
        turns="P",
    )
    cutter_comp = gx.CutterComp(
        planes=frozenset({"XY", "ZX"}),
        changes=False,
        arc_entry=True,
        corners="arc",
        entry="own",
        straight=0.05,
        before=frozenset({"tool", "override", "output"}),
        after=frozenset({"non-modal", "tool-length", "frame", "path", "retract"}),
    )
    offset_rule = gx.OffsetRule(
        known_at_start=True,
        g10_offsets=(*gx.Dialect.offset_rule.g10_offsets, "G59.1", "G59.2", "G59.3"),
        g10_tools=frozenset((1, 10, 11)),
        g10_p0="active",
        g10_l20="here",
        g10_ignores_g91=True,
        g10_rotates=True,
        g52_is_g92=True,
    )
    tool_rule = gx.ToolRule(
        in_table=True, lengths_aside=True, g43_takes_spindle_tool=True, units_spoil_length=True
    )
    cycle_rule = CYCLE_RULE
