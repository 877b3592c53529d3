"""What `gcxform check` asks for, taken from what it prints and filled in."""

from __future__ import annotations

import tomllib
from typing import Any

ANSWERS: dict[str, Any] = {
    "increment": "IS-B",
    "feed-increment": 1.0,
    "feed": 100.0,
    "block-delete": "skip",
    "peck-return": 0.5,
    "peck-clearance": 1.0,
    "g52": "fanuc",
    "cycle-without-place": "drills",
    "cycle-levels": "stay",
    "cycle-repeats": "L",
    "user-codes": "keep",
    "tool-length-axis": "Z",
    "basic-frames": "none",
    "orientation-path": "angles",
    "edge-after-tool-change": 1,
    "presets": [2],
    "inert-cycle": 392,
    "label-jumps": "return",
    "units": "mm",
    "argument-list": "II",
    "tip-at-start": "off",
    "tip-words": "workpiece",
    "cutter-comp-corners": "arc",
    "cutter-comp-entry": "own",
    "radius": 0.001,
    "null-compare": "zero",
    "ends": "unknown",
    "inert-m": [6, 50],
    "inch-feeds": "inches",
    "for-end": "included",
    "subroutine-locals": "shared",
    "mcall-in-subprograms": "acts",
    "motion-at-start": "G1",
    "swivel-reference": "A",
    "section-repeats": "further",
    "tool-change-by": "M6",
}


def pasted(stdout: str) -> dict[str, Any]:
    """Return the block of TOML that ends what check says, as values."""
    return tomllib.loads(stdout[stdout.index("\n\n#") :])


def filled(node: Any, key: str = "") -> Any:
    if isinstance(node, dict):
        return {name: filled(value, name) for name, value in node.items()}
    return ANSWERS.get(key, 1.5) if node == "?" else node


def as_toml(values: dict[str, Any]) -> str:
    """Return tables as text; a table in a table has its own header."""
    lines = [f"{key} = {inline(v)}" for key, v in values.items() if not isinstance(v, dict)]
    for name, table in values.items():
        if name in ("tool", "home", "work-offset"):
            lines += [t for k, v in table.items() for t in _table(f'{name}."{k}"', v)]
        elif isinstance(table, dict):
            lines += _table(name, table)
    return "\n".join(lines) + "\n"


def _table(name: str, table: dict[str, Any]) -> list[str]:
    return [f"[{name}]", *(f"{key} = {inline(value)}" for key, value in table.items())]


def inline(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f'"{k}" = {inline(v)}' for k, v in value.items()) + " }"
    return f'"{value}"' if isinstance(value, str) else repr(value)
