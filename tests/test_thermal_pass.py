"""`volumetric` with thermal models: the proof, the state of a time, the example of a warm screw."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from console_kit import check_console
from thermal_kit import ALPHA, AT, COLD, LOG, NAMES, PITCH, WARM, along, text, written

import gcxform as gx
from gcxform.errormodel.model_file import load_model
from gcxform.plot.models import curves

EXAMPLE = Path(__file__).parents[1] / "examples" / "warm-screw"

GEOMETRY = """\
format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
[X]
position = [0.0, 130.0, 300.0, 520.0]
EXX = [0.0, -0.004, -0.002, -0.015]
EYX = [0.0, 0.003, -0.001, 0.0]
EZX = [0.0, 0.0, 0.002, 0.001]
"""
PROGRAM = b"G21 G90 G94 G17\nG0 X5. Y0. Z10.\nG1 Z0. F500.\nX515. Y40.\nX20. Y-30. Z-8.\n"
PROGRAM += b"G2 X80. Y-30. I30. J0.\nG1 X400.\nM30\n"


def pipeline(folder: Path, model: str, options: str, decimals: int = 6) -> gx.Pipeline:
    (folder / "p.toml").write_text(
        f'format = 1\n[input]\ndialect = "fanuc"\n[[pass]]\nuse = "volumetric"\nmodel = "{model}"\n'
        f"part-origin = [0.0, 0.0, 0.0]\n{options}\n"
        f"[output]\nstamp = false\ndecimals = {decimals}\n"
    )
    return gx.Pipeline.load(folder / "p.toml")


@pytest.mark.parametrize("mode", ["exact", "linear"])
@pytest.mark.parametrize("tolerance", [None, 0.0003, 0.001, 0.004])
def test_the_machine_stays_on_the_program(tmp_path, tolerance, mode):
    """Lines are walked in small steps, with the growth of the screw summed here."""
    general = f'node-interpolation = "{mode}"'
    written(tmp_path, text(general=general))
    (tmp_path / "geometry.toml").write_text(GEOMETRY)
    (tmp_path / "sum.toml").write_text(
        'format = 1\nkind = "sum"\nmodels = ["geometry.toml", "model.toml"]\n'
    )
    options = "" if tolerance is None else f"tolerance = {tolerance}"
    result = pipeline(tmp_path, "sum.toml", options).run(PROGRAM, verify="full")
    assert result.certificate.verified
    model = load_model(tmp_path / "sum.toml")
    worst = farthest(PROGRAM, result, screw_and_table(mode))
    if mode == "exact":  # the machine of this test is the model
        x = np.linspace(0, 520, 30)
        points = np.column_stack([x, 0 * x, 0 * x])
        assert model.error(points) == pytest.approx(screw_and_table(mode)(points), abs=1e-8)
    assert worst <= (tolerance or 1e-4) + 2e-6
    assert farthest(PROGRAM, None, screw_and_table(mode)) > 0.1


def screw_and_table(mode: str):
    """Return the error (n, 3) at positions (n, 3): a fine table of sums, and np.interp."""
    fine = np.linspace(0, 1221, 122_101)
    theta = np.interp((fine[1:] + fine[:-1]) / 2, AT, WARM - COLD)
    grown = ALPHA * np.append(0.0, np.cumsum(theta * np.diff(fine)))
    if mode == "linear":
        grown = np.interp(fine, AT, np.interp(AT, fine, grown)) + 0.0
    home = ALPHA * np.append(0.0, np.cumsum(theta * np.diff(fine)))[20_000]
    nodes = [0.0, 130.0, 300.0, 520.0]
    columns = [[0, -0.004, -0.002, -0.015], [0, 0.003, -0.001, 0.0], [0, 0, 0.002, 0.001]]

    def error(points):
        found = np.column_stack([np.interp(points[:, 0], nodes, c) for c in columns])
        found[:, 0] += np.interp(200.0 + points[:, 0], fine, grown) - home
        return found

    return error


def farthest(program: bytes, result, error) -> float:
    """Return how far (mm) the machine is from the lines of a program, anywhere on them."""
    wanted = gx.read(program, "fanuc").path
    told = wanted if result is None else gx.read(result.text, "fanuc").path
    owner = told.source if result is None else np.array(result.source_map)[told.source]
    worst = 0.0
    for k in range(len(told)):
        of = int(np.flatnonzero(wanted.source == owner[k])[-1])
        if told.kind[k] != gx.Kind.LINE or wanted.kind[of] != gx.Kind.LINE:
            continue
        part = np.linspace(0, 1, 60)[:, None]
        points = told.start[k, :3] + part * (told.end[k, :3] - told.start[k, :3])
        points = points + error(points)
        start, way = wanted.start[of, :3], wanted.end[of, :3] - wanted.start[of, :3]
        share = np.clip((points - start) @ way / (way @ way), 0, 1)[:, None]
        worst = max(worst, float(np.linalg.norm(points - start - share * way, axis=1).max()))
        ends_here = k + 1 == len(told) or owner[k + 1] != owner[k]
        if ends_here:
            worst = max(worst, float(np.linalg.norm(points[-1] - wanted.end[of, :3])))
    return worst


def test_larger_tolerances_need_fewer_blocks(tmp_path):
    written(tmp_path, text())
    counts = [
        len(pipeline(tmp_path, "model.toml", f"tolerance = {t}").run(PROGRAM).text.splitlines())
        for t in (0.0002, 0.001, 0.005)
    ]
    assert counts[0] > counts[1] > counts[2]


def test_the_pass_takes_the_state_of_its_time(tmp_path):
    written(tmp_path, text(), LOG)
    early, late = (
        pipeline(tmp_path, "model.toml", f'time = "2026-03-04T{hour}"', 3)
        for hour in ("09:05:00", "10:00:00")
    )
    default = pipeline(tmp_path, "model.toml", "", 3)
    assert late.run(PROGRAM).text == default.run(PROGRAM).text != early.run(PROGRAM).text
    entry = early.run(PROGRAM).certificate.steps[0]
    state = entry["model"]["states"][0]
    assert (state["time"], entry["time"]) == ("2026-03-04T09:00:00", "2026-03-04T09:05:00")
    assert state["sensors"] == tuple(NAMES)
    assert entry["model"]["sha256"] != default.run(PROGRAM).certificate.steps[0]["model"]["sha256"]
    json.loads(early.run(PROGRAM).certificate.to_json())


@pytest.mark.parametrize(
    ("time", "code"), [("2026-03-04T07:00:00", "GX426"), ("noon", "GX702"), ("08:00", "GX702")]
)
def test_times_without_a_state(tmp_path, time, code):
    written(tmp_path, text(), LOG)
    with pytest.raises(gx.UsageError, match=code):
        pipeline(tmp_path, "model.toml", f'time = "{time}"')


def test_a_model_without_temperatures_has_no_time(tmp_path):
    (tmp_path / "geometry.toml").write_text(GEOMETRY)
    with pytest.raises(gx.UsageError, match="GX426"):
        pipeline(tmp_path, "geometry.toml", 'time = "2026-03-04T10:00:00"')


@pytest.mark.parametrize(("hour", "same"), [("09:00:00", True), ("10:00:00", False)])
def test_compare_takes_the_state_of_its_time(tmp_path, monkeypatch, hour, same):
    monkeypatch.chdir(tmp_path)
    written(tmp_path, text(), LOG)
    Path("part.nc").write_bytes(PROGRAM)
    early = pipeline(tmp_path, "model.toml", 'time = "2026-03-04T09:00:00"', 4)
    Path("early.nc").write_bytes(early.run(PROGRAM).text)
    model = ["--model", "model.toml", "--part-origin", "0,0,0", "--time", f"2026-03-04T{hour}"]
    words = ["compare", "-f", "fanuc", "--tolerance", "5um", *model, "part.nc", "early.nc"]
    assert call(*words).exit_code == int(not same)


def test_the_picture_of_a_warm_screw_is_curved(tmp_path):
    model = load_model(written(tmp_path, text()))
    ((name, (position, value)),) = curves(model).items()
    assert name == "EXX"
    assert 1000 * value == pytest.approx(along(model, position), abs=1e-9)
    assert np.unique(np.round(np.diff(value), 9)).size > 20


# --- the example ----------------------------------------------------------------------------


def test_the_example_prints_what_its_readme_says(tmp_path):
    """Also: a warm screw, off by almost 200 um, is compensated to less than a tenth."""
    page = EXAMPLE / "README.md"
    shutil.copytree(EXAMPLE, tmp_path / "examples" / EXAMPLE.name)
    assert check_console(page, tmp_path) == 2
    text = page.read_text("utf-8")
    before, after = (float(word) for word in text.split("X    M ")[1].splitlines()[0].split())
    assert before > 180
    assert after < before / 10


def smooth(place, warmer):
    """Return a temperature with continuous slope through that of the sensors (Catmull, Rom)."""
    slope = np.gradient(warmer)
    cell = np.clip(np.searchsorted(AT, place, side="right") - 1, 0, len(AT) - 2)
    t = (place - AT[cell]) / PITCH
    h = [2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, 3 * t**2 - 2 * t**3, t**3 - t**2]
    ends = [warmer[cell], slope[cell], warmer[cell + 1], slope[cell + 1]]
    return sum(a * b for a, b in zip(h, ends, strict=True))


def test_a_screw_that_the_sensors_do_not_know_to_the_last(tmp_path):
    """Smooth temperature between sensors, 1 % more expansion, 0.1 K of noise: still a tenth."""
    for file in EXAMPLE.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    log = (tmp_path / "readings.csv").read_text().splitlines()
    true = np.array([float(cell) for cell in log[-1].split(",")[1:]])
    cold = np.array([float(cell) for cell in log[2].split(",")[1:]])
    read = true + np.random.default_rng(1).normal(0, 0.1, 12)
    log[-1] = ",".join([log[-1].split(",")[0], *(f"{t:.2f}" for t in read)])
    (tmp_path / "readings.csv").write_text("\n".join(log) + "\n")
    fine = np.linspace(0.0, AT[-1], 40_001)
    grown = 1.01 * ALPHA * np.cumsum(smooth(fine, true - cold)) * (fine[1] - fine[0])
    stops = b"".join(b"X%d.\n" % x for x in range(0, 661, 60))
    program = b"G21 G90 G94\nG0 X0. Y0. Z0.\nG1 F500.\n" + stops + b"M30\n"
    result = gx.Pipeline.load(tmp_path / "warm.toml").run(program)
    geometry = load_model(tmp_path / "geometry.toml")

    def deviation(text: bytes) -> float:
        x = gx.read(text, "fanuc").path.end[:, 0]
        there = x + np.interp(100.0 + x, fine, grown) - np.interp(100.0, fine, grown)
        there += geometry.error(np.column_stack([x, 0 * x, 0 * x]))[:, 0]
        nominal = np.arange(0, 661, 60)
        return float(np.abs(there[np.abs(there[:, None] - nominal).argmin(axis=0)] - nominal).max())

    assert deviation(program) > 0.18
    assert 0.001 < deviation(result.text) < deviation(program) / 10
