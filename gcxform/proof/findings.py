"""What the verification of a run has found: counts, and the worst places, for the certificate."""

from __future__ import annotations

from dataclasses import field

from gcxform.proof.inventory import Written
from gcxform.values import dataclass


@dataclass(slots=True)
class Findings:
    """What the verification has found so far: counts, and the worst places.

    deviation   mm; `source_line` and `output_line` count from 1
    angle       degrees, of rotary axes
    inch        whether a block in inches has been written
    file        what the output is as a file
    arcs        whether there was any arc or spline, on either side
    contours    stretches under cutter compensation of which centre paths were compared
    contour_only   moves under it of which only the contour was
    between_taps, aside   moves between taps that are off by more than the budget, and how far (mm)
    spared      rapids left to go where the machine does, of which `spared_unknown` are off by what
                nobody knows, and the others by up to `spared_by` (mm)
    path_modes  blocks with a path mode that stand around cycles which are written out
    unset       codes that set coordinates, of which what they leave in the control is not set now
    """

    moves: int = 0
    events: int = 0
    deviation: float = 0.0
    angle: float = 0.0
    source_line: int = 0
    output_line: int = 0
    rapids: int = 0
    unknown_starts: int = 0
    between_taps: int = 0
    aside: float = 0.0
    lines_after_end: int = 0
    contours: int = 0
    contour_only: int = 0
    spared: int = 0
    spared_unknown: int = 0
    spared_by: float = 0.0
    path_modes: int = 0
    unset: int = 0
    inch: bool = False
    file: Written = field(default_factory=Written)
    arcs: bool = False
