"""The types of options: how a value is read from TOML or a word, and written back.

Lengths are mm and angles degrees; both may be written with a unit.
"""

from __future__ import annotations

import hashlib
import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, TypeVar

import msgspec

from gcxform.config.quantities import ANGLE, AXIS_LETTERS, LENGTH, Quantity, quantity_of
from gcxform.config.schemas import quantity_schema
from gcxform.config.toml_text import did_you_mean
from gcxform.contract.option_schemas import (
    COORDINATES_SCHEMA,
    FEED_INCREMENT_SCHEMA,
    INCREMENT_SCHEMA,
    LINES_SCHEMA,
    PARAMETER,
    PARAMETERS_SCHEMA,
    VECTOR_SCHEMA,
)
from gcxform.diagnostics import FileError, Location, UsageError
from gcxform.dialect.increments import CALCULATOR, SYSTEMS, Increments
from gcxform.machine.formats import NONE, Known
from gcxform.machine.machine import Machine
from gcxform.system import inputs
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.errormodel.formats import ErrorFormat
    from gcxform.errormodel.model import ErrorModel

Read = TypeVar("Read")


class Argument(str):
    """A value on the command line: text of which the option says what it is."""


@dataclass(frozen=True)
class ModelFile:
    """An error model with the file it came from; equal when the content is.

    `sha256` is that of the file; for a foreign format that of the model in its native form. Of a
    model that comes from more files, or is in another state than its file says, it is its own.
    """

    path: Path = field(compare=False)
    model: ErrorModel = field(compare=False, repr=False)
    sha256: str

    @classmethod
    def load(cls, path: Path, formats: Iterable[type[ErrorFormat]] = ()) -> ModelFile:
        """Return the model of a file; raises UsageError as `load_model` does."""
        from gcxform.errormodel import model_file as modelfile
        from gcxform.errormodel.model_text import fingerprint, to_toml

        native = path.suffix.lower() == modelfile.SUFFIX
        if native:
            model, data = _read_twice(path, partial(modelfile.load_model, formats=tuple(formats)))
        else:
            model = modelfile.load_model(path, tuple(formats))
            data = to_toml(model).encode()
        data += fingerprint(model) if model.composed else b""
        return cls(path, model, hashlib.sha256(data).hexdigest())

    def at_time(self, time: str) -> ModelFile:
        """Return the model in its state at a time (ISO 8601). Raises UsageError.

        A model that is in that state stays as it is, so that a pass may ask again.
        """
        from gcxform.errormodel.model_text import fingerprint

        if not self.model.states:
            message = f"{self.path.name} holds at any time: it has no thermal model"
            raise UsageError.one("GX426", message, hint="leave `time` out")
        model = self.model.at_time(time)
        content = fingerprint(model)
        if content == fingerprint(self.model):
            return self
        return replace(self, model=model, sha256=hashlib.sha256(content).hexdigest())


@dataclass(frozen=True)
class KinematicsFile:
    """A machine with the file it came from; equal when the content is. `sha256` is the file's."""

    path: Path = field(compare=False)
    machine: Machine = field(compare=False, repr=False)
    sha256: str

    @classmethod
    def load(cls, path: Path, known: Known = NONE) -> KinematicsFile:
        """Return the machine of a file; raises UsageError as `load_machine` does."""
        from gcxform.machine.file import load_machine

        machine, data = _read_twice(path, partial(load_machine, known=known))
        return cls(path, machine, hashlib.sha256(data).hexdigest())


def _read_twice(path: Path, load: Callable[[Path], Read]) -> tuple[Read, bytes]:
    """Return what a file says, and its bytes. Raises FileError if they may not belong together."""
    try:
        before, data = os.stat(path), inputs.read(path)
    except (OSError, ValueError):
        load(path)  # says what is wrong, in the words of its kind
        raise
    found = load(path)
    if inputs.is_changed(before, os.stat(path), len(data)):
        raise FileError.one("GX904", f"cannot read {path}: {inputs.CHANGED}")
    return found, data


@dataclass(frozen=True)
class Lines:
    """Lines of a program, as a user gives them, and the place of the option that has them."""

    texts: tuple[str, ...]
    where: Location | None = field(default=None, compare=False, repr=False)


class RefusedError(Exception):
    """A value which is not what its option takes: the code, a sentence and a hint."""

    def __init__(self, code: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.code, self.message, self.hint = code, message, hint


class Around(NamedTuple):
    """What surrounds the values: the directory for relative paths, and what plugins know.

    That is the formats of error models, and what machine files name. `where` is the place of the
    option.
    """

    base: Path
    formats: Iterable[type[ErrorFormat]] = ()
    machines: Known = NONE
    where: Location | None = None


@dataclass(frozen=True, eq=False)
class Kind:
    """A type of options: its words, how a raw value is read and written, its unit.

    `schema` is the JSON Schema of what a file may say.
    """

    words: str
    read: Callable[[object, Around], Any]
    raw: Callable[[Any], object] = lambda value: value
    unit: str = ""
    schema: Mapping[str, Any] = field(default_factory=lambda: {"type": "string"})


def written(raw: object) -> str:
    """Return a raw value for a message."""
    if isinstance(raw, list | dict):
        return "a list" if isinstance(raw, list) else "a table"
    return str(raw).lower() if isinstance(raw, bool) else repr(raw)


def _expected(what: str, raw: object) -> RefusedError:
    return RefusedError("GX702", f"expected {what}, got {written(raw)}")


def _read_plain(kind: type, what: str, raw: object, around: Around) -> Any:
    """Return a number, a string or a truth value; a word may be any of them."""
    word = isinstance(raw, Argument)
    try:
        value: Any = msgspec.convert(str(raw) if word else raw, kind, strict=not word)
    except msgspec.ValidationError:
        raise _expected(what, raw) from None
    if isinstance(value, float) and not math.isfinite(value):
        raise _expected(f"{what} that is finite", raw)
    return value


def _read_path(raw: object, around: Around) -> Path:
    if not isinstance(raw, str) or not raw or "\0" in raw:
        raise _expected("the name of a file", raw)
    if isinstance(raw, Argument):  # the user's own word
        return around.base / raw
    return inputs.referred(around.base, raw, around.where)


def _read_existing(raw: object, around: Around) -> Path:
    path = _read_path(raw, around)
    if not os.path.exists(path):  # unlike Path.exists, false for a name that is too long
        raise RefusedError("GX709", f"the file {str(path)!r} does not exist")
    return path


def _read_folders(raw: object, around: Around) -> tuple[Path, ...]:
    """Return folders that are there; those of a file as it may name other files."""
    if not isinstance(raw, list | tuple):
        raise _expected('a list of folders, such as ["subprograms"]', raw)
    paths = tuple(_read_path(each, around) for each in raw)
    if wrong := [path for path in paths if not os.path.isdir(path)]:
        raise RefusedError("GX709", f"the folder {str(wrong[0])!r} does not exist")
    return paths


def _read_model(raw: object, around: Around) -> ModelFile:
    return ModelFile.load(_read_existing(raw, around), around.formats)


def _read_machine(raw: object, around: Around) -> KinematicsFile:
    return KinematicsFile.load(_read_existing(raw, around), around.machines)


def _read_quantity(quantity: Quantity, raw: object, around: Around) -> float:
    if isinstance(raw, str):
        try:
            return quantity.parse(raw, bare=isinstance(raw, Argument))
        except ValueError as error:
            raise RefusedError("GX708", str(error)) from None
    what = f"{quantity.article}, such as {quantity.example}"
    return float(_read_plain(float, what, raw, around))


def _read_increment(raw: object, around: Around) -> float | str:
    """Return a length in mm, or how a system is called."""
    if not isinstance(raw, str) or LENGTH.of(raw) is not None:
        return _read_quantity(LENGTH, raw, around)
    try:
        Increments.of(raw)
    except ValueError as error:
        raise RefusedError("GX708", str(error)) from None
    return raw


def _read_feed_increment(raw: object, around: Around) -> float | str:
    """Return a number of units per minute, or how a system is called."""
    if raw in (CALCULATOR, *SYSTEMS):
        return str(raw)
    if isinstance(raw, str) and not isinstance(raw, Argument):
        known = f"a number of units per minute, {', '.join(SYSTEMS)} or {CALCULATOR}"
        raise RefusedError("GX702", f"expected {known}, got {written(raw)}")
    return float(_read_plain(float, "a number of units per minute", raw, around))


def _read_vector(raw: object, around: Around) -> tuple[float, float, float]:
    parts: list[object] = raw if isinstance(raw, list) else []
    if isinstance(raw, str):
        parts = [Argument(part) for part in raw.split(",")]
    elif isinstance(raw, dict) and sorted(raw) == ["X", "Y", "Z"]:
        parts = [raw[letter] for letter in "XYZ"]
    if len(parts) != 3:
        raise _expected("three lengths, such as [0.0, 0.0, 0.0] or {X = 0, Y = 0, Z = 0}", raw)
    x, y, z = (_read_quantity(LENGTH, part, around) for part in parts)
    return x, y, z


def _read_pair(raw: object, around: Around) -> tuple[float, float]:
    parts = raw.split(",") if isinstance(raw, Argument) else []
    if len(parts) != 2:
        raise _expected("two lengths, such as 0.1,-0.2", raw)
    x, y = (_read_quantity(LENGTH, Argument(part), around) for part in parts)
    return x, y


def _read_coordinates(raw: object, around: Around) -> dict[str, float]:
    if not isinstance(raw, dict):
        raise _expected("a table of axis letters, such as {X = 0.0, A = 0.0}", raw)
    if wrong := [key for key in raw if key not in AXIS_LETTERS]:
        raise RefusedError("GX701", f"{wrong[0]!r} is not one of the axes {' '.join(AXIS_LETTERS)}")
    return {key: _read_quantity(quantity_of(key), value, around) for key, value in raw.items()}


_PARAMETER = re.compile(PARAMETER)


def _read_parameters(raw: object, around: Around) -> dict[str, float]:
    if not isinstance(raw, dict):
        raise _expected('a table of parameters, such as {"100" = 1.5, "<depth>" = -2.0}', raw)
    if wrong := [key for key in raw if not _PARAMETER.fullmatch(key)]:
        hint = 'write a number, "100", or a name in its brackets, "<depth>"'
        raise RefusedError("GX701", f"{wrong[0]!r} is not a parameter", hint)
    return {key: _read_plain(float, "a number", value, around) for key, value in raw.items()}


def _read_lines(raw: object, around: Around) -> Lines:
    given = raw.split(",") if isinstance(raw, Argument) else raw
    if not isinstance(given, list) or not all(isinstance(text, str) for text in given):
        raise _expected('a list of lines, such as ["M9", "G53 G0 Z0."]', raw)
    texts = tuple(text.strip(" ") for text in given)
    if not all(text.isascii() and text.isprintable() and text for text in texts):
        raise RefusedError("GX702", "expected lines of plain characters, none of them empty")
    return Lines(texts, around.where)


def choice_kind(choices: tuple[Any, ...]) -> Kind:
    """Return the kind of a value which is one of a few, strings or numbers."""
    texts = {str(choice): choice for choice in choices}

    def read(raw: object, around: Around) -> object:
        choice = texts.get(str(raw))
        same = isinstance(raw, str) == isinstance(choice, str) or isinstance(raw, Argument)
        if choice is None or not same:
            known = [text for text in texts if text]
            message = f"{written(raw)} is not one of {', '.join(known)}"
            raise RefusedError("GX707", message, did_you_mean(str(raw), known))
        return choice

    def raw(choice: Any) -> object:
        return str(choice) if isinstance(choice, str) else choice

    return Kind("choice", read, raw, schema={"enum": [raw(choice) for choice in choices]})


def _quantity_kind(quantity: Quantity) -> Kind:
    read = partial(_read_quantity, quantity)
    return Kind(quantity.name, read, unit=f" {quantity.base}", schema=quantity_schema(quantity))


def _plain_kind(kind: type, words: str, what: str, name: str) -> Kind:
    return Kind(words, partial(_read_plain, kind, what), schema={"type": name})


def _file_kind(words: str, read: Callable[[object, Around], Any]) -> Kind:
    def raw(file: Any) -> str:
        return str((file if isinstance(file, Path) else file.path).absolute())

    return Kind(words, read, raw, schema={"type": "string", "minLength": 1})


_LENGTH, _ANGLE = _quantity_kind(LENGTH), _quantity_kind(ANGLE)
_INCREMENT = Kind(
    "increment system or length", _read_increment, unit=" mm", schema=INCREMENT_SCHEMA
)
_FEED_INCREMENT = Kind(
    "increment system or number", _read_feed_increment, schema=FEED_INCREMENT_SCHEMA
)
_VECTOR = Kind("three lengths", _read_vector, list, schema=VECTOR_SCHEMA)
_PAIR = Kind("two lengths", _read_pair, list)
_COORDINATES = Kind("coordinates by axis letter", _read_coordinates, schema=COORDINATES_SCHEMA)
_PARAMETERS = Kind("numbers by parameter", _read_parameters, schema=PARAMETERS_SCHEMA)
_FOLDERS = Kind(
    "list of folders",
    _read_folders,
    lambda paths: [str(p.absolute()) for p in paths],
    schema={"type": "array", "items": {"type": "string", "minLength": 1}},
)
PLAIN: dict[type, Kind] = {
    bool: _plain_kind(bool, "true or false", "true or false", "boolean"),
    int: _plain_kind(int, "whole number", "a whole number", "integer"),
    float: _plain_kind(float, "number", "a number", "number"),
    str: _plain_kind(str, "text", "a text", "string"),
    Path: _file_kind("file name", _read_path),
    ModelFile: _file_kind("error model", _read_model),
    Lines: Kind("list of lines", _read_lines, lambda lines: list(lines.texts), "", LINES_SCHEMA),
    KinematicsFile: _file_kind("machine file", _read_machine),
}
"""The types that are known by themselves; all others stand in an annotation."""
LOADED: dict[Kind, type] = {PLAIN[kind]: kind for kind in (Path, ModelFile, Lines, KinematicsFile)}
"""Kinds whose values are more than what a file says of them: in Python they come ready made."""

Length = Annotated[float, _LENGTH]
"""A length in mm; written "5 um", "0.2 mm", "0.001 in" or as a number in mm."""
Angle = Annotated[float, _ANGLE]
"""An angle in degrees; written "10 deg", "80 urad" or as a number in degrees."""
Increment = Annotated[float | str, _INCREMENT]
"""A length in mm, or what `Increments` takes: "IS-B", "calculator", "0.01 mm, 0.01 deg"."""
FeedIncrement = Annotated[float | str, _FEED_INCREMENT]
"""A number of units per minute, or the name of a system or of calculator input."""
Vector = Annotated[tuple[float, float, float], _VECTOR]
"""Three lengths in mm; written as a list, as "0,0,0" or as a table of X, Y and Z."""
Pair = Annotated[tuple[float, float], _PAIR]
"""Two lengths in mm; a word of the command line, such as "0,0"."""
Coordinates = Annotated[dict[str, float], _COORDINATES]
"""Positions by axis letter, mm or degrees; written as a table."""
ParameterValues = Annotated[dict[str, float], _PARAMETERS]
"""Values of parameters by number ("100") or name ("<depth>"); written as a table."""
FolderList = Annotated[tuple[Path, ...], _FOLDERS]
"""Folders, relative to the file that names them; written as a list."""
