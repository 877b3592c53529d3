"""`gcxform simulate` and `gcxform show`: tables, data, pictures, refusals."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from cli_kit import call, process
from simulate_kit import EXAMPLE, file_of, functions

import gcxform as gx
from gcxform import plot
from gcxform.machine.machinefile import load_machine
from gcxform.machine.modelfile import load_model
from gcxform.plot import canvas
from gcxform.plot.models import curves, squareness
from gcxform.registry import default_registry
from gcxform.simulate.heat import before_and_after, in_order

EXAMPLES = EXAMPLE.parents[1]
MODEL = ("--model", str(EXAMPLE))
SVG = "{http://www.w3.org/2000/svg}"
BALLBAR = ("simulate", "ballbar", *MODEL, "--planes", "XY", "--radius", "100 mm")
LINES = ("simulate", "positioning", *MODEL, "--runs", "2", "--targets", "4")
DIAGONAL = ("simulate", "diagonal", *MODEL, "--runs", "1", "--diagonals")
PROGRAM = str(EXAMPLES / "lddm" / "linear_in.nc")
SHOW = ("show", "-f", "fanuc", *MODEL, "--part-origin", "0,0,0")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def drawn(file: str) -> tuple[dict[str, ElementTree.Element], str]:
    """Return the groups of an SVG by their names, and all that is written in it."""
    root = ElementTree.parse(file).getroot()
    groups = {group.get("id", ""): group for group in root.iter(f"{SVG}g")}
    return groups, "\n".join(t.text or "" for t in root.iter(f"{SVG}text"))


def corners(group: ElementTree.Element) -> int:
    """Return how many points a curve has."""
    return len(re.findall("[ML]", "".join(path.get("d", "") for path in group.iter(f"{SVG}path"))))


def figures(stdout: str) -> dict[str, tuple[float, float]]:
    """Return the table by the names in it: before and after, um."""
    rows = re.findall(r"^(\S+ +\S.*?) +(-?[\d.]+|-) +(-?[\d.]+|-)$", stdout, re.MULTILINE)
    return {" ".join(name.split()): (before, after) for name, before, after in rows}


# --- simulate ---


def test_ballbar_prints_figures_before_and_after(here):
    found = call(*BALLBAR)
    assert found.exit_code == 0, found.stderr
    table = figures(found.stdout)
    assert list(table)[:3] == ["XY G(CW)", "XY G(CCW)", "XY G(b)"]
    assert table["XY G(CW)"][0] == "3.647"
    assert float(table["XY G(CW)"][1]) < 2.0
    assert "radius 100 mm about X240 Y165 Z225" in found.stdout
    assert found.stderr == ""


def test_diagonals_print_those_of_the_published_tables(here):
    """S1, and the largest E of the body diagonals."""
    table = figures(call(*DIAGONAL, "body").stdout)
    ends = [table[f"{name} end"][0] for name in ("PPP", "NPP", "PNP", "PPN")]
    assert ends == ["4.254", "-26.823", "-27.853", "-37.184"]
    assert table["body E_D"][0] == max((table[f"{n} E"][0] for n in ("PPP", "PPN")), key=float)
    assert table["body B_D"] == ("0.000", "0.000")
    assert "face E_D" not in table
    assert set(figures(call(*DIAGONAL, "n0p,PPP").stdout)) >= {"N0P E", "PPP M", "face E_D"}


def test_one_run_prints_dashes(here):
    table = figures(call(*LINES, "--runs", "1", "--axes", "z").stdout)
    assert table["Z A"] == ("-", "-")
    assert float(table["Z E"][0]) > 10.0


def test_data_are_those_of_the_table(here):
    found = call(*LINES, "--noise", "0.5 um", "--json", "out.json")
    data = json.loads((here / "out.json").read_text())
    for name, (before, after) in figures(found.stdout).items():
        axis, symbol = name.split(" ", 1)
        pair = data["figures"][axis][symbol]
        assert f"{1000 * pair['before'] + 0.0:.3f}" == before
        assert f"{1000 * pair['after'] + 0.0:.3f}" == after
    reading = data["readings"]["before"]["X"]
    assert np.shape(reading["up"]) == np.shape(reading["down"]) == (4, 2)
    assert 1.0 <= reading["target"][0] <= 3.0  # positions of the axis, and there its errors
    places = np.array([[x, 165.0, 225.0] for x in reading["target"]])
    quiet = json.loads(call(*LINES, "--json", "-").stdout)["readings"]["before"]["X"]
    assert quiet["target"] == reading["target"]
    truth = load_model(EXAMPLE).error(places)[:, 0]
    assert np.array(quiet["up"])[:, 0] == pytest.approx(truth, abs=1e-12)
    alone = call(*LINES, "--noise", "0.5 um", "--json", "-")
    assert json.loads(alone.stdout) == data
    assert json.loads(call(*LINES, "--runs", "1", "--json", "-").stdout)["figures"]["X"]["A"] == {
        "before": None,
        "after": None,
    }


def test_radii_are_among_the_data(here):
    data = json.loads(call(*BALLBAR, "--json", "-").stdout)
    reading, found = data["readings"]["before"]["XY"], data["figures"]["XY"]
    assert len(reading["angle"]) == len(reading["cw"]) == 360
    assert max(reading["ccw"]) == pytest.approx(found["Fmax(CCW)"]["before"], abs=5e-5)
    assert min(reading["cw"]) == pytest.approx(found["Fmin(CW)"]["before"], abs=5e-5)


def test_programs_are_written(here):
    found = call(*LINES, "--program", "before.nc", "--compensated", "after.nc")
    assert found.exit_code == 0
    compare = ("compare", "-f", "fanuc", *MODEL, "--part-origin", "0,0,0", "--tolerance", "2um")
    assert "deviation" in call(*compare, "before.nc", "after.nc").stdout
    assert call(*compare, "before.nc", "after.nc").exit_code == 0
    assert (here / "before.nc").read_text().startswith("G21 G90 G17 G94 F1000.\nG1 X")


@pytest.mark.parametrize(
    ("words", "named", "written"),
    [
        (
            BALLBAR,
            ["XY before cw", "XY after ccw"],
            ["XY before, 5 um/div", "G(b) 3.65", "+X", "-Y"],
        ),
        (LINES, ["X before mean up", "Z after low down"], ["deviation, um", "X before"]),
        ((*DIAGONAL, "body"), ["PPP before", "PPN after"], ["body diagonals before", "PPP  E 12"]),
    ],
)
def test_pictures_of_tests(here, words, named, written):
    for file in ("one.svg", "two.svg", "three.png"):
        assert call(*words, "--plot", file).exit_code == 0
    assert (here / "one.svg").read_bytes() == (here / "two.svg").read_bytes()
    groups, text = drawn("one.svg")
    assert [name for name in named if name not in groups] == []
    assert [word for word in written if word not in text] == []
    assert "<dc:date>" not in (here / "one.svg").read_text()
    assert_png(here / "three.png")


def assert_png(file: Path) -> None:
    """Assert that a picture opens and that there is something on it."""
    from matplotlib.image import imread

    picture = imread(file)
    assert picture.shape[0] > 400
    assert 0.5 < (picture[:, :, :3] == 1.0).all(axis=2).mean() < 0.995


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ((*BALLBAR, "--plot", "out.pdf"), "GX737"),
        ((*BALLBAR, "--planes", "XY,XZ"), "GX707"),
        ((*BALLBAR, "--radius", "170"), "GX738"),
        ((*BALLBAR, "--radius", "-1"), "GX706"),
        ((*BALLBAR, "--noise", "1 inch?"), "GX708"),
        ((*BALLBAR, "--outside", "perhaps"), "GX707"),
        ((*BALLBAR, "-f", "nothing"), "GX703"),
        ((*BALLBAR, "--json", "a", "--plot", "a"), "GX728"),
        ((*BALLBAR, "--json", str(EXAMPLE)), "GX727"),
        ((*DIAGONAL, "PPX"), "GX707"),
        ((*LINES, "--targets", "1"), "GX706"),
        ((*LINES, "--targets", "900"), "GX738"),
        (("simulate", "ballbar", "--model", "no.toml"), "GX709"),
        (("show", "-o", "out.txt", str(EXAMPLE)), "GX737"),
        (("show", "-o", "out.svg", "no.toml"), "GX709"),
        (("show", "-o", "out.svg", *MODEL, PROGRAM), "GX722"),
        (("show", "-o", "out.svg", "-f", "fanuc", *MODEL, PROGRAM), "GX721"),
        ((*SHOW, "-x", "arcs tolerance=1um", "-o", "out.svg", PROGRAM), "GX713"),
    ],
)
def test_refusals(here, words, code):
    found = call(*words)
    assert (found.exit_code, found.stdout) == (2, "")
    assert f"error[{code}]" in found.stderr
    assert list(here.iterdir()) == []


def test_a_model_without_room_has_no_test(here):
    (here / "flat.toml").write_text(
        'format = 1\nkind = "axis-functions"\nvalues = "error"\nconvention = "relative"\n'
        'order = "XYZ"\n[X]\nposition = [0.0, 100.0]\nEXX = [0.0, 0.001]\nEYX = [0.0, 0.0]\n'
        "EZX = [0.0, 0.0]\n"
    )
    for words in (("ballbar",), ("diagonal",), ("positioning",)):
        found = call("simulate", *words, "--model", "flat.toml")
        assert (found.exit_code, "GX738" in found.stderr) == (2, True)
    table = figures(call("simulate", "positioning", "--model", "flat.toml", "--axes", "X").stdout)
    assert table["X B"] == ("0.000", "0.000")
    assert call("show", "-o", "flat.svg", "flat.toml").exit_code == 0


def test_without_matplotlib_the_extra_is_named(here, monkeypatch):
    monkeypatch.setattr(canvas, "find_spec", lambda name: None)
    found = call(*BALLBAR, "--plot", "out.svg")
    assert (found.exit_code, found.stdout) == (2, "")
    assert "error[GX736]" in found.stderr
    assert "gcxform[plot]" in found.stderr
    assert call(*BALLBAR).exit_code == 0


def test_figures_wait_for_no_matplotlib(here):
    verbs = "gcxform.cli.simulate, gcxform.cli.show"
    code = f"import sys, {verbs}; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_picture_on_stdout_would_have_no_kind(here):
    found = process("show", "-o", "-", str(EXAMPLE))
    assert (found.returncode, found.stdout) == (2, b"")


# --- models ---


def test_a_model_is_drawn_as_a_grid_of_functions_and_a_volume(here):
    assert call("show", str(EXAMPLE), "-o", "model.svg").exit_code == 0
    groups, text = drawn("model.svg")
    for name in ("EXX", "EYX", "EZX", "EXY", "EYY", "EZY", "EXZ", "EYZ", "EZZ"):
        assert corners(groups[name]) == 11, name
        assert f"{name}, um" in text
    for name in ("EAX", "ECZ"):
        assert name not in groups
        assert f"{name}: none" in text
    for word in ("C0Y -25.264 urad", "B0Z +34.424 urad", "A0Z -52.624 urad"):
        assert word in text
    assert {"nominal", "actual", "errors"} <= set(groups)
    assert "errors x 2000" in text
    assert call("show", str(EXAMPLE), "-o", "model.png").exit_code == 0
    assert_png(here / "model.png")


def test_squareness_is_the_angle_between_two_axes_whatever_their_frame():
    """V9: turned by a small angle about Z, both straightnesses change and C0Y does not."""
    turn = 3e-5
    plain = curves(functions(EXY=-2e-5, EYZ=1e-5))
    turned = curves(functions(EXY=-2e-5 - turn, EYX=turn, EYZ=1e-5))
    assert squareness(plain) == pytest.approx({"C0Y": 2e-5, "B0Z": 0.0, "A0Z": -1e-5})
    assert squareness(turned) == pytest.approx(squareness(plain))


def test_a_machine_of_21_parameters_fills_the_grid(here):
    assert call("show", str(EXAMPLES / "rigid-body" / "model.toml"), "-o", "all.svg").exit_code == 0
    groups, text = drawn("all.svg")
    names = [f"E{letter}{axis}" for axis in "XYZ" for letter in "XYZABC"]
    assert [name for name in names if name not in groups] == []
    assert all(f"{name}, {'um' if name[1] in 'XYZ' else 'urad'}" in text for name in names)
    assert "none" not in text


def test_a_long_title_stays_in_a_narrow_picture(here):
    assert call(*LINES, "--axes", "x", "--plot", "narrow.svg").exit_code == 0
    lines = drawn("narrow.svg")[1].splitlines()
    assert [line for line in lines if "proved" in line]
    assert max(map(len, lines)) < 60


def test_of_a_sum_the_sums_of_the_functions_are_drawn(here):
    """A warm screw and its geometry: each function is the error along its axis, from zero on."""
    folder = EXAMPLES / "warm-screw"
    whole, parts = load_model(folder / "machine.toml"), curves(load_model(folder / "machine.toml"))
    assert call("show", str(folder / "machine.toml"), "-o", "sum.svg").exit_code == 0
    groups, _ = drawn("sum.svg")
    assert set(parts) <= set(groups)
    for name, (position, value) in parts.items():
        axis, into = "XYZ".index(name[2]), "XYZ".index(name[1])
        points = np.zeros((len(position), 3))
        points[:, axis] = position
        expected = whole.error(points)[:, into] - whole.error(np.zeros((1, 3)))[0, into]
        low = float(np.interp(0.0, position, value))
        assert value - low == pytest.approx(expected, abs=5e-5), name
    assert "EXX" in parts


def test_a_model_without_limits_is_drawn_over_a_volume(here):
    """B0Z of 200 urad is 20 um in X and C0Y of 100 urad 10 um, at 100 mm: 30 um where both add."""
    (here / "skew.toml").write_text(
        'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nB0Z = 2e-4\n'
    )
    assert call("show", "skew.toml", "-o", "skew.svg").exit_code == 0
    groups, text = drawn("skew.svg")
    assert "largest 30.00 um" in text
    assert corners(groups["actual"]) > 100


def test_both_directions_of_a_pitch_table_are_drawn(here):
    table = "position = [0, 100, 200]\nforward = [0, 0.01, 0.02]"
    (here / "pitch.toml").write_text(
        f'format = 1\nkind = "pitch"\nvalues = "error"\n[X]\n{table}\n'
        f"reverse = [-0.004, 0.007, 0.015]\n[Y]\n{table}\n"
    )
    assert call("show", "pitch.toml", "-o", "pitch.svg").exit_code == 0
    groups, text = drawn("pitch.svg")
    assert corners(groups["EXX"]) == corners(groups["EXX reverse"]) == 3
    assert "reverse" in text
    assert "EYY" in groups
    assert "EYY reverse" not in groups


class Lattice(gx.ErrorModel):
    """A model that is no function of one axis at a time."""

    kind = "lattice"
    nodes = (np.array([0.0, 50.0]),) * 3

    def lipschitz(self, reach=0.0):
        return 1e-4

    def largest(self, reach=0.0):
        return 1e-2

    def error(self, position, outside=gx.Outside.ERROR, tool=None, sense=None):
        return 1e-6 * position * position[:, ::-1]

    def range_of(self, axis_index):
        return 0.0, 50.0


def test_of_a_lattice_the_field_alone_is_drawn(here):
    picture = plot.rendered(plot.model(Lattice(), "lattice"), "out.svg")
    (here / "out.svg").write_bytes(picture)
    groups, text = drawn("out.svg")
    assert {"nominal", "actual", "errors"} <= set(groups)
    assert "EXX" not in text


# --- programs ---


def test_the_error_along_a_program_before_and_after(here):
    """V4: the figures of the pictures are those of `compare` and of the certificate."""
    assert call(*SHOW, "-o", "heat.svg", PROGRAM).exit_code == 0
    groups, text = drawn("heat.svg")
    assert {"before", "after"} <= set(groups)
    assert "before: at most 13.85 um" in text
    assert "after: at most 0.94 um" in text
    assert "distance from the programmed path, um" in text
    colours = {path.get("style") for path in groups["before"].iter(f"{SVG}path")}
    assert len(colours) > 50
    assert call(*SHOW, "-o", "heat.png", PROGRAM).exit_code == 0
    assert_png(here / "heat.png")


def test_what_is_refused_in_a_program_has_its_place(here):
    """A call is executed: the place is that in the file."""
    text = "G21 G90 G17\nG0 X0 Y0 Z5\no1 repeat [3]\nG91 G1 X200. F100\no1 endrepeat\nM2\n"
    (here / "row.ngc").write_text(text)
    found = call("show", "-f", "linuxcnc", *SHOW[3:], "-o", "row.svg", "row.ngc")
    assert found.exit_code == 3
    assert found.stderr.startswith("row.ngc:4:1: error[GX310]: X 600.000"), found.stderr
    assert not Path("row.svg").exists()


def test_backlash_and_large_corrections_are_drawn_if_asked(here):
    (here / "bed.toml").write_text(
        'format = 1\nkind = "height-map"\nX = [0, 100]\nY = [0, 100]\n'
        "height = [[0, 0.5], [0, 0.5]]\n"
    )
    (here / "part.nc").write_text("G21 G90 G17 G94\nG1 X0. Y0. Z0. F100.\nX90.\nM30\n")
    words = ("show", "-f", "grbl", "--model", "bed.toml", "--part-origin", "0,0,0", "-o", "bed.svg")
    found = call(*words, "part.nc")
    assert (found.exit_code, "part.nc:3:1: error[GX313]" in found.stderr) == (3, True)
    assert call(*words, "--max-correction", "1 mm", "part.nc").exit_code == 0
    assert "before: at most 450.00 um" in drawn("bed.svg")[1]


def pipeline(dialect, chain="", machine=None, **options):
    kind, registry = default_registry().dialect(dialect), default_registry()
    first = gx.Pipeline.parse(f"absolute {chain}", dialect).passes
    step = registry.pass_("volumetric")(tolerance=0.001, **options)
    return gx.Pipeline(kind, kind, (*first, step), machine=machine)


def test_the_largest_deviation_is_that_of_the_proof():
    folder = EXAMPLES / "bracket"
    machine = load_machine(folder / "machine.toml")
    steps = pipeline("linuxcnc", machine=machine, model=gx.ModelFile.load(EXAMPLE))
    program = gx.read(folder / "bracket.nc", "linuxcnc")
    before, after, result = before_and_after(program, steps)
    assert after.largest == pytest.approx(result.certificate.largest["deviation"], rel=1e-6)
    assert before.largest > 10 * after.largest
    drawn = before.end[~before.rapid] - before.start[~before.rapid]
    assert np.sqrt((drawn**2).sum(axis=1)).max() < 3.0  # mm: fine enough to see


CYCLES = b"""G21 G90 G17 G94 F500
G0 X10 Y10 Z20
G1 Z5
G5 I20 J30 P-20 Q-30 X100 Y80
G98 G83 X60 Y50 Z2 R10 Q3
X90
G80
G2 X120 Y50 I15 J0
M2
"""


def test_cycles_and_splines_find_their_moves_again():
    """A scale of 1e-4: deviation before is what it makes at the place, after that of rounding."""
    chain = "| cycles | segment chord-error=0.1um arcs=lines"
    origin = (0.0, 0.0, 100.0)
    model = functions(EZX=1e-4)
    steps = pipeline("linuxcnc", chain, model=file_of(model), part_origin=origin)
    before, after, _ = before_and_after(gx.read(CYCLES, "linuxcnc"), steps)
    assert after.largest < 0.0013
    down = ~before.rapid & (np.abs(before.end - before.start)[:, :2].max(axis=1) < 1e-3)
    assert down.any()
    flat = ~before.rapid & ~down
    wanted = 1e-4 * np.maximum(before.start, before.end)[flat, 0]
    assert before.deviation[flat] == pytest.approx(wanted, abs=4e-4)
    for x in (60.0, 90.0):
        one, other = (feeds_at(side, x) for side in (before, after))
        assert one == pytest.approx(8.0 + 2 * 0.254, abs=0.02)  # again where each peck ended
        assert other == pytest.approx(one, abs=0.01)


def test_moves_that_were_cut_belong_to_the_move_whose_end_comes_next():
    down, up = [0.0, 0.0, 2.0], [0.0, 0.0, 10.0]
    ends = np.array([up, down, up, down, up])
    others = np.array([up, [0.0, 0.0, 6.0], down, up, [0.0, 0.0, 8.0], [0.0, 0.0, 4.0], down, up])
    assert in_order(ends, others + 0.02).tolist() == [0, 1, 1, 2, 3, 3, 3, 4]
    assert in_order(ends, ends).tolist() == [0, 1, 2, 3, 4]
    assert in_order(ends[:2], others[:1]).tolist() == [0]


def feeds_at(heat, x):
    """Return how far the tool goes down in feed at an X, mm."""
    here = ~heat.rapid & (np.abs(heat.end[:, 0] - x) < 0.1) & (np.abs(heat.end[:, 1] - 50) < 0.1)
    way = heat.end[here] - heat.start[here]
    return -float(way[np.abs(way[:, :2]).max(axis=1) < 0.01, 2].sum())


def test_a_long_program_is_an_image_within_the_svg(here, monkeypatch):
    monkeypatch.setattr("gcxform.plot.paths.AS_LINES", 100)
    assert call(*SHOW, "-o", "heat.svg", PROGRAM).exit_code == 0
    root = ElementTree.parse("heat.svg").getroot()
    assert len(list(root.iter(f"{SVG}image"))) >= 2


def test_a_foreign_table_is_drawn_as_well(here):
    shutil.copytree(EXAMPLES / "lddm", here / "lddm", ignore=shutil.ignore_patterns("out"))
    assert call("show", "lddm/table_x.txt", "-o", "one.svg").exit_code == 0
    assert "C0Y -25.264 urad" in drawn("one.svg")[1]
    assert load_model(EXAMPLE).range_of(0) == (0.0, 480.0)
