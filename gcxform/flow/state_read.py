"""What macro B reads of the state of the control: modes (#4001 to #4120), and where it stands.

The numbers are those of the block before (of #4001 to #4014 the code of a group, of #4109 the F, of
#4120 the T: Mitsubishi M700V manual p. 331, of the same numbers; the groups are Fanuc's). #5001 to
#5003 are the end of the block before, in the work offset and without the length of the tool. What
the program has not stated, what stands behind a branch or a call that may have changed it, and the
order of axes behind Z only the machine knows.
"""

from __future__ import annotations

import math
import re
from typing import Final

import numpy as np

from gcxform.dialect.arithmetic import Key
from gcxform.dialect.dialect import INCH
from gcxform.flow.branches import Branches
from gcxform.flow.detection import READS
from gcxform.flow.execution import Execution
from gcxform.flow.places import Places
from gcxform.modal.meaning.tables import FAMILIES, code_of
from gcxform.modal.state import CYCLE_OFF, State

NAMES: Final = re.compile(READS.decode(), re.IGNORECASE)
GROUPS: Final = {
    4001: "motion",
    4002: "plane",
    4003: "distance",
    4005: "feed-mode",
    4006: "units",
    4007: "cutter-comp",
}
WORK, FEED, TOOL, FIRST = 4014, 4109, 4120, 5001
ALL: Final = (*GROUPS, WORK, FEED, TOOL, *range(FIRST, FIRST + 3))
PLAIN_WORK: Final = re.compile("G(5[4-9])")


class StateRead:
    """Reads the executed blocks as they come, and says what the variables are worth."""

    def __init__(self, program: Execution, branches: Branches) -> None:
        self.program, self.branches = program, branches
        self.places = Places(program)

    def values(self) -> dict[Key, float]:
        """Return the variables; nan where only the machine knows one. Raises InputError."""
        state = self.places.now()
        open_ = bool(self.branches.joins or state.kept_calls or state.lost_modes)
        modes = {} if open_ else {**_codes(state), **_words(state)}
        return {**dict.fromkeys(ALL, math.nan), **modes, **_place(state, self.places.axes)}

    def in_cycle(self) -> bool:
        """Whether a cycle is on, or only the machine knows. Raises InputError."""
        state = self.places.now()
        return bool(state.lost_modes) or state.memory.get("cycle", CYCLE_OFF) != CYCLE_OFF


def _codes(state: State) -> dict[Key, float]:
    """Return the codes in force that the program has stated."""
    found: dict[Key, float] = {}
    for number, group in GROUPS.items():
        cycle = group == "motion" and state.memory.get("cycle", CYCLE_OFF) != CYCLE_OFF
        if group in state.stated and not cycle and group in FAMILIES:
            code = float(code_of(group, state.groups[group])[1:])
            found[number] = math.nan if code == CYCLE_OFF else code
    plain = PLAIN_WORK.fullmatch(state.frames.work)
    if plain is not None and "frame" in state.stated:
        found[WORK] = float(plain[1])
    return found


def _words(state: State) -> dict[Key, float]:
    """Return F and T as they were written last."""
    feed = math.nan if state.feed_lost else state.feed
    return {FEED: feed, TOOL: state.tool_word if state.tool_word >= 0 else math.nan}


def _place(state: State, axes: str) -> dict[Key, float]:
    """Return where X, Y and Z stand, as words would say it, where that is one thing for certain."""
    frames, frame = state.frames, state.frames.frame()
    turned = frame.matrix is not None or frame.polar or frame.diameter
    if turned or state.side or any(frames.local) or any(frames.preset):
        return {}
    words = frame.words(state.position[np.newaxis])[0]
    scale = INCH if state.groups["units"] else 1.0
    return {FIRST + k: float(words[axes.index(axis)]) / scale for k, axis in enumerate("XYZ")}
