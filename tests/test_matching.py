"""Matching two paths that are cut at different places, and comparing programs by it."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcxform.api import Program, read
from gcxform.comparison import Comparison, compare
from gcxform.deviations.even_travel import evenly_apart
from gcxform.deviations.matching import match
from gcxform.deviations.paired_pieces import measure
from gcxform.pipeline.pipeline import Pipeline
from gcxform.syntax.source import WINDOW

HEAD = "G1 F100 X0 Y0 Z0\n"
Polyline = list[tuple[float, float, float]]


def program(text: str | bytes, dialect: str = "linuxcnc", **reading: Any) -> Program:
    return read(text if isinstance(text, bytes) else text.encode(), dialect, **reading)


def compared(a: str, b: str, tolerance: float = 0.001, head: str = HEAD) -> Comparison:
    return compare(program(head + a), program(head + b), tolerance)


def lines(points: Polyline) -> str:
    return "".join(f"X{x:.9f} Y{y:.9f} Z{z:.9f}\n" for x, y, z in points)


# --- one path, cut at different places ---

SAME = {
    "identical": ("X10\nY5\n", "X10\nY5\n"),
    "finer": ("X10\nX20 Y5\n", "X3\nX10\nX15 Y2.5\nX20 Y5\n"),
    "both finer": ("X3\nX6\nX9\nX10\n", "X5\nX10\n"),
    "a circle in two halves": ("G2 X0 Y0 I5 J0\n", "G2 X10 Y0 I5 J0\nG2 X0 Y0 I-5 J0\n"),
    "a helix in quarters": (
        "G3 X0 Y0 Z8 I5 J0\n",
        "G3 X5 Y-5 Z2 I5 J0\nX10 Y0 Z4 I0 J5\nX5 Y5 Z6 I-5 J0\nX0 Y0 Z8 I0 J-5\n",
    ),
    "turns": ("G3 X0 Y0 I5 P3\n", "G3 X0 Y0 I5\nG3 X0 Y0 I5 P2\n"),
    "turns of a helix": ("G3 X0 Y0 Z9 I5 P3\n", "G3 X0 Y0 Z6 I5 P2\nG3 X0 Y0 Z9 I5\n"),
    "other cuts of an arc": (
        "G3 X2 Y0 I1\nG3 X0 Y0 I-1\n",
        "G3 X1 Y-1 I1 J0\nG3 X1 Y1 I0 J1\nG3 X0 Y0 I0 J-1\n",
    ),
    "an axis that turns": ("A0\nX10 A90\n", "A0\nX5 A45\nX10 A90\n"),
    "only an axis that turns": ("A0\nA90\n", "A0\nA30\nA60\nA90\n"),
    "no way": ("X5\nX5\nY5\n", "X5\nY5\nY5\n"),
    "hardly a way": ("X5\nX5.0004\nG0 Y5\n", "X5\nG0 Y5\n"),
    "hardly an arc": (
        "G2 X0 Y0 I5 J0\nG0 Y5\n",
        "G2 X10 Y0 I5 J0\nX0 Y-0.0004 I-5 J0\nX0 Y0 I5 J0.0004\nG0 Y5\n",
    ),
    "rapids": ("G0 X5\nG1 Y5\n", "G0 X5\nG1 Y2\nY5\n"),
    "nothing": ("", ""),
}


@pytest.mark.parametrize(("a", "b"), SAME.values(), ids=SAME)
def test_one_path_in_two_programs(a: str, b: str) -> None:
    for found in (compared(a, b), compared(b, a)):
        assert found.same, found
        assert found.deviation <= 0.0005


points = st.tuples(*[st.integers(-5000, 5000).map(lambda n: n / 100)] * 3)
polylines = st.lists(points, min_size=1, max_size=12)
cuts = st.lists(st.floats(0.01, 0.99), max_size=4).map(sorted)


def subdivided(path: Polyline, parts: list[list[float]]) -> Polyline:
    start, found = (0.0, 0.0, 0.0), []
    for k, end in enumerate(path):
        for part in [*parts[k % len(parts)], 1.0]:
            found.append(tuple(p + part * (q - p) for p, q in zip(start, end, strict=True)))
        start = end
    return found  # type: ignore[return-value]


@given(polylines, st.lists(cuts, min_size=1), st.lists(cuts, min_size=1))
@settings(deadline=None)
def test_lines_cut_anywhere_are_the_same(
    path: Polyline, one: list[list[float]], other: list[list[float]]
) -> None:
    found = compared(lines(subdivided(path, one)), lines(subdivided(path, other)), 1e-6)
    assert found.same, found


@given(
    st.floats(0.5, 80.0),
    st.floats(0.05, 2 * math.pi),
    st.booleans(),
    st.lists(st.floats(0.02, 0.98), max_size=5).map(sorted),
    st.lists(st.floats(0.02, 0.98), max_size=5).map(sorted),
    st.sampled_from([0.0, 3.5]),
)
@settings(deadline=None)
def test_arcs_cut_anywhere_are_the_same(
    radius: float, sweep: float, clockwise: bool, one: list[float], other: list[float], rise: float
) -> None:
    def arcs(parts: list[float]) -> str:
        sense, text, x, y = -1.0 if clockwise else 1.0, "", 0.0, 0.0
        for part in [*parts, 1.0]:
            angle = sense * sweep * part
            end = radius * (math.cos(angle) - 1), radius * math.sin(angle)
            centre = -radius - x, -y
            text += f"G{2 if clockwise else 3} X{end[0]:.9f} Y{end[1]:.9f} Z{rise * part:.9f} "
            text += f"I{centre[0]:.9f} J{centre[1]:.9f}\n"
            x, y = end
        return text

    distinct = [
        [p for k, p in enumerate(parts) if not k or p - parts[k - 1] > 0.01]
        for parts in (one, other)
    ]
    found = compared(arcs(distinct[0]), arcs(distinct[1]), 1e-5)
    assert found.same, found


def sampled(path: Polyline, count: int = 60) -> np.ndarray[Any, Any]:
    corners = np.array([(0.0, 0.0, 0.0), *path])
    parts = np.linspace(0, 1, count)[:, None]
    legs = [a + parts * (b - a) for a, b in pairwise(corners)]
    return np.concatenate(legs)


@given(polylines, st.lists(cuts, min_size=1), st.integers(0, 2**32 - 1), st.floats(1e-4, 0.3))
@settings(deadline=None)
def test_the_deviation_is_never_too_small(
    path: Polyline, parts: list[list[float]], seed: int, noise: float
) -> None:
    """Every point of the second path is within the deviation of the first, and the reverse."""
    shift = np.random.default_rng(seed).normal(0, noise, (500, 3))
    fine = subdivided(path, parts)
    moved = [tuple(p) for p in np.array(fine) + shift[: len(fine)]]
    found = compared(lines(path), lines(moved), 0.001)
    if found.parted is not None:
        return
    one, other = sampled(path), sampled(moved)
    gaps = np.sqrt(((one[:, None, :] - other[None, :, :]) ** 2).sum(axis=2))
    step = 100 / 59  # the samples are this far apart at most
    assert gaps.min(axis=1).max() <= found.deviation + step
    assert gaps.min(axis=0).max() <= found.deviation + step


@pytest.mark.parametrize("shift", [0.0005, 0.004, 0.05, 0.4])
def test_the_deviation_of_a_shifted_path_is_the_shift(shift: float) -> None:
    path = [(10.0, 0.0, 0.0), (20.0, 9.0, 1.0), (20.0, -30.0, 2.0), (0.0, 0.0, 2.0)]
    moved = [(x, y, z + shift) for x, y, z in path[:3]] + [path[3]]
    found = compared(lines(path), lines(moved))
    assert found.deviation == pytest.approx(shift, rel=1e-3)
    assert found.same == (shift <= 0.001)
    assert found.line_a == found.line_b


def test_going_back_counts() -> None:
    """A path that goes 0.5 mm back and forth again is 0.25 mm from one that does not."""
    for found in (compared("X10\n", "X5\nX4.5\nX10\n"), compared("X5\nX4.5\nX10\n", "X10\n")):
        assert 0.25 <= found.deviation <= 0.51


# --- what is moved as a whole, and hair's breadths ---


def test_what_is_left_of_a_move_before_a_rapid_is_its_shift() -> None:
    """A twin that is shifted along its way: what a cut leaves is a point of the other path."""
    a = "G1 X10\nX10 Y0.05\nG0 Z5\nX20 Y9\nG1 Z0\nX30\nG0 Z5\n"
    b = "G1 X9.99\nX9.99 Y0.0502\nG0 Z5\nX19.99 Y9\nG1 Z0\nX29.99 Y9.0002\nG0 Z5\n"
    for found in (compared(a, b), compared(b, a)):
        assert found.parted is None
        assert found.deviation == pytest.approx(0.01, rel=0.05)
        assert not found.same


def test_a_path_that_lags_does_not_lag_more() -> None:
    """Short rows beside long ones that are 5 um off: pairs at their ends would run ahead."""
    arc = [(math.cos(t), math.sin(t)) for t in np.linspace(0.0, 3.0, 400)]
    fine = "".join(f"X{x:.5f} Y{y:.5f}\n" for x, y in arc)
    rough = "".join(f"X{1.005 * x:.5f} Y{1.005 * y:.5f}\n" for x, y in [*arc[::13], arc[-1]])
    for found in (compared(fine, rough, head=HEAD), compared(rough, fine, head=HEAD)):
        assert found.deviation <= 0.008


@pytest.mark.parametrize("rise", [0.002, 0.02])
def test_arcs_of_other_senses_that_are_a_hair_apart(rise: float) -> None:
    """Arcs over one chord of 1 mm: as far apart as both rise over it, and 1 % at most."""
    radius = (0.25 + rise**2) / (2.0 * rise)
    one, other = (f"G{code} X1 Y0 R{radius:.9f}\n" for code in (2, 3))
    found = compared(one, other)
    assert found.deviation == pytest.approx(2.0 * rise, rel=0.01)
    assert not found.same
    assert compared(one, other, 2.0 * rise * 1.01).same


def test_arcs_of_other_senses_differ_by_what_else_they_do() -> None:
    one, other = "G2 X1 Y0 Z0 R60\n", "G3 X1 Y0 Z0 R60\n"
    assert compared(one, other, 0.01).same
    assert not compared(one, other.replace("Z0", "Z0.02"), 0.01).same
    assert compared("A0\nG2 X1 Y0 A1 R60\n", "A0\nG3 X1 Y0 A2 R60\n", 0.01).deviation == math.inf


def test_the_bound_between_parts_holds() -> None:
    """Whole circles, one of them a little larger: no part is farther than is said."""
    one = program("G1 F100 X10 Y0 Z0\nG3 X10 Y0 I-10 J0\n").path
    other = program("G1 F100 X10 Y0 Z0\nG3 X10 Y0 Z1 I-11 J0\n").path
    (found,) = evenly_apart(one, other, np.array([1]))
    t = np.linspace(0.0, 2.0 * math.pi, 20001)
    away = np.stack([np.cos(t) * 10 - (11 * np.cos(t) - 1), -np.sin(t), -t / 2 / math.pi])
    farthest = np.sqrt((away**2).sum(axis=0)).max()
    assert farthest <= found <= farthest + 21 * (2 * math.pi / 64) ** 2 / 8 + 1e-9


def test_what_one_path_does_not_know_is_infinitely_far() -> None:
    one = program("G1 F100 X0 Y0\nG2 X1 Y0 R60\n").path
    other = program("G1 F100 X0 Y0 Z0\nG3 X1 Y0 R60\n").path
    assert evenly_apart(one, other, np.array([1])).tolist() == [math.inf]
    assert evenly_apart(one, one, np.array([1])) <= 2e-6


# --- paths that are not the same ---

DIFFERENT = {
    "another way": ("X10\n", "X5\nY20\n"),
    "nothing": ("X10\n", ""),
    "only the start": ("X10\nX20\n", "X10\n"),
    "back": ("X10\n", "X10\nX5\n"),
    "there and back": ("X10\n", "X10\nX4\nX10\n"),
    "a circle the other way round": ("G2 X0 Y0 I5\n", "G3 X0 Y0 I5\n"),
    "no circle": ("G2 X0 Y0 I5\nG1 X9\n", "G1 X9\n"),
    "one turn less": ("G3 X0 Y0 I5 P3\n", "G3 X0 Y0 I5 P2\n"),
    "the chord of an arc": ("G3 X2 Y0 I1\n", "G1 X2\n"),
    "the other arc": ("G3 X5 Y5 I0 J5\n", "G2 X5 Y5 I5 J0\n"),
    "a rapid": ("G0 X5\n", "G1 X5\n"),
    "turned": ("A0\nX5 A10\n", "A0\nX5 A11\n"),
    "turned early": ("A0\nX5 A10\n", "A0\nX2 A9\nX5 A10\n"),
}


@pytest.mark.parametrize(("a", "b"), DIFFERENT.values(), ids=DIFFERENT)
def test_other_paths_differ(a: str, b: str) -> None:
    for found in (compared(a, b), compared(b, a)):
        assert not found.same, found
        assert found.deviation > 0.001 or found.angle > 0.001 or found.parted


def test_a_rapid_among_many_alike_moves() -> None:
    moves = [f"X{k} Y{k % 3}\n" for k in range(1, 40)]
    text = "".join(moves)
    rapid = text.replace(moves[30], f"G0 {moves[30]}G1 ")
    assert compared(text, text).same
    assert compared(text, rapid).parted == (32, 32)


def test_the_place_where_paths_part() -> None:
    found = compared("X10\nX20\nX30\n", "X10\nX20\nX20 Y50\n")
    assert found.parted == (4, 4)
    assert found.deviation == math.inf
    assert compared("X10\n", "").parted == (2, 1)
    assert compared("G2 X0 Y0 I5\nG0 X9\n", "G0 X9\n").parted == (2, 2)


def test_a_position_that_only_one_program_knows() -> None:
    one, other = program("G1 F100 X0 Y0\nX5\n"), program("G1 F100 X0 Y0 Z0\nX5\n")
    for found in (compare(one, other), compare(other, one)):
        assert not found.same
        assert (found.parted, found.deviation) == (None, 0.0)
        assert [(d.line_a, d.line_b) for d in found.places] == [(1, 1)]
    assert compare(one, other).places[0].what == "only B says where Z is"
    assert compare(other, one).places[0].what == "only A says where Z is"


def test_the_rest_is_compared_where_a_first_move_names_one_axis_more() -> None:
    one = program("G0 X1 Y1\nG0 Z5\nG1 F100 X10\n")
    for z, x, off in ((50, 10, 0.01), (50, 10.03, 0.03)):
        found = compare(one, program(f"G0 X1.01 Y1 Z{z}\nG0 Z5\nG1 F100 X5\nX{x}\n"))
        assert found.parted is None
        assert found.deviation == pytest.approx(off)
        assert not compare(one, program(f"G0 X1 Y1 Z{z}\nG0 Z5\nG1 F100 X5\nX{x}\n")).same
    known = program("G0 X1 Y1\nG0 Z5\nG1 F100 X10\n", start={"Z": 50.0})
    assert compare(known, program("G0 X1 Y1 Z50\nG0 Z5\nG1 F100 X10\n")).same


def test_a_proof_takes_no_place_for_granted() -> None:
    """What `compare` leaves out is infinitely far for whoever proves by it."""
    one, other = program("G0 X1 Y1\nG0 Z5\n").path, program("G0 X1 Y1 Z50\nG0 Z5\n").path
    assert match(one, other, 0.001, 1.0).parted is not None
    lenient = match(one, other, 0.001, 1.0, partly=True)
    assert lenient.parted is None
    assert measure(one, other, lenient).distance.max() == math.inf
    assert measure(one, other, lenient, partly=True).distance.max() == 0.0


def test_axes_that_one_program_does_not_have() -> None:
    one, other = program(HEAD + "X5\n"), program(HEAD + "X5\n(A)\n")
    assert compare(one, other).same
    assert compare(other, one).same


# --- feeds and events ---


def test_feeds() -> None:
    found = compared("X5\nX10 F200\nX20\n", "X5\nX10 F300\nX20\n")
    assert [(d.what, d.line_a, d.line_b) for d in found.feeds] == [
        ("feed 200 became 300", 3, 3),
        ("feed 200 became 300", 4, 4),
    ]
    assert not found.same


def test_the_feed_of_a_neighbour_is_another_feed() -> None:
    assert compared("X5 F100\nX10 F200\n", "X5 F100\nX10 F100\n").feeds
    assert compared("X5 F100\nX10 F200\n", "X5 F200\nX10 F200\n").feeds
    assert compared("X5 F100\nX10 F200\n", "X5 F100\nX5.0005 F100\nX10 F200\n").same


def test_inverse_time_feeds_of_pieces_add_up() -> None:
    assert compared("G93 X10 F2\n", "G93 X5 F4\nX10 F4\n").same
    assert compared("G93 X10 F2\n", "G93 X5 F2\nX10 F2\n").feeds


def test_feed_modes_and_work_offsets() -> None:
    assert "feed mode G94 became G95" in compared("S9\nX5\n", "S9\nG95 F100 X5\n").feeds[0].what
    found = compared("G55 G1 X5 Y0 Z0\n", "G56 G1 X5 Y0 Z0\n")
    assert found.feeds[0].what == "G55 became G56"


@pytest.mark.parametrize(
    ("tied", "plain", "what"),
    [
        ("G38.2 Z5 F100\n", "G1 Z5\n", "a probe move became a plain move"),
        ("S100 M3\nG33 Z5 K1\n", "S100 M3\nG95 G1 Z5 F1\n", "a thread move became a plain move"),
    ],
)
def test_what_is_tied_is_no_plain_move(tied: str, plain: str, what: str) -> None:
    assert [difference.what for difference in compared(tied, plain).feeds] == [what]
    assert compared(tied, tied).same


EVENTS = {
    "missing": ("M3 S100\nX10\nM5\n", "M3 S100\nX10\n", "M5 is only in A"),
    "too many": ("X10\n", "X10\nM8\n", "M8 is only in B"),
    "another": ("M3 S100\nX10\n", "M4 S100\nX10\n", "M3 became M4"),
    "another number": ("M3 S100\nX10\n", "M3 S200\nX10\n", "S100 became S200"),
    "elsewhere": ("M8\nX10\n", "X10\nM8\n", "M8 stands elsewhere"),
    "another time": ("G4 P1\n", "G4 P2\n", "dwell 1 seconds became dwell 2 seconds"),
}


@pytest.mark.parametrize(("a", "b", "what"), EVENTS.values(), ids=EVENTS)
def test_events_that_differ(a: str, b: str, what: str) -> None:
    (found,) = compared(a, b).events
    assert found.what == what


def test_events_between_pieces() -> None:
    assert compared("X10\nM8\nX20\nM9\n", "X5\nX10\nM8\nX15\nX20\nM9\n").same


def test_dialects_say_a_dwell_in_their_own_units() -> None:
    fanuc = program("G1 F100. X0. Y0. Z0.\nX10.\nG4 X1.5\nG4 P250\nG80\n", "fanuc")
    linuxcnc = program("G1 F100 X0 Y0 Z0\nX10\nG4 P1.5\nG4 P0.25\n")
    assert compare(fanuc, linuxcnc).same
    assert compare(linuxcnc, fanuc).same


def test_inches_and_millimetres() -> None:
    assert compare(program("G20\n" + HEAD + "X1\n"), program("G1 F2540 X0 Y0 Z0\nX25.4\n")).same


# --- through pipelines ---

PART = HEAD + "G3 X0 Y0 Z-3 I-7 J3\nG2 X4 Y4 R4\nG18 G3 X8 Z4 R6\nG17 G1 X0 Y0\n"


@pytest.mark.parametrize(
    ("chain", "tolerance"),
    [
        ("absolute | segment chord-error=5um", 0.0055),
        ("segment chord-error=50um", 0.0505),
        ("segment arcs=split arc-step=10 max-length=1.3", 0.001),
        ("segment max-length=0.7 chord-error=1um", 0.0015),
    ],
)
def test_what_passes_write_is_matched_without_their_map(chain: str, tolerance: float) -> None:
    result = Pipeline.parse(chain, "linuxcnc").run(PART.encode())
    one, other = program(PART), program(result.text)
    found = compare(one, other, tolerance)
    assert found.same, found
    assert found.deviation == pytest.approx(result.certificate.largest["deviation"], abs=2e-4)
    assert compare(other, one, tolerance).same


def test_two_segmentations_of_one_part() -> None:
    texts = [
        Pipeline.parse(f"segment chord-error={size}um max-length={length}", "linuxcnc").run(
            PART.encode()
        )
        for size, length in ((2, 0.8), (3, 1.1))
    ]
    found = compare(program(texts[0].text), program(texts[1].text), 0.006)
    assert found.same, found


def test_programs_longer_than_a_window() -> None:
    count = WINDOW // 12
    text = HEAD + "".join(f"X{k % 100}.5 Y{k // 100}\n" for k in range(count))
    one = program(text)
    assert len(one.path) == count + 1
    (end,) = program(text + "M2\n").path.events
    assert (end.row, end.line) == (count + 1, count + 1)
    assert compare(one, program(text.replace("X99.5", "X99.500"))).same
    found = compare(one, program(text.replace("X57.5 Y300", "X57.5 Y300.25")))
    assert found.deviation == pytest.approx(0.25, abs=0.01)
    assert found.line_a == 30059


def test_pieces_are_contiguous_and_whole() -> None:
    one, other = program(HEAD + "X3\nX6\nX9\n").path, program(HEAD + "X5\nX9\n").path
    found = match(one, other, 0.001, 1.0)
    assert found.parted is None
    assert found.a.row.tolist() == [0, 1, 2, 2, 3]
    assert found.b.row.tolist() == [0, 1, 1, 2, 2]
    assert found.a.high[2] == pytest.approx(2 / 3)
    assert measure(one, other, found).distance.max() == pytest.approx(0, abs=1e-9)
