"""`gcxform simulate` and `gcxform show`: tables, data, pictures, refusals."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from cli_kit import call, process
from picture_kit import SVG, assert_png, drawn, figures
from simulate_kit import EXAMPLE, file_of, functions

import gcxform as gx
from gcxform.errormodel.model_file import load_model
from gcxform.machine.file import load_machine
from gcxform.plot import canvas
from gcxform.plugin.registry import default_registry
from gcxform.simulate.heat import before_and_after, in_order

EXAMPLES = EXAMPLE.parents[1]
MODEL = ("--model", str(EXAMPLE))
BALLBAR = ("simulate", "ballbar", *MODEL, "--planes", "XY", "--radius", "100 mm")
LINES = ("simulate", "positioning", *MODEL, "--runs", "2", "--targets", "4")
DIAGONAL = ("simulate", "diagonal", *MODEL, "--runs", "1", "--diagonals")
PROGRAM = str(EXAMPLES / "lddm" / "linear_in.nc")
SHOW = ("show", "-f", "fanuc", *MODEL, "--part-origin", "0,0,0")


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


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
    found = call(*LINES, "--noise", "0.5 um", "--report", "out.json")
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
    quiet = json.loads(call(*LINES, "--report", "-").stdout)["readings"]["before"]["X"]
    assert quiet["target"] == reading["target"]
    truth = load_model(EXAMPLE).error(places)[:, 0]
    assert np.array(quiet["up"])[:, 0] == pytest.approx(truth, abs=1e-12)
    alone = call(*LINES, "--noise", "0.5 um", "--report", "-")
    assert json.loads(alone.stdout) == data
    assert json.loads(call(*LINES, "--runs", "1", "--report", "-").stdout)["figures"]["X"]["A"] == {
        "before": None,
        "after": None,
    }


def test_radii_are_among_the_data(here):
    data = json.loads(call(*BALLBAR, "--report", "-").stdout)
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


def test_programs_in_whole_millimetres(here):
    """X100 is not X1."""
    words = ("--axes", "X", "--at", "200,100,200", "--scatter", "0", "--decimals", "0")
    found = call(*LINES, *words, "--program", "before.nc")
    assert found.exit_code == 0, found.stderr
    assert "\nG1 X160. Y100. Z200.\n" in (here / "before.nc").read_text()
    assert figures(found.stdout)["X E"][0] != "0.000"


@pytest.mark.parametrize(
    ("words", "named", "written"),
    [
        (
            BALLBAR,
            ["XY before cw", "XY after ccw"],
            ["XY before, 2 um/div", "G(b) 3.65", "+X", "-Y", "CCW", "+2"],
        ),
        (
            LINES,
            ["X before mean up", "Z after low down", "Y after band up"],
            ["deviation, um", "X before", "mean up +- 2 s"],
        ),
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
        ((*BALLBAR, "--report", "a", "--plot", "a"), "GX728"),
        ((*BALLBAR, "--report", str(EXAMPLE)), "GX727"),
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


def test_a_long_title_stays_in_a_narrow_picture(here):
    assert call(*LINES, "--axes", "x", "--plot", "narrow.svg").exit_code == 0
    lines = drawn("narrow.svg")[1].splitlines()
    assert [line for line in lines if "proved" in line]
    assert max(map(len, lines)) < 60


# --- programs ---


def test_the_error_along_a_program_before_and_after(here):
    """V4: the figures of the pictures are those of `compare` and of the certificate."""
    assert call(*SHOW, "-o", "heat.svg", PROGRAM).exit_code == 0
    groups, text = drawn("heat.svg")
    assert {"before", "after"} <= set(groups)
    assert "before: at most 13.85 um" in text
    assert "after: at most 1.35 um" in text
    assert "distance from the programmed path, um" in text
    assert {"before start", "before end", "before worst", "after worst", "frame"} <= set(groups)
    assert {"X, mm", "13.85 um, line 12", "1.35 um, line 13"} <= set(text.splitlines())
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


def test_the_worst_place_is_named_by_the_line_of_the_file():
    """A loop goes three times: the worst is where the last of them ends, and not in line 8."""
    text = b"G21 G90 G17 G94 F500\nG1 X0 Y0 Z0\no1 repeat [3]\nG91 G1 X20\no1 endrepeat\nM2\n"
    model = functions(EZX=1e-4)
    steps = pipeline("linuxcnc", model=file_of(model), part_origin=(0.0, 0.0, 0.0))
    before, _, _ = before_and_after(gx.read(text, "linuxcnc"), steps)
    assert before.worst is not None
    assert before.worst_at == "line 4"
    assert before.line[before.worst] > 4
    assert before.end[before.worst][0] == pytest.approx(60.0, abs=0.01)


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
