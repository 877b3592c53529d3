"""What a control makes of its canned cycles, as data: the steps of each and the rules around them.

A hole is drilled from a level at which the tool comes to it; every step of a cycle goes from there
to one of a few levels, at rapid or at the feed, and something may be done when it has arrived.
Pecking is the only thing that is not a fixed list of steps. Nothing here is true of every control:
each dialect has a `CycleRule` of its own, or that of its relative with changes (`replace`).
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import IntEnum

from gcxform.values import dataclass

DWELL = "DWELL"
STOP = "M5"
FORWARD = "M3"
REVERSE = "M4"
HALT = "M0"
ORIENT = "M19"
RESUME = "RESUME"
"""What may be done after a step; RESUME is M3 or M4, as the spindle turned before the cycle."""


class Level(IntEnum):
    """Where along the normal axis a step ends.

    BOTTOM: the depth of the hole. MIDDLE: how far a back boring goes up (G87). CLEARANCE: the
    R level. RETRACT: the level at which the cycle ends, as G98 or G99 chooses.
    """

    BOTTOM = 0
    MIDDLE = 1
    CLEARANCE = 2
    RETRACT = 3


@dataclass(frozen=True, slots=True)
class Step:
    """One move of a cycle: at the feed or at rapid, to a level, perhaps shifted by I, J, K.

    `then` names what is done when the move has ended.
    """

    feeds: bool
    level: Level
    then: tuple[str, ...] = ()
    shifted: bool = False


def feed(level: Level, *then: str) -> Step:
    """Return a step at the feed."""
    return Step(True, level, then)


def rapid(level: Level, *then: str, shifted: bool = False) -> Step:
    """Return a step at rapid."""
    return Step(False, level, then, shifted)


def tap(forward: str, reverse: str, level: Level = Level.RETRACT) -> tuple[Step, ...]:
    """Return the steps of tapping: in, and out at the feed to a level with the spindle reversed."""
    return (feed(Level.BOTTOM, STOP, reverse, DWELL), feed(level, STOP, forward))


DRILL = (feed(Level.BOTTOM), rapid(Level.RETRACT))
DRILL_DWELL = (feed(Level.BOTTOM, DWELL), rapid(Level.RETRACT))
BORE_STOP = (feed(Level.BOTTOM, STOP), rapid(Level.RETRACT, RESUME))
TAPPING = frozenset({74, 84})


@dataclass(frozen=True, slots=True)
class Cycle:
    """One canned cycle.

    steps       what it does, without pecking
    pecks       whether its first step is done in pecks, and where the tool goes between them:
                "clear" up to R and back down, "break" a little up
    needs       the words of P Q I J K that must have been given when it runs
    takes       the words of P Q I J K, and the one that counts repeats, that it may have; any other
                is refused
    spindle     how the spindle must turn: +1 (M3), -1 (M4); an empty tuple: it does not matter
    open_words  words that leave its moves open when they are in force
    refused     why it is not expanded; with `steps`, that to the hole and out of it, it may stay
    xy_only     why it is not expanded outside G17
    """

    steps: tuple[Step, ...] = ()
    pecks: str = ""
    needs: str = ""
    takes: str = ""
    spindle: tuple[int, ...] = ()
    open_words: str = ""
    refused: str = ""
    xy_only: str = ""


@dataclass(frozen=True, slots=True)
class Staying:
    """Which words of a canned cycle stay in force.

    words   R, Z, P, Q stay when another cycle is programmed; otherwise they must be given. Where no
            P has been, how long it dwells is not known, and its block stays
    levels  R and Z that were given in G90 stay levels behind a G91; otherwise, and where distances
            are in force behind a G90, what they are is not known
    dwell   the last P stays for good, for cycles that take P but do not need it; 0 s before the
            first one of the program
    """

    words: bool = False
    levels: bool = False
    dwell: bool = False


@dataclass(frozen=True)
class CycleRule:
    """The canned cycles of a control.

    cycles          by number: 81 is G81
    peck_return     mm; how far the tool goes up between the pecks of "break"; None: not known
    peck_clearance  mm; how far above the last depth a peck of "clear" begins; None: not known
    rises_first     from below R the tool rises to R before it goes to the hole; the initial level
                    then counts as R. Under G98 it goes to the next hole at the initial level, from
                    wherever it stands at or below R
    stays           which words of a cycle stay
    stores          a block without X, Y, Z, R, or with no repeats, stores words and drills nothing;
                    otherwise it is refused
    alone           the setting of the control that says "drills" if a block drills which names no
                    place in the plane; "": it always drills. Where the setting is not given such a
                    block stays, and the level behind it is not known
    turns           a call turns the rotary axes that it names while the tool goes to the hole, and
                    drills; otherwise it is refused
    one_plane       the plane may not change while a cycle is in force
    repeats         the word that counts the repeats
    initial_level   whether a program starts in G98
    taps_float      taps go at the feed alone, for a floating chuck: in step with the spindle is no
                    cycle, but G33.1
    patterns        kept codes that drill the cycle in force at places of their own, as G70 of Haas:
                    no others may stand where a cycle is in force
    """

    cycles: Mapping[int, Cycle]
    peck_return: float | None = None
    peck_clearance: float | None = None
    rises_first: bool = False
    stays: Staying = Staying()
    stores: bool = False
    alone: str = ""
    turns: bool = False
    one_plane: bool = True
    repeats: str = "L"
    initial_level: bool = True
    taps_float: bool = False
    patterns: frozenset[str] = frozenset()

    def place_is_open(self, control: Mapping[str, str | float]) -> bool:
        """Tell whether a setting that is not given decides if a block without a place drills."""
        return bool(self.alone) and control.get(self.alone) != "drills"

    def hint_without_place(self, first: str, second: str) -> str:
        """Return what to do about a block that names neither of two axes, if that is open."""
        say = f'{self.alone} = "drills" in [control] of the machine file'
        return f"give {first} or {second}, or say {say}"
