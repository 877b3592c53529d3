"""What the blocks of one shape mean in a dialect: modal groups, words, events, and acts on frames.

It is worked out in `gcxform/modal/meaning/sorting.py`.
"""

from __future__ import annotations

from dataclasses import field

from gcxform.syntax.tree import Statement, Word
from gcxform.values import dataclass

DRILL_WORDS = "PQLK"
"""Words that only a canned cycle in force may want."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why blocks of a shape are refused: a code of the catalogue, a column from 0, a sentence."""

    code: str
    column: int
    width: int
    message: str
    hint: str = ""


@dataclass(frozen=True, slots=True)
class EventShape:
    """An event of every block of a shape: its name, and the slots of the words it takes.

    `order` sorts the events of a block; `after`: it happens after the block's motion; `aside`: it
    stands behind a slash within the block, so that a switch of the control decides on it alone.
    """

    order: int
    what: str
    slots: tuple[tuple[str, int], ...] = ()
    after: bool = False
    aside: bool = False


@dataclass(frozen=True, slots=True)
class Act:
    """Something that a block does to the frame, or a move of its own.

    What it does is in `gcxform/modal/frames/acts.py`.

    `slots` are those of the words it takes; `column` and `width` where its code stands.
    """

    name: str
    code: str
    slots: tuple[tuple[str, int], ...]
    column: int
    width: int


ACT_ORDER = (
    "call",
    "table",
    "change-tool",
    "set-tool",
    "user-code",
    "tip-on",
    "tip-off",
    "tip-kept-on",
    "tip-kept-off",
    "diameter",
    "length",
    "length-negative",
    "length-vector",
    "length-add",
    "length-number",
    "offset-of-tool",
    "no-length",
    "vectors",
    "no-vectors",
    "tip",
    "follow-tip",
    "plane",
    "no-plane",
    "work",
    "polar",
    "no-polar",
    "rotate",
    "no-rotate",
    "scale",
    "no-scale",
    "mirror",
    "no-mirror",
    "define-plane",
    "set-work",
    "local",
    "preset",
    "preset-clear",
    "preset-suspend",
    "preset-restore",
    "store-home",
    "orient",
    "swivel",
    "turn-to",
    "home",
    "machine",
    "probe",
)
"""The order in which a block's acts are done; those with the name of a move are its motion."""
STILL_WORDS = frozenset("NS")
ORIENTING = frozenset({"orient", "swivel", "turn-to"})
"""Acts that turn the tool onto a plane."""
OWN_MOVES = ORIENTING | {"home", "machine", "probe"}
FRAMING = frozenset(
    {"diameter", *ORIENTING, *ACT_ORDER[ACT_ORDER.index("work") : ACT_ORDER.index("store-home")]}
)
"""Acts that folding takes into the words of moves, so that their codes are not written."""
PRESETS = frozenset({"preset", "set-work", "store-home"})
"""Acts whose effect may depend on where the axes stand."""
LENGTHENED = frozenset(
    {
        *("length", "length-negative", "length-vector", "length-add", "length-number", "no-length"),
        *("offset-of-tool", "vectors", "no-vectors", "follow-tip"),
    }
)
"""What puts another tool length in force, or none."""
SWITCHED = frozenset(
    {"tip-on", "tip-off", "tip-kept-on", "tip-kept-off", "follow-tip", "no-length"}
)
"""What may let the control follow the tip, or not any more: G49 ends a length that does."""
ZEROING = PRESETS | {"local", "preset-restore"}
"""Acts that say where coordinates, or ways home, count from."""
TAKES_MOTION = frozenset(
    {"home", "store-home", "set-work", "local", "preset", "length-vector", "define-plane"}
)
"""Acts whose axis words are theirs, so that the block can have no other motion."""


@dataclass(slots=True)
class Meaning:
    """What a block of a shape does, but for its numbers.

    `lengths` are the words that codes take for themselves and that are in the unit of the program:
    code, address, slot. `lent` are words that codes take which a move of the block may want as
    well: the code by address. `choices` are what was chosen among several meanings, in sentences.
    `corner` is the word that puts a chamfer or an arc into the corner at the end of the move.
    `sends`: it sends something out; `prints` is on what the values that it prints hang.
    `call` is the code of a block that calls a program and is kept, `call_slots` are its numbers.
    """

    groups: dict[str, str] = field(default_factory=dict)
    slots: dict[str, int] = field(default_factory=dict)
    axes: str = ""
    centres: str = ""
    dwell: bool = False
    deleted: bool = False
    ends: bool = False
    loses_position: bool = False
    lost_by: set[int] = field(default_factory=set)
    percent: bool = False
    runs_macro: bool = False
    assignments: list[Statement] = field(default_factory=list)
    expressions: list[tuple[int, Word]] = field(default_factory=list)
    marked: bool = False
    changes_tool: bool = False
    bars_comp: tuple[str, str] = ("", "")
    events: list[EventShape] = field(default_factory=list)
    acts: list[Act] = field(default_factory=list)
    lengths: list[tuple[str, str, int]] = field(default_factory=list)
    drill_words: str = ""
    corner: str = ""
    lent: dict[str, str] = field(default_factory=dict)
    refusal: Refusal | None = None
    choices: tuple[str, ...] = ()
    sends: bool = False
    prints: str = ""
    call: str = ""
    call_slots: tuple[tuple[str, int], ...] = ()

    def is_length(self, address: str) -> bool:
        """Whether a code takes a word as a length: D of G41.1, where D of G41 is a number."""
        return any(taken == address for _, taken, _ in self.lengths)

    @property
    def is_still(self) -> bool:
        """Whether the block neither moves anything nor changes a mode: it waits, counts or tells.

        Its assignments and its errors aside.
        """
        changes = self.ends or self.loses_position or self.changes_tool or self.runs_macro
        changes = changes or self.percent or self.sends or bool(self.acts or self.refusal)
        still = set(self.slots) <= STILL_WORDS and set(self.groups.values()) <= {"G4"}
        return still and not changes

    @property
    def switches(self) -> bool:
        """Whether no other block hangs on whether the block is executed."""
        return self.is_still and not (self.assignments or self.expressions or self.prints)

    @property
    def asides(self) -> bool:
        """Whether a slash within the block leaves codes behind it to a switch of the control."""
        return any(event.aside for event in self.events)

    @property
    def compensates(self) -> bool:
        """Whether the block turns cutter compensation on."""
        return self.groups.get("cutter-comp", "G40") != "G40"
