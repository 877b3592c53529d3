"""Controls that people have: what each says otherwise than its kin, from and to others.

Their tables rest on `check_dialect` (test_kit_dialects.py), on the facts of test_dialect_facts.py
and on the cases in corpus/dialects/controls; here is what takes two of them, or a machine file.
"""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.machine.file import load_machine
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0})
HEAD = "G21 G90 G94 G17\n"
OKUMA = HEAD + "G15 H1\nG0 X1. Y2. Z3.\nG15 H2\nG0 X1. Y2. Z3.\nG1 X2. F100. M9\nM2\n"


def said(source, target, blocks, reading=START):
    """Return what a program is written as, without what is the same in both."""
    pipeline = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), reading)
    result = pipeline.run((HEAD + blocks).encode())
    assert result.certificate.verified
    return result.text.decode().removeprefix(HEAD)


def test_two_work_offsets_of_an_okuma():
    path = gx.read(OKUMA.encode(), "okuma").path
    assert [path.frames[k].work for k in path.frame] == ["G15 H1", "G15 H2", "G15 H2"]
    offsets = {f"G15 H{n}": {"X": 5.0 * (n - 1), "Y": 0.0, "Z": 0.0} for n in (1, 2)}
    path = gx.read(OKUMA.encode(), "okuma", work_offsets=offsets).path
    assert path.end[:, 0].tolist() == [1.0, 6.0, 7.0]
    with pytest.raises(gx.GcxformError, match="cannot say G15"):
        said("okuma", "fanuc", OKUMA)


APART = [
    ("okuma", "fanuc", "G15 H1", "cannot say G15"),
    ("okuma", "linuxcnc", "G15 H1", "cannot say G15"),  # the 15 of others ends polar words
    ("fanuc", "okuma", "G54", "cannot say G54"),
    ("linuxcnc", "okuma", "G56", "cannot say G56"),  # there a length
    ("fanuc", "okuma", "G53 G0 Z0.", "cannot say G53"),  # there the end of a length
    ("mach3", "okuma", "G54", "cannot say G54"),
]
LENGTHS = [("G43 H1", "G56 H1"), ("G43 H1 Z50.", "G56 H1 Z50."), ("G49", "G53")]


@pytest.mark.parametrize(("source", "target", "block", "message"), APART)
def test_work_offsets_and_lengths_of_an_okuma_are_its_own(source, target, block, message):
    """G15 H1 and G54 are two acts, in tables of their own: nothing says that they are one."""
    with pytest.raises(gx.GcxformError, match=message):
        said(source, target, f"G0 X1. Y2. Z3.\n{block}\nG1 X2. F100.\nM2\n")


@pytest.mark.parametrize(("block", "there"), LENGTHS)
def test_a_length_of_an_okuma_has_the_codes_of_work_offsets(block, there):
    program = "G0 X1. Y2. Z3.\n{}\nG1 X2. F100.\nM2\n".format
    for other in ("fanuc", "haas", "mach3"):
        assert said("okuma", other, program(there)) == program(block)
        assert said(other, "okuma", program(block)) == program(there)


def test_a_program_that_says_no_work_offset_names_that_of_its_control():
    blocks = HEAD + "G0 X1. Y2. Z3.\nM2\n"
    works = [gx.read(blocks.encode(), name).path.frames[0].work for name in ("okuma", "fanuc")]
    assert works == ["G15 H1", "G54"]
    with pytest.raises(gx.GcxformError, match="G54"):
        _ = gx.read((HEAD + "G54\nG0 X1. Y2. Z3.\n").encode(), "okuma").path


def test_a_machine_file_names_them(tmp_path):
    text = 'format = 1\n[work-offset."G15 H2"]\nX = 5.0\nY = 0.0\nZ = 0.0\n'
    (tmp_path / "m.toml").write_text(text)
    assert load_machine(tmp_path / "m.toml").work_offsets["G15 H2"]["X"] == 5.0


DWELLS = [
    ("brother", "G4 P1.5"),
    ("mazak", "G4 X1.5"),
    ("mitsubishi", "G4 X1.5"),
    ("hurco", "G4 P1.5"),
    ("uccnc", "G4 P1500"),
    ("centroid", "G4 P1.5"),
    ("fluidnc", "G4 P1.5"),
]


@pytest.mark.parametrize(("target", "expected"), DWELLS)
def test_dwells(target, expected):
    lines = said("linuxcnc", target, "G54\nG0 X1. Y2. Z3.\nG4 P1.5\nM2\n")
    assert lines.split("\n")[2] == expected


OPEN = ("mach3", "mach4", "masso", "okuma")


@pytest.mark.parametrize("source", OPEN)
def test_a_dwell_of_which_the_unit_is_open_stays_in_its_control(source):
    block = "G4 F1.5\n" if source == "okuma" else "G4 P500\n"
    program = f"G0 X1. Y2. Z3.\n{block}M2\n"
    assert said(source, source, program) == program
    for target in {*OPEN, "linuxcnc", "uccnc", "fanuc"} - {source}:
        with pytest.raises(gx.GcxformError, match="G4"):
            said(source, target, program)
    if source != "okuma":
        with pytest.raises(gx.GcxformError, match="G4"):
            said("linuxcnc", source, program)


ARC = "G0 X1. Y2. Z3.\nG2 X5. Y2. I2. J0. F100.\nM2\n"


@pytest.mark.parametrize("name", ["mach3", "mach4"])
def test_centres_that_a_setting_counts_are_stated(name):
    """An arc for a Mach3 says how its centre counts; one of a Mach3 that does not is refused."""
    assert "G91.1 G2 X5. Y2. I2. J0." in said("linuxcnc", name, ARC)
    with pytest.raises(gx.GcxformError, match="J and K count"):
        said(name, "linuxcnc", ARC)
    stated = said(name, "linuxcnc", "G91.1\n" + ARC)
    given = Reading(START.start, control={"arc-centres": "incremental"})
    assert said(name, "linuxcnc", ARC, given) in stated
    absolute = "G90.1\n" + ARC.replace("I2. J0.", "I3. J2.")
    with pytest.raises(gx.GcxformError):
        said(name, "linuxcnc", "G90.1\n" + ARC)
    assert "I3. J2." in said(name, "linuxcnc", absolute)


def test_a_mach3_writes_what_others_read():
    program = f"G91.1\nG54\n(MSG, PART)\nG64\n{ARC.replace('F100.', 'F100. M9')}"
    lines = [line for line in said("mach3", "mazak", program).split("\n") if line]
    assert lines == [
        "G54",
        "(MSG, PART)",
        "G64",
        "G0 X1. Y2. Z3.",
        "M9",
        "G2 X5. Y2. I2. J0. F100.",
        "M2",
    ]


def test_a_centroid_starts_in_inches():
    assert said("centroid", "linuxcnc", "M2\n") == "M2\n"
    result = gx.Pipeline(DIALECTS["centroid"], DIALECTS["linuxcnc"], (), START)
    assert b"G20" in result.run(b"G90\nG0 X1.\nM2\n").text


@pytest.mark.parametrize("name", ["tinyg", "g2core"])
@pytest.mark.parametrize("window", [1, 1 << 20])
def test_the_end_of_a_tinyg_ends_a_shift(name, window, monkeypatch):
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", window)
    program = b"G21 G90\nG0 X1\nG92 X5\nG91 G0 X1\nM2\nG0 X7\nG92 X0\nM30\n"
    path = gx.read(program + b"G0 X1\n", name, start={"X": 0.0}).path
    assert path.end[:, 0].tolist() == [1.0, 2.0, 7.0, 1.0]
    whole = gx.read(program + b"G0 X1\nM2\nG0 X2\n", name, start={"X": 0.0}).path
    assert whole.end[:, 0].tolist() == [1.0, 2.0, 7.0, 1.0, 2.0]


E_MODES = "{}\nG1 X10 Y0 Z0 E1 F600\n{}\nG1 X20 E1\n"
FED = [
    ("rrf", "M83", "G90", 2.0),
    ("prusa", "M83", "G90", 2.0),
    ("klipper", "M83", "G90", 2.0),
    ("smoothieware", "M83", "G90", 1.0),
    ("marlin2", "M83", "G90", 1.0),
    ("marlin2", "M82", "G91", 2.0),
    ("rrf", "M82", "G91", 1.0),
    ("prusa", "M82", "G91", 1.0),
    ("klipper", "M82", "G91", 2.0),
    ("smoothieware", "M82", "G91", 2.0),
]


@pytest.mark.parametrize(("name", "mode", "then", "fed"), FED)
def test_what_makes_filament_a_distance(name, mode, then, fed):
    program = E_MODES.format(f"G90\n{mode}", then).encode()
    assert gx.read(program, name).path.end[-1, 3] == pytest.approx(fed)
    with pytest.raises(gx.GcxformError, match="firmware differs"):
        _ = gx.read(program, "marlin").path
