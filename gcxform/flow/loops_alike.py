"""Loops that are written like one of which only the machine knows how often it runs.

That a loop is one of these comes out at its end, and the program is run again from its start. Where
the same few probing moves stand a thousand times, each with a place of its own, that would be a
thousand runs. So all that are written like one that was found are taken for the machine's at once,
where each by itself would be found to be the same: each of its moves names its motion, one at least
is a probe's, and it sets no parameter but those of the probe. Then what is lost behind a round is
lost by the round alone, whatever is known before it. Whether the loop that was found was known to
begin is kept beside the others, which begin as it did (`Settled.alike`).
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
PROBE = re.compile(r"G *38")
ACTIVE = re.compile(r"[(;]\s*[A-Za-z]+,")


class LoopsAlike:
    """The loops of a program by how they are written, but for places."""

    def __init__(self, listing: Listing, every: Iterable[Construct]) -> None:
        whiles = {each.lines[0]: each for each in every if each.kind == "while"}
        self._writing = {line: _written(listing, each) for line, each in whiles.items()}
        self._lines: dict[tuple[str, ...], set[int]] = {}
        for line, writing in self._writing.items():
            self._lines.setdefault(writing, set()).add(line)

    def others(self, first: int) -> frozenset[int]:
        """Return the first lines of those written like the loop that has this one; itself too."""
        writing = self._writing.get(first)
        return frozenset(self._lines[writing] if writing else ())


def _written(listing: Listing, construct: Construct) -> tuple[str, ...]:
    """Return a loop of moves that name their motion, without places; nothing of any other."""
    first, last = construct.lines[0], construct.last
    if construct.lines != [first, last]:
        return ()
    inside = [listing.block(line).text for line in range(first + 1, last)]
    moves = [REMARK.sub("", text).strip().upper() for text in inside]
    if any(map(ACTIVE.search, inside)) or not all(map(MOVE.fullmatch, filter(None, moves))):
        return ()
    if not any(map(PROBE.match, moves)):
        return ()
    block = listing.block(first)
    statement = next(each for each in block.items if isinstance(each, Statement))
    condition = block.text[span_of(statement.tree.children[2])[1] :]
    return (condition, *(PLACE.sub("", move) for move in moves if move))
