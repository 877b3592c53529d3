"""Whether a dialect's codes do what controls agree on, and whether two things stay two.

Small programs are read. `FACTS` are worked out by hand: what a block does, by the definition of its
codes. Then everything that has a number is read with two of them, and each modal code behind each
other one of its group: two blocks that differ must differ in what they do, or be refused.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from itertools import combinations, permutations
from math import pi
from typing import Any

import numpy as np

from gcxform.api import read
from gcxform.diagnostics import GcxformError
from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import EXTRUDER, Dialect
from gcxform.machine.machine import Tool
from gcxform.modal.meaning.tables import FAMILIES, NUMBER
from gcxform.testing.canon import MEANINGS, WORK
from gcxform.testing.one_command import written_for
from gcxform.toolpath.path import Toolpath
from gcxform.values import dataclass

QUARTER, REST = pi / 2, 3 * pi / 2
PLANES = {"G17": "XY", "G18": "ZX", "G19": "YZ"}
MODES = ("G21", "G90", "G94", "G17", "G40", "G80", "G91.1")
START = "X10. Y20. Z5."
OFFSETS = {f"G{54 + n}": {"X": 100.0 * n, "Y": 0.0, "Z": 0.0} for n in range(6)}
HOMES = {name: {"X": 7.0 + k, "Y": 8.0, "Z": 9.0} for k, name in enumerate(("G28", "G30"))} | {
    f"G30 P{n}": {"X": 7.0 + n, "Y": 8.0, "Z": 9.0} for n in (2, 3, 4)
}
TOOLS = {n: Tool(length=40.0 + 10 * n, radius=1.0 * n) for n in (1, 2)}


@dataclass(frozen=True)
class Fact:
    """What the last move of a program does: `blocks` behind a start at X10 Y20 Z5 in G54."""

    blocks: str
    end: tuple[float, float, float]
    sweep: float = 0.0
    more: Mapping[str, float] = field(default_factory=dict)


FACTS: tuple[Fact, ...] = (
    Fact("G0 X1.", (1, 20, 5), more={"kind": 0}),
    Fact("G1 X30. Y25. Z-1.5 F100.", (30, 25, -1.5), more={"kind": 1, "feed": 100}),
    Fact("G91\nG1 X1. Y2. Z3. F100.", (11, 22, 8)),
    Fact("G91\nG90\nG1 X1. F100.", (1, 20, 5)),
    Fact("G20\nG1 X1. F10.", (25.4, 20, 5), more={"feed": 254}),
    Fact("G20\nG21\nG1 X1. F10.", (1, 20, 5), more={"feed": 10}),
    Fact("G93\nG1 X1. F2.", (1, 20, 5), more={"feed": 2, "feed_mode": 93}),
    Fact("G93\nG94\nG1 X1. F2.", (1, 20, 5), more={"feed": 2, "feed_mode": 94}),
    Fact("G95\nG1 X1. F2.", (1, 20, 5), more={"feed": 2, "feed_mode": 95}),
    Fact("G2 X20. Y10. I0. J-10. F100.", (20, 10, 5), QUARTER, {"kind": 2, "plane": 0}),
    Fact("G3 X20. Y10. I0. J-10. F100.", (20, 10, 5), REST, {"kind": 3}),
    Fact("G2 X20. Y10. R10. F100.", (20, 10, 5), QUARTER),
    Fact("G2 X20. Y10. R-10. F100.", (20, 10, 5), REST),
    Fact("G3 X0. Y10. I0. J-10. F100.", (0, 10, 5), QUARTER),
    Fact("G18\nG2 X20. Z-5. I0. K-10. F100.", (20, 20, -5), REST, {"plane": 1}),
    Fact("G18\nG3 X20. Z-5. I0. K-10. F100.", (20, 20, -5), QUARTER),
    Fact("G18\nG3 X20. Z-5. R10. F100.", (20, 20, -5), QUARTER),
    Fact("G19\nG2 Y30. Z-5. J0. K-10. F100.", (10, 30, -5), QUARTER, {"plane": 2}),
    Fact("G19\nG3 Y30. Z-5. J0. K-10. F100.", (10, 30, -5), REST),
    Fact("G19\nG2 Y30. Z-5. R10. F100.", (10, 30, -5), QUARTER),
    Fact("G18\nG17\nG2 X20. Y10. I0. J-10. F100.", (20, 10, 5), QUARTER),
    Fact("G90.1\nG2 X20. Y10. I10. J10. F100.", (20, 10, 5), QUARTER),
    Fact("G90.1\nG91.1\nG2 X20. Y10. I0. J-10. F100.", (20, 10, 5), QUARTER),
    Fact("G91\nG2 X10. Y-10. I0. J-10. F100.", (20, 10, 5), QUARTER),
    Fact("G41 D1\nG1 X30. F100.", (30, 20, 5), more={"side": 1}),
    Fact("G42 D1\nG1 X30. F100.", (30, 20, 5), more={"side": -1}),
    Fact("G41 D1\nG1 X30. F100.\nG40\nG1 X40.", (40, 20, 5), more={"side": 0}),
    *(Fact(f"G{54 + n}\nG1 X1. Y2. Z3. F100.", (100.0 * n + 1, 2, 3)) for n in range(6)),
    Fact("G55\nG54\nG1 X1. Y2. Z3. F100.", (1, 2, 3)),
    Fact("G43 H1\nG1 X1. Y2. Z3. F100.", (1, 2, 53)),
    Fact("G43 H2\nG1 X1. Y2. Z3. F100.", (1, 2, 63)),
    Fact("G44 H1\nG1 X1. Y2. Z3. F100.", (1, 2, -47)),
    Fact("G43 H1\nG49\nG1 X1. Y2. Z3. F100.", (1, 2, 3)),
    Fact("G43.1 Z5.\nG1 X1. Y2. Z3. F100.", (1, 2, 8)),
    Fact("G28 X5. Y5. Z5.", (7, 8, 9), more={"form": 2}),
    Fact("G30 X5. Y5. Z5.", (8, 8, 9), more={"form": 2}),
    Fact("G30 P3 X5. Y5. Z5.", (10, 8, 9), more={"form": 2}),
    Fact("G28.1\nG0 X1.\nG28 X2.", (10, 20, 5)),
    Fact("G55\nG53 G0 X5. Y6. Z7.", (5, 6, 7), more={"form": 3}),
    Fact("G52 X3. Y2.\nG1 X1. Y1. Z1. F100.", (4, 3, 1)),
    Fact("G92 X0. Y0.\nG1 X1. Y1. Z1. F100.", (11, 21, 1)),
    Fact("G92 X0. Y0.\nG92.1\nG1 X1. Y1. Z1. F100.", (1, 1, 1)),
    Fact("G92 X0. Y0.\nG92.2\nG1 X1. Y1. Z1. F100.", (1, 1, 1)),
    Fact("G92 X0. Y0.\nG92.2\nG92.3\nG1 X1. Y1. Z1. F100.", (11, 21, 1)),
    Fact("G10 L2 P1 X30. Y0. Z0.\nG1 X1. Y1. Z1. F100.", (31, 1, 1)),
    Fact("G10 L2 P2 X30. Y0. Z0.\nG55\nG1 X1. Y1. Z1. F100.", (31, 1, 1)),
    Fact("G10 L2 P6 X30. Y0. Z0.\nG59\nG1 X1. Y1. Z1. F100.", (31, 1, 1)),
    Fact("G68 X0. Y0. R90.\nG1 X3. Y1. Z1. F100.", (-1, 3, 1)),
    Fact("G68 X0. Y0. R90.\nG69\nG1 X3. Y1. Z1. F100.", (3, 1, 1)),
    Fact("G51.1 X0.\nG1 X3. Y1. Z1. F100.", (-3, 1, 1)),
    Fact("G51.1 X0.\nG50.1 X0.\nG1 X3. Y1. Z1. F100.", (3, 1, 1)),
    Fact("G16\nG1 X10. Y90. F100.", (0, 10, 5)),
    Fact("G16\nG15\nG1 X3. Y1. F100.", (3, 1, 5)),
    Fact("G7\nG1 X3. F100.", (1.5, 20, 5)),
    Fact("G98 G81 X1. Y2. Z-3. R2. F100.", (1, 2, 5)),
    Fact("G99 G81 X1. Y2. Z-3. R2. F100.", (1, 2, 2)),
    Fact("G98 G81 X1. Y2. Z-3. R2. F100.\nG80\nG0 X3. Y4.", (3, 4, 5), more={"kind": 0}),
)
"""Positions count from the zero of G54: OFFSETS, HOMES and TOOLS are the machine's."""


def check_doing(dialect: type[Dialect]) -> None:
    """Read programs in a dialect, and hold what they do to what is known. Raises AssertionError."""
    blocks: type[Dialect] = type("Blocks", (dialect,), {"translator": None})
    for fact in FACTS:
        _check_fact(blocks, fact)
    for check in (_dwells, _numbers, _work_offsets, _tools, _pairs):
        for message in check(blocks):
            raise AssertionError(f"{dialect.name}: {message}")


def _path(dialect: type[Dialect], blocks: str) -> Toolpath | None:
    """Return what blocks do behind a start at a known place; None where they are refused."""
    try:
        return _followed(dialect, blocks)
    except GcxformError:
        return None


def _followed(dialect: type[Dialect], blocks: str) -> Toolpath:
    """Return what blocks do behind a start at a known place. Raises GcxformError."""
    codes = dialect.codes
    modes = " ".join(m for m in MODES if m in codes and codes[m].effect is Effect.MODAL)
    frame = dialect.initial["frame"]
    lines = [modes, frame if frame in codes else "", f"G0 {START}", blocks]
    text = written_for(dialect, "\n".join(line for line in lines if line) + "\n")
    return read(text.encode(), dialect, **_reading(dialect)).path


def _reading(dialect: type[Dialect]) -> dict[str, Any]:
    given = {a: 0.0 for a in dialect.axes if a != EXTRUDER}
    homes = {name: {**given, **place} for name, place in HOMES.items()}
    offsets = {name: {**given, **place} for name, place in OFFSETS.items()}
    return {
        "start": given,
        "homes": homes,
        "work_offsets": offsets,
        "tools": TOOLS,
        "control": {"g52": "fanuc", "cycle-without-place": "drills"},
    }


def _here(dialect: type[Dialect], fact: Fact) -> str:
    """Return the blocks of a fact in the codes of a dialect; "" where it has none for them."""
    words: list[str] = []
    for word in fact.blocks.replace("\n", " \n ").split(" "):
        if word.startswith("G"):
            word = _code_here(dialect, word)
            if not word or _cuts_not(dialect, word, words):
                return ""
        elif _lacks(dialect, word, words):
            return ""
        words.append(word)
    return " ".join(words).replace(" \n ", "\n")


def _lacks(dialect: type[Dialect], word: str, before: list[str]) -> bool:
    """Whether a dialect has no use for a word: a radius, or a P behind G30."""
    if word.startswith("R"):
        return "R" not in dialect.block_rule.words
    home = word.startswith("P") and before[-1:] == ["G30"]
    return home and "P" not in dialect.codes["G30"].takes


def _cuts_not(dialect: type[Dialect], word: str, before: list[str]) -> bool:
    """Whether a code is an arc in a plane where a dialect has none."""
    plane = next((PLANES[code] for code in reversed(before) if code in PLANES), "XY")
    return word in ("G2", "G3") and plane not in dialect.arc_rule.planes


def _code_here(dialect: type[Dialect], name: str) -> str:
    """Return the code of a dialect that does what a code does on most controls."""
    act = MEANINGS[name][0].partition("act ")[2]
    names = [name] if name not in dialect.differs else []
    if act and act not in ("work", "home", "store-home", "diameter"):
        names += [n for n, code in dialect.codes.items() if code.act == act]
    sure = (n for n in names if n in dialect.codes)
    return next((n for n in sure if dialect.codes[n].effect is not Effect.BARRIER), "")


def _check_fact(dialect: type[Dialect], fact: Fact) -> None:
    """Check what a program does."""
    blocks = _here(dialect, fact)
    if not blocks:
        return
    here = f"{dialect.name}: after X10 Y20 Z5, {blocks.replace(chr(10), ' / ')!r}"
    try:
        path = _followed(dialect, blocks)
    except GcxformError as error:
        said = error.diagnostics[0].message
        raise AssertionError(f"{here} is refused, though the codes are there: {said}") from None
    assert len(path), f"{here} does not move"
    found = {name: float(getattr(path, name)[-1]) for name in ("sweep", *fact.more)}
    found |= dict(zip("XYZ", path.end[-1, :3].tolist(), strict=True))
    wanted = {"sweep": fact.sweep, **fact.more, **dict(zip("XYZ", fact.end, strict=True))}
    for name, value in wanted.items():
        good = bool(np.isclose(found[name], value, rtol=0, atol=1e-9))
        assert good, f"{here} ends with {name} {found[name]:g}, on other controls with {value:g}"


# --- two of everything ---


def _seen(dialect: type[Dialect], blocks: str, without: str) -> str | None:
    """Return all that can be told apart in what blocks do, but for the event of a code."""
    path = _path(dialect, blocks)
    if path is None:
        return None
    columns = ("kind", "sweep", "plane", "feed", "feed_mode", "form", "side", "radius", "lost")
    rows = [np.nan_to_num(getattr(path, name), nan=-1e9).round(9).tolist() for name in columns]
    ends = np.nan_to_num(path.end, nan=-1e9).round(9).tolist()
    centres = np.nan_to_num(path.centre, nan=-1e9).round(9).tolist()
    frames = [path.frames[k] for k in path.frame.tolist()]
    events = [(e.row, e.what, e.values) for e in path.events if e.what != without]
    return repr((rows, ends, centres, frames, events))


def _differ(dialect: type[Dialect], blocks: list[str], without: str) -> bool:
    """Whether two blocks do different things, or one of them is refused."""
    seen = _seen(dialect, blocks[0], without)
    return seen is None or seen != _seen(dialect, blocks[1], without)


Findings = Iterator[str]
"""What is wrong; nothing excuses it, for `differs` says of one thing that it is another."""
BASE = {
    "set-work": {"L": "2", "P": "1", "X": "3."},
    "rotate": {"X": "1.", "Y": "2.", "R": "30."},
    "scale": {"X": "1.", "Y": "2.", "Z": "0.", "P": "2."},
    "home": {"X": "5."},
    "mirror": {"X": "1."},
    "preset": {"X": "1."},
    "local": {"X": "1."},
    "length-vector": {"Z": "1."},
}
THEN = "G1 X15. Y15. Z15. F100."
TWO_TOOLS = [f"T{n} M6\n{THEN}" for n in (1, 2)]


def _said(words: dict[str, str]) -> str:
    return " ".join(letter + value for letter, value in words.items())


def _numbers(dialect: type[Dialect]) -> Findings:
    """Give each word of each code two numbers."""
    for name, code in dialect.codes.items():
        if code.effect in (Effect.BARRIER, Effect.DWELL):
            continue
        base = BASE.get(code.act, dict.fromkeys(code.takes, "1") if code.act == "work" else {})
        held = [a for a in code.takes if a not in dialect.axes or a in BASE.get(code.act, {})]
        if code.act.startswith("no-"):
            continue
        for letter in held:
            one, two = ("2", "3") if code.act == "home" else ("1", "2")
            one, two = (one + ".", two + ".") if letter in "XYZIJKR" else (one, two)
            blocks = [f"{name} {_said({**base, letter: n})}\n{THEN}" for n in (one, two)]
            without = name if code.effect is Effect.FRAME else ""
            if not _differ(dialect, blocks, without):
                said = " and ".join(repr(block.split("\n")[0]) for block in blocks)
                yield f"{said} are read as one and the same"


def _work_offsets(dialect: type[Dialect]) -> Findings:
    """Name each work offset by its code, and by two numbers where it takes one."""
    blocks: dict[str, str] = {}
    for name, code in dialect.codes.items():
        if code.act == "work":
            numbers = ("1", "2") if code.takes else ("",)
            for number in numbers:
                said = "".join(f" {letter}{number}" for letter in code.takes)
                blocks[name + said] = dialect.offset_rule.names.get(name, name) + said
    seen = {block: _frame(dialect, block) for block in blocks}
    for one, two in combinations(blocks, 2):
        same = seen[one] is not None and seen[one] == seen[two]
        if same and blocks[one] != blocks[two]:
            yield f"{one!r} and {two!r} are one and the same work offset"


def _frame(dialect: type[Dialect], block: str) -> str | None:
    path = _path(dialect, f"{block}\nG1 X1. F100.")
    return None if path is None else path.frames[int(path.frame[-1])].work


def _tools(dialect: type[Dialect]) -> Findings:
    """Change to two tools."""
    has = "T" in dialect.block_rule.words and 6 in dialect.m_codes
    if has and not dialect.m_codes[6].barrier and not _differ(dialect, TWO_TOOLS, "M6"):
        yield "'T1 M6' and 'T2 M6' are read as one and the same"


def _dwells(dialect: type[Dialect]) -> Findings:
    """Wait for two times by each word of G4."""
    for letter in dialect.point_rule.dwell if "G4" in dialect.codes else ():
        seconds = []
        for value in (2, 3):
            path = _path(dialect, f"G4 {letter}{value}.\n{THEN}")
            times = [e.values for e in path.events if e.what == "DWELL"] if path else []
            seconds += [dict(values).get("seconds") for values in times[-1:]]
        whole = dialect.point_rule.seconds(letter, pointed=True)
        if seconds and not np.allclose([s or 0.0 for s in seconds], [2 * whole, 3 * whole]):
            yield f"G4 {letter}2. and G4 {letter}3. last {seconds} s, not {whole:g} s each 1"


PROBES = {
    "motion": "X15. Y15. R30. F100.",
    "plane": "G2 X10. Y20. Z5. I-1. J-1. K-1. F100.",
    "distance": "G1 X15. F100.",
    "units": "G1 X15. F100.",
    "arc-distance": "G2 X20. Y10. I0. J-10. F100.",
    "feed-mode": "G1 X15. F2.",
    "cutter-comp": "G1 X30. F100.",
    "frame": "G1 X1. F100.",
}
"""What tells the codes of a group apart."""


def _pairs(dialect: type[Dialect]) -> Findings:
    """Write each modal code behind each other one of its group: the last one holds, alone."""
    for group, codes in {**FAMILIES, "frame": WORK, "motion": ("G0", "G1", "G2", "G3")}.items():
        here = [c for c in codes if c in dialect.codes and c in NUMBER]
        here = [c for c in here if dialect.codes[c].effect is not Effect.BARRIER]
        last = {c: _last(_path(dialect, _block(dialect, group, c))) for c in here}
        known = [c for c in here if last[c]]
        for one, two in combinations(known, 2):
            if last[one] == last[two]:
                yield f"{one} and {two} do the same"
        for one, two in permutations(known, 2):
            both = _last(_path(dialect, _block(dialect, group, one, two)))
            if both and both != last[two]:
                yield f"{two} behind {one} is not {two} alone: it does not replace it"


def _block(dialect: type[Dialect], group: str, *codes: str) -> str:
    said = [code + (" D1" if "D" in dialect.codes[code].takes else "") for code in codes]
    if group == "motion":
        return "\n".join(f"{code} {PROBES[group] if code == codes[-1] else ''}" for code in said)
    return "\n".join([*said, PROBES[group]])


def _last(path: Toolpath | None) -> str:
    """Return what the last move of a path is, in which frame; "" where there is none."""
    if path is None or not len(path):
        return ""
    columns = ("kind", "end", "sweep", "centre", "plane", "feed", "feed_mode", "side", "radius")
    values = [
        np.nan_to_num(getattr(path, name)[-1], nan=-1e9).round(9).tolist() for name in columns
    ]
    return repr((values, path.frames[int(path.frame[-1])]))
