"""What single codes do to the frame: G54, G10, G52, G92, G43, G68 and their like, by name."""

from __future__ import annotations

from collections.abc import Mapping

from gcxform.modal.frame_state import FrameState
from gcxform.modal.frames import followed_tips, planes
from gcxform.modal.frames import tool_lengths as lengths
from gcxform.modal.frames import transforms as turns
from gcxform.modal.frames import work_offsets as offsets
from gcxform.modal.frames.act import Act, ActError, Asked

ACTS: Mapping[str, Act] = {
    "call": offsets.behind_call,
    "table": offsets.table,
    "change-tool": lengths.change_tool,
    "set-tool": lengths.set_tool,
    "user-code": lengths.user_code,
    "tip-on": lengths.tip_on,
    "tip-off": lengths.tip_off,
    "tip-kept-on": lengths.tip_on,
    "tip-kept-off": lengths.tip_off,
    "length": lengths.length,
    "length-negative": lengths.length_negative,
    "length-vector": lengths.length_vector,
    "length-add": lengths.length_add,
    "length-number": lengths.length_number,
    "offset-of-tool": lengths.offset_of_tool,
    "no-length": lengths.no_length,
    "vectors": lengths.vectors,
    "no-vectors": lengths.no_vectors,
    "work": offsets.work,
    "diameter": turns.diameter,
    "plane": turns.plane,
    "no-plane": turns.no_plane,
    "tip": lengths.tip,
    "follow-tip": followed_tips.follow,
    "define-plane": planes.define,
    "orient": planes.orient,
    "swivel": planes.swivel,
    "turn-to": planes.turn_to,
    "polar": turns.polar,
    "no-polar": turns.no_polar,
    "rotate": turns.rotate,
    "no-rotate": turns.no_turn("rotate"),
    "scale": turns.scale,
    "no-scale": turns.no_turn("scale"),
    "mirror": turns.mirror,
    "no-mirror": turns.no_turn("mirror"),
    "set-work": offsets.set_work,
    "local": offsets.local,
    "preset": offsets.preset,
    "preset-clear": offsets.preset_clear,
    "preset-suspend": offsets.preset_suspend,
    "preset-restore": offsets.preset_restore,
    "store-home": offsets.store_home,
}

WORDS: Mapping[str, str] = {
    "length": "H",
    "length-negative": "H",
    "length-add": "H",
    "length-number": "H",
    "offset-of-tool": "T",
    "no-length": "H",
    "tip": "H",
    "follow-tip": "H",
    "plane": "PQRIJK",
    "define-plane": "PQRIJK",
    "swivel": "P",
    "turn-to": "IJK",
    "vectors": "H",
    "set-tool": "Q",
    "set-work": "LPRQIJK",
    "rotate": "RIJK",
    "scale": "PIJK",
    "user-code": "PQ",
}
"""The words, besides axes, by which an act says what it does. Work offsets have any."""


def done(name: str, state: FrameState, asked: Asked) -> FrameState:
    """Return the state behind an act. Raises ActError."""
    planes.check_in_plane(state, name, asked.code)
    if word := _unheard(name, asked):
        message = f"{asked.code} takes {word}, and what this asks for is not known"
        raise ActError("GX213", message)
    return ACTS[name](state, asked)


def _unheard(act: str, asked: Asked) -> str:
    """Return a word of the block that its code takes and its act does not look at, if there is one.

    Two blocks that differ in such a word alone would be taken for the same.
    """
    if not asked.written:
        return ""
    heard = asked.numbers if act == "work" else WORDS.get(act, "")
    return next((a for a in asked.written if a not in asked.dialect.axes and a not in heard), "")
