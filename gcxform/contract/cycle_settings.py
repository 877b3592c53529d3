"""What a machine file says of canned cycles, where controls of one name differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import Any, cast

from gcxform.dialect.cycle_rule import CycleRule
from gcxform.dialect.dialect import Dialect

LEVELS, REPEATS = "cycle-levels", "cycle-repeats"


def with_cycle_settings(
    dialect: type[Dialect], control: Mapping[str, str | float]
) -> type[Dialect]:
    """Return the dialect with the cycles that a machine file tells of; itself where it says none.

    `cycle-levels` is of controls on which words of a cycle stay, `cycle-repeats` of those that
    count holes by K.
    """
    rule = dialect.cycle_rule
    if rule is None:
        return dialect
    stay = rule.stays.words and LEVELS in control
    count = str(control.get(REPEATS, "")) if rule.repeats == "K" else ""
    return _with(cast(Any, dialect), stay, count) if stay or count else dialect


@cache
def _with(dialect: Any, stay: bool, count: str) -> type[Dialect]:
    rule: CycleRule = dialect.cycle_rule
    if count:
        cycles = {n: replace(c, takes=c.takes.replace("K", count)) for n, c in rule.cycles.items()}
        rule = replace(rule, cycles=cycles, repeats=count)
    own = {"cycle_rule": replace(rule, stays=replace(rule.stays, levels=stay))}
    return cast("type[Dialect]", type(dialect.__name__, (dialect,), own))
