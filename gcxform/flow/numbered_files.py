"""Files of programs that have numbers: which of them is meant by a call."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gcxform.flow.listing import Listing
from gcxform.flow.lookup import Found
from gcxform.flow.run_state import whole_number
from gcxform.syntax.tree import BLANKS, Block, Mark, Word

if TYPE_CHECKING:
    from gcxform.flow.execution import Execution


def file_of(program: Execution, number: int) -> Found | None:
    """Return the file of a program number, None if there is none.

    The number in it must be the same; without one that of its name counts, where the control may
    take it so. Raises InputError for one that cannot be taken, and for two that differ.
    """
    what, folders = f"O{number}", program.listing.folders
    fits, others = [], []
    for each in program.found(folders.of_number(number), what):
        numbers = _numbers_in(each, program.listing)
        fits += [each] if number in numbers or (not numbers and folders.rule.by_name) else []
        others += [each.name] if numbers and number not in numbers else []
    one = program.only(fits, what)
    if one is None and others:
        message = f"{others[0]} is called like O{number}, and holds another program"
        raise program.refusal("GX227", message, "give file and program the same number")
    return one


def _numbers_in(file: Found, caller: Listing) -> list[int | None]:
    """Return the numbers of the programs in a file; None is one that has none but a name."""
    other = Listing(file.text + b"\n", caller.dialect, file.name, caller.folders)
    blocks = (other.block(line) for line in other.special.tolist())
    return [program_number(block) for block in blocks if begins_program(block)]


def first_block(listing: Listing) -> int:
    """Return the first line, but for a percent sign, of the file that was added last."""
    first = listing.files[-1].first
    while first < len(listing) - 1 and listing.meaning(first).percent:
        first += 1
    return first


def begins_program(block: Block) -> bool:
    """Whether a program begins at a block, by a number or by a name; M98 <NAME> would call one."""
    if is_named(block):
        return not any(word.address in "GM" for word in block.words)
    numbered = any(isinstance(i, Mark) and i.kind == "program_id" for i in block.items)
    return numbered or any(word.address == "O" for word in block.words)


def is_named(block: Block) -> bool:
    """Whether a name of a program stands in a block."""
    return any(isinstance(i, Mark) and i.kind == "program_name" for i in block.items)


def program_number(block: Block) -> int | None:
    """Return the number of the program that begins at a block."""
    for item in block.items:
        if isinstance(item, Word) and item.address == "O":
            return whole_number(item)
        if isinstance(item, Mark) and item.kind == "program_id":
            text = block.text[item.start + 1 : item.end].translate(BLANKS)
            return int(text) if text.isdecimal() else None
    return None
