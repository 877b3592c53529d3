"""The words of one line of a program for a SINUMERIK, put in order."""

from __future__ import annotations

from dataclasses import dataclass, field, fields

import gcxform as gx

ABSOLUTE, STEP = "AC", "IC"
NOBODYS = "of no known tool"
"""The edge that is in force where D1 has been said of a tool that nobody knows."""
FRAMES = frozenset(
    way + name for way in ("", "A") for name in ("TRANS", "ROT", "ROTS", "SCALE", "MIRROR")
)
"""Instructions for the frame of the program, new ones and those that add to it."""
CORNERS = frozenset(("RND", "RNDM", "CHR", "CHF", "FRC"))
"""What cuts the corner to which a line leads, and how fast."""


@dataclass(slots=True)
class Line:
    """What stands in a line.

    number    the sequence number as a word, with a blank
    codes     G codes that are written as they are
    motion    of this line: "0" to "3", "CIP", or nothing
    axes      way (nothing, AC, IC, DC, ACP, ACN), number and item by letter; centres, middles: the
              same of I J K, and I1 J1 K1
    named     CR, TURN, AR, AP, RP, ANG: number and item;  onwards: AP turns on from the last one
    corner    RND, RNDM, CHR, CHF, FRC: number and item;  behind: the blocks that cut a corner
    others    S and M words;  ahead: those of blocks before this one
    asides    what goes along in the same language, as it was programmed
    alone     what stands for nothing, and in a block of its own
    act       what follows the tip, or stops: M128, M129
    """

    number: str = ""
    codes: list[str] = field(default_factory=list)
    motion: str = ""
    axes: dict[str, tuple[str, str, gx.Item]] = field(default_factory=dict)
    centres: dict[str, tuple[str, str, gx.Item]] = field(default_factory=dict)
    middles: dict[str, tuple[str, str, gx.Item]] = field(default_factory=dict)
    named: dict[str, tuple[str, gx.Item]] = field(default_factory=dict)
    onwards: bool = False
    corner: dict[str, tuple[str, gx.Item]] = field(default_factory=dict)
    behind: list[str] = field(default_factory=list)
    feed: str = ""
    others: list[str] = field(default_factory=list)
    ahead: list[str] = field(default_factory=list)
    asides: list[str] = field(default_factory=list)
    tool: str = ""
    tool_name: str = ""
    changes: gx.Item | None = None
    edge: gx.Item | None = None
    edge_number: str = ""
    work: tuple[str, gx.Item] | None = None
    machine: gx.Item | None = None
    dwell: gx.Item | None = None
    act: tuple[str, gx.Item] | None = None
    cycle: gx.Item | None = None
    alone: gx.Item | None = None
    modal: gx.Item | None = None
    pole: tuple[str, gx.Item] | None = None
    groups: set[str] = field(default_factory=set)

    def says_only(self, *names: str) -> bool:
        """Whether nothing stands in a line but what fields of these names hold, and its number."""
        others = (f.name for f in fields(self) if f.name not in {*names, *OF_OTHERS})
        return not any(getattr(self, name) not in NOTHING for name in others)


OF_OTHERS = frozenset(("number", "groups", "onwards", "edge_number", "asides"))
"""What says of other fields how they were said, or nothing that a block says."""
NOTHING: tuple[object, ...] = ("", None, [], {})
