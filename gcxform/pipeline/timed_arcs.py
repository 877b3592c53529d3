"""Arcs in inverse time (G93), on a control that does not give them the time that they state.

GRBL moves along such an arc at a feed per minute, F times the number of pieces that it cuts it
into: what a block takes there is said by the same block alone, on the same control.
"""

from __future__ import annotations

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.contract.passes import PassContext
from gcxform.system.arrays import Flags
from gcxform.toolpath.path import FeedMode, Toolpath

BY_CAM = "let the CAM write this part with feeds per minute (G94)"


def check_timed_arcs(read: Toolpath, path: Toolpath, context: PassContext) -> None:
    """Raise InputError (GX320) for an arc in G93 that would take another time.

    `read` is the path of the source, `path` the one to be written, of the same lines.
    """
    source, target = context.source, context.target
    by_pass = put_before("feed", options="mode=per-minute")
    for control, arcs, hint in ((source, read, BY_CAM), (target, path, by_pass)):
        timed = arcs.is_arc & (arcs.feed_mode == FeedMode.INVERSE_TIME)
        if control.feed_rule.arcs_in_time or not timed.any():
            continue
        wrong = timed if source is not target else timed & _become_others(read, path, arcs)
        if wrong.any():
            message = f"{control.name} does not time arcs in G93"
            raise arcs.refuse("GX320", np.flatnonzero(wrong), message, hint)


def _become_others(read: Toolpath, path: Toolpath, arcs: Toolpath) -> Flags:
    """Return which rows of `arcs`, one of both paths, are in lines with other moves than before.

    A pass has made lines of their arcs, arcs of their lines, or more or fewer of either.
    """
    lines = 1 + max(int(each.source.max(initial=0)) for each in (read, path))
    was, are = (
        np.bincount(2 * each.source + each.is_arc, minlength=2 * lines) for each in (read, path)
    )
    differ = (was != are).reshape(lines, 2).any(axis=1)
    return np.asarray(differ[arcs.source])
