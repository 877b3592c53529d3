"""`offsets`: shifted, turned and mirrored coordinates become plain ones.

It moves nothing. The frames of the rows are replaced by ones in which only the tool length is left,
and the path is `folded`: the writer then leaves out the codes that shifted or turned coordinates,
and computes the words anew. The proof reads the output, without these codes, to the same positions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags

FLAT = 1e-15  # what is left of a word of another axis where nothing is


@dataclass(frozen=True)
class Offsets(gx.Pass):
    """Fold G52, G92, G10, G68, G51.1, G16, G7 and other work offsets into the words of moves.

    The program then stays in the work offset in which it starts, and the codes that shifted or
    turned its coordinates are not written. What they would leave behind in the control is lost,
    and the certificate says of how many.
    Tool lengths, G28 and G53 stay as they are; but a length that is given by its value (G43.1) goes
    into the words of a control that has no such code, and a tip that is followed on a table that
    stands (G43.4) into those of any other control: G43 is left. How far two work offsets are apart
    has to be known, from the machine file or from the program.
    """

    name = "offsets"
    ensures = frozenset({gx.WORKPIECE_FRAME})
    demands = gx.Demands(folds=True)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with every row in the work offset in which the program starts."""
        self._check_known(path)
        self._check_turned(path)
        spent = context.saying.folds_value("length-vector")
        if spent:
            self._check_ended(path)
        frames = tuple(
            self._unshifted(frame, path, spent and frame.valued) for frame in path.frames
        )
        return path.replace(frames=frames, folded=True)

    def _unshifted(self, frame: gx.Frame, path: gx.Toolpath, spent: bool) -> gx.Frame:
        """Return the frame in which only the tool length is left; `spent`: not in the words.

        Words of the machine stay what they are.
        """
        if frame.machine:
            return replace(frame, work=path.first)
        shift = np.zeros(len(frame.shift))
        shift[:3] = 0.0 if spent else np.nan_to_num(np.array(frame.tool))
        return gx.Frame(
            path.first,
            tuple(shift.tolist()),
            frame.origin,
            tool=frame.tool,
            following=frame.following,
            called=frame.called and not spent,
            valued=frame.valued,
            instead=frame.instead,
        )

    def _check_ended(self, path: gx.Toolpath) -> None:
        """Refuse a length by its value behind one by its number, which would stay in force."""
        still = [frame.instead for frame in path.frames]
        rows = np.flatnonzero(np.array(still, np.bool_)[path.frame])
        if len(rows):
            message = "a tool length by its value takes the place of one by its number here, "
            message += "and that would stay in force"
            hint = "draw the tool back, and write G49 before the code of the value"
            raise path.refuse("GX501", rows, message, hint)

    def _check_known(self, path: gx.Toolpath) -> None:
        """Refuse moves in coordinates of which it is not known where they are."""
        for number in np.unique(path.frame).tolist():
            origin = (name.split(" + ")[0] for name in path.frames[number].origin)
            unknown = [name for name in origin if name != path.first]
            if unknown:
                rows = np.flatnonzero(path.frame == number)[:1]
                message = f"how far {unknown[0]} is from {path.first} is not known"
                hint = gx.ways_to_offsets(path.first, unknown[0])
                raise path.refuse("GX314", rows, message, hint)

    def _check_turned(self, path: gx.Toolpath) -> None:
        """Refuse first moves in other coordinates that leave out an axis which is then unknown.

        An axis that no turn mixes with others stands where it stood. A frame in which nothing moves
        is left before the program has moved at all, or behind another that it has stated. Where a
        table turns onto a plane no word counts in that: the move behind is the first.
        """
        works = [frame.work for frame in path.frames]
        if not (path.frame == 0).any():
            works[0] = path.first
        turns = [(f.matrix, f.polar, name) for f, name in zip(path.frames, works, strict=True)]
        moved = ~_turns_alone(path)
        last = np.maximum.accumulate(np.where(moved, np.arange(1, len(path) + 1), 0))
        before = np.append(0, path.frame)[np.append(0, last[:-1])[: len(path)]]
        changes = np.array([[a != b for b in turns] for a in turns], np.bool_)[before, path.frame]
        mixed = np.array([_mixed(frame) for frame in path.frames])
        work = np.unique(works, return_inverse=True)[1]
        counts = mixed[before] | mixed[path.frame] | (work[before] != work[path.frame])[:, None]
        unknown = (np.isnan(path.end) & np.isnan(path.start))[:, :3] & counts
        lost = np.stack([path.lost >> k & 1 for k in range(3)], axis=1) == 1
        rows = np.flatnonzero(changes & moved & (unknown & lost).any(axis=1))
        if len(rows):
            message = (
                "a first move in other coordinates leaves out an axis of which it is not known"
            )
            message += " where it stands in them"
            hint = "name the axes in this block, and the work offset at the head of the program"
            raise path.refuse("GX213", rows, message, hint)


def _turns_alone(path: gx.Toolpath) -> Flags:
    """Return the rows (n,) in which rotary axes alone turn: nothing is known of X, Y and Z."""
    rotary = path.start[:, 3:], path.end[:, 3:]
    turns = ((rotary[0] != rotary[1]) & ~np.isnan(rotary[1])).any(axis=1)
    known = ~np.isnan(path.start[:, :3]) | ~np.isnan(path.end[:, :3])
    return np.asarray(turns & ~known.any(axis=1))


def _mixed(frame: gx.Frame) -> list[bool]:
    """Return which of X, Y and Z are made of words of other axes as well."""
    if frame.matrix is None:
        return [frame.polar] * 3
    others = np.abs(np.array(frame.matrix)) * (1.0 - np.eye(3)) > FLAT
    return [frame.polar or bool(mixes) for mixes in others.any(axis=0) | others.any(axis=1)]
