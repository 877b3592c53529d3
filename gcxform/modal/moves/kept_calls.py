"""What is not known behind a call that is kept, as what it calls is not there to be read.

Positions, variables of the program, offsets (not where the control itself cuts), and what macros
set as they go: the motion code, G90 or G91, F. Each has to be programmed again before it is needed.
Units, plane and feed mode are taken to be as before where what is written is the same in any of
them, as for `absolute`; the certificate says so. Where a length, an arc or a time is made of what
is read they are needed as well.
"""

from __future__ import annotations

import numpy as np

from gcxform.modal.columns import fill
from gcxform.modal.findings import Findings
from gcxform.modal.line_notes import Unknown
from gcxform.modal.lines import Lines
from gcxform.modal.meaning.calls import computed_words
from gcxform.modal.meaning.tables import NUMBER
from gcxform.modal.state import CYCLE_OFF, Modes
from gcxform.system.arrays import Flags, Ints

UNKNOWN = "unknown"
SAID_BY = {
    "motion": "a motion code",
    "distance": "G90 or G91",
    "units": "G20 or G21",
    "plane": "G17, G18 or G19",
    "feed-mode": "G93, G94 or G95",
}
STRAIGHT = (NUMBER["G0"], NUMBER["G1"])
COMP = "cutter compensation", "lead the tool off the contour and cancel it with G40"
CYCLE = "a canned cycle", "end it with G80"
"""What may be in force at a call, and how it ends."""


def refuse_lost_modes(lines: Lines, modes: Modes) -> None:
    """Refuse lines that need a mode which a call may have changed, and calls in others."""
    _refuse_calls(lines, modes)
    if not lines.kept_calls and not lines.state.lost_modes:
        return
    moves = lines.flag("moves")
    needing = {"motion": moves & ~lines.flag("own_moves"), "distance": moves}
    if lines.reading.modes_count:
        needing["units"] = moves
        needing["plane"] = moves & ~np.isin(modes.motion, STRAIGHT)
        needing["feed-mode"] = moves & (modes.motion != NUMBER["G0"])
    for group, needs in needing.items():
        known = _known(lines, group)
        for line in _first_of_each(needs & ~known, lines):
            message = f"{SAID_BY[group]} is needed here: {_name_before(lines, line)} may have"
            hint = "write it in this block"
            if not _leaves_motion(lines, name := _name_before(lines, line)):
                hint += f', or say what the call does: ends = "{UNKNOWN}" in [control.macro.{name}]'
            lines.findings.add(line, "GX210", f"{message} changed it", hint=hint)
    lines.state.lost_by = _name_before(lines, lines.live)


def axes_led(lines: Lines, axes: str) -> Ints:
    """Return the axes (lines,), as bits, that calls have led to where their blocks say."""
    led = np.zeros(lines.live, np.int64)
    for call in lines.kept_calls:
        meaning = lines.table.meanings[int(lines.shape[call.line])]
        named = {axis for axis, _ in meaning.call_slots} & {*call.led} & {*axes}
        led[call.line] = sum(1 << axes.index(axis) for axis in named)
    return led


def _first_of_each(which: Flags, lines: Lines) -> list[int]:
    """Return the first line of those behind each call."""
    found = np.flatnonzero(which)
    behind = np.searchsorted([call.line for call in lines.kept_calls], found)
    _, first = np.unique(behind, return_index=True)
    return [int(line) for line in found[first][: Findings.enough]]


def _leaves_motion(lines: Lines, name: str) -> bool:
    """Whether a code leaves a motion code in force of which nothing is known."""
    code = lines.dialect.codes.get(name)
    return code is not None and code.group == "motion"


def _name_before(lines: Lines, line: int) -> str:
    before = [
        call.name
        for call in lines.kept_calls
        if call.line < line and (not call.ends or _leaves_motion(lines, call.name))
    ]
    return before[-1] if before else lines.state.lost_by


def _known(lines: Lines, group: str) -> Flags:
    """Return on which lines the code in force of a group is known, and keep the last of it."""
    lost = np.zeros(lines.live, np.bool_)
    for call in lines.kept_calls:
        lost[call.line] = not call.ends
        lost[call.line] |= group == "motion" and _leaves_motion(lines, call.name)
    said = lines.stated(group)
    known = fill(said & ~lost, said | lost, group not in lines.state.lost_modes).astype(np.bool_)
    if lines.live:
        gone = {group} if not known[-1] else set()
        lines.state.lost_modes = lines.state.lost_modes - {group} | gone
    return np.asarray(known)


def _refuse_calls(lines: Lines, modes: Modes) -> None:
    """Refuse calls under cutter compensation and in a canned cycle; note the others."""
    rule = lines.dialect.cycle_rule
    for call in lines.kept_calls:
        _note_computed(lines, call.line)
        drills = rule is not None and call.name in rule.patterns
        if modes.comp[call.line] or (modes.cycle[call.line] != CYCLE_OFF and not drills):
            what, end = COMP if modes.comp[call.line] else CYCLE
            message = f"{what} is in force at the call of {call.name}, whose moves are not known"
            lines.findings.add(
                call.line,
                "GX210",
                message,
                hint=f"{end} before the call, and begin it again behind",
            )
        if lines.dialect.translator is not None:
            continue  # it has said so
        lines.state.kept_calls[call.name] = lines.state.kept_calls.get(call.name, 0) + 1
        code = lines.dialect.codes.get(call.name)
        cuts = code is not None and bool(code.reason)
        said = f"{call.name} is kept: {_taken(call.ends, lines.reading.modes_count, cuts)}"
        lines.state.assumed.setdefault(said, None)


def _note_computed(lines: Lines, line: int) -> None:
    """Note the words of a call that are computed: they stay as they stand, and are compared."""
    text = lines.window.line(line).decode("latin-1")
    if computed := computed_words(lines.table.shapes.grammar.parse(text)):
        lines.unknown.append(Unknown(line, computed, ""))


def _taken(ends: str, modes_count: bool, cuts: bool) -> str:
    lost = "positions and variables" if cuts else "positions, offsets and variables"
    if ends == UNKNOWN or (not ends and modes_count):
        return f"{lost} are lost behind it" + ", and modes" * (not ends)
    if ends:
        return f"the machine file says that it ends {ends}; variables are lost behind it"
    modes = "units, plane, feed mode and compensation are as before"
    return f"{lost} are lost behind it, and {modes}"
