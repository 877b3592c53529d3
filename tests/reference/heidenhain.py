"""A reader of Klartext that goes line by line in floats and shares no code with the package.

It knows what the tests write, and believes that it is right: what is refused is no business of it.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

WORD = re.compile(
    r"(F ?MAX|F ?AUTO|DR ?[-+](?![\d.,])|I?P[AR]|I?[XYZABC]|[FRM]) ?([-+]?\d*[.,]?\d*)",
    re.IGNORECASE,
)
QUIET = ("BLK", "CYCL DEF 32", "CYCL DEF 7.0", "CYCL DEF 9.0", "*")


@dataclass
class Step:
    """A move: numbers of the program, in mm and degrees; `turns` are whole ones beyond the arc.

    `shift` is where the zero of the program is.
    """

    kind: str
    end: dict[str, float]
    feed: float | None
    following: bool
    centre: tuple[float, float] | None = None
    turns: int = 0
    shift: dict[str, float] = field(default_factory=dict)


@dataclass
class Reader:
    """Where the program is."""

    unit: float = 1.0
    at: dict[str, float] = field(default_factory=dict)
    shift: dict[str, float] = field(default_factory=dict)
    pole: tuple[float, float] = (0.0, 0.0)
    polar: tuple[float, float] = (0.0, 0.0)
    feed: float = 0.0
    tool_feed: float = 0.0
    following: bool = False
    steps: list[Step] = field(default_factory=list)
    events: list[str] = field(default_factory=list)
    over: bool = False


def read(text: str) -> Reader:
    """Return what a program does."""
    reader = Reader()
    lines = [re.sub(r"^\s*\d+\s+", "", line.split(";")[0]).strip() for line in text.splitlines()]
    _run(reader, lines, 0, len(lines))
    return reader


def _run(reader: Reader, lines: list[str], first: int, last: int) -> None:
    number = first
    while number < last and not reader.over:
        line = " ".join(lines[number].upper().split())
        call = re.match(r"CALL LBL ?(\d+)(?: REP ?(\d+))?", line)
        if call:
            start = next(k for k, other in enumerate(lines) if _is_label(other, call[1]))
            if call[2]:
                for _ in range(int(call[2])):
                    _run(reader, lines, start, number)
            else:
                end = next(k for k in range(start, len(lines)) if _is_label(lines[k], "0"))
                _run(reader, lines, start, end)
        elif line and not line.startswith(("LBL", *QUIET)):
            _statement(reader, line)
        number += 1


def _is_label(line: str, number: str) -> bool:
    return re.fullmatch(rf"LBL ?{number}", " ".join(line.upper().split())) is not None


def _statement(reader: Reader, line: str) -> None:
    if line.startswith("BEGIN"):
        reader.unit = 25.4 if line.endswith("INCH") else 1.0
    elif line.startswith("END"):
        reader.over = True
    elif line.startswith("TOOL CALL"):
        _tool(reader, line)
    elif line.startswith("TOOL DEF"):
        fetched = re.fullmatch(r"TOOL DEF ?(\d+)", line)
        reader.events += [f"T{int(fetched[1])}"] if fetched else []
    elif line.startswith("CYCL DEF 7."):
        axis, value = re.findall(r"([XYZ]) ?([-+\d.,]+)$", line)[0]
        old = reader.shift.get(axis, 0.0)
        reader.shift[axis] = _number(value)
        if axis in reader.at:
            reader.at[axis] -= _number(value) - old
    elif line.startswith("CYCL DEF 9.1"):
        reader.events.append(f"dwell {_number(line.split()[-1]):g}")
    elif line == "STOP":
        reader.events.append("M0")
    else:
        _positioning(reader, line)


def _positioning(reader: Reader, line: str) -> None:
    if line.startswith("FUNCTION"):
        reader.following = "RESET" not in line
    elif line.startswith("CC"):
        _centre(reader, line[2:])
    elif re.match(r"(LP|L|CP|CR|C)\b", line):
        head = re.match(r"[A-Z]+", line)[0]
        _move(reader, head, line[len(head) :])
    else:
        _move(reader, "L", line)


def _number(text: str) -> float:
    return float(text.replace(",", "."))


def _tool(reader: Reader, line: str) -> None:
    found = dict(re.findall(r"([SF]) ?([\d.,]+)", line))
    changed = re.match(r"TOOL CALL ?(\d+)", line)
    if changed:
        reader.at.clear()
        reader.events.append(f"T{int(changed[1])}")
    if "S" in found:
        reader.events.append(f"S{_number(found['S']):g}")
    if "F" in found:
        reader.feed = reader.tool_feed = _number(found["F"])


def _centre(reader: Reader, text: str) -> None:
    found = dict(re.findall(r"(I?[XY]) ?([-+\d.,]+)", text))
    reader.pole = tuple(_coordinate(reader, found, axis) for axis in "XY")  # type: ignore[assignment]


def _coordinate(reader: Reader, found: dict[str, str], axis: str) -> float:
    if axis in found:
        return _number(found[axis])
    return reader.at.get(axis, math.nan) + _number(found.get("I" + axis, "0"))


def _move(reader: Reader, head: str, text: str) -> None:
    found, functions = _words(reader, text)
    for code in functions:
        if code in (3, 4, 8, 13, 14):
            reader.events += {13: ["M3", "M8"], 14: ["M4", "M8"]}.get(code, [f"M{code}"])
        reader.following |= code == 128
    if head[0] == "L" and found.keys() - {"FMAX"}:
        _line(reader, head, found, found.pop("FMAX", None) is not None)
    elif head[0] == "C":
        _arc(reader, head, found, 1 if found["DR"] == "+" else -1)
    for code in functions:
        reader.events += {0: ["M5", "M0"], 1: ["M1"], 5: ["M5"], 9: ["M9"]}.get(code, [])
        reader.following &= code != 129
        reader.over |= code in (2, 30)


def _words(reader: Reader, text: str) -> tuple[dict[str, str], list[int]]:
    """Return coordinates and their like, and M functions; feeds are taken."""
    found: dict[str, str] = {}
    functions: list[int] = []
    last = 0
    for name, value in WORD.findall(text):
        name = name.replace(" ", "")
        if name == "M":
            functions.append(int(value))
        elif name == "FAUTO":
            reader.feed = reader.tool_feed
        elif name == "F":
            reader.feed = reader.feed if last == 128 else _number(value)
        elif name.startswith("DR"):
            found["DR"] = name[-1]
        elif name != "R" or _number(value):
            found[name] = value
        last = functions[-1] if name == "M" else 0
    return found, functions


def _polar(reader: Reader, found: dict[str, str]) -> tuple[float, float]:
    radius, angle = reader.polar
    radius = _number(found["PR"]) if "PR" in found else radius + _number(found.get("IPR", "0"))
    angle = _number(found["PA"]) if "PA" in found else angle + _number(found.get("IPA", "0"))
    return radius, angle


def _from_pole(reader: Reader) -> dict[str, float]:
    radius, angle = reader.polar
    x, y = reader.pole
    turn = math.radians(angle)
    return {"X": x + radius * math.cos(turn), "Y": y + radius * math.sin(turn)}


def _line(reader: Reader, head: str, found: dict[str, str], rapid: bool) -> None:
    named = {name[-1] for name in found if "P" not in name}
    end = {axis: _coordinate(reader, found, axis) for axis in named}
    if head == "LP":
        reader.polar = _polar(reader, found)
        end |= _from_pole(reader)
    reader.at |= end
    feed = None if rapid else reader.feed
    reader.steps.append(_step(reader, "RAPID" if rapid else "LINE", feed))


def _step(reader: Reader, kind: str, feed: float | None) -> Step:
    scale = {axis: reader.unit if axis in "XYZ" else 1.0 for axis in reader.at}
    end = {axis: value * scale[axis] for axis, value in reader.at.items()}
    rate = None if feed is None else feed * (2.54 if reader.unit != 1.0 else 1.0)
    shift = {axis: value * scale.get(axis, 1.0) for axis, value in reader.shift.items()}
    return Step(kind, end, rate, reader.following, shift=shift)


def _arc(reader: Reader, head: str, found: dict[str, str], sense: int) -> None:
    start = dict(reader.at)
    end = {axis: _coordinate(reader, found, axis) for axis in "XYZ" if axis in start}
    centre, whole = reader.pole, 0
    if head == "CR":
        centre = _by_radius(start, end, _number(found["R"]), sense)
    if head == "CP":
        x, y = start["X"] - centre[0], start["Y"] - centre[1]
        begin = math.degrees(math.atan2(y, x))
        turn = _number(found["IPA"]) if "IPA" in found else _number(found["PA"]) - begin
        whole = math.ceil(abs(turn) / 360.0) - 1 if "IPA" in found else 0
        reader.polar = math.hypot(x, y), begin + turn
        end |= _from_pole(reader)
    reader.at |= end
    step = _step(reader, "ARC_CCW" if sense > 0 else "ARC_CW", reader.feed)
    step.centre = centre[0] * reader.unit, centre[1] * reader.unit
    step.turns = whole
    reader.steps.append(step)


def _by_radius(
    start: dict[str, float], end: dict[str, float], radius: float, sense: int
) -> tuple[float, float]:
    """Return the centre: from the middle of the chord, left of it for the short way round."""
    dx, dy = end["X"] - start["X"], end["Y"] - start["Y"]
    half = math.hypot(dx, dy) / 2
    away = math.sqrt(max(0.0, radius * radius - half * half)) * sense * (1 if radius > 0 else -1)
    middle = (start["X"] + end["X"]) / 2, (start["Y"] + end["Y"]) / 2
    return middle[0] - dy / (2 * half) * away, middle[1] + dx / (2 * half) * away
