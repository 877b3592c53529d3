"""`volumetric` where the control follows the tip: what is written is walked (`tip_walker.py`)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from kinematics_kit import PRESETS
from rtcp_kit import GAUGE, LENGTH, ZERO, chain_of_kind, machine_text
from tip_walker import Walked, farthest

import gcxform as gx

RIGID = Path(__file__).parents[1] / "examples" / "rigid-body" / "model.toml"
ORIGIN = [0.0, 0.0, 300.0]
TOLERANCE = 0.002
CONTROL = '[control]\norientation-path = "angles"\nedge-after-tool-change = 1\n'
KINDS = sorted(PRESETS)
TABLES = [name for name in KINDS if not PRESETS[name].head]
DECIMALS = {"siemens": 3, "heidenhain": 4, "fagor": 3, "fanuc": 3, "linuxcnc": 3}
CONTROLS = {
    "siemens": CONTROL,
    "fanuc": '[control]\ntip-words = "workpiece"\n',
    "linuxcnc": '[control]\ntip-on = "M428"\ntip-off = "M429"\n',
}


def pipeline(folder, dialect, machine, options=""):
    """Return the pipeline of `volumetric` alone."""
    (folder / "machine.toml").write_text(machine + CONTROLS.get(dialect, ""))
    decimals, options = DECIMALS[dialect], f"{OPTIONS.get(dialect, '')}\n{options}"
    (folder / "p.toml").write_text(
        f'format = 1\n[input]\ndialect = "{dialect}"\n[output]\ndialect = "{dialect}"\n'
        f'stamp = false\ndecimals = {decimals}\n[machine]\nfile = "machine.toml"\n'
        f'[[pass]]\nuse = "volumetric"\nmodel = "{RIGID}"\ntable-origin = {ORIGIN}\n'
        f'outside = "extrapolate"\ntolerance = {TOLERANCE}\n{options}\n'
    )
    return gx.Pipeline.load(folder / "p.toml")


def words(pose, letters, plus=""):
    """Return the words of a pose."""
    return " ".join(f"{a}{v:{plus}.3f}" for a, v in zip("XYZ" + letters, pose, strict=True))


def siemens(poses, letters):
    """Return a program of the lines through poses, under TRAORI."""
    turned = " ".join(f"{letter}0" for letter in letters)
    cuts = "\n".join(f"G1 {words(pose, letters)} F900" for pose in poses[1:])
    return (
        f"G17 G54 G90 G710 G94\nT1 M6\nG0 X0 Y0 Z120 {turned}\nTRAORI ; follows\n"
        f"G0 {words(poses[0], letters)}\n{cuts}\nG0 Z120\nTRAFOOF\nM30\n"
    )


def heidenhain(poses, letters):
    """Return the same under M128."""
    turned = " ".join(f"{letter}+0" for letter in letters)
    cuts = "\n".join(f"L {words(pose, letters, '+')} F900" for pose in poses[1:])
    text = (
        f"BEGIN PGM A MM\nTOOL CALL 1 Z S900\nL X+0 Y+0 Z+120 {turned} R0 FMAX\nM128\n"
        f"L {words(poses[0], letters, '+')} FMAX\n{cuts}\nL Z+120 FMAX\nM129\nEND PGM A MM\n"
    )
    return "".join(f"{n} {line}\n" for n, line in enumerate(text.splitlines()))


def fanuc(poses, letters):
    """Return the same under G43.4, which comes once with the table turned."""
    turned = " ".join(f"{letter}0." for letter in letters)
    cuts = "\n".join(f"G1 {words(pose, letters)} F900." for pose in poses[1:])
    begins = words(poses[0], letters)
    return (
        f"G21 G17 G90 G94 G54 G49\nT1 M6\nG0 X0. Y0. Z120. {turned}\nG43.4 H1\n"
        f"G0 {begins}\n{cuts}\nG0 Z120.\nG49\nG0 X0. Y0. Z120. {begins.partition(letters[0])[1]}"
        f"{begins.partition(letters[0])[2]}\nG43.4 H1\nG0 {begins}\nG1 {words(poses[1], letters)}\n"
        "G0 Z120.\nG49\nM30\n"
    )


def linuxcnc(poses, letters):
    """Return the same with M codes of the machine file."""
    cuts = "\n".join(f"G1 {words(pose, letters)} F900" for pose in poses[1:])
    turned = " ".join(f"{letter}0" for letter in letters)
    return (
        f"G21 G17 G90 G94 G54\nG0 X0 Y0 Z120 {turned}\nG43 H1\nG0 X0 Y0 Z120\nM428\n"
        f"G0 {words(poses[0], letters)}\n{cuts}\nG0 Z120\nM429\nG49\nM2\n"
    )


def fagor(poses, letters):
    """Return the same between #RTCP ON and #RTCP OFF."""
    cuts = "\n".join(f"G1 {words(pose, letters)} F900" for pose in poses[1:])
    turned = " ".join(f"{letter}0" for letter in letters)
    return (
        f"G71 G90 G17 G94 G54\nT1 M6\nD1\nG0 X0 Y0 Z120 {turned}\n#RTCP ON\n"
        f"G0 {words(poses[0], letters)}\n{cuts}\nG0 Z120\n#RTCP OFF\nM30\n"
    )


SPELLED = {
    "siemens": siemens,
    "heidenhain": heidenhain,
    "fagor": fagor,
    "fanuc": fanuc,
    "linuxcnc": linuxcnc,
}
DIALECTS = sorted(SPELLED)
OPTIONS = {"fanuc": 'tips = "turning"'}


def drawn(seed, kind):
    """Return a chain and poses: of short moves and of long ones."""
    rng = np.random.default_rng(seed)
    chain = chain_of_kind(kind, seed)
    poses = [np.append(rng.uniform(-60, 60, 3), rng.uniform(-40, 40, 2)).round(3)]
    for n in range(5):
        scale = (1.5, 0.8) if n % 2 else (60.0, 30.0)
        step = np.append(rng.uniform(-1, 1, 3) * scale[0], rng.uniform(-1, 1, 2) * scale[1])
        still = rng.uniform() < 0.2
        poses.append((poses[-1] + np.where([0, 0, 0, still, still], 0.0, step)).round(3))
    return chain, np.clip(poses, [-90] * 3 + [-60] * 2, [90] * 3 + [60] * 2)


@pytest.mark.parametrize("seed", range(25))
def test_the_tip_stays_on_the_lines_of_the_program(tmp_path, seed):
    """Of machines of all kinds and all controls, as far as tolerance and rounding let it."""
    dialect = DIALECTS[seed % len(DIALECTS)]
    kinds = TABLES if dialect == "fanuc" else KINDS
    kind = kinds[(seed // len(DIALECTS) + 2 * seed) % len(kinds)]
    chain, poses = drawn(seed, kind)
    letters = "".join(sorted(chain.letters))
    text = SPELLED[dialect](poses, letters)
    written = pipeline(tmp_path, dialect, machine_text(kind, chain)).run(text.encode())
    model = gx.read_model(RIGID)
    walked = Walked.of(chain, GAUGE, LENGTH, ZERO, model, ORIGIN)
    rounded = 0.87 * 10.0 ** -DECIMALS[dialect]
    assert farthest(text, written.text.decode(), letters, walked) <= TOLERANCE + rounded
    assert farthest(text, text, letters, walked) > 2 * TOLERANCE
    counted = written.certificate.measured["moves of a tip that the control follows, axes turned"]
    assert counted == 7 + 3 * (dialect == "fanuc")


def fanuc_of(folder, seed=3):
    """Return a pipeline for a trunnion, and a program of G43.4."""
    chain, poses = drawn(seed, "ac-trunnion")
    made = pipeline(folder, "fanuc", machine_text("ac-trunnion", chain))
    return made, fanuc(poses, "AC")


def test_windows_know_where_the_tip_was_left(tmp_path, monkeypatch):
    """A window may begin with the table turned: its first line starts where the last one ended."""
    made, text = fanuc_of(tmp_path)
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 1)
    written = made.run(text.encode()).text.decode()
    chain, _ = drawn(3, "ac-trunnion")
    walked = Walked.of(chain, GAUGE, LENGTH, ZERO, gx.read_model(RIGID), ORIGIN)
    assert farthest(text, written, "AC", walked) <= TOLERANCE + 0.00087


def test_codes_and_blocks_that_lead_nowhere_stay(tmp_path):
    """Of a program that is followed only X, Y and Z of moves become others."""
    made, text = fanuc_of(tmp_path)
    source, written = (each.splitlines() for each in (text, made.run(text.encode()).text.decode()))
    still = [line for line in source if "X" not in line and "Z" not in line]
    assert [line for line in written if "X" not in line and "Z" not in line] == still


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (("F900.", "F900. G41 D1"), "GX"),
        (("G43.4 H1\nG0 X", "G43.4 H1\nG1 F500. X"), "GX311"),
        (("G1 X", "G2 R500. X"), "GX330"),
        (("G49\nM30", "G91 G28 Z0.\nM30"), "GX330"),
        (("H1", "H2"), "GX330"),
    ],
)
def test_what_is_not_known_is_refused(tmp_path, change, code):
    """Contours, a start that nobody has named, arcs, places of the machine, lengths."""
    made, text = fanuc_of(tmp_path)
    with pytest.raises(gx.InputError, match=code):
        made.run(text.replace(*change).encode())


def test_what_ends_the_following_may_end_what_began_before_the_program(tmp_path):
    """With the table turned before it, and unless the machine file says what holds at the start."""
    chain, _ = drawn(3, "ac-trunnion")
    machine = machine_text("ac-trunnion", chain)
    text = (
        "G17 G54 G90 G710 G94\nT1 M6\nG0 X0 Y0 Z100 A0 C30\nG1 X50 Y20 Z10 F500\n"
        "TRAFOOF\nG0 Z100\nM30\n"
    )
    with pytest.raises(gx.InputError, match="whether the control follows the tip is not known"):
        pipeline(tmp_path, "siemens", machine).run(text.encode())
    said = (tmp_path / "machine.toml").read_text() + 'tip-at-start = "off"\n'
    (tmp_path / "machine.toml").write_text(said)
    made = gx.Pipeline.load(tmp_path / "p.toml")
    assert b"TRAFOOF" in made.run(text.encode()).text


def test_the_certificate_says_how_far_the_axes_go_beyond_the_table(tmp_path):
    """Of a line whose ends are within it: (40, 40) at C0 to (48, 30) at C90, about the origin."""
    machine = (
        'format = 1\nkinematics = "ac-trunnion"\n[axis.X]\n[axis.Y]\n[axis.Z]\n'
        "[axis.A]\npoint = [450.0, 0.0, 0.0]\n[axis.C]\npoint = [450.0, 0.0, 0.0]\n"
        "[work-offset.G54]\nX = 450.0\n[tool.1]\nlength = 95.0\n"
    )
    made = pipeline(tmp_path, "siemens", machine)
    text = (
        "G17 G54 G90 G710 G94\nT1 M6\nG0 X0 Y0 Z120 A0 C0\nTRAORI\nG0 X40 Y40 Z10\n"
        "G1 X48 Y30 C90 F900\nG0 X0 Y0 Z120 C0\nTRAFOOF\nM30\n"
    )
    measured = made.run(text.encode()).certificate.measured
    s = np.linspace(0.0, 1.0, 10_001)
    angle = np.radians(90.0 * s)
    x = (40.0 + 8.0 * s) * np.cos(angle) + (40.0 - 10.0 * s) * np.sin(angle)
    told = measured["X beyond the error table (extrapolate), mm"]
    assert told == pytest.approx(x.max() - 50.0, abs=0.01)


def test_a_wrap_leaves_the_way_open(tmp_path):
    """A table that takes the shorter way may turn the other way round."""
    chain, poses = drawn(3, "ac-trunnion")
    machine = machine_text("ac-trunnion", chain).replace("[axis.C]", "[axis.C]\nwrap = 20.0")
    made = pipeline(tmp_path, "fanuc", machine)
    with pytest.raises(gx.InputError, match="half of its wrap"):
        made.run(fanuc(poses, "AC").encode())


def test_the_inverse_refuses_tips_that_are_followed(tmp_path):
    """It is not known to it where the machine goes."""
    chain, poses = drawn(3, "ac-trunnion")
    made = pipeline(tmp_path, "siemens", machine_text("ac-trunnion", chain), "inverse = true")
    with pytest.raises(gx.InputError, match="GX210"):
        made.run(siemens(poses, "AC").encode())


def test_a_step_that_has_other_positions_leaves_the_codes_refused(tmp_path):
    """Behind `rtcp` they are gone, and beside a step that changes feeds they are not read."""
    chain, poses = drawn(3, "ac-trunnion")
    pipeline(tmp_path, "siemens", machine_text("ac-trunnion", chain))
    text = (tmp_path / "p.toml").read_text()
    other = '[[pass]]\nuse = "feed"\nmode = "inverse-time"\n[[pass]]\nuse = "volumetric"'
    (tmp_path / "p.toml").write_text(text.replace('[[pass]]\nuse = "volumetric"', other))
    with pytest.raises(gx.InputError, match="GX210"):
        gx.Pipeline.load(tmp_path / "p.toml").run(siemens(poses, "AC").encode())


def test_an_error_of_the_machine_alone_moves_the_tip_by_it(tmp_path):
    """The walker, by hand: at C90 the table has carried X of the tip to -Y of the machine."""
    chain = gx.Chain(
        (gx.Rotary("C", (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), -1),), (), (0.0, 0.0, -LENGTH)
    )

    class Along:
        """An error of 0.01 mm along Y, everywhere."""

        @staticmethod
        def error(place, outside, tool):
            return np.tile([0.0, 0.01, 0.0], (len(place), 1))

    walked = Walked.of(chain, [0, 0, 0], LENGTH, [0, 0, 0], Along)
    tip = walked.actual(np.array([10.0, 0.0, 0.0]), {"C": 90.0})
    assert np.allclose(tip, [9.99, 0.0, 0.0])
