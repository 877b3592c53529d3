"""Files of controls: the door through which plugins read what controls say of their machines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import field
from pathlib import Path
from types import MappingProxyType
from typing import ClassVar, Literal, NamedTuple

from gcxform.config.toml_text import TomlText, did_you_mean
from gcxform.diagnostics import Diagnostic, FileError, Location
from gcxform.machine.kinds import Kinds
from gcxform.machine.machine import Machine, Tool
from gcxform.machine.presets import Presets
from gcxform.system import inputs
from gcxform.values import dataclass

TAKEN = frozenset(
    {"file", "output", "limit", "allow_outside", "debug", "show_traceback", "help"}
    | {"json", "as_json"}
)
"""What every command of `gcxform machine import` has, so no field of a control has such a name."""


@dataclass(frozen=True)
class ProgramSettings:
    """What a file of a control says of programs.

    `folders` are those in which subprograms are looked up, `parameters` the values that it gives to
    parameters which programs read, as `parameters` of [input] names them. `codes` are M codes that
    do something else than the control's own: "moves" its axes besides, or runs a "program".
    """

    folders: tuple[Path, ...] = ()
    parameters: Mapping[str, float] = field(default_factory=dict)
    codes: Mapping[str, str] = field(default_factory=dict)


class ControlFiles:
    """The files of a control; its docstring is what `gcxform list controls` shows.

    A control has methods of its own for those of its files that are read. It is a frozen dataclass:
    what its kinematics do not say of themselves are its fields, options as those of a pass, which
    `gcxform machine import NAME` takes. `file` is how the help of that calls the file.
    """

    name: ClassVar[str]
    file: ClassVar[str] = "FILE"

    def kinematics(self, path: Path) -> Machine:
        """Return the machine that a file describes, in mm; this docstring is the help.

        Raises FileError, and UsageError GX454 with file and line for what is not taken over.
        """
        raise NotImplementedError

    @staticmethod
    def tools(path: Path, units: Literal["mm", "in"]) -> Mapping[int, Tool]:
        """Return the tools of a table by number; `units` is what the machine file says of it.

        Raises FileError, and UsageError GX438 with file and line.
        """
        raise NotImplementedError

    @staticmethod
    def programs(path: Path) -> ProgramSettings:
        """Return what a file says of programs.

        Raises FileError, and UsageError with file and line.
        """
        raise NotImplementedError

    @classmethod
    def reads(cls, what: Literal["kinematics", "tools", "programs"]) -> bool:
        """Return whether there is a method for some files of this control."""
        return getattr(cls, what) is not getattr(ControlFiles, what)


class Known(NamedTuple):
    """What plugins know of machines: kinematics, files of controls and presets, by name.

    `dialects` are asked for only where a file has a setting that no loaded one has declared.
    """

    kinematics: Kinds = MappingProxyType({})
    controls: Mapping[str, type[ControlFiles]] = MappingProxyType({})
    presets: Presets = MappingProxyType({})
    dialects: Mapping[str, object] = MappingProxyType({})


NONE = Known()


def control_lines(path: Path, encoding: str = "latin-1") -> list[Location]:
    """Return the lines of a file, each as its place with its text. Raises FileError."""
    try:
        lines = inputs.read(path).decode(encoding).splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise FileError.one("GX901", f"cannot read {path}: {reason}") from None
    return [Location(str(path), n, 1, line, max(1, len(line))) for n, line in enumerate(lines, 1)]


def reader_findings(
    document: TomlText,
    name: str,
    what: Literal["tools", "programs"],
    known: Known,
    where: Callable[[], Location],
) -> Iterator[Diagnostic]:
    """Yield that there is no control of a name some files of which are read."""
    readers = [other for other, control in known.controls.items() if control.reads(what)]
    if name not in readers:
        files = {"tools": "tool tables", "programs": "settings for programs"}[what]
        message = f"there is no control {name!r} whose {files} are read"
        yield Diagnostic(document.codes.wrong_value, message, where(), did_you_mean(name, readers))
