"""LinuxCNC: O-words (sub, call, if, while, do, repeat), M98 with M99, and M70 to M73.

What is here was executed with LinuxCNC's stand-alone interpreter: labels are those of the
subprogram they stand in; numbered parameters up to 30 and names without an underscore belong to
their call, to M98 the names alone; a count is rounded, halves to an even number.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property

from gcxform.diagnostics import InputError
from gcxform.dialect.arithmetic import Arithmetic, NoValueError, whole
from gcxform.flow.constructs import Construct, OWord
from gcxform.flow.listing import Definition, Listing, bare
from gcxform.flow.modes import StoredModes
from gcxform.flow.named_files import Subprograms
from gcxform.flow.oword_loops import OWordLoops
from gcxform.flow.oword_names import (
    LOCALS,
    NAMES_POSITION,
    STANDS,
    is_local,
    is_named_local,
    name_of,
)
from gcxform.flow.places import FIRST, Places, beside_zeros
from gcxform.flow.residual import Edit
from gcxform.flow.run_state import Call, whole_number
from gcxform.modal.state import Reading
from gcxform.syntax.grammar import span_of
from gcxform.syntax.tree import Block, Statement, Word
from gcxform.syntax.undecided import Undecided

STORING = frozenset({70, 71, 72, 73})
LEAVES = frozenset({"break", "continue"})
POSITIONS = range(FIRST, FIRST + 9)


class OWords(OWordLoops):
    """Runs programs of LinuxCNC."""

    deepest = 9

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.ahead: set[str] = set()
        self.contours: dict[int, Construct] = {}
        self.modes = StoredModes(self)
        self.places = Places(self)
        self.returned()
        self.subprograms = Subprograms(self)

    @cached_property
    def beside_zeros(self) -> Arithmetic:
        """How it computes behind a block that has read a place at 0."""
        return beside_zeros(self.arithmetic)

    def arrange(self) -> None:
        """Find which lines belong together."""
        self.subprograms.arrange()

    def begins(self) -> bool:
        """Go on where a way comes in, behind what only the machine comes to."""
        self.kept_words.begins()
        return self.ended

    def stop(self, block: Block) -> None:
        """End the program, or note that it ends here if the machine comes here."""
        if self.kept_words.inside and self._ends(block):
            self.kept_words.ends_here()
        else:
            super().stop(block)

    def close_branches(self) -> None:
        """Check what only the machine decides."""
        self.kept_words.close()

    def undecided(self) -> Undecided:
        """Return what of the executed lines only the machine decides."""
        return self.kept_words.undecided

    # --- what lines do ---

    def write(self, block: Block) -> None:
        """Write a block out; one that cuts a contour needs the subprogram as it stands."""
        if self.listing.meaning(self.line).call:
            self._contour(block)
        super().write(block)

    def _contour(self, block: Block) -> None:
        """Note the subprogram that a lathe cycle cuts: it stays where nothing calls it."""
        number = next((whole_number(word) for word in block.words if word.address == "Q"), None)
        first = self.subprograms.arranged.subs.get((0, str(number)))
        if first is None or self.line >= self.listing.own:
            message = "the contour of this cycle is a subprogram of this file, by its number in Q"
            raise self.refusal("GX210", message)
        self.contours[self.line] = first

    def close(self, kept: tuple[Definition, ...]) -> None:
        """Write what stands behind the end. Raises InputError for a contour that is called too."""
        for line, contour in self.contours.items():
            self.line = line
            if self.times[contour.lines[0] + 1 : contour.last].any():
                message = "the contour of this cycle is called as well, and may not be changed"
                raise self.refusal("GX210", message, "give the cycle a subprogram of its own")
        super().close(kept)

    def act(self, block: Block) -> bool:
        """Do what an O-word, a call or a stored mode does."""
        items = bare(block)
        if NAMES_POSITION.search(block.text):
            self.acted = True
            self.tied = "positions or modes are read (#5420 to #5428, #<_x>, #<_metric>)"
            found = self.places.parameters()
            if any(found.get(key) == 0 for key in POSITIONS):
                self.arithmetic = self.beside_zeros
            self.set(found | {"_rpm": self.modes.speed()})
        elif FIRST in self.parameters:
            self.parameters |= dict.fromkeys((*POSITIONS, *STANDS), math.nan)
        word = self.words.get(self.line)
        if word is not None:
            getattr(self, f"_{word.keyword}")(word)
            return True
        if len(items) == 1 and isinstance(items[0], Word) and items[0].address == "O":
            return bool(self.calls)  # a label inside a subprogram is no program number
        codes = {
            whole_number(item) for item in items if isinstance(item, Word) and item.address == "M"
        }
        if codes & {98, 99}:
            self._call_by_number(block, items, 98 in codes)
            return True
        if codes & STORING and self.kept_words.returns():
            self.kept_words.refuse("modes are stored or restored")
        if self.modes.act(block, codes):
            self.tied = "modes are stored (M70 to M73)"
            return True
        return False

    def steady(self) -> bool:
        """Whether the parameters that say where the axes stand are not set."""
        return FIRST not in self.parameters

    def decides(self, line: int) -> bool:
        """Whether a line has an O-word, or reads where the axes stand."""
        text = self.listing.window.line(line).decode("latin-1")
        return line in self.words or NAMES_POSITION.search(text) is not None

    def edits(self, block: Block) -> list[Edit]:
        """Return what is written otherwise: values, and polar words."""
        polar = self.places.polar_edits(block)
        if sum(word.address in "@^" for word in block.words) == 1:
            self.tied = "a polar word counts from where the axes stand"
        return [*polar, *(e for e in super().edits(block) if not _within(e, polar))]

    def becomes_other(self, block: Block) -> bool:
        """Whether a block cannot be judged before it is written out: also one of polar words."""
        polar = any(word.address in "@^" for word in block.words)
        return polar or super().becomes_other(block)

    # --- subprograms ---

    def entered(self) -> Iterator[tuple[int, int]]:
        """Yield first and last line of the loops and branches."""
        return ((c.lines[0], c.last) for c in self.construct.values() if c.kind != "sub")

    def leaves(self, line: int, first: int, last: int) -> bool:
        """Whether a line returns, leaves a loop around this one, or ends the program."""
        word, block = self.words.get(line), self.listing.block(line)
        if word is not None and word.keyword == "return":
            return True
        if word is not None and word.keyword in LEAVES:
            return self.construct[line].lines[0] != first
        over = self.listing.meaning(line).percent or super().leaves(line, first, last)
        return over or _returns(block)

    def definitions(self) -> Iterator[Definition]:
        """Yield the subprograms, those of numbers up to the next or to the end of the file."""
        arranged, own = self.subprograms.arranged, self.listing.own
        subs = {label: c for (first, label), c in arranged.subs.items() if not first}
        begins = sorted({line for lines in arranged.labels.values() for line in lines})
        begins += [construct.lines[0] for construct in subs.values()]
        found = [Definition(name_of(label), c.lines[0], c.last) for label, c in subs.items()]
        for number, lines in arranged.labels.items():
            for line in (each for each in lines if each < own):
                after = min((other for other in begins if line < other < own), default=None)
                last = self.listing.last_of(line, after)
                if not self.times[line]:
                    found.append(Definition(f"O{number}", line, last))
        yield from sorted(found, key=lambda each: each.first)

    def callees(self, line: int) -> frozenset[str] | None:
        """Return the subprogram that an O-word calls, or the number that M98 does."""
        word, block = self.words.get(line), self.listing.block(line)
        if word is not None:
            called = word.keyword == "call"
            return frozenset({name_of(word.label)} if called else ())
        calls = any(w.address == "M" and whole_number(w) in (98, None) for w in block.words)
        if block.error is None and not calls:
            return frozenset()
        numbers = {whole_number(w) for w in block.words if w.address == "P"}
        return None if numbers in (set(), {None}) else frozenset(f"O{n}" for n in numbers)

    def _sub(self, word: OWord) -> None:
        met = self.subprograms.met
        if word.label in self.ahead or met.setdefault(word.label, self.line) != self.line:
            message = "the control has called this subprogram before it came here, and stops"
            raise self.refusal("GX223", message, "write it before the call, or behind the end")
        construct = self.construct[self.line]
        inside = range(construct.lines[0] + 1, construct.last + 1)
        for line in filter(self.words.__contains__, inside):
            if self.words[line].keyword in ("return", "endsub"):
                self.line = line
                self._pass_end(self.words[line])
        self.at = construct.last + 1

    def _pass_end(self, word: OWord) -> None:
        """Set what stands where a subprogram that is passed over would return, as if it had."""
        try:
            self.returned(self.value(word.values[0]) if word.values else None)
        except InputError:
            self.returned(self.doubtful)  # only who reads it must know it

    def _call(self, word: OWord) -> None:
        first = self.subprograms.line_of(label := self._label(word))
        values = [self.value(node) for node in word.values]
        if len(values) > len(LOCALS):
            raise self.refusal("GX221", f"a call takes at most {len(LOCALS)} values")
        self._refuse_recursion_in_loop(label)
        if self.line < first < self.listing.own:
            self.ahead.add(label)
        own = {key: value for key, value in self.parameters.items() if is_local(key)}
        call = Call(f"O{label}", self.at, first + 1, 1, own, self.counters)
        self.parameters = {k: v for k, v in self.parameters.items() if k not in own}
        given = [*values, *[0.0] * (len(LOCALS) - len(values))]
        self.set(dict(zip(LOCALS, given, strict=True)))
        self.counters = {}
        self.enter(call)
        self.modes.enter()

    def _label(self, word: OWord) -> str:
        """Return the label that a call names, which may be computed."""
        if word.computed is None:
            return word.label
        value = self.value(word.computed)
        try:
            return str(whole(value, self.arithmetic.whole_slip))
        except NoValueError as why:
            message = f"the number of a subprogram: {why}"
            raise self.refusal("GX221", message, place=span_of(word.computed)) from None

    def _refuse_recursion_in_loop(self, label: str) -> None:
        """Refuse a call of itself inside `repeat`: the control has one counter for both."""
        if self.counters and any(call.name == f"O{label}" for call in self.calls):
            raise self.refusal("GX223", "a subprogram calls itself inside a repeat loop")

    def _endsub(self, word: OWord) -> None:
        if not self.calls or self.calls[-1].name != f"O{word.label}":
            raise self.refusal("GX223", f"this ends O{word.label}, which is not running")
        self._return(word)

    def _return(self, word: OWord) -> None:
        """Return from the subprogram that runs, whatever the label says."""
        if not self.calls or not self.calls[-1].name.startswith("O"):
            message = "no subprogram that was called by name is running here"
            raise self.refusal("GX223", message)
        if self.kept_words.returns():
            self.kept_words.refuse("a subprogram returns")
        value = self.value(word.values[0]) if word.values else None
        self.modes.leave()
        self.at = self._left_call().back
        self.returned(value)

    def _left_call(self) -> Call:
        """Leave the call that runs: its caller has its parameters again."""
        call = self.calls.pop()
        own = is_local if call.name.startswith("O") else is_named_local
        self.parameters = {k: v for k, v in self.parameters.items() if not own(k)}
        self.parameters.update(call.locals)
        self.left |= set(self.counters)
        self.counters = call.counters
        return call

    def unwind(self, depth: int) -> None:
        """Leave the calls in which the program may have ended, down to so many."""
        while len(self.calls) > depth:
            self.at = self._left_call().back
            self.modes.levels.pop()

    def returned(self, value: float | None = None) -> None:
        """Set what the program can read about the last return."""
        self.set({"_value": value or 0.0, "_value_returned": float(value is not None)})

    def _call_by_number(self, block: Block, items: list[Word | Statement], calls: bool) -> None:
        """Do M98 or M99: named parameters are of the call, numbered ones of its caller."""
        self.refuse_more(items, "MPL" if calls else "M")
        if calls:
            self._call_number(block)
        elif not self.calls or not self.calls[-1].name.startswith("M98"):
            message = "M99 outside a subprogram that M98 has called: the control begins anew"
            raise self.refusal("GX210", message, "end the program with M2")
        else:
            self._repeat_or_return()

    def _call_number(self, block: Block) -> None:
        number, times = self.number(block, "P"), self.number(block, "L", 1.0)
        if not (number % 1 == 0 and times % 1 == 0 and times >= 0):
            raise self.refusal("GX221", "M98 takes the number of a subprogram, and a count in L")
        first = self.subprograms.line_of_number(int(number))
        held = self.modes.has_stored() or any(map(is_named_local, self.parameters))
        if not times and (held or self.calls or self._is_inside(self.line)):
            message = "the control loses its place at a call that is made no time at all"
            raise self.refusal("GX223", message, "leave the block out")
        if times:
            named = {k: v for k, v in self.parameters.items() if is_named_local(k)}
            self.parameters = {k: v for k, v in self.parameters.items() if k not in named}
            name, counts = f"M98 P{number:g}", self.counters
            self.enter(Call(name, self.at, first + 1, int(times), named, counts))
            self.modes.enter()
            self.counters = {}
            # On its way to the number the control may pass an M99 or endsub, which sets them.
            self.set({"_value": self.doubtful, "_value_returned": self.doubtful})

    def _is_inside(self, line: int) -> bool:
        """Whether a line stands inside a construct."""
        return any(c.lines[0] < line < c.last for c in self.construct.values())

    def _repeat_or_return(self) -> None:
        call = self.calls[-1]
        if self.kept_words.returns():
            self.kept_words.refuse("a subprogram returns")
        call.times -= 1
        self.modes.leave()
        self.returned()
        if call.times:
            self.left |= set(self.counters)
            self.modes.enter()
            self.counters = {}
            self.at = call.first
            return
        self.at = self._left_call().back

    # --- branches ---

    def _if(self, word: OWord) -> None:
        construct = self.construct[self.line]
        asked = self.asked.setdefault(self.line, set())
        for line in construct.lines:
            self.line = line
            asked.add(line)
            other = self.words[line]
            holds = True if other.keyword in ("else", "endif") else self.truth(other)
            if holds is None:
                self.kept_words.open_if(construct)
            if holds is not False:
                self.at = line + 1
                return

    def _elseif(self, word: OWord) -> None:
        """Reached from the branch before, which was taken, or may have been."""
        if self.kept_words.has(self.construct[self.line]):
            self.kept_words.clause()
        else:
            self.at = self.construct[self.line].last + 1

    _else = _elseif

    def _endif(self, word: OWord) -> None:
        """Go on."""
        if self.kept_words.has(self.construct[self.line]):
            self.kept_words.end_if()


def _returns(block: Block) -> bool:
    """Whether a block has M99."""
    return any(w.address == "M" and whole_number(w) == 99 for w in block.words)


def _within(edit: Edit, others: list[Edit]) -> bool:
    """Whether a piece of a block is part of another."""
    return any(start <= edit[0] and edit[1] <= end for start, end, _ in others)
