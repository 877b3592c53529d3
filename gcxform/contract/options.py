"""Options: what a dataclass field says about a value that a user writes.

The fields of a pass are its options: the kebab-case key, units, type, choices, range, default,
help and the way back to TOML are derived from them.

    class Shift(gx.Pass):
        by: Vector
        limit: Annotated[Length, Option(help="the longest shift", above=0)] = 1.0

A field is a `Length` (mm), `Angle` (degrees), `Vector` (mm), `Coordinates`, int, float, bool, str,
`Path`, `ModelFile`, `KinematicsFile`, `Lines`, a `Literal` or a `StrEnum`; `T | None`; or
`T | dict[str, T]`, one value for all or one for each address letter.
"""

from __future__ import annotations

import dataclasses
import enum
import re
import types
import typing
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, TypeVar

from gcxform.config import arguments
from gcxform.config.toml_text import did_you_mean
from gcxform.contract.code_kinds import CodeList as CodeList
from gcxform.contract.code_kinds import CodeTable as CodeTable
from gcxform.contract.option_kinds import (
    LOADED,
    PLAIN,
    Around,
    Kind,
    RefusedError,
    choice_kind,
    written,
)
from gcxform.contract.option_kinds import Angle as Angle
from gcxform.contract.option_kinds import Argument as Argument
from gcxform.contract.option_kinds import Coordinates as Coordinates
from gcxform.contract.option_kinds import FeedIncrement as FeedIncrement
from gcxform.contract.option_kinds import FolderList as FolderList
from gcxform.contract.option_kinds import Increment as Increment
from gcxform.contract.option_kinds import KinematicsFile as KinematicsFile
from gcxform.contract.option_kinds import Length as Length
from gcxform.contract.option_kinds import Lines as Lines
from gcxform.contract.option_kinds import ModelFile as ModelFile
from gcxform.contract.option_kinds import Pair as Pair
from gcxform.contract.option_kinds import ParameterValues as ParameterValues
from gcxform.contract.option_kinds import Vector as Vector
from gcxform.contract.option_schemas import by_letter, ranged
from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.machine.formats import NONE, Known
from gcxform.system.option_mark import Option as Option
from gcxform.values import dataclass

if TYPE_CHECKING:
    from gcxform.errormodel.formats import ErrorFormat

Built = TypeVar("Built")
Where = Callable[[str], Location]


class OptionDoc(NamedTuple):
    """The documentation of one option, in words."""

    name: str
    type: str
    default: str
    mandatory: bool
    choices: tuple[str, ...]
    help: str
    range: str
    example: str


@dataclass(frozen=True, eq=False)
class _Spec:
    """All that is known of one option."""

    name: str
    key: str
    kind: Kind
    option: Option
    by_letter: bool
    choices: tuple[Any, ...]
    default: Any

    def read(self, raw: object, around: Around) -> object:
        """Return the value; raises RefusedError or, from the file of a model, UsageError."""
        if self.by_letter and isinstance(raw, dict):
            if wrong := [k for k in raw if not re.fullmatch("[A-Z]", k)]:
                raise RefusedError("GX701", f"{wrong[0]!r} is not an address letter")
            return {letter: self._read_one(value, around) for letter, value in raw.items()}
        return self._read_one(raw, around)

    def _read_one(self, raw: object, around: Around) -> object:
        value = self.kind.read(raw, around)
        if isinstance(value, int | float) and not self.option.admits(value):
            unit = self.kind.unit
            message = f"{value:g}{unit} is not {self.option.range_text(unit)}"
            raise RefusedError("GX706", message, self.option.help)
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
    machines: Known = NONE,
    elsewhere: Callable[[str, object], str] = lambda key, value: "",
) -> Built:
    """Return a pass, or any dataclass of options, from the keys of its table, without `use`.

    `base` is the directory of relative paths; `where` gives the place of a key, and of the whole
    for "use"; `owner` is what messages call it. `elsewhere` gives a hint for a key that is not
    known, and its value, if it is one of another pass. Raises UsageError with all that is wrong.
    """
    owner = owner or f"the pass {getattr(pass_class, 'name', '')!r}"
    around = Around(base, formats, machines)
    specs = _specs(pass_class)
    known = [spec.key for spec in specs]
    found = [
        Diagnostic(
            "GX701",
            f"unknown key {key!r} in {owner}",
            where(key),
            elsewhere(key, value) or did_you_mean(key, known),
        )
        for key, value in raw.items()
        if key not in known
    ]
    values: dict[str, object] = {}
    for spec in specs:
        try:
            if spec.key in raw:
                values[spec.name] = spec.read(raw[spec.key], around._replace(where=where(spec.key)))
            elif spec.default is MISSING:
                raise RefusedError("GX705", f"{owner} needs {spec.key!r}", spec.option.help)
        except RefusedError as refusal:
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


def read_word(kind: str, mark: Option, word: str, where: Location | None) -> Any:
    """Return what a word of the command line is worth as an option. Raises UsageError.

    `kind` is what this module calls the type, such as "Length".
    """
    spec = dataclasses.replace(_spec_of("", globals()[kind], MISSING), option=mark)
    try:
        return spec.read(Argument(word), Around(Path()))
    except RefusedError as refusal:
        raise UsageError.one(refusal.code, refusal.message, where, refusal.hint) from None


def taken(instance: Built) -> Built:
    """Return a dataclass of options that was made in Python, its values as a file would give them.

    Raises UsageError for values that no file could give.
    """
    changed: dict[str, object] = {}
    for spec in _specs(type(instance)):
        value = getattr(instance, spec.name)
        if value is None and spec.default is None:
            continue
        found = _taken(spec, value, instance)
        if found is not value and (type(found) is not type(value) or found != value):
            changed[spec.name] = found
    return dataclasses.replace(instance, **changed) if changed else instance  # type: ignore[type-var]


def _taken(spec: _Spec, value: Any, owner: object) -> object:
    """Return the value of one option as its file would give it. Raises UsageError."""
    if spec.kind in LOADED and isinstance(value, LOADED[spec.kind]):
        return value
    try:
        return spec.read(arguments.plain(value), Around(Path()))
    except RefusedError as refusal:
        name = getattr(owner, "name", "") or type(owner).__name__
        message = f"{name}: {spec.name}: {refusal.message}"
        raise UsageError.one(refusal.code, message, hint=refusal.hint) from None


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
            example=spec.option.example,
        )
        for spec in _specs(target)
    ]


def schema(target: type) -> dict[str, Any]:
    """Return the JSON Schema of a table of options: no other keys, and those that it needs."""
    specs = _specs(target)
    return {
        "type": "object",
        "properties": {spec.key: _schema_of(spec) for spec in specs},
        "required": [spec.key for spec in specs if spec.default is MISSING],
        "additionalProperties": False,
    }


def _schema_of(spec: _Spec) -> dict[str, Any]:
    """Return the JSON Schema of one option, with what it says, its range and its default."""
    found = ranged(dict(spec.kind.schema), spec.option)
    found = by_letter(found) if spec.by_letter else found
    default = _default_text(spec)
    range_ = spec.option.range_text(spec.kind.unit)
    said = [part for part in (spec.option.help, range_, default and f"default {default}") if part]
    return {**found, "description": "; ".join(said)} if said else found


def _default_text(spec: _Spec) -> str:
    """Return the default for a person: with its unit, empty if there is none."""
    raw = None if spec.default in (MISSING, None) else spec.to_raw(spec.default)
    if isinstance(raw, bool | None):
        return "" if raw is None else written(raw)
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
    return _specs_of(target)


@lru_cache(256)  # of classes: what their hints mean is worked out by typing, which is slow
def _specs_of(target: Any) -> tuple[_Spec, ...]:
    hints = typing.get_type_hints(target, include_extras=True)
    fields = [f for f in dataclasses.fields(target) if f.init]
    return tuple(_spec_of(f.name, hints[f.name], _default(f)) for f in fields)


def _default(of: dataclasses.Field[Any]) -> Any:
    default = of.default if of.default_factory is MISSING else of.default_factory()
    return MISSING if isinstance(default, property) else default  # one of the base class


def _spec_of(name: str, annotation: Any, default: Any) -> _Spec:
    alternatives, metadata = _flat(annotation)
    types_ = [kind for kind in alternatives if kind is not types.NoneType]
    plain = [kind for kind in types_ if typing.get_origin(kind) is not dict] or types_
    marks = [mark for mark in metadata if isinstance(mark, Kind)]
    choices = _choices(plain[0])
    kind = marks[0] if marks else choice_kind(choices) if choices else PLAIN.get(plain[0])
    if kind is None or (len(plain) != 1 and not marks):
        raise TypeError(f"the option {name!r} has the type {annotation}, which is none of ours")
    return _Spec(
        name=name,
        key=name.replace("_", "-"),
        kind=kind,
        option=next((mark for mark in metadata if isinstance(mark, Option)), Option()),
        by_letter=len(plain) < len(types_),
        choices=choices,
        default=default,
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
