"""Kinematics of machines as the TOML of machine files; every number reads back as the same bits."""

from __future__ import annotations

import json
from collections.abc import Iterable

from gcxform.machine.machine import Axis, Machine


def to_toml(machine: Machine, comments: Iterable[str] = ()) -> str:
    """Return the axes of a machine, its chains and its gauge point, after lines of comment."""
    lines = [f"# {comment}".rstrip() for comment in comments]
    lines += ["format = 1", f"name = {_text(machine.name)}"]
    lines += [f"table = {json.dumps(machine.table)}", f"head = {json.dumps(machine.head)}"]
    lines += [f"gauge-point = {list(map(float, machine.gauge_point))}"]
    for letter, axis in machine.axes.items():
        lines += ["", f"[axis.{letter}]", *axis_lines(axis)]
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


def axis_lines(axis: Axis) -> list[str]:
    """Return the lines of the table of an axis, without its header."""
    lists = {"direction": axis.direction, "point": axis.point, "limits": axis.limits}
    values = {"wrap": axis.wrap, "max-speed": axis.max_speed}
    lines = [f"{key} = {list(map(float, value))}" for key, value in lists.items() if value]
    lines += [f"sign = {axis.sign}"] * (axis.sign is not None)
    return lines + [f"{key} = {float(value)}" for key, value in values.items() if value is not None]
