"""Controls that people have, as tables in a distribution of their own: the guide is enough.

They import what plugins may. Each keeps the contract of dialects, two work offsets stay two, and
everyday programs go from and to controls that are shipped.
"""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path

import pytest

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_dialect

SOURCE = Path(__file__).parent / "controls_dist" / "src"
NAMES = ("Okuma", "Mach3", "Mazak", "Mitsubishi", "Brother")
MAY = {"gcxform", "gcxform_plugins", "gcxform_controls", "collections", "dataclasses", "typing"}
DIALECTS = default_registry().dialects
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0})
HEAD = "G21 G90 G94 G17\n"


@pytest.fixture(scope="module")
def controls():
    sys.path.insert(0, str(SOURCE))
    try:
        yield importlib.import_module("gcxform_controls")
    finally:
        sys.path.remove(str(SOURCE))


@pytest.mark.parametrize("name", NAMES)
def test_they_keep_the_contract(controls, name):
    check_dialect(getattr(controls, name))


def test_they_import_what_plugins_may():
    for path in (SOURCE / "gcxform_controls").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert str(node.module).split(".")[0] in MAY


def said(source, target, blocks):
    result = gx.Pipeline(source, target, (), START).run(blocks.encode())
    assert result.certificate.verified
    return result.text.decode().split("\n")


OKUMA = HEAD + "G15 H1\nG0 X1. Y2. Z3.\nG15 H2\nG0 X1. Y2. Z3.\nG1 X2. F100. M9\nM2\n"


def test_two_work_offsets_of_an_okuma(controls):
    path = gx.read(OKUMA.encode(), controls.Okuma).path
    assert [path.frames[k].work for k in path.frame] == ["G15 H1", "G15 H2", "G15 H2"]
    offsets = {f"G15 H{n}": {"X": 5.0 * (n - 1), "Y": 0.0, "Z": 0.0} for n in (1, 2)}
    path = gx.read(OKUMA.encode(), controls.Okuma, work_offsets=offsets).path
    assert path.end[:, 0].tolist() == [1.0, 6.0, 7.0]
    with pytest.raises(gx.GcxformError, match="cannot say G15"):
        said(controls.Okuma, DIALECTS["fanuc"], OKUMA)


def test_a_machine_file_names_them(tmp_path):
    text = 'format = 1\n[work-offset."G15 H2"]\nX = 5.0\nY = 0.0\nZ = 0.0\n'
    (tmp_path / "m.toml").write_text(text)
    assert load_machine(tmp_path / "m.toml").work_offsets["G15 H2"]["X"] == 5.0


def test_a_mach3_writes_what_others_read(controls):
    arc = "G2 X5. I2. J0. F100."
    program = f"{HEAD}G91.1\nG54\n(MSG, PART)\nG64\nG0 X1. Y2. Z3.\n{arc} M9\nM30\n"
    expected = ["G54", "(MSG, PART)", "G64", "G0 X1. Y2. Z3.", "M9", arc]
    lines = said(controls.Mach3, controls.Mazak, program)
    assert [line for line in lines[1:-2] if line] == expected
    with pytest.raises(gx.GcxformError, match="is a setting"):
        said(controls.Mach3, controls.Mazak, f"{HEAD}G4 P1.\nG0 X1.\nM30\n")


DWELLS = [("Brother", "G4 P1.5"), ("Mazak", "G4 X1.5"), ("Mitsubishi", "G4 X1.5")]


@pytest.mark.parametrize(("target", "expected"), DWELLS)
def test_dwells_of_relatives(controls, target, expected):
    program = HEAD + "G54\nG0 X1. Y2. Z3.\nG4 P1.5\nM2\n"
    assert expected in said(DIALECTS["linuxcnc"], getattr(controls, target), program)
