"""Proves a program that came back in its own lines: they say the blocks that were proved.

It is read as any other, and moves, modes and events are compared with those of the blocks. Besides,
its comments are those of the blocks, and it leaves the same values behind it as the one that was
read: lines that set them stay, and what they hang on has to stay with them.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from gcxform.diagnostics import Diagnostic, GcxformError, Location, SpellingError
from gcxform.dialect.dialect import Dialect
from gcxform.flow.speller import ASIDE, COMMENT
from gcxform.flow.translated import Translated
from gcxform.modal.state import Reading
from gcxform.proof.spelled_out import check_spelled_out
from gcxform.stamps.comment import without_lines
from gcxform.syntax.source import Source

LEFT = "what the program leaves to others would be another value"
STILL = "a line would call a cycle, or shift or turn coordinates, as no pass leaves any"
HINT = "the program is written anew"


def check_refolded(
    written: Source,
    blocks: bytes,
    source: Translated,
    dialect: type[Dialect],
    reading: Reading,
    against: Collection[re.Pattern[str]] = (),
) -> list[str]:
    """Check that a program says blocks that are proved, and keeps what `source` has besides.

    What is `against` a promise of a pass may be in no line that is executed. Return the names of
    values that only the control knew behind the program, and that it does not set any more. Raises
    SpellingError: then it has to be written another way.
    """
    try:
        found = check_spelled_out(written, blocks, dialect, reading)
    except GcxformError as error:
        (first, *_) = error.diagnostics
        raise SpellingError((first,)) from None
    wrong = ""
    if _comments(blocks) != _comments(found.text):
        wrong = "comments in their own lines would be others"
    left, now = source.translator.leaves(), found.translator.leaves()
    if any(now.get(name) != value for name, value in left.items() if value is not None):
        wrong = LEFT
    if not now.keys() <= left.keys():
        wrong = LEFT
    executed = {*found.executed_lines()[1:].tolist()} if against else ()
    if any(each.search(found.lines[line]) for each in against for line in executed):
        wrong = STILL
    if wrong:
        raise SpellingError((Diagnostic("GX501", wrong, Location(written.name), HINT),))
    lost = (name for name, value in left.items() if value is None)
    return sorted(name for name in lost if now.get(name, left) is not None)


def _comments(blocks: bytes) -> list[str]:
    """Return what is told in blocks, but for stamps, and for what goes along."""
    found = COMMENT.findall(without_lines(blocks).decode("latin-1"))
    return [each.strip() for each in found if not each.startswith(ASIDE)]
