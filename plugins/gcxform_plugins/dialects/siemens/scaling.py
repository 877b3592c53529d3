"""Whether a SINUMERIK program may make contours larger than their words.

How near lines are to an arc does not say there how near they are on the workpiece.
"""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from typing import Any

from gcxform_plugins.dialects.siemens.in_place import InPlace

SCALES = re.compile(r"(?<![A-Z0-9_])[AC]?SCALE[ \t]*[(XYZ]|,[ \t]*SC[ \t]*\]")


class Scaling(InPlace):
    """Knows whether anything in the program, and in what it has called yet, may scale."""

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self._scaled = _scales(self.lines)

    @property
    def scales(self) -> bool:
        """Whether it does; then nothing is learnt of its lines."""
        return self._scaled

    def key(self) -> Hashable | None:
        """Return the state; None where nothing is learnt: an arc in what scales is looked at."""
        return None if self._scaled and self.reading.stays else super().key()

    def called_file(self, name: str) -> range | None:
        """Return the lines of a subprogram, which may scale; None without one."""
        lines = super().called_file(name)
        if lines is not None:
            self._scaled |= _scales(self.lines[lines.start : lines.stop])
        return lines


def _scales(lines: Sequence[str]) -> bool:
    text = "\n".join(lines).upper()
    return "SC" in text and SCALES.search(text) is not None
