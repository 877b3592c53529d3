"""Files that a program calls: what has been done to them is not done again.

They are executed with it and written out, or kept where nothing of them changes; so what their
stamps say has to be what the chain takes the program for, as of the program itself.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gcxform.flow.executed import CalledFile
from gcxform.syntax.source import Source

if TYPE_CHECKING:
    from gcxform.pipeline.plan import Plan


def not_done_yet(plan: Plan, files: tuple[CalledFile, ...]) -> tuple[CalledFile, ...]:
    """Return the files that a program calls. Raises InputError for one that is done already."""
    for each in files:
        plan.marks(Source.of_bytes(each.text, each.name))
    return files
