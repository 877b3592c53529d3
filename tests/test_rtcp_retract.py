"""Drawing the tool back where a cut forces axes to flip or unwind: `retract` of `rtcp`.

The oracle finds these moves in the text alone, by matrices of scipy. What is left has to be the
program, and there shall be no more of them than limits ask for.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.choice import LEAP, Choice, NoWayError, Trouble
from hypothesis import given
from hypothesis import strategies as st
from kinematics_kit import leaning, tool
from rtcp_kit import ROUNDED, between, chain_of_kind, machine_text, pipeline, positions, tips
from test_rtcp_choice import in_a_cut, trunnion, with_axis
from test_rtcp_repost import ROOM, step_of

import gcxform as gx

BACK, FEED, TOLERANCE = 25.0, 830.0, 0.02
OPTIONS = {"retract": f"{BACK} mm", "retract_feed": FEED}
LIMITS = {
    "ac-trunnion": {"A": (-30.0, 110.0), "C": (-200.0, 200.0)},
    "bc-trunnion": {"B": (-110.0, 110.0), "C": (-200.0, 160.0)},
    "ca-fork": {"C": (-200.0, 200.0), "A": (-110.0, 110.0)},
    "c-table-b-head": {"C": (-190.0, 190.0), "B": (-30.0, 110.0)},
    "nutating-head": {"C": (-190.0, 190.0)},
}


def limited(text, limits):
    """Return the text of a machine file with limits of axes."""
    for letter, ends in limits.items():
        text = text.replace(f"[axis.{letter}]\n", f"[axis.{letter}]\nlimits = {[*ends]}\n")
    return text


def steps_of(folder, kind, limits, **options):
    """Return the pipeline from an A/C trunnion without limits, with both chains."""
    source, target = chain_of_kind("ac-trunnion", 3), chain_of_kind(kind, 4)
    (folder / "target.toml").write_text(limited(machine_text(kind, target), limits))
    said = {"tolerance": TOLERANCE, "axis_tolerance": 0.5, "use": "retarget"}
    said |= {"target": "target.toml", "before": "", "rapids": "ends", "decimals": 4}
    steps = pipeline(folder, machine_text("ac-trunnion", source), **(said | options))
    return steps, source, target


def round_about(turns=1.6, tilt=40.0):
    """Return a program with long and short blocks, in which C of the source turns on and on."""
    head = f"G21 G90 G93 G17 G54\nG0 X0. Y0. A0. C0.\nG43 H1 Z0.\nG0 X20. Y10. Z5. A{tilt} C0.\n"
    ways = [0.3 * turns, 0.302 * turns, 0.304 * turns, 0.7 * turns, turns]
    blocks = [
        f"G1 X{20.0 + 8 * n} Y{10.0 - 5 * n} Z{5.0 + n} A{tilt + n} C{360 * way:.3f} F0.5\n"
        for n, way in enumerate(ways)
    ]
    return (head + "".join(blocks) + "G0 Z50.\nM30\n").encode()


def drawn_back(chain, new, rows, feeds):
    """Return which of the rows of a line draw the tool back, by tips and axes of the text."""
    found, here = [], []
    for row in rows:
        ends = new[row - 1 : row + 1]
        (tip, other), axis = tips(chain, ends), tool(chain, ends[:, :3], ends[:, 3:])[1][0]
        still = (ends[0, 3:] == ends[1, 3:]).all()
        along = np.linalg.norm(other - tip - BACK * axis) < 0.002
        if not here and still and along and abs(feeds[row] * BACK / FEED - 1.0) < 1e-3:
            here = [row]
        elif here:
            here.append(row)
            if still:
                found.append(here)
                here = []
    assert not here
    return found


def check_drawn(chain, new, rows, feeds):
    """Check moves that draw the tool back: on its axis, held, and in where it was."""
    along = [between(new[row - 1], new[row]) for row in rows]
    points = [tips(chain, each) for each in along]
    begin, top = points[0][0], points[0][-1]
    axis = tool(chain, along[0][:1, :3], along[0][:1, 3:])[1][0]
    room = 3 * (ROUNDED + ROOM)
    for ends in (points[0], points[-1]):
        part = (ends - begin) @ axis
        assert np.linalg.norm(ends - begin - part[:, None] * axis, axis=1).max() <= room
        assert -room <= part.min() <= part.max() <= BACK + room
    for ends in points[1:-1]:
        assert np.linalg.norm(ends - top, axis=1).max() <= 0.1 * BACK + room
    assert np.linalg.norm(points[-1][-1] - begin) <= room
    assert np.abs(new[rows[-1], 3:] - new[rows[0], 3:]).max() > LEAP
    last = along[-1][-1:]
    assert np.linalg.norm(tool(chain, last[:, :3], last[:, 3:])[1][0] - axis) <= np.radians(0.01)
    for row in rows[1:-1]:
        turned = np.linalg.norm(new[row, 3:] - new[row - 1, 3:])
        assert turned / FEED == pytest.approx(1.0 / feeds[row], rel=1e-3)


def check_program(text, result, source, target, limits):
    """Check all that is written; return how often the tool is drawn back."""
    letters = [("X", "Y", "Z", *chain.letters) for chain in (source, target)]
    old, new = positions(text, letters[0]), positions(result.text, letters[1])
    feeds = positions(result.text, "F")[:, 0]
    owner, count = np.array(result.source_map), 0
    for letter, (low, high) in limits.items():
        at = new[:, letters[1].index(letter)]
        assert low <= at.min() <= at.max() <= high
    for line in range(4, len(old) - 2):
        rows = np.flatnonzero(owner == line).tolist()
        drawn = drawn_back(target, new, rows, feeds)
        count += len(drawn)
        for each in drawn:
            check_drawn(target, new, each, feeds)
            rows = [row for row in rows if row not in each]
        assert feeds[rows] == pytest.approx(0.5 * len(rows), abs=1e-3)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 9)[:, None]) / len(rows)
            posed = old[line - 1] + part * (old[line] - old[line - 1])
            found = between(new[row - 1], new[row], 9)
            off = np.linalg.norm(tips(source, posed) - tips(target, found), axis=1)
            assert off.max() <= TOLERANCE + ROUNDED + ROOM
            axes = [tool(c, p[:, :3], p[:, 3:])[1] for c, p in ((source, posed), (target, found))]
            assert np.linalg.norm(axes[0] - axes[1], axis=1).max() <= np.radians(0.5)
    outside = [at for at, line in enumerate(owner) if not 4 <= line < len(old) - 2]
    assert len(outside) == 4 + 2  # each is one block, as it was
    return count


@pytest.mark.parametrize("kind", sorted(LIMITS))
def test_the_tool_is_drawn_back_where_axes_must_turn(tmp_path, kind):
    """Tip and tool axis on their way outside of it, on the tool's own axis within it."""
    text = round_about(tilt=25.0)
    refused, _, _ = steps_of(tmp_path, kind, LIMITS[kind])
    with pytest.raises(gx.InputError, match="GX335"):
        refused.run(text)
    steps, source, target = steps_of(tmp_path, kind, LIMITS[kind], **OPTIONS)
    result = steps.run(text, "full")
    count = check_program(text, result, source, target, LIMITS[kind])
    told = result.certificate.added
    assert told["retracts"] == count >= 1
    clear = f"{count} retracts, {told['moves of retracts']} moves of retracts"
    assert any(clear in said for said in result.certificate.not_checked)


def test_not_where_there_is_a_way_without(tmp_path):
    """With limits wide enough the option changes no byte; and what is refused else, still is."""
    limits = {"A": (-110.0, 110.0), "C": (-400.0, 400.0)}
    plain, _, _ = steps_of(tmp_path, "ac-trunnion", limits)
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", limits, **OPTIONS)
    found = steps.run(round_about(), "full")
    assert found.text == plain.run(round_about()).text
    assert found.certificate.added == {"retracts": 0, "moves of retracts": 0}
    leaned = round_about(tilt=25.0).replace(b"A29.0", b"A118.0")
    with pytest.raises(gx.InputError, match=r"GX331.*\n.*A118"):
        steps.run(leaned)


@pytest.mark.usefixtures("one_process")
def test_several_cuts_are_counted_together(tmp_path, monkeypatch):
    """The certificate has the sum of all windows, and a cut does not depend on the one before."""
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 1)
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", LIMITS["ac-trunnion"], **OPTIONS)
    head, _, rest = round_about(tilt=25.0).partition(b"G0 X20.")
    cut = b"G0 X20." + rest.removesuffix(b"M30\n")
    result = steps.run(head + 3 * cut + b"M30\n", "full")
    once = steps.run(head + cut + b"M30\n", "full")
    assert once.certificate.added["retracts"] == 1
    assert result.certificate.added == {n: 3 * k for n, k in once.certificate.added.items()}


def test_beyond_travel_it_says_what_for(tmp_path):
    """GX331 tells that it is the retract that does not fit."""
    limits = LIMITS["ac-trunnion"] | {"Z": (-500.0, 60.0)}
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", limits, **OPTIONS)
    with pytest.raises(gx.InputError, match=r"GX331.*Z would have.*where the tool is drawn back"):
        steps.run(round_about(tilt=25.0))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"retract": 20.0}, "go together"),
        ({"retract_feed": 100.0}, "go together"),
        ({"retract": 0.05, "retract_feed": 100.0}, "0.1"),
    ],
)
def test_options_that_do_not_fit(tmp_path, options, message):
    """Both are given, for another machine, and the way is no trifle."""
    with pytest.raises(gx.UsageError, match=message):
        steps_of(tmp_path, "ac-trunnion", {}, **options)


def test_it_is_for_another_machine(tmp_path):
    """The other passes do not choose attitudes."""
    text = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    with pytest.raises(gx.UsageError, match="unknown key 'retract'"):
        pipeline(tmp_path, text, before="", tolerance=0.01, **OPTIONS)


# --- the search ---


def test_as_late_or_soon_as_it_may_but_not_more_often():
    """A sweep of 850 degrees within 540: one unwinding, at a point where it is allowed."""
    axis = leaning(np.full(171, 40.0), np.linspace(0.0, 850.0, 171))
    may = np.zeros(171, np.bool_)
    may[100:110] = True
    choice = Choice(trunnion(), axis, in_a_cut(171), may)
    angles = choice.run(np.zeros(2))
    (at,) = choice.retracts
    assert may[at]
    assert len(angles) == 172
    steps = np.abs(np.diff(angles, axis=0)).max(axis=1)
    assert np.flatnonzero(steps > LEAP).tolist() == [at]
    with pytest.raises(NoWayError) as caught:
        Choice(trunnion(), axis, in_a_cut(171), np.zeros(171, np.bool_)).run(np.zeros(2))
    assert caught.value.trouble is Trouble.FLIP


def test_a_long_turn_before_the_cut_is_better():
    """C-350 is far, and C10 near; but from there the tool would have to flip in the cut."""
    tilt = np.concatenate([np.linspace(40.0, 10.0, 20), np.full(61, 10.0)])
    axis = leaning(tilt, np.linspace(-80.0, 320.0, 81))
    chain = trunnion(a=(-30.0, 110.0), c=(-350.0, 350.0))
    choice = Choice(chain, axis, in_a_cut(81), np.ones(81, np.bool_))
    angles = choice.run(np.zeros(2))
    assert choice.retracts == []
    assert angles[0] == pytest.approx([40.0, -350.0])


@given(st.integers(0, 100_000))
def test_no_way_has_fewer(seed):
    """Against all sequences of candidates along a random walk of the azimuth."""
    rng = np.random.default_rng(seed)
    azimuth = np.cumsum(rng.choice([-40.0, 30.0, 40.0], 9)) + rng.uniform(-180.0, 180.0)
    axis = leaning(np.full(9, 40.0), azimuth)
    low, high = rng.uniform(-260.0, -190.0), rng.uniform(10.0, 200.0)
    chain = trunnion(a=(-110.0, 110.0), c=(low, high))
    choice = Choice(chain, axis, in_a_cut(9), np.ones(9, np.bool_))
    try:
        angles = choice.run(np.zeros(2))
    except NoWayError:
        return
    assert len(angles) == 9 + len(choice.retracts)
    angle, allowed = gx.turns(chain, gx.attitudes(chain, axis).angle)
    fewest = {0: np.zeros(len(angle[0][allowed[0]]))}
    for at in range(1, 9):
        old, new = (angle[k][allowed[k]] for k in (at - 1, at))
        before = fewest[at - 1] + 0.0
        if at > 1:
            before = np.minimum(before, before.min() + 1.0)
        near = np.abs(old[:, None] - new[None]).max(axis=-1) <= LEAP
        fewest[at] = np.where(near, before[:, None], np.inf).min(axis=0)
    assert len(choice.retracts) == fewest[8].min()


# --- the proof ---


@pytest.fixture
def drawn(tmp_path):
    """Return the pass, its context, the path of a program, and that with the tool drawn back."""
    steps, _, _ = steps_of(tmp_path, "bc-trunnion", LIMITS["bc-trunnion"], **OPTIONS)
    read = gx.Program(round_about(0.8, 25.0), steps.source, steps.machine_reading)
    path = with_axis(read.path, "B")
    step = step_of(steps)
    after = step.apply(path, steps.context)
    step.prove(path, after, steps.context)
    assert step.added(path, after, steps.context)["retracts"] == 1
    return step, steps.context, path, after


def first_of(after):
    """Return the first row that draws the tool back, and the number of rows until it is in."""
    angles = after.end[:, [after.axes.index("B"), after.axes.index("C")]]
    feeds = np.flatnonzero(np.abs(after.feed * BACK / FEED - 1.0) < 1e-9)
    first, last = feeds
    assert np.abs(angles[last] - angles[first]).max() > LEAP
    return int(first), int(last - first + 1)


def refused(drawn, after, what=None):
    """Check that the proof refuses a path: GX606."""
    step, context, path, _ = drawn
    with pytest.raises(gx.VerificationError, match="GX606"):
        (what or step).prove(path, after, context)


def test_the_proof_takes_nothing_else(drawn):
    """Farther, aside, faster, leaning, or without the option: what is added is refused."""
    step, _, _, after = drawn
    first, count = first_of(after)
    for row, column, size in (
        (first, 2, 0.001),  # not as far as asked
        (first, 0, 0.001),  # aside
        (first + count // 2, 1, 0.2 * BACK),  # away while axes turn
        (first + count - 1, 0, 0.001),  # in beside where it was
        (first + count - 1, after.axes.index("C"), 0.7),  # in with another tool axis
    ):
        end = after.end.copy()
        end[row, column] += size
        refused(drawn, after.replace(end=end))
    for row in (first, first + 1, first + count - 1):
        feed = after.feed.copy()
        feed[row] *= 1.001
        refused(drawn, after.replace(feed=feed))
    plain = replace(step, retract=None, retract_feed=None)
    refused(drawn, after, plain)
    refused(drawn, after, replace(step, retract=BACK + 0.001))


@pytest.mark.parametrize(("turn", "count"), [(0.4, 1), (0.7, 0)])
def test_the_tool_goes_in_with_the_axis_it_had(drawn, turn, count):
    """Axes that end a little farther, the tip where it should be: as much as is allowed to lean."""
    step, context, path, after = drawn
    first, moves = first_of(after)
    rows = np.array([first + moves - 2, first + moves - 1])
    _, place = step.places(after, context)
    held = place.tips_of(after.end[rows, :3], place.angles(after.end[rows]), rows)
    end, feed, column = after.end.copy(), after.feed.copy(), after.axes.index("B")
    way = end[rows[0]] - end[rows[0] - 1]
    end[rows, column] += np.copysign(turn, way[column])
    end[rows, :3] = place.axes_of(held, place.angles(end[rows]), rows)
    way = end[rows[0]] - end[rows[0] - 1]
    feed[rows[0]] = FEED / np.linalg.norm(way[place.columns])
    other = after.replace(end=end, feed=feed)
    assert step.added(path, other, context)["retracts"] == count


def test_the_proof_wants_it_whole_and_in_a_line(drawn):
    """A part of it, or rapids, or one that begins before any move of its line: refused."""
    step, context, path, after = drawn
    first, count = first_of(after)
    for gone in (range(first, first + 1), range(first, first + count), [first + count - 1]):
        counts = np.ones(len(after), np.int64)
        counts[[*gone]] = 0
        refused(drawn, after.with_rows(counts, end=after.end[counts > 0]))
    kind = after.kind.copy()
    kind[first + 1] = gx.Kind.RAPID
    refused(drawn, after.replace(kind=kind))
    source = after.source.copy()
    source[first:] += 1
    refused(drawn, after.replace(source=source))
    assert step.added(path, after.replace(source=source), context)["retracts"] == 0


def test_axes_do_not_turn_to_and_fro(drawn):
    """A turn beyond where the tool goes in, and back, is no part of it."""
    step, context, path, after = drawn
    first, count = first_of(after)
    c = after.axes.index("C")
    counts = np.ones(len(after), np.int64)
    middle = first + count - 2
    counts[middle] = 3
    end = np.repeat(after.end, counts, axis=0)
    end[middle + 1, c] += 0.01
    feed = np.repeat(after.feed, counts)
    feed[middle + 1 : middle + 3] = FEED / 0.01
    more = after.with_rows(counts, end=end, feed=feed)
    assert step.added(path, more, context)["retracts"] == 0
    refused(drawn, more)
