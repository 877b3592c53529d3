"""Rotary axes of which one leans, by 45 degrees or what `inclination` says."""

from __future__ import annotations

import gcxform as gx


class NutatingHead(gx.Kinematics):
    """A head C that carries a nutating axis B, which carries the spindle."""

    name = "nutating-head"
    head = ("C", "B")
    nutating = "B"


class NutatingTable(gx.Kinematics):
    """A nutating axis B that carries a rotary table C."""

    name = "nutating-table"
    table = ("B", "C")
    nutating = "B"


class ATableNutatingHead(gx.Kinematics):
    """A rotary table A, and a head that turns about a nutating axis B."""

    name = "a-table-nutating-head"
    table = ("A",)
    head = ("B",)
    nutating = "B"
