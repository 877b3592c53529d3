"""What is known of the output: no more than of the source that it was written from."""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace

import numpy as np

from gcxform.contract.passes import PassContext
from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import INCH
from gcxform.proof.trace import Trace
from gcxform.system.arrays import Flags, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.path import Event, Kind, Toolpath

LENGTHS = frozenset("XYZUVWIJKR")
LENGTHS_OF_PLANES = frozenset("XYZ")  # the other words of a plane in space are angles


def as_known(path: Toolpath, read: Toolpath, line: Ints, nth: Ints, switched: bool) -> Toolpath:
    """Return a path that was written with no more than is known of the source.

    `line` (n,) are the lines of the source for its rows, `nth` (n,) which of the moves there they
    are; `switched`: a pass has taken over the codes with which the control follows the tip.
    """
    unknown = np.isnan(read.end).any()
    if not len(read) or not (unknown or switched):
        return path
    row = _row_of(read, line, nth)
    if unknown:
        path = _at_rest_unknown(path, (np.isnan(read.start) & np.isnan(read.end))[row])
    return _followed(path, read, row) if switched else path


def _row_of(read: Toolpath, line: Ints, nth: Ints) -> Ints:
    """Return the rows (n,) of the source, by their lines and which of the moves there they are."""
    first, last = (np.searchsorted(read.source, line, side) for side in ("left", "right"))
    row = np.clip(first + nth, first, np.maximum(last, first + 1) - 1)
    return np.asarray(np.minimum(row, len(read) - 1))


def _at_rest_unknown(path: Toolpath, unknown: Flags) -> Toolpath:
    """Return a path in which axes that do not move stand nowhere known where `unknown` (n, axes).

    A tool change of the source may move axes, and another control knows that its own does not. The
    source does not say where such an axis stands; all that can be asked is that it is left there.
    `unknown` is where the source knows neither where a move starts nor where it ends: one that it
    takes from a known place to a place of the machine must not rest.
    """
    start, end = path.start, path.end.copy(order="F")
    left = (end == start) & unknown
    end[left] = np.nan
    bits = 1 << np.arange(len(path.axes))
    return path.replace(end=end, lost=path.lost | (left & np.isfinite(start)) @ bits)


def _followed(path: Toolpath, read: Toolpath, row: Ints) -> Toolpath:
    """Return a path with what a pass has taken over: where the control follows the tip.

    No code in the output says it, but the rows (n,) of the source that its rows came from.
    """
    count = len(read.frames)
    pair = path.frame * count + read.frame[row]
    pairs = distinct(pair)
    frames = tuple(
        replace(path.frames[mine], following=read.frames[its].following)
        for mine, its in (divmod(each, count) for each in pairs.tolist())
    )
    return path.replace(frames=frames, frame=np.searchsorted(pairs, pair))


def in_mm(event: Event, path: Toolpath, planes: Container[str]) -> Event:
    """Return an event with the lengths among the words of its G code in mm; `planes` are codes."""
    if event.what[0] != "G" or not path.blocks.inch[event.line - path.blocks.first]:
        return event
    lengths = LENGTHS_OF_PLANES if event.what in planes else LENGTHS
    values = tuple((a, v * INCH if a in lengths else v) for a, v in event.values)
    return replace(event, values=values)


def lost_in_target(
    trace: Trace, written: Toolpath, context: PassContext, file: str
) -> InputError | None:
    """Return what to raise if the target knows less of where axes stand than the source does.

    `written` is the path as the target reads it. Between two controls that is what their codes do
    to positions, and no fault of what was written; on one control it would be.
    """
    if context.source is context.target or not len(written):
        return None
    owner = trace.owners(written)
    lost = np.isnan(written.end) & np.isfinite(trace.before.end[owner])
    begins = np.append(True, owner[1:] != owner[:-1]) & (written.kind != Kind.RAPID)
    was = np.isfinite(trace.before.start[owner, :3]) & begins[:, None]
    lost[:, :3] |= np.isnan(written.start[:, :3]) & was
    if not lost.any():
        return _lengthened_otherwise(trace, written, owner, context, file)
    row = int(np.argmax(lost.any(axis=1)))
    axis = written.axes[int(np.argmax(lost[row]))]
    name, line = context.target.name, trace.line_of(int(written.source[row]))
    return InputError.one(
        "GX509",
        f"where {axis} stands is not known to {name} here, as a code before it may have moved it",
        Location(file, line + 1),
        f"program {axis}, with the way clear, behind the last code that moves it on {name}"
        + _still(written, context),
    )


def _lengthened_otherwise(
    trace: Trace, written: Toolpath, owner: Ints, context: PassContext, file: str
) -> InputError | None:
    """Return what to raise if the target has a tool length of which the source knows nothing.

    Behind G28 the control of the source may have let go of one that is still in force there.
    """
    open_here, open_there = (
        np.array([np.isnan(frame.tool).any() for frame in path.frames])[path.frame]
        for path in (trace.before, written)
    )
    wrong = open_here[owner] & ~open_there & np.isfinite(trace.before.end[owner, 2])
    if not wrong.any():
        return None
    source, target = context.source.name, context.target.name
    line = trace.line_of(int(written.source[int(np.argmax(wrong))]))
    return InputError.one(
        "GX509",
        f"which tool length is in force here {target} knows, and {source} may have another",
        Location(file, line + 1),
        "say the length again before this block, G43 with its H",
    )


def _still(written: Toolpath, context: PassContext) -> str:
    """Return how the user says that a code leaves axes where they stand, if one may lose them."""
    codes = context.target.m_codes
    lose = {f"M{number}" for number, code in codes.items() if code.loses_position}
    found = [event.what for event in written.events if event.what in lose]
    said = f'inert = ["{found[0]}"] in [output], beside those that it has' if found else ""
    return f"; or, if it moves none, {said}" if said else ""
