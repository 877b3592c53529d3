"""O-words that only the machine decides: they stay, and what they enclose is executed once.

An `if` whose condition is not known stays with all its clauses from there on, each executed from
what was known where it was asked. A loop of which only the machine knows how often it runs stays as
well: its lines are executed once, from what is true before each of its rounds. What that is comes
out at its end: what a round changes is not known before it, and the program is run again with that
(`Again`), until nothing more is found. A loop that only a `break` or `continue` inside such an `if`
leaves is one of these. Each stays with a label that the written blocks have nowhere else: where a
subprogram is called twice its labels would be.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import field, replace

from gcxform.dialect.arithmetic import Key
from gcxform.flow.constructs import Construct, Constructs, OWord
from gcxform.flow.execution import Execution
from gcxform.flow.forks import HINT, Arrival, Forks, differ
from gcxform.flow.loops_alike import LoopsAlike
from gcxform.flow.modes import StoredModes
from gcxform.flow.named_files import Subprograms
from gcxform.flow.rerun import Again, Changes
from gcxform.flow.run_state import UNKNOWN
from gcxform.flow.skipped_stretches import Effect, Join
from gcxform.syntax.grammar import span_of
from gcxform.syntax.tree import Statement
from gcxform.values import dataclass

LEAVING = frozenset({"break", "continue"})


class Structured(Execution):
    """A run of a language of constructs.

    counters  the rounds that are left of each `repeat` loop that runs, by its first line
    left      those that a jump has left
    """

    counters: dict[int, int]
    left: set[int]
    modes: StoredModes
    subprograms: Subprograms

    @property
    def words(self) -> dict[int, OWord]:
        """The O-word of each line that has one."""
        return self.subprograms.arranged.words

    @property
    def construct(self) -> dict[int, Construct]:
        """What each of these lines belongs to."""
        return self.subprograms.arranged.construct

    @abstractmethod
    def truth(self, word: OWord) -> bool | None:
        """Return whether a condition holds; None if only the machine knows."""

    @abstractmethod
    def unwind(self, depth: int) -> None:
        """Leave the calls in which the program may have ended, down to so many."""

    @abstractmethod
    def quirks(self) -> frozenset[int | str]:
        """Return what the control notes of loops that were left, and counts wrong by."""

    @abstractmethod
    def take_quirks(self, noted: frozenset[int | str]) -> None:
        """Take for noted what may have been."""


@dataclass(slots=True)
class Kept:
    """A construct that stays.

    begin           the block before which its rounds begin, and what is known there
    holds_at_first  whether it is a `while` whose condition is known to hold at first
    closing         the ways to the line that closes it
    following       those to its next clause
    exits           those behind it
    """

    construct: Construct
    label: str
    depth: int
    begin: int = 0
    known: dict[Key, float] = field(default_factory=dict)
    holds_at_first: bool = False
    closing: list[Arrival] = field(default_factory=list)
    following: list[Arrival] = field(default_factory=list)
    exits: list[Arrival] = field(default_factory=list)


class KeptOWords(Forks):
    """Those of one run; `inside` are those that are open, the outermost first."""

    run: Structured

    def __init__(self, run: Structured) -> None:
        super().__init__(run)
        self.inside: list[Kept] = []
        self.used: set[str] = set()
        self.largest = 0  # number of a label in what was `counted`, or given to what is kept
        self.counted: Constructs | None = None
        self.likenesses: tuple[Constructs, LoopsAlike] | None = None

    # --- the walk ---

    def begins(self) -> None:
        """Go on where a way comes in, if none leads to the next line."""
        if not self.over:
            return
        if not self.inside:
            self.run.ended = True
            return
        last = self.inside[-1]
        self.run.unwind(last.depth)
        lines = (n for n in last.construct.lines if self.run.words[n].keyword not in LEAVING)
        self.run.at = next(n for n in lines if n >= self.run.at or n == last.construct.last)

    def has(self, construct: Construct) -> bool:
        """Whether a construct is the innermost one that stays, and open."""
        return bool(self.inside) and self._is_of(self.inside[-1], construct)

    def _is_of(self, kept: Kept, construct: Construct) -> bool:
        same = kept.construct.lines[0] == construct.lines[0]
        return same and kept.depth == len(self.run.calls)

    def refuse(self, what: str) -> None:
        """Refuse what cannot be done where only the machine knows whether it is."""
        if self.inside:
            message = f"only the machine knows whether {what} here"
            raise self.run.refusal("GX220", message, HINT)

    def returns(self) -> bool:
        """Whether a subprogram would return here that the machine may go on with."""
        return any(each.depth == len(self.run.calls) for each in self.inside)

    def ends_here(self) -> None:
        """Note that the last executed line ends the program, if the machine comes to it."""
        self.ends.add(self.run.blocks - 1)
        self.over = True

    def carry(self, arrivals: Sequence[Arrival], line: int, stale: frozenset[Key]) -> None:
        """Note what is not known where ways meet, and the modes that come back by M72."""
        super().carry(arrivals, line, stale)
        modes = self.run.modes
        modes.open_up(modes.touched_by(self.since(min(each.line for each in arrivals))[0]))

    # --- branches ---

    def open_if(self, construct: Construct) -> None:
        """Keep an `if`, from the clause at which the run stands."""
        kept = self._opened(construct)
        self._write(kept, "if")
        kept.following = [self.here()]

    def clause(self) -> None:
        """Go on with the next clause, `elseif` or `else`."""
        run, kept = self.run, self.inside[-1]
        if not self.over:
            kept.closing.append(self.here())
        self.over = True
        self.meet(kept.following, run.line)
        self._write(kept)
        kept.following = [self.here()] if run.words[run.line].keyword == "elseif" else []

    def end_if(self) -> None:
        """Close an `if`."""
        kept = self.inside[-1]
        self._meet_if_any([*kept.closing, *kept.following])
        self._write(kept)
        self.inside.pop()

    def _meet_if_any(self, arrivals: list[Arrival]) -> None:
        if arrivals:
            self.meet(arrivals, self.run.line)

    # --- loops ---

    def is_kept(self) -> bool:
        """Whether the loop that begins here has been found to be one that the machine ends."""
        return self.run.line in self.run.settled.kept

    def is_found(self) -> bool:
        """Whether it was itself found to be one, and not one that is written alike."""
        return self.is_kept() and self.run.line not in self.run.settled.alike

    def is_like_one_that_begins(self) -> bool:
        """Whether it is written like one that was found, although it was known that it begins."""
        return self.run.settled.alike.get(self.run.line, False)

    def open_loop(self, construct: Construct) -> None:
        """Keep a loop, from its first line."""
        run, kind = self.run, construct.kind
        kept = self._opened(construct)
        kept.holds_at_first = kind == "while" and bool(run.truth(run.words[run.line]))
        found = run.settled.kept.get(run.line, Changes())
        if kind == "repeat":  # its count is computed once
            self._write(kept)
        run.parameters |= dict.fromkeys(found.keys, UNKNOWN)
        run.take_quirks(found.quirks)
        run.modes.open_up(found.groups)
        kept.begin, kept.known = run.blocks, dict(run.parameters)
        self.forgets[run.blocks] = found.keys | self.forgets.get(run.blocks, frozenset())
        self.note(run.blocks, run.blocks, Effect(found.letters))
        run.changes += 1
        if kind != "repeat":
            self._write(kept)
        kept.exits = [self.here()] if kind != "do" else []

    def run_again(self, construct: Construct) -> None:
        """Run the program again with a loop kept. Raises Again."""
        settled, first = self.run.settled, construct.lines[0]
        known = settled.kept.get(first, Changes())
        raise Again(replace(settled, kept={**settled.kept, first: known}))

    def close_loop(self) -> None:
        """Close the innermost loop: see what a round of it has changed."""
        run, kept = self.run, self.inside[-1]
        self._meet_if_any(kept.closing)
        self._write(kept)
        first = kept.construct.lines[0]
        if not self.over:
            self._settle(kept, first)
            self.joins.append(Join((run.blocks - 1,), kept.begin, first))
            self.over = kept.construct.kind == "while"
        self.inside.pop()
        self._meet_if_any(kept.exits)

    def _settle(self, kept: Kept, first: int) -> None:
        """Raise Again if a round changes more than was said before it."""
        run = self.run
        keys = {*kept.known, *run.parameters}
        changed = {k for k in keys if _other(kept.known.get(k), run.parameters.get(k))}
        effect = self.effect(kept.begin - 1)
        groups = run.modes.touched_by(self.since(kept.begin - 1)[0])
        now = Changes(frozenset(changed), effect.letters, groups, run.quirks())
        known = run.settled.kept.get(first, Changes())
        if now.within(known):
            self.perhaps.update(range(kept.begin, run.blocks) if effect.moves else ())
            self._take_others(kept, known)
            return
        all_ = {**run.settled.kept, first: known.with_more(now)}
        needed = run.settled.needed | now.keys
        likened = {line: held for line, held in run.settled.alike.items() if line != first}
        raise Again(replace(run.settled, kept=all_, needed=needed, alike=likened))

    def _take_others(self, kept: Kept, found: Changes) -> None:
        """Take those that are written like a loop for the machine's too. Raises Again."""
        settled = self.run.settled
        if kept.construct.kind != "while" or kept.construct.lines[0] in settled.alike:
            return
        others = self._alike().others(kept.construct.lines[0]) - settled.kept.keys()
        if others:
            all_ = {**settled.kept, **dict.fromkeys(others, found)}
            likened = {**settled.alike, **dict.fromkeys(others, kept.holds_at_first)}
            raise Again(replace(settled, kept=all_, alike=likened))

    def _alike(self) -> LoopsAlike:
        """Return the loops of all that has been called by how they are written."""
        arranged = self.run.subprograms.arranged
        if self.likenesses is None or self.likenesses[0] is not arranged:
            every = arranged.construct.values()
            self.likenesses = (arranged, LoopsAlike(self.run.listing, every))
        return self.likenesses[1]

    def leave(self, construct: Construct, keyword: str) -> bool:
        """Leave a loop that stays, or go to its end; return whether it stays.

        Raises Again for a loop that only the machine leaves here.
        """
        run = self.run
        inside = [each for each in self.inside if self._encloses(construct, each)]
        if not inside:
            return False
        kept = inside[0]
        if kept.construct.lines[0] != construct.lines[0]:
            self.run_again(construct)
        left = {n for n in run.counters if construct.lines[0] < n < construct.last}
        run.left |= left
        self._write(kept)
        (kept.exits if keyword == "break" else kept.closing).append(self.here())
        self.over = True
        return True

    def _encloses(self, construct: Construct, kept: Kept) -> bool:
        own = construct.lines[0] <= kept.construct.lines[0] <= construct.last
        return own and kept.depth == len(self.run.calls)

    # --- what is written ---

    def _opened(self, construct: Construct) -> Kept:
        """Return a construct that is kept from here on, with a label of its own."""
        run = self.run
        label = run.words[construct.lines[0]].label
        if label in self.used or any(label == name for _, name in run.subprograms.arranged.subs):
            label = self._free_label()
        self.used.add(label)
        self.inside.append(Kept(construct, label, len(run.calls)))
        return self.inside[-1]

    def _free_label(self) -> str:
        """Return a number that no label has, of the program or of what is kept."""
        arranged = self.run.subprograms.arranged
        if arranged is not self.counted:  # a file was called meanwhile
            self.counted = arranged
            names = [word.label for word in arranged.words.values()]
            self.largest = max(
                self.largest, *map(int, filter(str.isdigit, names)), *arranged.labels
            )
        self.largest += 1
        return str(self.largest)

    def _write(self, kept: Kept, keyword: str = "") -> None:
        """Write the O-word at which the run stands with the label of its construct."""
        run = self.run
        block = run.listing.block(run.line)
        statement = next(i for i in block.items if isinstance(i, Statement))
        word, more = run.words[run.line], []
        label, said = statement.tree.children[1:3]
        if kept.label != word.label:
            more.append((*span_of(label), kept.label))
        if keyword and keyword != word.keyword:
            more.append((*span_of(said), keyword))
        self.still.add(run.blocks)
        self.keep(block, statement, more)

    # --- the end ---

    def close(self) -> None:
        """Check all of it, behind the last line."""
        self.refuse("the program ends")
        self.refuse_modes()


def _other(before: float | None, now: float | None) -> bool:
    """Whether a parameter is not what it was; not known is not known."""
    nan = before is not None and before != before
    return not (nan and (now is None or now != now)) and differ(before, now)
