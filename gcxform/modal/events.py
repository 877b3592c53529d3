"""What happens between the moves of a window: spindle, coolant, tool, stops, dwells."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gcxform.modal.lines import LENGTHS, Lines
from gcxform.toolpath.path import Event

Ints = NDArray[np.int64]


def events_of(lines: Lines, rows: Ints) -> tuple[Event, ...]:
    """Return what happens between the moves, in the order of execution."""
    events = []
    having = np.flatnonzero(lines.flag("has_events"))
    row = np.searchsorted(rows, having)
    on_move = np.isin(having, rows)
    for line, at, moves in zip(having.tolist(), row.tolist(), on_move.tolist(), strict=True):
        first = int(lines.first[line])
        meaning = lines.table.meanings[int(lines.shape[line])]
        for event in meaning.events:
            values = tuple(_value(lines, event.what, a, first + n) for a, n in event.slots)
            where = at + (moves and event.after)
            events.append(Event(where, event.what, values, line + lines.window.first_line))
    return tuple(events)


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
