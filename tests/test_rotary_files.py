"""`gcxform calibrate rotary`: tables, machine files, reports, and what is refused."""

from __future__ import annotations

import json
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from console_kit import check_console

from gcxform.calibrate.rotary.axis import Centres, locate
from gcxform.calibrate.rotary.ball_file import balls_csv, parse_balls
from gcxform.diagnostics import InputError
from gcxform.machine.chain import Rotary
from gcxform.machine.file import load_machine
from gcxform.plugin.registry import default_registry
from gcxform.simulate.balls import simulate_balls

TRUE = Rotary("A", (0.9999999354499963, -0.00021, 0.00029), (5.013, -32.017, -95.032), -1)
MACHINE = """# a mill
format = 1
table = ["A", "C"]    # from the base

[axis.A]              # tilts
direction = [1.0, 0.0, 0.0]
point = ["5 mm", -32.0, -95.0]
sign = -1
limits = [-30.0, 110.0]

[axis.C]
direction = [0.0, 0.0, 1.0]
point = [5.0, -20.0, -60.0]
sign = -1

[tool.1]
length = 120.0
"""
ANGLES = np.arange(-30.0, 111.0, 20.0)


def table(axis: Rotary = TRUE, noise: float = 0.002) -> str:
    points = simulate_balls(axis, (40.0, 60.0, -80.0), ANGLES, noise=noise)
    return balls_csv(Centres(ANGLES, points))


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Go to a folder with a machine file and ball centres of its axis A."""
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MACHINE)
    Path("a.csv").write_text(table())
    return tmp_path


def test_a_table_reads_back_as_the_same_bits():
    text = table()
    assert balls_csv(parse_balls(text).centres) == text


def test_units_are_those_of_the_header():
    degrees = parse_balls(table()).centres
    rows = [
        [repr(float(np.radians(a))), *(repr(v * 1000) for v in point)]
        for a, point in zip(ANGLES, degrees.points.tolist(), strict=True)
    ]
    head = "angle [rad];X [um];Y [um];Z [um];temperature table [degC]\n"
    found = parse_balls(head + "".join(";".join([*row, "20.5"]) + "\n" for row in rows))
    assert found.centres.degrees == pytest.approx(ANGLES, abs=1e-12)
    assert found.centres.points == pytest.approx(degrees.points, abs=1e-10)
    assert found.conditions["temperature table"]["mean"] == 20.5


@pytest.mark.parametrize(
    ("old", "new", "code", "place", "said"),
    [
        ("angle [deg]", "angle", "GX470", "1:1", "'angle' has no unit"),
        ("angle [deg]", "angle [mm]", "GX470", "1:1", "'mm' is not a unit of an angle"),
        ("angle [deg]", "A [deg]", "GX470", "1:1", "the column 'a' means nothing"),
        ("X [mm]", "X [deg]", "GX470", "1:13", "'deg' is not a unit of length"),
        ("\n-10.0,", "\n,", "GX471", "3:1", "a number is missing"),
    ],
)
def test_a_wrong_table_is_refused_with_its_place(old, new, code, place, said):
    with pytest.raises(InputError) as caught:
        parse_balls(table().replace(old, new))
    diagnostic = caught.value.diagnostics[0]
    where = diagnostic.where
    assert (diagnostic.code, f"{where.line}:{where.column}") == (code, place)
    assert said in diagnostic.message


def test_a_copied_row_is_shown():
    lines = table().splitlines()
    copied = "\n".join([*lines[:4], lines[2], *lines[4:]])
    with pytest.raises(InputError, match="stands twice, also in row 2") as caught:
        locate(parse_balls(copied).centres, 0.002)
    assert caught.value.diagnostics[0].where.line == 5


def test_the_machine_file_keeps_all_but_the_axis(files):
    done = call("calibrate", "rotary", "--axis", "A", "-m", "m.toml", "-o", "new.toml", "a.csv")
    assert done.exit_code == 0, done.output
    written = Path("new.toml").read_text()
    old, new = tomllib.loads(MACHINE), tomllib.loads(written)
    for key in ("direction", "point", "sign"):
        del old["axis"]["A"][key]
        del new["axis"]["A"][key]
    assert new == old
    kept = [line for line in written.splitlines() if not line.startswith("# calibrated:")]
    axis = MACHINE.splitlines().index("[axis.A]              # tilts")
    assert kept[: axis + 1] == MACHINE.splitlines()[: axis + 1]
    assert kept[axis + 4 :] == MACHINE.splitlines()[axis + 4 :]
    assert max(map(len, written.splitlines())) <= 100
    found = load_machine(Path("new.toml")).axes["A"]
    assert found.sign == -1
    assert found.direction == pytest.approx(TRUE.direction, abs=1.5e-4)
    away = np.cross(np.subtract(found.point, TRUE.point), TRUE.direction)
    assert np.linalg.norm(away) < 0.02  # the direction over the 35 mm to the ball, and noise


def test_an_axis_in_one_line_is_found_as_well(files):
    inline = "axis.A = {direction = [1.0, 0.0, 0.0], point = [5.0, -32.0, -95.0], sign = -1}"
    Path("inline.toml").write_text(f'format = 1\ntable = ["A"]\n{inline} # tilts\n')
    for name in ("m", "inline"):
        words = ("--axis", "A", "-m", f"{name}.toml", "-o", f"new-{name}.toml", "a.csv")
        assert call("calibrate", "rotary", *words).exit_code == 0
    one, other = (load_machine(Path(f"new-{name}.toml")).axes["A"] for name in ("m", "inline"))
    assert (one.direction, one.point, one.sign) == (other.direction, other.point, other.sign)
    assert Path("new-inline.toml").read_text().endswith("} # tilts\n")


def test_calibrating_again_leaves_one_set_of_comments(files):
    words = ("calibrate", "rotary", "--axis", "A", "a.csv")
    assert call(*words, "-m", "m.toml", "-o", "one.toml").exit_code == 0
    assert call(*words, "-m", "one.toml", "-o", "two.toml").exit_code == 0
    assert Path("two.toml").read_text() == Path("one.toml").read_text()


def test_c8_the_file_is_the_same_however_the_axis_was_written(files):
    """C8: V and -V inputs give the same machine file."""
    other = MACHINE.replace("[1.0, 0.0, 0.0]", "[-1.0, 0.0, 0.0]").replace(
        "sign = -1", "sign = 1", 1
    )
    Path("n.toml").write_text(other)
    for name in "mn":
        words = ("-m", f"{name}.toml", "-o", f"{name}{name}.toml")
        assert call("calibrate", "rotary", "--axis", "A", *words, "a.csv").exit_code == 0
    assert Path("mm.toml").read_bytes() == Path("nn.toml").read_bytes()


def test_without_a_machine_there_is_one_of_that_axis(files):
    done = call("calibrate", "rotary", "--axis", "A", "-o", "-", "a.csv")
    assert done.exit_code == 0
    Path("new.toml").write_text(done.stdout)
    machine = load_machine(Path("new.toml"))
    assert machine.table == ("A",)
    assert "the dial is predicted to read 0 +-" in done.stderr


def test_the_report_says_what_the_lines_say(files):
    words = ("--axis", "A", "-m", "m.toml", "--report", "r.json")
    done = call("calibrate", "rotary", *words, "a.csv")
    assert done.exit_code == 0, done.output
    report = json.loads(Path("r.json").read_text())
    matrix = np.array(report["covariance"]["matrix"])
    assert matrix.shape == (6, 6)
    assert report["point"]["sd"] == pytest.approx(np.sqrt(np.diag(matrix)[:3]))
    assert report["direction"]["sd"] == pytest.approx(np.sqrt(np.diag(matrix)[3:]))
    assert report["arc"] == pytest.approx(140.0)
    assert len(report["centres"]) == len(ANGLES)
    assert f"+- {1e3 * max(report['check']['sd']):.3g} um" in done.stdout
    assert "with the axis as it was" in done.stdout
    measured = [np.hypot(c["radial"], np.hypot(c["tangential"], c["axial"])) for c in
                report["centres"]]  # fmt: skip
    dof = 3 * len(measured) - 7
    assert np.sqrt(np.sum(np.square(measured)) / dof) == pytest.approx(report["rms"])
    assert report["redundancy"] == dof


@pytest.mark.parametrize("said", ["outlier, left out: centre 4 (line 5) at 30 degrees is off"])
def test_outliers_are_named_with_their_lines(files, said):
    lines = table().splitlines()
    angle, x, y, z = lines[4].split(",")
    lines[4] = ",".join([angle, repr(float(x) + 0.05), y, z])
    Path("a.csv").write_text("\n".join(lines))
    words = ("-m", "m.toml", "-o", "n.toml", "--report", "r.json")
    done = call("calibrate", "rotary", "--axis", "A", *words, "a.csv")
    assert said in done.stdout
    assert "# calibrated: warning: outlier" in Path("n.toml").read_text()
    (out,) = [c for c in json.loads(Path("r.json").read_text())["centres"] if c["outlier"]]
    assert (out["angle"], out["used"]) == (30.0, False)
    assert out["axial"] == pytest.approx(0.05, abs=0.01)


@pytest.mark.parametrize(
    ("words", "code", "exit_code"),
    [
        (["--axis", "C", "-m", "m.toml"], "GX488", 3),
        (["--axis", "B", "-m", "m.toml"], "GX707", 2),
        (["--axis", "A", "-m", "signed.toml"], "GX488", 3),
        (["--axis", "A", "-m", "headed.toml"], "GX707", 2),
        (["--axis", "A", "--noise", "0"], "GX706", 2),
        (["--axis", "A", "--noise", "0.1 um"], "GX475", 3),
        (["--axis", "A", "-m", "m.toml", "-o", "a.csv"], "GX727", 2),
    ],
)
def test_what_does_not_fit_is_refused(files, words, code, exit_code):
    Path("signed.toml").write_text(MACHINE.replace("sign = -1", "sign = 1", 1))
    Path("headed.toml").write_text(MACHINE.replace('["A", "C"]', '["C"]\nhead = ["A"]'))
    done = call("calibrate", "rotary", *words, "a.csv")
    assert (done.exit_code, code in done.stderr) == (exit_code, True), done.output
    assert Path("m.toml").read_text() == MACHINE
    assert not Path("n.toml").exists()


def test_the_head_of_a_machine_by_its_probe(files):
    axis = Rotary("B", (0.0003, 0.9999999, -0.0001), (250.0, 30.0, 480.0), 1)
    text = MACHINE.replace('["A", "C"]', '["C"]\nhead = ["B"]').replace("axis.A", "axis.B")
    text = text.replace("[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]").replace("sign = -1", "sign = 1", 1)
    Path("m.toml").write_text(
        text.replace("format = 1", "format = 1\ngauge-point = [250, 30, 300]")
    )
    tip = np.array((250.0, 30.0, 180.0))
    points = -axis.turn(np.tile(tip, (8, 1)), ANGLES) + (400.0, 0.0, 0.0)
    Path("b.csv").write_text(balls_csv(Centres(ANGLES, points)))
    words = ("--axis", "B", "--tool", "1", "-m", "m.toml", "-o", "n.toml")
    done = call("calibrate", "rotary", *words, "b.csv")
    assert done.exit_code == 0, done.output
    found = load_machine(Path("n.toml")).axes["B"]
    away = np.cross(np.subtract(found.point, axis.point), axis.direction)
    assert np.linalg.norm(away) < 1e-4
    assert found.sign == 1


EXAMPLES = Path(__file__).parents[1] / "examples"


def test_the_commands_of_the_example_print_what_its_readme_shows(tmp_path):
    for name in ("ball-circles", "trunnion"):
        shutil.copytree(EXAMPLES / name, tmp_path / name)
    assert check_console(EXAMPLES / "ball-circles" / "README.md", tmp_path / "ball-circles") == 4
    known = default_registry().machines
    found = load_machine(tmp_path / "ball-circles" / "machine.toml", known).axes["C"]
    assert found.direction[:2] == pytest.approx((5.4e-5, 7e-5), abs=4e-5)
    assert found.point[:2] == pytest.approx((5.0093 + 0.0011, -20.0121 + 0.0014), abs=4e-3)
