"""Drawing the tool back where a cut forces axes to flip or unwind: `retract` of `rtcp`.

The oracle finds these moves in the text alone, by matrices of scipy. What is left has to be the
program, and there shall be no more of them than limits ask for.
"""

from __future__ import annotations

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp_choice import LEAP
from kinematics_kit import tool
from rtcp_kit import (
    ROUNDED,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from test_rtcp_repost import ROOM

import gcxform as gx

BACK, FEED, TOLERANCE = 25.0, 800.0, 0.02
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
    said = {"tolerance": TOLERANCE, "axis_tolerance": 0.5, "direction": "retarget"}
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
    assert told["retracts to turn rotary axes"] == count >= 1
    owner = np.array(result.source_map)
    assert told["moves of these"] < len(owner)
