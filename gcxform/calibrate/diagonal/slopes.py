"""The six slopes that a machine has in the end-point frame, and combinations of them in words."""

from __future__ import annotations

from typing import Final

from gcxform.system.arrays import Floats

SLOPES: Final = ("scale X", "scale Y", "scale Z", "EXY slope", "EXZ slope", "EYZ slope")
SLOPES_AT: Final = ((0, 0), (1, 1), (2, 2), (1, 0), (2, 0), (2, 1))  # axis, direction


def worded(row: Floats) -> str:
    """Return a combination of `SLOPES` in words, such as `scale X + 2.12 scale Y`."""
    text = ""
    for factor, name in zip(row.tolist(), SLOPES, strict=True):
        if abs(factor) > 1e-6:
            size = "" if abs(abs(factor) - 1.0) < 1e-9 else f"{abs(factor):.4g} "
            sign = ("- " if factor < 0 else "+ ") if text else ("-" if factor < 0 else "")
            text += f"{' ' if text else ''}{sign}{size}{name}"
    return text


def together(row: Floats) -> str:
    """Return a direction among `SLOPES` in words, such as `scale X +1 with scale Z -1.14`."""
    pairs = zip(row.tolist(), SLOPES, strict=True)
    return " with ".join(f"{name} {factor:+.4g}" for factor, name in pairs if abs(factor) > 1e-6)
