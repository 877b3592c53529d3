"""Programs of small tests for controls that take one command in a block."""

from __future__ import annotations

import re
from itertools import pairwise

from gcxform.dialect.dialect import Dialect

COMMAND = re.compile(r"(?=[GM]\d)")
MOTION = re.compile(r"G[0-3]\b")


def written_for(dialect: type[Dialect], blocks: str) -> str:
    """Return blocks as a dialect takes them: where it has to be, a block for each command."""
    if not dialect.block_rule.one_command:
        return blocks
    motion, lines = "", list[str]()
    for line in blocks.split("\n"):
        starts = [found.start() for found in COMMAND.finditer(line)] or [0]
        head, *parts = (line[a:b].strip() for a, b in pairwise([0, *starts, len(line)]))
        for part in filter(None, [head, *parts]):
            motion = part.split(" ")[0] if MOTION.match(part) else motion
            lines.append(part if part[0] in "GM" else f"{motion} {part}")
    return "\n".join(lines) + "\n" * blocks.endswith("\n")
