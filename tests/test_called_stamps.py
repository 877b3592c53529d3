"""What a program calls is executed with it: what was done to that is not done twice."""

from __future__ import annotations

from pathlib import Path

import pytest

import gcxform as gx

MODEL = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"
STAMPED = (
    b"O7\n(GCXFORM STAMP 296434964C0B COMPENSATED BY 0.1.0 VOLUMETRIC)\nG1 X49.95 F100.\nM99\n"
)
MAIN = b"O1\nG21 G90 G94 G17 G54\nG0 X0. Y0. Z5.\nM98 P7\nM30\n"


def test_a_stamped_file_that_is_called(tmp_path: Path) -> None:
    (tmp_path / "O7").write_bytes(STAMPED)
    (tmp_path / "main.nc").write_bytes(MAIN)
    chain = gx.Pipeline.parse(f"volumetric model={MODEL} part-origin=0,0,0 outside=clamp", "fanuc")
    with pytest.raises(gx.InputError, match="GX240") as refused:
        chain.run(tmp_path / "main.nc")
    where = refused.value.diagnostics[0].where
    assert where is not None
    assert where.file.endswith("O7")
    absolute = gx.Pipeline.parse("absolute", "fanuc").run(tmp_path / "main.nc")
    assert absolute.certificate.verified
