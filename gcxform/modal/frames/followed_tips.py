"""Tips that a control follows (G43.4) on a table that turns: where words lead while it stands.

From G43.4 to G49 X, Y and Z are those of the tip, and the control moves its axes so that it comes
there. As long as no rotary axis turns that is a frame like any other. With M_T what the table does
(`gcxform/machine/chain.py`) at the angles q that it stands at,

    position = M_T(q) (zero of the work offset + word) - gauge point + tool

Turned axes make the difference. Fanuc's manual fixes the coordinates of the work offset on the
table "at that point of time" and calls the angle their "initial state" (30i, A-79348E p. 19;
19696#5 = 1 leaves them out of the turn, p. 20): they may lie as with all rotary axes at 0, or along
the axes of the machine. A CAM that states a point in a plane of G68.2 as well means the first. So
the machine file has to say which, where G43.4 comes with the table turned. With `rtcp` the axes may
turn; here they may not, but for a pass that corrects tips (`volumetric` with `tips = "turning"`):
positions are then those of the tip on the table with all axes at 0, as they are behind M128. For
another control `offsets` makes words of the axes of these, and G43 is left of the code; for the
same one it stays.
"""

from __future__ import annotations

import numpy as np

from gcxform.machine.tilting import carried
from gcxform.modal.frame_state import FrameState, TiltedPlane, matrix_of, replace, vector_of
from gcxform.modal.frames.act import ActError, Asked
from gcxform.modal.frames.planes import (
    EQUAL,
    TURN,
    named,
    standing,
    zero_carried,
    zero_of_work,
)
from gcxform.modal.frames.tool_lengths import kept_by_length, length

WORDS_OF_TIP = "tip-words"  # where they count where the code comes with axes turned
TIP = "the tip"
BY_RTCP = "rtcp makes positions of axes of tips: its option tip-codes says that it reads them"


def follow(state: FrameState, asked: Asked) -> FrameState:
    """G43.4 H: from here on words are those of the tip, wherever the table stands."""
    chain = asked.reading.tables
    assert chain is not None  # else no code has this act
    zero = zero_of_work(state, asked, TIP)
    angles = standing(chain, state, asked, f"where words behind {asked.code} lead", TIP)
    state = length(state, asked)
    turned = np.abs(angles - TURN * np.round(angles / TURN)).max() > EQUAL
    said = asked.reading.control.get(WORDS_OF_TIP)
    if turned and said is None:
        raise ActError(
            "GX214",
            f"{asked.code} where the table is turned: along which axes X, Y and Z count is a "
            "matter of the control",
            f'say {WORDS_OF_TIP} = "workpiece" in [control] of the machine file, or "machine"',
        )
    if kept_by_length(asked) and not (turned and said == "machine"):
        return replace(state, following=True)
    if not turned or said == "machine":
        plain = TiltedPlane(None, vector_of(zero), named(chain, angles), tip=True)
        return replace(state, plane=plain)
    if asked.reading.turns_plainly and not asked.reading.crosses:
        message = f"{asked.code} with the table turned: it stays, and words would not"
        raise ActError("GX213", message, BY_RTCP)
    matrix = matrix_of(carried(chain, np.eye(3), angles))
    place = zero_carried(chain, state, zero, angles)
    return replace(state, plane=TiltedPlane(matrix, place, named(chain, angles), tip=True))


def turned_tip(state: FrameState) -> bool:
    """Whether a tip is followed whose words do not lead along the axes of the machine."""
    return state.plane is not None and state.plane.tip and state.plane.turned is not None
