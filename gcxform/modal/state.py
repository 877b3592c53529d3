"""What the interpreter is told, what it carries from window to window, and what holds on a line."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Small = NDArray[np.int8]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Reading:
    """What a program does not say of itself.

    start         position of axes before the first block, mm or degrees
    increment     least input increment, in the unit the program is in (mm, inch) and degrees;
                  None: a distance without a point is refused where the dialect asks for one
    feed          feed in effect before the first F word, in the program's unit
    block_delete  "execute", "skip", or "" to refuse blocks with a slash that do anything
    units         "mm" or "in" until the program says G20 or G21; "" for the dialect's default
    tools         radius of tools by their number, mm: what G41 and G42 leave to a table
    """

    start: Mapping[str, float] = field(default_factory=dict)
    increment: float | None = None
    feed: float | None = None
    block_delete: str = ""
    units: str = ""
    tools: Mapping[int, float] = field(default_factory=dict)


@dataclass(slots=True)
class State:
    """What one window hands to the next.

    side, radius  cutter compensation in force; `at_side`: that of the last move;
                  `cancelled`: G40 has been in force since
    selected      the T word; `tool`: the tool in the spindle; `stored`: the D word; nan: not known
    """

    groups: dict[str, int]
    position: Floats
    feed: float
    feed_unit: float
    frame_known: bool
    ended: bool = False
    percents: int = 0
    first_frame: int = -1
    rapid: bool = False
    side: int = 0
    radius: float = np.nan
    selected: float = np.nan
    tool: float = np.nan
    stored: float = np.nan
    at_side: int = 0
    cancelled: bool = False
    stated: set[str] = field(default_factory=set)


@dataclass(frozen=True, slots=True)
class Modes:
    """Per line of a window, after its words: the number of the code in force of each group.

    `feed` is the number last programmed and `feed_unit` what 1 of it is worth in mm.
    """

    motion: Small
    plane: Small
    incremental: Flags
    absolute_centre: Flags
    feed_mode: Small
    inch: Flags
    frame: Small
    comp: Small
    feed: Floats
    feed_unit: Floats
