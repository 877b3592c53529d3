"""How far the grounds of holes are off that are called as they stand: what the certificate says."""

from __future__ import annotations

from pathlib import Path

import pytest

import gcxform as gx

PIPELINE = """format = 1
[input]
dialect = "siemens"
[output]
structure = "keep"
[[pass]]
use = "volumetric"
model = "model.toml"
tolerance = {}
lean = 0.1
part-origin = [0.0, 0.0, 0.0]
"""
MODEL = """format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
order = "XYZ"
[Z]
position = [-100.0, 100.0]
EXZ = [-0.03, 0.03]
EYZ = [0.04, -0.04]
EZZ = [-0.1, 0.1]
"""
ACROSS = "holes called as they stand: grounds off across the tool, mm"
ALONG = "holes called as they stand: grounds off along the tool, mm"


def figures(folder: Path, *lines: str, tolerance: float = 0.1) -> dict[str, float]:
    """Return what the certificate of a program has measured."""
    (folder / "model.toml").write_text(MODEL)
    (folder / "p.toml").write_text(PIPELINE.format(tolerance))
    text = "\n".join(("N1 G17 G90 G54 G94 S500 M3", *lines, "M30", "")).encode()
    result = gx.Pipeline.load(folder / "p.toml").run(text)
    return dict(result.certificate.measured)


def test_the_certificate_says_how_far_grounds_are_off(tmp_path: Path) -> None:
    """Called at Z20, down to Z-60: 80 mm of a column that leans by 0.5 um a mm; 60 um too short."""
    hole = "CYCLE84(16,10,5,-60,,0,3,,1,0,500,500,0,1,,0,,,,,,0,0,1001002)"
    found = figures(tmp_path, "G710", "G0 X10 Y20 Z20", hole)
    assert found[ACROSS] == pytest.approx(80 * 0.0005, abs=1e-4)
    assert found[ALONG] == pytest.approx(60 * 0.001, abs=1e-4)


def test_grounds_in_inches(tmp_path: Path) -> None:
    """An inch is as deep as 25.4 mm."""
    found = figures(tmp_path, "G700", "G0 X1 Y1 Z1", "CYCLE840(1,.5,.1,-1,0,,,3,,1)")
    assert found[ACROSS] == pytest.approx(2 * 25.4 * 0.0005, abs=1e-4)
    assert found[ALONG] == pytest.approx(25.4 * 0.001, abs=1e-4)


def test_a_program_without_such_holes_says_nothing(tmp_path: Path) -> None:
    """Nothing is measured where nothing is called as it stands."""
    assert not figures(tmp_path, "G710", "G0 X10 Y20 Z20", "G1 Z-5 F100")


def test_a_hint_does_not_drill_again(tmp_path: Path) -> None:
    """Under MCALL a rapid between would be a hole more."""
    hole = "MCALL CYCLE840(16,10,5,-1,0,,,3,,1)"
    with pytest.raises(gx.InputError) as caught:
        figures(tmp_path, "G710", "G0 X10 Y20 Z16", hole, "X30", "G1 Z5 F100", tolerance=0.01)
    (said,) = caught.value.diagnostics
    assert said.code == "GX317"
    assert said.hint.startswith("end the modal call")
