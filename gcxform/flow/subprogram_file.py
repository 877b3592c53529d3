"""Is a file a subprogram by itself, that another program calls? Asked before it is executed.

On controls whose programs have numbers it is one whose first program has M99, with or without P,
and neither M2 nor M30. Such a file may be a program that begins anew as well: both begin in a state
that something else has left, and leave one. A file with O-words is one if nothing but an end stands
outside of what they define.

Where such a file neither moves anything nor says or asks where anything is, no error of a machine
is to be taken off it, wherever it is called.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from gcxform.dialect.dialect import Dialect
from gcxform.flow.listing import Listing, bare
from gcxform.flow.lookup import Folders
from gcxform.flow.numbered_files import begins_program
from gcxform.flow.run_state import whole_number
from gcxform.modal.meaning.meaning import OWN_MOVES, PRESETS, Meaning
from gcxform.syntax.source import Source
from gcxform.syntax.tree import Block, Expression, Statement, Word

PLACES = re.compile(
    rb"#[ \t]*(?:[\[#]|50[0-9]{2}(?![0-9])|542|<[ \t]*_[xyzabcuvw][ \t]*>)", re.IGNORECASE
)
"""Parameters that say where axes stand or were touched, and those whose number is computed."""
ELSEWHERE = frozenset({"G65", "G66", "G66.1", "M96", "M97", "M98", "M198"})
"""Codes that lead to other lines, or to other programs."""


def only_returns(source: Source, dialect: type[Dialect]) -> bool:
    """Whether a program that has the sign of it returns to what has called it, and ends nothing."""
    listing = _listing(source, dialect)
    if dialect.flow_rule.language == "o-words":
        return _only_defines(listing)
    first = _first_program(listing)
    special = [line for line in listing.special.tolist() if line in first]
    back = [line for line in special if returns(listing.block(line))]
    return bool(back) and not any(listing.meaning(n).ends for n in special if n not in back)


def moves_nothing(source: Source, dialect: type[Dialect], calling: Collection[str]) -> bool:
    """Whether a file moves no axis, sets no zero, asks not where axes stand, and calls no other.

    `calling` are the codes that call programs on this machine, besides those of the control.
    """
    listing = _listing(source, dialect)
    if PLACES.search(listing.window.text):
        return False
    meanings = zip(listing.table.shapes.shapes, listing.table.meanings, strict=True)
    codes = ELSEWHERE.union(calling)
    if any(_goes(shape.block, meaning, dialect, codes) for shape, meaning in meanings):
        return False
    blocks = [listing.block(line) for line in listing.special.tolist()]
    flow = [item for block in blocks for item in block.items if _keyword_of(item)]
    defined = {_label(item) for item in flow if _keyword_of(item) == "SUB"}
    return all(_keyword_of(item) != "CALL" or _label(item) in defined for item in flow)


def _goes(block: Block, meaning: Meaning, dialect: type[Dialect], codes: frozenset[str]) -> bool:
    """Whether a block moves, says where something is, or leads elsewhere; or may do so."""
    words = [*block.words]
    placed = not meaning.dwell and any(word.address in dialect.axes for word in words)
    placed |= bool(meaning.centres) or any(word.address in "IJKR@^" for word in words)
    computed = any(word.address in "GM" and isinstance(word.value, Expression) for word in words)
    leads = any(f"{word.address}{word.value.value:g}" in codes for word in words)
    done = bool(meaning.call) or any(act.name in OWN_MOVES | PRESETS for act in meaning.acts)
    flows = any(isinstance(item, Statement) for item in block.items)
    unread = block.error is not None or (meaning.refusal is not None and not flows)
    return placed or computed or leads or done or unread


def _listing(source: Source, dialect: type[Dialect]) -> Listing:
    text, folders = b"".join(source.windows()), Folders((), dialect.flow_rule.lookup)
    return Listing(text, dialect, source.name, folders)


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


def _keyword_of(item: object) -> str:
    """Return the keyword of an O-word in capitals; nothing for all else that stands in a block."""
    return _keyword(item) if isinstance(item, Statement) else ""


def _label(item: object) -> str:
    """Return what an O-word is called by."""
    assert isinstance(item, Statement)
    return str(item.tree.children[1]).lower()


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
