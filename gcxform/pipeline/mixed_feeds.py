"""Feeds of moves of several kinds of axes, whose time hangs on the control and on the unit.

X10 A90 F100 takes LinuxCNC the time of the 10 mm; another control adds up the squares of mm and
degrees, and in inches another sum. So such a feed is the same only on the same control, and in the
same unit; in inverse time (G93) it is the same everywhere.
"""

from __future__ import annotations

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.contract.passes import PassContext
from gcxform.dialect.dialect import LINEAR, run_alike
from gcxform.system.arrays import Ints
from gcxform.toolpath.path import FeedMode, Kind, Toolpath

STILL = 1e-7  # mm, degrees
MAIN = frozenset("XYZ")


def check_mixed(read: Toolpath, path: Toolpath, context: PassContext) -> None:
    """Raise InputError (GX320) for a move that would take another time at the feed it has.

    `read` is the path of the source, `path` the one to be written, of the same lines.
    """
    source, target = context.source, context.target
    same_rule = run_alike(source, target) or (
        source.feed_rule.along_lines and target.feed_rule.along_lines
    )
    inches = path.blocks.inch != read.blocks.inch
    if same_rule and (target.feed_rule.along_lines or not inches.any()):
        return
    main, second, rotary = _axes_moved(path)
    rows = (path.kind != Kind.RAPID) & (path.feed_mode != FeedMode.INVERSE_TIME)
    rows &= path.feed_mode == read.blocks.feed_mode[path.block]  # else a pass has converted it
    kinds = 1 * (main > 0) + 1 * (second > 0) + 1 * (rotary > 0)
    if not same_rule:
        wrong = rows & ((kinds > 1) | (rotary > 1))
        why = f"{source.name} and {target.name} may count it along other axes"
    else:
        wrong = rows & inches[path.block] & (rotary > 0) & (kinds > 1)
        why = f"{target.name} may add up degrees and inches, and another sum in mm"
    if wrong.any():
        message = f"the feed of this move would be another: {why}"
        raise path.refuse("GX320", np.flatnonzero(wrong), message, _way_out(context))


def _axes_moved(path: Toolpath) -> tuple[Ints, Ints, Ints]:
    """Return how many of X Y Z, of U V W and of the rotary axes each move (n,) moves."""
    start, end = path.start, path.end
    way = np.where(np.isnan(start) & np.isnan(end), 0.0, end - start)
    moved = ~(np.abs(way) < STILL)
    main = np.array([axis in MAIN for axis in path.axes])
    linear = np.array([axis in LINEAR for axis in path.axes])
    along = moved[:, main].sum(axis=1) + path.is_arc
    return along, moved[:, linear & ~main].sum(axis=1), moved[:, ~linear].sum(axis=1)


def _way_out(context: PassContext) -> str:
    """Return what to do: G93 says the time of a move, where the source says how long it takes."""
    if context.source.feed_rule.along_lines and "G93" in context.target.codes:
        return put_before("feed", options="mode=inverse-time")
    return "let the CAM write this part in inverse time (G93), or in the dialect and unit wanted"
