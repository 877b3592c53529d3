"""Texts in programs for a SINUMERIK: functions, joins, lengths, and what no source tells."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.plugin.registry import default_registry

SIEMENS = default_registry().dialect("siemens")
HEAD = 'G710 G17 G90 G94 G0\nDEF STRING[9] AA="a.b.c", BB\nDEF CHAR CH=65\nDEF BOOL YES=TRUE\n'


def x_of(text):
    """Return where X goes in the last block of a program."""
    found = gx.read(f"{HEAD}{text}\n".encode(), SIEMENS).executed.decode()
    return float(found.splitlines()[-1].removeprefix("X"))


@pytest.mark.parametrize(
    ("said", "worth"),
    [
        ("STRLEN(AA)", 5),
        ('STRLEN("")', 0),
        ('INDEX(AA,".")', 1),
        ('RINDEX(AA,".")', 3),
        ('INDEX(AA,"x")', -1),
        ('INDEX("xAx",CH)', 1),
        ('NUMBER("-2.5")', -2.5),
        ('NUMBER(SUBSTR("N0123",2))', 123),
        ('NUMBER(SUBSTR("N0123",2,2))', 12),
        ('ISNUMBER("7.")', 1),
        ('ISNUMBER("7 mm")', 0),
        ('TOUPPER("aB1")=="AB1"', 1),
        ('TOLOWER("aB1")=="ab1"', 1),
        ('("a"<<1.50<<R1)=="a1.5-2"', 1),
    ],
)
def test_functions_give_what_the_manual_says(said, worth):
    assert x_of(f"R1=-2\nX={said}") == worth


@pytest.mark.parametrize(
    "line",
    [
        'X=STRLEN("a"<<CH)',
        'X=STRLEN("a"<<YES)',
        'X=STRLEN("a"<<(1==1))',
        'X=STRLEN("a"<<NOT YES)',
        "X=STRLEN(5)",
        'X=NUMBER("1EX3")',
        'X=ISNUMBER("1EX3")',
        'X=ISNUMBER("")',
        'X=NUMBER("")',
        "X=STRLEN(SUBSTR(AA,5))",
        "X=STRLEN(SUBSTR(AA,1,5))",
        "X=STRLEN(SUBSTR(AA,-1))",
        'X=INDEX(AA,"..")',
        "X=INDEX(AA,1.5)",
        'X=STRLEN(TOUPPER("\xe4"))',
        'X=STRLEN("a","b")',
        'BB="0123456789"',
        "X=SIN(AA)",
    ],
)
def test_what_no_source_tells_has_no_value(line):
    with pytest.raises(gx.InputError, match="GX221"):
        _ = gx.read(f"{HEAD}{line}\n".encode("latin-1"), SIEMENS).executed


def test_an_empty_text_takes_the_place_of_another():
    assert x_of('BB="q"\nBB=""\nX=STRLEN(BB)') == 0


def test_a_text_of_a_parameter_is_not_longer_than_it_says(tmp_path):
    (tmp_path / "SAYS.SPF").write_text("PROC SAYS(STRING[3] NN)\nX=STRLEN(NN)\nM17\n")
    for text, good in (("abc", True), ("abcd", False)):
        program = f'{HEAD}SAYS("{text}")\n'.encode()
        found = gx.read(program, SIEMENS, subprograms=(tmp_path,))
        if good:
            assert found.executed.endswith(b"X3\n")
            continue
        with pytest.raises(gx.InputError, match=r"STRING\[3\]"):
            _ = found.executed


def test_a_value_that_a_call_cannot_have_is_refused(tmp_path):
    (tmp_path / "TAKES.SPF").write_text("PROC TAKES(REAL NN)\nX=NN\nM17\n")
    for call in ("TAKES(1/0)", "TAKES(1) P=0.5/0"):
        found = gx.read(f"{HEAD}{call}\n".encode(), SIEMENS, subprograms=(tmp_path,))
        with pytest.raises(gx.InputError, match="GX221"):
            _ = found.executed


def test_a_message_that_is_computed_is_told_as_far_as_it_is_known():
    found = gx.read(f'{HEAD}MSG("at (" <<2<<")")\nMSG("at "<<R7)\nX1\n'.encode(), SIEMENS)
    assert found.executed.decode().splitlines()[-2:] == ["(at [2])", "X1"]
