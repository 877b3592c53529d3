"""The pass `cycles` on rows as the reader would mark them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from gcxform_plugins.passes.cycles import ExpandCycles

import gcxform as gx

CONTEXT: Any = None  # the pass asks nothing of it


def marked(*forms: gx.Form) -> gx.Toolpath:
    """Return a path of as many moves, two from each block."""
    path = gx.read(b"G21 G90 G94 F100\n" + b"G1 X1\n" * len(forms), "linuxcnc").path
    return path.replace(form=np.array(forms, np.int8), source=np.arange(len(forms)) // 2 + 1)


def test_rows_of_cycles_become_plain() -> None:
    path = marked(gx.Form.CYCLE, gx.Form.CYCLE, gx.Form.PLAIN, gx.Form.HOME)
    after = ExpandCycles().apply(path, CONTEXT)
    assert after.form.tolist() == [gx.Form.PLAIN] * 3 + [gx.Form.HOME]
    assert after.end is path.end


def test_tapping_is_refused_and_threads_are_no_cycles() -> None:
    thread = marked(gx.Form.CYCLE, gx.Form.CYCLE, gx.Form.SYNCHRONISED, gx.Form.SYNCHRONISED)
    assert ExpandCycles().apply(thread, CONTEXT).form.tolist() == [0, 0, 5, 5]
    with pytest.raises(gx.InputError, match="tapping"):
        ExpandCycles().apply(marked(gx.Form.CYCLE, gx.Form.SYNCHRONISED), CONTEXT)


def test_nothing_to_do() -> None:
    path = marked(gx.Form.PLAIN, gx.Form.SYNCHRONISED)
    assert ExpandCycles().apply(path, CONTEXT) is path
