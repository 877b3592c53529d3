"""`cycles`: canned cycles become the moves that the control makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import gcxform as gx


@dataclass(frozen=True)
class ExpandCycles(gx.Pass):
    """Write the moves of canned cycles one by one, for controls that lack the cycles or differ.

    The moves are those that the control of the input makes, so nothing moves elsewhere. Dwells and
    what the spindle does within a cycle become blocks of their own. Tapping stays as it stands,
    for its feed is tied to the spindle only as long as it is a cycle; so do cycles that orient the
    spindle, and the cycles between which and one of these there is no other move.

    Where a program is written for a control that has not the same cycle, and where the errors of a
    machine are taken off, that is done by itself.

    LinuxCNC ends the moves of a cycle exactly, also under G64: where that is stated they get G61
    before them, and G64 with its words behind them; where no path mode is stated they are written
    without, and the certificate says so in `assumed`.
    """

    name = "cycles"
    ensures = frozenset({gx.NO_CYCLES})
    demands = gx.Demands(keeps_rows=False)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with the rows of cycles as plain rows."""
        return gx.cycles_as_moves(path)
