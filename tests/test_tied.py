"""The proof sees a thread or a probe that became something else."""

from types import SimpleNamespace

import numpy as np
import pytest

import gcxform as gx
from gcxform.proof.trace import Trace
from gcxform.proof.verify import Verifier
from gcxform.toolpath.facts import between_taps
from gcxform.toolpath.path import Form


def test_the_proof_compares_forms():
    written = gx.read(b"G0 X0 Y0 Z5\nS100 M3\nG95 F1.5 G1 Z-5\nM2\n", "linuxcnc").path
    before = written.replace(form=(written.form + np.array([0, Form.THREAD])).astype("int8"))
    assert before.feed_mode.tolist() == written.feed_mode.tolist()
    verifier = object.__new__(Verifier)
    verifier.file = "-"
    lines = np.arange(4)
    same = Trace(written, range(4), written, written, lines, lines * 0, 0)
    told = SimpleNamespace(modes=SimpleNamespace(motion=np.zeros(4, np.int64)))
    verifier._forms(same, told, told)
    other = Trace(before, range(4), written, written, lines, lines * 0, 0)
    with pytest.raises(gx.VerificationError, match="tied to the spindle"):
        verifier._forms(other, told, told)


def test_only_what_has_no_words_may_be_off_between_taps():
    """R and the depth are never among it; the way out is where it leads past R."""
    text = b"G21 G90 G94\nS500 M3\nG0 X0. Y0. Z9.\nG98 G84 X5. Z-5. R2. F500.\nG99 X9.\nG80\nM2\n"
    path = gx.read(text, "linuxcnc").path
    ends = [(x, z) for x, _, z in path.end[between_taps(path), :3].tolist()]
    assert ends == [(5, 9), (5, 9), (9, 9)]
    fanuc = gx.read(text, "fanuc").path
    tied = fanuc.form == Form.SYNCHRONISED
    assert tied.sum() == 4
    assert not between_taps(fanuc)[tied].any()
