"""Which ways the axes go between the ends of lines along which they turn, for `volumetric`.

The tip goes straight, and the axes do not: with both ends within the tables they may leave them.
The proof imports nothing of this.
"""

from __future__ import annotations

import numpy as np

from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.shared.tip_bound import leaving
from gcxform_plugins.passes.volumetric.followed import Followed

WAYPOINTS = 64  # of a line; between them the axes leave its way by 1 / 64^2 of what they do in all


def ways_of(followed: Followed, which: Ints) -> tuple[Floats, Ints]:
    """Return positions (n, 3) mm close on the way of the axes, and the rows (n,) they are of.

    `which` are numbers of `followed.rows`; each gives `WAYPOINTS` + 1 in the order of travel.
    """
    every = np.repeat(which, WAYPOINTS + 1)
    part = np.tile(np.linspace(0.0, 1.0, WAYPOINTS + 1), len(which))
    return followed.axes_at(every, part), followed.rows[every]


def aside_of(followed: Followed, which: Ints) -> Floats:
    """Return how far (n,) mm the axes leave the chord of their way, at most."""
    place, path, aside = followed.place, followed.path, np.zeros(len(which))
    assert place is not None
    for chain, here in place.chains(which):
        start, end = (side[followed.rows[which[here]]] for side in (path.start, path.end))
        tips = place.on_workpiece(start[:, :3], chain), place.on_workpiece(end[:, :3], chain)
        aside[here] = leaving(chain, tips, (place.angles(start), place.angles(end)))
    return aside
