"""GRBL 1.1h, as its own parser executes programs.

| what | GRBL |
|---|---|
| motion at start | G0 |
| `/` | is dropped and the block is executed |
| two codes of a group, a word twice, a word nobody uses | refused |
| G80 beside a motion code, G49 beside one | refused |
| G49 beside axis words | does not move: refused |
| arc centre | incremental only; K of an arc in XY is dropped, beside I or J |
| full circle | at least one plane word must be there |
| start and end radius | refused beyond 0.5 mm, or beyond 0.005 mm and 0.1 % |
| `%` | error 1, and nothing is executed, or left out by what sends the program: copied |
| O numbers | refused |
| after M2, M30 | modes are G1 G17 G90 G94 G54 and execution goes on |
| G93 on an arc | its source takes F as mm/min there: refused where feeds are converted |
| another feed mode | the feed is not known until it is programmed |
| G38.2 to G38.5 | end at the target at the latest; the axes named then stand nowhere known |
| `!` `?` `~`, bytes from 0x80 | act at once, also in a comment: hold, state, resume, overrides |
| block | at most 79 characters after comments and blanks |
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v


class Grbl(gx.Dialect):
    """GRBL 1.1h."""

    name = "grbl"
    grammar = ("gcxform_grammars", "grbl")
    axes = "XYZ"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G61": v.inert("path", act="exact-path"),
        "G91.1": gx.Code("arc-distance"),
        "G10": v.frame("non-modal", "set-work", "XYZLP"),
        "G92": v.frame("non-modal", "preset", "XYZ"),
        "G92.1": v.frame("non-modal", "preset-clear"),
        **{code: v.frame("non-modal", "home") for code in ("G28", "G30")},
        **{code: v.frame("non-modal", "store-home") for code in ("G28.1", "G30.1")},
        "G53": v.frame("non-modal", "machine"),
        "G43.1": v.frame("tool-length", "length-vector", "XYZ"),
        **{code: gx.Code("motion") for code in ("G38.2", "G38.3", "G38.4", "G38.5")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        code: code_of
        for code, code_of in v.ISO_M.items()
        if code not in (6,)  # M6 is error 20
    }
    initial: ClassVar[Mapping[str, str]] = {**gx.Dialect.initial, "motion": "G0"}
    program_rule = gx.ProgramRule(
        has_percent=False,
        drops_percent=True,
        has_program_number=False,
        block_delete="execute",
        stops_at_end=False,
        resets_at_end={
            "motion": "G1",
            "plane": "G17",
            "distance": "G90",
            "feed-mode": "G94",
            "frame": "G54",
        },
    )
    text_rule = gx.TextRule(
        line_length=79,
        length_without_blanks=True,
        largest_number=10_000_000,
        comments="(;",
        acts_anywhere="!?~\x18" + "".join(map(chr, range(0x80, 0x100))),
    )
    block_rule = gx.BlockRule(words="FIJKLNPRST", one_action="axes", g80_beside_motion=False)
    feed_rule = gx.FeedRule(arcs_in_time=False)
    motion_rule = gx.MotionRule(g28_without_axes=True, g53_in_g91="absolute")
    arc_rule = gx.ArcRule(
        absolute=0.005, relative=0.001, largest=0.5, circle="some", third="dropped"
    )
    offset_rule = gx.OffsetRule(
        known_at_start=True,
        g10_p0="active",
        g10_needs_p=False,
        g10_l20="here",
        g10_ignores_g91=True,
    )
    tool_rule = gx.ToolRule(length_axes="Z", g49_takes_axes=True)
