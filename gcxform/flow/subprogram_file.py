"""Is a file a subprogram by itself, that another program calls? Asked before it is executed.

On controls whose programs have numbers it is one whose first program has M99, with or without P,
and neither M2 nor M30. Such a file may be a program that begins anew as well: both begin in a state
that something else has left, and leave one.
"""

from __future__ import annotations

import re

from gcxform.dialect.dialect import Dialect
from gcxform.flow.listing import Listing, bare
from gcxform.flow.lookup import Folders
from gcxform.flow.numbered_files import begins_program
from gcxform.flow.run_state import whole_number
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block

RETURNS = re.compile(rb"M[ \t]*0*99(?![0-9])", re.IGNORECASE)


def is_subprogram(source: Source, dialect: type[Dialect]) -> bool:
    """Whether the program of a file returns to what has called it, and ends nothing."""
    if dialect.flow_rule.language != "macro-b":
        return False
    text = b"".join(source.windows())
    if RETURNS.search(text) is None:
        return False
    listing = Listing(text, dialect, source.name, Folders((), dialect.flow_rule.lookup))
    first = _first_program(listing)
    special = [line for line in listing.special.tolist() if line in first]
    back = [line for line in special if returns(listing.block(line))]
    return bool(back) and not any(listing.meaning(n).ends for n in special if n not in back)


def _first_program(listing: Listing) -> range:
    """Return the lines of the program that runs: up to where the second one begins."""
    special = listing.special.tolist()
    lines = [line for line in special if begins_program(listing.block(line))]
    if lines and not any(bare(listing.block(line)) for line in range(lines[0])):
        lines = lines[1:]
    return range(lines[0] if lines else len(listing))


def returns(block: Block) -> bool:
    """Whether a block has M99."""
    return any(word.address == "M" and whole_number(word) == 99 for word in block.words)
