"""Hints have to work: what they give has to be a setting, and one that takes its value."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec

from gcxform.catalogue.settings import Setting, settings
from gcxform.contract.options import build, describe
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.control import INERT, answers, settings_of
from gcxform.machine.file import FILLED_IN
from gcxform.machine.machine import Offset, Tool
from gcxform.machine.macro_tables import expected
from gcxform.pipeline.file import SECTIONS
from gcxform.plugin.registry import Registry


def try_hint(hint: str, registry: Registry) -> None:
    """Raise ValueError for a setting in a hint that nothing has or whose value is not taken."""
    for setting in settings(hint):
        _try(setting, registry)


def _try(setting: Setting, registry: Registry) -> None:
    """Raise ValueError if nothing has the key of a setting, or if it does not take the value.

    Letters and dots that stand for numbers (`start = { X = ... }`, `[x, y, z]`) count as 0.
    """
    value = setting.worth()
    table, *name = setting.section.split(".", 1)
    if table in FILLED_IN:
        _try_machine(table, name, setting.key, value)
        return
    if setting.section:
        owners: list[type] = [SECTIONS[setting.section]] if setting.section in SECTIONS else []
    else:
        owners = list(registry.passes.values())
    having = [owner for owner in owners if setting.key in {o.name for o in describe(owner)}]
    if setting.section and not having:
        raise ValueError(f"[{setting.section}] has no key {setting.key!r}")
    for owner in having:
        _take(owner, setting.key, value)


def _try_machine(table: str, name: list[str], key: str, value: Any) -> None:
    """Raise ValueError if a machine file does not take a value; `*` is any name."""
    if table == "control" and name:
        if wrong := expected(name[0].partition(".")[2].strip('"'), {key: value}):
            raise ValueError(f"[{table}.{name[0]}]: expected {wrong}")
        return
    if table == "control":
        if key != INERT and not answers(key):
            raise ValueError(f"[control] has no key {key!r}")
        settings_of({key: value})
        return
    fields = msgspec.structs.fields(Tool if table == "tool" else Offset)
    if len(name) != 1 or key not in {each.encode_name for each in fields}:
        raise ValueError(f"[{'.'.join([table, *name])}] has no key {key!r}")


def _take(owner: type, key: str, value: Any) -> None:
    """Raise ValueError if an option does not take a value; other options do not count."""
    try:
        build(owner, {key: value}, Path(), (), Location)
    except UsageError as error:
        wrong = [each for each in error.diagnostics if each.message.startswith(f"{key}:")]
        if wrong:
            raise ValueError(wrong[0].message) from None
