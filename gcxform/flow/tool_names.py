"""Tools that a program calls by their names, in languages where that may be done."""

from __future__ import annotations

from gcxform.flow.speller import NAMED, Speller, UnspeakableError
from gcxform.modal.state import Reading

MADE_UP = 900_000_000
"""The number of the first tool whose name is all that is known of it; no table has so many."""


class ToolNames:
    """The numbers of tools by their names.

    Where they are called by their names again, any number does that no tool has.
    """

    def __init__(self, reading: Reading) -> None:
        self.reading = reading
        self._made_up: dict[str, int] = {}

    def number(self, name: str) -> str:
        """Return the number of a tool. Raises UnspeakableError where that is not known."""
        known = [number for number, tool in self.reading.tools.items() if tool.name == name]
        if len(known) == 1:
            return str(known[0])
        if known or not self.reading.asides:
            what = "several tools of the machine file have it" if known else "which number it has"
            hint = f'give a tool of the machine file the name "{name}"'
            why = what if known else f"{what} is not known"
            raise UnspeakableError(f'the tool "{name}" by its name: {why}', hint)
        return str(self._made_up.setdefault(name, MADE_UP + len(self._made_up)))

    def beside(self, name: str) -> str:
        """Return what stands behind T in a block, for who calls the tool by its name again."""
        return f" {Speller.aside(NAMED + name)}" if name and self.reading.asides else ""
