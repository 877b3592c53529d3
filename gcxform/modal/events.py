"""What happens between the moves of a window: spindle, coolant, tool, stops, dwells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gcxform.modal.lines import LENGTHS, Lines
from gcxform.toolpath.path import Event

Ints = NDArray[np.int64]


def events_of(
    lines: Lines, rows: Ints, within: Sequence[tuple[int, int, Event]] = ()
) -> tuple[Event, ...]:
    """Return what happens between the moves, in the order of execution.

    `rows` (n,) are the lines of the moves. `within` is what happens within canned cycles: the
    first line of a stretch, how many moves behind its first, and what.
    """
    events: list[tuple[tuple[int, int, int], Event]] = []
    having = np.flatnonzero(lines.flag("has_events"))
    begin, end = np.searchsorted(rows, having), np.searchsorted(rows, having, "right")
    for line, first_row, last_row in zip(
        having.tolist(), begin.tolist(), end.tolist(), strict=True
    ):
        first = int(lines.first[line])
        meaning = lines.table.meanings[int(lines.shape[line])]
        for shape in meaning.events:
            values = tuple(_value(lines, shape.what, a, first + n) for a, n in shape.slots)
            where = last_row if shape.after else first_row
            event = Event(where, shape.what, values, line + lines.window.first_line)
            events.append(((where, event.line, 2 * shape.after), event))
    if not within:
        return tuple(event for _, event in events)
    offsets = np.searchsorted(rows, [line for line, _, _ in within]).tolist()
    for offset, (_, behind, event) in zip(offsets, within, strict=True):
        row = offset + behind
        moved = Event(row, event.what, event.values, event.line, True)
        events.append(((row, event.line, 1), moved))
    return tuple(event for _, event in sorted(events, key=lambda item: item[0]))


def _value(lines: Lines, what: str, address: str, number: int) -> tuple[str, float]:
    """Return a word of an event; a time in seconds where the dialect knows its unit."""
    value = float(lines.window.value[number])
    if what != "DWELL":
        return address, value
    pointless = lines.window.decimals[number] < 0 and address in LENGTHS
    if pointless and value and lines.dialect.point_required:
        return "increments", value
    if lines.dialect.dwell_point_is_seconds and lines.window.decimals[number] >= 0:
        return "seconds", value
    return "seconds", value * lines.dialect.dwell[address]
