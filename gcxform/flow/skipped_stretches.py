"""What a stretch of blocks changes that a jump may leave out, as far as that can be carried.

Axes that it moves are lost behind it, and the feed. Modes that it changes must be programmed before
a block depends on them. Frames, tools, cutter compensation and cycles are refused, and M codes of
the machine's own, unless its file says that they are inert.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace

import numpy as np

from gcxform.flow.run_state import RunState
from gcxform.modal.meaning.meaning import OWN_MOVES, Meaning
from gcxform.modal.meaning.tables import COLUMNS, CYCLES, NUMBER, MeaningTable
from gcxform.syntax.tree import Block
from gcxform.system.arrays import Flags, Ints, Small
from gcxform.system.distinct import distinct
from gcxform.values import dataclass

CARRIED = ("motion", "plane", "distance", "arc-distance")
"""Groups that may be changed, if they are programmed again before they count."""
UNMINDED = frozenset({"spindle"})
MACRO = "an M code that may run a macro"


@dataclass(frozen=True, slots=True)
class Effect:
    """Letters of the axes that a stretch may have moved, F for the feed; `moves`: any axis."""

    letters: str

    @property
    def moves(self) -> bool:
        """Whether an axis is among them."""
        return bool(set(self.letters) - {"F"})


def is_still(meaning: Meaning, block: Block, inert_m: Set[int]) -> bool:
    """Whether a block neither moves anything nor changes a mode: it waits, counts or tells.

    `inert_m` are M codes of the machine's own of which its file says that they do not, either.
    """
    if meaning.lost_by and meaning.lost_by <= inert_m:
        meaning = replace(meaning, loses_position=False, runs_macro=False)
    return block.error is None and meaning.is_still and not meaning.deleted


def effect_of(run: RunState, table: MeaningTable, shapes: Ints, lines: Ints) -> Effect:
    """Return what written blocks change, by their shapes. Raises InputError.

    `lines` (n,) are those of the program that they stand for.
    """
    letters: set[str] = set()
    axes = run.dialect.axes
    for shape in distinct(shapes).tolist():
        meaning = table.meanings[shape]
        inert = meaning.lost_by <= run.reading.inert_m
        if why := _not_carried(meaning, inert):
            run.line = int(lines[np.argmax(shapes == shape)])
            message = f"{why} in a block of which only the machine knows whether it is executed"
            raise run.refusal("GX220", message, _way(meaning) if why == MACRO else "")
        letters |= {*meaning.axes} | ({"F"} if "F" in meaning.slots else set())
        own = any(act.name in OWN_MOVES for act in meaning.acts)
        if (meaning.loses_position and not inert) or (own and not meaning.axes):
            letters |= {*axes}
    return Effect("".join(sorted(letters)))


def _not_carried(meaning: Meaning, inert: bool) -> str:
    """Return what of a block cannot be carried on as lost; `inert`: its own M codes do nothing."""
    acts = [act.code for act in meaning.acts if act.name not in OWN_MOVES]
    cycles = [code for code in meaning.groups.values() if NUMBER.get(code) in CYCLES]
    if acts or cycles:
        return (acts + cycles)[0]
    if meaning.changes_tool or "T" in meaning.slots:
        return "a tool"
    if meaning.runs_macro and not inert:
        return MACRO
    return "an end" if meaning.ends else ""


def said_of_codes(meaning: Meaning) -> str:
    """Return what the machine file can say of the M codes of a block."""
    numbers = ", ".join(map(str, sorted(meaning.lost_by - {-1})))
    said = f"inert-m = [{numbers}] in [control] of the machine file"
    return f"{said}, beside those that it has" if numbers else ""


def _way(meaning: Meaning) -> str:
    said = said_of_codes(meaning)
    return f"if it runs none: {said}" if said else ""


@dataclass(frozen=True, slots=True)
class Join:
    """Where ways meet: the executed lines that they come from, its block, and its line."""

    jumps: tuple[int, ...]
    here: int
    line: int


def other_modes(
    run: RunState, table: MeaningTable, shape: Ints, joins: list[Join]
) -> tuple[int, str] | None:
    """Return a block and a code that is in force there or not, and counts; None if there is none.

    `shape` (n,) are the shapes of all written blocks.
    """
    groups = table.groups[shape]
    moves = np.any([table.flag(f, shape) for f in ("moves", "has_centre", "acts")], 0)
    for column, name in enumerate(COLUMNS):
        group = _Group(groups[:, column], _initial(run, name), moves)
        for join in group.open_at(joins):
            if name in CARRIED and not group.counts(join.here):
                continue
            if name not in UNMINDED:
                return join.line, f"another code of the group {name}"
        for join in joins if name in ("cutter-comp", "motion", "cycle") else ():
            since = min(join.jumps) + 1
            if _in_force(name, group.code(since)) and moves[since : join.here].any():
                return join.line, "cutter compensation or a canned cycle"
    return None


class _Group:
    """The codes of one modal group in written blocks; `moves` are those to which they matter."""

    def __init__(self, stated: Small, initial: int, moves: Flags) -> None:
        self.codes, self.initial = stated, initial
        number, count = np.arange(len(stated)), len(stated)
        self.last = np.maximum.accumulate(np.where(stated >= 0, number, -1))
        self.next = _next(np.where(stated >= 0, number, count))
        self.use = _next(np.where(moves, number, count))

    def stated_before(self, line: int) -> int:
        """Return the block that states the code in force before one; -1: none."""
        return int(self.last[line - 1]) if line > 0 else -1

    def code(self, line: int) -> int:
        """Return the code in force before a block, as they stand one behind the other."""
        at = self.stated_before(line)
        return int(self.codes[at]) if at >= 0 else self.initial

    def counts(self, line: int) -> bool:
        """Whether the code in force before a block counts before it is stated again."""
        return line < len(self.use) and self.use[line] < min(len(self.use), self.next[line])

    def open_at(self, joins: list[Join]) -> list[Join]:
        """Return the joins at which another code may be in force than that before them."""
        found, left = list[Join](), sorted(joins, key=lambda each: each.here)
        is_open = np.zeros(len(self.codes) + 1, np.bool_)

        def differs(join: Join) -> bool:
            ways = [*(jump + 1 for jump in join.jumps), join.here]
            loose = (is_open[self.stated_before(line) + 1 : line + 1].any() for line in ways)
            return any(self.code(line) != self.code(join.here) for line in ways) or any(loose)

        grown = True
        while grown:  # a way back comes in before what lies on it
            before = len(found)
            for join in left:
                if differs(join):
                    found.append(join)
                    is_open[join.here] = True
            left = [join for join in left if not is_open[join.here]]
            grown = len(found) > before
        return found


def _next(places: Ints) -> Ints:
    """Return of each place the first one from there on."""
    return np.minimum.accumulate(places[::-1])[::-1]


def _initial(run: RunState, group: str) -> int:
    code = run.dialect.initial.get(group)
    return NUMBER.get(code, -1) if code is not None else -1


def _in_force(group: str, number: int) -> bool:
    if group == "cutter-comp":
        return number > 0
    return group in ("motion", "cycle") and number in CYCLES
