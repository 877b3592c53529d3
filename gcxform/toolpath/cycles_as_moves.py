"""Canned cycles as the moves that the control of the input makes of them."""

from __future__ import annotations

import numpy as np

from gcxform.system.arrays import Flags
from gcxform.toolpath.facts import inseparable_cycles
from gcxform.toolpath.path import Form, Toolpath


def cycles_as_moves(path: Toolpath, which: Flags | None = None, in_step: bool = False) -> Toolpath:
    """Return a path with the rows of cycles as plain rows; `which` (n,) limits them.

    `in_step`: taps are said by another code, and what leads to them and away becomes plain. Else
    tapping stays as it stands, and so do cycles that orient the spindle, and those between which
    and one of these there is no other move. Raises InputError.
    """
    tied = inseparable_cycles(path, in_step)
    cycle = (path.form == Form.CYCLE) & ~tied
    if which is not None:
        cycle &= which
    if not cycle.any():
        return path
    if not in_step:
        _check_dwells(path, cycle)
    path = path.replace(form=np.where(cycle, Form.PLAIN, path.form).astype(np.int8))
    still = cycle & (path.end == path.start).all(axis=1)
    return path.with_rows((~still).astype(np.int64)) if still.any() else path


def _check_dwells(path: Toolpath, expanded: Flags) -> None:
    """Refuse taps that dwell as long as a cycle that is expanded, whose P may be theirs as well."""
    rows = [e for e in path.events if e.within and e.what == "DWELL" and e.values[0][1] > 0]
    before = np.array([each.row - 1 for each in rows], np.int64)
    seconds = np.array([each.values[0][1] for each in rows])
    shared = np.isin(seconds, seconds[expanded[before]])
    taps = before[(path.form[before] == Form.SYNCHRONISED) & shared]
    if len(taps):
        message = "this tap dwells, perhaps for the P of a cycle that would be expanded"
        raise path.refuse("GX215", taps, message, "leave such programs without the pass")
