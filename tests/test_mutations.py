"""The mutations still fit the source; with GCXFORM_MUTATIONS=1 every fourth one is run as well.

All of them take twice as long: `python tests/mutations.py`.
"""

from __future__ import annotations

import os

import mutations
import pytest


def test_every_mutation_fits_the_source() -> None:
    assert mutations.problems() == []
    assert len({m.name for m in mutations.MUTATIONS}) == len(mutations.MUTATIONS) >= 20
    assert all(m.old != m.new for m in mutations.MUTATIONS)


@pytest.mark.slow
@pytest.mark.skipif(
    os.environ.get("GCXFORM_MUTATIONS") != "1", reason="minutes long: set GCXFORM_MUTATIONS=1"
)
def test_every_second_mutation_is_caught() -> None:
    assert mutations.main(["--every", "4"]) == 0
