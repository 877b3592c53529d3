"""One rotary axis in the table and one in the head."""

from __future__ import annotations

import gcxform as gx


class CTableBHead(gx.Kinematics):
    """A rotary table C, and a head that swivels about B."""

    name = "c-table-b-head"
    table = ("C",)
    head = ("B",)


class CTableAHead(gx.Kinematics):
    """A rotary table C, and a head that swivels about A."""

    name = "c-table-a-head"
    table = ("C",)
    head = ("A",)


class ATableBHead(gx.Kinematics):
    """A rotary table A, and a head that swivels about B."""

    name = "a-table-b-head"
    table = ("A",)
    head = ("B",)
