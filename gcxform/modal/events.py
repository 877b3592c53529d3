"""What happens between the moves of a window: spindle, coolant, tool, stops, dwells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.modal.lines import Lines
from gcxform.system.arrays import Flags, Ints
from gcxform.system.records import Records
from gcxform.toolpath.path import Event

SWITCHED = "/"
"""Before the name of an event that a switch of the control decides on."""


def events_of(
    lines: Lines, rows: Ints, calls: Flags, within: Sequence[tuple[int, int, Event]] = ()
) -> tuple[Event, ...]:
    """Return what happens between the moves, in the order of execution.

    `rows` (n,) are the lines of the moves, `calls` (lines,) tells which call a cycle. `within` is
    what happens within cycles: the first line of a stretch, how many moves behind its first, and
    what. A piece of a line that only
    the machine can compute is an event as well: its text, which has to stay. One in a block with a
    slash has that in its name where nobody said whether such blocks are executed.
    """
    events: list[Event] = []
    after: list[bool] = []
    having = np.flatnonzero(lines.flag("has_events"))
    begin, end = np.searchsorted(rows, having), np.searchsorted(rows, having, "right")
    columns = [c.tolist() for c in (having, lines.shape[having], lines.first[having], begin, end)]
    meanings, first_line = lines.table.meanings, lines.window.first_line
    slash = lines.reading.blocks_with_a_slash(lines.dialect)
    rule = lines.dialect.motion_rule
    over_hole = rule.over_hole(lines.dialect.m_codes) if calls.any() else frozenset()
    for line, number, first, first_row, last_row in zip(*columns, strict=True):
        for shape in meanings[number].events:
            if shape.aside and slash == "skip":
                continue
            values = tuple(_value(lines, shape.what, a, first + n) for a, n in shape.slots)
            where = last_row if shape.after else first_row
            if shape.what in over_hole and calls[line]:
                where = min(first_row + 1, last_row)
            switched = not slash and (meanings[number].deleted or shape.aside)
            what = SWITCHED + shape.what if switched else shape.what
            events.append(Event(where, what, values, line + first_line))
            after.append(shape.after)
    if not within and not lines.unknown:
        return Records(events)
    rank = [2 * each for each in after]
    begun = np.searchsorted(rows, [first for first, _, _ in within]).tolist()
    for row, (_, behind, event) in zip(begun, within, strict=True):
        events.append(Event(row + behind, event.what, event.values, event.line, True))
        rank.append(1)
    open_rows = np.searchsorted(rows, [each.line for each in lines.unknown]).tolist()
    for each, row in zip(lines.unknown, open_rows, strict=True):
        events.append(Event(row, each.text, (), each.line + first_line))
        rank.append(-1)
    order = np.lexsort((rank, [event.line for event in events], [event.row for event in events]))
    return Records(events[number] for number in order.tolist())


def _value(lines: Lines, what: str, address: str, number: int) -> tuple[str, float]:
    """Return a word of an event; a time in seconds where the dialect knows its unit."""
    value = float(lines.window.value[number])
    if value != value:
        return f"{address}?", 0.0  # what it is stands in an event of its own
    if what != "DWELL":
        return address, value
    unit = lines.pointless.dwell(address, int(lines.window.decimals[number])) if value else 1.0
    return ("increments", value) if unit is None else ("seconds", value * unit)
