"""`distinct` is what `np.unique` is."""

from __future__ import annotations

import numpy as np
import pytest

from gcxform.system.distinct import distinct


@pytest.mark.parametrize("dtype", [np.int8, np.int64, np.float64, np.bool_])
def test_it_gives_what_numpy_gives(dtype: type) -> None:
    rng = np.random.default_rng(3)
    for size in (0, 1, 2, 50):
        values = rng.integers(0, 5, size).astype(dtype)
        found = distinct(values)
        assert found.dtype == values.dtype
        assert np.array_equal(found, np.unique(values))
