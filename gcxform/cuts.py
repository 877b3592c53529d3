"""Programs in windows that divide no cut: a cut is what is between two rapids."""

from __future__ import annotations

import re
from collections.abc import Iterator

MOTION = re.compile(rb"[Gg][ \t]*0*([0123])(?![0-9.])")
COMMENT = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")


def whole_cuts(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts of whole lines which begin, but for the first, with the rapid after a cut.

    What is looked for are the letters; a text that begins otherwise is refused by the pass.
    """
    waiting = b""
    for text in texts:
        waiting += text
        if at := _last_rapid(waiting):
            yield waiting[:at]
            waiting = waiting[at:]
    if waiting:
        yield waiting


def _last_rapid(text: bytes) -> int:
    """Return where the last line begins that changes from feeds to rapids; 0 if there is none."""
    blank = COMMENT.sub(lambda found: b" " * len(found[0]), text)
    end, rapid = len(blank), -1
    for found in reversed([*MOTION.finditer(blank)]):
        if found[1] == b"0":
            rapid = found.start()
        elif rapid >= 0:
            end = rapid
            break
    else:
        return 0
    return max(blank.rfind(b"\n", 0, end), blank.rfind(b"\r", 0, end)) + 1
