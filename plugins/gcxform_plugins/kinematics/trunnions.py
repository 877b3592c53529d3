"""Two rotary axes that carry the table."""

from __future__ import annotations

import gcxform as gx


class AcTrunnion(gx.Kinematics):
    """A tilting table A that carries a rotary table C."""

    name = "ac-trunnion"
    table = ("A", "C")


class BcTrunnion(gx.Kinematics):
    """A tilting table B that carries a rotary table C."""

    name = "bc-trunnion"
    table = ("B", "C")


class AbTrunnion(gx.Kinematics):
    """A tilting table A that carries a rotary table B."""

    name = "ab-trunnion"
    table = ("A", "B")


class BaTrunnion(gx.Kinematics):
    """A tilting table B that carries a rotary table A."""

    name = "ba-trunnion"
    table = ("B", "A")
