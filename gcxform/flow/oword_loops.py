"""Loops of O-words: while, do, repeat, and what leaves them."""

from __future__ import annotations

from typing import Any

from gcxform.flow.constructs import Construct, OWord
from gcxform.flow.kept_owords import KeptOWords, Structured
from gcxform.flow.listing import Listing
from gcxform.flow.round_body import Repeated
from gcxform.flow.rounds import MOST, Rounds
from gcxform.modal.state import Reading


class OWordLoops(Structured):
    """A run of loops."""

    def __init__(self, listing: Listing, reading: Reading, keeps: bool = False) -> None:
        super().__init__(listing, reading, keeps)
        self.broken = self.continued = False
        self.counters: dict[int, int] = {}
        self.left: set[int] = set()
        self.many = Rounds(self)
        self.kept_words = KeptOWords(self)

    def quirks(self) -> frozenset[int | str]:
        """Return what the control notes of loops that were left, and counts wrong by."""
        noted = {"broken": self.broken, "continued": self.continued}
        return frozenset(self.left) | {name for name, is_so in noted.items() if is_so}

    def take_quirks(self, noted: frozenset[int | str]) -> None:
        """Take for noted what may have been."""
        self.broken |= "broken" in noted
        self.continued |= "continued" in noted
        self.left |= {each for each in noted if isinstance(each, int)}

    def truth(self, word: OWord) -> bool | None:
        """Return whether a condition holds; None if only the machine knows. Raises InputError."""
        if len(word.values) != 1:
            raise self.refusal("GX221", f"{word.keyword} takes one condition in brackets")
        value = self.value_or_lost(word.values[0])
        return None if value is None else value != 0

    def _while(self, word: OWord) -> None:
        construct = self.construct[self.line]
        if construct.kind == "do":
            self._refuse_after_break()
            self._while_of_do(construct, word)
            return
        self.broken |= self._has(construct, "break")
        again = None if self.kept_words.is_found() else self.truth(word)
        if again is None or (again and self.kept_words.is_like_one_that_begins()):
            self.kept_words.open_loop(construct)
        elif not again:
            self.at = construct.last + 1

    def _while_of_do(self, construct: Construct, word: OWord) -> None:
        """Go back to `do`, or on; a loop that turns out to be the machine's is run anew."""
        if self.kept_words.has(construct):
            self.kept_words.close_loop()
            return
        again = self.truth(word)
        if again is None:
            self.kept_words.run_again(construct)
        elif again:
            self.back_to(construct.lines[0] + 1)
            self._many(construct, word.values[0])

    def _has(self, construct: Construct, keyword: str) -> bool:
        """Whether a keyword stands in a construct behind the line that is executed."""
        behind = (line for line in construct.lines if line > self.line)
        return any(self.words[line].keyword == keyword for line in behind)

    def _refuse_after_break(self) -> None:
        """Refuse a `do` loop behind a `while` loop with `break`, taken or not.

        The interpreter may run it once, whatever its condition says.
        """
        if self.broken:
            message = "behind a loop with break the control may run this loop once only"
            raise self.refusal("GX223", message, "write it as a while loop")

    def _refuse_after_continue(self, what: str = "counts this loop wrong") -> None:
        """Refuse `repeat` and `break` behind `continue` in a `do` loop.

        The interpreter may run a `repeat` too often, and take the next `break` for a `continue`.
        """
        if self.continued:
            message = f"behind continue in a do loop the control {what}"
            raise self.refusal("GX223", message, "write the do loop as a while loop")

    def _endwhile(self, word: OWord) -> None:
        construct = self.construct[self.line]
        if self.kept_words.has(construct):
            self.kept_words.close_loop()
            return
        self.back_to(construct.lines[0])
        opening = self.words[construct.lines[0]]
        if len(opening.values) == 1:
            self._many(construct, opening.values[0])

    def _do(self, word: OWord) -> None:
        """Go on; keep a loop that the machine ends."""
        if self.kept_words.is_kept():
            self.kept_words.open_loop(self.construct[self.line])

    def _repeat(self, word: OWord) -> None:
        self._refuse_after_continue()
        if len(word.values) != 1:
            raise self.refusal("GX221", "repeat takes a count in brackets")
        if self.line in self.left:
            message = "this loop was left by a jump before: the control goes on counting from there"
            raise self.refusal("GX223", message, "leave it at its end")
        count = None if self.kept_words.is_kept() else self.value_or_lost(word.values[0])
        if count is None:
            self.kept_words.open_loop(self.construct[self.line])
            return
        times = round(count)
        self.counters[self.line] = times
        if times <= 0:
            self._leave(self.construct[self.line])

    def _endrepeat(self, word: OWord) -> None:
        self._refuse_after_continue()
        if self.kept_words.has(self.construct[self.line]):
            self.kept_words.close_loop()
            return
        first = self.construct[self.line].lines[0]
        self.counters[first] -= 1
        if self.counters[first] > 0:
            self.at = first + 1
            self.counters[first] -= self._many(self.construct[self.line])
        else:
            self._leave(self.construct[self.line])

    def _many(self, construct: Construct, condition: Any = None) -> int:
        """Execute rounds of a loop at once, where that can be done; return how many."""
        first, last = construct.lines[0], construct.last
        begin = first if construct.kind == "while" else first + 1
        flow = frozenset((first, last))
        loop = Repeated(begin, last, flow, condition, construct.kind == "do")
        return self.many.go(loop, self.counters[first] - 1 if condition is None else MOST)

    def _break(self, word: OWord) -> None:
        """Leave a loop; on its way to the end the interpreter notes a `continue` that it passes."""
        self._refuse_after_continue("may go on with this loop")
        construct = self.construct[self.line]
        self.continued |= construct.kind == "do" and self._has(construct, "continue")
        if not self.kept_words.leave(construct, "break"):
            self._note_left(construct)
            self._leave(construct)

    def _note_left(self, construct: Construct) -> None:
        """Note the `repeat` loops inside a construct that a jump leaves."""
        for line in [n for n in self.counters if construct.lines[0] < n < construct.last]:
            self.left.add(line)
            del self.counters[line]

    def _continue(self, word: OWord) -> None:
        """Go to the condition; the interpreter notes a `break` that it passes."""
        construct = self.construct[self.line]
        self.continued |= construct.kind == "do"
        self.broken |= self._has(construct, "break")
        if not self.kept_words.leave(construct, "continue"):
            self._note_left(construct)
            self.at = construct.last

    def _leave(self, construct: Construct) -> None:
        self.counters.pop(construct.lines[0], None)
        self.at = construct.last + 1
