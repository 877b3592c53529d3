"""JSON Schemas (draft 2020-12) of the files that we read: what they have in common.

TOML has no null, and JSON no "not known": neither stands in a schema. A schema is named by a URN,
so that no host has to be there; editors find it as a file (`gcxform schema --write`).
"""

from __future__ import annotations

import math
from typing import Any, Final

import msgspec

from gcxform.config.quantities import Quantity
from gcxform.config.to_fill_in import TO_FILL_IN

Schema = dict[str, Any]
DRAFT: Final = "https://json-schema.org/draft/2020-12/schema"
NAME: Final = "urn:gcxform:schema:"
TAKES: Final = "takes"  # what replaces the type that msgspec knows


def headed(kind: str, found: Schema) -> Schema:
    """Return a schema with its head: the draft, its name and its title."""
    return {"$schema": DRAFT, "$id": f"{NAME}{kind}", "title": f"gcxform {kind} file", **found}


def format_schema(number: int) -> Schema:
    """Return the schema of the key `format`."""
    return {"const": number, "description": f"the form of this file; now {number}"}


def whole(pattern: str) -> str:
    """Return a pattern which the whole of a text has to match, as JSON Schemas have it."""
    return f"^(?:{pattern})$"


def quantity_schema(*quantities: Quantity) -> Schema:
    """Return the schema of a number, or of a string with a unit of one of some quantities."""
    patterns = "|".join(quantity.pattern() for quantity in quantities)
    return {"type": ["number", "string"], "pattern": whole(patterns)}


def with_unit(*quantities: Quantity) -> msgspec.Meta:
    """Return the mark of a number, for `Annotated`, that may be written with a unit."""
    return msgspec.Meta(extra_json_schema={TAKES: quantity_schema(*quantities)})


def opened(schema: Schema) -> Schema:
    """Return the schema of a value that a file may leave to be filled in, and of those below it."""
    found = dict(schema)
    for key in ("properties", "patternProperties"):
        if key in found:
            found[key] = {name: opened(value) for name, value in found[key].items()}
    if isinstance(inner := found.get("additionalProperties"), dict):
        found["additionalProperties"] = opened(inner)
    if "enum" in found:
        return found | {"enum": [*found["enum"], TO_FILL_IN]}
    kinds = found.get("type", [])
    kinds = kinds if isinstance(kinds, list) else [kinds]
    if "pattern" in found:
        return found | {"pattern": rf"^\{TO_FILL_IN}$|{found['pattern']}"}
    if "string" in kinds or not kinds:
        return found
    return found | {"type": [*kinds, "string"], "pattern": rf"^\{TO_FILL_IN}$"}


def of_toml(node: Any) -> Any:
    """Return a schema made of types in Python, without what TOML and JSON cannot say."""
    if isinstance(node, list):
        return [of_toml(each) for each in node]
    if not isinstance(node, dict):
        return node
    found = {key: of_toml(value) for key, value in node.items() if not _is_unsaid(key, value)}
    found |= found.pop(TAKES, {})
    if "prefixItems" in found:  # of one kind here, and then older validators know it as well
        first, *others = found.pop("prefixItems")
        assert all(other == first for other in others)
        found["items"] = first
    among = [each for each in found.get("anyOf", ()) if each != {"type": "null"}]
    if len(among) == 1:
        del found["anyOf"]
        return among[0] | found
    return found | ({"anyOf": among} if among else {})


def _is_unsaid(key: str, value: Any) -> bool:
    unknown = isinstance(value, float) and math.isnan(value)
    return key == "default" and (value is None or unknown)
