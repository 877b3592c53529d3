"""What a template is made of, and all that decides how a piece of a block is written."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

from gcxform.values import dataclass


class Role(IntEnum):
    """Which piece of its block a line is; NONE: the block does not move.

    VERBATIM: the block moves in a way of its own, and its words stay as they are. EVENT: what a
    canned cycle does between its moves, where it is written as plain moves. GONE: its move is a
    part of one that another block makes.
    """

    NONE = 0
    ONLY = 1
    FIRST = 2
    MIDDLE = 3
    LAST = 4
    VERBATIM = 5
    EVENT = 6
    GONE = 7


class Feed(IntEnum):
    """What happens to the feed word of a piece; PITCH: K is written instead, the way for a turn."""

    NONE = 0
    KEEP = 1
    WRITE = 2
    PITCH = 3


@dataclass(frozen=True, slots=True)
class Key:
    """All that decides how a piece of a block is written, but for its numbers.

    `motion`, `inch`, `incremental`, `absolute_centre`, `feed_mode`: what has to be stated; -1:
    nothing. `silent`: a motion code that moves nothing is left out.
    `expanded`: the block called a canned cycle, of which this is a move. `thread`: it is one whose
    code and K stay. `tap`: it is a canned cycle whose ends have moved; `apart`: one of its repeats,
    which become blocks of their own. `converted`: its words stay, in the other unit. `preset`: it
    sets a zero, for axes that stand elsewhere. `homed`: it goes home by G53. `arc`: whether centre
    words are written, in `plane`; `turns`: full turns beyond the arc.
    """

    role: Role
    motion: int
    inch: int
    incremental: int
    absolute_centre: int
    feed_mode: int
    silent: bool
    feed: Feed
    expanded: bool
    thread: bool
    tap: bool
    apart: bool
    converted: bool
    preset: bool
    homed: bool
    arc: bool
    plane: int
    turns: int

    @property
    def as_it_stands(self) -> bool:
        """Whether the motion of the block is left as it is."""
        return self.role in (Role.NONE, Role.VERBATIM)


@dataclass(frozen=True, slots=True)
class Literal:
    """Bytes written as they are."""

    text: bytes


@dataclass(frozen=True, slots=True)
class Copied:
    """The number in a slot of the source line, as it was written."""

    slot: int


@dataclass(frozen=True, slots=True)
class CopiedText:
    """The text in a slot of the source line: a comment, an expression, an assignment.

    `comment`: it is a comment, to be written as those of another dialect.
    """

    slot: int
    comment: bool = False


@dataclass(frozen=True, slots=True)
class Computed:
    """A word with the number that an expression in a slot of the source line is worth.

    `point`: it has a point also where it is a whole number.
    """

    address: str
    slot: int
    point: bool = False


@dataclass(frozen=True, slots=True)
class Converted:
    """A word with the length in a slot of the source line, in the other unit."""

    address: str
    slot: int


@dataclass(frozen=True, slots=True)
class Preset:
    """A word in a slot of the source line that sets a zero for axes that stand elsewhere."""

    address: str
    slot: int


@dataclass(frozen=True, slots=True)
class Wait:
    """The word by which the target waits for as long as the word in a slot of the source."""

    slot: int


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis word: left out where it need not be written, its gap where nothing is before it."""

    gap: bytes
    address: str


@dataclass(frozen=True, slots=True)
class CycleWord:
    """A word that says where a canned cycle goes."""

    gap: bytes
    address: str


@dataclass(frozen=True, slots=True)
class Centre:
    """A centre word; `index` is 0 for the plane's first axis, 1 for its second."""

    gap: bytes
    address: str
    index: int


@dataclass(frozen=True, slots=True)
class FeedWord:
    """The feed, formatted; or K, the way for each turn of the spindle."""

    gap: bytes
    which: Feed = Feed.WRITE

    @property
    def address(self) -> str:
        """The letter of the word."""
        return "K" if self.which is Feed.PITCH else "F"


Number = Copied | Computed | Converted | Preset | Wait
Field = Literal | Number | CopiedText | Axis | CycleWord | Centre | FeedWord


class CycleWords:
    """The words that say where a canned cycle goes, as they are written anew.

    They stand where the block has them; those that it has not stand behind its last one.
    """

    def __init__(self, addresses: str, named: Sequence[str], gap: bytes) -> None:
        self.waiting = list(addresses)
        self.named = set(named)
        self.gap = gap

    def at(self, address: str, lead: bytes) -> list[Field]:
        """Return what is written in the place of a word of the block."""
        self.waiting.remove(address)
        rest = [] if self.named & set(self.waiting) else self.rest(self.gap)
        return [CycleWord(lead, address), *rest]

    def rest(self, lead: bytes) -> list[Field]:
        """Return all that has not been written."""
        left, self.waiting = self.waiting, []
        gaps = [lead] + [self.gap] * len(left)
        return [CycleWord(gap, address) for gap, address in zip(gaps, left, strict=False)]
