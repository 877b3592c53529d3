"""Moves that the control of the output makes by other words, without being asked.

Canned cycles that it has not become their moves, and ways home to another kind of point become
moves in the machine, where it is known where home is. Moves in the machine at a feed become plain
ones for a control whose G53 is always a rapid, and arcs of more than a turn several for one that
has none such. A compensation finds the moves of all cycles: the errors of a machine on the way down
a hole are others than where it begins.

Splines that it has not become lines within `CHORD_ERROR` of them, behind the same steps, unless one
of the steps makes lines of them by an error that it was given.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from gcxform.contract.passes import resolved
from gcxform.modal.interpreter import Interpreted
from gcxform.pipeline.chain import compensates
from gcxform.pipeline.cutter_comp import with_centre_path
from gcxform.pipeline.placing import placing
from gcxform.pipeline.plan import Plan
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source
from gcxform.toolpath.cycles_as_moves import cycles_as_moves
from gcxform.toolpath.facts import LINEAR_ONLY
from gcxform.toolpath.path import Form, Kind, Toolpath
from gcxform.toolpath.splines import spline_chords, splines_as_lines
from gcxform.toolpath.turns import turning_on, within_a_turn

CHORD_ERROR = 0.002
"""mm; a step `segment` takes another."""
MEASURED = 0.01  # of it: what splines leave to the proof, whose bound is an upper one
SPLINE = re.compile(rb"[Gg][ \t]*0*(5)(?:\.([12])?0*)?(?![0-9.])")
COMMENT = re.compile(rb"\([^)\r\n]*\)|;[^\r\n]*")
TURNED = re.compile(rb"[Gg][ \t]*0*10(?![0-9.])[^\r\n]*[Rr]")
"""Work offsets that are turned: arcs may then lie in a plane that is turned out of the axes."""
SAID = (
    "splines, and arcs out of the planes of the axes, become lines within 2 um of them; the pass "
    "segment takes another chord error"
)


def settled(plan: Plan, source: Source) -> tuple[Plan, tuple[str, ...]]:
    """Return a plan with what a program needs and nobody has asked for, and what is to be said."""
    plan, centre = with_centre_path(plan, source)
    plan, lines = with_lines_for_splines(plan, source)
    return plan, (*centre, *lines)


def with_lines_for_splines(plan: Plan, source: Source) -> tuple[Plan, tuple[str, ...]]:
    """Return a plan that makes lines of splines where the target has none, and what is to be said.

    The plan itself where one of its steps makes lines of them, or there are none.
    """
    by_a_step = any(LINEAR_ONLY in step.ensures for step in plan.path_passes)
    if plan.source is plan.target or by_a_step:
        return plan, ()
    texts = (COMMENT.sub(b"", text) for text in source.windows())
    if not any(_bends(plan, text) for text in texts):
        return plan, ()
    return replace(plan, chord_error=CHORD_ERROR), (SAID,)


def _bends(plan: Plan, text: bytes) -> bool:
    """Whether a text has letters by which there may be curves that the target has not."""
    if plan.source.offset_rule.g10_rotates and TURNED.search(text):
        return True
    return any(_foreign(plan, found) for found in SPLINE.finditer(text))


def _foreign(plan: Plan, found: re.Match[bytes]) -> bool:
    """Whether a code of the source is a spline, which the target has not."""
    name = ".".join(each.decode() for each in found.groups() if each)
    code = plan.source.codes.get(f"G{name}")
    return code is not None and code.group == "motion" and plan.target.codes.get(f"G{name}") != code


def said_in_moves(
    plan: Plan, done: int, read: Interpreted, path: Toolpath, window: Window, file: str
) -> Toolpath:
    """Return the path of a window, in which such blocks are plain moves. Raises InputError.

    They become so behind the last of the steps that prove their paths by what they were given;
    `done` is how many have been run.
    """
    if done != resolved(plan.path_passes):
        return path
    if plan.chord_error and path.has_splines:
        with placing(window, file):
            path = _straight(path, plan.chord_error)
    path = _tapped_by_places(plan, _fed_in_work(plan, _homed(plan, read, path)))
    if not plan.target.arc_rule.turns and len(turning := turning_on(path)):
        with placing(window, file):
            path = within_a_turn(path, turning)
    foreign = plan.manner.foreign_cycles
    whole = compensates(plan.path_passes)
    if not (foreign or whole) or not (path.form == Form.CYCLE).any():
        return path
    with placing(window, file):
        here = np.isin(read.modes.cycle[path.block], list(foreign))
        return cycles_as_moves(path, None if whole else here, plan.saying.taps_in_step)


def _straight(path: Toolpath, chord_error: float) -> Toolpath:
    """Return a path with lines for its splines, within a chord error (mm)."""
    rows, pieces = np.flatnonzero(path.is_spline), np.ones(len(path), np.int64)
    pieces[rows] = spline_chords(path, rows, chord_error * (1.0 - MEASURED))
    return splines_as_lines(path, pieces)


def _fed_in_work(plan: Plan, path: Toolpath) -> Toolpath:
    """Return a path in which moves in the machine at a feed are plain, where G53 is rapid there.

    One whose end is not known in the work offset stays, and is refused by the target.
    """
    if not plan.saying.feeds_in_work:
        return path
    known = ~np.isnan(path.end).any(axis=1)
    moved = (path.form == Form.MACHINE) & (path.kind == Kind.LINE) & known
    incremental = path.blocks.incremental.copy()
    incremental[path.block[moved]] = False
    return path.replace(
        form=np.where(moved, Form.PLAIN, path.form).astype(np.int8),
        blocks=replace(path.blocks, incremental=incremental),
    )


def _tapped_by_places(plan: Plan, path: Toolpath) -> Toolpath:
    """Return a path in which lines with taps are absolute, where the target has none by steps.

    One that begins or ends where it is not known stays, and is refused by the target.
    """
    saying, translator = plan.saying, plan.target.translator
    spelled = saying.taps_in_step and getattr(translator, "speller", None) is not None
    tied = path.form == Form.SYNCHRONISED
    if not (spelled or saying.taps_as_cycles) or not tied.any():
        return path
    unknown = path.block[np.isnan(path.end[:, :3]).any(axis=1)]
    tapped = np.setdiff1d(path.block[tied], unknown)
    incremental = path.blocks.incremental.copy()
    incremental[tapped] = False
    return path.replace(blocks=replace(path.blocks, incremental=incremental))


def _homed(plan: Plan, read: Interpreted, path: Toolpath) -> Toolpath:
    """Return a path in which ways home are moves in the machine, by absolute words."""
    saying = plan.saying
    frames = {n: to.frame for n, to in read.homed.items() if saying.moves_home(*to.asked)}
    if not frames:
        return path
    lines = np.array(list(frames))
    home = np.isin(path.block, lines) & (path.form == Form.HOME)
    last = np.append(path.block[1:] != path.block[:-1], True)
    number = np.zeros(len(path.blocks.inch), np.int64)
    number[lines] = len(path.frames) + np.arange(len(lines))
    incremental = path.blocks.incremental.copy()
    incremental[lines] = False
    path = path.replace(
        form=np.where(home, Form.PLAIN, path.form).astype(np.int8),
        frame=np.where(home, number[path.block], path.frame),
        frames=(*path.frames, *frames.values()),
        blocks=replace(path.blocks, incremental=incremental),
    )
    return path.with_rows((~home | last).astype(np.int64))
