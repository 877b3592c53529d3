"""Rounds of a loop as columns: each line of its body is computed for many rounds at once.

A body without calls, jumps and other flow words does the same in every round, with other numbers.
What a parameter is worth in a round follows from the rounds before: from a value computed of others
(`#2=[#1*2]`), or from its own with something added (`#1=[#1+E]`), whose sums are made in the order
in which the control makes them. So all numbers, and the text of each line, are those of one round
after the other, bit by bit. Whatever is not certain to be so (`NoColumnError`) is executed as any
line is: how it is refused is told there alone.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.dialect.arithmetic import Key
from gcxform.dialect.null import Null
from gcxform.flow.execution import Execution
from gcxform.flow.round_body import Body, Repeated, made
from gcxform.flow.text import assignment
from gcxform.flow.walk import Made
from gcxform.modal.expressions.compiled import NO_VALUE, Compiled, NoColumnError
from gcxform.syntax.tree import Word
from gcxform.system.arrays import Floats
from gcxform.system.limits import limits

WAIT = 8  # rounds that are executed one by one before
FEWEST, GROWS, MOST = 32, 4, 8192  # rounds at once: at first, how they grow, and at most
NOT_SO = (*NO_VALUE, InputError)


class Rounds:
    """Those of one execution.

    waits   the rounds of each loop, by its last line, that are still executed one by one
    sizes   how many are tried at once
    bodies  what a loop does in every round
    """

    def __init__(self, run: Execution) -> None:
        self.run = run
        self.waits: dict[int, int] = {}
        self.sizes: dict[int, int] = {}
        self.bodies: dict[int, Body | None] = {}

    def go(self, loop: Repeated, most: int = MOST) -> int:
        """Execute rounds of a loop at whose begin the run stands; return how many."""
        wait = self.waits.get(loop.last, WAIT)
        if wait > 0 or not self.run.steady():
            self.waits[loop.last] = wait - 1
            return 0
        body = self._body(loop)
        done = self._tried(loop, body, most) if body is not None else 0
        if done < WAIT:
            self.waits[loop.last] = 16 * WAIT
        return done

    def _tried(self, loop: Repeated, body: Body, most: int) -> int:
        left = max(0, limits().steps - self.run.steps) // body.special
        size = min(self.sizes.get(loop.last, FEWEST), most, left)
        while size >= WAIT:
            try:
                done = Columns(self.run, loop, body, size).execute()
            except NOT_SO:
                size //= 2 * GROWS
                continue
            grown = size * GROWS if done == size else max(FEWEST, 2 * done)
            self.sizes[loop.last] = min(grown, MOST)
            return done
        return 0

    def _body(self, loop: Repeated) -> Body | None:
        """Return what a loop does in every round; None where it cannot be said once."""
        if loop.last not in self.bodies:
            try:
                self.bodies[loop.last] = made(self.run, loop)
            except NOT_SO:
                self.bodies[loop.last] = None
        return self.bodies[loop.last]


# --- many of them ---


class Columns:
    """Rounds of a loop at once, from what the parameters are worth before: `size` are tried.

    A value is asked for by its parameter and the line that reads it.
    """

    def __init__(self, run: Execution, loop: Repeated, body: Body, size: int) -> None:
        self.run = run
        self.loop = loop
        self.body = body
        self.size = size
        self.puts = {put.key: put for put in body.puts}
        self.found: dict[Key, tuple[Floats, Floats]] = {}
        self.open: set[Key] = set()

    def execute(self) -> int:
        """Execute the rounds that go on, and return how many. Raises NO_VALUE, nothing done."""
        rounds = self._goes_on()
        values = {key: self.both(key) for key in self.puts}
        words = {
            id(word): self._spelled(word, line, function)[:rounds]
            for line, word, function in self.body.words
        }
        for put in self.body.puts:
            self.run.lasting.outputs.refuse_levels(put.key)
        if rounds:
            ends = {key: after[:rounds].tolist() for key, (_, after) in values.items()}
            self._take(rounds, words, ends)
        return rounds

    def _goes_on(self) -> int:
        """Return how many rounds are begun, or gone on behind."""
        if self.body.condition is None:
            return self.size
        line = self.loop.last if self.loop.behind else self.loop.begin
        holds = self._column(self.body.condition, line) != 0
        return self.size if holds.all() else int(np.argmin(holds))

    def _column(self, function: Compiled, line: int) -> Floats:
        found = np.asarray(function(Seen(self, line), ()), np.float64)
        if not np.isfinite(found).all():
            raise NoColumnError
        return found if found.shape == (self.size,) else np.full(self.size, found)

    def both(self, key: Key) -> tuple[Floats, Floats]:
        """Return what a parameter is worth before its line sets it in each round, and behind."""
        if key in self.found:
            return self.found[key]
        if key in self.open:
            raise NoColumnError
        self.open.add(key)
        put, start = self.puts[key], self.run.parameters.get(key, np.nan)
        if put.added is None:
            after = self._column(put.value, put.line)
            before = np.concatenate([[start], after[:-1]])
        else:
            added, sign = put.added
            every = np.concatenate([[start], sign * self._column(added, put.line)])
            with np.errstate(all="ignore"):
                every = np.add.accumulate(every)
            before, after = every[:-1], every[1:]
            if not np.isfinite(after).all():
                raise NoColumnError
        self.open.discard(key)
        self.found[key] = before, after
        return before, after

    def seen(self, key: Key, line: int, default: Any) -> Any:
        """Return what a parameter is worth in a line: a column, or what it was before."""
        put = self.puts.get(key)
        if put is None:
            return self.run.parameters.get(key, default)
        if put.line < line:
            return self.both(key)[1]
        start = self.run.parameters.get(key, np.nan)
        if not -np.inf < start < np.inf or isinstance(start, Null):
            raise NoColumnError
        return self.both(key)[0]

    def _spelled(self, word: Word, line: int, function: Compiled) -> list[str]:
        """Return the text of a word in every round."""
        self.run.line = line
        values = self._column(function, line).tolist()
        if self.run.rounds_openly(word):
            raise NoColumnError
        return self.run.spelled(word, values)

    # --- what is left of them ---

    def _take(self, rounds: int, words: dict[int, list[str]], ends: dict[Key, list[float]]) -> None:
        """Do what the rounds do to the run."""
        run, loop, body = self.run, self.loop, self.body
        first = len(run.walked)
        steps = np.tile(body.steps, (rounds, 1))
        steps[:, 2] += run.blocks + np.repeat(np.arange(rounds) * len(body.blocks), len(body.steps))
        steps[:, 3:] = len(run.calls), run.levels_of_values()
        run.walked.extend(steps)
        self._account(rounds, first, ends)
        lines = np.tile(np.array(body.blocks, np.int64), rounds)
        run.put(self._text(rounds, words, ends).encode("latin-1"), lines)
        run.steps += rounds * body.special
        run.times[loop.begin : loop.last + 1] += rounds
        run.parameters.update((key, column[-1]) for key, column in ends.items())
        run.changes += rounds
        run.rounds[loop.last] = run.changes

    def _account(self, rounds: int, first: int, ends: dict[Key, list[float]]) -> None:
        body, rows = self.body, self.body.steps[:, 0].tolist()
        at = [first + rows.index(put.line) for put in body.puts]
        columns = [ends[put.key] for put in body.puts]
        made = [
            (put.line, Made(step + k * len(rows), put.key, column[k]))
            for k in range(rounds)
            for put, step, column in zip(body.puts, at, columns, strict=True)
        ]
        self.run.lasting.account_all(made)

    def _text(self, rounds: int, words: dict[int, list[str]], ends: dict[Key, list[float]]) -> str:
        """Return the text of the rounds."""
        body, form, columns = self.body, list[str](), list[list[str]]()
        for part in body.parts:
            if isinstance(part, str):
                form.append(part.replace("%", "%%"))
                continue
            form.append("%s")
            if isinstance(part, Word):
                columns.append(words[id(part)])
            else:
                arithmetic, key = self.run.arithmetic, part.key
                columns.append([assignment(key, value, arithmetic) for value in ends[key]])
        round_ = "".join(form)
        rows = zip(*columns, strict=True) if columns else ((),) * rounds
        return "".join([round_ % row for row in rows])


class Seen:
    """The parameters as a line of the loop reads them."""

    def __init__(self, columns: Columns, line: int) -> None:
        self.columns = columns
        self.line = line

    def get(self, key: Key, default: Any, /) -> Any:
        """Return a column, or a number."""
        return self.columns.seen(key, self.line, default)
