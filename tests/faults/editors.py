"""Faults of what editors are told."""

from __future__ import annotations

from faults.mutation import Mutation

SCHEMAS = "tests/test_schemas.py"

MUTATIONS = (
    Mutation(
        "schemas: an option takes a length without a unit",
        "gcxform/config/schemas.py",
        '"|".join(quantity.pattern() for quantity',
        '"|".join(quantity.pattern(bare=True) for quantity',
        SCHEMAS,
    ),
    Mutation(
        "schemas: a range is not said",
        "gcxform/contract/option_schemas.py",
        "if b is not None and numeric",
        "if b is not None and not numeric",
        SCHEMAS,
    ),
    Mutation(
        "schemas: what is left to be filled in is wrong",
        "gcxform/machine/schema.py",
        "opened(parts[name])",
        "parts[name]",
        SCHEMAS,
    ),
)
