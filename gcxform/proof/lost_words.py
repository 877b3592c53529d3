"""Words whose values only the machine knows: they say the same place only in the same coordinates.

No end is known of such a move, on either side, so nothing of it can be compared but its text, which
is an event, and what the control adds to it: shift, turn and diameter of the frame (mm, degrees).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcxform.modal.interpreter import Interpreted
from gcxform.proof.inventory import Wrong
from gcxform.proof.trace import Trace


def elsewhere(read: Interpreted, trace: Trace, near: float) -> Iterator[Wrong]:
    """Yield what is wrong with words of a window that now count from elsewhere, by more than near.

    Words by distances (G91) do not count from anywhere.
    """
    before, written = trace.before, trace.written
    named = {(each.line, each.text[:1]) for each in read.unknown}
    if not named:
        return
    lost = np.isnan(written.end) & (trace.written_owner >= 0)[:, None]
    for row, k in np.argwhere(lost).tolist():
        owner = int(trace.written_owner[row])
        line, axis = int(before.block[owner]), written.axes[k]
        if (line, axis) not in named or before.blocks.incremental[line]:
            continue
        old, new = before.frames[int(before.frame[owner])], written.frames[int(written.frame[row])]
        turned = (old.matrix, old.diameter, old.polar) != (new.matrix, new.diameter, new.polar)
        if turned or not abs(old.shift[k] - new.shift[k]) <= near:
            message = f"{axis}, whose value only the machine knows, counts from elsewhere"
            yield message, int(before.source[owner]), int(written.source[row])
