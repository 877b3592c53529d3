"""Where the rows of a path are in the machine, for `volumetric`."""

from __future__ import annotations

from dataclasses import dataclass

from gcxform.vocabulary import Floats, Ints
from gcxform_plugins.passes.volumetric.levers import Lever


@dataclass(frozen=True)
class Place:
    """Position in the table minus position in the program, and the tool.

    `offset` (n or 1, 3) mm; `tool` (n, 3) or (3,) mm is the way from the gauge point to the tip,
    None where the error does not depend on it or it is not known. With a turned head it is that of
    the ends of the rows, and `lever` has it in between.
    """

    offset: Floats
    tool: Floats | None = None
    lever: Lever | None = None

    def offset_of(self, rows: Ints) -> Floats:
        """Return the offsets (n or 1, 3) of rows."""
        return self.offset if len(self.offset) == 1 else self.offset[rows]

    def tool_of(self, rows: Ints, part: Floats | None = None) -> Floats | None:
        """Return the tools at parts of rows, without parts at their ends."""
        if self.lever is not None and part is not None:
            return self.lever.at(rows, part)
        return self.tool if self.tool is None or self.tool.ndim == 1 else self.tool[rows]

    def tool_before(self, rows: Ints) -> Floats | None:
        """Return the tools where rows begin."""
        if self.lever is not None:
            return self.lever.starts[rows]
        return self.tool_of(rows)

    @property
    def first_tool(self) -> Floats | None:
        """The tool before the first row."""
        if self.lever is not None:
            return self.lever.starts[:1]
        return self.tool if self.tool is None or self.tool.ndim == 1 else self.tool[:1]
