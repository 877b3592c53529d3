"""Executes what a window computes: its assignments, and the values of words that are expressions.

This is done in the order of execution, for the lines that compute something and for no others; the
rest of the interpreter then finds numbers where the program has expressions. Lines between which no
parameter changes are computed as columns (`compiled.py`), others one by one.

No value is guessed. One that only the machine knows is nan and makes lost what it goes into
(`unknown.py`); what the control would stop at is refused. Assignments leave their parameters to the
next window. The writer copies words with expressions where they say what is
meant, and writes numbers where not; assignments stay, once, in the first piece of their block,
unless the dialect changes. The proof computes all of it again from the output.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from gcxform.diagnostics import Diagnostic
from gcxform.dialect.arithmetic import NoValueError, whole
from gcxform.dialect.increments import coarse
from gcxform.dialect.null import Null
from gcxform.modal.expressions.compiled import NO_VALUE, NoColumnError
from gcxform.modal.expressions.functions import computed_in, functions_of, whole_columns
from gcxform.modal.expressions.straight import Group, Straight
from gcxform.modal.expressions.unknown import bare_text, hangs_on, is_set, may_be_unknown
from gcxform.modal.expressions.value import (
    Evaluator,
    LocatedError,
    forgotten,
    key_set,
    settable,
    written,
)
from gcxform.modal.findings import Findings
from gcxform.modal.line_notes import Assigned, Assignments, Unknown
from gcxform.modal.lines import DISTANCES, Lines
from gcxform.modal.meaning.meaning import Meaning
from gcxform.syntax.tree import Expression, Item, Mark, Statement, Word
from gcxform.system.arrays import Floats, Ints
from gcxform.system.distinct import distinct, union

UNKNOWN = float("nan")
FEW = 8  # lines for which columns do not pay


def compute(lines: Lines) -> Assignments:
    """Give the words of the lines their values, and leave the parameters after the last line.

    Returns what the lines have set.

    Raises InputError for what has no value.
    """
    undecided = _undecided(lines)
    having = union(np.flatnonzero(lines.flag("computes")), undecided).astype(np.int64)
    if not len(having) or lines.dialect.flow_rule.arithmetic is None:
        return Assignments.of(())
    made = _Run(lines, having, undecided).run()
    lines.findings.raise_if_any()
    return made


class _Run:
    """Computes the lines of a window that compute something, in order."""

    def __init__(self, lines: Lines, having: Ints, undecided: list[int]) -> None:
        self.lines = lines
        self.undecided = frozenset(undecided)
        self.having = having
        self.value = lines.window.value.copy()
        assert lines.dialect.flow_rule.arithmetic is not None
        self.arithmetic = lines.dialect.flow_rule.arithmetic
        self.functions = [
            functions_of(lines.table, shape) if used and not self._rounds_openly(shape) else None
            for shape, used in enumerate(np.bincount(lines.shape[having]))
        ]

    @cached_property
    def row(self) -> list[float]:
        """The numbers of the window, as they were before anything was computed."""
        numbers: list[float] = self.value.tolist()
        return numbers

    def _rounds_openly(self, shape: int) -> bool:
        """Whether blocks of a shape have words that are rounded to what nobody has said."""
        words = (word.address for _, word in self.lines.table.meanings[shape].expressions)
        return any(rounds_openly(self.lines, address) for address in words)

    def run(self) -> Assignments:
        """Compute them all, and give the window its values; return what they have set."""
        made = self._straight() if len(self.having) >= FEW else None
        if made is None:
            self._in_turn()
            made = Assignments.of(self.lines.assigned)
        self.lines.window = replace(self.lines.window, value=self.value)
        return made

    def _straight(self) -> Assignments | None:
        """Compute all lines as columns, if that can be done; return what they have set."""
        lines, having = self.lines, self.having
        shapes = lines.shape[having]
        used = distinct(shapes).tolist()
        functions = [(shape, self.functions[shape]) for shape in used]
        groups = [
            Group(each, same := having[shapes == shape], lines.first[same])
            for shape, each in functions
            if each is not None and not self.undecided
        ]
        keys = {key for _, each in functions if each is not None for key, _ in each.assigned}
        if len(groups) < len(used) or not all(map(self.arithmetic.owns, keys)):
            return None
        straight = Straight(groups, lines.parameters, self.arithmetic, self.value)
        try:
            found = straight.compute(lines.window.first_line)
        except NoColumnError:
            return None
        for places, column in found.words:
            self.value[places] = column
        lines.parameters.update(found.parameters)
        return found.assigned

    def _in_turn(self) -> None:
        """Compute lines one by one, and those between which no parameter changes as columns."""
        meanings = self.lines.table.meanings
        writes = np.array([_writes(meaning) for meaning in meanings], np.bool_)
        writers = np.flatnonzero(writes[self.lines.shape[self.having]]).tolist()
        if self.undecided:
            kept = np.flatnonzero(np.isin(self.having, [*self.undecided])).tolist()
            writers = sorted({*writers, *kept})
        begin = 0
        for writer in [*writers, len(self.having)]:
            alone = self.having[begin : writer + 1]
            if writer - begin >= FEW:
                alone = np.append(self._columns(self.having[begin:writer]), alone[writer - begin :])
            for line in alone.tolist():
                self._line(line)
            begin = writer + 1
            if len(self.lines.findings.found) >= Findings.enough:
                break

    def _columns(self, stretch: Ints) -> Ints:
        """Compute lines between which no parameter changes; return those that are left."""
        lines, left = self.lines, [self.having[:0]]
        order = stretch[np.argsort(lines.shape[stretch], kind="stable")]
        for same in np.split(order, np.flatnonzero(np.diff(lines.shape[order])) + 1):
            functions = self.functions[int(lines.shape[same[0]])]
            first = lines.first[same]
            try:
                found = whole_columns(functions, lines.parameters, self.value, first)
            except NoColumnError:
                left.append(same)
                continue
            for slot, computed in found:
                self.value[first + slot] = computed
        return np.sort(np.concatenate(left))

    def _line(self, line: int) -> None:
        """Compute one line: its words, then its assignments, which take effect together."""
        lines = self.lines
        functions, first = self.functions[lines.shape[line]], int(lines.first[line])
        if functions is None or line in self.undecided:
            _Block(lines, line, self.value).execute()
            return
        row = self.row[first : first + functions.slots]
        try:
            found = [(slot, word(lines.parameters, row)) for slot, word in functions.words]
            made = [(key, result(lines.parameters, row)) for key, result in functions.assigned]
        except NO_VALUE:
            _Block(lines, line, self.value).execute()
            return
        for slot, computed in found:
            self.value[first + slot] = computed
        if made:
            for key, result in made:
                lines.parameters.update(self.arithmetic.behind(key, result))
            at = lines.window.first_line + line
            lines.assigned += [Assigned(at, key, result) for key, result in made]


def rounds_openly(lines: Lines, address: str) -> bool:
    """Whether the control rounds a computed distance to an increment that is not known."""
    here = lines.dialect.point_rule.required and address in DISTANCES
    if not here or lines.reading.crosses:
        return False
    said = lines.reading.increments
    return said is None or said.per_unit(address, False) is None


def rounded_openly(lines: Lines, line: int, address: str, value: float) -> bool:
    """Whether a word of a line becomes another value by such a rounding, perhaps."""
    if not rounds_openly(lines, address) or value == 0.0:
        return False
    same = coarse(value, address, bool(lines.inch[line]))
    return same != same


def _writes(meaning: Meaning) -> bool:
    """Whether blocks of a shape change parameters."""
    return bool(meaning.assignments) or meaning.runs_macro


class _Block:
    """One block that computes something; `value` are the number columns of its window."""

    def __init__(self, lines: Lines, line: int, value: Floats) -> None:
        assert lines.dialect.flow_rule.arithmetic is not None
        self.lines = lines
        self.line = line
        self.value = value
        self.arithmetic = lines.dialect.flow_rule.arithmetic
        self.meaning = lines.table.meanings[int(lines.shape[line])]
        self.expressions, self.assignments = self.meaning.expressions, self.meaning.assignments
        shapes = lines.table.shapes
        own = shapes.shapes[int(lines.shape[line])].layout is None or self.meaning.call
        if not own:  # it has other numbers than the line that was read
            self.expressions, self.assignments = computed_in(shapes.grammar.parse(self._text))

    def execute(self) -> None:
        """Compute the words, then the assignments; these take effect together, at the end."""
        first = int(self.lines.first[self.line])
        self._stay()
        for slot, word in self.expressions:
            self.value[first + slot] = self._word(word)
        changes = [self._assigned(statement) for statement in self.assignments]
        made = [change for change in changes if change is not None]
        for each in made:
            self.lines.parameters.update(self.arithmetic.behind(each.key, each.value))
        self.lines.assigned += made
        if self.meaning.runs_macro and not self.meaning.lost_by <= self.lines.reading.inert_m:
            self.lines.parameters = forgotten(
                self.lines.parameters, self.arithmetic, bool(self.meaning.call)
            )

    def _stay(self) -> None:
        """Note the texts of what only the machine decides: flow words, and what they jump to."""
        place, undecided = self.line + self.lines.window.first_line, self.lines.undecided
        items = self.lines.table.shapes.grammar.parse(self._text).items if undecided else ()
        number = bare_text(self._text[: _label_end(items)])
        self.lines.parameters |= dict.fromkeys(undecided.forgets.get(place, ()), UNKNOWN)
        if place in undecided.labels:
            self.lines.unknown.append(Unknown(self.line, number or "without a number", ""))
        for item in items if place in undecided.lines else ():
            if isinstance(item, Statement) and item.kind != "assignment":
                self._keep(item, item.tree, Evaluator(self.arithmetic, self.lines.parameters))
                if item.kind == "if_then":
                    self._perhaps(item)

    def _perhaps(self, item: Statement) -> None:
        """Note an assignment that may be made or not."""
        evaluator = Evaluator(self.arithmetic, self.lines.parameters)
        key = settable(self.arithmetic, evaluator.key(item.tree.children[-1].children[0]))
        text = bare_text(self._text[item.start : item.end])
        line = self.lines.window.first_line + self.line
        self.lines.parameters[key] = UNKNOWN
        self.lines.assigned.append(Assigned(line, key, UNKNOWN, text))

    def _word(self, word: Word) -> float:
        """Return the value of a word, nan where only the machine knows it, and after a finding."""
        assert isinstance(word.value, Expression)
        evaluator = Evaluator(self.arithmetic, self.lines.parameters, in_word=True)
        try:
            value = evaluator.value(word.value.tree)
            if isinstance(value, Null):
                raise NoValueError(f"{word.address} is null here", "leave the word out")
            if word.address in self.arithmetic.whole and not self.meaning.is_length(word.address):
                value = float(whole(value, self.arithmetic.whole_slip))
            may = may_be_unknown(word.address, self.meaning)
            if may and rounded_openly(self.lines, self.line, word.address, value):
                self._keep(word, word.value.tree, evaluator, rounded=True)
                return UNKNOWN
        except NoValueError as why:
            if why.lost and may_be_unknown(word.address, self.meaning):
                self._keep(word, word.value.tree, evaluator)
            else:
                self._refuse(why, word)
        else:
            return value
        return UNKNOWN

    def _keep(
        self, item: Word | Statement, tree: Any, evaluator: Evaluator, rounded: bool = False
    ) -> str:
        """Note that the text of an item has to stay, for its value is not known; return it."""
        kept, hangs = bare_text(self._text[item.start : item.end]), hangs_on(tree, evaluator)
        if isinstance(item, Word) and self._is_measured(item.address):
            hangs = hangs or "units"
        self.lines.unknown.append(Unknown(self.line, kept, hangs, rounded))
        return kept

    def _is_measured(self, address: str) -> bool:
        """Whether the value of a word is in the unit of the program."""
        set_ = address != "P" and is_set(address, self.meaning)
        return set_ or address in self.meaning.axes + "F"

    @cached_property
    def _text(self) -> str:
        return self.lines.window.line(self.line).decode("latin-1")

    def _assigned(self, statement: Statement) -> Assigned | None:
        """Return a parameter and its new value, nan if that is not known; None after a finding."""
        evaluator = Evaluator(self.arithmetic, self.lines.parameters)
        parameter, expression = statement.tree.children
        line = self.lines.window.first_line + self.line
        try:
            key = settable(self.arithmetic, evaluator.key(parameter))
        except NoValueError as why:
            self._refuse(why, statement)
            return None
        if self.arithmetic.writes_table(key) and key_set(statement) is None:
            message = (
                f"{written(key)} belongs to a table of the control, and its number is computed"
            )
            self._refuse(NoValueError(message, code="GX206"), statement)
        try:
            return Assigned(line, key, evaluator.value(expression))
        except NoValueError as why:
            if not why.lost:
                self._refuse(why, statement)
                return Assigned(line, key, UNKNOWN)
        return Assigned(line, key, UNKNOWN, self._keep(statement, statement.tree, evaluator))

    def _refuse(self, why: NoValueError, item: Word | Statement) -> None:
        place = item.start, item.end
        if isinstance(why, LocatedError):
            place = why.start, why.end
        diagnostic = Diagnostic(why.code, why.message, hint=why.hint)
        self.lines.findings.add_at(self.line, place, diagnostic)


def _undecided(lines: Lines) -> list[int]:
    """Return the lines of a window with what only the machine decides."""
    first, found = lines.window.first_line, lines.undecided
    there = {*found.lines, *found.labels, *found.forgets}
    return sorted(n - first for n in there if 0 <= n - first < lines.live)


def _label_end(items: tuple[Item, ...]) -> int:
    """Return where the sequence number of a block ends that begins with one."""
    for item in items:
        if isinstance(item, Word) and item.address == "N":
            return item.end
        if isinstance(item, Mark) and item.kind == "label":
            return item.end
    return 0
