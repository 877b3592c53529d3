"""Pieces to bytes: each template fills rows of one matrix, whose padding is then dropped."""

from __future__ import annotations

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.emit.manner import Task
from gcxform.emit.numbers import LARGEST, number_field
from gcxform.system.arrays import Bytes, Flags, Floats, Ints

PEELED_AT_MOST = 16
EIGHT = 8  # rows are padded to words of so many bytes


class Renderer:
    """Collects rendered templates and puts them in order."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.window = task.window
        self._parts: list[Bytes] = []
        self._done: list[tuple[Ints, Bytes]] = []
        self._rows = 0
        self._lines: Ints = np.zeros(0, np.int64)
        self._begun: Flags = np.zeros(0, np.bool_)

    def begin(self, lines: Ints) -> None:
        """Begin a template; its rows are pieces of these lines."""
        self._parts = []
        self._lines = lines
        self._rows = len(lines)
        self._begun = np.zeros(len(lines), np.bool_)

    def literal(self, text: bytes) -> None:
        """Add bytes that all rows have."""
        if b"\0" in text:
            where = self.task.location(int(self._lines[0]))
            raise InputError.one("GX505", "a block with a NUL byte has to be written anew", where)
        if text.strip():
            self._begun[:] = True
        self._where(text, None)

    def _where(self, text: bytes, rows: Flags | None) -> None:
        """Add bytes that all rows have, or some."""
        cell = np.frombuffer(text, np.uint8)
        if rows is None or rows.all():
            self._parts.append(np.broadcast_to(cell, (self._rows, len(cell))))
        elif len(cell):
            self._parts.append(np.where(rows[:, None], cell, np.uint8(0)))

    def copied(self, lines: Ints, slot: int) -> None:
        """Add numbers as they stand in the source lines."""
        number = self.window.first_number[lines] + slot
        start, end = self.window.number_start[number], self.window.number_end[number]
        self._bytes_between(start, end)

    def copied_text(self, lines: Ints, slot: int) -> None:
        """Add texts as they stand in the source lines."""
        self.copied(lines, slot)
        self._begun[:] = True

    def texts(self, lines: Ints, slot: int) -> list[str]:
        """Return the texts in a slot of source lines."""
        number = self.window.first_number[lines] + slot
        ends = zip(self.window.number_start[number], self.window.number_end[number], strict=True)
        return [self.window.text[int(a) : int(b)].decode("latin-1") for a, b in ends]

    def said(self, texts: list[bytes]) -> None:
        """Add texts, one for each row."""
        width = max(map(len, texts))
        padded = b"".join(text.ljust(width, b"\0") for text in texts)
        self._parts.append(np.frombuffer(padded, np.uint8).reshape(-1, width))
        self._begun[:] = True

    def _bytes_between(self, start: Ints, end: Ints) -> None:
        width = int((end - start).max(initial=0))
        text = np.frombuffer(self.window.text, np.uint8)
        at = start[:, None] + np.arange(width)
        inside = at < end[:, None]
        cells = text[np.minimum(at, len(text) - 1)] if len(text) else np.zeros(at.shape, np.uint8)
        self._parts.append(np.where(inside, cells, np.uint8(0)))

    def number(
        self,
        gap: bytes,
        address: str,
        whole: Floats,
        decimals: int,
        present: Flags,
        point: bool = True,
    ) -> None:
        """Add words, in the rows where they are present: an address and whole / 10**decimals.

        The gap goes before the word where the row has begun.
        """
        if not present.any():
            return
        long = present & (np.abs(whole) >= LARGEST * 10.0**decimals)
        if long.any():
            where = self.task.location(int(self._lines[np.argmax(long)]))
            raise InputError.one("GX503", f"{address} has more digits than a control takes", where)
        if gap:
            self._where(gap, present & self._begun)
        self._where(address.encode(), present)
        self._begun |= present
        zeros = self.task.manner.numbers.zeros
        self._parts.append(number_field(whole, decimals, zeros, present, point))

    def line_ends(self, lines: Ints, last: Flags, usual: bytes) -> None:
        """Add the line ends of the source lines; pieces before the last of a line get the usual."""
        start, end = self.window.end[lines], self.window.next[lines]
        if last.all():
            self._bytes_between(start, end)
            return
        cell = np.frombuffer(usual, np.uint8)
        self._parts.append(np.where(last[:, None], np.uint8(0), cell))
        self._bytes_between(start, np.where(last, end, start))

    def finish(self, places: Ints) -> None:
        """End the template; its rows stand at these places among all pieces written."""
        width = sum(part.shape[1] for part in self._parts)
        self._parts.append(np.zeros((self._rows, -width % EIGHT), np.uint8))
        self._done.append((places, np.concatenate(self._parts, axis=1)))

    def text(self, rows: int) -> tuple[bytes, Ints]:
        """Return the text of all rows in order, and the length of each."""
        if len(self._done) == 1:
            matrix = self._done[0][1]
        else:
            width = max((part.shape[1] for _, part in self._done), default=0)
            matrix = np.zeros((rows, width), np.uint8)
            for places, part in self._done:
                matrix[places, : part.shape[1]] = part
        return matrix.tobytes().translate(None, b"\0"), _lengths(matrix)


def _lengths(matrix: Bytes) -> Ints:
    """Return how many bytes of each row are no padding; eight of them are counted at once."""
    eights = np.ascontiguousarray(matrix != 0).view(np.uint64)  # rows of one text lie by columns
    counts = np.zeros(len(matrix), np.int64)
    for column in range(eights.shape[1]):
        counts += np.bitwise_count(eights[:, column])
    return counts


def groups_of(ways: Ints) -> list[Ints]:
    """Return the places of each value, by peeling off one value after another."""
    groups: list[Ints] = []
    left = np.arange(len(ways))
    while len(left) and len(groups) < PEELED_AT_MOST:
        same = ways[left] == ways[left[0]]
        groups.append(left[same])
        left = left[~same]
    if len(left):
        order = left[np.argsort(ways[left], kind="stable")]
        groups += np.split(order, np.flatnonzero(np.diff(ways[order])) + 1)
    return groups


def interleave(
    task: Task, copied: Flags, written: Ints, nth: Ints, text: bytes, lengths: Ints
) -> tuple[bytes, Ints, Ints]:
    """Return a window's new text and, for each of its lines, line and move that it came from.

    `copied` (live,) says which lines are copied; `written` (k,) are the lines of the pieces whose
    texts, of these lengths, follow one another in `text`. `nth` (k,) says which move of its line
    each piece is, and the same is returned for all lines of the text. Lines the control does not
    reach are copied.
    """
    window = task.window
    whole = np.concatenate([copied, _unreached(task)])
    keep = np.flatnonzero(whole)
    order = np.argsort(np.concatenate([keep, written]), kind="stable")
    source = np.concatenate([keep, written])[order]
    which = np.concatenate([np.zeros(len(keep), np.int64), nth])[order]
    if not len(written) and whole.all():
        return window.text, source, which
    if not len(order):
        return b"", source, which
    parts = _parts(task, order < len(keep), source, text, lengths)
    return b"".join(parts), source, which


def _unreached(task: Task) -> Flags:
    """Return which of the lines that the control does not reach are copied.

    In another dialect they would be foreign text: only blank lines and the final % stay, which has
    nothing beside it.
    """
    shapes = task.window.shape[task.read.live :]
    if not task.manner.crossing:
        return np.ones(len(shapes), np.bool_)
    percent = task.table.flag("percent", shapes) & task.manner.target.program_rule.has_percent
    blocks = [task.table.shapes.shapes[int(shape)].block for shape in shapes]
    bare = np.array([len(block.items) == 1 for block in blocks], np.bool_)
    blank = [not block.items and block.error is None for block in blocks]
    return np.asarray(percent & bare | np.array(blank, np.bool_))


def _parts(task: Task, is_copy: Flags, source: Ints, text: bytes, lengths: Ints) -> list[bytes]:
    """Return the pieces that make the new text: a slice for each run of neighbours.

    `is_copy` and `source` (lines of the new text,) say which are copies, and of which lines; those
    of the others follow one another in `text`. Slices are cut by columns: every other line of a
    contour is another run.
    """
    window, at = task.window, np.append(0, np.cumsum(lengths))
    begins = (is_copy[1:] != is_copy[:-1]) | (is_copy[1:] & (np.diff(source) != 1))
    first = np.flatnonzero(np.append(True, begins))
    last = np.append(first[1:], len(source)) - 1
    copied = is_copy[first]
    before = np.append(0, np.cumsum(~is_copy))
    begin = np.where(copied, window.start[source[first]], at[before[first]])
    end = np.where(copied, window.next[source[last]], at[before[last + 1]])
    cuts = zip(copied.tolist(), begin.tolist(), end.tolist(), strict=True)
    return [(window.text if copy else text)[a:b] for copy, a, b in cuts]
