"""Acceptance checks of volumetric compensation that are not shown elsewhere: V1, V7 and V8.

V2, V7 and V8 also in test_errors.py, V3 and V4 in test_volumetric.py, V5 and V6 in test_rigid.py,
V9 in test_step_diagonal.py; V1 byte for byte in corpus/lddm.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.errormodel.model import Outside, compensate
from gcxform.errormodel.model_file import load_model

ROOT = Path(__file__).parents[1]
LDDM = load_model(ROOT / "examples" / "lddm" / "model.toml")


# --- V1: the published arc ---


def arc_words(pi: float) -> list[str]:
    """Return X and Y of the published arc, by its definition and a constant for pi."""
    angles = [k * 10.0 * pi / 180.0 for k in range(1, 10)]
    target = np.array([(-6.0 + 10.0 * math.cos(a), -2.0 - 10.0 * math.sin(a), 0.0) for a in angles])
    command = target - LDDM.error(target, Outside.EXTRAPOLATE)
    return [f"X{_word(x)} Y{_word(y)}" for x, y, _ in command]


def _word(value: float) -> str:
    return f"{math.copysign(math.floor(abs(value) * 1000 + 0.5) / 1000, value):.3f}".rstrip("0")


def test_v1_with_another_pi_the_published_arc_differs_in_one_word():
    """The published X-6. is X-6.001 with the right pi, and X-6. with 3.14159; no other word is."""
    text = (ROOT / "corpus" / "lddm" / "arc.txt").read_text("utf-8")
    written = re.findall(r"^G2 (X\S+ Y\S+) ", text.partition("-- expected.nc --")[2], re.MULTILINE)
    assert len(written) == 9
    assert arc_words(math.pi) == written
    assert arc_words(3.14159) == [*written[:-1], written[-1].replace("X-6.001", "X-6.")]


# --- V7: beyond the table ---

PROGRAM = b"G21 G90 G94\nG0 X10. Y10. Z10.\nG1 X200. F500.\nY-3.\n(and on)\nZ-20.\nM30\n"


def outcome(folder: Path, options: str) -> gx.Result:
    text = f"""\
format = 1
[input]
dialect = "fanuc"
[[pass]]
use = "volumetric"
model = "{ROOT / "examples" / "lddm" / "model.toml"}"
part-origin = [0.0, 0.0, 0.0]
{options}
"""
    (folder / "p.toml").write_text(text)
    return gx.Pipeline.load(folder / "p.toml").run(PROGRAM)


def test_v7_the_first_place_outside_is_named_with_axis_value_limit_and_line(tmp_path):
    with pytest.raises(gx.InputError) as caught:
        outcome(tmp_path, "")
    found = caught.value.diagnostics[0]
    assert (found.code, found.where.line) == ("GX310", 4)
    assert "Y -3.000 is outside the error table, which ends at 0" in found.message


def test_v7_extrapolation_by_more_than_one_cell_is_named_too(tmp_path):
    """Y-3 is within a cell of 33 mm, Z-20 within one of 45."""
    outcome(tmp_path, 'outside = "extrapolate"')
    with pytest.raises(gx.InputError) as caught:
        outcome(tmp_path, 'outside = "extrapolate"\nmax-extrapolation = 0.4')
    found = caught.value.diagnostics[0]
    assert (found.code, found.where.line) == ("GX310", 6)
    assert "Z -20.000 is outside" in found.message
    assert "by more than 0.4 cells" in found.message


@pytest.mark.parametrize("policy", ["clamp", "extrapolate"])
def test_v7_the_policies_differ_beyond_the_table_and_nowhere_else(tmp_path, policy):
    """At Z-20 the machine is told the target less what the policy says."""
    result = outcome(tmp_path, f'outside = "{policy}"')
    path = gx.read(result.text, "fanuc").path
    line = np.array(result.source_map)[path.source]
    beyond = LDDM.error(np.array([[200.0, -3.0, -20.0]]), Outside(policy))[0]
    assert path.end[line == 5][-1, :3] == pytest.approx((200, -3, -20) - beyond, abs=6e-4)
    inside = LDDM.error(np.array([[200.0, 10.0, 10.0]]))[0]
    assert path.end[line == 2][-1, :3] == pytest.approx((200, 10, 10) - inside, abs=6e-4)


def test_v7_a_cut_through_a_jump_of_the_error_is_not_proved(tmp_path):
    """With zero the error jumps at the border, and no line is straight there."""
    with pytest.raises(gx.GcxformError):
        outcome(tmp_path, 'outside = "zero"')


def test_v7_the_published_arc_needs_extrapolation():
    """Clamped or zero, every Y of the arc is another one: 1.7 of the reference."""
    angles = np.radians(np.arange(10, 91, 10))
    target = np.stack([-6 + 10 * np.cos(angles), -2 - 10 * np.sin(angles), 0 * angles], axis=1)
    right = np.round(target - LDDM.error(target, Outside.EXTRAPOLATE), 3)
    for policy in (Outside.CLAMP, Outside.ZERO):
        assert (np.round(target - LDDM.error(target, policy), 3)[:, 1] != right[:, 1]).all()


# --- V8: the fixed point ---


@pytest.mark.parametrize("steps", range(5))
def test_v8_each_step_of_a_bad_machine_is_within_its_bound(steps):
    """|E| of 1 mm and L of 6e-3, thirty times the published table: the bound, and close to it."""
    axes = (AxisFunction(f.position, 31.25 * f.values) for f in LDDM.axes)
    bad = AxisFunctions(tuple(axes))
    assert bad.largest() == pytest.approx(1.0, abs=0.01)
    assert bad.lipschitz() == pytest.approx(6.1e-3, rel=0.05)
    low, high = np.transpose([bad.range_of(k) for k in range(3)])
    target = np.random.default_rng(8).uniform(low, high, (2000, 3))
    exact = compensate(bad, target, Outside.EXTRAPOLATE, 20).position
    near = target if not steps else compensate(bad, target, Outside.EXTRAPOLATE, steps).position
    off = np.linalg.norm(near - exact, axis=1).max()
    limit = bad.lipschitz() ** steps * bad.largest() / (1 - bad.lipschitz())
    assert 1e-4 * limit < off <= limit
