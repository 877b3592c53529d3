"""What a program says with tool vectors (G43.5), for finding angles and for the proof."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats

UPRIGHT = np.array([0.0, 0.0, 1.0])


def without_left(path: gx.Toolpath) -> gx.Toolpath:
    """Return a path in which axes that a control has left where they are (inf) are unknown."""
    if not np.isinf(path.end).any() and not np.isinf(path.entry).any():
        return path
    end, entry = (np.where(np.isinf(values), np.nan, values) for values in (path.end, path.entry))
    return path.replace(end=np.asfortranarray(end), entry=entry)


@dataclass(frozen=True)
class Vectors:
    """The tool axes that a path is led with; all of them are unit vectors on the workpiece.

    `on` (n,) are the rows in which vectors are in force; before them all rotary axes are at 0.
    `end` (n, 3) is the tool axis at the end of each row, upright where none is in force, and
    `start` that of the row before, nan before the first row if vectors are in force there.
    """

    on: Flags
    start: Floats
    end: Floats

    @classmethod
    def of(cls, path: gx.Toolpath) -> Vectors:
        """Return those of a path."""
        following = np.array([frame.following is True for frame in path.frames])
        on = np.asarray(following[path.frame])
        end = np.where(on[:, None], path.tool, UPRIGHT)
        first = np.where(following[0], np.nan, UPRIGHT)[None, :]
        return cls(on, np.concatenate([first, end])[: len(end)], end)

    def turn(self) -> Floats:
        """Return the angles (n,) rad between the tool axes at both ends of the rows."""
        across = np.linalg.norm(np.cross(self.start, self.end), axis=1)
        return np.asarray(np.arctan2(across, np.einsum("ij,ij->i", self.start, self.end)))
