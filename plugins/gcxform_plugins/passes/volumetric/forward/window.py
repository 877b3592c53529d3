"""What `volumetric` knows of a window before it commands anything: places, bounds, the solver."""

from __future__ import annotations

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats, Ints
from gcxform_plugins.passes.volumetric.forward.turning_head import Swing
from gcxform_plugins.passes.volumetric.options import VolumetricOptions
from gcxform_plugins.passes.volumetric.place import Place

PROOF = 1.5e-5  # mm; what the proof may add to what is off, for what it does not follow
PROOF_SHARE = 0.25  # of a tolerance, at most


def left_to_machine(path: gx.Toolpath, skip: bool = False) -> Flags:
    """Return the rapids (n,) that are not compensated; `skip`: all of them.

    These are moves to points of the machine itself (G28, G53, and G28 that becomes G53), and those
    that end where some axis is at an unknown place, as between a tool change and the first Z.
    """
    left = np.isnan(path.end[:, :3]).any(axis=1) | skip
    left |= np.array([frame.machine for frame in path.frames])[path.frame]
    left |= (path.form == gx.Form.HOME) | (path.form == gx.Form.MACHINE)
    return np.asarray(left & (path.kind == gx.Kind.RAPID))


class Window:
    """The rows of a path in the table, and how steep and curved the error is there.

    start, end  (n, 3) mm, of the rows, in the table
    swing       what a turning head adds; None where none turns
    lipschitz   mm/mm, the steepest slope of the error
    curvature   (3, 3) 1/mm, the bounds of its second derivatives
    undone      mm/mm, how far the undo moves what a command is moved by, at most
    left        (n,) the rapids to points of the machine, or to unknown places
    skipped     (n,) the rapids that are written as they were
    room        mm, what of the limit is there for what is written
    """

    def __init__(self, step: VolumetricOptions, path: gx.Toolpath, place: Place) -> None:
        self.step = step
        self.path = path
        self.place = place
        self.offset = place.offset
        self.start = path.start[:, :3] + self.offset
        self.end = path.end[:, :3] + self.offset
        model = step.model.model
        self.swing = None if place.lever is None else Swing(step, place.lever)
        reach = gx.reach_of(model, place.tool) if self.swing is None else self.swing.reach
        self.lipschitz, self.curvature = model.lipschitz(reach), model.curvature(reach)
        steep = self.lipschitz / (1 - min(self.lipschitz, 0.5))
        self.undone = steep if step.inverse else self.lipschitz
        self.left = left_to_machine(path)
        self.skipped = left_to_machine(path, step.rapids == "skip")
        self.room = step.limit - min(PROOF, PROOF_SHARE * step.limit)

    def offset_of(self, rows: Ints) -> Floats:
        """Return table position minus program position of rows."""
        return self.place.offset_of(rows)

    def command(self, target: Floats, rows: Ints, part: Floats | None = None) -> Floats:
        """Return the commands (n, 3) for targets in the table (n, 3) at parts of rows, mm.

        Without parts the rows are at their ends, or their heads do not turn.
        """
        return self.commanded(target, self.place.tool_of(rows, part))

    def commanded(self, target: Floats, tool: Floats | None) -> Floats:
        """Return what is written (n, 3) for targets in the table (n, 3), mm, for tools."""
        return self._actual(target, tool) if self.step.inverse else self._solved(target, tool)

    def meant(self, written: Floats, tool: Floats | None) -> Floats:
        """Return the targets (n, 3) for which something else (n, 3) is written, mm, for tools."""
        return self._solved(written, tool) if self.step.inverse else self._actual(written, tool)

    def _actual(self, command: Floats, tool: Floats | None) -> Floats:
        return command + self.step.error(command, tool)

    def _solved(self, target: Floats, tool: Floats | None) -> Floats:
        step = self.step
        model = step.model.model
        return gx.compensate(model, target, step.outside, step.iterations, tool).position

    def refuse_jump(self, rows: Ints, off: float | None = None) -> gx.InputError:
        """Return the error about a move on whose way the error jumps, `off` (mm) where known."""
        how_far = "" if off is None else f" by {off * 1000:.3g} um"
        message = f"on the way of this move the error jumps{how_far}, which no cut mends"
        hint = "one that is zero outside does at the border of its table: keep away from that"
        return self.path.refuse("GX309", rows, message, hint)

    def refuse_short(self, row: int, shortest: float) -> gx.InputError:
        """Return the error about a move that has to be cut into too short pieces."""
        step = self.step
        return self.path.refuse(
            "GX315",
            np.array([row]),
            f"to be within {step.limit * 1000:g} um takes a piece of {shortest:.3f} mm, shorter "
            f"than min-length, which is {step.min_length:g} mm",
            "give a larger tolerance, or a smaller min-length",
        )
