"""Axes of machines whose source has inches and seconds, as the samples of LinuxCNC have them.

| value | from | and there |
|---|---|---|
| limits | `MIN_LIMIT`, `MAX_LIMIT` of the axis | inches; -0.000001 and 0.000001 are taken for 0 |
| max-speed | `MAX_VELOCITY` of the axis | inches per second |
"""

from __future__ import annotations

from typing import Any

IPS = 60 * 25.4  # mm/min


def axis(low: float, high: float, speed: float) -> dict[str, Any]:
    """Return an axis of these limits (inch) and top speed (inch/s)."""
    return {"limits": [f"{low:g} in", f"{high:g} in"], "max-speed": round(speed * IPS, 3)}
