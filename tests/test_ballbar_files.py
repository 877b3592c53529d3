"""`gcxform calibrate ballbar`: tables, machine files, reports, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from ballbar_kit import ERRORS, measured
from cli_kit import call

from gcxform.calibrate.ballbar.file import circles_csv, parse_circles
from gcxform.diagnostics import InputError
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine

MACHINE = """# a mill
format = 1
table = ["A", "C"]

[axis.A]
direction = [1.0, 0.0, 0.0]    # as set
point = [5.0, -32.0, -95.0]
sign = -1
limits = [-95.0, 95.0]

[axis.C]
direction = [0.0, 0.0, 1.0]
point = [5.0, -20.0, -60.0]
sign = -1
wrap = 360.0
"""
OFF = ("--spindle-ball", "12 um,-9 um")


@pytest.fixture
def files(tmp_path, monkeypatch):
    """Go to a folder with a machine file and four traces with 1 um of noise."""
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MACHINE)
    traces = measured(samples=37, noise=0.001, rng=np.random.default_rng(2))
    Path("t.csv").write_text(circles_csv(traces))
    return tmp_path


def table():
    return circles_csv(measured(samples=7))


def test_a_table_reads_back_as_the_same_bits():
    found = parse_circles(table(), 0.01)
    assert circles_csv([test.trace for test in found.tests]) == table()


def test_units_and_repeated_tests():
    lines = table().splitlines()
    head = "test;axis;bar;X [mm];Y [mm];Z [mm];angle [rad];reading [um];temperature air [degC]"
    rows = []
    for name in ("out", "back"):
        for line in lines[1:]:
            *setup, angle, reading = line.split(",")
            cells = [
                name,
                *setup,
                repr(float(np.radians(float(angle)))),
                repr(1e3 * float(reading)),
            ]
            rows.append(";".join([*cells, "20.5"]))
    twice = parse_circles("\n".join([head, *rows]), 0.01)
    once = parse_circles(table(), 0.01)
    assert len(twice.tests) == 8
    for k, test in enumerate(twice.tests):
        assert test.value == pytest.approx(once.tests[k % 4].value, abs=1e-12)
        assert test.where.line == 2 + 7 * k
    assert twice.conditions["temperature air"]["mean"] == 20.5


def test_the_command_writes_the_axes(files):
    words = ("-m", "m.toml", *OFF, "-o", "n.toml", "--report", "r.json")
    done = call("calibrate", "ballbar", *words, "t.csv")
    assert done.exit_code == 0, done.output
    assert (
        "# calibrated: by 4 circular tests of t.csv, RTCP on; noise 1 um"
        in Path("n.toml").read_text()
    )
    machine = load_machine(Path("n.toml"))
    assert machine.axes["C"].wrap == 360.0
    report = json.loads(Path("r.json").read_text())
    for axis in chain_of(machine).axes:
        one = report["axes"][axis.letter]
        assert list(axis.direction) == pytest.approx(one["direction"]["value"], abs=1e-15)
        assert list(axis.point) == pytest.approx(one["point"]["value"], abs=1e-12)
    for name, one in report["trunnion"]["errors"].items():
        assert one["value"] == pytest.approx(ERRORS["A"][name], abs=4.5 * one["sd"])
        scale, unit = (1e3, "um") if name[0] == "d" else (1e6, "urad")
        assert f"{name}: {scale * one['value']:+.2f} +- " in done.stdout
        assert f" {unit}" in done.stdout
    assert report["check"]["A"]["before"][0] > 0.02
    worst = max(report["check"]["A"]["spread"])
    assert f"0 +- {1e3 * worst:.3g} um; with the axis as it was " in done.stdout
    assert max(map(len, Path("n.toml").read_text().splitlines())) <= 100
    assert report["warnings"] == []


def test_eccentricities_in_place_of_traces(files):
    words = ("-m", "m.toml", *OFF, "--report")
    assert call("calibrate", "ballbar", *words, "one.json", "t.csv").exit_code == 0
    one = json.loads(Path("one.json").read_text())
    lines = ["axis, bar, X [mm], Y [mm], Z [mm], cosine [um], sine [um]"]
    for test in one["tests"]:
        cosine, sine = (repr(1e3 * v) for v in test["cosine-sine"]["value"])
        lines.append(",".join([test["axis"], test["bar"], *map(repr, test["ball"]), cosine, sine]))
    Path("e.csv").write_text("\n".join(lines))
    done = call("calibrate", "ballbar", *words, "two.json", "e.csv")
    assert done.exit_code == 0, done.output
    two = json.loads(Path("two.json").read_text())
    for name, value in one["trunnion"]["errors"].items():
        same = two["trunnion"]["errors"][name]["value"]
        assert same == pytest.approx(value["value"], abs=6e-5 if name[0] == "d" else 4e-7)
    assert two["warnings"][0].startswith("no redundancy: as many eccentricities as unknowns")
    assert two["check"]["C"]["degrees"][:3] == [0.0, 10.0, 20.0]


def test_without_the_spindle_ball_there_is_a_warning(files):
    done = call("calibrate", "ballbar", "-m", "m.toml", "t.csv")
    assert "warning: the spindle ball is taken to be on the spindle" in done.stdout
    assert (
        "warning: the spindle ball"
        not in call("calibrate", "ballbar", "-m", "m.toml", *OFF, "t.csv").stdout
    )


def test_the_length_of_the_bar_is_of_second_order(files):
    short, long = (
        call("calibrate", "ballbar", "-m", "m.toml", *OFF, "--bar", bar, "t.csv").stdout
        for bar in ("50 mm", "100 mm")
    )
    assert short != long


@pytest.mark.parametrize(
    ("old", "new", "code", "place", "said"),
    [
        ("axis,", "axle,", "GX470", "1:1", "the column 'axle' means nothing"),
        ("reading [mm]", "reading", "GX470", "1:43", "'reading' has no unit"),
        ("\nA,Z,", "\nQ,Z,", "GX471", "2:1", "'Q' is not one of A, B, C"),
        ("\nA,Z,", "\nA,W,", "GX471", "2:3", "'W' is not one of X, Y, Z"),
    ],
)
def test_a_wrong_table_is_refused_with_its_place(old, new, code, place, said):
    with pytest.raises(InputError) as caught:
        parse_circles(table().replace(old, new, 1), 0.01)
    found = caught.value.diagnostics[0]
    assert (found.code, f"{found.where.line}:{found.where.column}") == (code, place)
    assert said in found.message


@pytest.mark.parametrize(
    ("words", "code", "exit_code"),
    [
        (["-m", "headed.toml"], "GX490", 3),
        (["-m", "m.toml", "--noise", "0.1 um"], "GX475", 3),
        (["-m", "m.toml", "--spindle-ball", "12 um"], "GX702", 2),
        (["-m", "m.toml", "--spindle-ball", "1,x"], "GX708", 2),
        (["-m", "m.toml", "--bar", "0"], "GX706", 2),
        (["-m", "m.toml", "-o", "t.csv"], "GX727", 2),
        (["-m", "none.toml"], "GX452", 2),
    ],
)
def test_what_does_not_fit_is_refused(files, words, code, exit_code):
    Path("headed.toml").write_text(MACHINE.replace('["A", "C"]', '["C"]\nhead = ["A"]'))
    Path("none.toml").write_text("format = 1\n")
    done = call("calibrate", "ballbar", *words, "t.csv")
    assert (done.exit_code, code in done.stderr) == (exit_code, True), done.output
