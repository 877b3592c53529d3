"""Canned cycles as moves, worked out by hand: each cycle, each plane, G90 and G91, G98 and G99.

In the tables `>` is a rapid and `=` a feed move to a level of the normal axis, `!` something done.
A hole is drilled from 10 at (1, 2), R is 2 and the bottom -4, unless a test says otherwise.
"""

from __future__ import annotations

import numpy as np
import pytest
from cycle_kit import (
    AXES_OF,
    HOLE,
    PLANE_OF,
    START,
    Block,
    calls,
    cycles,
    expanded,
    points,
    refusals,
    spatial,
    told,
    turned,
)

from gcxform.modal.moves.cycle_patterns import turn_axes
from gcxform.toolpath.path import Kind

# After the approach, which is `> 10, > 2` in all of them: LinuxCNC in G98, and in G99.
LINUXCNC = {
    73: ("=-0.5 >-0.246 =-3 >-2.746 =-4 >10", "=-0.5 >-0.246 =-3 >-2.746 =-4 >2"),
    74: ("=-4 !M5 !M3 !0.5 =10 !M5 !M4", "=-4 !M5 !M3 !0.5 =2 !M5 !M4"),
    81: ("=-4 >10", "=-4 >2"),
    82: ("=-4 !0.5 >10", "=-4 !0.5 >2"),
    83: ("=-0.5 >2 >-0.246 =-3 >2 >-2.746 =-4 >10", "=-0.5 >2 >-0.246 =-3 >2 >-2.746 =-4 >2"),
    84: ("=-4 !M5 !M4 !0.5 =10 !M5 !M3", "=-4 !M5 !M4 !0.5 =2 !M5 !M3"),
    85: ("=-4 =2 >10", "=-4 =2 >2"),
    86: ("=-4 !0.5 !M5 >10 !M3", "=-4 !0.5 !M5 >2 !M3"),
    87: (
        ">2 !M5 !M19 >-4 >-4 !M3 =-1 =-4 !M5 !M19 >-4 >10 >10 !M3",
        ">2 !M5 !M19 >-4 >-4 !M3 =-1 =-4 !M5 !M19 >-4 >2 >2 !M3",
    ),
    88: ("=-4 !0.5 !M5 !M0 !M3", "=-4 !0.5 !M5 !M0 !M3"),
    89: ("=-4 !0.5 =10", "=-4 !0.5 =2"),
}
FANUC = {
    73: ("=-0.5 >-0.2 =-3 >-2.7 =-4 >10", "=-0.5 >-0.2 =-3 >-2.7 =-4 >2"),
    74: ("=-4 !M5 !M3 !0.5 =2 !M5 !M4 >10", "=-4 !M5 !M3 !0.5 =2 !M5 !M4 >2"),
    81: ("=-4 >10", "=-4 >2"),
    82: ("=-4 !0.5 >10", "=-4 !0.5 >2"),
    83: ("=-0.5 >2 >-0.1 =-3 >2 >-2.6 =-4 >10", "=-0.5 >2 >-0.1 =-3 >2 >-2.6 =-4 >2"),
    84: ("=-4 !M5 !M4 !0.5 =2 !M5 !M3 >10", "=-4 !M5 !M4 !0.5 =2 !M5 !M3 >2"),
    85: ("=-4 =2 >10", "=-4 =2 >2"),
    86: ("=-4 !M5 >10 !M3", "=-4 !M5 >2 !M3"),
    89: ("=-4 !0.5 =2 >10", "=-4 !0.5 =2 >2"),
}
WORDS: dict[int, Block] = {
    **{code: {"Q": 2.5} for code in (73, 83)},
    **{code: {"P": 0.5} for code in (74, 82, 84, 86, 88, 89)},
    87: {"I": 0.25, "J": -0.5, "K": -1},
}


CASES = [("linuxcnc", code) for code in LINUXCNC] + [("fanuc", code) for code in FANUC]


@pytest.mark.parametrize("retract", [98, 99])
@pytest.mark.parametrize("distance", [90, 91])
@pytest.mark.parametrize("plane", AXES_OF)
@pytest.mark.parametrize(("dialect", "code"), CASES)
def test_each_cycle(dialect: str, code: int, plane: str, distance: int, retract: int) -> None:
    words = HOLE | WORDS.get(code, {})
    if distance == 91:
        words |= {"Z": -6.0, "R": -8.0}
        words |= {"K": 3.0} if code == 87 else {}
    if dialect == "fanuc" and code == 86:
        words.pop("P", None)
    block = turned(plane, words)
    block |= {"cycle": code, "distance": distance, "retract": retract, "spindle": 1}
    if code == 74:
        block["spindle"] = -1
    start = spatial(np.array([START]), PLANE_OF[plane])[0].tolist()
    steps = cycles(dialect).expand(calls([block], tuple(start)))
    if dialect == "linuxcnc" and code in (74, 84) and plane != "G17":
        assert refusals(steps)[0].startswith(f"0: G{code} outside G17")
        return
    table = LINUXCNC if dialect == "linuxcnc" else FANUC
    assert refusals(steps) == []
    assert told(steps) == f">10 >2 {table[code][retract == 99]}"
    centre = [tuple(end[:2]) for end in steps.rows.end.tolist()]
    if code == 87:
        assert set(centre) == {(1, 2), (1.25, 1.5)}
        beside = [end == (1.25, 1.5) for end in centre]
        assert beside == [False, False, True, True, False, False, False, True, True, False]
    else:
        assert set(centre) == {(1, 2)}
    assert steps.after.tolist() == [[1, 2, 10 if retract == 98 else 2]]


@pytest.mark.parametrize("plane", AXES_OF)
def test_axes_of_the_planes(plane: str) -> None:
    block = turned(plane, HOLE) | {"cycle": 81}
    where = PLANE_OF[plane]
    start = spatial(np.array([START]), where)[0].tolist()
    steps = cycles("linuxcnc").expand(calls([block], tuple(start)))
    expected = {
        "G17": [(1, 2, 10), (1, 2, 2), (1, 2, -4), (1, 2, 2)],
        "G18": [(2, 10, 1), (2, 2, 1), (2, -4, 1), (2, 2, 1)],
        "G19": [(10, 1, 2), (2, 1, 2), (-4, 1, 2), (2, 1, 2)],
    }
    assert points(steps, where) == expected[plane]


# --- from hole to hole ---


def test_words_stay_within_a_cycle() -> None:
    both = [HOLE | {"cycle": 82, "P": 1}, {"X": 5}, {"Y": 6, "Z": -1}, {"X": 7, "R": 3}]
    for dialect in ("linuxcnc", "fanuc"):
        assert told(expanded(dialect, *both)) == (
            ">10 >2 =-4 !1 >2 >2 =-4 !1 >2 >2 =-1 !1 >2 "
            + (">3 =-1 !1 >3" if dialect == "linuxcnc" else ">2 >3 =-1 !1 >3")
        )


def test_words_are_dropped_or_kept_by_another_cycle() -> None:
    blocks = [HOLE | {"cycle": 81}, {"cycle": 82, "X": 5, "P": 1}]
    assert refusals(expanded("linuxcnc", *blocks)) == ["1: G82 without R"]
    assert told(expanded("fanuc", *blocks)) == ">10 >2 =-4 >2 >2 =-4 !1 >2"
    missing = [HOLE | {"cycle": 82, "P": 1}, HOLE | {"cycle": 89}]
    assert refusals(expanded("linuxcnc", *missing)) == ["1: G89 without P"]
    assert refusals(expanded("fanuc", *missing)) == []


def test_words_stay_from_stretch_to_stretch_until_the_mode_is_left() -> None:
    for dialect in ("linuxcnc", "fanuc"):
        kernel = cycles(dialect)
        kernel.expand(calls([HOLE | {"cycle": 81, "retract": 98}], START))
        more = calls([{"cycle": 81, "X": 5, "retract": 98}], (1, 2, 7))
        assert told(kernel.expand(more)) == ">7 >2 =-4 >10"  # back to the level latched before
        kernel.leave()
        assert refusals(kernel.expand(more)) == ["0: G81 without R"]


def test_windows_do_not_matter() -> None:
    blocks = [HOLE | {"cycle": 83, "Q": 2}, {"X": 5}, {"Y": 1, "Z": -3}, {"R": 3, "X": 2}]
    full = [{"cycle": 83} | block for block in blocks]
    for dialect in ("linuxcnc", "fanuc"):
        whole = cycles(dialect).expand(calls(full, START))
        kernel, at, ends = cycles(dialect), START, []
        for block in full:
            steps = kernel.expand(calls([block], at))
            at = tuple(steps.after[-1].tolist())
            ends.append(steps.rows.end)
        assert np.array_equal(np.vstack(ends), whole.rows.end)
        assert at == tuple(whole.after[-1].tolist())


def test_linuxcnc_goes_to_the_next_hole_at_a_level_that_depends() -> None:
    hole = HOLE | {"cycle": 81}
    after_g99 = {
        "stays at R": ({"X": 5, "retract": 99}, [(5, 2, 2), (5, 2, -4), (5, 2, 2)]),
        "above a new R": (
            {"X": 5, "R": 1, "retract": 98},
            [(5, 2, 2), (5, 2, 1), (5, 2, -4), (5, 2, 10)],
        ),
        "slanting to the initial level": (
            {"X": 5, "retract": 98},
            [(5, 2, 10), (5, 2, 2), (5, 2, -4), (5, 2, 10)],
        ),
        "slanting to a higher R": (
            {"X": 5, "R": 4, "retract": 99},
            [(5, 2, 4), (5, 2, -4), (5, 2, 4)],
        ),
        "up first where R is above the initial level": (
            {"X": 5, "R": 14, "retract": 98},
            [(1, 2, 14), (5, 2, 14), (5, 2, -4), (5, 2, 14)],
        ),
    }
    for name, (block, expected) in after_g99.items():
        steps = expanded("linuxcnc", hole | {"retract": 99}, block)
        assert points(steps)[4:] == expected, name


def test_from_below_r() -> None:
    low = expanded("linuxcnc", HOLE | {"cycle": 81, "retract": 98}, start=(0, 0, 1))
    assert points(low) == [(0, 0, 2), (1, 2, 2), (1, 2, -4), (1, 2, 2)]
    again = expanded("linuxcnc", HOLE | {"cycle": 81, "L": 2}, start=(0, 0, 1))
    assert points(again) == [(0, 0, 2), *[(1, 2, 2), (1, 2, -4), (1, 2, 2)] * 2]
    low = expanded("fanuc", HOLE | {"cycle": 81, "retract": 98}, start=(0, 0, 1))
    assert refusals(low) == ["0: G81 with R above the level from which the cycle began"]


def test_repeats() -> None:
    absolute = expanded("linuxcnc", HOLE | {"cycle": 81, "L": 2, "retract": 98})
    assert points(absolute) == [(1, 2, 10), (1, 2, 2), (1, 2, -4), (1, 2, 10)] * 2
    words = {"cycle": 81, "X": 1, "Z": -6, "R": -8, "L": 3, "distance": 91}
    steps = expanded("linuxcnc", words, {"Y": 5})
    holes = [end for end in points(steps) if end[2] == -4]
    assert holes == [(1, 0, -4), (2, 0, -4), (3, 0, -4), (3, 5, -4)]
    assert steps.after.tolist() == [[3, 0, 2], [3, 5, 2]]
    assert points(expanded("linuxcnc", words | {"L": 2}))[3:] == [
        *[(1, 0, 2), (2, 0, 2)],
        *[(2, 0, -4), (2, 0, 2)],
    ]


def test_no_repeats() -> None:
    block = HOLE | {"cycle": 81, "L": 0}
    assert refusals(expanded("linuxcnc", block)) == ["0: G81 with no repeats at all"]
    stored = expanded("fanuc", block, {"X": 5})
    assert points(stored) == [(5, 0, 10), (5, 0, 2), (5, 0, -4), (5, 0, 2)]
    assert stored.after.tolist() == [[0, 0, 10], [5, 0, 2]]


def test_fanuc_drills_where_there_is_an_axis_word_or_r() -> None:
    steps = expanded("fanuc", HOLE | {"cycle": 81}, {"cycle": 82, "P": 1}, {"R": 1})
    assert told(steps) == ">10 >2 =-4 >2 >2 >1 =-4 !1 >1"
    assert refusals(expanded("linuxcnc", HOLE | {"cycle": 81}, {"R": 1})) == [
        "1: G81 without an axis word"
    ]


def test_incremental_r_counts_from_the_initial_level() -> None:
    words = {"cycle": 81, "X": 1, "Z": -6, "R": -8, "distance": 91}
    for dialect in ("linuxcnc", "fanuc"):
        steps = expanded(dialect, words, {"X": 1}, {"X": 1, "R": -7})
        assert told(steps) == ">10 >2 =-4 >2 >2 =-4 >2 " + (
            ">3 =-3 >3" if dialect == "linuxcnc" else ">2 >3 =-3 >3"
        )


def test_words_of_another_distance_mode() -> None:
    blocks = [HOLE | {"cycle": 81}, {"X": 1, "distance": 91}]
    # LinuxCNC takes the numbers again: R 2 and Z -4 are now distances.
    assert points(expanded("linuxcnc", *blocks))[4:] == [
        (1, 2, 12),
        (2, 2, 12),
        (2, 2, 8),
        (2, 2, 12),
    ]
    assert refusals(expanded("fanuc", *blocks)) == [
        "1: G81 with R in force from before a G90 or G91"
    ]


def test_axes_turn_on_the_way_to_the_hole() -> None:
    block = HOLE | {"cycle": 81, "L": 2}
    rows = cycles("linuxcnc").expand(calls([block], (0, 0, 0))).rows
    assert rows.hole.tolist() == [0, 1, 1, 1, 2, 2, 2]  # up to R, then over the hole
    words = np.full((7, 4), -1.0)
    turn_axes(words, rows.hole, ((3, 90.0, 45.0),))
    assert words[:, 3].tolist() == [-1, 45, 45, 45, 90, 90, 90]
    assert (words[:, :3] == -1).all()


def test_linuxcnc_keeps_the_last_dwell_for_tapping() -> None:
    kernel = cycles("linuxcnc")
    kernel.expand(calls([HOLE | {"cycle": 82, "P": 3}], START))
    kernel.leave()
    assert "!3" in told(kernel.expand(calls([HOLE | {"cycle": 84}], START))).split()
    assert "!0" in told(expanded("linuxcnc", HOLE | {"cycle": 84})).split()
    kernel = cycles("fanuc")
    kernel.expand(calls([HOLE | {"cycle": 82, "P": 3}], START))
    kernel.leave()
    assert "!0" in told(kernel.expand(calls([HOLE | {"cycle": 84}], START))).split()


def test_tapping_is_marked() -> None:
    steps = expanded("linuxcnc", HOLE | {"cycle": 84}, HOLE | {"cycle": 81})
    assert steps.rows.synchronised.tolist() == [False, False, True, True] + [False] * 3
    assert steps.rows.call.tolist() == [0, 0, 0, 0, 1, 1, 1]


def test_events_name_their_line_and_the_way_the_spindle_turned() -> None:
    block = HOLE | {"cycle": 86, "P": 1, "spindle": -1, "line": 7}
    events = expanded("linuxcnc", block).rows.events
    assert [(e.row, e.what, e.line) for e in events] == [
        *[(3, "DWELL", 7), (3, "M5", 7)],
        (4, "M4", 7),
    ]


def test_after_manual_boring_the_tool_is_taken_to_be_out() -> None:
    steps = expanded("linuxcnc", HOLE | {"cycle": 88, "P": 1, "retract": 98}, {"X": 5})
    assert steps.after[:, 2].tolist() == [10, 10]
    assert told(steps) == ">10 >2 =-4 !1 !M5 !M0 !M3 >10 >2 =-4 !1 !M5 !M0 !M3"


# --- pecks ---


@pytest.mark.parametrize(
    ("depth", "peck", "count"),
    [(6, 2.5, 3), (6, 2, 3), (6, 6, 1), (6, 7, 1), (0, 1, 1), (0.5, 0.125, 4), (5, 0.01, 500)],
)
def test_number_of_pecks(depth: float, peck: float, count: int) -> None:
    block = HOLE | {"cycle": 73, "Z": 2 - depth, "Q": peck}
    steps = expanded("linuxcnc", block)
    feeds = steps.rows.end[steps.rows.kind == Kind.LINE, 2]
    assert len(feeds) in (count, count + (peck == 0.01))  # the sum of many pecks is rounded
    assert np.allclose(feeds[:count], np.maximum(2 - peck * np.arange(1, count + 1), 2 - depth))


def test_pecks_of_inches_are_counted_in_inches() -> None:
    # .4 - .1 - .1 - .1 - .1 is above 0 by the rounding: a fifth, empty peck.
    block = {"cycle": 83, "X": 0, "Z": 0, "R": 0.4, "Q": 0.1, "unit": 20}
    steps = cycles("linuxcnc").expand(calls([block], (0, 0, 25.4)))
    value, count = 0.4, 0
    while value > 0:
        value, count = value - 0.1, count + 1
    assert int((steps.rows.kind == Kind.LINE).sum()) == count
    back = steps.rows.end[4, 2]
    assert back == pytest.approx(0.3 * 25.4 + 0.254)


def test_published_fact_of_fanuc() -> None:
    """The second hole keeps Z-5 R2, dwells 1 s, and G99 returns to R."""
    hole = {"cycle": 81, "X": 1, "Y": 0, "Z": -5, "R": 2}
    steps = expanded("fanuc", hole, {"cycle": 82, "X": 2, "P": 1})
    assert points(steps) == [
        *[(1, 0, 10), (1, 0, 2), (1, 0, -5), (1, 0, 2)],
        *[(2, 0, 2), (2, 0, -5), (2, 0, 2)],
    ]
    assert [(e.row, e.what, e.values) for e in steps.rows.events] == [
        (6, "DWELL", (("seconds", 1.0),))
    ]
