"""Findings as values, for programs that read them: places, and what hints offer to do."""

from __future__ import annotations

from typing import Any

from gcxform.diagnostics import Diagnostic, Location


def described(found: Diagnostic) -> dict[str, Any]:
    """Return a finding as plain values.

    `ways` are the ways out that its hint offers, each of which is enough; each is a list of what it
    takes together (`gcxform.catalogue.remedies`).
    """
    from gcxform.catalogue.remedies import as_table, ways

    return {
        "code": found.code,
        "severity": found.severity.name.lower(),
        "message": found.message,
        "place": None if found.where is None else _place(found.where),
        "also": [_place(where) for where in found.also],
        "context": found.context,
        "hint": str(found.hint),
        "ways": [[as_table(offer) for offer in way] for way in ways(found.hint)],
    }


def _place(where: Location) -> dict[str, Any]:
    return {
        "file": where.file,
        "line": where.line,
        "column": where.column,
        "width": where.width,
    }
