"""What a user says of a SINUMERIK that its programs do not: variables, motion, what changes tools.

And what may not be known behind lines that stay as they stand.
"""

from __future__ import annotations

import pytest
from gcxform_plugins.dialects.siemens.axes_of_lines import axes_of
from gcxform_plugins.passes.absolute import Absolute

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

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
