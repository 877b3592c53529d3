"""Where LinuxCNC stands while it executes: #5420 to #5428, `#<_x>`, `#<_metric>`, polar words.

The blocks that have been executed so far are read as any program is; they end at a position and in
modes. What the names are worth was asked of LinuxCNC's interpreter (`tests/facts`).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.dialect.arithmetic import Arithmetic, NoValueError
from gcxform.dialect.dialect import INCH, LINEAR
from gcxform.flow.execution import Execution
from gcxform.flow.residual import Edit
from gcxform.flow.text import decimal
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.meaning.tables import NUMBER
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import State
from gcxform.syntax.tree import Block, Word

FIRST = 5420
FEEDS = {"_inverse_time": "G93", "_units_per_minute": "G94", "_units_per_rev": "G95"}
RADIUS, ANGLE, REPEATS = "@", "^", "L"
ZERO = 1e-6
"""A radius, in the unit of the program, at which rounding alone may say what the angle is."""
AXES_OF_PLANE = frozenset("XY")


def beside_zeros(arithmetic: Arithmetic) -> Arithmetic:
    """Return the arithmetic of a program that has read a place at 0.

    LinuxCNC keeps the minus of X-0 there, which is not followed; no angle may hang on it.
    """
    plain = arithmetic.functions["ATAN/"]

    def angle(y: float, x: float) -> float:
        if y == 0 and x <= 0:
            raise NoValueError("this angle hangs on the sign of a zero, which is not certain")
        return float(plain(y, x))

    return replace(arithmetic, functions={**arithmetic.functions, "ATAN/": angle})


class Places:
    """Reads the executed blocks as they come."""

    def __init__(self, program: Execution) -> None:
        self.program = program
        self.reader = WindowReader(program.dialect)
        self.interpreter = Interpreter(program.dialect, program.reading, file=program.listing.file)
        self.seen = 0

    def now(self) -> State:
        """Return the state after the executed blocks. Raises InputError."""
        self.interpreter.undecided = self.program.undecided()
        text = b"".join(self.program.text[self.seen :])
        self.seen = len(self.program.text)
        if text:
            try:
                self.interpreter.interpret(self.reader.read(text), self.reader.table)
            except InputError as error:
                raise self.program.located(error) from None
        return self._where_ways_meet(self.interpreter.state)

    def _where_ways_meet(self, state: State) -> State:
        """Return the state before the next block: another way may come in there."""
        letters = self.interpreter.undecided.lost.get(self.program.blocks, "")
        if not letters:
            return state
        position = state.position.copy()
        position[[k for k, axis in enumerate(self.axes) if axis in letters]] = math.nan
        return replace(state, position=position, feed_lost=state.feed_lost or "F" in letters)

    @property
    def axes(self) -> str:
        """The axes whose positions are known, in order."""
        return self.interpreter.axes

    def words(self) -> dict[str, float]:
        """Return where the axes stand, as the words of a block would say it; nan: not known."""
        state = self.now()
        frame = state.frames.frame()
        axes = self.interpreter.axes
        if frame.diameter or state.side or set(frame.origin) != {state.frames.first}:
            return dict.fromkeys(axes, math.nan)
        words = frame.words(state.position[np.newaxis])[0]
        inch = INCH if state.groups["units"] else 1.0
        return {
            axis: float(word) / (inch if axis in LINEAR else 1.0)
            for axis, word in zip(axes, words, strict=True)
        }

    def parameters(self) -> dict[int | str, float]:
        """Return the parameters that say where axes stand, and the modes; nan: not known."""
        words, state = self.words(), self.now()
        found: dict[int | str, float] = {FIRST + k: word for k, word in enumerate(words.values())}
        named = {f"_{axis.lower()}": word for axis, word in words.items()}
        return found | named | self._modes(state)

    def _modes(self, state: State) -> dict[str, float]:
        """Return what the names of modes are worth: 1 where one is in force, F and S as written.

        Units and feed modes are the same on all ways on which a program goes on (`CARRIED`).
        """
        inch, incremental = state.groups["units"], state.groups["distance"]
        same = {
            "_imperial": bool(inch),
            "_metric": not inch,
            **{name: state.groups["feed-mode"] == NUMBER[code] for name, code in FEEDS.items()},
        }
        other = {"_incremental": bool(incremental), "_absolute": not incremental}
        known = math.nan if state.lost_modes else 1.0
        open_ = math.nan if self.interpreter.undecided else known
        timed = state.groups["feed-mode"] == NUMBER["G93"]  # F is what it comes to in G94 there
        feed = math.nan if state.feed_lost or timed else state.feed
        values = {name: on * known for name, on in same.items()}
        return values | {name: on * open_ for name, on in other.items()} | {"_feed": feed}

    # --- polar words ---

    def polar_edits(self, block: Block) -> list[Edit]:
        """Return X and Y in place of `@` and `^`; nothing for a block without them."""
        words = {w.address: w for w in block.words if w.address in (RADIUS, ANGLE)}
        if not words:
            return []
        incremental = self._refuse(block, [*words.values()])
        x, y = self._step(block, words) if incremental else self._point(block, words)
        first, *rest = sorted(words.values(), key=lambda word: word.start)
        return [(first.start, first.end, f"X{decimal(x)} Y{decimal(y)}")] + [
            (word.start, word.end, "") for word in rest
        ]

    def _refuse(self, block: Block, words: list[Word]) -> bool:
        """Refuse polar words that the control does not take, or that are not resolved.

        Return whether they count from where the axes stand.
        """
        place = words[0].start, words[0].end
        if any(word.address in AXES_OF_PLANE for word in block.words):
            raise self.program.refusal("GX203", "X or Y beside polar words", place=place)
        groups = self.program.listing.meaning(self.program.line).groups
        if "non-modal" in groups:
            message = f"{groups['non-modal']} takes no polar words"
            raise self.program.refusal("GX203", message, place=place)
        state = self.now()
        if groups.get("plane", "G17") != "G17" or state.groups["plane"] != NUMBER["G17"]:
            raise self.program.refusal("GX203", "polar words are of G17 alone", place=place)
        named = groups.get("distance")
        incremental = named == "G91" if named else bool(state.groups["distance"])
        if incremental and self.program.number(block, REPEATS, 1.0) != 1:
            message = "polar words in G91 count anew for each hole of L, which is not followed"
            hint = "give each hole a block of its own"
            raise self.program.refusal("GX210", message, hint, place=place)
        if state.frames.diameter or "units" in groups or "frame" in groups:
            message = "polar words are resolved in G8, in the unit and frame before"
            raise self.program.refusal("GX210", message, place=place)
        return incremental

    def _point(self, block: Block, words: dict[str, Word]) -> tuple[float, float]:
        """Return the point that polar words name; one of them that is missing is as before."""
        radius = self.program.number(block, RADIUS)
        angle = self.program.number(block, ANGLE)
        if len(words) < 2:
            x, y = self._here(words, ANGLE not in words)
            radius = math.hypot(x, y) if RADIUS not in words else radius
            angle = math.degrees(math.atan2(y, x)) if ANGLE not in words else angle
        turned = math.radians(angle)
        return radius * math.cos(turned), radius * math.sin(turned)

    def _step(self, block: Block, words: dict[str, Word]) -> tuple[float, float]:
        """Return the way in G91: to the radius and the angle of here, with the words added."""
        x, y = self._here(words, True)
        radius = math.hypot(x, y) + self.program.number(block, RADIUS, 0.0)
        turned = math.atan2(y, x) + math.radians(self.program.number(block, ANGLE, 0.0))
        return radius * math.cos(turned) - x, radius * math.sin(turned) - y

    def _here(self, words: dict[str, Word], has_angle: bool) -> tuple[float, float]:
        """Return X and Y of where the axes stand; `has_angle`: refuse the zero, which has none."""
        here = self.words()
        x, y = here["X"], here["Y"]
        if math.isnan(x + y) or (has_angle and math.hypot(x, y) < ZERO):
            word = next(iter(words.values()))
            message = f"{word.address} needs a point away from the zero to start from"
            raise self.program.refusal("GX220", message, place=(word.start, word.end))
        return x, y
