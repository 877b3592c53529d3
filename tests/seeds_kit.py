"""Seeds of generated programs, in shares: each is a test of seconds, and they run side by side.

A property of which an example is dear (a program is drawn, run and compared, or LinuxCNC is asked)
is tried on multiples of `DRAWN`: 20 where a cheap one is tried on 50, and as many as it over night.
"""

from __future__ import annotations

import pytest
from hypothesis import settings

LONG = settings.default.max_examples > 1000  # the profile of that name
DRAWN = settings.default.max_examples if LONG else min(20, settings.default.max_examples)


def some(count: int) -> range:
    """Return the seeds that are tried, of so many over night: two in five of them."""
    return range(count if LONG else max(2 * count // 5, 1))


def shares(count: int, size: int) -> pytest.MarkDecorator:
    """Give a test its `seeds`, of 0 to count, so many at a time."""
    parts = [range(first, min(first + size, count)) for first in range(0, count, size)]
    return pytest.mark.parametrize("seeds", parts, ids=lambda part: f"{part.start}-{part.stop}")
