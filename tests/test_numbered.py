"""Codes that name one of many things by a word: which one it is, is never lost."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform import vocabulary as v
from gcxform.plugin.registry import default_registry

FANUC = default_registry().dialect("fanuc")
TWO = "G21 G90 G94 G17\n{0}\nG0 X0. Y0. Z5.\nG1 X10. F100.\n{1}\nG0 X0. Y0. Z5.\nG1 X10.\nM30\n"


def dialect(**codes: gx.Code) -> type[gx.Dialect]:
    """Return a dialect with codes of its own."""
    return type("Acme", (FANUC,), {"name": "acme", "codes": {**FANUC.codes, **codes}})


def origins(kind: type[gx.Dialect], one: str, two: str) -> set[str]:
    """Return what the moves of two blocks count from."""
    path = gx.read(TWO.format(one, two).encode(), kind).path
    return {path.frames[k].origin[0] for k in path.frame.tolist()}


@pytest.mark.parametrize("takes", ["H", "P", "E", "HP"])
def test_two_work_offsets_are_two(takes) -> None:
    """G15 H1 and G15 H2 were one frame, which was compensated with one origin."""
    kind = dialect(G15=v.frame("frame", "work", takes))
    one, two = ("G15 " + " ".join(f"{a}{n}" for a in takes) for n in (1, 2))
    assert len(origins(kind, one, two)) == 2
    assert len(origins(kind, one, one)) == 1


@pytest.mark.parametrize("block", ["G15", "G15 H0", "G15 H1.5", "G15 H-1"])
def test_a_work_offset_without_a_whole_number_is_refused(block) -> None:
    kind = dialect(G15=v.frame("frame", "work", "H"))
    with pytest.raises(gx.InputError, match="GX213"):
        origins(kind, block, "G15 H2")


@pytest.mark.parametrize(
    ("code", "takes"),
    [
        (v.frame("tool-length", "length", "HD"), "H1 D2"),
        (v.frame("tool-length", "no-length", "E"), "E1"),
        (v.frame("polar", "no-polar", "E"), "E1"),
        (v.frame("rotation", "no-rotate", "H"), "H3"),
    ],
)
def test_a_word_that_an_act_does_not_look_at_is_refused(code, takes) -> None:
    with pytest.raises(gx.InputError, match="what this asks for is not known"):
        origins(dialect(G300=code), f"G300 {takes}", "G54")
