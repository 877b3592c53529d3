"""The array types of every column: what an annotation says where numpy's own name is longer."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]  # positions, lengths, feeds, angles
Ints = NDArray[np.int64]  # rows, lines, shapes, counts
Small = NDArray[np.int8]  # kinds, planes, modes: one of a few
Flags = NDArray[np.bool_]  # which rows
Bytes = NDArray[np.uint8]  # text
