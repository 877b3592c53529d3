"""Programs under cutter compensation: where they may be cut, and what passes may do to them.

While G41 or G42 is in force the blocks are a contour, and the control makes a path of it by looking
at the blocks that follow.

So a pass must keep such rows, and those that begin and end compensation, one for one and as they
are. Whatever else a pass declares or returns is refused here, for every pass at once; so are pieces
of an arc, which have corners when they are rounded.

What takes errors off moves every point, so before it the contour becomes the path of the centre by
itself, where the control does that in one way alone, or the machine file says in which: then
nothing depends on what is not known but the radius, which is asked for.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.contract.passes import CompensationPass, Pass, resolved
from gcxform.pipeline.chain import compensates
from gcxform.pipeline.plan import Plan
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source, has_sign
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.contours import contour_rows
from gcxform.toolpath.path import Toolpath

CODE = re.compile(rb"G[ \t]*0*4[ \t]*([012])")
COMMENT = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")
SMALL = 1 << 17  # bytes; so much may wait, and what is seen together is said together
TAIL = 1 << 13  # bytes; by the end of a text it is mostly decided what is open there
UNSEEN = sys.maxsize  # where a stretch begins that a text begins within
AXIS = re.compile(rb"[XYZ]")
WHICH = ("kind", "plane", "source", "nth", "form", "side")
WHERE = ("start", "end", "centre", "sweep", "radius")
RESOLVED = (
    "contours under G41 and G42 become the path of the tool's centre, by the radii that are known "
    "here: offsets that are set at the control act on them no more"
)
NOISE = 1e-9  # mm, rad; what computing a position in another way makes of it


def with_centre_path(plan: Plan, source: Source) -> tuple[Plan, tuple[str, ...]]:
    """Return a plan that resolves the contours of a program where errors are taken off them.

    The plan itself where it does so already, where nothing is to be resolved, and where parameters
    of the machine decide how that nobody has said. With it comes what the certificate says of that.
    """
    steps = plan.path_passes
    if resolved(steps) or not compensates(steps) or not _begins_contour(source):
        return plan, ()
    kinds = default_registry().passes.values()
    ways = [
        way
        for kind in kinds
        if issubclass(kind, CompensationPass)
        for way in kind.ways(plan.source, plan.machine.control if plan.machine else {})
    ]
    if len(ways) != 1:
        return plan, ()
    return replace(plan, passes=(ways[0], *plan.passes)), (RESOLVED,)


def _begins_contour(source: Source) -> bool:
    """Whether a program has G41 or G42 outside of its comments."""
    texts = (_bare(text) for text in source.windows() if has_sign(CODE, text))
    return any(found[1] != b"0" for text in texts for found in CODE.finditer(text))


def _bare(text: bytes) -> bytes:
    """Return a text in capital letters, without its comments."""
    return COMMENT.sub(b"", text).upper()


def whole_stretches(texts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield texts of whole lines that end where no compensation is in force and the tool has left.

    It has left with words of two of X, Y and Z: in every plane one of them is of the plane. What is
    looked for are the letters; a text that is cut elsewhere is refused by the pass. A long one that
    ends within a contour is cut before it.
    """
    waiting: list[bytes] = []
    size, stretch = 0, _Stretch()
    for text in texts:
        if stretch.begins >= 0 or has_sign(CODE, text):
            stretch.follow(text, size)
        waiting.append(text)
        size += len(text)
        at = stretch.begins if stretch.begins >= 0 else size
        if at == size or at > SMALL:
            whole = b"".join(waiting)
            yield whole[:at]
            waiting, size = [whole[at:]], size - at
            stretch.begins -= at if stretch.begins >= 0 else 0
    if size:
        yield b"".join(waiting)


class _Stretch:
    """The stretch that is open where a text ends: it `begins` there, or below 0 at none.

    One that begins in the line in which another is left is a part of that. `off` is whether G40 was
    the last code, `seen` the axes that have been named since.
    """

    def __init__(self, begins: int = -1) -> None:
        self.begins = begins
        self.off = False
        self.seen: set[bytes] = set()

    def follow(self, text: bytes, before: int) -> None:
        """Go on through a text of whole lines, with so many bytes before it.

        Only its end counts: where a stretch begins or is left there, nothing hangs on those before.
        """
        at = text.rfind(b"\n", 0, max(0, len(text) - TAIL)) + 1
        tail = _Stretch(UNSEEN)
        if at:
            tail._follow(_blanked(text[at:]), before + at)
        if at and tail.begins != UNSEEN:
            self.begins, self.off, self.seen = tail.begins, tail.off, tail.seen
        else:
            self._follow(_blanked(text), before)

    def _follow(self, plain: bytes, before: int) -> None:
        """Go on through a text without comments."""
        last, left = self.begins, -1  # where the last one began, and where in this text it was left
        codes, line = [*CODE.finditer(plain)], 0
        left = self._leave(plain, 0, codes[0].start() if codes else len(plain), left)
        for k, code in enumerate(codes):
            line = _line_start(plain, line, code.start())
            if self.begins < 0:
                self.begins = last if line < left else before + line
            last, self.off, self.seen = self.begins, code[1] == b"0", set()
            behind = codes[k + 1].start() if k + 1 < len(codes) else len(plain)
            left = self._leave(plain, code.end(), behind, left)

    def _leave(self, plain: bytes, at: int, behind: int, left: int) -> int:
        """Look for two axes behind G40; return where they are named, or what was known."""
        if self.begins < 0 or not self.off:
            return left
        for word in AXIS.finditer(plain, at, behind):
            self.seen.add(word[0])
            if len(self.seen) > 1:
                self.begins = -1
                return word.end()
        return left


def _blanked(text: bytes) -> bytes:
    """Return a text of the same length in capital letters, with blanks for its comments."""
    return COMMENT.sub(lambda found: b" " * len(found[0]), text).upper()


def _line_start(text: bytes, before: int, at: int) -> int:
    """Return where the line begins in which a place is; one before it begins at `before`."""
    for end in (b"\n", b"\r"):  # not from the start of the text: it may have none of them
        before = max(before, 1 + text.rfind(end, before, at))
    return before


def check_compensated(step: Pass, before: Toolpath, after: Toolpath) -> None:
    """Refuse what a pass must not do under compensation. Raises InputError.

    The contour, with the moves that begin and end it, has to stay as it is, row by row: the control
    offsets what it reads, and a point that is moved by a little, or a corner more, leads the centre
    of the tool elsewhere by more than that.
    """
    held = contour_rows(before)[:-1]
    if not held.any() and not after.side.any():
        return
    rows, new = np.flatnonzero(held), np.flatnonzero(contour_rows(after)[:-1])
    if type(step).undo is not Pass.undo and before.side.any():
        wrong, what = np.flatnonzero(before.side)[:1], "moves a contour"
    elif len(rows) != len(new):
        wrong, what = _of_other_count(before, after, rows, new), "cuts or joins moves of a contour"
    else:
        wrong, what = rows[_changed(before, rows, after, new)], "moves a contour"
    if len(wrong):
        message = f"{step.name} {what} that the control offsets by the tool's radius"
        raise before.refuse("GX233", wrong, message, put_before("cutter-comp", step.name))


def _of_other_count(before: Toolpath, after: Toolpath, rows: Ints, new: Ints) -> Ints:
    """Return the rows whose lines have not as many moves of a contour as they had."""
    lines = before.source[rows]
    had = np.searchsorted(lines, lines, "right") - np.searchsorted(lines, lines, "left")
    others = after.source[new]
    has = np.searchsorted(others, lines, "right") - np.searchsorted(others, lines, "left")
    found = rows[had != has]
    return found if len(found) else rows[:1]


def _changed(before: Toolpath, rows: Ints, after: Toolpath, new: Ints) -> Flags:
    """Return which rows (n,) of a contour are not what they were."""
    wrong: Flags = np.zeros(len(rows), np.bool_)
    for name in WHICH:
        wrong |= getattr(before, name)[rows] != getattr(after, name)[new]
    for name in WHERE:
        one, other = getattr(before, name)[rows], getattr(after, name)[new]
        same = (np.abs(one - other) <= NOISE) | (np.isnan(one) & np.isnan(other))
        wrong |= ~same.reshape(len(rows), -1).all(axis=1)
    return wrong
