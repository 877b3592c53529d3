"""Moves by distances from nowhere known, in passes that ask where the machine stands.

A pass that leaves rapids to the machine says itself which moves it must know (`Demands.spares`).
"""

from __future__ import annotations

import numpy as np

from gcxform.contract.passes import Pass
from gcxform.toolpath.path import Form, Toolpath


def check_blind(step: Pass, path: Toolpath) -> None:
    """Refuse moves from nowhere known before a pass that turns them into others.

    Raises InputError (GX207).
    """
    turns = step.demands.resolves or type(step).undo is not Pass.undo
    blind = np.flatnonzero(path.form == Form.BLIND)
    if len(blind) and turns and step.demands.spares is None:
        message = "this goes by distances, and where an axis stands before it is not known"
        raise path.refuse("GX207", blind, message, "program the axis in G90 before")
