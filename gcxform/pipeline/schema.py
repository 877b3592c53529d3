"""JSON Schemas of the files that a user writes; that of pipelines has the options of all passes."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, Final, Literal

from gcxform.contract.options import OptionDoc, describe
from gcxform.errormodel import model_file
from gcxform.machine import file as machine_file
from gcxform.pipeline.file import FORMAT, SECTIONS
from gcxform.plugin.registry import Registry, default_registry

FORM: Final = f"the form of this file; now {FORMAT}"
_JSON_TYPES: Final[Mapping[str, str | list[str]]] = {
    "length": ["number", "string"],
    "increment system or length": ["number", "string"],
    "increment system or number": ["number", "string"],
    "angle": ["number", "string"],
    "three lengths": ["array", "string", "object"],
    "coordinates by axis letter": "object",
    "list of lines": "array",
    "list of folders": "array",
    "numbers by parameter": "object",
    "true or false": "boolean",
    "whole number": "integer",
    "number": "number",
    "whole number or table by letter": ["integer", "object"],
}


Kind = Literal["pipeline", "machine", "model"]


def schema(kind: Kind, registry: Registry | None = None) -> dict[str, Any]:
    """Return the JSON Schema of a kind of files; that of pipelines has the passes' options."""
    if kind == "machine":
        _ = registry or default_registry()  # dialects have settings of their own
        return machine_file.schema()
    if kind == "model":
        return model_file.schema()
    return _pipeline_schema((registry or default_registry()).passes)


def _pipeline_schema(passes: Mapping[str, type]) -> dict[str, Any]:
    steps = [_table(describe(each), use=name) for name, each in passes.items()]
    properties: dict[str, Any] = {"format": {"const": FORMAT, "description": FORM}}
    for name, section in SECTIONS.items():
        said = (inspect.getdoc(section) or "").partition("\n\n")[0].rstrip(".")
        properties[name] = {**_table(describe(section)), "description": " ".join(said.split())}
    said = "a step of the chain, by its name; steps run in their order"
    properties["pass"] = {"type": "array", "items": {"anyOf": steps}, "description": said}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "gcxform pipeline",
        "type": "object",
        "properties": properties,
        "required": ["format"],
        "additionalProperties": False,
    }


def _table(options: list[OptionDoc], use: str = "") -> dict[str, Any]:
    """Return the schema of a table of options, with the name of its pass."""
    named: dict[str, Any] = {"use": {"const": use}} if use else {}
    return {
        "type": "object",
        "properties": named | {option.name: _property(option) for option in options},
        "required": [*named, *(option.name for option in options if option.mandatory)],
        "additionalProperties": False,
    }


def _property(option: OptionDoc) -> dict[str, Any]:
    found: dict[str, Any] = {"type": _JSON_TYPES.get(option.type, "string")}
    if option.choices:
        found = {"enum": list(option.choices)}
    parts = (option.help, option.range, f"default {option.default}" if option.default else "")
    if text := "; ".join(part for part in parts if part):
        found["description"] = text
    return found
