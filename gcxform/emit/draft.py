"""The draft of a template: its fields so far, in the spelling of the target.

Whoever writes a part of a block adds fields here, so that gaps between words come out right whoever
wrote the word before.
"""

from __future__ import annotations

import re
from typing import NoReturn

from gcxform.dialect.dialect import Dialect
from gcxform.emit.expressible import CannotSayError
from gcxform.emit.fields import Field, Literal
from gcxform.syntax.tree import Item

SLASH = re.compile(rb"/[0-9]?")


class Draft:
    """The fields of one template; `text` is the block of the source, `gap` stands between words."""

    def __init__(self, text: str, target: type[Dialect], gap: bytes) -> None:
        self.text = text
        self.target = target
        self.gap = gap
        self.fields: list[Field] = []

    def literal(self, lead: bytes, text: str) -> None:
        """Add a text behind what stands before it, if there is anything of both."""
        if lead or text:
            self.fields.append(Literal(lead + text.encode("latin-1")))

    def said(self, start: int, end: int) -> str:
        """Return a piece of a word, in capitals where the target knows nothing else."""
        text = self.text[start:end]
        return text if self.target.text_rule.lower_case else text.upper()

    def gap_before(self, lead: bytes) -> bytes:
        """Return what stands before a word: its own `lead`, or the usual gap, if words precede.

        A slash is no word: what follows it stands as near as it stood.
        """
        words = [f for f in self.fields if not (isinstance(f, Literal) and SLASH.fullmatch(f.text))]
        return lead or (self.gap if words else b"")

    def ends_in_word(self) -> bool:
        """Whether something other than blanks has been written."""
        return any(not isinstance(f, Literal) or f.text.strip() for f in self.fields)

    def refuse(self, item: Item, what: str, hint: str = "") -> NoReturn:
        """Raise CannotSayError for what an item of the block says."""
        self.raise_at(item, f"{self.target.name} cannot say {what}", hint)

    def raise_at(self, item: Item, message: str, hint: str = "") -> NoReturn:
        """Raise CannotSayError at an item of the block."""
        raise CannotSayError(item.start, item.end - item.start, message, hint)
