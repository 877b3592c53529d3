"""Faults of what editors are told."""

from __future__ import annotations

from faults.mutation import Mutation

SCHEMAS = "tests/test_schemas.py"
EDITING = "tests/test_editing.py::test_"
EDITING_STATE = f"{EDITING}a_state_that_is_kept_is_not_that_of_another_text"
EDITING_PLACES = f"{EDITING}places_are_counted_in_units"
EDITING_FORMAT = f"{EDITING}formatting_is_what_text_passes_make"

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
    Mutation(
        "editing: a state is kept that another text led to",
        "gcxform/cli/editing/program.py",
        "while kept.stops and data[",
        "while not kept.stops and data[",
        EDITING_STATE,
    ),
    Mutation(
        "editing: a state is that of a line further on",
        "gcxform/cli/editing/program.py",
        "for stop in kept.stops if stop.lines <= number",
        "for stop in kept.stops",
        EDITING_STATE,
    ),
    Mutation(
        "editing: characters are taken for units",
        "gcxform/cli/editing/text.py",
        'head = line.encode(codec, "surrogatepass")[: size * count]',
        "return min(count, len(line))",
        EDITING_PLACES,
    ),
    Mutation(
        "editing: a line of a range is renumbered by itself",
        "gcxform/cli/editing/changes.py",
        "if step.name != RENUMBER",
        "if step.name",
        EDITING_FORMAT,
    ),
    Mutation(
        "highlighting: a sign in front of a number is no operator",
        "gcxform/cli/editing/highlighting.py",
        'or each[0] == "NUMBER"]',
        'or each[0] != "NUMBER"]',
        "tests/test_highlighting.py",
    ),
)
