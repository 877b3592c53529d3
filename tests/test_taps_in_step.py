"""A tap in step with the spindle in other languages: `compare` sees all that makes it one."""

import pytest

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

WORDS = b"G21 G17 G90 G94\nG0 X0 Y0 Z5\nS300 M3\nG33.1 Z-10 K1.25\nG0 Z9\nM2\n"
AT = Reading({"X": 0.0, "Y": 0.0, "Z": 5.0})
OTHERWISE = {
    "pitch": (("K1.25", "K1.5"), ("Q239=+1.25", "Q239=+1.5")),
    "depth": (("G331 Z-10", "G331 Z-9"), ("Q201=-14", "Q201=-13")),
    "speed": (("S300", "S400"),),
    "hand": (("K1.25", "K-1.25"), ("Q239=+1.25", "Q239=-1.25"), ("M3", "M4")),
    "a plain move": (
        ("SPOS=0\nG331 Z-10 K1.25 S300\nG332 Z5 K1.25\nM3 S300\n", "G1 Z-10 F375\nG1 Z5\n"),
        ("CYCL CALL\n6 M3\n", "L Z-10 F375\n6 L Z+5 F375\n"),
    ),
}


@pytest.mark.parametrize("name", ["siemens", "heidenhain"])
def test_another_tap_is_another_program(name):
    words, there = default_registry().dialect("linuxcnc"), default_registry().dialect(name)
    said = Pipeline(words, there, (), AT).run(WORDS).text.decode()
    first = gx.Program(WORDS, words, AT)
    assert gx.compare(first, gx.Program(said.encode(), there, AT), 0.001).same
    for what, changes in OTHERWISE.items():
        other = said
        for old, new in changes:
            other = other.replace(old, new)
        assert other != said, what
        assert not gx.compare(first, gx.Program(other.encode(), there, AT), 0.001).same, what
