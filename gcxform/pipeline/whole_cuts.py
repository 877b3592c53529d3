"""Programs in windows that divide nothing that is to be seen as a whole.

A cut is what is between two rapids, a section what is between a tool length and the next G49, and
a spline of weights and knots is known at its G5.3.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import pairwise

from gcxform.pipeline.cutter_comp import whole_stretches
from gcxform.pipeline.plan import Plan
from gcxform.syntax.source import before_corners

MOTION = re.compile(rb"[Gg][ \t]*0*([0123])(?![0-9.])")
LENGTH = re.compile(rb"[Gg][ \t]*0*4([39])(?:\.0*)?(?![0-9.])")
KNOTS = re.compile(rb"[Gg][ \t]*0*5[ \t]*\.[ \t]*([23])0*(?![0-9])")
CYCLES = re.compile(rb"[Gg][ \t]*(?:(7[346]|8[1-9])|80)(?![0-9.])")
BEGUN = re.compile(rb"G[78 \t]"), re.compile(rb"g[78 \t]")
"""With these they begin, which are found sooner, as each begins with one letter."""
PART = 1 << 17  # bytes
COMMENT = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")


def undivided(texts: Iterator[bytes], plan: Plan) -> Iterator[bytes]:
    """Yield texts of whole lines that divide nothing that a plan has to see as a whole."""
    texts = _in_parts(texts)
    demands = [step.demands for step in plan.path_passes]
    if plan.machine_reading.curves and "G5.2" in plan.source.codes:
        texts = _divided(texts, _last_spline)
    if any(each.resolves for each in demands):
        texts = whole_stretches(texts)
    if any(each.reads_vectors for each in demands):
        return whole_sections(texts)
    return whole_cuts(texts) if any(each.whole_cuts for each in demands) else texts


def _in_parts(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts in smaller parts where they drill: a line of a canned cycle is many moves."""
    drills = False
    for text in texts:
        drilled, drills = _drilled(text, drills)
        at = 0
        while 2 * drilled > len(text) and len(text) - at > PART:
            end = before_corners(text, text.rfind(b"\n", at, at + PART) + 1)
            if end <= at:
                break
            yield text[at:end]
            at = end
        yield text[at:]


def _drilled(text: bytes, drills: bool) -> tuple[int, bool]:
    """Return about how many bytes of a text are lines of cycles, and whether one is in force."""
    found = at = 0
    if not any(begun.search(text) for begun in BEGUN):
        return len(text) * drills, drills
    for code in CYCLES.finditer(text):
        found += (code.start() - at) * drills
        at, drills = code.start(), code[1] is not None
    return found + (len(text) - at) * drills, drills


def whole_cuts(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts of whole lines which begin, but for the first, with the rapid after a cut.

    What is looked for are the letters; a text that begins otherwise is refused by the pass.
    """
    return _divided(texts, _last_rapid)


def whole_sections(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts of whole lines which begin, but for the first, with G43 after a G49."""
    return _divided(texts, _last_section)


def _divided(texts: Iterator[bytes], place: Callable[[bytes], int]) -> Iterator[bytes]:
    waiting = b""
    for text in texts:
        waiting += text
        if at := place(COMMENT.sub(lambda found: b" " * len(found[0]), waiting)):
            yield waiting[:at]
            waiting = waiting[at:]
    if waiting:
        yield waiting


def _last_spline(blank: bytes) -> int:
    """Return where the line begins with which an open spline begins; the end if none is open."""
    opens = -1
    for found in KNOTS.finditer(blank):
        if found[1] == b"3":
            opens = -1
        elif opens < 0:
            opens = found.start()
    return len(blank) if opens < 0 else _line_of(blank, opens)


def _last_section(blank: bytes) -> int:
    """Return where the last line begins that has G43 after G49; 0 if there is none."""
    lengths = [*LENGTH.finditer(blank)]
    for one, other in reversed([*pairwise(lengths)]):
        if (one[1], other[1]) == (b"9", b"3"):
            line = _line_of(blank, other.start())
            return line if line > one.start() else 0
    return 0


def _last_rapid(blank: bytes) -> int:
    """Return where the last line begins that changes from feeds to rapids; 0 if there is none."""
    end, rapid = len(blank), -1
    for found in reversed([*MOTION.finditer(blank)]):
        if found[1] == b"0":
            rapid = found.start()
        elif rapid >= 0:
            end = rapid
            break
    else:
        return 0
    return _line_of(blank, end)


def _line_of(blank: bytes, end: int) -> int:
    return max(blank.rfind(b"\n", 0, end), blank.rfind(b"\r", 0, end)) + 1
