"""What lines are that stay as they stand, in languages that are turned into words."""

from __future__ import annotations

KEPT = "M9000"
"""The block that stands for such a line among words: nobody knows what it does."""
KEEPABLE = frozenset(
    ("GX203", "GX204", "GX206", "GX207", "GX208", "GX210", "GX213", "GX215", "GX220", "GX221")
)
"""The refusals of what may stand as it is: it is not known, or not read."""
KEEPS = (
    "as they stand: {}; where the axes are behind them is not known, nor what they have set; "
    "units, plane and feed mode are taken to be as before"
)
