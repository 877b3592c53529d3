"""Codes that a machine file declares: their blocks are kept, and it says where they end.

`[control.macro.G100] ends = "at XYZ"` is said of a code that the dialect does not have, or that it
refuses as one that moves by itself in its own block. All words of such a block belong to the code,
as those of G65 do. A code that stays in force, or that the dialect resolves, cannot be declared.
They are those of the control that a program is in; nothing is said of another one. A file of the
control may also say that one of its own M codes moves axes there, or runs a program.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any, cast

from gcxform.contract.cycle_settings import with_cycle_settings
from gcxform.diagnostics import UsageError
from gcxform.dialect.codes import Code, Effect
from gcxform.dialect.dialect import Dialect
from gcxform.machine.control import OTHER

ALL_WORDS = "ABCDEFHIJKLMPQRSTUVWXYZ"
MACRO = "macro "
RUNS = "the file of the control says that it runs a program of the machine"
ONE_BLOCK = "non-modal"


def with_own_codes(dialect: type[Dialect], control: Mapping[str, str | float]) -> type[Dialect]:
    """Return the dialect with the codes that a machine file declares; itself without any.

    And with what it says of canned cycles. Raises UsageError for codes that the dialect has.
    """
    names = {name.partition(MACRO)[2] for name, ends in control.items() if _declares(name, ends)}
    other = {
        name.partition(OTHER)[2]: str(how)
        for name, how in control.items()
        if name.startswith(OTHER)
    }
    dialect = with_cycle_settings(dialect, control)
    dialect = _changed(cast(Any, dialect), tuple(sorted(other.items()))) if other else dialect
    return _with(cast(Any, dialect), tuple(sorted(names))) if names else dialect


def without_own_codes(control: Mapping[str, str | float]) -> dict[str, str | float]:
    """Return what a machine file says, for a program in the language of another control."""
    return {
        name: said
        for name, said in control.items()
        if not _declares(name, said) and not name.startswith(OTHER)
    }


def _declares(name: str, said: str | float) -> bool:
    """Whether a setting declares a code."""
    code = name.removeprefix(MACRO)
    return code != name and code[0] in "GM" and isinstance(said, str)


@cache
def _changed(dialect: Any, other: tuple[tuple[str, str], ...]) -> type[Dialect]:
    """Return the dialect with M codes that do something else on this machine."""
    codes = dict(dialect.m_codes)
    chosen = dict(dialect.chosen)
    for setting, how in other:
        name = setting.removeprefix(OTHER)
        number = int(name[1:])
        does = {"loses_position": True} if how == "moves" else {"barrier": RUNS}
        if number in codes:
            codes[number] = replace(codes[number], **does)
            chosen.pop(name, None)
    own = {"m_codes": codes, "chosen": chosen}
    return cast("type[Dialect]", type(dialect.__name__, (dialect,), own))


@cache
def _with(dialect: Any, names: tuple[str, ...]) -> type[Dialect]:
    codes = {name: _declared(dialect.codes.get(name)) for name in names if name[0] == "G"}
    for name in names:
        _check(dialect, name)
    flow = replace(dialect.flow_rule, kept_codes=dialect.flow_rule.kept_codes | {*names})
    if flow == dialect.flow_rule:
        return cast("type[Dialect]", dialect)
    own = {"codes": {**dialect.codes, **codes}, "flow_rule": flow}
    made: type[Dialect] = type(dialect.__name__, (dialect,), own)
    return made


def _declared(known: Code | None) -> Code:
    """Return a code that is kept as a call; one that cuts in a way of its own does so as before."""
    cuts = known is not None and known.effect is Effect.CALL
    return Code(MACRO.strip(), Effect.CALL, ALL_WORDS, known.reason if known and cuts else "")


def _check(dialect: type[Dialect], name: str) -> None:
    """Refuse a code that is none of the machine's own."""
    if why := _why_not(dialect, name):
        message = f"[control.macro.{name}]: {dialect.name} {why}, so that it is not kept as a call"
        raise UsageError.one("GX405", message)


def may_be_said(dialect: type[Dialect], call: str) -> bool:
    """Whether a machine file may say where axes are behind a call: `P9810`, or a code."""
    return call[0] not in "GM" or not _why_not(dialect, call)


def _why_not(dialect: type[Dialect], name: str) -> str:
    """Return why a code cannot be declared, in words; "" for one of the machine's own."""
    if name in dialect.flow_rule.kept_codes:
        return ""
    known = dialect.codes.get(name) if name[0] == "G" else None
    taken = known is not None and (
        known.effect not in (Effect.BARRIER, Effect.CALL) or known.group != ONE_BLOCK
    )
    taken |= name[0] == "M" and int(float(name[1:])) in dialect.m_codes
    if taken:
        return "has this code"
    return "" if dialect.flow_rule.macro_levels else "has no calls with values"
