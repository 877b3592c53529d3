"""Cutter compensation as it is read: which side is in force on each line, and for what radius.

The contour stays as it is programmed; what the control makes of it is the business of a pass. Here
is settled what a block says: G41 and G42, whose tool D names, and where a control stops.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from gcxform.dialect.dialect import INCH
from gcxform.machine.machine import Tool
from gcxform.modal.columns import fill
from gcxform.modal.findings import Findings
from gcxform.modal.lines import Lines
from gcxform.modal.state import CYCLE_OFF, Modes
from gcxform.system.arrays import Flags, Floats, Ints, Small
from gcxform.toolpath.columns import constant
from gcxform.toolpath.contours import contour_rows
from gcxform.toolpath.path import Kind, Plane, Toolpath

GIVEN = 3  # the number of G41.1: from here on D is the diameter itself
SIDES = np.array([0, 1, -1, 1, -1], np.int8)  # by the number of the code: G40 G41 G42 G41.1 G42.1
AGAIN = "lead the tool off the contour and cancel it with G40 before, and begin it again behind"


def compensation(lines: Lines, modes: Modes) -> tuple[Small, Floats]:
    """Return side (live,) and radius (live,) mm of cutter compensation, after each line's words."""
    code = modes.comp
    offset = _named_tools(lines)
    if not lines.live or not (code.any() or lines.state.side):
        return constant(0, lines.live, np.int8), constant(np.nan, lines.live)
    _refuse(lines, modes)
    if lines.dialect.cutter_comp.stored:
        side, radius = SIDES[code], np.where(code > 0, _radius_of(lines, offset), np.nan)
    else:
        side, radius = _of_the_block(lines, modes, offset)
    lines.state.side, lines.state.radius = int(side[-1]), float(radius[-1])
    return side, radius


def _named_tools(lines: Lines) -> Floats:
    """Return the number (live,) of the offset or tool that G41 takes on each line.

    It is the D word where that stays in force, else the tool in the spindle. Once G10 has written
    into the tool table, nothing is known of it.
    """
    return np.where(_written_anew(lines), np.nan, _named(lines))


def _written_anew(lines: Lines) -> Flags:
    """Return the lines (live,) before which G10 has written into the control's tool table."""
    kinds = lines.dialect.offset_rule.g10_tools
    written = constant(bool(lines.state.frames.written), lines.live, np.bool_).copy()
    for line in np.flatnonzero(lines.flag("presets")).tolist() if kinds else ():
        meaning = lines.table.meanings[int(lines.shape[line])]
        for act in meaning.acts:
            slot = dict(act.slots).get("L") if act.name == "set-work" else None
            if slot is not None and lines.window.value[int(lines.first[line]) + slot] in kinds:
                written[line:] = True
    tables = np.flatnonzero(lines.flag("sets_tables"))
    if len(tables):
        written[int(tables[0]) :] = True
    return written


def _named(lines: Lines) -> Floats:
    """Return the number (live,) of the offset or tool by the words of the program."""
    state = lines.state
    if lines.dialect.cutter_comp.stored:
        stored = _carried(lines, "D", state.stored)
        state.stored = float(stored[-1]) if lines.live else state.stored
        return stored
    selected = _carried(lines, "T", state.selected)
    changes = lines.flag("changes_tool")
    tool = fill(np.where(_is_m6(lines, changes), selected, np.nan), changes, state.tool)
    if lines.live:
        state.selected, state.tool = float(selected[-1]), float(tool[-1])
    return np.where(changes, np.nan, tool)  # the change and G41 in one block: which tool?


def _carried(lines: Lines, address: str, before: float) -> Floats:
    """Return a word as it is in force on each line."""
    word = lines.word(address)
    if word is None:
        return constant(before, lines.live)
    return fill(word[0], word[1], before)


def _is_m6(lines: Lines, changes: Flags) -> Flags:
    """Return which of the lines that change the tool put the selected one into the spindle."""
    put = np.zeros(lines.live, np.bool_)
    for line in np.flatnonzero(changes).tolist():
        events = lines.table.meanings[int(lines.shape[line])].events
        put[line] = any(event.what == "M6" for event in events)
    return put


def _radius_of(lines: Lines, number: Floats) -> Floats:
    """Return the radius (mm) of tools by number, nan where it is not known; offset 0 has none."""
    known = lines.reading.tools
    numbers, at = np.unique(number, return_inverse=True)
    nothing = 0.0 if lines.dialect.cutter_comp.stored else np.nan
    radius = [nothing if n == 0 else _radius(known, n) for n in numbers.tolist()]
    return np.array(radius, np.float64)[at]


def _radius(tools: Mapping[int, Tool], number: float) -> float:
    """Return the radius of a tool of the table, nan where it is not known."""
    tool = None if np.isnan(number) else tools.get(int(number))
    return np.nan if tool is None else float(tool.radius)


def _of_the_block(lines: Lines, modes: Modes, tool: Floats) -> tuple[Small, Floats]:
    """Return side and radius where each block with G41 or G42 says its own."""
    code, stated = modes.comp, lines.stated("cutter-comp")
    value, present = lines.word("D") or (np.zeros(lines.live), np.zeros(lines.live, np.bool_))
    given = code >= GIVEN
    _refuse_words(lines, stated & (code > 0), given, value, present)
    unit = np.where(modes.inch, INCH, 1.0)
    named = np.where(present & (value > 0), value, tool)
    radius = np.where(given, value * unit / 2, _radius_of(lines, named))
    side = np.where(radius < 0, -SIDES[code], SIDES[code])
    radius = np.where(code > 0, np.abs(radius), np.nan)
    return (
        fill(side.astype(np.int8), stated, lines.state.side),
        fill(radius, stated, lines.state.radius),
    )


def _refuse_words(lines: Lines, begins: Flags, given: Flags, value: Floats, present: Flags) -> None:
    """Refuse D words that say nothing, as the control does."""
    for line in np.flatnonzero(begins & given & ~present)[: Findings.enough].tolist():
        lines.findings.add(line, "GX230", "D with the tool's diameter is missing")
    broken = begins & ~given & present & ((value % 1 != 0) | (value < 0))
    for line in np.flatnonzero(broken)[: Findings.enough].tolist():
        lines.findings.add(line, "GX230", "D is the number of a tool, and this is none", "D")


def _refuse(lines: Lines, modes: Modes) -> None:
    """Refuse what the control refuses while compensation is on, or where it is turned on."""
    rule, state = lines.dialect.cutter_comp, lines.state
    code, plane = modes.comp, modes.plane
    on_before = np.append(state.groups["cutter-comp"] > 0, code[:-1] > 0)
    on_after = code > 0
    for flags, column, which in ((on_before, "before", 0), (on_after, "after", 1)):
        for line in np.flatnonzero(flags & lines.flag(f"bars_comp_{column}")).tolist():
            name = lines.table.meanings[int(lines.shape[line])].bars_comp[which]
            _stop(lines, line, f"{lines.dialect.name} takes no {name} under cutter compensation")
    other = plane != np.append(np.int8(state.groups["plane"]), plane[:-1])
    for line in np.flatnonzero(on_before & other)[: Findings.enough].tolist():
        _stop(lines, line, "the plane cannot change under cutter compensation")
    drills = on_after & (modes.cycle != CYCLE_OFF) & lines.flag("drills")
    for line in np.flatnonzero(drills)[: Findings.enough].tolist():
        _stop(lines, line, "a canned cycle under cutter compensation")
    begins = lines.stated("cutter-comp") & on_after
    if not rule.changes:
        for line in np.flatnonzero(begins & on_before)[: Findings.enough].tolist():
            _stop(lines, line, "cutter compensation is on already")
    allowed = np.array([p.name in rule.planes for p in Plane])
    for line in np.flatnonzero(begins & ~allowed[plane])[: Findings.enough].tolist():
        name = lines.dialect.name
        _stop(lines, line, f"{name} has no cutter compensation in this plane", "")


def _stop(lines: Lines, line: int, message: str, hint: str = AGAIN) -> None:
    lines.findings.add(line, "GX230", message, hint=hint)


def refuse_ends(lines: Lines, modes: Modes, path: Toolpath, rows: Ints) -> None:
    """Refuse arcs that begin compensation, or come next after it, where the control stops.

    Nor may compensation begin again before a move has ended it.
    """
    state, side = lines.state, path.side
    before = np.append(np.int8(state.at_side), side[:-1])
    off = np.cumsum(modes.comp == 0) + int(state.cancelled)
    again = (before != 0) & (side != 0) & (np.diff(off[rows], prepend=0) > 0)
    for row in np.flatnonzero(again)[: Findings.enough].tolist():
        message = "cutter compensation begins again, and no move has ended it"
        _stop(lines, int(rows[row]), message, "move after G40")
    if lines.live:
        last = off[rows[-1]] if len(rows) else 0
        state.cancelled = bool(off[-1] > last)
    if len(rows):
        state.at_side = int(side[-1])
        state.leaving = bool((state.leaving or side.any()) and contour_rows(path)[-1])
    arc = path.kind >= Kind.ARC_CW
    for row in np.flatnonzero(arc & (before != 0) & (side == 0)).tolist():
        _stop(lines, int(rows[row]), "the move that ends cutter compensation is an arc", "")
    if lines.dialect.cutter_comp.arc_entry:
        return
    for row in np.flatnonzero(arc & (before == 0) & (side != 0)).tolist():
        _stop(lines, int(rows[row]), "the move that begins cutter compensation is an arc", "")
