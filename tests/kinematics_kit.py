"""Chains for the tests of kinematics, and where scipy's matrices say that their tools are."""

from __future__ import annotations

import os

import numpy as np
from scipy.spatial.transform import Rotation

from gcxform.machine.chain import Chain, Rotary
from gcxform.plugin.registry import default_registry

POSES = 100_000 if os.environ.get("HYPOTHESIS_PROFILE") == "long" else 2_000
PRESETS = {n: k for n, k in default_registry().kinematics.items() if len(k.table + k.head) == 2}


def preset(name, rng, inclination=45.0):
    """Return a machine of a kind, its axes at points of their own."""
    kind = PRESETS[name]
    sides = [
        tuple(
            Rotary(a, kind.direction(a, inclination), tuple(rng.uniform(-80, 80, 3)), kind.sign(a))
            for a in letters
        )
        for letters in (kind.table, kind.head)
    ]
    return Chain(*sides, tip=(0.0, 0.0, -120.0))


def skewed(rng, tables):
    """Return a machine of two axes, so many in the table, that are square to nothing."""
    while True:
        ways = rng.normal(size=(2, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        one, two = ways[::-1] if tables == 2 else ways
        if min(np.linalg.norm(np.cross(one, two)), np.linalg.norm(two[:2])) > 0.2:
            break
    axes = tuple(
        Rotary(letter, tuple(way.tolist()), tuple(rng.uniform(-90, 90, 3)), int(sign))
        for letter, way, sign in zip("AC", ways, rng.choice([-1, 1], 2), strict=True)
    )
    return Chain(axes[:tables], axes[tables:], tuple(rng.uniform(-100, 100, 3)))


def matrices(axis, degrees):
    """Return the homogeneous matrices (n, 4, 4) by which an axis carries things."""
    found = np.tile(np.eye(4), (len(degrees), 1, 1))
    vectors = np.radians(axis.sign * degrees)[:, None] * np.array(axis.direction)
    found[:, :3, :3] = Rotation.from_rotvec(vectors).as_matrix()
    moved, back = np.eye(4), np.eye(4)
    moved[:3, 3], back[:3, 3] = axis.point, -np.array(axis.point)
    return moved @ found @ back


def tool(chain, linear, angles):
    """Return tip and tool axis (n, 3) on the workpiece, for X, Y, Z (n, 3) and angles (n, m)."""
    moved = np.tile(np.eye(4), (len(linear), 1, 1))
    table, head = moved.copy(), moved.copy()
    moved[:, :3, 3] = linear
    for k, axis in enumerate(chain.table):
        table = table @ matrices(axis, angles[:, k])
    for k, axis in enumerate(chain.head, len(chain.table)):
        head = head @ matrices(axis, angles[:, k])
    whole = np.linalg.inv(table) @ moved @ head
    tip = whole @ np.array([*chain.tip, 1.0])
    return tip[:, :3], whole[:, :3, 2]


def apart(one, other):
    """Return how far angles are apart, in degrees, full turns forgiven."""
    return np.abs(np.remainder(one - other + 180.0, 360.0) - 180.0)


def leaning(tilts, azimuths):
    """Return vectors that lean from Z by some degrees, towards others."""
    t, a = np.radians(tilts), np.radians(azimuths)
    return np.stack([np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)], axis=-1)
