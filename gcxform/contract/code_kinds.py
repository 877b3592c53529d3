"""Options that name codes of a control: a list of them, and a table of M codes."""

from __future__ import annotations

import re
from typing import Annotated, Final

from gcxform.contract.option_kinds import Argument, Around, Kind, RefusedError, written

CODE: Final = r"[GM](0|[1-9][0-9]*)(\.[1-9])?|#|\(\)"
"""A code; or assignments that last longer than the program, or comments that are executed."""
M_CODE: Final = r"M(0|[1-9][0-9]*)"


def _read_codes(raw: object, around: Around) -> tuple[str, ...]:
    given = raw.split(",") if isinstance(raw, Argument) else raw
    if not isinstance(given, list | tuple):
        expected = 'a list of codes, such as ["M8", "G64"]'
        raise RefusedError("GX702", f"expected {expected}, got {written(raw)}")
    return tuple(_code(each, CODE) for each in given)


def _read_table(raw: object, around: Around) -> dict[str, str]:
    if not isinstance(raw, dict):
        expected = 'a table of M codes, such as { M88 = "M7" }'
        raise RefusedError("GX702", f"expected {expected}, got {written(raw)}")
    return {_code(name, M_CODE): _code(said, M_CODE) for name, said in raw.items()}


def _code(raw: object, pattern: str) -> str:
    if not isinstance(raw, str) or not re.fullmatch(pattern, raw):
        hint = "codes are written in capitals and without zeros in front: M8, G61.1"
        raise RefusedError("GX702", f"{written(raw)} is no code", hint)
    return raw


_ONE = {"type": "string", "pattern": f"^{M_CODE}$"}
_CODES = Kind(
    "list of codes",
    _read_codes,
    list,
    schema={"type": "array", "items": {"type": "string", "pattern": f"^({CODE})$"}},
)
_TABLE = Kind(
    "table of M codes",
    _read_table,
    schema={
        "type": "object",
        "patternProperties": {f"^{M_CODE}$": _ONE},
        "additionalProperties": False,
    },
)
CodeList = Annotated[tuple[str, ...], _CODES]
"""Codes, as "G64" or "M8"; written as a list."""
CodeTable = Annotated[dict[str, str], _TABLE]
"""M codes by M codes; written as a table."""
