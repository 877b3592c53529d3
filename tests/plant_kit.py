"""Work of a batch that goes wrong: processes that do it import this by its name."""

from __future__ import annotations

import os
import signal
from dataclasses import replace
from pathlib import Path

from gcxform.cli.plant.rows import Row
from gcxform.cli.plant.tasks import Task
from gcxform.cli.plant.work import done

LETHAL = "lethal.nc"
ONCE = "once.nc"


def dying(task: Task) -> Row:
    """Do a task; one program ends every process that does it, another the first one."""
    first = Path(task.root, "first")
    if task.below == LETHAL or (task.below == ONCE and not first.exists()):
        first.parent.mkdir(parents=True, exist_ok=True)
        first.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return replace(done(task), reason=str(os.getpid()))
