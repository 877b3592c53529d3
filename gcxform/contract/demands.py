"""What a pass asks of a run, and what a run has to know of it, besides how it changes a path."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from typing import TYPE_CHECKING

from gcxform.system.arrays import Flags
from gcxform.toolpath.path import FeedMode, Toolpath
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.contract.option_kinds import KinematicsFile


@dataclass(frozen=True)
class Demands:
    """What a pass asks of a run. Most ask for nothing of it."""

    keeps_rows: bool = True
    """A pass that moves nothing has the rows of its input in its output, one for one."""
    joins: bool = False
    """A row may come to stand for several that follow one another: it is the first one's line that
    it keeps. Where a window ends decides then what can be joined."""
    folds: bool = False
    """The codes that shift coordinates are folded into the words of moves."""
    resolves: bool = False
    """Its output is what the rest of the run is compared with; then it has to `prove` it. No window
    ends where cutter compensation is in force for such a pass."""
    whole_cuts: bool = False
    """It has to see every cut as a whole: a window then ends where a rapid follows one."""
    reads_tip_codes: bool = False
    """It does what codes for following the tip ask for, so they are read as plain tool lengths."""
    keeps_tip_codes: bool = False
    """It corrects tips where the control follows them: such codes are read, and stay."""
    turns_tips: bool = False
    """It does so behind codes of a tool length (G43.4) as well, where axes may turn then."""
    reads_vectors: bool = False
    """It makes angles of the tool vectors that such codes announce."""
    letters: str = ""
    """The letters of axes that its output may have, whether the program names them or not."""
    written_for: KinematicsFile | None = None
    """The machine that its output is for, if it is not the one of the pipeline."""
    promise_angle: float = 0.0
    """How far (deg) rotary axes may be from where they should be at a point of the path."""
    feed_mode: FeedMode | None = None
    """The feed mode that the pass turns those of others into; None: it keeps them."""
    slows: bool = False
    """Its moves may take longer than their feeds say, where axes are at full speed."""
    deviates: Mapping[str, str] = field(default_factory=dict)
    """By "deviation" (mm) and "angle" (degrees) the name of what it measures of the same kind: what
    its promise bounds, and what no comparison of what it wrote with its own path can show."""
    counts: frozenset[str] = frozenset()
    """The names of what it measures that are counts: told is the sum of the run."""
    spares: Callable[[Toolpath], Flags] | None = None
    """Says which rapids (n,) of a path are left to go where the machine takes them. Of these the
    proof asks that the control is told what the program says, and the certificate says how far off
    the machine is there."""
