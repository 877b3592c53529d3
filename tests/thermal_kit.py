"""Warm screws for tests: the vector of the published screw, files of models, integrals by parts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.catalogue import CATALOGUE
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.thermal import Held, Rod, ThermalScrew, stretch

ALPHA = 11.5e-6
PITCH = 111.0
AT = PITCH * np.arange(12)
WARM = np.array([31, 33.5, 38, 46, 53, 57, 55, 48, 40, 34, 31, 30])
COLD = 22.0
NAMES = [f"T{k}" for k in range(12)]
HELD_SECTION = 210e3 * np.pi * 20.0**2  # N: steel, 40 mm in diameter

SCREW = "nut = 200.0\ndirection = 1\nhomed-at = 0.0"


def warm(seed: int) -> ThermalScrew:
    """Return a model of three axes: screws in both senses, one of them held, and a scale."""
    rng = np.random.default_rng(seed)
    at = np.cumsum(rng.uniform(40, 160, 12)) - 100.0
    held = Held(2e5, 5e5, HELD_SECTION, 900.0)
    rods = (
        Rod(at, ALPHA, 420.0, 1, 10.0),
        Rod(at, ALPHA, 450.0, -1, -20.0, held),
        Rod(at - 400.0, 8e-6, still=100.0),
    )
    axes = [stretch(rod, rng.uniform(0, 40, 12), (-300.0, 300.0)) for rod in rods]
    return ThermalScrew((axes[0], axes[1], axes[2]))


def growth(place: float, temperatures=WARM, alpha: float = ALPHA) -> float:
    """Return the growth (mm) of a screw up to a place (mm), by summing small steps."""
    steps = np.linspace(0.0, place, 200_001)
    middle = (steps[1:] + steps[:-1]) / 2
    theta = np.interp(middle, AT, np.asarray(temperatures)) - COLD
    return float(alpha * theta.sum() * (steps[1] - steps[0]))


def csv(*rows: str, names=NAMES, unit: str = "degC") -> str:
    """Return a file of readings."""
    header = ",".join(["time", *(f"{name} [{unit}]" for name in names)])
    return "\n".join([header, *rows]) + "\n"


def row(time: str, temperatures=WARM) -> str:
    return ",".join([time, *(f"{t:g}" for t in temperatures)])


def text(
    rod: str = f"[X.screw]\n{SCREW}\n",
    general: str = "",
    *,
    reference: str = "22.0",
    travel: str = "[0.0, 520.0]",
    expansion: str = "11.5e-6",
) -> str:
    """Return the text of a model of X."""
    head = [
        "format = 1",
        'kind = "thermal-screw"',
        'readings = "readings.csv"',
        f"reference = {reference}",
        *(() if "sensor-range" in general else ("sensor-range = [0.0, 80.0]",)),
        general,
        "[X]",
        f"travel = {travel}",
        f"expansion = {expansion}",
        f"sensors = {NAMES}",
        f"at = {AT.tolist()}",
        rod,
    ]
    return "\n".join(head) + "\n"


def written(folder: Path, model: str, readings: str | None = None) -> Path:
    """Write a model and its readings; return the model's file."""
    (folder / "model.toml").write_text(model, "utf-8")
    (folder / "readings.csv").write_text(readings or csv(row("2026-03-04T10:00:00")), "utf-8")
    return folder / "model.toml"


LOG = csv(
    row("2026-03-04T08:00:00", [22.0] * 12),
    row("2026-03-04T09:00:00", WARM - 4),
    row("2026-03-04T10:00:00"),
)


def along(model, x) -> np.ndarray:
    """Return the error in X (um) at positions of X (mm)."""
    x = np.atleast_1d(np.asarray(x, dtype=float))
    return 1000 * model.error(np.column_stack([x, 0 * x, 0 * x]))[:, 0]


def refused(path: Path):
    with pytest.raises(gx.UsageError) as caught:
        load_model(path)
    assert all(d.code in CATALOGUE for d in caught.value.diagnostics)
    return caught.value.diagnostics


def place(found) -> tuple:
    return Path(found.where.file).name, found.where.line, found.where.column, found.code
