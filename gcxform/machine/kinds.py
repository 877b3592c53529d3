"""Kinds of machines: what a machine file need not say when it names its kinematics.

A kind says which rotary axes there are, on which side, and which way they point; the machine file
gives their points, and whatever differs: a calibrated direction, or the sign of a control that
turns an axis the other way.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import ClassVar

import msgspec

from gcxform.config.quantities import ROTARY_AXES
from gcxform.config.toml_text import TomlText, did_you_mean
from gcxform.diagnostics import Diagnostic
from gcxform.machine.machine import Axis, MachineFile

INCLINATION = 45.0
"""Degrees that a nutating axis leans from Z if nothing is said."""
FAR = 5.0  # degrees: more is no error of a machine, but another axis
_UNITS = {"A": (1.0, 0.0, 0.0), "B": (0.0, 1.0, 0.0), "C": (0.0, 0.0, 1.0)}


class Kinematics:
    """A kind of machines; its docstring is what `gcxform list kinematics` shows.

    `table` and `head` name the rotary axes from the base to the workpiece and to the spindle. A, B
    and C turn about X, Y and Z, but for the one that is `nutating`: it leans from Z towards Y.
    Signs are those of ISO 841: right-handed for the tool, so +1 in the head and -1 in the table.
    """

    name: ClassVar[str] = ""
    table: ClassVar[tuple[str, ...]] = ()
    head: ClassVar[tuple[str, ...]] = ()
    nutating: ClassVar[str] = ""

    @classmethod
    def direction(cls, letter: str, inclination: float = INCLINATION) -> tuple[float, float, float]:
        """Return the unit vector along an axis; `inclination` in degrees is that to Z."""
        if letter != cls.nutating:
            return _UNITS[letter]
        lean = math.radians(inclination)
        return 0.0, math.sin(lean), math.cos(lean)

    @classmethod
    def sign(cls, letter: str) -> int:
        """Return the sign of an axis."""
        return 1 if letter in cls.head else -1


Kinds = Mapping[str, type[Kinematics]]


def findings(document: TomlText, file: MachineFile, known: Kinds) -> Iterator[Diagnostic]:
    """Yield where a machine file contradicts the kinematics that it names."""
    if file.kinematics is None:
        if file.inclination is not None:
            message = "inclination is that of the nutating axis of a kind of kinematics"
            hint = 'add kinematics = "nutating-head", or give the axis its direction'
            yield Diagnostic("GX451", message, document.where("inclination"), hint)
        return
    kind = known.get(file.kinematics)
    if kind is None:
        message = f"there are no kinematics {file.kinematics!r}"
        hint = did_you_mean(file.kinematics, known)
        yield Diagnostic("GX450", message, document.where("kinematics"), hint)
        return
    yield from _chain_findings(document, file, kind)
    yield from _inclination_findings(document, file, kind)
    for letter, axis in file.axis.items():
        if letter in kind.table + kind.head and axis.direction is not None:
            yield from _direction_findings(document, file, kind, letter)


def _chain_findings(
    document: TomlText, file: MachineFile, kind: type[Kinematics]
) -> Iterator[Diagnostic]:
    for chain, stated, own in (("table", file.table, kind.table), ("head", file.head, kind.head)):
        if stated and tuple(stated) != own:
            message = f"{chain} of {kind.name} is {list(own)}, not {stated}"
            hint = f"leave {chain} out, or leave kinematics out and describe every axis"
            yield Diagnostic("GX451", message, document.where(chain), hint)
    for letter in file.axis:
        if letter in ROTARY_AXES and letter not in kind.table + kind.head:
            message = f"{kind.name} has no axis {letter}"
            yield Diagnostic("GX451", message, document.where("axis", letter))


def _inclination_findings(
    document: TomlText, file: MachineFile, kind: type[Kinematics]
) -> Iterator[Diagnostic]:
    if file.inclination is None:
        return
    where = document.where("inclination")
    if not kind.nutating:
        yield Diagnostic("GX451", f"{kind.name} has no nutating axis", where)
    elif not 0.0 < file.inclination < 180.0:
        message = f"inclination is {file.inclination:g}, it has to be between 0 and 180 degrees"
        yield Diagnostic("GX434", message, where)


def _direction_findings(
    document: TomlText, file: MachineFile, kind: type[Kinematics], letter: str
) -> Iterator[Diagnostic]:
    """Yield a finding if an axis is far from that of its kind, whichever way round it is."""
    stated = file.axis[letter].direction or (0.0, 0.0, 0.0)
    length = math.hypot(*stated)
    if not length:
        return
    nominal = kind.direction(letter, _inclination(file))
    along = abs(sum(s * n for s, n in zip(stated, nominal, strict=True))) / length
    off = math.degrees(math.acos(min(1.0, along)))
    if off > FAR:
        message = f"the direction of axis {letter} is {off:.1f} degrees off that of {kind.name}"
        hint = "a calibrated axis is a fraction of a degree off; leave kinematics out if it is so"
        yield Diagnostic("GX451", message, document.where("axis", letter, "direction"), hint)


def filled(file: MachineFile, known: Kinds) -> MachineFile:
    """Return a machine file with all that its kinematics say and itself does not."""
    kind = known.get(file.kinematics or "")
    if kind is None:
        return file
    axes = dict(file.axis)
    for letter in kind.table + kind.head:
        axis = axes.get(letter, Axis())
        direction = axis.direction or kind.direction(letter, _inclination(file))
        # the direction may be given either way round: the sign of the kind is about its own
        sign = kind.sign(letter) * (-1 if _opposed(direction, kind, letter, file) else 1)
        axes[letter] = msgspec.structs.replace(
            axis, direction=direction, sign=sign if axis.sign is None else axis.sign
        )
    replaced: MachineFile = msgspec.structs.replace(
        file, axis=axes, table=list(kind.table), head=list(kind.head)
    )
    return replaced


def _opposed(
    direction: tuple[float, float, float], kind: type[Kinematics], letter: str, file: MachineFile
) -> bool:
    nominal = kind.direction(letter, _inclination(file))
    return sum(s * n for s, n in zip(direction, nominal, strict=True)) < 0.0


def _inclination(file: MachineFile) -> float:
    return INCLINATION if file.inclination is None else float(file.inclination)
