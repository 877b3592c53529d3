"""Options: what a dataclass field says about a value that a user writes.

The fields of a pass are its options: the kebab-case key, units, type, choices, range, default,
help and the way back to TOML are derived from them.

    class Shift(gx.Pass):
        by: Vector
        limit: Annotated[Length, Option(help="the longest shift", above=0)] = 1.0

A field is a `Length` (mm), `Angle` (degrees), `Vector` (mm), `Coordinates`, int, float, bool, str,
`Path`, `ModelFile`, a `Literal` or a `StrEnum`; `T | None`; or `T | dict[str, T]`, one value for
all or one for each address letter.
"""

from __future__ import annotations

import dataclasses
import enum
import hashlib
import math
import os
import re
import types
import typing
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, field
from functools import partial
from pathlib import Path
from typing import Annotated, Any, NamedTuple, TypeVar

import msgspec

from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.machine import modelfile
from gcxform.machine.errors import AxisFunctions, ErrorModel
from gcxform.machine.formats import ErrorFormat
from gcxform.machine.quantities import ANGLE, AXIS_LETTERS, LENGTH, Quantity, quantity_of
from gcxform.tomltext import did_you_mean

Built = TypeVar("Built")
Where = Callable[[str], Location]


class Argument(str):
    """A value on the command line: text of which the option says what it is."""


@dataclass(frozen=True)
class Option:
    """What an option says beyond its type: help, and the range of its value in its base unit."""

    help: str = ""
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None

    def admits(self, value: float) -> bool:
        """Return whether a value is in the range."""
        above = self.above is None or value > self.above
        at_least = self.at_least is None or value >= self.at_least
        return above and at_least and (self.at_most is None or value <= self.at_most)

    def range_text(self, unit: str) -> str:
        """Return the range in words, each bound with its unit."""
        words = {"above": self.above, "at least": self.at_least, "at most": self.at_most}
        return " and ".join(f"{word} {b:g}{unit}" for word, b in words.items() if b is not None)


@dataclass(frozen=True)
class ModelFile:
    """An error model with the file it came from; equal when the content is.

    `sha256` is that of the file; for a foreign format that of the model in its native form.
    """

    path: Path = field(compare=False)
    model: ErrorModel = field(compare=False, repr=False)
    sha256: str

    @classmethod
    def load(cls, path: Path, formats: Iterable[type[ErrorFormat]] = ()) -> ModelFile:
        """Return the model of a file; raises UsageError as `load_model` does."""
        model = modelfile.load_model(path, tuple(formats))
        if path.suffix.lower() == modelfile.SUFFIX or not isinstance(model, AxisFunctions):
            data = path.read_bytes()
        else:
            data = modelfile.to_toml(model).encode()
        return cls(path, model, hashlib.sha256(data).hexdigest())


class OptionDoc(NamedTuple):
    """The documentation of one option, in words."""

    name: str
    type: str
    default: str
    mandatory: bool
    choices: tuple[str, ...]
    help: str
    range: str


class _RefusedError(Exception):
    """A value which is not what its option takes: the code, a sentence and a hint."""

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code, self.message, self.hint = code, message, hint


class _Around(NamedTuple):
    """What surrounds the values: the directory for relative paths, the formats of models."""

    base: Path
    formats: tuple[type[ErrorFormat], ...] = ()


@dataclass(frozen=True, eq=False)
class _Kind:
    """A type of options: its words, how a raw value is read and written, its unit."""

    words: str
    read: Callable[[object, _Around], Any]
    raw: Callable[[Any], object] = lambda value: value
    unit: str = ""


def _written(raw: object) -> str:
    """Return a raw value for a message."""
    if isinstance(raw, list | dict):
        return "a list" if isinstance(raw, list) else "a table"
    return str(raw).lower() if isinstance(raw, bool) else repr(raw)


def _expected(what: str, raw: object) -> _RefusedError:
    return _RefusedError("GX702", f"expected {what}, got {_written(raw)}")


def _read_plain(kind: type, what: str, raw: object, around: _Around) -> Any:
    """Return a number, a string or a truth value; a word may be any of them."""
    word = isinstance(raw, Argument)
    try:
        value: Any = msgspec.convert(str(raw) if word else raw, kind, strict=not word)
    except msgspec.ValidationError:
        raise _expected(what, raw) from None
    if isinstance(value, float) and not math.isfinite(value):
        raise _expected(f"{what} that is finite", raw)
    return value


def _read_path(raw: object, around: _Around) -> Path:
    if not isinstance(raw, str) or not raw or "\0" in raw:
        raise _expected("the name of a file", raw)
    return around.base / raw


def _read_model(raw: object, around: _Around) -> ModelFile:
    path = _read_path(raw, around)
    if not os.path.exists(path):  # unlike Path.exists, false for a name that is too long
        raise _RefusedError("GX709", f"the file {str(path)!r} does not exist")
    return ModelFile.load(path, around.formats)


def _read_quantity(quantity: Quantity, raw: object, around: _Around) -> float:
    if isinstance(raw, str):
        try:
            return quantity.parse(raw, bare=isinstance(raw, Argument))
        except ValueError as error:
            raise _RefusedError("GX708", str(error)) from None
    what = f"{quantity.article}, such as {quantity.example}"
    return float(_read_plain(float, what, raw, around))


def _read_vector(raw: object, around: _Around) -> tuple[float, float, float]:
    parts: list[object] = raw if isinstance(raw, list) else []
    if isinstance(raw, str):
        parts = [Argument(part) for part in raw.split(",")]
    elif isinstance(raw, dict) and sorted(raw) == ["X", "Y", "Z"]:
        parts = [raw[letter] for letter in "XYZ"]
    if len(parts) != 3:
        raise _expected("three lengths, such as [0.0, 0.0, 0.0] or {X = 0, Y = 0, Z = 0}", raw)
    x, y, z = (_read_quantity(LENGTH, part, around) for part in parts)
    return x, y, z


def _read_coordinates(raw: object, around: _Around) -> dict[str, float]:
    if not isinstance(raw, dict):
        raise _expected("a table of axis letters, such as {X = 0.0, A = 0.0}", raw)
    if wrong := [key for key in raw if key not in AXIS_LETTERS]:
        raise _RefusedError(
            "GX701", f"{wrong[0]!r} is not one of the axes {' '.join(AXIS_LETTERS)}"
        )
    return {key: _read_quantity(quantity_of(key), value, around) for key, value in raw.items()}


_PARAMETER = re.compile(r"[0-9]+|<[^<>#()]+>")


def _read_parameters(raw: object, around: _Around) -> dict[str, float]:
    if not isinstance(raw, dict):
        raise _expected('a table of parameters, such as {"100" = 1.5, "<depth>" = -2.0}', raw)
    if wrong := [key for key in raw if not _PARAMETER.fullmatch(key)]:
        hint = 'write a number, "100", or a name in its brackets, "<depth>"'
        raise _RefusedError("GX701", f"{wrong[0]!r} is not a parameter", hint)
    return {key: _read_plain(float, "a number", value, around) for key, value in raw.items()}


def _choice_kind(choices: tuple[Any, ...]) -> _Kind:
    """Return the kind of a value which is one of a few, strings or numbers."""
    texts = {str(choice): choice for choice in choices}

    def read(raw: object, around: _Around) -> object:
        choice = texts.get(str(raw))
        same = isinstance(raw, str) == isinstance(choice, str) or isinstance(raw, Argument)
        if choice is None or not same:
            known = [text for text in texts if text]
            message = f"{_written(raw)} is not one of {', '.join(known)}"
            raise _RefusedError("GX707", message, did_you_mean(str(raw), known))
        return choice

    return _Kind("choice", read, lambda choice: str(choice) if isinstance(choice, str) else choice)


_LENGTH = _Kind("length", partial(_read_quantity, LENGTH), unit=" mm")
_ANGLE = _Kind("angle", partial(_read_quantity, ANGLE), unit=" deg")
_VECTOR = _Kind("three lengths", _read_vector, list)
_COORDINATES = _Kind("coordinates by axis letter", _read_coordinates)
_PARAMETERS = _Kind("numbers by parameter", _read_parameters)
_PLAIN: dict[type, _Kind] = {
    bool: _Kind("true or false", partial(_read_plain, bool, "true or false")),
    int: _Kind("whole number", partial(_read_plain, int, "a whole number")),
    float: _Kind("number", partial(_read_plain, float, "a number")),
    str: _Kind("text", partial(_read_plain, str, "a text")),
    Path: _Kind("file name", _read_path, lambda path: str(path.absolute())),
    ModelFile: _Kind("error model", _read_model, lambda f: str(f.path.absolute())),
}

Length = Annotated[float, _LENGTH]
"""A length in mm; written "5 um", "0.2 mm", "0.001 in" or as a number in mm."""
Angle = Annotated[float, _ANGLE]
"""An angle in degrees; written "10 deg", "80 urad" or as a number in degrees."""
Vector = Annotated[tuple[float, float, float], _VECTOR]
"""Three lengths in mm; written as a list, as "0,0,0" or as a table of X, Y and Z."""
Coordinates = Annotated[dict[str, float], _COORDINATES]
"""Positions by axis letter, mm or degrees; written as a table."""
ParameterValues = Annotated[dict[str, float], _PARAMETERS]
"""Values of parameters by number ("100") or name ("<depth>"); written as a table."""


@dataclass(frozen=True, eq=False)
class _Spec:
    """All that is known of one option."""

    name: str
    key: str
    kind: _Kind
    option: Option
    by_letter: bool
    choices: tuple[Any, ...]
    default: Any

    def read(self, raw: object, around: _Around) -> object:
        """Return the value; raises _RefusedError or, from the file of a model, UsageError."""
        if self.by_letter and isinstance(raw, dict):
            if wrong := [k for k in raw if not re.fullmatch("[A-Z]", k)]:
                raise _RefusedError("GX701", f"{wrong[0]!r} is not an address letter")
            return {letter: self._read_one(value, around) for letter, value in raw.items()}
        return self._read_one(raw, around)

    def _read_one(self, raw: object, around: _Around) -> object:
        value = self.kind.read(raw, around)
        if isinstance(value, int | float) and not self.option.admits(value):
            unit = self.kind.unit
            message = f"{value:g}{unit} is not {self.option.range_text(unit)}"
            raise _RefusedError("GX706", message, self.option.help)
        return value

    def to_raw(self, value: Any) -> object:
        """Return what a TOML file says for a value."""
        if self.by_letter and isinstance(value, dict):
            return {letter: self.kind.raw(each) for letter, each in value.items()}
        return self.kind.raw(value)


def build(
    pass_class: type[Built],
    raw: Mapping[str, object],
    base: Path,
    formats: Iterable[type[ErrorFormat]],
    where: Where,
    owner: str = "",
) -> Built:
    """Return a pass, or any dataclass of options, from the keys of its table, without `use`.

    `base` is the directory of relative paths; `where` gives the place of a key, and of the whole
    for "use"; `owner` is what messages call it. Raises UsageError with all that is wrong.
    """
    owner = owner or f"the pass {getattr(pass_class, 'name', '')!r}"
    around = _Around(base, tuple(formats))
    specs = _specs(pass_class)
    known = [spec.key for spec in specs]
    found = [
        Diagnostic("GX701", f"unknown key {key!r} in {owner}", where(key), did_you_mean(key, known))
        for key in raw
        if key not in known
    ]
    values: dict[str, object] = {}
    for spec in specs:
        try:
            if spec.key in raw:
                values[spec.name] = spec.read(raw[spec.key], around)
            elif spec.default is MISSING:
                raise _RefusedError("GX705", f"{owner} needs {spec.key!r}", spec.option.help)
        except _RefusedError as refusal:
            message = f"{spec.key}: {refusal.message}" if spec.key in raw else refusal.message
            found.append(Diagnostic(refusal.code, message, where(spec.key), refusal.hint))
        except UsageError as error:
            found += error.diagnostics
    if found:
        raise UsageError(tuple(found))
    return _instance(pass_class, values, owner, where)


def _instance(target: type[Built], values: dict[str, object], owner: str, where: Where) -> Built:
    """Return the dataclass; what it says itself about its values becomes a diagnostic."""
    try:
        return target(**values)
    except UsageError as error:
        placed = (d if d.where else d.at(where("use")) for d in error.diagnostics)
        raise UsageError(tuple(placed)) from None
    except ValueError as error:
        raise UsageError.one("GX713", f"{owner}: {error}", where("use")) from None


def describe(target: type) -> list[OptionDoc]:
    """Return the documentation of the options of a pass; TypeError for a field that is none."""
    return [
        OptionDoc(
            name=spec.key,
            type=spec.kind.words + (" or table by letter" if spec.by_letter else ""),
            default=_default_text(spec),
            mandatory=spec.default is MISSING,
            choices=tuple(str(choice) for choice in spec.choices),
            help=spec.option.help,
            range=spec.option.range_text(spec.kind.unit),
        )
        for spec in _specs(target)
    ]


def _default_text(spec: _Spec) -> str:
    """Return the default for a person: with its unit, empty if there is none."""
    raw = None if spec.default in (MISSING, None) else spec.to_raw(spec.default)
    if isinstance(raw, bool | None):
        return "" if raw is None else _written(raw)
    return f"{raw:g}{spec.kind.unit}" if isinstance(raw, int | float) else str(raw)


def to_toml(instance: object) -> dict[str, object]:
    """Return the options of a pass as raw values that `build` turns into an equal pass.

    Lengths are mm and angles degrees. An option that is None is left out, hence None has to be
    its default.
    """
    pairs = ((spec, getattr(instance, spec.name)) for spec in _specs(type(instance)))
    return {spec.key: spec.to_raw(value) for spec, value in pairs if value is not None}


def _specs(target: Any) -> tuple[_Spec, ...]:
    """Return the options of a dataclass; TypeError for a field whose type is not one of ours."""
    hints = typing.get_type_hints(target, include_extras=True)
    fields = [f for f in dataclasses.fields(target) if f.init]
    return tuple(_spec(f, hints[f.name]) for f in fields)


def _spec(of: dataclasses.Field[Any], annotation: Any) -> _Spec:
    alternatives, metadata = _flat(annotation)
    types_ = [kind for kind in alternatives if kind is not types.NoneType]
    plain = [kind for kind in types_ if typing.get_origin(kind) is not dict] or types_
    marks = [mark for mark in metadata if isinstance(mark, _Kind)]
    choices = _choices(plain[0])
    kind = marks[0] if marks else _choice_kind(choices) if choices else _PLAIN.get(plain[0])
    default = of.default if of.default_factory is MISSING else of.default_factory()
    if kind is None or len(plain) != 1:
        raise TypeError(f"the option {of.name!r} has the type {annotation}, which is none of ours")
    return _Spec(
        name=of.name,
        key=of.name.replace("_", "-"),
        kind=kind,
        option=next((mark for mark in metadata if isinstance(mark, Option)), Option()),
        by_letter=len(plain) < len(types_),
        choices=choices,
        default=MISSING if isinstance(default, property) else default,  # one of the base class
    )


def _flat(annotation: Any) -> tuple[list[Any], list[Any]]:
    """Return the alternatives of an annotation and all its metadata, the outermost first."""
    origin = typing.get_origin(annotation)
    if origin is Annotated:
        inner, metadata = _flat(annotation.__origin__)
        return inner, [*reversed(annotation.__metadata__), *metadata]
    if origin in (typing.Union, types.UnionType):
        parts = [_flat(part) for part in typing.get_args(annotation)]
        return [k for kinds, _ in parts for k in kinds], [m for _, marks in parts for m in marks]
    return [annotation], []


def _choices(kind: Any) -> tuple[Any, ...]:
    """Return the values of a Literal or of a StrEnum, nothing for another type."""
    if typing.get_origin(kind) is typing.Literal:
        return typing.get_args(kind)
    return tuple(kind) if isinstance(kind, type) and issubclass(kind, enum.StrEnum) else ()
