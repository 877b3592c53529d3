"""Controls that are not read and whose programs may be taken for those of others.

| control | what only it has | known from |
|---|---|---|
| Fagor 8055 | `%COMMENT,` in the first line, and its permissions of MXHO | 8055i, SOFT M 9.0X |
| Fadal | E, the number of a fixture offset, beside the start of the spindle | [K] |
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

UNREAD: Final[Mapping[str, re.Pattern[bytes]]] = {
    "a Fagor 8055": re.compile(rb"\A\s*%[^,\r\n]{0,20},[ \t]*[MXHO-]{1,4}[ \t]*(?:[,\r\n]|\Z)"),
    "a Fadal": re.compile(
        rb"^[^;(\r\n]*(?<![A-Z])M[ \t]*0?[34][ \t]*E[ \t]*[0-9]{1,2}(?![.0-9])", re.MULTILINE
    ),
}


def unread(head: bytes) -> str:
    """Return which of them a program is for, by its beginning; nothing for all others."""
    return next((name for name, sign in UNREAD.items() if sign.search(head)), "")
