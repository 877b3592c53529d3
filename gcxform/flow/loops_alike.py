"""Loops that are written like one of which only the machine knows how often it runs.

That a loop is one of these comes out at its end, and the program is run again from its start. Where
the same few probing moves stand a thousand times, each with a place of its own, that would be a
thousand runs. So all that are written like one that was found are taken for the machine's at once,
where each by itself would be found to be the same: what they do sets no parameter but those of the
probe, each move names its motion, and the condition was known where the found one began. Then what
is lost behind a round is lost by the round alone, whatever is known before it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from gcxform.flow.constructs import Construct
from gcxform.flow.listing import Listing
from gcxform.syntax.grammar import span_of
from gcxform.syntax.tree import Statement

MOVE = re.compile(r"G *(?:0*[01]|38\.[2-5])(?![0-9.])[GXYZABCUVWF0-9. +-]*")
PLACE = re.compile(r"(?<=[XYZABCUVW])[ +-]*[0-9.][0-9. ]*")
REMARK = re.compile(r"\([^)]*\)|;.*")
ACTIVE = re.compile(r"[(;]\s*[A-Za-z]+,")


def alike(listing: Listing, every: Iterable[Construct], construct: Construct) -> frozenset[int]:
    """Return the first lines of the loops that are written like one, but for places."""
    own = _written(listing, construct)
    whiles = {each.lines[0]: each for each in every if each.kind == "while"} if own else {}
    return frozenset(n for n, each in whiles.items() if _written(listing, each) == own)


def _written(listing: Listing, construct: Construct) -> tuple[str, ...]:
    """Return a loop of moves that name their motion, without places; nothing for any other."""
    first, last = construct.lines[0], construct.last
    if construct.lines != [first, last]:
        return ()
    inside = [listing.block(line).text for line in range(first + 1, last)]
    moves = [REMARK.sub("", text).strip().upper() for text in inside]
    if any(map(ACTIVE.search, inside)) or not all(map(MOVE.fullmatch, filter(None, moves))):
        return ()
    block = listing.block(first)
    statement = next(each for each in block.items if isinstance(each, Statement))
    condition = block.text[span_of(statement.tree.children[2])[1] :]
    return (condition, *(PLACE.sub("", move) for move in moves if move))
