"""What a stretch of blocks changes that a jump may leave out, as far as that can be carried.

Axes that it moves are lost behind it, and the feed. Modes that it changes must be programmed before
a block depends on them. Frames, tools, cutter compensation and cycles are refused.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gcxform.flow.run_state import RunState
from gcxform.modal.meaning.meaning import OWN_MOVES, Meaning
from gcxform.modal.meaning.tables import COLUMNS, CYCLES, NUMBER
from gcxform.syntax.tree import Block
from gcxform.system.arrays import Flags, Ints, Small

CARRIED = ("motion", "plane", "distance", "arc-distance")
"""Groups that may be changed, if they are programmed again before they count."""
UNMINDED = frozenset({"spindle"})


@dataclass(frozen=True, slots=True)
class Effect:
    """Letters of the axes that a stretch may have moved, F for the feed; `moves`: any axis."""

    letters: str

    @property
    def moves(self) -> bool:
        """Whether an axis is among them."""
        return bool(set(self.letters) - {"F"})


def is_still(meaning: Meaning, block: Block) -> bool:
    """Whether a block neither moves anything nor changes a mode: it waits, counts or tells."""
    return block.error is None and meaning.is_still and not meaning.deleted


def effect_of(run: RunState, lines: Ints) -> Effect:
    """Return what executed lines of the program, from 0, change. Raises InputError."""
    letters: set[str] = set()
    axes = run.dialect.axes
    for shape in np.unique(run.listing.window.shape[lines]).tolist():
        meaning = run.listing.table.meanings[shape]
        if why := _not_carried(meaning):
            run.line = int(lines[np.argmax(run.listing.window.shape[lines] == shape)])
            message = f"{why} in a block of which only the machine knows whether it is executed"
            raise run.refusal("GX220", message)
        letters |= {*meaning.axes} | ({"F"} if "F" in meaning.slots else set())
        own = any(act.name in OWN_MOVES for act in meaning.acts)
        if meaning.loses_position or (own and not meaning.axes):
            letters |= {*axes}
    return Effect("".join(sorted(letters)))


def _not_carried(meaning: Meaning) -> str:
    """Return what of a block cannot be carried on as lost."""
    acts = [act.code for act in meaning.acts if act.name not in OWN_MOVES]
    cycles = [code for code in meaning.groups.values() if NUMBER.get(code) in CYCLES]
    if acts or cycles:
        return (acts + cycles)[0]
    if meaning.changes_tool or "T" in meaning.slots:
        return "a tool"
    if meaning.runs_macro:
        return "an M code that may run a macro"
    return "an end" if meaning.ends else ""


@dataclass(frozen=True, slots=True)
class Join:
    """Where jumps lead to: the executed lines they stand in, that of the join, and its block."""

    jumps: tuple[int, ...]
    here: int
    line: int


def other_modes(run: RunState, origin: Ints, joins: list[Join]) -> tuple[int, str] | None:
    """Return a block and a code that is in force there or not, and counts; None if there is none.

    `origin` (n,) are the lines of the program of all executed lines.
    """
    shape = run.listing.window.shape[origin]
    groups = run.listing.table.groups[shape]
    moves = np.any([run.listing.table.flag(f, shape) for f in ("moves", "has_centre", "acts")], 0)
    for column, name in enumerate(COLUMNS):
        stated, initial = groups[:, column], _initial(run, name)
        for join in _open_joins(stated, initial, joins):
            if name in CARRIED and not _counts(stated[join.here :], moves[join.here :]):
                continue
            if name not in UNMINDED:
                return join.line, f"another code of the group {name}"
        for join in joins:
            since = min(join.jumps)
            moved = moves[since + 1 : join.here].any()
            if moved and _in_force(name, _last(stated[: since + 1], initial)):
                return join.line, "cutter compensation or a canned cycle"
    return None


def _open_joins(stated: Small, initial: int, joins: list[Join]) -> list[Join]:
    """Return the joins at which the code of a group may be another one than that before it."""
    found: list[Join] = []
    for join in sorted(joins, key=lambda each: each.here):
        now = _last(stated[: join.here], initial)
        for jump in join.jumps:
            before = [e.here for e in found if e.here <= jump]
            loose = any((stated[here : jump + 1] < 0).all() for here in before)
            if loose or _last(stated[: jump + 1], initial) != now:
                found.append(join)
                break
        else:
            inner = [e.here for e in found if e.here < join.here]
            if any((stated[here : join.here] < 0).all() for here in inner):
                found.append(join)
    return found


def _last(values: Small, initial: int) -> int:
    stated = values[values >= 0]
    return int(stated[-1]) if len(stated) else initial


def _initial(run: RunState, group: str) -> int:
    code = run.dialect.initial.get(group)
    return NUMBER.get(code, -1) if code is not None else -1


def _in_force(group: str, number: int) -> bool:
    if group == "cutter-comp":
        return number > 0
    return group in ("motion", "cycle") and number in CYCLES


def _counts(stated: Small, moves: Flags) -> bool:
    """Whether a mode counts behind a stretch before it is stated again."""
    use = int(np.argmax(moves)) if moves.any() else len(moves)
    again = stated >= 0
    return use < len(moves) and not again[: use + 1].any()
