"""`gcxform calibrate diagonal`: models, reports, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from diagonal_kit import LENGTHS, apart, linear, published, readings
from step_diagonal_kit import diagonals_csv, linear_csv

from gcxform.calibrate.diagonal.plain_diagonal import ANGLES, BLIND


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Go to a folder with the readings of the published machine and linear tests."""
    monkeypatch.chdir(tmp_path)
    Path("d.csv").write_text(diagonals_csv(readings().legs))
    for axis, name in enumerate("xyz"):
        Path(f"{name}.csv").write_text(linear_csv(linear(axis)))
    return tmp_path


@pytest.mark.parametrize("words", [["--misalignment", "none"], ["--linear", "x.csv", "--linear",
                                                                "y.csv"]])  # fmt: skip
def test_calibrate_writes_a_model_that_reads_back(files, words):
    done = call("calibrate", "diagonal", *words, "d.csv", "-o", "m.toml", "--report", "r.json")
    assert (done.exit_code, done.stdout) == (0, "")
    assert apart(published(Path("m.toml")), published()) <= 1e-11
    text = Path("m.toml").read_text()
    for said in ("end points", "Noise: 1 um a step", "EXX and", "Standard deviations"):
        assert said.replace("EXX and", "EYX, EZX and EZY end at zero") in text
    assert max(len(line) for line in text.split("\nformat")[0].splitlines()) <= 100
    report = json.loads(Path("r.json").read_text())
    assert report["observable"]["slopes"] == 6
    order, matrix = report["covariance"]["order"], np.array(report["covariance"]["matrix"])
    assert (len(order), matrix.shape) == (90, (90, 90))
    at = order.index("EYY[10]")
    assert report["functions"]["EYY"]["sd"][10] == pytest.approx(np.sqrt(matrix[at, at]))
    assert report["squareness"]["C0Y"]["value"] * 1e6 == pytest.approx(-25.264, abs=5e-4)
    assert report["squareness"]["B0Z"]["value"] * 1e6 == pytest.approx(34.424, abs=5e-4)
    assert report["squareness"]["A0Z"]["value"] * 1e6 == pytest.approx(-52.624, abs=5e-4)
    assert report["scales"]["X"]["value"] == pytest.approx(-0.014282 / 480)


def test_calibrate_writes_no_model_without_scales_but_what_is_known(files):
    refused = call("calibrate", "diagonal", "d.csv", "-o", "m.toml", "--report", "r.json")
    assert refused.exit_code == 3
    assert refused.stderr.startswith("d.csv: error[GX476]")
    assert not Path("m.toml").exists()
    assert not Path("r.json").exists()
    assert call("calibrate", "diagonal", "d.csv", "--report", "r.json").exit_code == 0
    report = json.loads(Path("r.json").read_text())
    assert report["observable"]["slopes"] == 4
    assert len(report["observable"]["hidden"]) == 2
    assert report["scales"] == {"X": None, "Y": None, "Z": None}
    assert [name for name, one in report["functions"].items() if one is None] == [
        "EXX", "EYY", "EZZ",
    ]  # fmt: skip
    assert len(report["covariance"]["order"]) == 60
    assert report["misalignments"] is None


def test_calibrate_writes_to_stdout_and_reads_stdin(files):
    words = ("calibrate", "diagonal", "--misalignment", "none")
    assert call(*words, "d.csv").stdout.count("\n[X]\n") == 1


def test_calibrate_plain_says_what_it_is_blind_to(files):
    done = call("calibrate", "diagonal", "--plain", "d.csv", "-o", "m.toml", "--report", "r.json")
    assert done.exit_code == 0
    text = Path("m.toml").read_text()
    assert "blind to scale errors with X^2 sX + Y^2 sY" in " ".join(text.split())
    assert "C0Y -25.26 +- " in text
    report = json.loads(Path("r.json").read_text())
    assert report["blind"] == f"{BLIND}; {ANGLES}"
    assert "four lengths cannot tell them" in " ".join(text.replace("#", " ").split())
    assert [round(v * 1e3, 3) for _, v in report["deviations"]] == LENGTHS


def test_calibrate_carries_temperatures_to_the_report(files):
    rows = Path("d.csv").read_text().splitlines()
    texts = [f"{rows[0]},temperature table [degC]"]
    texts += [f"{row},{20 + k / 100}" for k, row in enumerate(rows[1:])]
    Path("d.csv").write_text("\n".join(texts))
    call("calibrate", "diagonal", "d.csv", "--report", "r.json")
    found = json.loads(Path("r.json").read_text())["conditions"]["d.csv"]["temperature table"]
    assert (found["unit"], found["least"], found["most"]) == ("degC", 20.0, 21.23)
    assert [name for name, _ in found["legs"]] == ["ppp", "npp", "pnp", "ppn"]
    assert found["legs"][0][1] == pytest.approx(20.15)


@pytest.mark.parametrize(
    ("words", "code", "exit_code"),
    [
        (["--noise", "1"], None, 0),
        (["--noise", "fast"], "GX708", 2),
        (["--noise", "0 um"], "GX706", 2),
        (["--linear-noise", "-1 um"], "GX706", 2),
        (["--plain", "--linear", "x.csv"], "GX728", 2),
        (["-o", "d.csv"], "GX727", 2),
        (["--report", "x.csv", "--linear", "x.csv"], "GX727", 2),
        (["--linear", "none.csv"], "GX901", 5),
    ],
)
def test_calibrate_refuses_options(files, words, code, exit_code):
    done = call("calibrate", "diagonal", "--misalignment", "none", *words, "d.csv")
    assert done.exit_code == exit_code, done.stderr
    assert code is None or code in done.stderr


def test_calibrate_shows_the_place_of_a_fault(files):
    text = Path("d.csv").read_text().replace("ppp,1,+,48.0,33.0,0.0", "ppp,1,+,48.0,34.0,0.0")
    Path("d.csv").write_text(text)
    done = call("calibrate", "diagonal", "d.csv")
    assert done.exit_code == 3
    assert "d.csv:4:14: error[GX472]" in done.stderr
    assert "\n4 | ppp,1,+,48.0,34.0,0.0" in done.stderr
    assert "\n  |              ^^^^\n" in done.stderr


def test_calibrate_refuses_readings_in_the_place_of_deviations(files):
    text = Path("d.csv").read_text().replace("deviation [um]", "deviation [mm]")
    rows = [text.split("\n")[0]]
    for row in text.split("\n")[1:-1]:
        *head, x, y, z, value = row.split(",")
        rows.append(",".join((*head, x, y, z, str(float(value) * 10 + float(x) / 2))))
    Path("d.csv").write_text("\n".join(rows))
    done = call("calibrate", "diagonal", "--misalignment", "none", "--noise", "1 m", "d.csv")
    assert (done.exit_code, "GX415" in done.stderr) == (2, True), done.stderr
