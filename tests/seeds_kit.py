"""Seeds of generated programs, in shares: each is a test of seconds, and they run side by side."""

from __future__ import annotations

import pytest


def shares(count: int, size: int) -> pytest.MarkDecorator:
    """Give a test its `seeds`, of 0 to count, so many at a time."""
    parts = [range(first, min(first + size, count)) for first in range(0, count, size)]
    return pytest.mark.parametrize("seeds", parts, ids=lambda part: f"{part.start}-{part.stop}")
