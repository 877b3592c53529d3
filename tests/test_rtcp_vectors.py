"""`rtcp` of programs that say the tool axis by I, J and K (G43.5): the oracle is in the kit."""

from __future__ import annotations

import re

import numpy as np
import pytest
from cli_kit import call
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from kinematics_kit import leaning, tool
from rtcp_kit import (
    KINDS,
    ROUNDED,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from test_rtcp_repost import leaning_poses
from vectors_kit import (
    ENDS,
    MODES,
    ROOM,
    TOLERANCE,
    block,
    check,
    pointed,
    read,
    several,
    whole,
    winding,
)

import gcxform as gx
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.pipeline.whole_cuts import whole_sections
from gcxform.syntax.source import Source

EACH = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much],
    deadline=None,
    max_examples=8,
)
PLACED = ("GX331", "GX332", "GX333", "GX334", "GX335")
"""What may speak against a way of the tool, whatever it is."""


# --- beside a program that says angles ---


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("kind", KINDS)
def test_it_does_what_angles_do(tmp_path, kind, mode):
    """The same cuts said by angles (G43.4) and by vectors: tips and tool axes are the same."""
    chain = chain_of_kind(kind, 4)
    letters = ("X", "Y", "Z", *chain.letters)
    poses = leaning_poses(chain, np.random.default_rng(5), 5, least=25.0, around=40.0).round(3)
    poses[1:] = (poses[:1] + 0.3 * (poses[1:] - poses[:1])).round(3)
    axes = tool(chain, poses[:, :3], poses[:, 3:])[1]
    codes = ["G0 ", "G1 F600. ", *[""] * (len(poses) - 2)]
    blocks = [block(p[:3], 3.0 * k, c) for p, k, c in zip(poses, axes, codes, strict=True)]
    text = whole(blocks, chain)
    result = pointed(tmp_path, kind, chain, mode).run(text, "full")
    assert check(text, result, chain, mode) >= len(poses) - 1
    words = ["".join(f"{a}{v:.3f}" for a, v in zip(letters, p, strict=True)) for p in poses]
    angles = whole([c + w for c, w in zip(codes, words, strict=True)], chain)
    angles = angles.replace(b"G43.5", b"G43.4").replace(
        b"G49", b"G0 Z90. " + zeros(chain) + b"\nG49"
    )
    said = {"tolerance": TOLERANCE, "tip_codes": "read", "rapids": "ends"}
    if mode != "angles":
        said |= {"orientation_path": mode, "before": ""}
    other = pipeline(tmp_path, machine_text(kind, chain), **said)
    other = other.run(angles, "full")
    for line in range(3, 3 + len(poses)):
        found = [
            positions(r.text, letters)[np.flatnonzero(np.array(r.source_map) == line)[-1:]]
            for r in (result, other)
        ]
        tip = [tips(chain, one)[0] for one in found]
        axis = [tool(chain, one[:, :3], one[:, 3:])[1][0] for one in found]
        assert np.linalg.norm(tip[0] - tip[1]) <= 2 * ROUNDED + ROOM
        assert np.linalg.norm(axis[0] - axis[1]) <= 2 * ENDS


def zeros(chain):
    return " ".join(f"{letter}0." for letter in chain.letters).encode()


# --- any vectors ---


@st.composite
def sections(draw):
    """Draw blocks of a section: rapids and cuts, long and short, with vectors of any length."""
    seed = draw(st.integers(0, 100_000))
    rng = np.random.default_rng(seed)
    tilt, around = rng.uniform(10.0, 60.0), rng.uniform(-180.0, 180.0)
    tip, blocks, cuts = rng.uniform(-40.0, 40.0, 3), [], False
    for number in range(draw(st.integers(3, 9))):
        size = draw(st.sampled_from([0.05, 1.0, 6.0]))
        tilt = float(np.clip(tilt + rng.uniform(-2.0, 2.0) * size, 0.0, 80.0))
        around += rng.uniform(-4.0, 4.0) * size
        tip = tip + rng.uniform(-2.0, 2.0, 3) * size
        axis = leaning(np.array([tilt]), np.array([around]))[0] * rng.uniform(0.1, 9.0)
        cut = number > 0 and bool(rng.random() < 0.7)
        code = ("G1 " if cut else "G0 ") if cut != cuts or not number else ""
        rest = " F600." if cut and not cuts else ""
        cuts = cut
        what = draw(st.sampled_from(["all", "all", "all", "none", "in-plane", "steps"]))
        blocks.append(_drawn(what if number else "all", tip, axis, (code, rest), rng))
    return seed, blocks


def _drawn(what, tip, axis, around, rng):
    code, rest = around
    if what == "none":
        return block(tip, axis, code, rest).split("I")[0] + rest
    if what == "in-plane":
        words = block(tip, axis, code).split("I")[0]
        return f"{words} K{abs(axis[2]) + 0.2:.6f} I{axis[0]:.6f}{rest} (J is 0)"
    if what == "steps":
        step = rng.uniform(-1.0, 1.0, 3).round(3)
        return block(step, axis, f"G91 {code}", rest) + "\nG90"
    return block(tip, axis, code, rest)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("kind", ["ac-trunnion", "bc-trunnion", "ca-fork", "c-table-b-head"])
@EACH
@given(drawn=sections())
def test_any_vectors(tmp_path, kind, mode, drawn):
    seed, blocks = drawn
    chain = chain_of_kind(kind, seed)
    text = whole(blocks, chain)
    try:
        result = pointed(tmp_path, kind, chain, mode).run(text, "full")
    except gx.InputError as error:
        codes = {d.code for d in error.diagnostics}
        assume(not codes <= {*PLACED})
        raise
    if b"G91" not in text:
        check(text, result, chain, mode)
        return
    said, axes = read(text)
    letters = ("X", "Y", "Z", *chain.letters)
    new, owner = positions(result.text, letters), np.array(result.source_map)
    for line in range(3, len(text.splitlines()) - 4):
        at_end = new[np.flatnonzero(owner == line)[-1:]]
        assert np.linalg.norm(tips(chain, at_end)[0] - said[line]) <= ROUNDED + ROOM
        axis = tool(chain, at_end[:, :3], at_end[:, 3:])[1][0]
        assert np.linalg.norm(axis - axes[line]) <= ENDS


@pytest.mark.parametrize("mode", MODES)
def test_turns_go_on_and_limits_hold(tmp_path, mode):
    chain = chain_of_kind("ac-trunnion", 3)
    text = whole(winding(1.4), chain)
    free = pointed(tmp_path, "ac-trunnion", chain, mode).run(text, "full")
    check(text, free, chain, mode)
    angles = positions(free.text, "XYZAC")[3:-4, 3:]
    assert np.ptp(angles[:, 1]) == pytest.approx(1.4 * 360.0, abs=91.0)
    limits = {"A": (-120.0, 20.0), "C": (-420.0, 420.0)}
    held = pointed(tmp_path, "ac-trunnion", chain, mode, limits).run(text, "full")
    check(text, held, chain, mode)
    angles = positions(held.text, "XYZAC")[3:-4, 3:]
    for column, (low, high) in enumerate(limits.values()):
        assert low <= angles[:, column].min()
        assert angles[:, column].max() <= high
    assert angles[4:, 0].max() < -39.0
    limits["C"] = (-200.0, 200.0)
    with pytest.raises(gx.InputError) as error:
        pointed(tmp_path, "ac-trunnion", chain, mode, limits).run(text)
    assert {d.code for d in error.value.diagnostics} == {"GX335"}
    assert "retract" not in error.value.diagnostics[0].hint


@pytest.mark.parametrize("kind", ["ac-trunnion", "cb-fork", "c-table-a-head"])
def test_a_tool_that_is_drawn_back_keeps_its_attitude(tmp_path, kind):
    """Rapids that turn nothing turn no axis, though another attitude is nearer to the axes at 0."""
    chain = chain_of_kind(kind, 3)
    blocks = [*winding(0.45), "G0 Z90.", "X-30.", "Y10. Z80."]
    text = whole(blocks, chain)
    result = pointed(tmp_path, kind, chain).run(text, "full")
    new = positions(result.text, ("X", "Y", "Z", *chain.letters))
    owner = np.array(result.source_map)
    cut, *air = (np.flatnonzero(owner == 2 + len(blocks) - n)[-1] for n in range(3, -1, -1))
    assert all((new[row, 3:] == new[cut, 3:]).all() for row in air)
    assert np.abs(new[cut, 3:]).max() > 30.0


def test_axes_unwind_where_the_tool_turns(tmp_path):
    """Drawing the tool back turns nothing, though unwinding there would be as short."""
    chain = chain_of_kind("ac-trunnion", 3)
    first = leaning(np.full(20, 40.0), np.linspace(0.0, 190.0, 20))
    second = leaning(np.full(30, 40.0), np.linspace(165.0, 455.0, 30))
    spots = np.linspace([0.0, 0.0, 0.0], [40.0, 0.0, 0.0], 30)
    codes = ["G0 ", "G1 F600. ", *[""] * 28]
    cuts = [
        [block(p, k, c) for p, k, c in zip(spots, axes, codes, strict=False)]
        for axes in (first, second)
    ]
    text = whole([*cuts[0], "G0 Z90.", *cuts[1]], chain)
    limits = {"A": (0.0, 110.0), "C": (-110.0, 285.0)}
    result = pointed(tmp_path, "ac-trunnion", chain, limits=limits).run(text, "full")
    new, owner = positions(result.text, "XYZAC"), np.array(result.source_map)
    cut, back, turns = (np.flatnonzero(owner == 22 + n)[-1] for n in range(3))
    assert (new[cut, 3:] == new[back, 3:]).all()
    assert abs(new[turns, 4] - new[back, 4]) > 180.0


def test_small_vectors_beside_the_pole(tmp_path):
    """Vectors that turn by little beside the pole, in many blocks: long turns of C, and no leap."""
    chain = chain_of_kind("ac-trunnion", 3)
    around = np.linspace(0.0, 300.0, 31)
    axes = leaning(np.full(31, 0.4), around)
    spots = np.column_stack([np.linspace(0.0, 60.0, 31), np.zeros(31), np.zeros(31)])
    codes = ["G0 ", "G1 F600. ", *[""] * 29]
    blocks = [block(p, k, c) for p, k, c in zip(spots, axes, codes, strict=True)]
    text = whole(blocks, chain)
    for mode in MODES:
        result = pointed(tmp_path, "ac-trunnion", chain, mode).run(text, "full")
        check(text, result, chain, mode)
        turns = positions(result.text, "XYZAC")[3:-4, 4]
        assert np.ptp(turns) == pytest.approx(300.0, abs=0.1)


@pytest.mark.parametrize("mode", MODES)
def test_rounded_angles_are_made_good(tmp_path, mode):
    """Angles with one decimal: X, Y and Z are those that suit them."""
    chain = chain_of_kind("ac-trunnion", 3)
    text = whole(winding(0.5, count=9), chain)
    said = {"axis_tolerance": 0.5, "decimals": "{ A = 1, C = 1 }"}
    result = pointed(tmp_path, "ac-trunnion", chain, mode, **said).run(text, "full")
    new, owner = positions(result.text, "XYZAC"), np.array(result.source_map)
    spots, _ = read(text)
    worst = 0.0
    for line in range(4, 12):
        rows = np.flatnonzero(owner == line)
        for nth, row in enumerate(rows):
            part = (nth + np.linspace(0.0, 1.0, 9)[:, None]) / len(rows)
            wanted = spots[line - 1] + part * (spots[line] - spots[line - 1])
            found = tips(chain, between(new[row - 1], new[row], 9))
            worst = max(worst, float(np.linalg.norm(found - wanted, axis=1).max()))
    assert worst <= TOLERANCE + ROUNDED + ROOM


@pytest.mark.parametrize("size", [1, 60, 400, 2000])
@pytest.mark.parametrize("mode", MODES)
def test_windows_of_any_size_are_alike(tmp_path, mode, size):
    chain = chain_of_kind("ac-trunnion", 3)
    step, text = pointed(tmp_path, "ac-trunnion", chain, mode), several(chain)
    parts = []
    run = Run(step, Source.of_bytes(text), "on")
    run.over(Output(parts.append, None), abs, size)
    assert b"".join(parts) == step.run(text).text


def test_sections_are_not_divided():
    text = b"G43 H1\n(G49)\nG1 X1.\nG49\nG0 X2.\nN1 G43 H2\nG1 X3.\nG49 (G43)\nG0 X3.\n"
    for size in (1, 9, 30, 1000):
        parts = [*whole_sections(Source.of_bytes(text).windows(size))]
        assert b"".join(parts) == text
        assert all(not n or part.startswith(b"N1 G43 H2\n") for n, part in enumerate(parts))
    assert len([*whole_sections(Source.of_bytes(text).windows(1))]) == 2


def test_feeds_and_speeds(tmp_path):
    """The tip goes as fast as it is said to, in G93 too; an axis at full speed slows it down."""
    chain = chain_of_kind("ac-trunnion", 3)
    axes = leaning(np.array([30.0, 40.0, 40.0]), np.array([10.0, 10.0, 80.0]))
    spots = np.array([[0.0, 0.0, 0.0], [30.0, 40.0, 0.0], [30.0, 40.0, 12.0]])
    codes = ["G0 ", "G1 F500. ", "F250. "]
    text = whole([block(p, k, c) for p, k, c in zip(spots, axes, codes, strict=True)], chain)
    result = pointed(tmp_path, "ac-trunnion", chain).run(text, "full")
    for line, minutes in ((4, 50.0 / 500.0), (5, 12.0 / 250.0)):
        assert time_of(result, line) == pytest.approx(minutes, rel=1e-3)
    timed = text.replace(b"G94", b"G93").replace(b"F500.", b"F7.").replace(b"F250.", b"F9.")
    result = pointed(tmp_path, "ac-trunnion", chain).run(timed, "full")
    for line, minutes in ((4, 1.0 / 7.0), (5, 1.0 / 9.0)):
        assert time_of(result, line) == pytest.approx(minutes, rel=1e-3)
    machine = machine_text("ac-trunnion", chain).replace(
        "[axis.C]\n", "[axis.C]\nmax-speed = 700.0\n"
    )
    said = {"tolerance": TOLERANCE, "tip_codes": "vectors", "rapids": "ends", "before": ""}
    result = pipeline(tmp_path, machine, **said).run(text, "full")
    assert time_of(result, 5) == pytest.approx(70.0 / 700.0, rel=1e-3)
    assert result.certificate.measured["slower than its feed, times"] > 2.0


def time_of(result, line):
    """Return how long (min) the blocks of a line take."""
    texts = result.text.decode().splitlines()
    rows = np.flatnonzero(np.array(result.source_map) == line)
    return sum(1.0 / float(re.search(r"F([\d.]+)", texts[row])[1]) for row in rows)


def test_inches(tmp_path):
    """A vector has no unit."""
    chain = chain_of_kind("bc-trunnion", 3)
    text = whole(winding(0.2), chain).replace(b"G21", b"G20")
    result = pointed(tmp_path, "bc-trunnion", chain, decimals=5).run(text, "full")
    mm = result.text.replace(b"G20", b"G21")
    letters = ("X", "Y", "Z", *chain.letters)
    new, (said, axes) = positions(mm, letters), read(text)
    new[:, :3] *= 25.4
    owner = np.array(result.source_map)
    for line in range(3, len(text.splitlines()) - 4):
        at_end = new[np.flatnonzero(owner == line)[-1:]]
        assert np.linalg.norm(tips(chain, at_end)[0] - 25.4 * said[line]) <= 0.001
        assert np.linalg.norm(tool(chain, at_end[:, :3], at_end[:, 3:])[1][0] - axes[line]) <= ENDS


def test_what_follows_a_section_stays(tmp_path):
    """Words in the block of G49, tools that are changed, axes that are left where they are."""
    chain = chain_of_kind("ac-trunnion", 3)
    text = several(chain, 2).replace(b"G49\nG53 Z0\n", b"G49 Z190.\nX3.\nT1 M6\n")
    text = text.replace(
        b"(section 1: G43.5 and G49)\n", b"(section 1)\nG91 G28 Z0.\nG90 G0 Z300.\n"
    )
    result = pointed(tmp_path, "ac-trunnion", chain).run(text, "full")
    lines, owner = result.text.decode().splitlines(), np.array(result.source_map)
    for number, line in enumerate(text.decode().splitlines()):
        if line in ("G49 Z190.", "X3.", "G91 G28 Z0.", "G90 G0 Z300."):
            assert [lines[row] for row in np.flatnonzero(owner == number)] == [line]


def test_check_reads_what_is_run(tmp_path):
    """`gcxform check` takes the codes as the run does: those with angles too."""
    chain = chain_of_kind("ac-trunnion", 3)
    pointed(tmp_path, "ac-trunnion", chain)
    (tmp_path / "v.nc").write_bytes(several(chain))
    found = call("check", "-p", str(tmp_path / "p.toml"), str(tmp_path / "v.nc"))
    assert found.exit_code == 0, found.output
    machine = machine_text("ac-trunnion", chain)
    pipeline(tmp_path, machine, tolerance=TOLERANCE, tip_codes="read", rapids="ends")
    text = (
        b"G21 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\nG43.4 H1 Z9.\nG1 X3. A3. F9.\nG0 A0.\nG49\nM30\n"
    )
    (tmp_path / "a.nc").write_bytes(text)
    found = call("check", "-p", str(tmp_path / "p.toml"), str(tmp_path / "a.nc"))
    assert found.exit_code == 0, found.output


@pytest.mark.parametrize("after", ["G0 Z7.", "G53 G0 Z0.", "G0 A0.", "G68"])
def test_axes_that_were_left_are_no_arithmetic(tmp_path, after):
    """Where the control has left axes is unknown: of that nothing is computed, nor warned."""
    chain = chain_of_kind("ac-trunnion", 3)
    text = b"G20 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\nG43.5 H1 Z3.\nG0 X.4 Y.2 I.1 K1.\n"
    text += f"G1 X.5 F20.\nG49\n{after}\nM5\nX.5\nM30\n".encode()
    text = text.replace(b"G49\nG68", b"G68 X0. Y0. R10.\nX.6\nG49")
    steps = pointed(tmp_path, "ac-trunnion", chain)
    if "G68" in after:
        with pytest.raises(gx.InputError) as error:
            steps.run(text)
        assert {d.code for d in error.value.diagnostics} == {"GX330"}
        return
    assert steps.run(text, "full").certificate.verified
