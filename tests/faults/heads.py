"""Faults of what a probe in a turning head keeps clear of, and of the program that leads it."""

from __future__ import annotations

from faults.mutation import Mutation

HEADS = "tests/test_plan_heads.py"


def _heads(file: str, name: str, old: str, new: str) -> Mutation:
    return Mutation(f"heads: {name}", file, old, new, HEADS)


MUTATIONS = (
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "a leaning probe has room as an upright one",
        "room * (around + along.clip(0.0))",
        "room * along.clip(0.0)",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "the probe goes through balls before its own",
        "in places[:number] + places[number + 1 :]",
        "in places[number + 1 :]",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "the way down has no probe behind it",
        "ways = np.stack([along, ",
        "ways = np.stack([up, ",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "the nearest may be backwards",
        "(shares[:, :, 0] >= 0.0)",
        "(shares[:, :, 0] >= -9e9)",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "only the way between table and probe counts",
        "[chain.tool_axis(degrees), chain.spindle(degrees), chain.upwards(degrees)]",
        "[chain.tool_axis(degrees)]",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "a head may hang",
        ".min() < HANGING)",
        ".min() < -2.0)",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "the tip turns without room",
        "highest + room - lowest",
        "highest - lowest",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "heights bend nowhere",
        "math.radians(STEP) ** 2 / 8.0",
        "0.0",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "an axis starts at its first pose",
        "min(0.0, degrees[:, k].min())",
        "degrees[:, k].min()",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "a wrapping axis goes no other way",
        " or axis.wrap is not None",
        "",
    ),
    _heads(
        "gcxform/calibrate/bundle/clearance.py",
        "an endless axis goes no other way",
        "axis.limits is None or axis.wrap",
        "axis.wrap",
    ),
    _heads(
        "gcxform/calibrate/bundle/touching.py",
        "a leaning ball is found from above",
        "plan.points + aside + height[:, None] * along",
        "plan.points + aside + height[:, None] * [0, 0, 1]",
    ),
    _heads(
        "gcxform/calibrate/bundle/touching.py",
        "the sides are those of an upright probe",
        "np.sin(turns) * np.cross(along, toward))",
        "np.sin(turns) * np.cross([0, 0, 1], toward))",
    ),
)
