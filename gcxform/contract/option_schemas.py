"""What a file may say for an option, by its type, as JSON Schemas.

Each says no less and no more than `option_kinds` reads: keys, types, units and words. A range binds
numbers alone, for a schema cannot compare a string with a unit.
"""

from __future__ import annotations

from typing import Final

from gcxform.config.quantities import ANGLE, AXIS_LETTERS, LENGTH, quantity_of
from gcxform.config.schemas import Schema, quantity_schema, whole
from gcxform.dialect.increments import CALCULATOR, SYSTEMS
from gcxform.system.option_mark import Option

PARAMETER: Final = r"[0-9]+|<[^<>#()]+>"
"""The name of a parameter: a number, or a name in its brackets."""


def ranged(schema: Schema, mark: Option) -> Schema:
    """Return the schema of a value with the range of its option."""
    bounds = {
        "exclusiveMinimum": mark.above,
        "minimum": mark.at_least,
        "maximum": mark.at_most,
    }
    kinds = schema.get("type", ())
    numeric = {"number", "integer"} & {*([kinds] if isinstance(kinds, str) else kinds)}
    return schema | {k: b for k, b in bounds.items() if b is not None and numeric}


def by_letter(schema: Schema) -> Schema:
    """Return the schema of one value, or of a table of values by address letter."""
    kinds = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
    names = {"pattern": "^[A-Z]$"}
    table = {"propertyNames": names, "additionalProperties": dict(schema)}
    return schema | {"type": [*kinds, "object"]} | table


_SYSTEM = "|".join(SYSTEMS)
_SYSTEMS = rf"\s*(?:{CALCULATOR}|(?:{CALCULATOR}\s+)?(?:{_SYSTEM})|(?:{_SYSTEM})\s+{CALCULATOR})\s*"
_SIZES = rf"{LENGTH.pattern()}|{LENGTH.pattern(bare=True)},(?:{ANGLE.pattern()})?"
INCREMENT_SCHEMA: Final[Schema] = {
    "type": ["number", "string"],
    "pattern": whole(f"{_SYSTEMS}|{_SIZES}"),
}
FEED_INCREMENT_SCHEMA: Final[Schema] = {
    "type": ["number", "string"],
    "pattern": whole("|".join((CALCULATOR, *SYSTEMS))),
}
_PART: Final = quantity_schema(LENGTH)
VECTOR_SCHEMA: Final[Schema] = {
    "type": ["array", "string", "object"],
    "items": _PART,
    "minItems": 3,
    "maxItems": 3,
    "pattern": whole(",".join([LENGTH.pattern(bare=True)] * 3)),
    "properties": {letter: {**_PART, "description": f"along {letter}, mm"} for letter in "XYZ"},
    "required": [*"XYZ"],
    "additionalProperties": False,
}
COORDINATES_SCHEMA: Final[Schema] = {
    "type": "object",
    "properties": {
        letter: {**quantity_schema(of), "description": f"{of.name} on {letter}, {of.base}"}
        for letter, of in ((letter, quantity_of(letter)) for letter in AXIS_LETTERS)
    },
    "additionalProperties": False,
}
PARAMETERS_SCHEMA: Final[Schema] = {
    "type": "object",
    "propertyNames": {"pattern": whole(PARAMETER)},
    "additionalProperties": {"type": "number"},
}
LINES_SCHEMA: Final[Schema] = {
    "type": "array",
    "items": {"type": "string", "pattern": "^[ -~]*[!-~][ -~]*$"},
}
