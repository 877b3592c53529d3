"""Whether what bores by itself, in a call that stays, does so at a place that was corrected.

A pass that compensates a machine leaves rapids as they are where it does not know all of the place
to which they lead, and all of them where that is asked for. A cut that begins there is measured by
the proof. A call has no cut that could be, so the move that leads to it has to be corrected.
"""

from __future__ import annotations

import numpy as np

from gcxform.emit.manner import Believed, Task
from gcxform.modal.line_notes import AT
from gcxform.toolpath.path import Kind


def bores_beside(task: Task, believed: Believed, line: int) -> bool:
    """Whether a line bores at a place that no move has been corrected for, or that is not known."""
    if not _bores(task, line):
        return False
    path, meaning = task.read.path, task.table.meanings[int(task.shape[line])]
    led = {axis for axis, _ in meaning.call_slots}
    across = [k for k, axis in enumerate(path.axes[:3]) if axis not in led]
    own = int(np.searchsorted(path.block, line))
    known = bool(np.isfinite(path.end[own][across]).all())
    return not (known and _is_corrected(task, believed, own))


def led_behind(task: Task, believed: Believed) -> bool:
    """Whether the axes are behind a window where a corrected move has led them."""
    return _is_corrected(task, believed, len(task.read.path))


def _is_corrected(task: Task, believed: Believed, row: int) -> bool:
    """Whether the last move before a row was corrected; what bores has moved along the tool alone.

    Before the first row it is what has led the axes in the windows before.
    """
    path, row = task.read.path, row - 1
    while row >= 0 and _bores(task, int(path.block[row])):
        row -= 1
    if row < 0:
        return believed.led
    one = path.take(np.array([row]))
    spared = any(bool(spares(one)[0]) for spares in task.manner.spares)
    return not (spared and path.kind[row] == Kind.RAPID)


def _bores(task: Task, line: int) -> bool:
    """Whether a line has a code that bores by itself, over the place to which others lead."""
    called = task.table.meanings[int(task.shape[line])].call
    code = task.manner.source.codes.get(called)
    return code is not None and code.act.startswith(AT) and not code.reason
