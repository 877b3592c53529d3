"""`gcxform table`: formats and their options on the command line, what is proved, what is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cli_kit import call, workplace
from format_kit import apart, nine, pitch, rigid
from gcxform_plugins.formats.isg_csv import IsgCsv
from gcxform_plugins.formats.xyz import Xyz

from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.model import ErrorModel
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import to_toml
from gcxform.plugin.registry import default_registry

LDDM = Path(__file__).parents[1] / "examples" / "lddm"
COMP = "0 0 0\n100 100.005 99.997\n"


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    return workplace(tmp_path, monkeypatch)


def model(path) -> ErrorModel:
    return load_model(Path(path), tuple(default_registry().formats.values()))


def test_from_linuxcnc_to_toml_and_siemens(folder):
    (folder / "x.comp").write_text(COMP)
    words = ["--from", "linuxcnc-comp type=0 units=mm", "--axis", "X"]
    done = call("table", "convert", "x.comp", "x.toml", *words)
    assert done.exit_code == 0, done.output
    assert "the control may compensate with the linuxcnc-comp table already" in done.stderr
    assert done.stdout == ""
    assert model("x.toml").backlash.tolist() == [True, False, False]
    words = ["--to", "siemens-cec units=mm axes=AX1,AX2,AX3 positive=minus"]
    done = call("table", "convert", "x.toml", "-", *words)
    assert done.exit_code == 0, done.output
    assert "$AN_CEC[0,1]=0.005\n" in done.stdout
    assert "$AN_CEC[1,1]=-0.003\n" in done.stdout
    assert "beats rewriting programs: Siemens" in done.stderr


def test_lddm_there_and_back():
    assert call("table", "convert", str(LDDM), "nine.toml").exit_code == 0
    assert call("table", "convert", "nine.toml", "out", "--to", "lddm").exit_code == 0
    assert sorted(p.name for p in Path("out").iterdir()) == [f"table_{a}.txt" for a in "xyz"]
    assert to_toml(model("out")) == to_toml(model(LDDM))


def test_the_format_is_that_of_the_name(folder):
    height = Lattice((np.arange(3.0), np.arange(2.0), np.zeros(1)), np.zeros((3, 2, 1, 3)))
    (folder / "map.toml").write_text(to_toml(height))
    done = call("table", "convert", "map.toml", "map.xyz", "--to", "xyz units=mm")
    assert done.exit_code == 0, done.output
    assert call("table", "convert", "map.xyz", "b.toml", "--from", "xyz units=mm").exit_code == 0
    done = call("table", "convert", "map.toml", "b.xyz")
    assert (done.exit_code, "needs 'units'" in done.stderr) == (2, True)
    done = call("table", "convert", "map.toml", "b.ini")
    assert "which format is b.ini to be in?" in done.stderr
    assert "known: siemens-cec, siemens-eec" in done.stderr
    assert not Path("b.ini").exists()


def test_a_fit_says_what_it_leaves(folder):
    given = rigid(3)
    (folder / "rigid.toml").write_text(to_toml(given))
    done = call("table", "convert", "rigid.toml", "grid.toml", "--kind", "lattice")
    assert done.exit_code == 0, done.output
    assert "lattice: leaves" in done.stderr
    done = call("table", "convert", "grid.toml", "again.toml", "--kind", "functions")
    assert done.exit_code == 0, done.output
    assert apart(model("again.toml"), given) < 1e-11
    done = call("table", "convert", "rigid.toml", "out", "--to", "lddm", "--kind", "nine-functions")
    left = float(done.stderr.split("rms, ")[1].split()[0])
    assert apart(model("out"), given) * 1e3 == pytest.approx(left, rel=2e-3)
    assert left > 0.1


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["none.comp", "b.toml", "--from", "linuxcnc-comp type=0 units=mm"], "GX401"),
        (["none.comp", "b.toml"], "GX401"),
        (["part.nc", "b.toml"], "GX416"),
        (["model.toml", "b.toml", "--from", "lidar"], "GX730"),
        (["model.toml", "b.toml", "--to", "xyz 'units"], "GX712"),
        (["model.toml", "b.toml", "--to", "xyz units"], "GX712"),
        (["model.toml", "b.toml", "--to", "xyz units=cm"], "GX707"),
        (["model.toml", "b.toml", "--to", "lddm units=mm"], "GX701"),
        (["model.toml", "model.toml"], "GX727"),
        (["model.toml", "b.toml", "--order", "XXZ"], "GX421"),
        (["model.toml", "b.csv", "--to", "iso230-csv"], "GX481"),
        (["model.toml", "b.probe", "--to", "bcnc-probe units=mm"], "GX481"),
        (["model.toml", "b.xyz", "--to", "siemens-eec units=mm axes=X1"], "GX713"),
    ],
)
def test_what_is_refused(words, code):
    done = call("table", "convert", *words)
    assert code in done.stderr, done.output
    assert done.exit_code in (2, 3)
    assert not Path("b.toml").exists()


def test_a_sum_has_no_text_of_its_own(folder):
    (folder / "sum.toml").write_text('format = 1\nkind = "sum"\nmodels = ["a.toml", "b.toml"]\n')
    for name in "ab":
        (folder / f"{name}.toml").write_text(to_toml(nine(5)))
    assert "GX481" in call("table", "convert", "sum.toml", "c.toml").stderr
    assert call("table", "convert", "sum.toml", "c.toml", "--kind", "functions").exit_code == 0
    assert apart(model("c.toml"), model("sum.toml")) < 1e-12


def test_a_file_that_fits_two_formats(folder):
    mesh = "[bed_mesh a]\nversion = 1\n[skew_correction a]\nxy_skew = 0\nxz_skew = 0\nyz_skew = 0\n"
    (folder / "printer.cfg").write_text(mesh)
    done = call("table", "show", "printer.cfg")
    assert "GX416" in done.stderr
    assert "klipper-mesh and klipper-skew" in done.stderr
    assert call("table", "show", "printer.cfg", "--from", "klipper-skew").exit_code == 0


def test_what_does_not_read_back_is_not_written(folder, monkeypatch):
    height = Lattice((np.arange(3.0), np.arange(2.0), np.zeros(1)), np.zeros((3, 2, 1, 3)))
    (folder / "map.toml").write_text(to_toml(height))
    wrong = {"": "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0.001\n"}
    monkeypatch.setattr(Xyz, "write", lambda self, model: wrong)
    done = call("table", "convert", "map.toml", "map.xyz", "--to", "xyz units=mm")
    assert (done.exit_code, "GX605" in done.stderr) == (4, True)
    assert "differ by 1 um" in done.stderr
    assert not Path("map.xyz").exists()


def test_angular_errors_that_act_on_another_tool_alone_are_proved_too(folder, monkeypatch):
    """Those of the axis next to the tool: the measured point has no lever on it."""
    (folder / "rigid.toml").write_text(to_toml(rigid(3)))
    to = "isg-csv values=error order=XYZ tool=10,0,-120"
    words = ("table", "convert", "rigid.toml", "r.csv", "--to", to)
    done = call(*words)
    assert done.exit_code == 0, done.stderr
    right = IsgCsv.write
    swapped = lambda form, model: {"": right(form, model)[""].replace("EAZ EBZ", "EBZ EAZ")}  # noqa: E731
    monkeypatch.setattr(IsgCsv, "write", swapped)
    Path("r.csv").unlink()
    done = call(*words)
    assert (done.exit_code, "GX605" in done.stderr) == (4, True)
    assert not Path("r.csv").exists()


def test_the_mean_of_both_directions(folder):
    """EEC has one value for both: 20 and 10 um are 15 um."""
    (folder / "back.toml").write_text(
        'format = 1\nkind = "pitch"\nvalues = "error"\n[X]\nposition = [0, 100]\n'
        "forward = [0, 0.02]\nreverse = [0, 0.01]\n"
    )
    words = ("table", "convert", "back.toml", "mean.ini", "--to", "siemens-eec units=mm")
    assert "--backlash mean" in call(*words).stderr
    done = call(*words, "--backlash", "mean")
    assert done.exit_code == 0, done.stderr
    assert "$AA_ENC_COMP[0,1,X1]=0.015\n" in Path("mean.ini").read_text()
    done = call("table", "convert", "back.toml", "f.toml", "--kind", "functions")
    assert (done.exit_code, "--backlash mean" in done.stderr) == (2, True)
    words = ("table", "convert", "back.toml", "f.toml", "--kind", "functions", "--backlash", "mean")
    assert call(*words).exit_code == 0
    assert "EXX = [0.0, 0.015]" in Path("f.toml").read_text()


def test_show(folder):
    (folder / "pitch.toml").write_text(to_toml(pitch(2, "Y")))
    done = call("table", "show", "pitch.toml")
    count = len(pitch(2, "Y").nodes[1])
    assert done.stdout.startswith(f"kind      pitch\nY         {count} positions, ")
    assert ", with backlash\nlargest   " in done.stdout
    (folder / "rigid.toml").write_text(to_toml(rigid(2)))
    assert "tool      10, 0, -120 mm\n" in call("table", "show", "rigid.toml").stdout


def test_formats_are_listed_with_their_options():
    lines = call("list", "formats").stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(default_registry().formats)
    text = call("list", "formats", "linuxcnc-comp").stdout
    assert "COMP_FILE_TYPE of the INI file; mandatory" in text
    assert "in the control: LinuxCNC, [JOINT_n] COMP_FILE" in text
