"""`cycles`: canned cycles become the moves that the control makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx

HINT = "leave the cycle as it is: without the pass it is written as it stands"


@dataclass(frozen=True)
class ExpandCycles(gx.Pass):
    """Write the moves of canned cycles one by one, for controls that lack the cycles or differ.

    The moves are those that the control of the input makes, so nothing moves elsewhere. Dwells and
    what the spindle does within a cycle become blocks of their own. Tapping is refused: its feed is
    tied to the spindle only as long as it is a cycle.
    """

    name = "cycles"
    ensures = frozenset({gx.NO_CYCLES})

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with the rows of cycles as plain rows."""
        cycle = path.form == gx.Form.CYCLE
        if not cycle.any():
            return path
        tied = (path.form == gx.Form.SYNCHRONISED) & np.isin(path.source, path.source[cycle])
        if tied.any():
            message = "tapping cannot be written as plain moves: its feed is tied to the spindle"
            raise path.refuse("GX210", np.flatnonzero(tied), message, HINT)
        return path.replace(form=np.where(cycle, gx.Form.PLAIN, path.form).astype(np.int8))
