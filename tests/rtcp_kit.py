"""Machines and programs for the tests of `rtcp`, and where scipy's matrices say that axes are."""

from __future__ import annotations

import re

import numpy as np
from kinematics_kit import PRESETS, matrices, preset, tool

import gcxform as gx

LENGTH = 95.0  # mm, of the tool
ZERO = np.array([31.0, -17.0, -140.0])  # the work offset
GAUGE = np.array([4.0, -3.0, 20.0])
ROUNDED = 0.00087  # mm, three decimals
KINDS = sorted(PRESETS)


def chain_of_kind(name, seed):
    """Return a chain of a kind with the tool of this file, its axes at points of their own."""
    chain = preset(name, np.random.default_rng(seed))
    return gx.Chain(chain.table, chain.head, tuple((GAUGE - [0.0, 0.0, LENGTH]).tolist()))


def machine_text(name, chain):
    """Return the machine file of a chain."""
    lines = ["format = 1", f'kinematics = "{name}"', f"gauge-point = {GAUGE.tolist()}"]
    lines += [f"[axis.{letter}]" for letter in "XYZ"]
    for axis in chain.axes:
        lines += [f"[axis.{axis.letter}]", f"point = {[*map(float, axis.point)]}"]
    lines += ["[work-offset.G54]"]
    lines += [f"{axis} = {value}" for axis, value in zip("XYZ", ZERO, strict=True)]
    lines += ["[tool.1]", f"length = {LENGTH}"]
    return "\n".join(lines) + "\n"


SEGMENT = '[[pass]]\nuse = "segment"\nchord-error = 0.001\n'


def pipeline(folder, machine, decimals=3, before=SEGMENT, after="", use="rtcp", **options):
    """Return the pipeline of a pass with options, for the text of a machine file."""
    (folder / "machine.toml").write_text(machine)
    said = "\n".join(f"{key.replace('_', '-')} = {value!r}" for key, value in options.items())
    (folder / "p.toml").write_text(
        'format = 1\n[input]\ndialect = "fanuc"\n[machine]\nfile = "machine.toml"\n'
        f'[[pass]]\nuse = "absolute"\n{before}'
        f'[[pass]]\nuse = "{use}"\n{said}\n{after}[output]\nstamp = false\ndecimals = {decimals}\n'
    )
    return gx.Pipeline.load(folder / "p.toml")


def program(poses, letters, feed="F600."):
    """Return a program that goes in lines through poses (n, 5): X, Y, Z and two angles."""
    words = ["".join(f"{a}{v:.3f}" for a, v in zip(letters, pose, strict=True)) for pose in poses]
    turned = " ".join(f"{letter}0." for letter in letters[3:])
    mode, each = ("G93", feed) if feed != "F600." else ("G94", "")
    head = f"G21 G90 {mode} G17 G54\nG0 X0. Y0. {turned}\nG43 H1 Z0.\nG1 {words[0]} {feed}\n"
    rest = "".join(f"{block} {each}\n" for block in words[1:])
    return (head + rest + "M30\n").encode()


def positions(text, letters):
    """Return where axes stand at the end of every line (n, 5), words kept from line to line."""
    here = {letter: 0.0 for letter in letters}
    found = []
    for line in re.sub(r"\([^()]*\)", "", text.decode()).splitlines():
        here.update({a: float(v) for a, v in re.findall(r"([A-Z])(-?[\d.]+)", line) if a in here})
        found.append([here[letter] for letter in letters])
    return np.array(found)


def tips(chain, poses):
    """Return the words (n, 3) of tips for words of axes (n, 5), by the matrices of scipy."""
    linear = poses[:, :3] + ZERO + [0.0, 0.0, LENGTH]
    return tool(chain, linear, poses[:, 3:])[0] - ZERO - GAUGE


def axes(chain, poses):
    """Return the words (n, 3) of axes for words of tips (n, 5)."""
    moved = np.tile(np.eye(4), (len(poses), 1, 1))
    table, head = moved.copy(), moved.copy()
    for k, axis in enumerate(chain.table):
        table = table @ matrices(axis, poses[:, 3 + k])
    for k, axis in enumerate(chain.head, len(chain.table)):
        head = head @ matrices(axis, poses[:, 3 + k])
    point = np.ones((len(poses), 4))
    point[:, :3] = poses[:, :3] + ZERO + GAUGE
    arm = head @ np.array([*chain.tip, 1.0])
    linear = np.einsum("nij,nj->ni", table, point) - arm
    return linear[:, :3] - ZERO - [0.0, 0.0, LENGTH]


def between(start, end, count=33):
    """Return poses (count, 5) from one to another in proportion."""
    return start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)


def aside(points, start, end):
    """Return the distances (n,) of points from the way between two points."""
    way = end - start
    square = float(way @ way)
    part = np.clip((points - start) @ way / square, 0.0, 1.0) if square else np.zeros(len(points))
    return np.linalg.norm(points - start - part[:, None] * way, axis=1)
