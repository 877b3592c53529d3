"""The proof of zeros: what a program sets from where the axes stand is set where it was.

G92, G10 and G28.1 leave something in the control that outlives the program. Behind moves that were
compensated the axes stand elsewhere, and G92 then has other words for the same zero.

    z   a zero that a block of the source sets, as its reader tells it: of a work offset, of G92
        (also the one that G92.3 restores), of G52, its angle; a place that G28.1 stores
    z'  the same of the output, whose reader takes the axes for where its own blocks have led them

Claimed: the blocks of the output that set zeros are those of the source, in their order and from
the same lines, and behind each of them, for every zero and axis,

    |z' - z| <= 1e-9 mm (deg),   or neither is known.

Both are positions in the words of the machine, which no pass here changes: a pass that compensates
has other commands for the same places, and a zero is no command.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from gcxform.modal.frame_state import FrameState
from gcxform.proof.feeds import Wrong
from gcxform.proof.trace import Trace

SAME = 1e-9  # mm, deg
Zeroed = tuple[tuple[int, FrameState], ...]


def zeros_differ(old: Zeroed, new: Zeroed, trace: Trace) -> Iterator[Wrong]:
    """Yield what is wrong with the zeros that a window sets."""
    for (line, before), (output, after) in zip(old, new, strict=False):
        if trace.line_of(output) != line:
            yield Wrong("a zero is set from another block", line, output)
        elif name := _moved(before, after):
            yield Wrong(f"{name} would be elsewhere", line, output)
    if len(old) != len(new):
        rest = old[len(new) :] or new[len(old) :]
        line = rest[0][0] if len(old) > len(new) else trace.line_of(rest[0][0])
        yield Wrong("a block that sets a zero is missing or too many", line)


def _moved(before: FrameState, after: FrameState) -> str:
    """Return the name of a zero that is elsewhere, or nothing."""
    zeros, others = dict(_zeros(before)), dict(_zeros(after))
    wrong = (name for name in zeros.keys() | others.keys() if not _same(zeros, others, name))
    return next(iter(sorted(wrong)), "")


def _zeros(state: FrameState) -> Iterator[tuple[str, Sequence[float]]]:
    """Yield the zeros of a state by what they are called."""
    yield from _of_g92(state)
    yield "the zero of G52", state.local
    for work, zero in state.zeros.items():
        yield f"the zero of {work}", zero
    for work, angle in state.rotation.items():
        yield f"the angle of {work}", (angle,)
    for code, place in state.homes.items():
        yield f"the point of {code}", [place.get(axis, np.nan) for axis in state.axes]


def _of_g92(state: FrameState) -> Iterator[tuple[str, Sequence[float]]]:
    yield "the zero of G92", state.preset
    yield "the zero that G92.3 restores", state.held


def _same(
    zeros: Mapping[str, Sequence[float]], others: Mapping[str, Sequence[float]], name: str
) -> bool:
    """Whether a zero is at the same place; one that is not there is not known."""
    old, new = (np.array(each.get(name, (np.nan,))) for each in (zeros, others))
    return bool(((np.abs(new - old) <= SAME) | (np.isnan(new) & np.isnan(old))).all())
