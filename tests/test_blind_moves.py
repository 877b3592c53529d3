"""Moves by distances from where it is not known: what they go by is all that can be compared."""

from __future__ import annotations

import numpy as np
import pytest

import gcxform as gx
from gcxform.deviations.deviation import deviation

BEGIN = "G21 G90 G94 G17 G54\nG0 Z5.\nT1 M6\nG91 G1 X1. F100.\n"


def compared(a: str, b: str) -> gx.Comparison:
    first, second = (gx.read((BEGIN + text + "M30\n").encode(), "fanuc") for text in (a, b))
    return gx.compare(first, second)


@pytest.mark.parametrize(
    "step", ["X1.", "X1. Y2.", "G2 X10. R5.", "G3 X10. Y10. J10.", "G28 X1. Y0.", "G30 P2 Y-1."]
)
def test_the_same_steps_are_the_same(step: str) -> None:
    assert compared(f"{step}\n", f"{step}\n").same


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ("X1.", "X2."),
        ("X1.", "Y1."),
        ("X1.", "X-1."),
        ("G2 X10. R5.", "G2 X10. R6."),
        ("G3 X10. Y10. J10.", "G3 X10. Y10. I10."),
        ("G2 X10. R5.", "G3 X10. R5."),
        ("G2 I5.", "G2 I-5."),
        ("X1.", "G20 G1 X1. F100."),
        ("G1 Y1.", "G51.1 Y0.\nG1 Y1."),
        ("G28 Y1.", "G28 Y2."),
        ("G28 Y0.", "G28 Z0."),
        ("G30 P2 Y1.", "G30 P2 Y-1."),
    ],
)
def test_other_steps_are_others(a: str, b: str) -> None:
    assert not compared(f"{a}\n", f"{b}\n").same


def test_an_arc_of_another_sweep_is_another() -> None:
    path = gx.read((BEGIN + "G2 X10. R5.\nM30\n").encode(), "fanuc").path
    longer = path.replace(sweep=np.where(path.is_arc, path.sweep + 0.1, path.sweep))
    owner = np.arange(len(path))
    assert deviation(path, path, owner).distance.max() == 0.0
    assert deviation(path, longer, owner).distance.max() == np.inf


def test_the_other_way_round_the_same_chord_is_another() -> None:
    path = gx.read((BEGIN + "G2 X10. R6.\nM30\n").encode(), "fanuc").path
    around = path.replace(sweep=np.where(path.is_arc, 2 * np.pi - path.sweep, path.sweep))
    assert deviation(path, around, np.arange(len(path))).distance.max() == np.inf
