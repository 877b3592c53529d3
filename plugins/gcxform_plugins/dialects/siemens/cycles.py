"""Drilling cycles of a SINUMERIK as plain moves, and calls that move nothing."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

import gcxform as gx

CALLED = re.compile(r"([A-Z_]\w*)[ \t]*\((.*)\)", re.IGNORECASE | re.DOTALL)
PARTS = re.compile(r'"[^"]*"|[^,"]+|,')
HOLE, PATH = "G65.1", "G65.2"
"""The codes of blocks that stand for cycles which are called as they stand."""
KEPT = "called as they stand, from places corrected for the height of the tool there: {}"
SECONDS = "10"
"""AMODE of drilling cycles where dwells are in seconds, and depths as ever."""
MODES = 3
"""GMODE, DMODE and AMODE, behind the last argument of the hole itself."""
PLANES = {"Z": "1", "Y": "2", "X": "3"}
"""DMODE where it names the plane, by the axis across that."""
ABSOLUTE = ("2", "12")
"""AMODE where a depth is absolute, by its ones."""
AS_EVER = ("", "0", "2")
"""The ones of AMODE where DP is absolute, as it is without."""
DIGITS = re.compile(r"[0-9]{1,7}")
QUALITY = re.compile(r"_?(?:ORI_)?(?:OFF|FINISH|SEMIFIN|ROUGH)")
WORDY = re.compile(r"[A-Z_]", re.IGNORECASE)
NO_RETRACT, PLAIN_MODE = "0", re.compile(r"[0-9]*")


def arguments(call: gx.Item) -> tuple[str, list[str]]:
    """Return the name of what is called, and its arguments without blanks."""
    found = CALLED.fullmatch(call.name)
    assert found is not None
    parts = [""]
    for part in PARTS.findall(found[2]):
        if part == ",":
            parts.append("")
        else:
            parts[-1] += part.strip()
    return found[1], parts


Steps = tuple[tuple[str, str, str], ...]


@dataclass(frozen=True, slots=True)
class Drilling:
    """A hole along the axis across the plane, as blocks have it.

    steps     code, level and feed of each move at a place: 0 rapid, 1 at the feed, nothing for the
              one in force; code 4 is a dwell, of seconds
    own_feed  it has feeds of its own: behind one that is read which is in force is not known
    kept      the call, where it stays as it stands: it ends at the level of its one step, if any
    ground    how deep that goes, where it bores and that is known
    of_before it stays, and drills at the feed before it alone: that is in force behind it too
    cuts      it stays, and moves in the plane as well, where no manual tells
    """

    axis: str
    steps: Steps
    own_feed: bool = False
    kept: str = ""
    cuts: bool = False
    ground: str = ""
    of_before: bool = False


ONE_FEED = frozenset(("CYCLE81", "CYCLE82", "CYCLE87", "CYCLE88", "CYCLE89"))
FRF = 10
"""The argument of CYCLE83 that slows its first stroke."""


class CycleError(Exception):
    """Arguments that are not understood."""


def drilling(name: str, given: Sequence[str], axis: str) -> Drilling:
    """Return the hole of a cycle. Raises CycleError."""
    at, rest = _levels(given), _without_modes(name, given, axis)
    steps = READ[name](rest, at)
    return Drilling(axis, (("0", at.start, ""), *steps, ("0", at.back, "")), name == "CYCLE85")


def _without_modes(name: str, given: Sequence[str], axis: str) -> list[str]:
    """Return what stands behind the depth, without DMODE and AMODE that change nothing.

    Their ones are the plane and how the depth is meant (public NCXchange specification of Siemens
    programs). The call has to have all arguments: some leave the dwell of CYCLE81 out.
    """
    rest, at = list(given[5:]), OF_HOLE.get(name, len(given))
    plane, how = [*rest[at + 1 : at + MODES], "", ""][:2]
    if plane == PLANES[axis]:
        rest[at + 1] = "0"
    if how in ABSOLUTE and given[3] and not given[4]:
        rest[at + 2] = SECONDS
    return rest


def kept_hole(name: str, given: Sequence[str], axis: str, text: str, deep: bool) -> Drilling:
    """Return the hole of a cycle that is called as it stands. Raises CycleError.

    `deep`: how deep it goes matters.

    It moves along the axis across the plane, and ends at RTP over the place at which it was called;
    CYCLE86 comes back there from where it has lifted the tool off (Cycles 11.02, 2.1). CYCLE840
    taps at the feed in force where it has no encoder.
    """
    values = [*given, *[""] * MOST_GIVEN]
    along, plane = OF_CALL[name]
    if (along and values[along] not in ("", "0")) or (
        plane and values[plane] not in ("", "0", PLANES[axis])
    ):
        raise CycleError("along which axis it moves is said behind its depth")
    if not plane and any(given[along + 1 :]):
        raise CycleError("what stands behind its axis is not known")
    own_feed = name == "CYCLE84"
    ground = _ground(values, values[plane + 1] if plane else "") if deep else ""
    out = (("", _number(given[0], "RTP"), ""),)
    return Drilling(axis, out, own_feed, text, False, ground, _at_one_feed(name, values))


def _at_one_feed(name: str, values: Sequence[str]) -> bool:
    """Whether a cycle has no feed among its arguments but a factor (FRF) of 1."""
    return name in ONE_FEED or (name == "CYCLE83" and values[FRF] in ("", "0", "1"))


def _ground(values: Sequence[str], mode: str) -> str:
    """Return how deep a hole is; `mode` is its AMODE. Raises CycleError."""
    if mode[-1:] not in AS_EVER:
        raise CycleError("AMODE says that its depth is no absolute one")
    level = Decimal(_number(values[1], "RFP"))
    return _depth(values[3], values[4], level, "DP", "DPR")


def texts_in(given: Sequence[str]) -> list[str]:
    """Return the texts among arguments, which may name a contour, or where it begins or ends."""
    return [each.strip('"') for each in given if each.startswith('"') and each != '""']


def kept_path(name: str, given: Sequence[str], axis: str, text: str) -> Drilling:
    """Return what a cycle that mills does, and is called as it stands. Raises CycleError.

    Those of a known list of arguments end at RTP (Cycles 11.02, chapter 3); of others nothing is
    known but that they return modes and frames as they were (1.4).
    """
    if any(WORDY.search(each) for each in given if not each.startswith('"')):
        raise CycleError("which contour it takes, or how, is in a variable of the control")
    ends = name.startswith(("POCKET", "SLOT", "LONGHOLE"))
    steps = (("", _number(given[0], "RTP"), ""),) if ends else ()
    return Drilling(axis, steps, True, text, True)


class Levels(NamedTuple):
    """Where a cycle ends, the surface, where its feed begins, and the depth."""

    back: str
    plane: str
    start: str
    bottom: str


def _levels(given: Sequence[str]) -> Levels:
    """Return the levels of a cycle. Raises CycleError."""
    values = [*given, *[""] * 5]
    back, plane, gap = (_number(values[k], what) for k, what in enumerate(("RTP", "RFP", "SDIS")))
    level = Decimal(_number(plane, "RFP"))
    bottom = _depth(values[3], values[4], level, "DP", "DPR")
    start = format(level + abs(Decimal(gap)), "f")
    if not Decimal(bottom) < level <= Decimal(start) <= Decimal(back):
        raise CycleError("its levels are not in order: depth, reference, start, return")
    return Levels(back, plane, start, bottom)


def _depth(absolute: str, below: str, level: Decimal, *names: str) -> str:
    """Return a depth that is given absolute, or below the reference plane. Raises CycleError."""
    if absolute and below and Decimal(_number(below, names[1])):
        raise CycleError(f"both {names[0]} and {names[1]} are given")
    if absolute:
        return _number(absolute, names[0])
    return format(level - abs(Decimal(_number(below, names[1]))), "f")


def _nothing_more(rest: Sequence[str]) -> None:
    """Refuse arguments behind those that are read: GMODE, DMODE, AMODE. Raises CycleError."""
    others = [x for k, x in enumerate(rest) if not (k == MODES - 1 and x == SECONDS)]
    if any(x and not (gx.NUMBER.fullmatch(x) and Decimal(x) == 0) for x in others):
        raise CycleError("an argument behind the depth is not read")


def _drilled(rest: list[str], at: Levels) -> Steps:
    """CYCLE81: feed to the depth; with four arguments behind that, the first is a dwell."""
    if len(rest) > MODES:
        return _with_dwell(rest, at)
    _nothing_more(rest)
    return (("1", at.bottom, ""),)


def _with_dwell(rest: list[str], at: Levels) -> Steps:
    """CYCLE82: feed to the depth, dwell."""
    dwell = _seconds(rest[0]) if rest else ""
    _nothing_more(rest[1:])
    return (("1", at.bottom, ""), *_wait(dwell))


def _bored(rest: list[str], at: Levels) -> Steps:
    """CYCLE89: feed to the depth, dwell, and out at the same feed."""
    return (*_with_dwell(rest, at), ("1", at.start, ""))


def _reamed(rest: list[str], at: Levels) -> Steps:
    """CYCLE85: in at FFR, dwell, out at RFF."""
    dwell, into, out = [*rest, "", "", ""][:3]
    _nothing_more(rest[3:])
    feeds = [_number(text, what) for text, what in ((into, "FFR"), (out, "RFF"))]
    if any(Decimal(feed) <= 0 for feed in feeds):
        raise CycleError("FFR and RFF have to be above 0")
    return (("1", at.bottom, feeds[0]), *_wait(_seconds(dwell)), ("1", at.start, feeds[1]))


def _pecked(rest: list[str], at: Levels) -> Steps:
    """CYCLE83: in strokes alike, each behind a way out (VARI 1), or a little back (VARI 0).

    The first counts from the surface. Only where arguments say all of it: what DAM, VRT and DIS1
    of 0 mean is in machine data.
    """
    first, by, less, dwell, above, slower, kind, axn, _, back, last, near = [*rest, *[""] * 12][:12]
    _nothing_more([axn])
    _nothing_more(rest[12:])
    if any(text and Decimal(_number(text, what)) for text, what in ((less, "DAM"), (by, "FDPR"))):
        raise CycleError("DAM or FDPR changes how deep a stroke is")
    if slower and Decimal(_number(slower, "FRF")) not in (0, 1):
        raise CycleError("FRF slows the first stroke")
    clear = {"0": False, "1": True}.get(kind)
    gap = near if clear else back
    if clear is None or not gap or Decimal(_number(gap, "DIS1 or VRT")) <= 0:
        raise CycleError("VARI, and DIS1 or VRT, have to be given: else machine data decide")
    depth = Decimal(_number(first, "FDEP"))
    end, top = Decimal(at.bottom), Decimal(at.plane)
    stroke = top - depth
    if not end <= depth < top or (top - end) / stroke > MOST:
        raise CycleError("FDEP is not between the surface and the depth")
    steps: list[tuple[str, str, str]] = []
    while depth > end:
        steps += [("1", format(depth, "f"), ""), *_wait(_seconds(dwell))]
        up = depth + Decimal(gap)
        if clear:
            steps += [("0", at.start, ""), *_wait(_seconds(above)), ("0", format(up, "f"), "")]
        else:
            steps.append(("1", format(up, "f"), ""))
        depth -= stroke
    final = last if last and Decimal(_number(last, "DTD")) else dwell
    return (*steps, ("1", at.bottom, ""), *_wait(_seconds(final)))


def _wait(seconds: str) -> Steps:
    return (("4", seconds, ""),) if seconds else ()


OF_HOLE = {"CYCLE81": 1, "CYCLE82": 1, "CYCLE89": 1, "CYCLE85": 3}
"""How many arguments of the hole itself stand behind the depth."""
READ = {
    "CYCLE81": _drilled,
    "CYCLE82": _with_dwell,
    "CYCLE83": _pecked,
    "CYCLE85": _reamed,
    "CYCLE89": _bored,
}
"""The cycles that are read, with the steps between the start and the way back."""
OF_CALL = {
    **{"CYCLE81": (0, 7), "CYCLE82": (0, 7), "CYCLE83": (12, 18), "CYCLE84": (12, 22)},
    **{"CYCLE840": (11, 0), "CYCLE85": (0, 9), "CYCLE86": (0, 12), "CYCLE87": (0, 7)},
    **{"CYCLE88": (0, 8), "CYCLE89": (0, 7)},
}
"""Those that may stay as they stand, with the places of AXN, the axis, and of DMODE, the plane,
among their arguments; 0 where there is none, or it is not known."""
MOST_GIVEN = 24


def row(given: Sequence[str], stands: Sequence[Decimal | None]) -> list[tuple[Decimal, Decimal]]:
    """Return the places of HOLES1 in the plane. Raises CycleError.

    It may begin at the end that is nearer to the tool, or always at the first: where the first is
    the nearer one both are the same.
    """
    if len(given) != 6:
        raise CycleError("it takes six arguments")
    names = ("SPCA", "SPCO", "STA1", "FDIS", "DBH")
    a, b, angle, first, step = (
        Decimal(_number(text or "0", what)) for text, what in zip(given, names, strict=False)
    )
    if not given[5].isdigit() or not 0 < int(given[5]) <= MOST:
        raise CycleError("NUM counts no holes")
    turn = math.radians(float(angle))
    x, y = Decimal(repr(math.cos(turn))), Decimal(repr(math.sin(turn)))
    along = [first + k * step for k in range(int(given[5]))]
    places = [(a + d * x, b + d * y) for d in along]
    ends = [
        math.dist([float(s) for s in stands if s is not None], [float(p) for p in place])
        if None not in stands
        else math.nan
        for place in (places[0], places[-1])
    ]
    if len(places) > 1 and not ends[0] < ends[1] - CLEARLY:
        raise CycleError("it may begin at either end: let the tool stand nearer to the first hole")
    return places


CLEARLY = 0.01  # mm


def circle(given: Sequence[str]) -> list[tuple[Decimal, Decimal]]:
    """Return the places of HOLES2 in the plane, in their order. Raises CycleError.

    The first is at STA1, each further one by INDA, or by as much as goes round (Operating p. 286).
    """
    if len(given) != 6:
        raise CycleError("it takes six arguments")
    names = ("CPA", "CPO", "RAD", "STA1", "INDA")
    a, b, radius, first, step = (
        Decimal(_number(text or "0", name)) for text, name in zip(given, names, strict=False)
    )
    if not given[5].isdigit() or not 0 < int(given[5]) <= MOST or radius <= 0:
        raise CycleError("NUM counts no holes, or RAD is not above 0")
    count = int(given[5])
    angles = [math.radians(float(first + k * (step or Decimal(360) / count))) for k in range(count)]
    turns = [(Decimal(repr(math.cos(t))), Decimal(repr(math.sin(t)))) for t in angles]
    return [(a + radius * x, b + radius * y) for x, y in turns]


MOST = 9999  # holes of a pattern


def _number(text: str, what: str) -> str:
    """Return an argument that is a number. Raises CycleError."""
    if not gx.NUMBER.fullmatch(text):
        raise CycleError(f"{what} is not a plain number")
    return text


def _seconds(text: str) -> str:
    """Return a dwell; nothing for none. Raises CycleError."""
    value = Decimal(_number(text, "DTB")) if text else Decimal(0)
    if value < 0:
        raise CycleError("the dwell is in turns of the spindle")
    return text if value else ""


def keeps_path(given: Sequence[str], following: bool) -> bool:
    """Whether CYCLE832 changes nothing but tolerances; `following`: TRAORI is in force.

    It is told by name, or by digits. Of these the tens say whether a tolerance of the tool axis
    comes behind (PM 1108); in calls of two values, of older cycles, whether TRAORI is switched on,
    or off [K].
    """
    if given == [""]:
        return True
    if len(given) not in (2, 3, 4) or not all(
        gx.NUMBER.fullmatch(x) for x in (given[0], *given[2:])
    ):
        return False
    if DIGITS.fullmatch(given[1]):
        tens = given[1].zfill(2)[-2]
        return tens in ("01" if len(given) > 2 else "1" if following else "0")
    return QUALITY.fullmatch(given[1].upper()) is not None


def swivels_nowhere(given: Sequence[str]) -> bool:
    """Whether CYCLE800 has neither angles nor shifts, and does not draw back."""
    if len(given) not in (14, 15, 16) or given[0] != NO_RETRACT:
        return False
    numbers = given[4:13]
    return all(not x or (gx.NUMBER.fullmatch(x) and not Decimal(x)) for x in numbers)
