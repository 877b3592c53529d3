"""Programs under cutter compensation: where they may be cut, and what passes may do to them.

While G41 or G42 is in force the blocks are a contour, and the control makes a path of it by looking
at the blocks that follow.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from gcxform.contract import Pass
from gcxform.toolpath.path import Toolpath

CODE = re.compile(rb"[Gg][ \t]*0*4[ \t]*([012])")
COMMENT = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")
AXIS = re.compile(rb"[XYZxyz]")
MENDED = "put the pass cutter-comp before it"


def whole_stretches(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts of whole lines that end where no compensation is in force and the tool has left.

    What is looked for are the letters; a text that is cut elsewhere is refused by the pass.
    """
    waiting: list[bytes] = []
    on, left = False, True
    for text in texts:
        waiting.append(text)
        codes = CODE.search(text) is not None
        plain = COMMENT.sub(b"", text) if codes or not left else b""
        found = list(CODE.finditer(plain))
        if found:
            on = found[-1][1] != b"0"
        if found or not left:
            left = not on and AXIS.search(plain, found[-1].end() if found else 0) is not None
        if left:
            yield b"".join(waiting)
            waiting = []
    if waiting:
        yield b"".join(waiting)


def check_compensated(step: Pass, before: Toolpath, after: Toolpath) -> None:
    """Refuse what a pass must not do under compensation. Raises InputError.

    It may not move the contour, because the control would offset another one; and the moves that
    begin and end compensation have to stay whole.
    """
    on = before.side != 0
    if not on.any() and not before.after_side:
        return
    rows = np.flatnonzero(on)
    if type(step).undo is not Pass.undo and len(rows):
        message = f"{step.name} moves a contour that the control offsets by the tool's radius"
        raise before.refuse("GX233", rows[:1], message, MENDED)
    ends = np.flatnonzero(on != np.append(before.after_side != 0, on[:-1]))
    lines = before.source[ends]
    if len(lines) and (_pieces(after, lines) != _pieces(before, lines)).any():
        wrong = ends[_pieces(after, lines) != _pieces(before, lines)]
        message = f"{step.name} cuts a move that begins or ends cutter compensation"
        raise before.refuse("GX233", wrong, message, MENDED)


def _pieces(path: Toolpath, lines: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many rows lines have, and whether the first is an arc, in one number."""
    at = np.searchsorted(path.source, lines, "left")
    counts = np.searchsorted(path.source, lines, "right") - at
    return np.asarray(2 * counts + (path.kind[np.minimum(at, len(path) - 1)] > 1))
