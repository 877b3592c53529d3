"""What a user says of a SINUMERIK that its programs do not: variables, motion, what changes tools.

And what may not be known behind lines that stay as they stand.
"""

from __future__ import annotations

import pytest
from gcxform_plugins.dialects.siemens.axes_of_lines import axes_of
from gcxform_plugins.passes.absolute import Absolute

import gcxform as gx
from gcxform.flow.translated import translated
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

SIEMENS = default_registry().dialect("siemens")
HEAD = "G710 G17 G90 G94\nG0 X1 Y2 Z3 C5\nG1 F100\n"


def own(text, **reading):
    """Return a program written for the same control."""
    made = Pipeline(SIEMENS, SIEMENS, (Absolute(),), Reading(**reading))
    return made.run((HEAD + text).encode()).text.decode().removeprefix(HEAD)


def ends(text, **reading):
    return gx.read((HEAD + text).encode(), SIEMENS, **reading).path.end[1:].tolist()


def test_what_is_told_twice_is_refused():
    with pytest.raises(gx.InputError, match="beside both coordinates"):
        ends("X20 Y5 ANG=30\n")


def test_a_call_may_set_what_is_given():
    given = {"parameters": {"<HIGH_>": 4.0}}
    assert own("Z=IC(HIGH_)\n", **given) == "Z=7\n"
    assert own("OTHER_(1)\nG90 G0 Z5\nZ=IC(HIGH_)\n", **given).endswith("Z=IC(HIGH_)\n")


def test_what_the_program_defines_is_not_what_is_given():
    assert ends("DEF REAL HIGH_=2\nZ=HIGH_\n", parameters={"<HIGH_>": 4.0})[0][2] == 2.0


@pytest.mark.parametrize("said", ["SPOS=90", "SPOS[1]=90", "SPOS=DC(90)"])
def test_a_spindle_moves_no_linear_axis(said):
    assert own(f"{said}\nX=IC(1)\n") == f"{said}\nX=2\n"


@pytest.mark.parametrize("said", ["TOFFL=2", "TOFF=2", "TOFFL=2*1"])
def test_what_adds_to_a_length_loses_where_the_tool_is(said):
    assert own(f"{said}\nZ=IC(1)\n") == f"{said}\nZ=IC(1)\n"
    assert own(f"{said}\nZ5\nZ=IC(1)\n") == f"{said}\nZ5\nZ=6\n"


def test_a_spindle_may_be_a_rotary_axis():
    turned = gx.Item("named", ("SPOS",), ("90",), (0, 0))
    assert axes_of([turned], frozenset(), frozenset()) == "ABC"


def test_a_tool_that_t_changes_may_leave_all_axes_elsewhere():
    assert own("T5\nC=AC(3) X=IC(1)\n") == "T5\nC=AC(3) X=IC(1)\n"
    with pytest.raises(gx.InputError, match="whether it changes the tool"):
        ends("T5\nX9\n")
    assert ends("T5\nX9\n", control={"tool-change-by": "M6"})[0][0] == 9.0


@pytest.mark.parametrize(("motion", "kind"), [("G0", 0), ("G1", 1)])
def test_the_motion_at_the_start_is_said(motion, kind):
    text = b"G710 G17 G90 G94 F100\nX5\n"
    path = gx.read(text, SIEMENS, control={"motion-at-start": motion}).path
    assert [*path.kind] == [kind]


SECTION = "G0 X0\nROW: G1 X=IC(1)\n"


@pytest.mark.parametrize(
    ("said", "why"),
    [
        ("REPEATB ROW", "of the ways of REPEAT"),
        ("REPEAT ROW ROW", "of the ways of REPEAT"),
        ("REPEAT ROW X2", "of the ways of REPEAT"),
        ("REPEAT ROW P=0", "REPEAT for 0 times"),
        ("REPEAT ROW P=1.5", "P of a number that is not whole"),
        ("REPEAT UNSEEN", "no UNSEEN before this"),
        ("REPEAT LATER\nLATER: X5", "no LATER before this"),
        ("ROW: X7\nREPEAT ROW", "or several"),
        ("IF 1\nREPEAT ROW\nENDIF", "left or entered on the way"),
        ("IF R1 GOTOF NEXT\nNEXT:\nREPEAT ROW", "left or entered on the way"),
        ("ENDLABEL:\nREPEAT ROW", "left or entered on the way"),
        ("REPEAT ROW\nREPEAT ROW", "left or entered on the way"),
        ("REPEAT ROW P=R7", "the value of R7"),
    ],
)
def test_other_ways_to_repeat_a_section_are_refused(said, why):
    with pytest.raises(gx.InputError, match=why):
        ends(f"R1=1\n{SECTION}{said}\n", control={"section-repeats": "further"})


@pytest.mark.parametrize(("counts", "passes"), [("further", 4), ("in-all", 3)])
def test_a_section_is_repeated_as_often_as_the_machine_file_says(counts, passes):
    found = ends(f"{SECTION}REPEAT ROW P=3\nX50\n", control={"section-repeats": counts})
    assert [end[0] for end in found] == [*range(passes + 1), 50.0]


def test_it_is_repeated_in_each_pass_of_a_loop_around_it():
    text = f"R1=0\nWHILE R1<2\nR1=R1+1\n{SECTION}REPEAT ROW\nENDWHILE\n"
    found = ends(text, control={"section-repeats": "further"})
    assert [end[0] for end in found] == [0.0, 1.0, 2.0] * 2


def test_a_comment_of_another_language_is_nothing_that_goes_along():
    text = b"G21 G90 G17 G94\n(\x01G642)\nG0 X1 Y2\nM2\n"
    written = Pipeline(default_registry().dialect("linuxcnc"), SIEMENS, (Absolute(),), Reading())
    assert b"\n; \x01G642\n" in written.run(text).text


@pytest.mark.parametrize("said", ["; \x01G642", 'MSG("\x01G642"<<1) ;', "X1 ; \x01SOFT"])
def test_a_comment_of_the_same_language_is_nothing_that_goes_along_either(said):
    source = Source.of_bytes(f"G710 G17 G90 G94 G0\n{said}\nM30\n".encode("latin-1"))
    blocks = translated(source, SIEMENS, Reading(asides=True)).text.decode("latin-1").splitlines()
    lines = SIEMENS.translator.speller("A", False)
    lines.asides = True
    assert not {*lines.heard(blocks[1])[0]} & {"G642", "SOFT"}
