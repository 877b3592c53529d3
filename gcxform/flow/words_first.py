"""Blocks that call or return and have words beside that: the words are executed first.

M98 runs behind what its block moves (Fanuc macro executor B-62093EN, as facts of `macros.md` have
it), and M99 returns behind it. The words are a block of their own then, in the place of the line.
P and L are those of the call, so beside them stands no code that takes one, and no cycle is on.
"""

from __future__ import annotations

from gcxform.dialect.dialect import Dialect
from gcxform.flow.listing import bare, code_name
from gcxform.flow.residual import Edit
from gcxform.syntax.tree import Block, Word

OF_CALL = {"M98": "PL", "M99": ""}
"""What calls or returns, and the addresses that are its own."""


def of_call(block: Block) -> list[Word]:
    """Return the words of a block that call or return, if others stand beside them."""
    items = bare(block)
    names = [name for word in block.words if (name := code_name(word)) in OF_CALL]
    if len(names) != 1 or not all(isinstance(item, Word) for item in items):
        return []
    mine = [w for w in block.words if w.address in OF_CALL[names[0]] or code_name(w) == names[0]]
    return mine if len(mine) < len(items) else []


def are_certain(block: Block, mine: list[Word], dialect: type[Dialect]) -> bool:
    """Whether what stands beside a call is executed as it stands, and takes none of its words."""
    rest = [item for item in bare(block) if isinstance(item, Word) and item not in mine]
    codes = [dialect.codes.get(code_name(word)) for word in rest if word.address == "G"]
    once = len({word.address for word in mine}) == len(mine)
    plain = not any(word.address in "MTPLO@^" for word in rest) and ";" not in block.text
    rule = dialect.cycle_rule
    cycles = {f"G{number}" for number in rule.cycles} if rule is not None else set()
    drills = not cycles.isdisjoint(map(code_name, block.words))
    return once and plain and not drills and all(c and not {*c.takes} & {*"PL"} for c in codes)


def without(block: Block, mine: list[Word]) -> list[Edit]:
    """Return the edits that take words out of a block, with the blanks behind each."""
    found: list[Edit] = []
    for word in mine:
        rest = block.text[word.end :]
        found.append((word.start, word.end + len(rest) - len(rest.lstrip(" \t")), ""))
    return found


def behind(text: bytes, block: Block) -> bytes:
    """Return what was written for the words of a block, with what calls or returns behind it."""
    words = text.rstrip(b"\r\n")
    call = (block.text[word.start : word.end].encode("latin-1") for word in of_call(block))
    return b" ".join(filter(None, [words, *call])) + text[len(words) :]
