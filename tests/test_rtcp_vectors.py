"""`rtcp` of programs that say the tool axis by I, J and K (G43.5).

The oracle reads both texts word by word and follows the machine by matrices of scipy; of vectors it
knows that they point from the tip to the holder, on the workpiece with all axes at 0.
"""

from __future__ import annotations

import hashlib
import re

import numpy as np
import pytest
from cli_kit import call
from gcxform_plugins.passes.rtcp_pointing import InProportion
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from kinematics_kit import leaning, tool
from rtcp_kit import (
    KINDS,
    LENGTH,
    ROUNDED,
    axes,
    between,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from scipy.spatial.transform import Rotation
from test_rtcp_repost import leaning_poses
from test_rtcp_retract import limited

import gcxform as gx
from gcxform.cuts import whole_sections
from gcxform.run import Output, Run
from gcxform.source import Source
from gcxform.tipcodes import with_vectors

EACH = settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much],
    deadline=None,
    max_examples=8,
)
TOLERANCE = 0.01
ROOM = 2e-6  # mm; the least decimals of a machine file and of the matrices
ENDS = np.radians(0.0011)  # two angles with three decimals
MODES = ("angles", "great-circle")
PLACED = ("GX331", "GX332", "GX333", "GX334", "GX335")
"""What may speak against a way of the tool, whatever it is."""


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


def winding(turns, tilt=40.0, count=24):
    """Return blocks in which the tool axis goes round Z so many times."""
    around = np.linspace(0.0, 360.0 * turns, count)
    axes = leaning(np.full(count, tilt), around)
    spots = np.column_stack([np.linspace(0.0, 60.0, count), np.zeros(count), np.zeros(count)])
    codes = ["G0 ", "G1 F600. ", *[""] * (count - 2)]
    return [block(p, k, c) for p, k, c in zip(spots, axes, codes, strict=True)]


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


# --- the proof ---


def proved(folder, change, mode="angles"):
    """Let the proof look at a path that was changed after it was made."""
    chain = chain_of_kind("ac-trunnion", 3)
    step = pointed(folder, "ac-trunnion", chain, mode)
    rtcp = next(one for one in step.path_passes if one.name == "rtcp")
    text = several(chain, 1).replace(b"G43.5", b"G43")
    source = gx.Program(text, with_vectors(step.source), step.machine_reading).path
    after = rtcp.apply(source, step.context)
    rtcp.prove(source, after, step.context)
    rtcp.prove(source, change(after), step.context)


def turned(column, rows, by):
    """Return a change of one axis in some rows."""

    def change(path):
        end = path.end.copy()
        end[rows, column] += by
        return path.replace(end=end)

    return change


def as_it_is(path):
    return path


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    ("column", "rows", "by"),
    [(4, -20, 0.002), (3, slice(3, None), 0.002), (2, -20, 0.02), (0, -1, 0.001), (3, 30, 0.002)],
)
def test_the_proof_sees_it(tmp_path, mode, column, rows, by):
    with pytest.raises(gx.VerificationError):
        proved(tmp_path, turned(column, rows, by), mode)


@pytest.mark.parametrize(("factor", "by"), [(1.0, -360.0), (1.0, 360.0), (-1.0, 180.0)])
def test_the_proof_sees_ways_round_about(tmp_path, monkeypatch, factor, by):
    """Tips, and tool axes at the ends of blocks, are right; the axes take another way there."""
    choose = InProportion._choose

    def wrong(self):
        choose(self)
        cut = np.flatnonzero(self.cuts)[4]
        self.said[cut:, 0] *= factor
        self.said[cut:, 1] += by

    monkeypatch.setattr(InProportion, "_choose", wrong)
    with pytest.raises(gx.VerificationError, match="round about"):
        proved(tmp_path, as_it_is)


def test_the_proof_sees_what_is_out_of_proportion(tmp_path):
    """The tip is where it was, the tool axis nearly so."""
    chain = chain_of_kind("ac-trunnion", 3)
    tipped = [0, 1, 2, 3, 4]

    def change(path):
        row = int(np.flatnonzero(path.kind == gx.Kind.LINE)[2])
        end = path.end.copy()
        length = np.array([0.0, 0.0, LENGTH, 0.0, 0.0])
        words = end[row : row + 1, tipped] - length
        moved = words + np.array([0.0, 0.0, 0.0, 0.0, 0.001])
        moved[:, :3] = axes(chain, np.hstack([tips(chain, words), moved[:, 3:]]))
        end[row, tipped] = moved[0] + length
        return path.replace(end=end)

    with pytest.raises(gx.VerificationError, match="proportion"):
        proved(tmp_path, change)


def test_the_proof_sees_an_axis_that_should_have_stayed(tmp_path):
    """After G49 C is where it was: a turn of it is none of the source."""

    def change(path):
        first = int(np.flatnonzero(path.form == gx.Form.MACHINE)[0])
        return turned(4, first, 1.0)(path)

    with pytest.raises(gx.VerificationError, match="outside"):
        proved(tmp_path, change)


def test_the_proof_sees_a_missing_turn(tmp_path):
    """In G93 the last block may turn the tool about its tip; without it nothing else changes."""
    chain = chain_of_kind("ac-trunnion", 3)
    blocks = ["G0 X0. Y0. Z0. J-1. K1.", "G1 I1. J0. K1. F9."]
    text = whole(blocks, chain, "G93").replace(b"G43.5", b"G43")
    step = pointed(tmp_path, "ac-trunnion", chain)
    rtcp = next(one for one in step.path_passes if one.name == "rtcp")
    source = gx.Program(text, with_vectors(step.source), step.machine_reading).path
    after = rtcp.apply(source, step.context)
    rtcp.prove(source, after, step.context)
    kept = np.flatnonzero(after.kind != gx.Kind.LINE)
    end = after.end[kept].copy()
    end[3, :2] = end[2, :2]  # after G49 they stay where they are then
    with pytest.raises(gx.VerificationError, match="missing"):
        rtcp.prove(source, after.take(kept).replace(end=end), step.context)


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


# --- what stays as it is ---


def test_other_chains_refuse_it():
    """Whatever asks for positions refuses G43.5 by name; what edits text copies it."""
    text = whole(winding(0.2), chain_of_kind("ac-trunnion", 3))
    for chain in ("absolute", "metric", "feed mode=inverse-time", "offsets | absolute"):
        with pytest.raises(gx.InputError) as error:
            gx.Pipeline.parse(chain, "fanuc").run(text)
        assert {d.code for d in error.value.diagnostics} == {"GX210"}
    edited = gx.Pipeline.parse("renumber", "fanuc").run(text).text
    assert edited.count(b"I0.") == text.count(b"I0.")
    with pytest.raises(gx.InputError, match=r"G43\.5"):
        gx.read(text, "fanuc").path  # noqa: B018


def test_angles_are_not_read_as_vectors(tmp_path):
    chain = chain_of_kind("ac-trunnion", 3)
    step = pointed(tmp_path, "ac-trunnion", chain)
    for code in ("G43.4", "G43"):
        text = f"G21 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\n{code} H1 Z9.\nG1 X3. A3. F9.\nM30\n"
        with pytest.raises(gx.InputError) as error:
            step.run(text.encode())
        assert {d.code for d in error.value.diagnostics} <= {"GX210", "GX330"}
    with pytest.raises(gx.InputError, match="positions of axes"):
        step.run(whole(["G43 H1"], chain))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rapids": "refuse"}, 'rapids = "ends"'),
        ({"direction": "to-tip"}, "tip-codes"),
        ({"direction": "retarget", "target": "machine.toml"}, "tip-codes"),
        ({"retract": "5 mm", "retract_feed": 500.0}, "retract"),
    ],
)
def test_options_that_do_not_fit(tmp_path, options, message):
    chain = chain_of_kind("ac-trunnion", 3)
    with pytest.raises(gx.UsageError, match=message):
        pointed(tmp_path, "ac-trunnion", chain, **options)
