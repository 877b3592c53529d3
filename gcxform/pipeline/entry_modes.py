"""Which modes a program may be told to begin in: `[entry]` of a pipeline file."""

from __future__ import annotations

from collections.abc import Iterable

from gcxform.diagnostics import UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.tables import GROUPS

ENTERED = (*GROUPS, "retract")


def check_entry(modes: Iterable[str], dialect: type[Dialect]) -> None:
    """Refuse modes that are none of the dialect, or two of one group. Raises UsageError."""
    groups: set[str] = set()
    for mode in modes:
        code = dialect.codes.get(mode)
        known = code is not None and (code.group in ENTERED or mode == "G49")
        if code is None or not known or code.group in groups:
            message = f"modes: {mode!r} is no mode of {dialect.name}, or one of two"
            raise UsageError.one("GX707", message, hint='modes = "G90 G21 G94" in [entry]')
        groups.add(code.group)
