"""How far the pieces of two paths are apart that `matching` has found to belong together."""

from __future__ import annotations

import numpy as np

from gcxform.deviations.deviation import deviation
from gcxform.deviations.even_travel import evenly_apart
from gcxform.deviations.matching import Matching, cut
from gcxform.system.arrays import Flags, Floats, Small
from gcxform.toolpath.path import Kind, Toolpath
from gcxform.values import dataclass


@dataclass(frozen=True)
class Distance:
    """Per pair of pieces: distance (mm), angle (degrees), and whether only ends were compared."""

    distance: Floats
    angle: Floats
    ends_only: Flags


def known_alone(a: Toolpath, b: Toolpath, matching: Matching) -> Small:
    """Return where an axis has a place at the end of a piece in one path only (pieces, axes).

    It is 1 where a has it, 2 where b has it, 0 where both or none do.
    """
    lost = [np.isnan(cut(p, side).end) for p, side in ((a, matching.a), (b, matching.b))]
    return np.asarray(np.where(lost[0] == lost[1], 0, np.where(lost[1], 1, 2)), np.int8)


def measure(a: Toolpath, b: Toolpath, matching: Matching, partly: bool = False) -> Distance:
    """Return how far the matched pieces are apart, along each of them and not only at its end.

    Where an axis has a place in one path only they are infinitely far apart; `partly` it is left
    out there, as if none had it.
    """
    one, other = cut(a, matching.a), cut(b, matching.b)
    if partly:
        alone = known_alone(a, b, matching) != 0
        entry = np.isnan(one.entry) != np.isnan(other.entry)
        one, other = (
            path.replace(
                end=np.where(alone, np.nan, path.end), entry=np.where(entry, np.nan, path.entry)
            )
            for path in (one, other)
        )
    owner = np.arange(len(one))
    there, back = deviation(one, other, owner), deviation(other, one, owner)
    out, home = there.distance + a.slack, back.distance + b.slack
    nearer = np.minimum(out, home)
    unlike = np.flatnonzero(np.isinf(nearer))
    nearer[unlike] = evenly_apart(one, other, unlike) + a.slack + b.slack
    return Distance(
        nearer,
        np.where(out <= home, there.angle, back.angle),
        there.unknown_start | back.unknown_start | (one.kind == Kind.RAPID),
    )
