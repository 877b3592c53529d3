"""One rotary axis: four axes, or three and one that is set between cuts."""

from __future__ import annotations

import gcxform as gx


class ATable(gx.Kinematics):
    """A rotary table A: 3 + 1 axes."""

    name = "a-table"
    table = ("A",)


class BTable(gx.Kinematics):
    """A rotary table B: 3 + 1 axes."""

    name = "b-table"
    table = ("B",)


class CTable(gx.Kinematics):
    """A rotary table C: 3 + 1 axes."""

    name = "c-table"
    table = ("C",)
