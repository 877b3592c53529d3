"""M codes that a user says leave the axes of the target where they stand, such as a tool change.

A tool that is changed by hand moves nothing; what a changer does belongs to its machine, and no
table of a control can say it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any, cast

from gcxform.diagnostics import UsageError
from gcxform.dialect.dialect import Dialect


def with_inert(dialect: type[Dialect], names: frozenset[str]) -> type[Dialect]:
    """Return the dialect in which M codes lose no position. Raises UsageError for other codes."""
    known = {f"M{number}" for number, code in dialect.m_codes.items() if not code.barrier}
    for name in sorted(names - known):
        message = f"inert: {name} is no M code of {dialect.name} that could be inert"
        raise UsageError.one("GX707", message, hint='inert = ["M6"] in [output]')
    return _with(cast(Any, dialect), names) if names else dialect


@cache
def _with(dialect: Any, names: frozenset[str]) -> type[Dialect]:
    codes = {
        number: replace(code, loses_position=code.loses_position and f"M{number}" not in names)
        for number, code in dialect.m_codes.items()
    }
    made: type[Dialect] = type(dialect.__name__, (dialect,), {"m_codes": codes})
    return made
