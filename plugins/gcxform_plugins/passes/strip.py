"""`strip`: comments and blanks are left out."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated

import gcxform as gx
from gcxform_plugins.dialects.linuxcnc import LinuxCNC

BETWEEN = re.compile(r"([A-Za-z]?)[ \t]+(?=([A-Za-z]?))")
"""Blanks, and the letters beside them."""


@dataclass(frozen=True)
class Strip(gx.TextPass):
    """Leave out comments, blanks and empty blocks. Comments that a control executes stay."""

    name = "strip"
    comments: Annotated[bool, gx.Option("leave out comments")] = True
    blanks: Annotated[bool, gx.Option("leave out blanks between and in words")] = True
    empty: Annotated[bool, gx.Option("leave out blocks that hold nothing")] = True

    def edit(self, block: gx.Block, number: int) -> str | None:
        """Return the block without what is to be left out."""
        parts, at = [], 0
        for item in block.items:
            gap, text = block.text[at : item.start], block.text[item.start : item.end]
            at = item.end
            comment = isinstance(item, gx.Comment)
            if comment and self.comments and not _is_active(text, block):
                continue
            if self.blanks:
                gap = "" if not gap.strip(" \t") else gap
                told = comment or getattr(item, "kind", "") == "output"
                text = text if told else _packed(text)
            parts += [gap, text]
        rest = block.text[at:]
        text = "".join(parts) + (rest if not self.blanks or rest.strip(" \t") else "")
        if self.comments and not self.blanks and len(text) < len(block.text):
            text = text.rstrip(" \t")
        return None if self.empty and not text.strip(" \t") else text


def _packed(text: str) -> str:
    """Return a word or a statement without blanks, but one between letters: `5 MOD ROUND[2]`."""
    return BETWEEN.sub(lambda found: found[1] + " " * bool(found[1] and found[2]), text)


def _is_active(comment: str, block: gx.Block) -> bool:
    """Whether a control does something with a comment: an alarm shows the one in its block."""
    beside = (item for item in block.items if not isinstance(item, gx.Word | gx.Comment))
    return LinuxCNC.text_rule.executes(comment) or any(hasattr(item, "tree") for item in beside)
