"""Programs that say the tool axis by I, J and K (G43.5), and an oracle for what becomes of them.

It reads both texts word by word and follows the machine by matrices of scipy; of vectors it knows
that they point from the tip to the holder, on the workpiece with all axes at 0.
"""

from __future__ import annotations

import hashlib
import re

import numpy as np
from kinematics_kit import leaning, tool
from rtcp_kit import (
    ROUNDED,
    between,
    machine_text,
    pipeline,
    positions,
    tips,
)
from scipy.spatial.transform import Rotation
from test_rtcp_retract import limited

TOLERANCE = 0.01
ROOM = 2e-6  # mm; the least decimals of a machine file and of the matrices
ENDS = np.radians(0.0011)  # two angles with three decimals
MODES = ("angles", "great-circle")


def pointed(folder, kind, chain, mode="angles", limits=None, **options):
    """Return the pipeline that makes angles of vectors."""
    said = {"tolerance": TOLERANCE, "tip_codes": "vectors", "rapids": "ends"} | options
    machine = limited(machine_text(kind, chain), limits or {})
    return pipeline(folder, machine, before="", orientation_path=mode, **said)


def whole(blocks, chain, feed="G94"):
    """Return a program with one section of vectors, from the axes at 0 and back to there."""
    zeros = " ".join(f"{letter}0." for letter in chain.letters)
    head = [f"G21 G90 {feed} G17 G54", f"G0 X0. Y0. {zeros}", "G43.5 H1 Z60."]
    tail = ["G49", f"G0 {zeros}", "G0 X0. Y0. Z200.", "M30"]
    return "".join(f"{line}\n" for line in [*head, *blocks, *tail]).encode()


def block(tip, axis, code="", rest=""):
    words = "".join(f"{a}{v:.3f}" for a, v in zip("XYZ", tip, strict=True))
    vector = "".join(f"{a}{v:.7f}" for a, v in zip("IJK", axis, strict=True))
    return f"{code}{words}{vector}{rest}"


def read(text):
    """Return tips (n, 3) and unit vectors (n, 3) after every line of a program with vectors."""
    tip, axis, on, found = np.zeros(3), np.array([0.0, 0.0, 1.0]), False, []
    steps = False
    for line in text.decode().splitlines():
        line = re.sub(r"\(.*?\)", "", line)
        steps = "G91" in line or (steps and "G90" not in line)
        on = ("G43.5" in line or on) and "G49" not in line
        words = {a: float(v) for a, v in re.findall(r"([XYZIJK])(-?[\d.]+)", line)}
        for k, letter in enumerate("XYZ"):
            if letter in words:
                tip[k] = words[letter] + (tip[k] if steps else 0.0)
        said = np.array([words.get(a, 0.0) for a in "IJK"])
        if on and any(a in words for a in "IJK"):
            axis = said / np.linalg.norm(said)
        found.append((tip.copy(), axis.copy()))
    return tuple(np.array(column) for column in zip(*found, strict=True))


def check(text, result, chain, mode):
    """Check every block of a section; return how many rows were written for its cuts."""
    letters = ("X", "Y", "Z", *chain.letters)
    said, axes = read(text)
    new, owner = positions(result.text, letters), np.array(result.source_map)
    lines = [line.decode() for line in text.splitlines()]
    last = next(n for n, line in enumerate(lines) if "G49" in line)
    assert not re.search(r"[IJK]", re.sub(r"\(.*?\)", "", result.text.decode()))
    assert result.certificate.verified
    assert result.certificate.source["sha256"] == hashlib.sha256(text).hexdigest()
    rapid, count = True, 0
    for line in range(3, last):
        rapid = "G0" in lines[line] or (rapid and "G1" not in lines[line])
        rows = np.flatnonzero(owner == line)
        at_end = new[rows[-1] : rows[-1] + 1]
        assert np.linalg.norm(tips(chain, at_end)[0] - said[line]) <= ROUNDED + ROOM
        axis = tool(chain, at_end[:, :3], at_end[:, 3:])[1][0]
        assert np.linalg.norm(axis - axes[line]) <= ENDS
        if rapid:
            assert len(rows) == 1
            continue
        count += len(rows)
        check_between(chain, new, rows, (said, axes, line), mode)
    return count


def check_between(chain, new, rows, source, mode):
    """Check the way of a cut: the tip on its line, the tool axis on its circle if asked."""
    said, axes, line = source
    begin, end = new[rows[0] - 1], new[rows[-1]]
    for nth, row in enumerate(rows):
        part = (nth + np.linspace(0.0, 1.0, 9)) / len(rows)
        found = between(new[row - 1], new[row], 9)
        wanted = said[line - 1] + part[:, None] * (said[line] - said[line - 1])
        assert (
            np.linalg.norm(tips(chain, found) - wanted, axis=1).max() <= TOLERANCE + ROUNDED + ROOM
        )
        axis = tool(chain, found[:, :3], found[:, 3:])[1]
        if mode == "angles":
            straight = begin[3:] + part[:, None] * (end - begin)[3:]
            assert np.abs(found[:, 3:] - straight).max() <= 0.00051
        elif np.linalg.norm(axes[line] - axes[line - 1]) > 1e-9:
            off = axis - on_a_circle(axes[line - 1], axes[line], part)
            assert np.degrees(np.linalg.norm(off, axis=1)).max() <= 0.1 + np.degrees(ENDS)


def on_a_circle(one, other, part):
    """Return unit vectors between two, by a rotation of scipy."""
    pole = np.cross(one, other)
    whole = np.arctan2(np.linalg.norm(pole), one @ other)
    turns = part[:, None] * whole * pole / np.linalg.norm(pole)
    return Rotation.from_rotvec(turns).apply(one)


def winding(turns, tilt=40.0, count=24):
    """Return blocks in which the tool axis goes round Z so many times."""
    around = np.linspace(0.0, 360.0 * turns, count)
    axes = leaning(np.full(count, tilt), around)
    spots = np.column_stack([np.linspace(0.0, 60.0, count), np.zeros(count), np.zeros(count)])
    codes = ["G0 ", "G1 F600. ", *[""] * (count - 2)]
    return [block(p, k, c) for p, k, c in zip(spots, axes, codes, strict=True)]


def several(chain, cuts=3):
    """Return a program of several sections, with what is between them."""
    zeros = " ".join(f"{letter}0." for letter in chain.letters)
    lines = ["G21 G90 G94 G17 G54"]
    for number in range(cuts):
        lines += [
            f"(section {number}: G43.5 and G49)",
            f"G0 X{number}. Y0. {zeros}",
            "G43.5 H1 Z60.",
        ]
        lines += [*winding(0.3 + 0.1 * number), "G0 Z70.", "M5", "G49", "G53 Z0", f"G0 {zeros}"]
    return "".join(f"{line}\n" for line in [*lines, "M30"]).encode()
