"""Foreign file formats of error models: the door through which plugins read and write tables."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import MISSING
from pathlib import Path
from typing import ClassVar

from gcxform.diagnostics import Location, UsageError
from gcxform.errormodel.model import ErrorModel
from gcxform.system import inputs

HEAD = 4096  # bytes: enough to tell formats apart by what they begin with


class ErrorFormat(ABC):
    """A file format of error models; its docstring is what `gcxform list formats` shows.

    `name` is unique among the formats, `suffixes` are the file name endings which are usual. What
    the files do not say of themselves, such as their units, are the fields of the class, a frozen
    dataclass then: options as those of a pass. `control` says how a control takes the table itself;
    empty where none does.
    """

    name: ClassVar[str]
    suffixes: ClassVar[tuple[str, ...]]
    control: ClassVar[str] = ""

    @classmethod
    def recognises(cls, path: Path) -> bool:
        """Return whether the file or directory is meant to be of this format; raise nothing.

        A file is, unless a format says otherwise, where its name ends in one of the `suffixes`.
        """
        return path.suffix.lower() in cls.suffixes and path.is_file()

    @abstractmethod
    def read(self, path: Path) -> ErrorModel:
        """Return the model of a file, or raise UsageError with file and line."""

    def write(self, model: ErrorModel) -> Mapping[str, str]:
        """Return the files of a model: their texts by name, in a directory which the user names.

        The empty name stands for the user's own name, if the format is one file. Raises UsageError
        GX481 with the name of what the format cannot hold; without a method of its own it can hold
        nothing.
        """
        raise cannot_hold(self.name, "anything: the format is only read")


def cannot_hold(name: str, what: str, hint: str = "") -> UsageError:
    """Return the refusal of a format to write a part of a model."""
    return UsageError.one("GX481", f"the format {name!r} cannot hold {what}", hint=hint)


def unsaid(form: type[ErrorFormat]) -> list[str]:
    """Return the options which a format needs and its files do not say."""
    fields: Iterable[dataclasses.Field[object]] = getattr(form, "__dataclass_fields__", {}).values()
    needed = [f for f in fields if f.default is MISSING and f.default_factory is MISSING]
    return [f.name.replace("_", "-") for f in needed if f.init and "ClassVar" not in str(f.type)]


def chosen_format(path: Path, formats: Iterable[type[ErrorFormat]]) -> type[ErrorFormat] | None:
    """Return the format that recognises a path, None if none does. Raises UsageError if two do."""
    check_readable(path)
    found = [form for form in formats if form.recognises(path)]
    if len(found) > 1:
        names = " and ".join(form.name for form in found)
        hint = "say which with `gcxform table convert --from FORMAT`"
        raise UsageError.one("GX416", f"{path} fits the formats {names}", hint=hint)
    return found[0] if found else None


def check_readable(path: Path) -> None:
    """Raise UsageError for a file that nobody should open to look at it: a pipe, a device."""
    try:
        if not path.is_dir():
            inputs.check_kind(path)
    except OSError as error:
        message = f"the file cannot be read: {error.strerror}"
        raise UsageError.one("GX401", message, Location(str(path))) from None


def head_of(path: Path) -> str:
    """Return the beginning of a file as text, empty for what cannot be read: to recognise it."""
    try:
        with path.open("rb") as stream:
            return stream.read(HEAD).decode("utf-8-sig", "replace")
    except (OSError, ValueError):
        return ""
