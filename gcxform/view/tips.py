"""Where the tip of the tool is on the workpiece, for programs in positions of the axes.

What a program says is where axes stand. With rotary axes turned the tool cuts elsewhere, on the way
of which the ends are those of the move and which is no line. Where a machine file says the chain,
its forward model (`gcxform/machine/chain.py`) takes points between both ends onto the workpiece.
What that would need and is not known (an angle, the length of a tool in a head that turns) is not
drawn.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final, NamedTuple

import numpy as np

from gcxform.diagnostics import UsageError
from gcxform.machine.chain import Chain, Rotary, chain_of
from gcxform.machine.machine import Machine
from gcxform.system.arrays import Floats, Ints
from gcxform.system.distinct import distinct
from gcxform.toolpath.circles import points_on_arcs
from gcxform.toolpath.path import Toolpath
from gcxform.toolpath.splines import points_on_splines
from gcxform.view.packing import Store

TURN: Final = 3.0  # degrees that an axis turns from one point to the next
ARC: Final = 0.1  # rad, of an arc in the linear axes
SPLINE: Final = 24  # pieces
MOST: Final = 400  # pieces of one move
STEP: Final = 1e-4  # mm


class Tips(NamedTuple):
    """Points of the tip, mm: `entry` (3,), and `points` (k, 3) of all moves one after the other.

    `pieces` (n,) are those of each move, 0 for one that is not drawn: it has one point as well.
    """

    entry: Floats
    pieces: Ints
    points: Floats

    def packed(self, store: Store) -> dict[str, Any]:
        """Add the points to a store; return where they are."""
        columns = [store.lengths(column, STEP) for column in self.points.T]
        entry = self.entry.tolist()
        return {"entry": entry, "pieces": store.ints(self.pieces), "points": columns}


def rotary_chain(machine: Machine | None) -> Chain | None:
    """Return the chain of a machine with rotary axes; None where that is not known."""
    if machine is None:
        return None
    try:
        chain = chain_of(machine)
    except UsageError:
        return None
    return chain if chain.axes else None


def described_chain(chain: Chain) -> dict[str, Any]:
    """Return how the rotary axes turn, from the base outwards."""
    sides = {"table": chain.table, "head": chain.head}
    return {name: [_rotary(axis) for axis in axes] for name, axes in sides.items()}


def _rotary(axis: Rotary) -> dict[str, Any]:
    return {"letter": axis.letter, "direction": list(axis.direction), "sign": axis.sign}


def tips(path: Toolpath, machine: Machine) -> Tips | None:
    """Return where the tip goes; None where the machine is not one whose tip is known.

    That is one with a chain, with the work offset of the path, and all of its rotary axes are
    somewhere in the path.
    """
    chain = rotary_chain(machine)
    offset = machine.work_offsets.get(path.first)
    if chain is None or offset is None:
        return None
    if not set(chain.letters) <= set(path.axes) or any(offset.get(a, 0.0) for a in chain.letters):
        return None
    zero = np.array([offset.get(axis, 0.0) for axis in "XYZ"])
    columns = [path.axes.index(letter) for letter in chain.letters]
    if not np.isfinite(path.end[:, columns]).any(axis=0).all():
        return None
    return _followed(path, chain, zero, columns)


def _followed(path: Toolpath, chain: Chain, zero: Floats, columns: list[int]) -> Tips:
    """Return where the tip goes; `columns` are those of the rotary axes."""
    first, last = path.start[:, columns], path.end[:, columns]
    pieces = _pieces(path, last - first)
    row = np.repeat(np.arange(len(path)), pieces)
    nth = np.arange(len(row)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    part = (nth + 1) / pieces[row]
    at = _on_moves(path, row, part)
    angles = first[row] + part[:, None] * (last - first)[row]
    points = _tip(path, chain, zero, at, angles, path.frame[row])
    known = np.asarray(np.isfinite(points).all(axis=1))
    drawn = np.asarray(np.minimum.reduceat(known, np.cumsum(pieces) - pieces), np.bool_)
    points = np.where(known[:, None], points, np.nan_to_num(at))
    keep = drawn[row] | (nth == pieces[row] - 1)
    start = path.start[:1]
    entry = _tip(path, chain, zero, start[:, :3], start[:, columns], path.frame[:1])[0]
    return Tips(np.nan_to_num(entry), np.where(drawn, pieces, 0), points[keep])


def _pieces(path: Toolpath, turned: Floats) -> Ints:
    """Return into how many pieces (n,) moves are cut that turn axes by so much (n, m), degrees."""
    turn = np.nan_to_num(np.abs(turned)).max(axis=1, initial=0.0) / TURN
    arc = np.where(path.is_arc, path.sweep, 0.0) / ARC
    spline = np.where(path.is_spline, SPLINE, 1)
    wanted = np.ceil(np.maximum(np.maximum(turn, arc), spline))
    return np.asarray(np.clip(wanted, 1, MOST), np.int64)


def _on_moves(path: Toolpath, row: Ints, part: Floats) -> Floats:
    """Return positions (k, 3) of moves at parts of their ways, mm."""
    start, end = path.start[row, :3], path.end[row, :3]
    points = np.array(start + part[:, None] * (end - start))
    points[part == 1.0] = end[part == 1.0]
    for chosen, along in ((path.is_arc, points_on_arcs), (path.is_spline, points_on_splines)):
        here = chosen[row]
        if here.any():
            points[here] = along(path, row[here], part[here])
    return points


def _tip(
    path: Toolpath, chain: Chain, zero: Floats, at: Floats, angles: Floats, frames: Ints
) -> Floats:
    """Return the tips (k, 3) of positions (k, 3) on the workpiece, in the coordinates of the path.

    `frames` (k,) says which frames hold. Where the control follows the tip, a position is one of
    it, but for the length; nan is not known.
    """
    found = np.full(at.shape, np.nan)
    gauge = np.array(chain.tip)
    for number in distinct(frames).tolist():
        frame, here = path.frames[number], frames == number
        tool = np.array(frame.tool)
        if frame.following:
            found[here] = at[here] - np.nan_to_num(tool)
            continue
        if not np.isfinite(tool).all() and not chain.head:
            tool = np.zeros(3)  # along Z of the machine, where it makes no difference
        x, y, z = (gauge - tool).tolist()
        own = replace(chain, tip=(x, y, z))
        found[here] = own.tip_at(at[here] + zero, angles[here]) - gauge - zero
    return found
