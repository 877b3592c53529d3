"""Tilted planes (G68.2) and tips that a control follows (G43.4), where nothing asks where they are.

Where such coordinates are in the machine no version follows. A chain that only says the same words
in other modes, for the same control, needs to know no more than that they are others: their blocks
stay, and positions are lost at each of them. Any other chain refuses them by name.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from typing import Any, cast

from gcxform.contract.demands import Demands
from gcxform.contract.passes import Pass
from gcxform.dialect.codes import AXES, Effect
from gcxform.dialect.dialect import Dialect

TAKES = {"plane": AXES + "PQRIJK", "no-plane": "", "tip": "H"}


def says_the_same(steps: Iterable[Pass]) -> bool:
    """Whether passes turn words into words of the same coordinates, and ask for nothing else."""
    return all(
        type(step).undo is Pass.undo
        and step.promise == 0.0
        and replace(step.demands, keeps_rows=True) == Demands()
        for step in steps
    )


def with_kept_planes(dialect: type[Dialect], keeps: bool) -> type[Dialect]:
    """Return the dialect that keeps such codes; without `keeps` the one that refuses them."""
    names = dialect.tip_rule.unfollowed
    kept = any(dialect.codes[name].effect is Effect.FRAME for name in names)
    kept = kept and "codes" in vars(dialect)  # else it is made of one that keeps them, for a run
    plain = dialect.__mro__[1] if kept else dialect
    return _keeping(cast(Any, plain)) if keeps and names else plain


@cache
def _keeping(dialect: Any) -> type[Dialect]:
    codes = dict(dialect.codes)
    for name, act in dialect.tip_rule.unfollowed.items():
        codes[name] = replace(codes[name], effect=Effect.FRAME, act=act, takes=TAKES[act])
    made: type[Dialect] = type(dialect.__name__, (dialect,), {"codes": codes})
    return made
