"""The blocks that bring a control into the state in which a program is at a line.

Each modal group has its place in `Preamble.blocks`: modes that the approach needs, tool, spindle
and coolant, the approach, then the modes that the approach has changed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcxform.dialect.dialect import INCH, LINEAR, Dialect
from gcxform.emit.numbers import MOST_DECIMALS, text_of
from gcxform.modal.meaning.tables import NUMBER, code_of
from gcxform.modal.state import State
from gcxform.resume.memory import Memory
from gcxform.values import dataclass

EXACT = 1e-9  # mm, degrees: closer positions are the same


@dataclass(frozen=True)
class Approach:
    """How to come to where the program is: Z (mm) that is clear, feed (mm/min) of the plunge."""

    clearance: float
    feed: float


@dataclass(frozen=True)
class Preamble:
    """The state at a line, what else was switched on, and what is wanted.

    `motion` is the motion code to leave behind, "" for none. Without an approach the axes are taken
    to stand in their places.
    """

    dialect: type[Dialect]
    axes: str
    state: State
    memory: Memory
    motion: str
    approach: Approach | None
    change_tool: bool = True

    def blocks(self) -> Iterator[str]:
        """Yield the blocks, without line ends."""
        inch = self._approach_in_inches()
        yield from self._head(inch)
        yield from self._kept(inch)
        yield from self._tool()
        yield from self._spindle()
        if self.approach is not None:
            yield from self._moves(self.approach, inch)
        yield from self._tail(inch)

    def _in(self, group: str) -> str:
        work = group == "frame"
        return self.state.frames.work if work else code_of(group, self.state.groups[group])

    def _stated(self, *groups: str) -> list[str]:
        """Return the codes in force of the groups that the program states before the line."""
        return [self._in(group) for group in groups if group in self.state.stated]

    def _head(self, inch: bool) -> Iterator[str]:
        """Yield units, plane, G90, feed per minute, arc distance mode and work offset."""
        units = [code_of("units", int(inch))] if "units" in self.state.stated else []
        feed = ["G94"] if "feed-mode" in self.state.stated else []
        codes = [*units, *self._stated("plane"), "G90", *feed, *self._stated("arc-distance")]
        codes += self._stated("cutter-comp")
        yield " ".join([*codes, *self._stated("frame")])

    def _kept(self, inch: bool) -> Iterator[str]:
        """Yield what is kept as it was written, in the unit in which it was written."""
        now = inch
        for text, was_inch in self.memory.codes.values():
            if was_inch != now and "units" in self.state.stated:
                yield code_of("units", int(was_inch))
                now = was_inch
            yield text
        if now != inch:
            yield code_of("units", int(inch))

    def _tool(self) -> Iterator[str]:
        """Yield the tool change, or say which tool must be there; the tool that waits; a length."""
        loaded, ready = self.memory.loaded, self.memory.ready
        if loaded is not None:
            change = " ".join(part for part in loaded if part)
            yield change if self.change_tool else f"({loaded[0] or 'TOOL'} MUST BE IN THE SPINDLE)"
        if ready is not None and (loaded is None or loaded[0] != ready):
            yield ready
        if self.memory.length and self.approach is None:
            yield self.memory.length  # behind the tool: G43 may take the one in the spindle

    def _spindle(self) -> Iterator[str]:
        """Yield speed and direction, then coolant."""
        parts = (self.memory.speed, self.memory.spindle)
        if said := " ".join(part for part in parts if part):
            yield said
        yield from self.memory.coolant

    def places_text(self) -> str:
        """Return where the axes stand, as words."""
        inch = self.state.groups["units"] == 1
        return " ".join(self._word(a, v, inch) for a, v in self._places().items())

    # --- the approach ---

    def _approach_in_inches(self) -> bool:
        """Whether the position is written in inches: where millimetres do not hold it exactly."""
        here = self.state.groups["units"] == 1
        if "units" not in self.state.stated:
            return here
        return not here if self._error(here) > self._error(not here) else here

    def _places(self) -> dict[str, float]:
        """Return where the axes stand that are known, by letter."""
        words = self.state.frames.frame().words(self.state.position[None, :])[0]
        known = zip(self.axes, words.tolist(), strict=True)
        return {axis: place for axis, place in known if not math.isnan(place)}

    def _error(self, inch: bool) -> float:
        """Return by how much (mm) positions are missed in a unit."""
        step = 10.0**-MOST_DECIMALS * (INCH if inch else 1.0)
        linear = [value for axis, value in self._places().items() if axis in LINEAR]
        missed = max((abs(v - round(v / step) * step) for v in linear), default=0.0)
        return 0.0 if missed < EXACT else missed

    def _word(self, axis: str, value: float, inch: bool) -> str:
        """Return a position as a word, with the decimals it needs."""
        if inch and axis in LINEAR:
            value /= INCH
        return axis + text_of(value, MOST_DECIMALS)

    def _moves(self, approach: Approach, inch: bool) -> Iterator[str]:
        """Yield Z up, the other axes, Z down at a feed."""
        places = self._places()
        length = [self.memory.length] if self.memory.length else []
        yield " ".join(["G0", *length, self._word("Z", approach.clearance, inch)])
        others = [self._word(a, v, inch) for a, v in places.items() if a != "Z"]
        if others:
            yield f"G0 {' '.join(others)}"
        feed = approach.feed / (INCH if inch else 1.0)
        yield f"G1 {self._word('Z', places['Z'], inch)} F{self._feed_text(feed, 3)}"

    def _feed_text(self, feed: float, decimals: int) -> str:
        return text_of(feed, decimals, point=self.dialect.point_rule.required)

    def _tail(self, inch: bool) -> Iterator[str]:
        """Yield feed mode and feed, units, distance mode and motion code of the line."""
        feed_inch = self.state.feed_unit == INCH
        known = self.state.feed > 0 and not self._inverse()
        stated = "units" in self.state.stated
        if known and feed_inch != inch and stated:
            yield code_of("units", int(feed_inch))
            inch = feed_inch
        if self.approach is None and self.motion == "G1" and self._inverse():
            yield f"G1 F{self._feed_text(1.0, 0)}"
        mode = [self._in("feed-mode")] if "feed-mode" in self.state.stated else []
        feed = [f"F{self._feed_text(self.state.feed, MOST_DECIMALS)}"] if known else []
        if said := [*mode, *feed]:
            yield " ".join(said)
        wanted = self.state.groups["units"] == 1
        if inch != wanted and stated:
            yield code_of("units", int(wanted))
        last = ["G91"] if self.state.groups["distance"] == NUMBER["G91"] else []
        motion = [self.motion] if self.motion and not self._moved_already() else []
        if said := [*last, *motion]:
            yield " ".join(said)

    def _moved_already(self) -> bool:
        """Whether G1 is in force: after the plunge, or because in G93 no block may say it alone."""
        return self.motion == "G1" and (self.approach is not None or self._inverse())

    def _inverse(self) -> bool:
        return self.state.groups["feed-mode"] == NUMBER["G93"]
