"""What a control refuses whatever the block does: lines too long, numbers a word cannot have."""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from gcxform.catalogue.remedies import tool_said
from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.tables import NURBS
from gcxform.modal.state import CYCLE_OFF, SPEED, Modes
from gcxform.system.arrays import Flags
from gcxform.system.distinct import one_of
from gcxform.toolpath.path import Event, FeedMode, Kind

NOT_NEGATIVE = {"S": "a speed", "T": "a tool number", "DWELL": "a dwell"}
NAMES_TOOL = frozenset({"T", "M61"})
ALL_SPINDLES = -1.0
FED = (Kind.LINE, Kind.ARC_CW, Kind.ARC_CCW)
SILENT = re.compile(rb"\([^)]*\)|;.*|\s")


def refuse_limits(lines: Lines, modes: Modes, events: Iterable[Event]) -> None:
    """Add what is refused to the findings."""
    _too_long(lines)
    _negative(lines, events)
    _no_such_tool(lines, events)
    _other_spindle(lines, events)
    _number_too_large(lines)
    _turns_without_arc(lines, modes)
    _turns_without_speed(lines, modes)


def without_blanks(line: bytes) -> int:
    """Return the length of a line without blanks and comments."""
    return len(SILENT.sub(b"", line))


def _too_long(lines: Lines) -> None:
    limit, window = lines.dialect.text_rule.line_length, lines.window
    if not limit:
        return
    length = (window.end - window.start)[: lines.live]
    for line in np.flatnonzero(length > limit).tolist():
        blanks = lines.dialect.text_rule.length_without_blanks
        long = without_blanks(window.line(line)) if blanks else int(length[line])
        if long > limit:
            message = f"the block has {long} characters; {lines.dialect.name} takes {limit}"
            lines.findings.add(line, "GX219", message)


def _negative(lines: Lines, events: Iterable[Event]) -> None:
    """Refuse speeds, tools, times and feeds below zero."""
    for event in events:
        if event.what in NOT_NEGATIVE and any(value < 0 for _, value in event.values):
            message = f"{NOT_NEGATIVE[event.what]} cannot be negative"
            lines.findings.add(event.line - lines.window.first_line, "GX219", message)
    feed = lines.word("F")
    if feed is None:
        return
    for line in np.flatnonzero(feed[1] & (feed[0] < 0))[: Findings.enough].tolist():
        lines.findings.add(line, "GX219", "a feed cannot be negative", "F")


def _no_such_tool(lines: Lines, events: Iterable[Event]) -> None:
    """Refuse tools that are not in the table, where a table is given and the control looks."""
    tools = lines.reading.tools
    if not tools or not lines.dialect.tool_rule.in_table:
        return
    for event in events:
        named = event.values[0][1] if event.what in NAMES_TOOL and event.values else 0.0
        if named > 0 and named not in tools:
            message, hint = f"the tool table has no tool {named:g}", tool_said(named)
            lines.findings.add(event.line - lines.window.first_line, "GX213", message, hint=hint)


def _other_spindle(lines: Lines, events: Iterable[Event]) -> None:
    """Refuse all spindles but the first, which is the only one that every machine has."""
    for event in events:
        if event.what == "$" and event.values[0][1] not in (0.0, ALL_SPINDLES):
            message = f"${event.values[0][1]:g} is another spindle than the first"
            lines.findings.add(event.line - lines.window.first_line, "GX213", message)


def _number_too_large(lines: Lines) -> None:
    """Refuse sequence numbers that the control cannot count to."""
    most = lines.dialect.text_rule.largest_number
    number = lines.word("N") if most else None
    if number is None:
        return
    for line in np.flatnonzero(number[1] & (number[0] > most))[: Findings.enough].tolist():
        message = f"the sequence number is larger than {most}, which {lines.dialect.name} refuses"
        lines.findings.add(line, "GX219", message, "N")


def _turns_without_arc(lines: Lines, modes: Modes) -> None:
    """Refuse the word for the turns of an arc where there is none."""
    address = lines.dialect.arc_rule.turns
    turns = lines.word(address) if address else None
    if turns is None:
        return
    arc = (modes.motion >= Kind.ARC_CW) & ~lines.flag("own_moves")
    arc &= lines.flag("moves") | lines.flag("has_centre")
    arc |= modes.motion == NURBS  # a weight
    for line in np.flatnonzero(turns[1] & ~arc & (modes.cycle == CYCLE_OFF)).tolist():
        lines.findings.add(line, "GX203", f"{address} belongs to an arc, and this is none", address)


def _turns_without_speed(lines: Lines, modes: Modes) -> None:
    """Refuse feeds per turn of a spindle whose speed is 0, as it is until an S word."""
    if not lines.dialect.feed_rule.turns_need_speed:
        return
    turns = _turning(lines)
    moves = (lines.flag("moves") | lines.stated("motion")) & ~lines.flag("own_moves")
    feeds = one_of(modes.motion, FED) & (moves | lines.flag("in_machine"))
    feeds &= (modes.feed_mode == FeedMode.PER_TURN) & ~turns
    for line in np.flatnonzero(feeds)[: Findings.enough].tolist():
        message = "a feed per turn, but the speed of the spindle is 0"
        lines.findings.add(line, "GX204", message, hint="write an S word before it")


def _turning(lines: Lines) -> Flags:
    """Return the lines on which a speed is in force that is not 0, or not known."""
    word, before = lines.word("S"), bool(lines.state.memory[SPEED])
    if word is None or not lines.live:
        return np.full(lines.live, before)
    said = np.maximum.accumulate(np.where(word[1], np.arange(lines.live), -1))
    found = np.where(said < 0, before, word[0][said] != 0.0)
    lines.state.memory[SPEED] = int(found[-1:].any())
    return found
