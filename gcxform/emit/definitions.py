"""Definitions of a program that is written out: they stand beside what was executed, as they did.

What the control passes on its way stands where it is passed, the rest behind the end. Nothing that
was written out calls them any more, but another program may.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from gcxform.emit.folding import Folded
from gcxform.emit.spelled import Spelled, Text
from gcxform.flow.listing import Definition
from gcxform.stamps.comment import is_stamp


def beside(spelled: Spelled, takes_stamps: bool = False) -> Folded | None:
    """Return a program that is written out, with its definitions; None if it has none.

    `takes_stamps`: its stamps are taken out, those of definitions too.
    """
    walk = spelled.walk
    if not walk.definitions:
        return None
    places = {each: walk.passed_at(each.first) for each in walk.definitions}
    found, at = Text(), 0
    for each, block in places.items():
        if block is not None:
            found += spelled.text(at, block) + _raw(spelled, each, takes_stamps)
            at = block
    found += spelled.text(at, walk.blocks)
    for each in (one for one, block in places.items() if block is None):
        found += _raw(spelled, each, takes_stamps)
    found += _behind(spelled, walk.kept)
    return Folded(found.text, found.lines, (), (), whole=True)


def _raw(spelled: Spelled, one: Definition, takes_stamps: bool) -> Text:
    """Return a definition as it stands."""
    lines = [(spelled.raw(line), line) for line in range(one.first, one.last + 1)]
    stay = [
        (text, line)
        for text, line in lines
        if not (takes_stamps and is_stamp(text.decode("latin-1").strip()))
    ]
    return Text(b"".join(text for text, _ in stay), tuple(line for _, line in stay))


def _behind(spelled: Spelled, kept: Iterable[Definition]) -> Text:
    """Return what stands behind the end and is no definition: a percent sign."""
    first = spelled.walk.blocks
    lines = spelled.origin[first:]
    inside = np.zeros(len(lines), np.bool_)
    for each in kept:
        inside |= (each.first <= lines) & (lines <= each.last)
    return sum((spelled.text(k, k + 1) for k in (first + np.flatnonzero(~inside)).tolist()), Text())
