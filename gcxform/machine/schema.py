"""The JSON Schema of machine files, made of the structs that they are read into."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Final

import msgspec

from gcxform.config.quantities import AXIS_LETTERS
from gcxform.config.schemas import format_schema, headed, of_toml, opened, whole
from gcxform.config.to_fill_in import TO_FILL_IN
from gcxform.errormodel.model_file import FORMAT
from gcxform.machine import control
from gcxform.machine.control import HOME, WORK_OFFSET
from gcxform.machine.file import FILLED_IN, TOOL
from gcxform.machine.formats import NONE, Known
from gcxform.machine.machine import MachineFile

NAMES: Final = {
    "axis": "|".join(AXIS_LETTERS),
    "work-offset": WORK_OFFSET.pattern,
    "home": HOME.pattern,
    "tool": TOOL.pattern,
}
"""How the tables below a table are called."""


def schema(known: Known = NONE) -> dict[str, Any]:
    """Return the JSON Schema of machine files, with the names that are known."""
    found: dict[str, Any] = of_toml(msgspec.json.schema(MachineFile))
    parts = found["$defs"]
    keys = parts["MachineFile"]["properties"]
    keys["format"] = format_schema(FORMAT)
    said = {"description": keys["control"]["description"]}
    tuple(known.dialects.values())  # loads them all, and what they declare
    keys["control"] = opened(control.schema()) | {"type": "object"} | said
    readers = [name for name, each in known.controls.items() if each.reads("tools")]
    keys["kinematics"] |= _choice(known.kinematics)
    keys["tool-table-control"] |= _choice(readers)
    keys["control"]["properties"][control.LIKE] |= _choice(known.presets)
    for name, pattern in NAMES.items():
        keys[name]["propertyNames"] = {"pattern": whole(pattern)}
        if name in FILLED_IN:
            inner = keys[name]["additionalProperties"]
            keys[name]["additionalProperties"] = {"anyOf": [inner, {"const": TO_FILL_IN}]}
    for name in ("Tool", "Offset"):  # they may be left to be filled in; those of an axis may not
        parts[name] = opened(parts[name]) | {"type": "object"}
        parts[name].pop("pattern", None)
    return headed("machine", found)


def _choice(names: Collection[str]) -> dict[str, Any]:
    """Return what a schema says of a key that takes one of some names, if any are known."""
    return {"enum": [*names]} if names else {}
