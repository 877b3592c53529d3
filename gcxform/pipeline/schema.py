"""JSON Schemas of the files that a user writes; that of pipelines has the options of all passes."""

from __future__ import annotations

import inspect
from typing import Any, Final, Literal

from gcxform.config.schemas import format_schema, headed, opened
from gcxform.contract import options
from gcxform.errormodel import model_file
from gcxform.machine import schema as machine_file
from gcxform.pipeline.file import FILLED_IN, FORMAT, SECTIONS
from gcxform.plugin.registry import Registry, default_registry

Kind = Literal["pipeline", "machine", "model"]
DIALECTS: Final = ("input", "output")
"""The sections that name a dialect."""


def schema(kind: Kind, registry: Registry | None = None) -> dict[str, Any]:
    """Return the JSON Schema of a kind of files; that of pipelines has the passes' options."""
    if kind == "model":
        return model_file.schema()
    installed = registry or default_registry()
    if kind == "machine":
        tuple(installed.dialects.values())  # are loaded: they have settings of their own
        return machine_file.schema(installed.machines)
    return _pipeline_schema(installed)


def _pipeline_schema(registry: Registry) -> dict[str, Any]:
    properties: dict[str, Any] = {"format": format_schema(FORMAT)}
    for name, section in SECTIONS.items():
        found = options.schema(section)
        if name in DIALECTS:
            found["properties"]["dialect"] |= {"enum": [*registry.dialects]}
        keys = found["properties"]
        found["properties"] = {k: opened(v) for k, v in keys.items()} if name in FILLED_IN else keys
        properties[name] = {**found, "description": _said(section)}
    properties["budget"]["minProperties"] = 1
    steps = [_step(name, each) for name, each in registry.passes.items()]
    properties["pass"] = {
        "type": "array",
        "items": {"anyOf": steps},
        "description": "a step of the chain, by its name; steps run in their order",
    }
    return headed(
        "pipeline",
        {
            "type": "object",
            "properties": properties,
            "required": ["format"],
            "additionalProperties": False,
        },
    )


def _step(name: str, step: type) -> dict[str, Any]:
    """Return the schema of a step: the name of its pass, and its options."""
    found = options.schema(step)
    return found | {
        "title": name,
        "description": _said(step),
        "properties": {"use": {"const": name, "description": _said(step)}} | found["properties"],
        "required": ["use", *found["required"]],
    }


def _said(of: type) -> str:
    """Return the first sentence of what something says of itself."""
    return " ".join((inspect.getdoc(of) or "").partition("\n\n")[0].rstrip(".").split())
