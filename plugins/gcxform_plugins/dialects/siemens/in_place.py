"""Lines of a SINUMERIK that are written again in a program of its own."""

from __future__ import annotations

import re
from collections.abc import Sequence

import gcxform as gx
from gcxform_plugins.dialects.siemens.learning import Learning
from gcxform_plugins.dialects.siemens.spelling import spelled
from gcxform_plugins.dialects.siemens.structure import code

STEPPED = re.compile(  # it begins with letters that may be looked for one by one
    r"[=Gg](?:(?<==)[ \t]*[Ii][Cc][ \t]*\("
    r"|(?<=[Gg])(?<![A-Za-z0-9_][Gg])[ \t]*0*91(?![0-9.]))"
)
HEAD = re.compile(
    r"[ \t]*(?:[N:][ \t]*[0-9]+(?![0-9.]))?(?:[ \t]*[A-Z_]{2}[A-Z0-9_]*[ \t]*:(?!=))?[ \t]*",
    re.IGNORECASE,
)
NUMBER = re.compile(r"N[0-9]+[ \t]+")
CODES = frozenset(("0", "1", "2", "3", "9", "17", "18", "19", "40", "60", "64", "90", "91", "94"))
"""G codes of which blocks say all that there is: not how near to a corner (G642), nor F (G71)."""
PLAIN = frozenset("NFMS")
PLACES = frozenset((*"XYZIJKF", "CR", "AR", "TURN", "I1", "J1", "K1", "CIP"))
"""Words of which they do, too; the second also where they are computed. Of a rotary axis they say
where it turns to, and not which way."""
KINDS = frozenset(("word", "value", "named", "function", "expression", "command"))


class InPlace(Learning):
    """Says what stands in the place of a line whose blocks have changed."""

    stepped = STEPPED

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks; None where that is not known."""
        return spelled(self.lines[line], blocks)

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became, with its head and its comment.

        None for a line that has more than blocks say, and for steps: they would stay in force.
        """
        if not all(map(self._is_said, self.items(line))) or any(map(STEPPED.search, said)):
            return None
        text = self.lines[line]
        head, bare = HEAD.match(text), code(text, True).rstrip()
        first, *more = [each.partition(";")[0].rstrip() for each in said]
        start = head[0] if head else ""
        return "\n".join([f"{start}{NUMBER.sub('', first)}{text[len(bare) :]}", *more])

    def _is_said(self, item: gx.Item) -> bool:
        if item.kind in ("label", "comment"):
            return True
        if item.kind == "word" and item.name == "G":
            return (item.numbers[0].lstrip("0") or "0") in CODES
        plain = item.kind == "word" and item.name in PLAIN
        return plain or (item.kind in KINDS and item.name in PLACES)

    def counts(self, line: str) -> bool:
        """Whether a line has a word that counts from where its axis stands."""
        return STEPPED.search(code(line)) is not None
