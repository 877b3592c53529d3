"""Pictures of what calibrations leave: the curves are the residuals, polar, in um."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from ball_kit import around, clean, skew
from ballbar_kit import identified, measured
from cli_kit import call

from gcxform import plot
from gcxform.calibrate.ballbar.ballbar import identify
from gcxform.calibrate.ballbar.file import circles_csv
from gcxform.calibrate.bundle.bundle import Poses, bundle
from gcxform.calibrate.rotary.axis import Centres, locate
from gcxform.calibrate.rotary.ball_file import balls_csv, poses_csv
from gcxform.calibrate.rotary.check import components
from gcxform.machine.chain import Chain
from gcxform.plot import canvas

pytest.importorskip("matplotlib")


def curves(figure):
    """Return the data (angles, values) of all named curves, and the titles of the diagrams."""
    lines = [line for axes in figure.axes for line in axes.lines if line.get_gid()]
    return {line.get_gid(): np.array(line.get_data()) for line in lines}, [
        axes.get_title() for axes in figure.axes
    ]


def spoilt():
    """Return an axis from centres of which the third does not belong to the rest."""
    centres = clean(skew(), around(9), noise=0.002)
    centres.points[2] += (0.0, 0.03, 0.0)
    return locate(centres, 0.002)


def test_residuals_of_an_axis():
    found = spoilt()
    drawn, titles = curves(plot.placed(found, "A", "a title"))
    parts = 1e3 * components(found)
    for k, name in enumerate(("radial", "tangential", "axial")):
        angles, values = drawn[f"A {name}"]
        assert angles == pytest.approx(np.radians(np.delete(around(9), 2)))
        assert values == pytest.approx(np.delete(parts[:, k], 2))
        (angle,), (value,) = drawn[f"A {name} left out"]
        assert angle == pytest.approx(np.radians(80.0))
        assert np.sign(value) == np.sign(parts[2, k])
    assert titles[0].startswith("residuals over A, ")


@pytest.mark.parametrize(("most", "division"), [(0.3, 0.2), (7.0, 5.0), (10.1, 10.0), (40.0, 20.0)])
def test_the_ring_is_as_wide_as_the_residuals(most, division):
    """A division is one of 1, 2, 5 times a power of ten, and two of them hold the largest."""
    axes = canvas.figure(3.0, 3.0, "").add_subplot(projection="polar")
    assert canvas.magnified(axes, most) == pytest.approx(division)
    low, high = axes.get_ylim()
    assert (high - low) / 7.0 == pytest.approx(division)


def test_the_title_says_what_a_division_is():
    found = spoilt()
    axes = plot.placed(found, "A", "").axes[0]
    low, high = axes.get_ylim()
    assert f"{(high - low) / 7.0:g} um/div" in axes.get_title()
    assert np.abs(1e3 * components(found)[found.kept]).max() <= high


def poses():
    chain = Chain((skew(-1), skew(-1, "C")))
    rng = np.random.default_rng(3)
    degrees = rng.uniform(-90.0, 90.0, (24, 2))
    chain = Chain((skew(-1), type(skew())("C", (0.0, 0.0, 1.0), (5.0, -20.0, -60.0), -1)))
    places = chain.linear(np.tile((90.0, 40.0, 20.0), (24, 1)), degrees)
    noisy = places + 0.002 * rng.standard_normal(places.shape)
    return chain, Poses(degrees, ("1",) * 24, noisy)


def test_residuals_of_a_bundle():
    chain, data = poses()
    found = bundle(chain, data, 0.002, "none")
    drawn, titles = curves(plot.bundled(found, ""))
    for k, letter in enumerate("AC"):
        for j, axis in enumerate("XYZ"):
            angles, values = drawn[f"{letter} {axis}"]
            assert angles == pytest.approx(np.radians(data.degrees[found.kept, k]))
            assert values == pytest.approx(1e3 * found.residuals[found.kept, j])
    assert len(titles) == 2


def test_traces_about_their_circles():
    traces = measured(samples=37, noise=0.001, rng=np.random.default_rng(2))
    found = identified(traces)
    drawn, titles = curves(plot.circled(found, ""))
    for k, (trace, test) in enumerate(zip(traces, found.tests, strict=True), 1):
        letter, bar = ("A", "ZX"[k - 1]) if k < 3 else ("C", "XZ"[k - 3])
        name = f"test {k}: {letter}, bar {bar}"
        angles, values = drawn[f"{name} reading"]
        assert angles == pytest.approx(np.radians(trace.degrees))
        turns, fit = drawn[f"{name} fit"]
        assert np.interp(0.0, turns, fit) == pytest.approx(1e3 * test.value[0])
        assert np.interp(np.pi / 2, turns, fit) == pytest.approx(1e3 * test.value[1])
        cosine, sine = test.value
        left = values - 1e3 * (cosine * np.cos(angles) + sine * np.sin(angles))
        assert drawn[f"{letter} {name} residual"][1] == pytest.approx(left, abs=1e-9)
    assert len(titles) == 8
    given = [type(test)(test.setup, test.value, test.covariance) for test in found.tests]
    bare = identify(found.believed, given, found.spindle, 0.001)
    assert len(curves(plot.circled(bare, ""))[1]) == 4


MACHINE = """format = 1
table = ["A", "C"]
[axis.A]
direction = [1.0, 0.0, 0.0]
point = [5.0, -32.0, -95.0]
sign = -1
[axis.C]
direction = [0.0, 0.0, 1.0]
point = [5.0, -20.0, -60.0]
sign = -1
"""


@pytest.mark.parametrize("kind", ["svg", "png"])
def test_the_commands_draw(tmp_path, monkeypatch, kind):
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MACHINE)
    turn = around(8)
    Path("a.csv").write_text(balls_csv(Centres(turn, clean(skew(-1), turn, 0.002).points)))
    Path("b.csv").write_text(poses_csv(poses()[1], "AC"))
    Path("c.csv").write_text(circles_csv(measured(samples=19)))
    every = {
        "rotary": ("--axis", "A", "a.csv"),
        "bundle": ("-m", "m.toml", "--linear", "none", "--noise", "50 um", "b.csv"),
        "ballbar": ("-m", "m.toml", "--spindle-ball", "12um,-9um", "c.csv"),
    }
    for verb, words in every.items():
        done = call("calibrate", verb, "--plot", f"{verb}.{kind}", *words)
        assert done.exit_code == 0, done.output
        start = b"\x89PNG" if kind == "png" else b"<?xml"
        assert Path(f"{verb}.{kind}").read_bytes().startswith(start)
        done = call("calibrate", verb, "--plot", "x.gif", *words)
        assert (done.exit_code, "GX737" in done.stderr) == (2, True)
