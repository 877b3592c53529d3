"""Is a file a subprogram by itself, that another program calls? Asked before it is executed.

On controls whose programs have numbers it is one whose first program has M99, with or without P,
and neither M2 nor M30. Such a file may be a program that begins anew as well: both begin in a state
that something else has left, and leave one. A file with O-words is one if nothing but an end stands
outside of what they define.
"""

from __future__ import annotations

import re

from gcxform.dialect.dialect import Dialect
from gcxform.flow.listing import Listing, bare
from gcxform.flow.lookup import Folders
from gcxform.flow.numbered_files import begins_program
from gcxform.flow.run_state import whole_number
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Statement, Word

SIGNS = {
    "macro-b": re.compile(rb"M[ \t]*0*99(?![0-9])", re.IGNORECASE),
    "o-words": re.compile(rb"\bendsub\b", re.IGNORECASE),
}
"""What the text of every such file has, by the language of its control."""


def is_subprogram(source: Source, dialect: type[Dialect]) -> bool:
    """Whether the program of a file returns to what has called it, and ends nothing."""
    sign = SIGNS.get(dialect.flow_rule.language)
    if sign is None or not any(sign.search(text) for text in source.windows()):
        return False
    text, folders = b"".join(source.windows()), Folders((), dialect.flow_rule.lookup)
    listing = Listing(text, dialect, source.name, folders)
    if dialect.flow_rule.language == "o-words":
        return _only_defines(listing)
    first = _first_program(listing)
    special = [line for line in listing.special.tolist() if line in first]
    back = [line for line in special if returns(listing.block(line))]
    return bool(back) and not any(listing.meaning(n).ends for n in special if n not in back)


def _only_defines(listing: Listing) -> bool:
    """Whether nothing but ends stands outside of `sub` and `endsub`."""
    special, inside = set(listing.special.tolist()), False
    shapes = listing.table.shapes.shapes
    plain = [not bare(shape.block) for shape in shapes]
    for line in range(len(listing)):
        if line in special:
            items = bare(listing.block(line))
            word = _keyword(items[0]) if items else ""
            if not inside and items and word != "SUB" and not _is_end(items):
                return False
            inside = word == "SUB" or (inside and word != "ENDSUB")
        elif not inside and not plain[int(listing.window.shape[line])]:
            return False
    return True


def _keyword(item: Word | Statement) -> str:
    """Return the keyword of an O-word in capitals; nothing for what is none."""
    if not isinstance(item, Statement) or item.kind != "flow":
        return ""
    return str(item.tree.children[2]).upper()


def _is_end(items: list[Word | Statement]) -> bool:
    """Whether a block is an end and nothing else."""
    one = items[0]
    ends = isinstance(one, Word) and one.address == "M" and whole_number(one) in (2, 30)
    return ends and len(items) == 1


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
