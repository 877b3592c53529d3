"""`rtcp` and `volumetric` in one chain: linear axes with errors, and rotary ones elsewhere."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from kinematics_kit import matrices
from rtcp_kit import (
    GAUGE,
    LENGTH,
    ROUNDED,
    ZERO,
    chain_of_kind,
    machine_text,
    pipeline,
    positions,
    tips,
)
from test_rtcp_repost import FINE, leaning_poses, measured, measured_text, posted

import gcxform as gx

EXAMPLES = Path(__file__).parents[1] / "examples"
LDDM = EXAMPLES / "lddm" / "model.toml"
RIGID = EXAMPLES / "rigid-body" / "model.toml"
ORIGINS = {LDDM: np.array([-250.0, -180.0, -300.0]), RIGID: np.array([0.0, 0.0, 300.0])}
"""Of the measurements, in machine coordinates."""
TOLERANCE = 0.002


def volumetric(model):
    """Return the text of the step."""
    return (
        f'[[pass]]\nuse = "volumetric"\nmodel = "{model}"\ntolerance = {TOLERANCE}\n'
        f'table-origin = {ORIGINS[model].tolist()}\noutside = "extrapolate"\n'
    )


def levers(chain, angles):
    """Return the ways (n, 3) from the gauge point to the tip, by the matrices of scipy."""
    head = np.tile(np.eye(4), (len(angles), 1, 1))
    for k, axis in enumerate(chain.head, len(chain.table)):
        head = head @ matrices(axis, angles[:, k])
    return (head @ np.array([*chain.tip, 1.0]))[:, :3] - GAUGE


def actual(model, words, origin, chain):
    """Return where axes stand (n, 5), as words, when they are commanded to words."""
    found = words.copy()
    tool = np.array([0.0, 0.0, LENGTH])
    machine = words[:, :3] + tool + ZERO
    found[:, :3] += model.error(
        machine - origin, gx.Outside.EXTRAPOLATE, levers(chain, words[:, 3:])
    )
    return found


def chained(folder, kind, nominal, real, model, **options):
    """Return the pipeline of both passes."""
    (folder / "real.toml").write_text(measured_text(kind, real))
    given = {"tolerance": TOLERANCE, "after": volumetric(model)} | options
    given |= {"decimals": FINE} if options.get("use") == "repost" else {}
    machine = measured_text(kind, real) if "use" not in options else None
    return pipeline(folder, machine or machine_text(kind, nominal), **given)


@pytest.mark.parametrize("use", ["to-tip", "retarget"])
def test_positions_that_are_not_those_of_the_machine_are_refused(tmp_path, use):
    """After `to-tip` they are tips, and after `retarget` of axes that the machine file has not."""
    nominal = chain_of_kind("cb-fork", 12)
    (tmp_path / "target.toml").write_text(machine_text("cb-fork", nominal))
    options = {"use": use, "tolerance": TOLERANCE}
    if use == "retarget":
        options |= {"target": "target.toml", "rapids": "ends", "before": ""}
    text = machine_text("cb-fork", nominal)
    assert pipeline(tmp_path, text, **options)
    with pytest.raises(gx.UsageError, match="volumetric, requires AXIS_POSITIONS"):
        pipeline(tmp_path, text, after=volumetric(RIGID), **options)


def beside(points, line):
    """Return the distances (n,) of points from a line through others (m, 3)."""
    start, way = line[:-1], np.diff(line, axis=0)
    gap = points[:, None, :] - start
    part = np.clip((gap * way).sum(axis=2) / (way**2).sum(axis=1), 0.0, 1.0)
    return np.linalg.norm(gap - part[:, :, None] * way, axis=2).min(axis=1)


def short_walk(chain, seed):
    """Return poses (n, 5) of a path in the middle of the machine."""
    poses = leaning_poses(chain, np.random.default_rng(seed), 5, around=50.0)
    poses[:, :3] *= 0.4
    poses[1:] = poses[:1] + 0.3 * (poses[1:] - poses[:1])
    return poses.round(3)


@pytest.mark.parametrize("kind", ["cb-fork", "c-table-b-head", "ac-trunnion"])
@pytest.mark.parametrize("model", [LDDM, RIGID])
@pytest.mark.parametrize("use", ["repost", "rtcp"])
def test_errors_of_linear_and_rotary_axes_in_one_budget(tmp_path, kind, model, use):
    """The true machine, at 33 places of each block: within both promises and the rounding."""
    nominal = chain_of_kind(kind, 12)
    real = measured(nominal, 13)
    letters = ("X", "Y", "Z", *nominal.letters)
    text = posted(short_walk(nominal, 3), letters)
    options = {"use": use, "calibrated": "real.toml"} if use == "repost" else {}
    steps = chained(tmp_path, kind, nominal, real, model, **options)
    result = steps.run(text, "full")
    errors = gx.ModelFile.load(model).model
    old, new = positions(text, letters), positions(result.text, letters)
    owner = np.array(result.source_map)
    worst, without = 0.0, 0.0
    for line in range(4, len(old) - 1):
        rows = np.flatnonzero(owner == line)
        along = np.linspace(0.0, 1.0, 401)[:, None]
        posed = old[line - 1] + along * (old[line] - old[line - 1])
        wanted = tips(nominal, posed) if use == "repost" else posed[:, :3]
        uncorrected = tips(real, actual(errors, posed, ORIGINS[model], real)) - wanted
        without = max(without, float(np.linalg.norm(uncorrected, axis=1).max()))
        for row in rows:
            part = np.linspace(0.0, 1.0, 33)[:, None]
            commands = new[row - 1] + part * (new[row] - new[row - 1])
            found = tips(real, actual(errors, commands, ORIGINS[model], real))
            worst = max(worst, float(beside(found, wanted).max()))
    assert worst <= 2 * TOLERANCE + 2 * ROUNDED
    assert without > 4.0 * worst
    assert steps.promised() == pytest.approx(2 * TOLERANCE + 0.001)  # and the chords of arcs
    assert result.certificate.largest["deviation"] <= steps.limit()
