"""What one control has no code for is said otherwise in another, and the certificate says so.

The programs are small and the results are worked out by hand from the tables of
`gcxform/dialect/code_translation.py`.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from check_kit import new_in_output

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
START = Reading({"X": 0.0, "Y": 0.0, "Z": 0.0})
HEAD = "G21 G90 G94 G17 G54\n"


def said(source, target, blocks, end="M2", **options):
    """Return what comes out behind the head, without the end, and the sentences about codes."""
    pipeline = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), START, **options)
    program = f"{HEAD}{blocks}\n{end}\n".encode()
    result = pipeline.run(program)
    assert result.certificate.verified
    assert not new_in_output(program, result.text, pipeline)
    lines = result.text.decode().split("\n")
    told = [each for each in result.certificate.assumed if f" for {target}: " in each]
    return lines[1:-2], told


def refused(source, target, blocks, **options):
    with pytest.raises(gx.GcxformError) as error:
        said(source, target, blocks, **options)
    (found, *_) = error.value.diagnostics
    return found


PATH_MODES = [
    ("linuxcnc", "fanuc", "G64 P0.01", ["G64"], ["G64 P is said as G64 for fanuc: 1"]),
    ("linuxcnc", "grbl", "G64 P0.01", [], ["G64 P is left out for grbl: 1"]),
    ("linuxcnc", "fanuc", "G61", ["G61"], []),
    ("linuxcnc", "haas", "G61.1", ["G61"], ["G61.1 is said as G61 for haas: 1"]),
    ("linuxcnc", "grbl", "G61", ["G61"], []),
    ("fanuc", "linuxcnc", "G61", ["G61.1"], ["G61 is said as G61.1 for linuxcnc: 1"]),
    ("fanuc", "linuxcnc", "G64", [], ["G64 is left out for linuxcnc: 1"]),
    ("grbl", "linuxcnc", "G61", ["G61"], []),
    ("fanuc", "haas", "G8 P1", [], ["G8 P is left out for haas: 1"]),
    ("fanuc", "linuxcnc", "G69 G50", [], None),
    ("haas", "fanuc", "G187 P1 E0.01", [], ["G187 PE is left out for fanuc: 1"]),
]


@pytest.mark.parametrize(("source", "target", "block", "expected", "told"), PATH_MODES)
def test_codes_that_change_no_position(source, target, block, expected, told):
    moves = ["G0 X1. Y2. Z3."]
    lines, sentences = said(source, target, "\n".join([block, *moves]))
    assert lines == [*expected, *moves]
    assert told is None or sentences == told


def test_an_exact_stop_has_no_equal_on_grbl():
    found = refused("fanuc", "grbl", "G61\nG0 X1.")
    assert (found.code, found.message) == ("GX501", "grbl cannot say G61")
    lines, told = said("fanuc", "grbl", "G61\nG0 X1.", drop=frozenset({"G61"}))
    assert (lines, told) == (["G0 X1."], ["G61 is left out for grbl: 1"])


def test_a_hint_that_is_pasted_over_a_list_keeps_what_stands_there():
    blocks, more = "M48\nG61\nG0 X1.", frozenset({"M48"})
    assert refused("fanuc", "grbl", blocks, drop=more).hint.startswith('drop = ["M48", "G61"]')
    blocks, more = "M6\nG0 X1. Y0 Z0", {"M8": "M9"}
    hint = refused("fanuc", "grbl", blocks, m_codes=more).hint
    assert hint.startswith('m-codes = { M8 = "M9", M6 = "M0" }')


DWELLS = [
    ("linuxcnc", "fanuc", "G4 P0.5", "G4 X0.5"),
    ("linuxcnc", "fanuc", "G4 P0.057", "G4 X0.057"),
    ("linuxcnc", "fanuc", "G4 P1.2345", "G4 X1.2345"),
    ("grbl", "haas", "G4 P70", "G4 P70000"),
    ("fanuc", "linuxcnc", "G4 P57", "G4 P0.057"),
    ("fanuc", "grbl", "G4 X1.5", "G4 P1.5"),
    ("haas", "linuxcnc", "G4 P1.5", "G4 P1.5"),
    ("haas", "linuxcnc", "G4 P1500", "G4 P1.5"),
]


@pytest.mark.parametrize(("source", "target", "block", "expected"), DWELLS)
def test_dwells_last_as_long(source, target, block, expected):
    assert said(source, target, block)[0] == [expected]


def test_no_cycle_waits_where_a_setting_says_how_long():
    found = refused("linuxcnc", "mach3", "G82 X1 Y2 Z-1 R2 P0.5 F100")
    assert (found.code, found.message) == ("GX501", "mach3 cannot say the DWELL of this cycle")


def test_a_dwell_that_no_word_can_say():
    found = refused("linuxcnc", "haas", "G4 P1.2345")
    assert (found.code, found.where.line) == ("GX501", 2)


BESIDE = [
    ("linuxcnc", "fanuc", "G1 X1. F100. M9", ["M9", "G1 X1. F100."]),
    ("linuxcnc", "fanuc", "G1 X1. F100. M5 M9", ["M5 M9", "G1 X1. F100."]),
    ("fanuc", "linuxcnc", "G1 X1. F100. M9", ["G1 X1. F100.", "M9"]),
    ("fanuc", "grbl", "G1 X1. F100. M5", ["G1 X1. F100.", "M5"]),
    ("fanuc", "linuxcnc", "G1 X1. F100. M8", ["G1 X1. F100. M8"]),
    ("linuxcnc", "fanuc", "M9", ["M9"]),
]


@pytest.mark.parametrize(("source", "target", "block", "expected"), BESIDE)
def test_m_codes_that_act_on_the_other_side_of_a_move(source, target, block, expected):
    assert said(source, target, block)[0] == expected


def test_m_codes_by_a_table_and_those_that_are_dropped():
    codes = {"M88": "M7"}
    lines, told = said("haas", "linuxcnc", "M88\nG0 X1.\nM89\n", m_codes=codes, drop={"M89"})
    assert lines == ["M7", "G0 X1.", ""]
    assert told == [
        "M88 is said as M7 for linuxcnc: 1",
        "M89 is left out for linuxcnc: 1",
    ]
    found = refused("haas", "linuxcnc", "M31")
    assert found.hint == 'drop = ["M31"] in [output] leaves it out'
    found = refused("fanuc", "linuxcnc", "S3000 M13")  # the spindle, with coolant, on many machines
    assert "leaves it out, if it turns no spindle" in found.hint
    stops, _ = said("linuxcnc", "grbl", "T1 M6", m_codes={"M6": "M0"})
    assert stops == ["T1 M0"]


@pytest.mark.parametrize("drop", ["M30", "G1", "G4", "G55", "G28", "M98", "G999"])
def test_what_may_not_be_dropped(drop):
    with pytest.raises(gx.UsageError, match="cannot be left out"):
        gx.Pipeline(DIALECTS["fanuc"], DIALECTS["linuxcnc"], (), START, drop=frozenset({drop}))


def test_m_codes_that_the_target_lacks():
    with pytest.raises(gx.UsageError, match="grbl has no code M6"):
        gx.Pipeline(DIALECTS["fanuc"], DIALECTS["grbl"], (), START, m_codes={"M8": "M6"})


@pytest.mark.parametrize("code", ["M30", "M98", "M99"])
def test_m_codes_that_stand_for_no_other(code):
    with pytest.raises(gx.UsageError, match="ends or calls a program"):
        gx.Pipeline(DIALECTS["fanuc"], DIALECTS["fanuc"], (), START, m_codes={"M8": code})


def test_messages_become_comments():
    lines, told = said("linuxcnc", "fanuc", "(MSG, HELLO)\n(DEBUG, #<_line>)\nG0 X1.")
    assert lines == ["(MSG, HELLO)", "(DEBUG, #<_line>)", "G0 X1."]
    assert told[0] == "(...) is a comment that is not executed for fanuc: 2"
    assert refused("linuxcnc", "fanuc", "(ABORT, NOW)\nG0 X1.").code == "GX501"


def test_options_of_the_pipeline_file(tmp_path):
    (tmp_path / "p.toml").write_text(
        'format = 1\n[input]\ndialect = "haas"\n[output]\ndialect = "linuxcnc"\n'
        'drop = ["M31", "G187"]\nm-codes = { M88 = "M7" }\n'
    )
    plan = gx.Pipeline.load(tmp_path / "p.toml")
    assert plan.drop == {"M31", "G187"}
    assert plan.m_codes == {"M88": "M7"}
    (tmp_path / "p.toml").write_text('format = 1\n[output]\ndrop = ["m08"]\n')
    with pytest.raises(gx.UsageError, match="'m08' is no code"):
        gx.Pipeline.load(tmp_path / "p.toml")


DRILLED = "G0 X0. Y0. Z5.\nG98 G81 X1. Y2. Z-3. R2. F100.\nX3.\nG80\nG0 X0."
HOLES = [((1.0, 2.0), -3.0), ((3.0, 2.0), -3.0)]


@pytest.mark.parametrize(
    ("source", "target", "kept"),
    [
        ("linuxcnc", "fanuc", False),
        ("linuxcnc", "grbl", False),
        ("fanuc", "linuxcnc", False),
        ("haas", "grbl", False),
        ("fanuc", "haas", True),
    ],
)
def test_cycles_become_moves_where_the_target_has_not_the_same(source, target, kept):
    lines, _ = said(source, target, DRILLED)
    assert any("G81" in line for line in lines) == kept
    text = "\n".join([HEAD, *lines]).encode()
    path = gx.read(text, DIALECTS[target], start={"X": 0.0, "Y": 0.0, "Z": 0.0}).path
    cuts = path.end[path.kind == 1]
    assert [(tuple(end[:2].tolist()), float(end[2])) for end in cuts] == HOLES


def test_a_cycle_under_g64_goes_where_nothing_rounds_corners():
    assert said("linuxcnc", "grbl", f"G64 P0.01\n{DRILLED}")[0]
    assert refused("linuxcnc", "fanuc", f"G64 P0.01\n{DRILLED}").code == "GX506"


HOMES = {"G28": {"X": 10.0, "Y": 20.0, "Z": 450.0}, "G30 P3": {"Z": 400.0}}
MACHINE = Reading(homes=HOMES, work_offsets={"G54": {"X": 1.0, "Y": 2.0, "Z": 100.0}})
MACHINE = replace(MACHINE, tools={1: Tool(length=50.0)})
WAYS_HOME = [
    ("fanuc", "linuxcnc", "G91 G28 Z0.", ["G0 G90 G53 Z450."]),
    ("fanuc", "linuxcnc", "G0\nG28 G91 X0. Y0. M5", ["G0", "G90 G53 X10. Y20.", "M5"]),
    ("fanuc", "linuxcnc", "G43 H1 G0 Z5.\nG91 G28 Z0.", ["G43 H1 G0 Z5.", "G90 G53 Z450."]),
    ("fanuc", "linuxcnc", "G91 G30 P3 Z0.", ["G0 G90 G53 Z400."]),
    ("fanuc", "haas", "G91 G28 Z0.", ["G91 G28 Z0."]),
    ("haas", "linuxcnc", "G28", ["G0 G53 X10. Y20. Z450."]),
    ("haas", "grbl", "G91 G28 Z0.\nG90 G1 Z0. F100.", ["G90 G53 Z450.", "G90 G1 Z0. F100."]),
    ("grbl", "fanuc", "G91 G28 Z0.\nG0 X1.", ["G90 G53 Z450.", "G91 G0 X1."]),
    ("fanuc", "haas", "G43 H1 G0 Z5.\nG91 G28 Z0.", ["G43 H1 G0 Z5.", "G90 G53 Z450."]),
    ("haas", "fanuc", "G43 H1 G0 Z5.\nG91 G28 Z0.", ["G43 H1 G0 Z5.", "G91 G28 Z0."]),
]


@pytest.mark.parametrize(("source", "target", "blocks", "expected"), WAYS_HOME)
def test_ways_home_are_moves_in_the_machine(source, target, blocks, expected):
    pipeline = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), MACHINE)
    start = "" if "X1" not in blocks else "G0 X5. Y5. Z5.\n"
    result = pipeline.run(f"{HEAD}{start}{blocks}\nM2\n".encode())
    lines = result.text.decode().split("\n")[1 + bool(start) : -2]
    assert lines == expected


@pytest.mark.parametrize(
    ("target", "block"), [("fanuc", "G28"), ("linuxcnc", "G91 G28 X0. Y0. Z0.")]
)
def test_the_certificate_lists_a_way_home_that_is_said_otherwise(target, block):
    pipeline = gx.Pipeline(DIALECTS["haas"], DIALECTS[target], (), MACHINE)
    certificate = pipeline.run(f"{HEAD}{block}\nM30\n".encode()).certificate
    assert f"G28 is said as G53 for {target}: 1" in certificate.assumed


SIDE = "G0 X-20. Y0. Z5.\nG41 D1 G1 X0. F100.\nX10.\nY10.\n{}\nG91 G28 Z0.\nG90 G0 X0. Y0."


def test_a_way_home_behind_a_contour_that_a_step_resolves():
    step = default_registry().passes["cutter-comp"](corners="arc", entry="own")
    reading = replace(MACHINE, tools={1: Tool(length=50.0, radius=3.0)})
    pipeline = gx.Pipeline(DIALECTS["fanuc"], DIALECTS["linuxcnc"], (step,), reading)
    result = pipeline.run(f"{HEAD}{SIDE.format('G40 X30.')}\nM30\n".encode())
    assert b"\nG0 G90 G53 Z450.\n" in result.text
    with pytest.raises(gx.GcxformError, match="of its own kind"):
        pipeline.run(f"{HEAD}{SIDE.format('G40')}\nM30\n".encode())


@pytest.mark.parametrize(
    ("blocks", "homes"),
    [
        ("G91 G28 Z0.", {}),
        ("G90 G28 Z50.", HOMES),
        ("G91 G28 Z5.", HOMES),
        ("G91 G28 Z0. X0.", {"G28": {"Z": 450.0}}),
    ],
)
def test_a_way_home_that_is_not_known_is_refused(blocks, homes):
    reading = Reading(homes=homes, work_offsets=MACHINE.work_offsets)
    pipeline = gx.Pipeline(DIALECTS["fanuc"], DIALECTS["linuxcnc"], (), reading)
    with pytest.raises(gx.GcxformError) as error:
        pipeline.run(f"{HEAD}G0 Z1.\n{blocks}\nM30\n".encode())
    assert error.value.diagnostics[0].code == "GX501"


SETS = [
    ("linuxcnc", "grbl", "G92 X1. Y2."),
    ("grbl", "fanuc", "G92 X1. Y2."),
    ("fanuc", "grbl", "G10 L2 P2 X1. Y0. Z0."),
]


@pytest.mark.parametrize(("source", "target", "block"), SETS)
def test_codes_that_set_zeros_by_words_that_both_take(source, target, block):
    assert said(source, target, f"{block}\nG0 X5. Y5. Z5.")[0] == [block, "G0 X5. Y5. Z5."]


def test_a_word_that_one_of_them_takes_is_refused():
    assert refused("linuxcnc", "grbl", "G10 L2 P2 X1. R30.\nG0 X5.").code == "GX501"


@pytest.mark.parametrize("target", ["fanuc", "haas"])
def test_a_zero_that_is_turned_is_folded_away(target):
    found = refused("linuxcnc", target, "G10 L2 P2 X0. Y0. R45.")
    assert (found.code, found.where.line) == ("GX213", 2)
    assert found.hint == 'put the pass "offsets" before'
