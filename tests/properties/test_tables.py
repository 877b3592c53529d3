"""Whatever stands in a foreign table: it is read, or refused with a code and a place."""

from __future__ import annotations

import math

import pytest
import test_height_formats as heights
import test_linuxcnc_comp as comp
import test_parameter_formats as parameters
import test_positioning_formats as positioning
import test_siemens_formats as siemens
from hypothesis import given, settings
from hypothesis import strategies as st

from gcxform.catalogue import CATALOGUE
from gcxform.diagnostics import UsageError

ORIGIN = (0.0, 0.0, 0.0)
SAMPLES = {
    "linuxcnc-comp": (comp.LinuxCncComp("0", "mm", "X"), comp.TYPE0),
    "isg-csv": (parameters.IsgCsv("error", "XYZ", ORIGIN), parameters.ISG),
    "etalon": (parameters.Etalon("error", "XYZ", ORIGIN), parameters.ETALON),
    "xyz": (heights.Xyz("mm"), heights.XYZ),
    "bcnc-probe": (heights.BcncProbe("mm"), heights.PROBE),
    "klipper-mesh": (heights.KlipperMesh(), heights.CFG),
    "klipper-skew": (heights.KlipperSkew(), heights.SKEW),
    "siemens-eec": (siemens.SiemensEec("mm"), siemens.EEC),
    "siemens-cec": (siemens.MINUS, siemens.CEC),
    "iso230 long": (positioning.Iso230Csv(), positioning.LONG),
    "iso230 wide": (positioning.Iso230Csv(), positioning.WIDE),
    "renishaw-rtl": (positioning.UM, positioning.RTL),
}
WORDS = [
    "0",
    "1",
    "-1",
    "1e9",
    "nan",
    "-inf",
    "1e999",
    "=",
    "[",
    "]",
    "{",
    "}",
    ",",
    ";",
    "#",
    "//",
    ":",
    "::",
    "+",
    "-",
    "X",
    "EXX",
    "C0Y",
    "é",
    "99999999",
]
PIECES = st.sampled_from(["", "\n", "\n\n", " ", "\t", "\ufeff", *WORDS])
EDITS = st.lists(st.tuples(st.floats(0, 1), st.integers(0, 12), PIECES), min_size=1, max_size=4)


@pytest.mark.parametrize("name", SAMPLES)
@settings(max_examples=60)
@given(edits=EDITS)
def test_a_spoilt_table_is_read_or_refused(tmp_path_factory, name, edits):
    form, text = SAMPLES[name]
    for where, length, piece in edits:
        at = int(where * len(text))
        text = text[:at] + piece + text[at + length :]
    path = tmp_path_factory.mktemp("table") / "table.txt"
    path.write_text(text, encoding="utf-8")
    type(form).recognises(path)
    model, found = None, ()
    try:
        model = form.read(path)
    except UsageError as error:
        found = error.diagnostics
    assert all(d.code in CATALOGUE for d in found)
    assert (model is None) == bool(found)
    if model is not None:
        assert all(math.isfinite(end) for nodes in model.nodes for end in nodes)
        assert model.lipschitz() >= 0.0
