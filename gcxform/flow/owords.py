"""LinuxCNC: O-words (sub, call, if, while, do, repeat), M98 with M99, and M70 to M73.

What is here was executed with LinuxCNC's stand-alone interpreter: labels are those of the
subprogram they stand in; numbered parameters up to 30 and names without an underscore belong to
their call, but not to M98; a count is rounded, halves to an even number.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

from lark import Token

from gcxform.diagnostics import InputError
from gcxform.flow.execution import HINT, Call, Edit, Execution, whole_number
from gcxform.flow.listing import Listing, bare
from gcxform.flow.modes import StoredModes
from gcxform.flow.places import FIRST, Places
from gcxform.modal.arithmetic import Key
from gcxform.modal.state import Reading
from gcxform.syntax.tree import BLANKS, Block, Statement, Word

LOCALS = range(1, 31)
LEAVES = frozenset({"break", "continue"})
POSITIONS = range(FIRST, FIRST + 9)
NAMES_POSITION = re.compile(r"#[ \t]*5[ \t]*4[ \t]*2")
ORDERS = {
    "sub": ("sub", "endsub"),
    "if": ("if", "elseif", "else", "endif"),
    "while": ("while", "break", "continue", "endwhile"),
    "do": ("do", "break", "while"),
    "repeat": ("repeat", "endrepeat"),
}
"""The keywords with the label of each construct: what opens it first, what closes it last.

After `continue` in a `do` loop the interpreter runs a later `repeat` too often, so it is refused.
"""


@dataclass(frozen=True, slots=True)
class OWord:
    """A line with an O-word: its label, its keyword, the values behind it, and its construct."""

    label: str
    keyword: str
    values: tuple[Any, ...]


@dataclass(slots=True)
class Construct:
    """The lines with one label that belong together, in order; `kind` is the first keyword."""

    kind: str
    lines: list[int] = field(default_factory=list)

    @property
    def last(self) -> int:
        """The line that closes it."""
        return self.lines[-1]


class OWords(Execution):
    """Runs programs of LinuxCNC; `left` are the `repeat` loops that a jump has left."""

    deepest = 9

    def __init__(self, listing: Listing, reading: Reading) -> None:
        super().__init__(listing, reading)
        self.words: dict[int, OWord] = {}
        self.construct: dict[int, Construct] = {}
        self.subs: dict[str, Construct] = {}
        self.labels: dict[int, list[int]] = {}
        self.ahead: set[str] = set()
        self.jumped = False
        self.modes = StoredModes(self)
        self.places = Places(self)
        self.counters: dict[int, int] = {}
        self.left: set[int] = set()
        self.returned()
        self._arrange()

    # --- which lines belong together ---

    def _arrange(self) -> None:
        """Find the constructs of the listing. Raises InputError for what does not fit together."""
        scope = ""
        open_: dict[tuple[str, str], Construct] = {}
        for line in self.listing.special.tolist():
            self.line = line
            block = self.listing.block(line)
            items = bare(block) if self.stands(block) else []
            if len(items) == 1 and isinstance(items[0], Word) and items[0].address == "O":
                number = whole_number(items[0])
                self.labels.setdefault(-1 if number is None else number, []).append(line)
                scope = f"O{number}"
            elif items and isinstance(items[0], Statement) and items[0].kind == "flow":
                word = self._read(items[0])
                self.words[line] = word
                if word.keyword == "return" and not scope.startswith("sub "):
                    raise self._misfit("return outside a subprogram")
                if word.keyword not in ("call", "return"):
                    scope = self._place(line, word, scope, open_)
        for (_, label), construct in open_.items():
            if construct.lines and ORDERS[construct.kind][-1] != self._keyword(construct.last):
                self.line = construct.lines[0]
                raise self._misfit(f"O{label} {construct.kind} is not closed")

    def _keyword(self, line: int) -> str:
        return self.words[line].keyword

    def _read(self, statement: Statement) -> OWord:
        _, label, keyword, *values = statement.tree.children
        if not isinstance(label, Token):
            place = (statement.start, statement.end)
            message = "which label this is must be written: a parameter says it"
            raise self.refusal("GX206", message, HINT, place)
        text = str(label).translate(BLANKS).lower()
        name = text[1:-1] if text.startswith("<") else str(int(text))
        return OWord(name, str(keyword).lower(), tuple(values))

    def _place(
        self, line: int, word: OWord, scope: str, open_: dict[tuple[str, str], Construct]
    ) -> str:
        """Put a line into its construct; return the scope of the next line."""
        if word.keyword == "sub":
            if scope.startswith("sub "):
                raise self._misfit("a subprogram begins inside another")
            scope = f"sub {word.label}"
        inside = "" if word.keyword in ("sub", "endsub") else scope
        construct = open_.get((inside, word.label))
        if construct is None:
            if word.keyword not in ORDERS:
                raise self._misfit(f"{word.keyword} closes or leaves nothing with this label")
            construct = open_[inside, word.label] = Construct(word.keyword)
            if word.keyword == "sub":
                self.subs[word.label] = construct
        elif not self._goes_on(construct, word.keyword):
            place = f"{construct.kind} in line {construct.lines[0] + 1}"
            raise self._misfit(f"{word.keyword} does not go with what has this label, {place}")
        construct.lines.append(line)
        self.construct[line] = construct
        return "" if word.keyword == "endsub" else scope

    def _goes_on(self, construct: Construct, keyword: str) -> bool:
        """Whether a keyword may be the next one of a construct."""
        order = ORDERS[construct.kind]
        last = self._keyword(construct.last)
        closed = last == order[-1]
        after_else = last == "else" and keyword != "endif"
        return keyword in order[1:] and not closed and not after_else

    def _misfit(self, message: str) -> Exception:
        return self.refusal("GX223", message)

    # --- what lines do ---

    def act(self, block: Block) -> bool:
        """Do what an O-word, a call or a stored mode does."""
        items = bare(block)
        if NAMES_POSITION.search(block.text):
            self.acted = True
            self.set(self.places.parameters())
        elif FIRST in self.parameters:
            self.parameters |= dict.fromkeys(POSITIONS, math.nan)
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
        return self.modes.act(block, codes)

    def edits(self, block: Block) -> list[Edit]:
        """Return what is written otherwise: values, and polar words."""
        polar = self.places.polar_edits(block)
        return [*polar, *(e for e in super().edits(block) if not _within(e, polar))]

    def becomes_other(self, block: Block) -> bool:
        """Whether a block cannot be judged before it is written out: also one of polar words."""
        polar = any(word.address in "@^" for word in block.words)
        return polar or super().becomes_other(block)

    def _truth(self, word: OWord) -> bool:
        if len(word.values) != 1:
            raise self.refusal("GX221", f"{word.keyword} takes one condition in brackets")
        return self.value(word.values[0]) != 0

    # --- subprograms ---

    def _sub(self, word: OWord) -> None:
        if word.label in self.ahead:
            message = "the control has called this subprogram before it came here, and stops"
            raise self.refusal("GX223", message, "write it before the call, or behind the end")
        self.line = self.construct[self.line].last
        self._pass_end(self.words[self.line])
        self.at = self.line + 1

    def _pass_end(self, word: OWord) -> None:
        """Set what stands at the end of a subprogram that is passed over, as if it had returned."""
        try:
            self.returned(self.value(word.values[0]) if word.values else None)
        except InputError:
            self.returned(math.nan)  # only who reads it must know it

    def _call(self, word: OWord) -> None:
        construct = self.subs.get(word.label)
        if construct is None:
            message = f"the subprogram {word.label} is not in this file"
            raise self.refusal("GX210", message, HINT)
        values = [self.value(node) for node in word.values]
        if len(values) > len(LOCALS):
            raise self.refusal("GX221", f"a call takes at most {len(LOCALS)} values")
        self._refuse_recursion_in_loop(word.label)
        if construct.lines[0] > self.line:
            self.ahead.add(word.label)
        own = {key: value for key, value in self.parameters.items() if _is_local(key)}
        call = Call(f"O{word.label}", self.at, construct.lines[0] + 1, 1, own, self.counters)
        self.parameters = {k: v for k, v in self.parameters.items() if k not in own}
        given = [*values, *[0.0] * (len(LOCALS) - len(values))]
        self.set(dict(zip(LOCALS, given, strict=True)))
        self.counters = {}
        self.enter(call)
        self.modes.enter()

    def _refuse_recursion_in_loop(self, label: str) -> None:
        """Refuse a call of itself inside `repeat`: the control has one counter for both."""
        if self.counters and any(call.name == f"O{label}" for call in self.calls):
            raise self.refusal("GX223", "a subprogram calls itself inside a repeat loop")

    def _endsub(self, word: OWord) -> None:
        if not self.calls or self.calls[-1].name != f"O{word.label}":
            raise self._misfit(f"this ends O{word.label}, which is not running")
        self._return(word)

    def _return(self, word: OWord) -> None:
        """Return from the subprogram that runs, whatever the label says."""
        if not self.calls or not self.calls[-1].name.startswith("O"):
            raise self._misfit("no subprogram that was called by name is running here")
        value = self.value(word.values[0]) if word.values else None
        call = self.calls.pop()
        self.modes.leave()
        self.parameters = {k: v for k, v in self.parameters.items() if not _is_local(k)}
        self.parameters.update(call.locals)
        self.left |= set(self.counters)
        self.counters = call.counters
        self.returned(value)
        self.at = call.back

    def returned(self, value: float | None = None) -> None:
        """Set what the program can read about the last return."""
        self.set({"_value": value or 0.0, "_value_returned": float(value is not None)})

    def _call_by_number(self, block: Block, items: list[Word | Statement], calls: bool) -> None:
        """Do M98 or M99: without parameters of its own."""
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
        found = [line for line in self.labels.get(int(number), []) if line > self.line]
        if not found:
            message = f"the subprogram O{number:g} is not behind this block in the file"
            raise self.refusal("GX210", message, HINT)
        if not times and (self.calls or self._is_inside(self.line)):
            message = "the control loses its place at a call that is made no time at all"
            raise self.refusal("GX223", message, "leave the block out")
        if times:
            name = f"M98 P{number:g}"
            self.enter(Call(name, self.at, found[0] + 1, int(times), {}, self.counters))
            self.modes.enter()
            self.counters = {}
            # On its way to the number the control may pass an M99 or endsub, which sets them.
            self.set({"_value": math.nan, "_value_returned": math.nan})

    def _is_inside(self, line: int) -> bool:
        """Whether a line stands inside a construct."""
        return any(c.lines[0] < line < c.last for c in self.construct.values())

    def _repeat_or_return(self) -> None:
        call = self.calls[-1]
        call.times -= 1
        self.modes.leave()
        self.returned()
        self.left |= set(self.counters)
        if call.times:
            self.modes.enter()
            self.counters = {}
            self.at = call.first
            return
        self.calls.pop()
        self.counters = call.counters
        self.at = call.back

    # --- branches ---

    def _if(self, word: OWord) -> None:
        construct = self.construct[self.line]
        for line in construct.lines:
            self.line = line
            other = self.words[line]
            if other.keyword in ("else", "endif") or self._truth(other):
                self.at = line + 1
                return

    def _elseif(self, word: OWord) -> None:
        """Reached from the branch before, which was taken."""
        self.at = self.construct[self.line].last + 1

    _else = _elseif

    def _endif(self, word: OWord) -> None:
        """Go on."""

    # --- loops ---

    def _while(self, word: OWord) -> None:
        construct = self.construct[self.line]
        again = self._truth(word)
        if construct.kind == "do":
            self._refuse_after_jump()
            if again:
                self.back_to(construct.lines[0] + 1)
            return
        self.jumped |= any(self._keyword(line) in LEAVES for line in construct.lines)
        if not again:
            self.at = construct.last + 1

    def _refuse_after_jump(self) -> None:
        """Refuse a `do` loop behind a loop with `break` or `continue`, taken or not.

        The interpreter may run it once, whatever its condition says.
        """
        if self.jumped:
            message = "behind a loop with break or continue the control may run this loop once only"
            raise self.refusal("GX223", message, "write it as a while loop")

    def _endwhile(self, word: OWord) -> None:
        self.back_to(self.construct[self.line].lines[0])

    def _do(self, word: OWord) -> None:
        """Go on."""

    def _repeat(self, word: OWord) -> None:
        if len(word.values) != 1:
            raise self.refusal("GX221", "repeat takes a count in brackets")
        if self.line in self.left:
            message = "this loop was left by a jump before: the control goes on counting from there"
            raise self.refusal("GX223", message, "leave it at its end")
        times = round(self.value(word.values[0]))
        self.counters[self.line] = times
        if times <= 0:
            self._leave(self.construct[self.line])

    def _endrepeat(self, word: OWord) -> None:
        first = self.construct[self.line].lines[0]
        self.counters[first] -= 1
        if self.counters[first] > 0:
            self.at = first + 1
        else:
            self._leave(self.construct[self.line])

    def _break(self, word: OWord) -> None:
        self.jumped = True
        self._note_left(self.construct[self.line])
        self._leave(self.construct[self.line])

    def _note_left(self, construct: Construct) -> None:
        """Note the `repeat` loops inside a construct that a jump leaves."""
        for line in [n for n in self.counters if construct.lines[0] < n < construct.last]:
            self.left.add(line)
            del self.counters[line]

    def _continue(self, word: OWord) -> None:
        self._note_left(self.construct[self.line])
        self.at = self.construct[self.line].last

    def _leave(self, construct: Construct) -> None:
        self.counters.pop(construct.lines[0], None)
        self.at = construct.last + 1


def _within(edit: Edit, others: list[Edit]) -> bool:
    """Whether a piece of a block is part of another."""
    return any(start <= edit[0] and edit[1] <= end for start, end, _ in others)


def _is_local(key: Key) -> bool:
    """Whether a parameter belongs to its call."""
    return key in LOCALS if isinstance(key, int) else not key.startswith("_")
