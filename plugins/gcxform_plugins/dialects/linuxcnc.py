"""LinuxCNC (RS274/NGC), as its stand-alone interpreter `rs274` 2.9 executes programs.

| what | LinuxCNC |
|---|---|
| motion at start | none: an axis word before any motion code is refused |
| two codes of a group, a word twice | refused |
| arc centre | incremental, or absolute (in work coordinates) after G90.1 |
| full circle | end repeated, or plane words left out |
| turns of an arc | P n: n - 1 full turns more |
| start and end radius | refused if they differ by more than 0.0282843 mm and 0.1 % |
| G93, G94, G95 | set the feed to zero, also when re-stated |
| `G20 F10` | F is in the unit before; after G20, G21 the feed in mm/min stays |
| CR without LF | is a blank |
| M5, M9 | act before the motion of their block |
| after M2, M30 | nothing is executed |
| G41 D, G42 D | tool D of the table, or the tool in the spindle; the table is the machine file's |
| G41.1 D, G42.1 D | the diameter itself; a negative one swaps the side |
| G41, G42 | refused when on already, and in YZ; on, many codes are refused |
| G40 | the next move is no arc |
| outside corners | are joined by arcs; turns below 0.05 rad are taken for none |
| tool change | the axes stay, as far as the interpreter knows |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

CYCLES = ("G73", "G74", "G76", "G81", "G82", "G83", "G84", "G85", "G86", "G87", "G88", "G89")


class LinuxCNC(gx.Dialect):
    """LinuxCNC 2.9, RS274/NGC."""

    name = "linuxcnc"
    grammar = ("gcxform_grammars", "linuxcnc")
    axes = "XYZABCUVW"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G95": gx.Code("feed-mode"),
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        **{code: gx.Code("frame") for code in ("G59.1", "G59.2", "G59.3")},
        **{code: v.inert("path", "PQ") for code in ("G61", "G61.1", "G64")},
        **{code: v.inert("retract") for code in ("G98", "G99")},
        "G8": v.inert("diameter"),
        "G97": v.inert("spindle-mode", "S"),
        "G96": v.barrier("spindle-mode", v.SYNCHRONISED, "DS"),
        "G7": v.barrier("diameter", v.TRANSFORM),
        **{
            code: v.barrier("non-modal", v.SHIFT, "LPR")
            for code in ("G10", "G52", "G92", "G92.1", "G92.2", "G92.3")
        },
        **{
            code: v.barrier("non-modal", v.HOME) for code in ("G28", "G28.1", "G30", "G30.1", "G53")
        },
        **{code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42", "G41.1", "G42.1")},
        **{code: v.barrier("tool-length", v.LENGTH, "H") for code in ("G43", "G43.2")},
        "G43.1": v.barrier("tool-length", v.LENGTH),
        **{code: v.barrier("motion", v.CYCLE, "EHIJKLPQR") for code in CYCLES},
        **{
            code: v.barrier("motion", "it cuts a spline", "IJKPQL")
            for code in ("G5", "G5.1", "G5.2", "G5.3")
        },
        **{code: v.barrier("motion", v.SYNCHRONISED, "K") for code in ("G33", "G33.1")},
        **{code: v.barrier("motion", v.PROBE) for code in ("G38.2", "G38.3", "G38.4", "G38.5")},
        **{
            code: v.barrier("motion", v.CYCLE, "DEIJKLPQR")
            for code in ("G70", "G71", "G71.1", "G71.2", "G72", "G72.1", "G72.2")
        },
        **{
            code: v.barrier("plane", "its plane has no arcs")
            for code in ("G17.1", "G18.1", "G19.1")
        },
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        60: gx.MCode("stop", after=True),
        19: gx.MCode("spindle", takes="RPQ"),
        61: gx.MCode("tool", takes="Q"),
        **{code: gx.MCode("override", takes="P") for code in (48, 49, 50, 51, 52, 53)},
        **{code: gx.MCode("output", takes="PQELR") for code in (62, 63, 64, 65, 66, 67, 68)},
        **{code: gx.MCode("modal-store") for code in (71,)},
        **{
            code: gx.MCode("modal-store", barrier="it restores modes that were stored before")
            for code in (70, 72, 73)
        },
        98: gx.MCode("stop", barrier=v.CALL, takes="PL"),
        99: gx.MCode("stop", barrier=v.CALL),
        **{code: gx.MCode("user", takes="PQ") for code in range(100, 200)},
    }
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
    feed_mode_clears_feed = True
    feed_before_units = True
    lone_cr_is_blank = True
    number_first = True
    turns_address = "P"
    line_length = 252
    comments = "(;"
    words = "DEFHIJKLNPQRST@^$"
    arc_rotary = True
    numbers = gx.NumberFormat(mm=4, inch=5, angle=4)
    arc_rule = gx.ArcRule(
        absolute=0.0282843, relative=0.001, largest=2.82843, smallest=0.00127, r_short=0.00127
    )
