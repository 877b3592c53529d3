"""Writes a program with the calls and loops that it has: what was executed is folded back.

A program with flow is executed, and its blocks are transformed and written one after the other. A
line whose blocks stayed as they were, in every execution, stands as it does in the program, with
its expressions, assignments and flow words. One whose blocks became the same other text each time
is written as that. If the texts differ, the smallest loop or subprogram around the line is written
out where it is executed; if that differs as well, what is around it is. What was not executed stays
as it stands, and so does the definition of a subprogram that is written out: others may call it.

Where nothing is left to keep, or what would be executed is not certain to be the same, the whole
program is written out beside its definitions, and the reason is told. `gcxform/proof/structure.py`
executes what comes out of here.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from itertools import islice

import numpy as np

from gcxform.emit.numbered import SEQUENCE, sequence_numbers
from gcxform.emit.spelled import Spelled, Text
from gcxform.emit.units import Unit
from gcxform.emit.values_left import Values
from gcxform.flow.walk import Walk, parts_of
from gcxform.stamps.comment import is_stamp
from gcxform.syntax.tree import Statement
from gcxform.values import dataclass

RETURNS = re.compile(rb"#[ \t]*<[ \t]*_value", re.IGNORECASE)
OTHERS = "what is not executed, or another program, calls it as it stands"
MODAL = re.compile(rb"G[ \t]*66(?![0-9])", re.IGNORECASE)
SHOWN = 2  # texts of a line that a reason shows


class WholeError(Exception):
    """The program has to be written out as a whole: why."""


@dataclass(frozen=True, slots=True)
class Folded:
    """A program with its structure.

    text   whole lines, and `lines` of the program, from 0, that they are for
    gone   lines, first and last, that are written out elsewhere, or in place of themselves
    why    what is written out, each in a sentence with its reason
    whole  of all lines those of definitions alone stand as they did
    """

    text: bytes
    lines: tuple[int, ...]
    gone: tuple[tuple[int, int], ...]
    why: tuple[str, ...]
    whole: bool = False


def fold(spelled: Spelled, takes_stamps: bool = False) -> Folded:
    """Return a program with what of its structure can stay.

    `takes_stamps`: its stamps are taken out, those too that are not executed.
    Raises WholeError where nothing can.
    """
    folding = _Folding(spelled)
    folding.settle()
    return folding.assembled(takes_stamps)


class _Folding:
    """One program being folded: `out` are the units to be written out, with the reasons."""

    def __init__(self, spelled: Spelled) -> None:
        self.spelled = spelled
        self.walk: Walk = spelled.walk
        self.values = Values(self.walk)
        self.variants = spelled.variants()
        self.out: dict[Unit, str] = {}
        self.texts: dict[int, Text] = {}
        """What stands in place of a line, or of the lines of a unit, by the first line."""
        self.ranges: dict[Unit, Text] = {}

    # --- the units ---

    @cached_property
    def subs(self) -> tuple[Unit, ...]:
        found = (*self.walk.definitions, *self.walk.files)
        return tuple(Unit(each.first, each.last, each.name) for each in found)

    @cached_property
    def kept(self) -> tuple[Unit, ...]:
        """The subprograms that stay as they stand: what is not executed needs them, or others."""
        found = (*self.walk.kept, *self.walk.files)
        return tuple(Unit(each.first, each.last, each.name) for each in found)

    def _needed(self) -> list[Unit]:
        """Return those, and what subprograms may call that are written out: they stay as well."""
        found = {*self.kept}
        new = [unit.first for unit in self.out if unit.name]
        while new:
            called = self.walk.callees.get(new.pop(), ())
            units = {Unit(each.first, each.last, each.name) for each in called} - found
            found |= units
            new += [unit.first for unit in units]
        return sorted(found, key=lambda each: each.first)

    @cached_property
    def loops(self) -> tuple[Unit, ...]:
        """The loops, and the lines that a jump back repeats; together where they cross."""
        steps = self.walk.steps
        back = [
            (steps[j + 1].first, steps[j].first)
            for j in sorted(self.walk.jumps)
            if j + 1 < len(steps)
            and steps[j + 1].first <= steps[j].first
            and steps[j + 1].depth == steps[j].depth
        ]
        every = [*self.walk.loops, *back]
        return tuple(Unit(*lines) for lines in dict.fromkeys(parts_of(*e, every) for e in every))

    def _around(self, unit: Unit) -> Unit | None:
        """Return the smallest unit around one, or around a line that is taken for one."""
        found = [
            other
            for other in (*self.loops, *self.subs)
            if other != unit and other.first <= unit.first and unit.last <= other.last
        ]
        return min(found, key=lambda each: each.last - each.first, default=None)

    def _called(self, step: int) -> Unit | None:
        """Return the subprogram that a step calls; None for one that is no definition."""
        return self._sub_of(self.walk.steps[step + 1].first)

    @cached_property
    def _calls(self) -> dict[int, list[int]]:
        """The steps that call, by their lines."""
        found: dict[int, list[int]] = {}
        first, depth = self.walk.table[:, 0], self.walk.table[:, 3]
        for step in np.flatnonzero(np.diff(depth) > 0).tolist():
            found.setdefault(int(first[step]), []).append(step)
        return found

    def _sub_of(self, line: int) -> Unit | None:
        return next((sub for sub in self.subs if sub.has(line)), None)

    # --- what is written out ---

    def settle(self) -> None:
        """Find what has to be written out, until the rest agrees. Raises WholeError."""
        if self.variants and self.walk.tied:
            raise WholeError(self.walk.tied)
        before = -1
        while len(self.out) != before:
            before = len(self.out)
            self.texts, self.ranges = {}, {}
            self._settle_lines()
            for unit in [*self.out]:
                if not unit.name:
                    self._settle_loop(unit)
            self._settle_calls()
            self._leave_kept()
        if self.out and MODAL.search(self.walk.listing.window.text):
            raise WholeError("a macro is called by every move (G66)")
        if any(unit.name for unit in self.out) and self._reads_returns():
            raise WholeError("what a subprogram returned is read")

    def _leave_kept(self) -> None:
        """Write out subprograms that what is not executed calls too: it needs them as they are."""
        changed = [*self.variants, *self.texts, *(unit.first for unit in self.ranges)]
        for unit in self._needed():
            line = min((line for line in changed if unit.has(line)), default=None)
            if line is not None:
                why = self._differs(line, self.variants.get(line, ())) + f", and {OTHERS}"
                self._write_out(unit, self.out.get(unit) or why)

    def _write_out(self, unit: Unit | None, why: str) -> None:
        if unit is None:
            raise WholeError(why)
        self.out.setdefault(unit, why)

    def _settle_lines(self) -> None:
        """Settle the lines that did not stay as they were executed."""
        for line, texts in self.variants.items():
            unit = Unit(line, line)
            if self._is_out(line):
                continue
            if len(texts) > 1:
                self._write_out(self._around(unit), self._differs(line, texts))
            elif line in self.walk.deciding and not self.spelled.moves_and_calls(line):
                why = f"line {line + 1} decides what is executed, and was changed"
                self._write_out(self._around(unit), why)
            else:
                self._settle_line(unit, next(iter(texts.values())))

    def _is_out(self, line: int) -> bool:
        return any(unit.has(line) for unit in self.out)

    def _differs(self, line: int, texts: Iterable[bytes]) -> str:
        """Return how the texts of a line differ."""
        shown = [repr(text.decode("latin-1").strip()) for text in islice(texts, SHOWN)]
        return f"{self._told(line)} " + (f"became {' and '.join(shown)}" if shown else "changes")

    def _told(self, line: int) -> str:
        """Return which line it is, of which file."""
        file, number = self.walk.listing.place(line)
        return f"line {number}" if line < self.walk.listing.own else f"line {number} of {file}"

    def _settle_line(self, unit: Unit, step: int) -> None:
        """Write a line as what it became; with what it sets, which the program reads."""
        text = self.spelled.became(step, unit.first)
        if not self.spelled.sets(unit.first):
            self.texts[unit.first] = text
            return
        runs = [(k, k + 1) for k, at in enumerate(self.walk.steps) if at.first == unit.first]
        same = self.values.one(unit.lines, runs, [text] * len(runs))
        if same is None:
            why = f"line {unit.first + 1} was changed, and sets a value"
            self._write_out(self._around(unit), why)
        else:
            self.texts[unit.first] = same

    def _settle_loop(self, unit: Unit) -> None:
        """Find what stands in place of a loop: the same each time it is executed."""
        runs = [*self._runs_of(unit)]
        same = None
        if all(self._goes_through(unit, *run) for run in runs):
            texts = [self.spelled.of(*run, self._stays) for run in runs]
            same = self.values.one(unit.lines, runs, texts)
        if same is None:
            self._write_out(self._around(unit), self.out[unit])
        else:
            self.ranges[unit] = same

    def _runs_of(self, unit: Unit) -> Iterator[tuple[int, int]]:
        """Yield the steps in which a unit is executed, from its first to behind its last."""
        steps, step = self.walk.steps, 0
        while step < len(steps):
            if not unit.has(steps[step].first):
                step += 1
                continue
            begin, depth = step, steps[step].depth
            while step < len(steps) and (
                steps[step].depth > depth
                or (steps[step].depth == depth and unit.has(steps[step].first))
            ):
                step += 1
            yield begin, step

    def _goes_through(self, unit: Unit, begin: int, end: int) -> bool:
        """Whether an execution of a unit comes in at its first line, and goes on behind its last.

        What leads elsewhere (a jump, a return) would be missing where the unit is written out.
        """
        steps = self.walk.steps
        if steps[begin].first != unit.first or begin - 1 in self.walk.jumps:
            return False
        if end == len(steps):
            return True
        return steps[end].depth == steps[begin].depth and steps[end].first == unit.last + 1

    def _settle_calls(self) -> None:
        """Find what stands in place of the calls of subprograms that are written out."""
        for line, steps in self._calls.items():
            lost = next((sub for k in steps if (sub := self._called(k)) in self.out), None)
            if lost is None or self._is_out(line):
                continue
            unit, same = Unit(line, line), None
            if all(self._comes_back(step) for step in steps):
                runs = [(step, self.walk.returned(step)) for step in steps]
                texts = [self._of_call(*run) for run in runs]
                same = self.values.one(unit.lines, runs, texts)
            if same is None:
                self._write_out(self._around(unit), self.out[lost])
            else:
                self.texts[line] = same

    def _of_call(self, step: int, behind: int) -> Text:
        """Return what a call became."""
        return self.spelled.of(step, behind, lambda at: at != step and self._stays(at))

    def _comes_back(self, step: int) -> bool:
        """Whether a call comes back to the line behind it, or never."""
        steps, behind = self.walk.steps, self.walk.returned(step)
        if behind == len(steps):
            return True
        same = steps[behind].depth == steps[step].depth
        return same and steps[behind].first == steps[step].first + 1

    def _stays(self, step: int) -> bool:
        """Whether a call stands as it is inside what is written out: it reads no local value."""
        line = self.walk.steps[step].first
        sub = self._called(step)
        if sub is None or sub in self.out or line in self.walk.reads:
            return False
        if self.spelled.moves_and_calls(line):
            return False
        items = self.walk.listing.block(line).items
        if any(isinstance(item, Statement) for item in items):
            return True
        inside = range(step + 1, self.walk.returned(step))
        looked_at = (self.walk.looked_at(self.walk.steps[k]) for k in inside)
        lines = {line for found in looked_at for line in found if line in self.walk.reads}
        return not any(
            key is None or not self.walk.arithmetic.outlives(key)
            for line in lines
            for key in self.walk.reads[line]
        )

    def _reads_returns(self) -> bool:
        return RETURNS.search(self.walk.listing.window.text) is not None

    # --- the text ---

    def assembled(self, takes_stamps: bool) -> Folded:
        """Return the program. Raises WholeError where nothing of its structure is left."""
        gone = self._gone()
        found: list[bytes] = []
        lines: list[int] = []
        line = 0
        while line < self.walk.listing.own:
            unit = next((unit for unit in gone if unit.first == line), None)
            text = self._text_of(line, takes_stamps) if unit is None else self.ranges.get(unit)
            found.append(text.text if text else b"")
            lines += text.lines if text else ()
            line = line + 1 if unit is None else unit.last + 1
        if self.variants and not self._is_left():
            why = "; ".join(dict.fromkeys(self.out.values()))
            raise WholeError(why or "no call and no loop is left")
        whole = b"".join(found)
        self._check_labels(whole, [*gone, *(unit for unit in self.out if unit.name)])
        ranges = tuple((unit.first, unit.last) for unit in gone)
        return Folded(whole, tuple(lines), ranges, self._reasons())

    def _is_left(self) -> bool:
        """Whether a call or loop is left that is executed, in the program itself or by its calls.

        What stands in a subprogram counts by what calls it.
        """
        first, depth = self.walk.table[:, 0], self.walk.table[:, 3]
        own = self.walk.deciding.intersection(first[depth == 0].tolist())
        written = (*self.texts.values(), *self.ranges.values())
        calls = any(
            line in self._calls and self.spelled.raw(line) in text.text
            for text in written
            for line in text.lines
        )
        stay = (n for n in own if n not in self.texts or self.spelled.moves_and_calls(n))
        return calls or not all(map(self._is_out, stay))

    def _gone(self) -> list[Unit]:
        """Return the units that do not stand where they did, but for those inside others."""
        left = [u for u in self.out if u.name]
        gone = [u for u in self.ranges if not any(o.has(u.first) for o in left)]
        return [u for u in gone if not any(o != u and o.first <= u.first <= o.last for o in gone)]

    def _text_of(self, line: int, takes_stamps: bool) -> Text:
        """Return what stands for a line: as it is, unless it has become another."""
        if line in self.texts and self.walk.times[line]:
            return self.texts[line]
        raw = self.walk.listing.raw(line, line + 1)
        if takes_stamps and not self.walk.times[line] and is_stamp(raw.decode("latin-1").strip()):
            return Text()
        return Text(raw, (line,))

    def _check_labels(self, text: bytes, gone: list[Unit]) -> None:
        """Raise WholeError where a number that is jumped to would be gone, or there once more."""
        walk = self.walk
        jumps = [
            (walk.steps[j].first, walk.steps[j + 1].first)
            for j in walk.jumps
            if j + 1 < len(walk.steps)
        ]
        stay = [to for line, to in jumps if not any(unit.has(line) for unit in gone)]
        lines = {line for line in stay if not any(unit.has(line) for unit in gone)}
        before, after = (sequence_numbers(each) for each in (walk.listing.window.text, text))
        for line in sorted(lines):
            found = SEQUENCE.match(self.spelled.raw(line))
            new = SEQUENCE.match(self.texts[line].text) if line in self.texts else found
            number = int(found[1]) if found else 0
            lost = found is None or new is None or int(new[1]) != number
            if lost or after[number] > before[number]:
                raise WholeError(f"N{number} is jumped to, and would be gone or doubled")

    def _reasons(self) -> tuple[str, ...]:
        """Return what is written out, and why."""
        found = []
        for unit, why in self.out.items():
            names = [unit.name] if unit.name else []
            if unit.last < self.walk.listing.own:
                names.append(f"lines {unit.first + 1} to {unit.last + 1}")
            found.append(f"{', '.join(names)}: {why}")
        return tuple(found)
