"""What the passes tell of their work besides the deviation."""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform_plugins.passes.rtcp.forward.cutting import STILL
from gcxform_plugins.passes.rtcp.forward.ways import Corrected
from gcxform_plugins.passes.rtcp.place import Place, turned_at

TIP_OFF, AXIS_OFF = "tip off, mm", "tool axis off, degrees"


def slowed(before: gx.Toolpath, after: gx.Toolpath, place: Place) -> dict[str, float]:
    """Return how much longer a piece takes than its feed says, if any does."""
    owner = np.searchsorted(before.source, after.source)
    cut = (after.kind != gx.Kind.RAPID) & (after.feed_mode != before.feed_mode[owner])
    rows = np.flatnonzero(cut)
    step = before.end - before.start
    way = np.sqrt((step[:, :3] ** 2).sum(axis=1))
    turned = np.sqrt((place.angles(step) ** 2).sum(axis=1))
    time = np.where(way < STILL, turned, way) / before.feed
    time = time / np.maximum(np.bincount(owner, minlength=len(before)), 1)
    slower = float(np.max(1.0 / after.feed[rows] / time[owner[rows]], initial=0.0))
    return {"slower than its feed, times": slower} if slower > 1.001 else {}


def leaning(way: Corrected, after: gx.Toolpath) -> dict[str, float]:
    """Return how far the tool axis stays off where angles are kept, and what that is at a tool."""
    angles = way.axes.angles(after.end)
    rows = np.flatnonzero(turned_at(angles))
    one, other = (p.chain.tool_axis(angles[rows]) for p in (way.nominal, way.axes))
    off = np.linalg.norm(one - other, axis=1)
    length = np.linalg.norm(way.axes.tools[way.axes.which[rows]], axis=1)
    return {
        AXIS_OFF: float(np.degrees(off.max(initial=0.0))),
        "tool axis off by tool length, mm": float((off * length).max(initial=0.0)),
    }
