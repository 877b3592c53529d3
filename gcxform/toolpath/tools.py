"""Which tool is in the spindle, as the events of a program say."""

from __future__ import annotations

from collections.abc import Collection

from gcxform.dialect.dialect import Dialect
from gcxform.toolpath.path import Event

NONE = "none"


class ToolInSpindle:
    """The tool in the spindle, by name; before the first change it is `none`.

    `used` are codes that the program has: where one of them changes tools, as M6, T only says which
    is next; otherwise T does it.
    """

    def __init__(self, dialect: type[Dialect], used: Collection[str]) -> None:
        self.change = {f"M{n}" for n, code in dialect.m_codes.items() if code.group == "tool"}
        self.changes = not self.change.isdisjoint(used)
        self.ready = self.loaded = NONE

    def see(self, event: Event) -> bool:
        """Take an event into account; return whether it has changed the tool."""
        values = dict(event.values)
        number = values.get("T", values.get("Q") if event.what in self.change else None)
        if number is not None:
            self.ready = f"T{number:g}"
        if event.what in self.change or (event.what == "T" and not self.changes):
            self.loaded = self.ready
            return True
        return False
