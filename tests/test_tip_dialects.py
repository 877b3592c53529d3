"""One part for three controls, each with its own code that lets it follow the tip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from rtcp_kit import positions

import gcxform as gx
from gcxform.plugin.registry import default_registry

FOLDER = Path(__file__).parents[1] / "examples" / "tip-codes"
PROGRAMS = {"siemens": "dish.mpf", "heidenhain": "dish.h", "fagor": "dish.nc"}
SWITCHES = {
    "siemens": ("TRAORI", "TRAFOOF"),
    "heidenhain": ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM"),
    "fagor": ("#RTCP ON", "#RTCP OFF"),
}
PIPELINE = (FOLDER / "dish.toml").read_text("utf-8")


def converted(folder, dialect, text, pipeline=PIPELINE):
    """Return what becomes of a program of a dialect."""
    (folder / "machine.toml").write_bytes((FOLDER / "machine.toml").read_bytes())
    (folder / "p.toml").write_text(pipeline.replace('"fagor"', f'"{dialect}"'), "utf-8")
    return gx.Pipeline.load(folder / "p.toml").run(text)


def places(text):
    """Return where the axes stand after each block that moves them (n, 5)."""
    moving = [line for line in text.splitlines() if {*b"XYZAC"} & {*line.split(b"(")[0]}]
    return positions(b"\n".join(moving), "XYZAC")


def program(dialect):
    return (FOLDER / PROGRAMS[dialect]).read_bytes()


def test_all_become_the_same_moves(tmp_path):
    found = {name: converted(tmp_path, name, program(name)) for name in PROGRAMS}
    assert all(result.certificate.verified for result in found.values())
    one, *others = (places(result.text) for result in found.values())
    assert len(one) > 100
    for other in others:
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("dialect", PROGRAMS)
def test_without_the_codes_it_is_another_path(tmp_path, dialect):
    text = program(dialect)
    for code in SWITCHES[dialect]:
        assert text.count(code.encode()) == 1
        text = text.replace(code.encode(), b"")
    with pytest.raises(gx.InputError, match="GX320"):
        converted(tmp_path, dialect, text)


@pytest.mark.parametrize("dialect", PROGRAMS)
@pytest.mark.parametrize("passes", ["absolute", "segment", "volumetric"])
def test_nothing_corrects_what_the_control_corrects(tmp_path, dialect, passes):
    """Only `rtcp`, told to, takes the place of the code; all else would come on top of it."""
    head = PIPELINE[: PIPELINE.index("[[pass]]")]
    tail = PIPELINE[PIPELINE.index("[output]") :]
    model = (FOLDER.parent / "lddm" / "model.toml").as_posix()
    steps = {
        "absolute": '[[pass]]\nuse = "absolute"\n',
        "segment": '[[pass]]\nuse = "segment"\nchord-error = "1 um"\n',
        "volumetric": '[[pass]]\nuse = "absolute"\n[[pass]]\nuse = "volumetric"\n'
        f'model = "{model}"\ntolerance = "5 um"\npart-origin = [100.0, 100.0, 100.0]\n',
    }
    with pytest.raises(gx.InputError) as caught:
        converted(tmp_path, dialect, program(dialect), head + steps[passes] + tail)
    (found, *_) = caught.value.diagnostics
    assert found.code == "GX210"
    assert "follows the tip of the tool itself" in found.message
    assert SWITCHES[dialect][0] in found.where.text


@pytest.mark.parametrize("dialect", PROGRAMS)
@pytest.mark.parametrize("name", ["to-tip", "repost"])
def test_positions_of_axes_are_not_those_of_tips(tmp_path, dialect, name):
    said = 'calibrated = "machine.toml"\n' if name == "repost" else ""
    pipeline = PIPELINE.replace('tip-codes = "read"\nrapids = "ends"\n', said)
    pipeline = pipeline.replace('use = "rtcp"', f'use = "{name}"')
    with pytest.raises(gx.InputError, match="GX210"):
        converted(tmp_path, dialect, program(dialect), pipeline)


@pytest.mark.parametrize("dialect", PROGRAMS)
def test_it_is_known_what_they_are_written_in(dialect):
    assert gx.guess_dialect(program(dialect)).dialects == (dialect,)


@pytest.mark.parametrize("dialect", PROGRAMS)
def test_a_program_is_copied_and_not_written(dialect):
    kind = default_registry().dialect(dialect)
    assert gx.Pipeline(kind, kind).run(program(dialect)).text == program(dialect)
    with pytest.raises(gx.UsageError, match="GX747"):
        gx.Pipeline.parse("renumber", dialect)
