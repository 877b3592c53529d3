"""Rapids that passes leave to go where the machine takes them: what the proof asks of these.

A rapid to a point of the machine (G28, G53) is said in the machine's own positions, and a pass that
compensates writes it as it stands. The tool is then off by the machine's error, on purpose. It must
be a rapid, and the control must be told what the program says; no feed move may begin there, which
the proof sees by where the machine is.

Claimed of every rapid that some pass spares (`Demands.spares`), with p its row as read, w as it was
written and undone by all passes but those that spare, and b the budget: in each axis

    |end of w - end of p| <= b,  or both stand still there,  or, in G91, for a return to reference
    and for a block of which some axis goes nowhere known, |way of w - way of p| <= b.

The certificate says in `not_checked` how many there are, and how far off the machine is there.
`compare --model` and `simulate` go by the same undo; `compare` holds spared rapids against what the
control is told, and where feed moves begin behind them against where the tool is.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gcxform.contract.passes import Pass, PassContext
from gcxform.system.arrays import Flags, Ints
from gcxform.toolpath.path import Form, Kind, Toolpath

STILL = 1e-9  # mm, deg


def spared_rows(passes: Sequence[Pass], path: Toolpath) -> Flags:
    """Return which rows (n,) of a path as read some pass spares: rapids alone."""
    spared = np.zeros(len(path), np.bool_)
    for step in passes:
        if step.demands.spares is not None:
            spared |= step.demands.spares(path)
    return np.asarray(spared & (path.kind == Kind.RAPID))


def told(passes: Sequence[Pass], path: Toolpath, context: PassContext) -> Toolpath:
    """Return what the control is told by a path that was written: passes that spare not undone."""
    for step in reversed(passes):
        if step.demands.spares is None:
            path = step.undo(path, context)
    return path


def led_elsewhere(before: Toolpath, after: Toolpath, owner: Ints, rows: Flags, slack: float) -> int:
    """Return a row of what the control is told that leads not where its spared owner does, or -1.

    `owner` (len(after),) are rows of the path as read, `rows` (n,) those that are spared. An axis
    has to end where the program says, or to stay where the program lets it stay; a return to
    reference in G91 may go as far as the program says, and so may a move of which not all ends are
    known.
    """
    mine = np.flatnonzero(rows[owner] & np.append(owner[1:] != owner[:-1], True)[: len(owner)])
    end, start = after.end[mine], after.start[mine]
    goal, begin = before.end[owner[mine]], before.start[owner[mine]]
    with np.errstate(invalid="ignore"):
        good = (np.abs(end - goal) <= slack) | (np.isnan(end) & np.isnan(goal))
        good |= (np.abs(end - start) <= STILL) & (np.abs(goal - begin) <= STILL)
        distances = np.isin(before.form[owner[mine]], (Form.HOME, Form.BLIND))
        distances &= before.blocks.incremental[before.block[owner[mine]]]
        good |= distances[:, None] & (np.abs((end - start) - (goal - begin)) <= slack)
    wrong = np.flatnonzero(~good.all(axis=1))
    return int(mine[wrong[0]]) if len(wrong) else -1
