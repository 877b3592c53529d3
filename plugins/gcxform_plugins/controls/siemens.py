"""Siemens' swivel data and five-axis machine data as machines.

A swivel data set ($TC_CARR) and a generic five-axis transformation (MD24100 = 24, 40, 56) have the
same vectors under two names:

| vector | head (T, 24) | table (P, 40) | both (M, 56) |
|---|---|---|---|
| I1 $TC_CARR1 to 3 | PART_OFFSET | | JOINT_OFFSET |
| I2 $TC_CARR4 to 6 | JOINT_OFFSET | BASE_TOOL | BASE_TOOL |
| I3 $TC_CARR15 to 17 | BASE_TOOL | JOINT_OFFSET_PART | JOINT_OFFSET_PART |
| I4 $TC_CARR18 to 20 | | PART_OFFSET | PART_OFFSET |

In the head I3 goes from the gauge point to the second axis, I2 from there to the first, and I1
back. In the table I2 goes from the machine's origin to the first axis, I3 from there to the second,
and I4 back. Of one each, I2 goes from the gauge point to the first axis, which is that of the
tool, and I1 back; I3 from the origin to the second axis, and I4 back.

V1 ($TC_CARR7 to 9, AXIS1) and V2 ($TC_CARR10 to 12, AXIS2) are the directions, about which a
positive command turns right-handed what it turns: those of tables are entered reversed. The source
is the commissioning manual of SINUMERIK Operate (IM9). Chains that are not closed, turned zeros of
axes, and fine offsets are refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

import gcxform as gx
from gcxform.vocabulary import Axis, Machine, control_lines

Triple = tuple[float, float, float]
Vectors = dict[str, list[float]]
FIRST = {"I1": 1, "I2": 4, "V1": 7, "V2": 10, "I3": 15, "I4": 18}
CARRIER = {n + k: (name, k) for name, n in FIRST.items() for k in range(3)}
KIND = 23
NOUGHT = {24, 25, *range(41, 61)}  # zeros of the rotary axes, fine offsets
TYPES = {"24": "T", "40": "P", "56": "M"}
NAMES = {
    "T": {"PART_OFFSET": "I1", "JOINT_OFFSET": "I2", "BASE_TOOL": "I3"},
    "P": {"BASE_TOOL": "I2", "JOINT_OFFSET_PART": "I3", "PART_OFFSET": "I4"},
    "M": {"JOINT_OFFSET": "I1", "BASE_TOOL": "I2", "JOINT_OFFSET_PART": "I3", "PART_OFFSET": "I4"},
}
AXES = {"AXIS1": "V1", "AXIS2": "V2"}
CLOSED: dict[str, list[tuple[str, ...]]] = {
    "T": [("I1", "I2", "I3")],
    "P": [("I4", "I2", "I3")],
    "M": [("I1", "I2"), ("I4", "I3")],
}
NEAR = 1e-6  # mm
_CARRIER = re.compile(r"\$TC_CARR(\d+)\[\d+\]\s*=\s*\"?([^\"\s]+)\"?")
_TYPE = re.compile(r"\$MC_TRAFO_TYPE_1\s*=\s*(\d+)")
_DATA = re.compile(r"\$MC_TRAFO5_([A-Z0-9_]+?)_1\[([0-2])\]\s*=\s*([^\s]+)")


@dataclass(frozen=True)
class SiemensFiles(gx.ControlFiles):
    """SINUMERIK: swivel data, and machine data of five-axis transformations."""

    axes: Annotated[str, gx.Option("first and second rotary axis of the data", example="C,A")]

    name: ClassVar[str] = "siemens"
    file: ClassVar[str] = "DATA"

    def kinematics(self, path: Path) -> Machine:
        """Take over a swivel data set ($TC_CARR), or machine data of a five-axis transformation.

        The transformation is the first of the channel, of the type 24, 40 or 56.
        """
        letters = self._letters()
        where = gx.Location(str(path))
        text = "\n".join(line.text for line in control_lines(path))
        try:
            kind, vectors = _carrier(text) if "$TC_CARR" in text else _machine_data(text)
        except ValueError as error:
            raise gx.UsageError.one("GX454", str(error), where) from None
        problems = _problems(kind, vectors, letters)
        if found := tuple(gx.Diagnostic("GX454", problem, where) for problem in problems):
            raise gx.UsageError(found)
        return _machine(kind, vectors, letters, path)

    def _letters(self) -> tuple[str, str]:
        letters = [letter.strip().upper() for letter in self.axes.split(",")]
        if len(letters) != 2:
            where = gx.Location("--axes")
            raise gx.UsageError.one("GX707", f"{self.axes!r} is not two axes", where)
        return letters[0], letters[1]


def _number(text: str, name: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{name}: {text!r} is not a number") from None


def _empty() -> Vectors:
    return {name: [0.0, 0.0, 0.0] for name in FIRST}


def _carrier(text: str) -> tuple[str, Vectors]:
    """Return kind and vectors of a swivel data set."""
    kind, vectors = "", _empty()
    if len(set(re.findall(r"\$TC_CARR\d+\[(\d+)\]", text))) > 1:
        raise ValueError("there is more than one swivel data set: leave the one that is meant")
    for number, value in _CARRIER.findall(text):
        n = int(number)
        if n == KIND:
            kind = value.upper()
        elif n in CARRIER:
            name, k = CARRIER[n]
            vectors[name][k] = _number(value, f"$TC_CARR{n}")
        elif n in NOUGHT and _number(value, f"$TC_CARR{n}"):
            raise ValueError(f"$TC_CARR{n} is not 0: describe this machine by hand")
    return kind, vectors


def _machine_data(text: str) -> tuple[str, Vectors]:
    """Return kind and vectors of a generic five-axis transformation."""
    stated = _TYPE.search(text)
    kind, vectors = TYPES.get(stated[1] if stated else "", ""), _empty()
    for name, index, value in _DATA.findall(text):
        number = _number(value.replace("TRUE", "1").replace("FALSE", "0"), name)
        own = (NAMES.get(kind, {}) | AXES).get(name)
        if own:
            vectors[own][int(index)] = number
        elif name == "ROT_SIGN_IS_PLUS" and number != 1.0:
            raise ValueError(f"{name} is not TRUE: describe this machine by hand")
        elif name != "ROT_SIGN_IS_PLUS" and kind and number:
            raise ValueError(f"{name} is not followed: describe this machine by hand")
    return kind, vectors


def _problems(kind: str, vectors: Vectors, letters: tuple[str, str]) -> Iterator[str]:
    """Yield why vectors are no machine that can be taken over."""
    if kind not in NAMES:
        yield "no $TC_CARR23 of T, P or M, and no $MC_TRAFO_TYPE_1 of 24, 40 or 56"
        return
    if letters[0] == letters[1] or not {*letters} <= {*"ABC"}:
        yield f"{letters[0]} and {letters[1]} are not two of the axes A, B and C"
    nothing = [name for name in AXES.values() if not any(vectors[name])]
    yield from (f"the vector {name} of an axis is zero" for name in nothing)
    for names in CLOSED[kind]:
        gap = [sum(vectors[name][k] for name in names) for k in range(3)]
        if max(map(abs, gap)) > NEAR:
            yield f"the vectors {' + '.join(names)} are not 0: this chain is not closed"


def _machine(kind: str, vectors: Vectors, letters: tuple[str, str], file: Path) -> Machine:
    """Return the machine of good vectors."""
    second = _sum(vectors["I3"])
    if kind == "T":
        points = (_sum(vectors["I3"], vectors["I2"]), second)
    elif kind == "P":
        points = (_sum(vectors["I2"]), _sum(vectors["I2"], vectors["I3"]))
    else:
        points = (_sum(vectors["I2"]), second)
    axes = {
        letter: Axis(direction=_sum(vectors[name]), point=point, sign=1)
        for letter, name, point in zip(letters, AXES.values(), points, strict=True)
    }
    one, two = letters
    table, head = {"T": ((), letters), "P": (letters, ()), "M": ((two,), (one,))}[kind]
    return Machine(file=file, name="SINUMERIK", table=table, head=head, axes=axes)


def _sum(*vectors: list[float]) -> Triple:
    x, y, z = (sum(parts) for parts in zip(*vectors, strict=True))
    return x, y, z
