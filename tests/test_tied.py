"""The proof sees a thread or a probe that became something else."""

import numpy as np
import pytest

import gcxform as gx
from gcxform.toolpath.path import Form
from gcxform.trace import Trace
from gcxform.verify import Verifier


def test_the_proof_compares_forms():
    written = gx.read(b"G0 X0 Y0 Z5\nS100 M3\nG95 F1.5 G1 Z-5\nM2\n", "linuxcnc").path
    before = written.replace(form=(written.form + np.array([0, Form.THREAD])).astype("int8"))
    assert before.feed_mode.tolist() == written.feed_mode.tolist()
    verifier = object.__new__(Verifier)
    verifier.file = "-"

    class Window:
        first_line = 0

        def __len__(self):
            return 4

    lines = np.arange(4)
    same = Trace(written, Window(), written, written, lines, lines * 0, 0)
    verifier._forms(same)
    other = Trace(before, Window(), written, written, lines, lines * 0, 0)
    with pytest.raises(gx.VerificationError, match="tied to the spindle"):
        verifier._forms(other)
