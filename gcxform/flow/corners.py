"""Corners in a program that is executed: the block behind one has to be the next line of its file.

Statements, calls, loops and jumps are no moves, and none of them is left in what is executed: `M99`
behind a corner would be overlooked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.corner_words import OUT
from gcxform.syntax.source import COMMENT, CORNER
from gcxform.system.arrays import Ints

if TYPE_CHECKING:
    from gcxform.flow.execution import Execution


def refuse_parted(run: Execution, dialect: type[Dialect], text: bytes, lines: Ints) -> None:
    """Raise InputError for a corner behind which another line is executed than the next.

    `lines` (n,) are those of the listing that the lines of the text are.
    """
    if not dialect.motion_rule.corners or CORNER.search(text) is None:
        return
    for nth in np.flatnonzero(np.diff(lines, append=-1) != 1).tolist():
        line = int(lines[nth])
        found = CORNER.search(COMMENT.sub(b"", run.listing.window.line(line)))
        if found is not None:
            message = (
                "behind a corner a move has to follow, and here is a statement, a call or an end"
            )
            raise run.listing.refusal(line, "GX213", message, OUT)
