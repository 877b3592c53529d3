"""`cycles`: canned cycles become the moves that the control makes of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags


@dataclass(frozen=True)
class ExpandCycles(gx.Pass):
    """Write the moves of canned cycles one by one, for controls that lack the cycles or differ.

    The moves are those that the control of the input makes, so nothing moves elsewhere. Dwells and
    what the spindle does within a cycle become blocks of their own. Tapping stays as it stands,
    for its feed is tied to the spindle only as long as it is a cycle; so do cycles that orient the
    spindle, and the cycles between which and one of these there is no other move.

    LinuxCNC ends the moves of a cycle exactly, also under G64: where that is stated they get G61
    before them, and G64 with its words behind them; where no path mode is stated they are written
    without, and the certificate says so in `assumed`.
    """

    name = "cycles"
    ensures = frozenset({gx.NO_CYCLES})
    demands = gx.Demands(keeps_rows=False)

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        """Return the path with the rows of cycles as plain rows."""
        tied = gx.inseparable_cycles(path)
        self._check_dwells(path, tied)
        cycle = (path.form == gx.Form.CYCLE) & ~tied
        if not cycle.any():
            return path
        path = path.replace(form=np.where(cycle, gx.Form.PLAIN, path.form).astype(np.int8))
        still = cycle & (path.end == path.start).all(axis=1)
        return path.with_rows((~still).astype(np.int64)) if still.any() else path

    def _check_dwells(self, path: gx.Toolpath, tied: Flags) -> None:
        """Refuse taps that dwell: for how long may have been said by a cycle that is expanded."""
        rows = [e.row for e in path.events if e.within and e.what == "DWELL" and e.values[0][1] > 0]
        before = np.array([row - 1 for row in rows], np.int64)
        taps = before[(path.form[before] == gx.Form.SYNCHRONISED) & tied[before]]
        if len(taps):
            message = "this tap dwells, perhaps for the P of a cycle that would be expanded"
            raise path.refuse("GX215", taps, message, "leave such programs without the pass")
