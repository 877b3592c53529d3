"""Tilted planes (G68.2) and tips that a control follows (G43.4): kept, followed, or refused.

A chain that only says the same words in other modes, for the same control, needs to know no more
than that they are others: their blocks stay, and positions are lost at each of them. Any other
chain has to know where such coordinates are. On a machine whose tables are told planes are followed
(`gcxform/modal/frames/planes.py`), and tips as long as no axis turns
(`gcxform/modal/frames/followed_tips.py`); all else is refused by name.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from typing import Any, Literal, cast

from gcxform.contract.demands import Demands
from gcxform.contract.passes import Pass
from gcxform.dialect.codes import AXES, Effect
from gcxform.dialect.dialect import Dialect
from gcxform.machine.chain import tables_of
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.toolpath.facts import AXIS_POSITIONS, TIP_POSITIONS

EULER = AXES + "PQRIJK"
TAKES = {
    **dict.fromkeys(("plane", "define-plane"), EULER),
    **dict.fromkeys(("tip", "follow-tip"), "H"),
    **dict.fromkeys(("no-plane", "orient"), ""),
    "swivel": "P",
    "turn-to": "IJK",
}
Which = Literal["refused", "kept", "followed"]


def says_the_same(steps: Iterable[Pass]) -> bool:
    """Whether passes turn words into words of the same coordinates, and ask for nothing else."""
    return all(
        type(step).undo is Pass.undo
        and step.promise == 0.0
        and replace(step.demands, keeps_rows=True) == Demands()
        for step in steps
    )


def treatment(same: bool, steps: Sequence[Pass], machine: Machine | None) -> Which:
    """Return what passes make of such codes; `same`: they write for the control they read.

    Passes that make tips of positions of axes, or the reverse, follow neither.
    """
    if same and says_the_same(steps):
        return "kept"
    kinds = {TIP_POSITIONS, AXIS_POSITIONS}
    tips = any(kinds & (step.ensures | step.clears) for step in steps)
    follows = machine is not None and tables_of(machine) is not None
    return "followed" if follows and not tips else "refused"


def with_known_planes(dialect: type[Dialect], reading: Reading) -> type[Dialect]:
    """Return the dialect in which a program is read by itself: planes are followed, if they can."""
    return dialect if reading.tables is None else with_planes(dialect, "followed")


def with_planes(dialect: type[Dialect], which: Which) -> type[Dialect]:
    """Return the dialect that keeps, follows or refuses such codes, whatever is given."""
    rule = dialect.tip_rule
    names = {"refused": {}, "kept": rule.unfollowed, "followed": rule.planes}[which]
    made = any(dialect.codes[name].effect is Effect.FRAME for name in rule.unfollowed)
    made = made and "codes" in vars(dialect)  # else it is made of one that keeps them, for a run
    plain = dialect.__mro__[1] if made else dialect
    return _acting(cast(Any, plain), tuple(names.items())) if names else plain


@cache
def _acting(dialect: Any, acts: tuple[tuple[str, str], ...]) -> type[Dialect]:
    codes = dict(dialect.codes)
    for name, act in acts:
        codes[name] = replace(codes[name], effect=Effect.FRAME, act=act, takes=TAKES[act])
    made: type[Dialect] = type(dialect.__name__, (dialect,), {"codes": codes})
    return made
