"""What the work on a window, and its proof, know of the options of their pass."""

from __future__ import annotations

from dataclasses import dataclass

import gcxform as gx
from gcxform_plugins.passes.rtcp.user_lines import UserLines


@dataclass(frozen=True)
class Retraction:
    """How the tool is drawn back to turn axes: how far (mm), and at which feed.

    `feed` is in mm/min of the tip, and in degrees/min while axes turn.
    """

    length: float
    feed: float
    lines: UserLines


@dataclass(frozen=True)
class Options:
    """The options of a pass in terms of the work: what is converted, and how far it may be off.

    The tip may be off by `tolerance` (mm), the tool axis by `axis_tolerance` (degrees).
    """

    tolerance: float
    axis_tolerance: float = 0.1
    to_axes: bool = False
    """Tips are read, and positions of axes are written."""
    rapids_turn: bool = False
    """Rapids may turn axes; they are converted where they end."""
    tip_codes: bool = False
    """The program has codes for following the tip, which are done here."""
    great_circles: bool = False
    """Between blocks the tool axis goes on a great circle, and angles not in proportion."""
    corrects: bool = False
    """Axes are written for those of a machine that is nearly the same, with feeds as they are."""
    largest_turn: float = 0.0
    """By how much (degrees) an angle may be corrected."""
    keeps_at_pole: bool = False
    """Angles that would be corrected by more than that are kept, and not refused."""
    target: gx.Machine | None = None
    """The machine that is written for, if it is not the one posted for."""
    retraction: Retraction | None = None
    """How the tool is drawn back where axes have to flip or unwind in a cut, if it may be."""
