"""The user's own lines for where the tool is drawn back, and what is known of them.

They are read in the dialect that is written, one by one, and only what can be proved is let in: a
comment, a dwell, coolant, codes that the machine file calls inert, and rapids of X, Y and Z to
places of the machine. The spindle has to turn when the tool goes in again, so it is not switched.

Each is read from two places of the machine, so that only axes that end at one place are named by
it. What they do is in rows of the form MACHINE and in events `within` the block; `given` of the
path has their text, which the emitter puts between the pieces and the verifier looks for, once each
and in order. As G53 counts from the machine, the output is read with the work offsets of the
machine that it is written for; a program's own moves to such places are refused where two machines
have them elsewhere. A macro would need a reader and a bound of its own.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, cast

import gcxform as gx

COMMENT = re.compile(r"\([^()]*\)|;.*")
WORD = re.compile(r"\s*([A-Z])\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*", re.IGNORECASE)
HINT = (
    "comments, dwells (G4), M7, M8, M9, inert-m of both machine files, and rapids such as "
    "G53 G0 Z0. are"
)
NOT_HERE = {
    "spindle": "the spindle has to turn as before when the tool goes in again",
    "stop": "what an operator does while the program stands is not known",
}
Codes = frozenset[int]
Values = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class Line:
    """One line: its text, what happens in it, and where it takes X, Y and Z of the machine, mm."""

    text: str
    events: tuple[tuple[str, Values], ...]
    ends: Mapping[str, float]


@dataclass(frozen=True)
class UserLines:
    """The lines before the axes turn, and those after it."""

    retract: tuple[Line, ...] = ()
    back: tuple[Line, ...] = ()

    @classmethod
    def of(
        cls,
        retract: gx.Lines | None,
        back: gx.Lines | None,
        dialect: type[gx.Dialect],
        inert: Codes,
    ) -> UserLines:
        """Return the lines of two options, in a dialect of which some M codes are inert.

        Raises UsageError, with the place of the option.
        """
        return cls(_read(retract, dialect, inert), _read(back, dialect, inert))

    @property
    def move(self) -> bool:
        """Whether any of them moves."""
        return any(line.ends for line in (*self.retract, *self.back))

    @property
    def in_mm(self) -> bool:
        """Whether one of them has a length that is another in inches."""
        return any(any(line.ends.values()) for line in (*self.retract, *self.back))

    def groups(self) -> list[str]:
        """Return in which order axes go back: those that no line moves, then the last first."""
        moved = ["".join(line.ends) for line in (*self.retract, *self.back) if line.ends]
        found, left = [], "XYZ"
        for axes in ("".join(a for a in left if a not in "".join(moved)), *reversed(moved)):
            found.append("".join(a for a in axes if a in left))
            left = "".join(a for a in left if a not in axes)
        return [axes for axes in found if axes]


class _WrongError(Exception):
    """Why a line is refused."""


def _read(lines: gx.Lines | None, dialect: type[gx.Dialect], inert: Codes) -> tuple[Line, ...]:
    found = []
    if lines is None:
        return ()
    for text in lines.texts:
        try:
            found.append(_line(text, dialect, inert))
        except _WrongError as wrong:
            message = f"{text!r}: {wrong}"
            raise gx.UsageError.one("GX745", message, lines.where, HINT) from None
    return tuple(found)


def _line(text: str, dialect: type[gx.Dialect], inert: Codes) -> Line:
    """Return what a line does. Raises _WrongError."""
    for comment in COMMENT.findall(text):
        if comment[0] not in dialect.text_rule.comments:
            raise _WrongError(f"{dialect.name} has no such comments")
        if dialect.text_rule.executes(comment):
            raise _WrongError("the control executes this comment")
    words = _words(COMMENT.sub(" ", text))
    if dialect.text_rule.lower_case:
        words = [(letter.upper(), value) for letter, value in words]
    codes = [f"G{float(value):g}" for letter, value in words if letter == "G"]
    rest = "".join(letter for letter, _ in words if letter != "G")
    if codes == ["G4"]:
        timed = len(rest) == 1 and rest in dialect.point_rule.dwell
        _check(timed, "the dwell has not one word for its time")
    elif codes:
        _check_move(codes, rest)
    else:
        _check(len(words) <= 1, "several codes in one line")
        for letter, value in words:
            _check_code(letter, value, dialect, inert)
    return _as_read(text, cast(Any, dialect), inert)


def _words(text: str) -> list[tuple[str, str]]:
    """Return letters and numbers of a text that has nothing else."""
    found, at = [], len(text) - len(text.lstrip())
    while at < len(text):
        word = WORD.match(text, at)
        if word is None:
            raise _WrongError(f"{text[at:].strip()!r} is no plain word")
        found.append((word[1], word[2]))
        at = word.end()
    return found


def _check(right: bool, message: str) -> None:
    if not right:
        raise _WrongError(message)


def _check_move(codes: list[str], rest: str) -> None:
    for code in codes:
        _check(code in ("G0", "G53", "G90"), f"{code} may not stand here")
    _check("G53" in codes, "a move is to a place of the machine: G53")
    _check("G0" in codes, "G53 without G0 would move as G1 does, in force here")
    for letter in rest:
        _check(letter in "XYZ", f"{letter} may not stand beside G53")
    _check(rest != "", "G53 names no axis")


def _check_code(letter: str, value: str, dialect: type[gx.Dialect], inert: Codes) -> None:
    """Check a word of a block without G codes."""
    name = f"{letter}{float(value):g}"
    _check(letter == "M", f"{name} may not stand here")
    number = int(float(value)) if float(value) % 1 == 0 else -1
    code = dialect.m_codes.get(number)
    group = code.group if code is not None else ""
    why = NOT_HERE.get(group, f"what {name} does is not known to {dialect.name}")
    own = code is None or group == "user"
    _check(group == "coolant" or (own and number in inert), f"{name}: {why}")


@lru_cache(maxsize=64)  # every window asks for its lines
def _as_read(text: str, dialect: Any, inert: Codes) -> Line:
    """Return what the reader of the dialect, a class, finds in a line, from two places."""
    zero = {dialect.initial["frame"]: dict.fromkeys("XYZ", 0.0)}
    paths = []
    for start in (0.0, 1.0):
        placed = dict.fromkeys("XYZ", start)
        given: dict[str, Any] = {"start": placed, "units": "mm", "work_offsets": zero}
        try:
            read = gx.read(text.encode() + b"\n", dialect, inert_m=inert, **given)
            paths.append(read.path)
        except gx.GcxformError as error:
            raise _WrongError(error.diagnostics[0].message) from None
    one, other = paths
    _check(len(one) <= 1, "these are several moves")
    events = tuple((event.what, event.values) for event in one.events)
    if not len(one):
        return Line(text, events, {})
    _check(all(what == "G53" for what, _ in events), "a line moves, or switches something")
    _check(one.form[0] == gx.Form.MACHINE and one.kind[0] == gx.Kind.RAPID, "this is no rapid")
    ends = zip("XYZ", one.end[0].tolist(), other.end[0].tolist(), strict=False)
    return Line(text, events, {axis: end for axis, end, same in ends if end == same})
