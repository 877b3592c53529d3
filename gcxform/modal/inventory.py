"""What a program holds: motions, definitions, assignments, messages, stops, ends, M codes.

Both sides of a run are counted as they stand in their files, each by a reader of its own. Every
difference has a rule with a count, or the run has failed: nothing is lost in silence.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

import numpy as np

from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.meaning import OWN_MOVES, Meaning
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.syntax.tree import Block, Comment, Mark, Number, Statement, Word
from gcxform.system.arrays import Ints
from gcxform.values import dataclass

KINDS = (
    *("motions", "definitions", "assignments", "messages", "stops", "ends", "m_codes"),
    "path_modes",
)
"""Blocks that move; subprograms and names of programs; parameters that are set; comments that are
executed; M0, M1 and their like; M2 and M30; all other M codes but those of calls; G61,
G64 and their like."""
OF_CALLS = frozenset({70, 71, 72, 73, 97, 98, 99})
STOPS = frozenset({0, 1, 60})


def nothing_held() -> Ints:
    """Return counts (kinds,) of nothing."""
    return np.zeros(len(KINDS), np.int64)


def defines(block: Block) -> bool:
    """Return whether a program or a subprogram begins at a block."""
    for item in block.items:
        if isinstance(item, Statement) and item.kind == "flow":
            _, _, keyword, *_ = item.tree.children
            return str(keyword).lower() == "sub"
        if isinstance(item, Word) and item.address == "O":
            return True
        if isinstance(item, Mark) and item.kind in ("program_id", "program_name"):
            return True
    return False


class Tally:
    """Counts what lines hold: what lines of a shape do is looked up once."""

    def __init__(self) -> None:
        self.total = nothing_held()
        self._table: MeaningTable | None = None
        self._held: list[list[int]] = []

    def add(self, table: MeaningTable, shape: Ints) -> Ints:
        """Count lines of these shapes; return what they hold, (kinds,)."""
        if not len(shape):
            return nothing_held()
        held_by = self._held_by(table)
        times = np.bincount(shape, minlength=len(held_by))[: len(held_by)]
        held = times @ held_by
        self.total = self.total + held
        return np.asarray(held)

    def lines(self, table: MeaningTable, shape: Ints, kind: str) -> Ints:
        """Return which lines of these shapes (n,) hold something of a kind, ascending."""
        return np.flatnonzero(self._held_by(table)[shape, KINDS.index(kind)])

    def _held_by(self, table: MeaningTable) -> Ints:
        """Return what lines of each shape hold, (shapes, kinds)."""
        if table is not self._table:
            self._table, self._held = table, []
        for number in range(len(self._held), len(table.meanings)):
            block = table.shapes.shapes[number].block
            self._held.append(_held(block, table.meanings[number], table.dialect))
        return np.array(self._held, np.int64).reshape(-1, len(KINDS))


def _held(block: Block, meaning: Meaning, dialect: type[Dialect]) -> list[int]:
    """Return what a block holds, in the order of `KINDS`."""
    moves = bool(meaning.axes) or any(act.name in OWN_MOVES for act in meaning.acts)
    statements = [i for i in block.items if isinstance(i, Statement)]
    sets = sum(each.kind in ("assignment", "if_then") for each in statements)
    texts = [block.text[i.start : i.end] for i in block.items if isinstance(i, Comment)]
    codes = [_code(word) for word in block.words if word.address == "M"]
    ends = sum(code in dialect.m_codes and dialect.m_codes[code].ends for code in codes)
    stops = sum(code in STOPS for code in codes)
    others = sum(code not in OF_CALLS for code in codes) - ends - stops
    told = sum(map(dialect.text_rule.executes, texts)) + meaning.sends
    named = (dialect.codes[name] for name in meaning.groups.values() if name in dialect.codes)
    modes = sum(code.group == "path" for code in named)
    return [int(moves), int(defines(block)), sets, told, stops, ends, others, modes]


def kind_of(name: str, dialect: type[Dialect]) -> str:
    """Return as what of `KINDS` an event is counted, by its name; "" if as none."""
    name = name.removeprefix("/")
    if name.startswith(("(", ";")):
        return "messages"
    if name in dialect.codes:
        return "path_modes" if dialect.codes[name].group == "path" else ""
    if not name.startswith("M"):
        return ""
    number = int(name[1:])
    ends = number in dialect.m_codes and dialect.m_codes[number].ends
    return "ends" if ends else "stops" if number in STOPS else "m_codes"


def _code(word: Word) -> int:
    """Return the number of an M code; -1 for one that is computed."""
    return int(word.value.value) if isinstance(word.value, Number) else -1


@dataclass
class Account:
    """What happened to what a source holds, as counts (kinds,) by rule, with signs."""

    source: Ints = field(default_factory=nothing_held)
    output: Ints = field(default_factory=nothing_held)
    rules: dict[str, Ints] = field(default_factory=dict)

    def rule(self, name: str, counts: Ints, kinds: tuple[str, ...] = KINDS) -> None:
        """Add to the counts of a rule, for some of the kinds."""
        chosen = np.array([kind in kinds for kind in KINDS])
        self.rules[name] = self.rules.get(name, nothing_held()) + np.where(chosen, counts, 0)

    def rule_of(self, name: str, kind: str, count: int) -> None:
        """Add to the count of a rule for one kind."""
        self.rule(name, np.full(len(KINDS), count), (kind,))

    @property
    def rest(self) -> Ints:
        """What the output has more than the source and the rules say, (kinds,)."""
        ruled = sum(self.rules.values(), nothing_held())
        return np.asarray(self.output - self.source - ruled)

    def table(self) -> Mapping[str, dict[str, object]]:
        """Return the counts of each kind that is there, for the certificate."""
        found: dict[str, dict[str, object]] = {}
        for k, kind in enumerate(KINDS):
            rules = {name: int(counts[k]) for name, counts in self.rules.items() if counts[k]}
            source, output = int(self.source[k]), int(self.output[k])
            if source or output or rules:
                found[kind] = {"source": source, "output": output, "rules": rules}
        return found
