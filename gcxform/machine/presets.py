"""Machines that files can be like: values that whoever made or configured one has published.

`like = "..."` in `[control]` of a machine file takes them; what the file says itself wins. A preset
holds what its source states and nothing else, so what a machine is set to must still be said.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, ClassVar, Final

from gcxform.config.toml_text import TomlText, did_you_mean
from gcxform.diagnostics import UsageError
from gcxform.machine.control import LIKE

TABLES: Final = ("control", "axis", "home")
"""The tables of a machine file that a preset may have."""


class MachinePreset:
    """A machine that files can be like; its docstring is what `gcxform list presets` shows.

    `source` says where the values stand that `values` has, in tables as a machine file has them.
    """

    name: ClassVar[str] = ""
    source: ClassVar[str] = ""
    values: ClassVar[Mapping[str, Mapping[str, Any]]] = {}


Presets = Mapping[str, type[MachinePreset]]


def with_preset(document: TomlText, known: Presets) -> tuple[TomlText, tuple[str, ...]]:
    """Return a file with what the preset that it names says besides, and what that is, in words.

    Raises UsageError for a preset that is not there.
    """
    control = document.values.get("control")
    if not isinstance(control, dict) or LIKE not in control:
        return document, ()
    name = control[LIKE]
    preset = known.get(name) if isinstance(name, str) else None
    if preset is None:
        message = f"there is no preset {name!r} of a machine"
        hint = did_you_mean(str(name), known)
        where = document.where("control", LIKE)
        raise UsageError.one(document.codes.wrong_value, message, where, hint)
    own = {**document.values, "control": {k: v for k, v in control.items() if k != LIKE}}
    taken = tuple(f"{each} of {name} ({preset.source})" for each in _taken(preset.values, own))
    return replace(document, values=_filled(own, preset.values)), taken


def said_by(preset: type[MachinePreset]) -> list[str]:
    """Return what a preset says, each value with its keys."""
    return list(_taken(preset.values, {}))


def _filled(own: Any, more: Mapping[str, Any]) -> Any:
    """Return tables with what others have besides."""
    if not isinstance(own, dict):
        return own
    return {
        **own,
        **{
            key: _filled(own.get(key, {}), value) if isinstance(value, Mapping) else value
            for key, value in more.items()
            if isinstance(value, Mapping) or key not in own
        },
    }


def _taken(more: Mapping[str, Any], own: Any, prefix: str = "") -> Iterator[str]:
    """Yield the values that are taken, each with its keys."""
    for key, value in more.items():
        said = own.get(key) if isinstance(own, dict) else None
        if isinstance(value, Mapping):
            yield from _taken(value, said, f"{prefix}{key}.")
        elif said is None:
            yield f"{prefix}{key} = {_written(value)}"


def _written(value: Any) -> str:
    """Return a value as TOML has it."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_written, value))}]"
    return f'"{value}"' if isinstance(value, str) else f"{value}"
