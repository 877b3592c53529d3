"""A restart at a line: what was before it, whether it is safe, and the proof that it is."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location, UsageError, VerificationError
from gcxform.dialect.dialect import INCH, Dialect
from gcxform.modal.frame_state import FrameState
from gcxform.modal.interpreter import Interpreted, Interpreter
from gcxform.modal.meaning.tables import CYCLES, GROUPS, NUMBER, code_of
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading, State
from gcxform.resume.memory import Memory, shapes_seen
from gcxform.resume.preamble import Approach, Preamble
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source, before_corners
from gcxform.system.arrays import Flags
from gcxform.toolpath.path import Kind, Toolpath
from gcxform.values import dataclass

CLOSE = 1e-6  # mm, degrees: positions are written with so many decimals
ARCS = ("G2", "G3")
PLANE = "a tilted plane is in force"
COMPARED = ("kind", "plane", "feed_mode", "source", "nth", "form", "side")
MEASURED = ("end", "centre", "sweep", "feed", "radius", "control")  # the feed where it cuts


@dataclass
class Restart:
    """Reads a program up to a line, from 1, and says how to begin there.

    Raises InputError (GX732) where no restart is safe, and whatever reading refuses before the
    line; UsageError if there is no such line.
    """

    dialect: type[Dialect]
    source: Source
    reading: Reading
    line: int

    def __post_init__(self) -> None:
        self.axes = self.reading.axes_of(self.source, self.dialect)
        self.placed: set[str] = set()  # axes that are programmed before the line
        self.fed = False  # whether a feed is
        self.reader = WindowReader(self.dialect)
        self.interpreter = self._interpreter(self.reading)
        self.memory = Memory(self.dialect)
        self.text, self.rest = self._read()
        self.state = copy.deepcopy(self.interpreter.state)
        self.used = self._used_after()
        self._refuse_if_unsafe()

    def _interpreter(self, reading: Reading) -> Interpreter:
        return Interpreter(self.dialect, reading, self.axes, self.source.name)

    # --- before the line ---

    def _read(self) -> tuple[str, list[bytes]]:
        """Interpret what is before the line; return its text and the windows from it on."""
        line, rest = "", list[bytes]()
        for text in self.source.windows():
            if rest:
                rest.append(text)
                continue
            first = self.reader.lines
            window = self.reader.read(text)
            index = self.line - 1 - first
            if index >= len(window):
                self._before(window)
                continue
            start = int(window.start[index])
            line = window.line(index).decode("latin-1")
            if before_corners(text, start) != start:
                self.text = line
                raise self.refusal("no restart is safe here: the block before ends in a corner")
            self.reader.lines = first
            if start:
                self._before(self.reader.read(text[:start]))
            rest.append(text[start:])
        if not rest:
            message = f"{self.source.name} has {self.reader.lines} lines and no line {self.line}"
            raise UsageError.one("GX731", message)
        return line, rest

    def _before(self, window: Window) -> None:
        """Take a window before the line into account."""
        found = self.interpreter.interpret(window, self.reader.table)
        shapes, meanings = self.reader.shapes.shapes, self.reader.table.meanings
        for number, first in shapes_seen(found.shape):
            at = window.first_line + first + 1
            self.memory.look(shapes[number], meanings[number], at)
            open_ = meanings[number].deleted or meanings[number].asides
            if open_ and not self.reading.blocks_with_a_slash(self.dialect):
                self.memory.refuse(at, "a switch decides whether a block before is executed")
            self.placed.update(meanings[number].axes)
            self.fed |= "F" in meanings[number].slots
        grammar = self.dialect.load_grammar()
        inch = found.modes.inch
        for event in found.path.events:
            line = event.line - window.first_line
            if meanings[int(found.shape[line])].call:
                continue  # what it has switched on nobody knows: `look` says so
            block = grammar.parse(window.line(line).decode("latin-1"))
            self.memory.take(event, block, bool(inch[line]))

    # --- whether it is safe ---

    def refusal(self, message: str, hint: str = "") -> InputError:
        """Return the error that says why no restart is safe at the line."""
        where = Location(self.source.name, self.line, 1, self.text, max(1, len(self.text)))
        return InputError((Diagnostic("GX732", message, where, hint),))

    def _refuse_if_unsafe(self) -> None:
        state = self.state
        if self.memory.unsafe is not None:
            line, reason = self.memory.unsafe
            raise self.refusal(f"no restart is safe here: in line {line} {reason}")
        frames = state.frames
        if frames.turns or frames.polar or any((*frames.local, *frames.preset)):
            line, reason = self.memory.turned
            raise self.refusal(f"no restart is safe here: in line {line} {reason}")
        if state.ended:
            raise self.refusal("the program has ended before this line")
        if state.frames.plane is not None:
            what, end = ("a tip is followed", "G49") if state.frames.plane.tip else (PLANE, "G69")
            message = f"no restart is safe here: {what}, which is not restated"
            raise self.refusal(message, f"begin where it begins, or behind {end}")
        if state.groups["cutter-comp"] or state.side:
            message = (
                "no restart is safe here: cutter compensation is on, and looks at moves before"
            )
            raise self.refusal(message, "begin at the move that begins compensation")
        if state.memory["cycle"] in CYCLES or state.groups["motion"] in CYCLES:
            message = "no restart is safe here: a canned cycle is in force, whose words stay"
            raise self.refusal(message, "begin at the block that calls the cycle")
        needed = self.placed | {axis for axis in "XYZ" if axis in self.used}
        unknown = [axis for axis in self.unknown() if axis in needed]
        if unknown:
            names = ", ".join(unknown)
            message = f"no restart is safe here: where {names} stands is not known"
            hint = "begin at a line after its first absolute move, or at the tool change before"
            raise self.refusal(message, hint)
        self._refuse_skipped()

    def unknown(self) -> list[str]:
        """Return the axes whose position is not known at the line."""
        places = zip(self.axes, self.state.position.tolist(), strict=True)
        return [axis for axis, place in places if np.isnan(place)]

    def _used_after(self) -> set[str]:
        """Return the axes that are programmed from the line on."""
        used: set[str] = set()
        reader = WindowReader(self.dialect)
        for text in self.rest:
            window = reader.read(text)
            reader.table.update()
            for number, _ in shapes_seen(window.shape):
                used.update(reader.table.meanings[number].axes)
        return used

    def _refuse_skipped(self) -> None:
        skips = self.reading.blocks_with_a_slash(self.dialect) == "skip"
        if skips and self.text.lstrip().startswith("/"):
            raise self.refusal("the block is skipped", "begin at a block that is executed")

    def motion(self) -> str:
        """Return the motion code to leave behind. Raises InputError if it cannot be stated."""
        code = code_of("motion", self.state.groups["motion"])
        if code == "G80" and "motion" not in self.state.stated:
            return ""
        if code in ARCS:
            if self._next_block_hangs_on_motion():
                message = f"{code} is in force, which no block can state without an arc"
                raise self.refusal(message, f"begin at the block in which {code} is written")
            return "G1"
        return code

    def _next_block_hangs_on_motion(self) -> bool:
        """Whether the first block that moves says no motion code."""
        reader = WindowReader(self.dialect)
        for text in self.rest:
            window = reader.read(text)
            reader.table.update()
            shape = window.shape
            stated = reader.table.groups[shape, GROUPS.index("motion")] >= 0
            uses = reader.table.flag("moves", shape) | reader.table.flag("has_centre", shape)
            if (stated | uses).any():
                return not bool(stated[int(np.argmax(stated | uses))])
        return False

    # --- how to begin ---

    def preamble(self, clearance: float | None, feed: float | None, change_tool: bool) -> Preamble:
        """Return the blocks that begin at the line.

        `clearance`: Z in mm at which everything is clear, None: the axes are in place already.
        `feed`: mm/min of the plunge, None: the feed in force.
        """
        approach = None if clearance is None else self._approach(clearance, feed)
        motion = self.motion()
        return Preamble(
            self.dialect, self.axes, self.state, self.memory, motion, approach, change_tool
        )

    def _approach(self, clearance: float, feed: float | None) -> Approach:
        words = self.state.frames.frame().words(self.state.position[None, :])[0]
        height = float(words[self.axes.index("Z")])
        if np.isnan(height):
            raise self.refusal("no restart is safe here: where Z stands is not known")
        if clearance < height:
            message = f"the clearance, Z{clearance:g}, is below Z{height:g}, where the line begins"
            raise self.refusal(message, f"--clearance {height:g}mm or more")
        if feed is None:
            per_minute = self.state.groups["feed-mode"] == NUMBER["G94"]
            if not (per_minute and self.state.feed > 0):
                raise self.refusal(
                    "at which feed to plunge? No feed per minute is in force",
                    "--plunge 100 says it in mm/min",
                )
            feed = self.state.feed * self.state.feed_unit
        return Approach(clearance, feed)

    # --- the proof ---

    def prove(self, preamble: Preamble, text: bytes) -> Diagnostic | None:
        """Run the rest of the program both ways and compare; return what is not proved, if any.

        Raises VerificationError if the two differ, InputError if the line itself is refused.
        """
        other = self._after(preamble, text)
        mine, theirs = self.interpreter, other
        self.reader.lines = self.line - 1
        for part in self.rest:
            window = self.reader.read(part)
            before = copy.deepcopy(mine.state)
            try:
                expected = mine.interpret(window, self.reader.table)
            except InputError as error:
                mine.state = before
                open_feed = preamble.approach is not None and self.fed
                open_feed &= bool(np.isnan(self.state.feed))
                return self._up_to(error, window, (mine, theirs), open_feed)
            found = theirs.interpret(window, self.reader.table)
            self._compare(expected, found)
        return None

    def _after(self, preamble: Preamble, text: bytes) -> Interpreter:
        """Return an interpreter that has read the preamble."""
        reading = replace(self.reading, start={})
        other = self._interpreter(reading)
        if preamble.approach is None:
            other.state.position[:] = self.state.position
            tool = other.state.frames.in_spindle
            other.state.frames = replace(self.state.frames, known=True, in_spindle=tool)
        else:
            other.state.frames = self._counted_alike(other.state.frames)
        if not preamble.change_tool:
            tool = self.state.frames.in_spindle
            other.state.frames = replace(other.state.frames, in_spindle=tool)
            other.state.tool = self.state.tool
        reader = WindowReader(self.dialect)
        other.interpret(reader.read(text), reader.table)
        if "frame" not in self.state.stated:
            other.state.frames = replace(other.state.frames, known=self.state.frames.known)
        lost = np.isnan(other.state.position) & ~np.isnan(self.state.position)
        if preamble.approach is None and lost.any():
            names = ", ".join(a for a, gone in zip(self.axes, lost.tolist(), strict=True) if gone)
            message = f"the blocks of the restart move {names}, and to where is not known"
            raise self.refusal(message, "--clearance 50mm, with a Z that is clear of all")
        self._compare_states(self.state, other.state, preamble)
        other.state.percents = self.state.percents
        other.state.rapid = self.state.rapid
        return other

    def _counted_alike(self, frames: FrameState) -> FrameState:
        """Return frames of a start whose positions count from where those of the program do.

        That is the work offset which the program states first, and not the one of the preamble: it
        is said to have been given, no times anew.
        """
        first = self.state.frames.first
        counted = frames.starting_in(first, self.reading.work_offsets, True)
        return replace(counted, work=frames.work, given={first: 0})

    def _compare_states(self, mine: State, other: State, preamble: Preamble) -> None:
        """Raise VerificationError unless the two states mean the same."""
        groups = dict(mine.groups)
        if preamble.motion == "G1":
            groups["motion"] = NUMBER["G1"]
        if not preamble.motion:
            groups["motion"] = other.groups["motion"]
        same = groups == other.groups and mine.frames.frame() == other.frames.frame()
        same &= bool(np.allclose(mine.position, other.position, rtol=0, atol=CLOSE, equal_nan=True))
        if mine.feed > 0 and mine.groups["feed-mode"] != NUMBER["G93"]:
            same &= bool(np.isclose(mine.feed, other.feed)) and mine.feed_unit == other.feed_unit
        if not same:
            raise self._difference(self.line)

    def _difference(self, line: int) -> VerificationError:
        message = f"the restart does not do in line {line} what the program does"
        return VerificationError.one("GX601", message, Location(self.source.name, line))

    def _up_to(
        self, error: InputError, window: Window, both: tuple[Interpreter, ...], open_feed: bool
    ) -> Diagnostic:
        """Compare the lines before the one that is refused; return a note about where it ends.

        `open_feed`: a feed was in force that nobody knows, and the plunge has another one.
        """
        mine, theirs = both
        first = error.diagnostics[0]
        line = first.where.line if first.where else self.line
        if line <= self.line:
            raise error
        count = line - 1 - window.first_line
        if count > 0:
            self.reader.lines = window.first_line
            before = self.reader.read(window.text[: int(window.start[count])])
            expected = mine.interpret(before, self.reader.table)
            self._compare(expected, theirs.interpret(before, self.reader.table))
        if mine.state.parameters != theirs.state.parameters:
            raise self.refusal(
                "no restart is safe here: the program has set parameters before, which are not "
                f"restated, and line {line}, which is not read, may take them"
            )
        if open_feed and np.isnan(mine.state.feed):
            raise self.refusal(
                "no restart is safe here: which feed is in force nobody knows, the restart plunges "
                f"with its own, and line {line}, which is not read, may take it",
                "write F behind what has changed units or the feed mode",
            )
        hint = "from there on the program does what it did, if all is as it was in this line"
        message = f"compared up to line {line - 1}: line {line} is not read ({first.code})"
        return replace(first, code="GX732", message=message, hint=hint)

    def _compare(self, expected: Interpreted, found: Interpreted) -> None:
        """Raise VerificationError unless two paths of the same lines are the same."""
        for line in _differences(expected.path, found.path):
            raise self._difference(line)


def _other_frames(one: Toolpath, other: Toolpath) -> Flags:
    """Return the rows (n,) with other frames; the two paths may number theirs differently."""
    wrong = [[mine != theirs for theirs in other.frames] for mine in one.frames]
    shape = len(one.frames), len(other.frames)
    return np.array(wrong, np.bool_).reshape(shape)[one.frame, other.frame]


def _differences(one: Toolpath, other: Toolpath) -> Iterator[int]:
    """Yield lines, from 1, in which two paths differ."""
    if len(one) != len(other):
        yield int(min(one.source[:1].tolist() + other.source[:1].tolist())) + 1
        return
    wrong = _other_frames(one, other)
    for name in COMPARED:
        wrong |= getattr(one, name) != getattr(other, name)
    for name in MEASURED:
        a, b = getattr(one, name), getattr(other, name)
        close = np.isclose(a, b, rtol=1e-9, atol=INCH * CLOSE, equal_nan=True)
        if name == "feed":
            close |= one.kind == Kind.RAPID
        wrong |= ~close.all(axis=tuple(range(1, close.ndim)))
    yield from (one.source[np.flatnonzero(wrong)] + 1).tolist()
    yield from (a.line + 1 for a, b in zip(one.events, other.events, strict=False) if a != b)
    if len(one.events) != len(other.events):
        yield int(one.source[0]) + 1 if len(one) else one.blocks.first + 1
