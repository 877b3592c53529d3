"""Two rotary axes that carry the spindle."""

from __future__ import annotations

import gcxform as gx


class CaFork(gx.Kinematics):
    """A fork head: C carries A, which carries the spindle."""

    name = "ca-fork"
    head = ("C", "A")


class CbFork(gx.Kinematics):
    """A fork head: C carries B, which carries the spindle."""

    name = "cb-fork"
    head = ("C", "B")
