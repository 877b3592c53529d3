"""Writes blocks of words as a program in a language of its own, line after line.

`gcxform/proof/spelled_out.py` reads what comes out of here.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import PurePath

from gcxform.diagnostics import Diagnostic, InputError, Location
from gcxform.flow.speller import Speller, UnspeakableError
from gcxform.stamps.comment import OPEN_SEAL

INCHES = re.compile(rb"(?<![A-Z0-9.])G[ \t]*0*20(?![0-9.])", re.IGNORECASE)
MILLIMETRES = re.compile(rb"(?<![A-Z0-9.])G[ \t]*0*21(?![0-9.])", re.IGNORECASE)
COMMENTS = re.compile(rb"\([^()]*\)|;.*")
HINT = "let a pass write it in another way, or write for another dialect"


def spelled_out(
    blocks: Sequence[bytes],
    source: Sequence[int],
    kind: type[Speller],
    file: str,
    inch: bool,
    inert: frozenset[str] = frozenset(),
    asides: bool = False,
    seals: bool = False,
    drills: bool = True,
    tool: int | None = None,
) -> tuple[bytes, list[int], Counter[str]]:
    """Return a program for blocks, for each of its lines the line that it is for, what is left out.

    `source` are lines of the program, from 0, of which the blocks are. `inert` are M codes of the
    target that leave its axes where they stand; `asides`: whether a translator of the language has
    put into comments what goes along. `seals`: its last comment is a seal that is still open.
    `drills`: moves of holes may be said as cycles. `tool`: the one in the spindle before the first
    block, where that is known.
    Raises InputError for a block that cannot be said.
    """
    speller = kind(PurePath(file).stem, inch_first(blocks, inch))
    speller.inert, speller.asides, speller.drills = inert, asides, drills
    if tool is not None:
        speller.in_spindle = str(tool)
    lines, of = list[str](), list[int]()
    for block, line in zip(blocks, source, strict=True):
        text = block.decode("latin-1").rstrip("\r\n")
        try:
            said = speller.lines(text)
        except UnspeakableError as why:
            where = Location(file, line + 1, 1, text, max(1, len(text)))
            raise InputError((Diagnostic("GX501", str(why), where, why.hint or HINT),)) from None
        lines += said
        of += [line] * len(said)
    begins = [(line, source[0] if source else 0) for line in speller.opening()]
    both = [*begins, *speller.gathered([*zip(lines, of, strict=True)])]
    lines, of = [line for line, _ in both], [line for _, line in both]
    ends = [*(speller.lines(f"({OPEN_SEAL})") if seals else ()), *speller.closing()]
    lines, of = speller.numbered([*lines, *ends]), [*of, *[of[-1] if of else 0] * len(ends)]
    end = "\r\n" if blocks and blocks[0].endswith(b"\r\n") else "\n"
    return "".join(f"{line}{end}" for line in lines).encode("latin-1"), of, speller.left_out


def inch_first(blocks: Sequence[bytes], inch: bool) -> bool:
    """Whether blocks begin in inches; `inch`: it is so where none says it."""
    codes = (COMMENTS.sub(b"", block) for block in blocks)
    units = (block for block in codes if INCHES.search(block) or MILLIMETRES.search(block))
    first = next(units, None)
    return inch if first is None else INCHES.search(first) is not None
