"""Whether, and how, programs are written whose control has a language of its own.

A program of a control with such a language is written back, line by line, where no pass turns its
positions into others: what is not understood of it stays as it stands. Else all of it has to be
understood, and it is written whole, as that of another control would be; so is one in which a line
cannot be written back, if all of it is understood.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from gcxform.contract.passes import PassContext
from gcxform.diagnostics import UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.stamps.chain import stamp_of

TEXT = "this changes text, and is for programs of words: those for {} have a language of their own"
HINT = 'dialect = "linuxcnc" in [output]; `gcxform list dialects`'


class Plan(Protocol):
    """What is asked of a plan."""

    @property
    def source(self) -> type[Dialect]: ...  # noqa: D102
    @property
    def target(self) -> type[Dialect]: ...  # noqa: D102
    @property
    def passes(self) -> Sequence[Any]: ...  # noqa: D102
    @property
    def text_passes(self) -> Sequence[Any]: ...  # noqa: D102
    @property
    def context(self) -> PassContext: ...  # noqa: D102
    @property
    def words(self) -> str: ...  # noqa: D102
    @property
    def copies(self) -> bool: ...  # noqa: D102
    @property
    def whole(self) -> str: ...  # noqa: D102


def check_written(dialect: type[Dialect]) -> None:
    """Raise UsageError for a dialect in which nothing is written."""
    if dialect.translator is not None:
        message = f"programs for {dialect.name} are read, and not written"
        raise UsageError.one("GX747", message, hint=HINT)


def check_target(plan: Plan) -> None:
    """Refuse to write, or to change the text of, programs that are only read."""
    target = plan.target
    if (plan.copies and not plan.passes) or writes_back(plan) or _spells_out(plan):
        return
    if getattr(target.translator, "speller", None) is not None:
        raise UsageError.one("GX747", TEXT.format(target.name), hint=HINT)
    check_written(target)


def target_of(plan: Plan) -> type[Dialect]:
    """Return the target of a plan; one that is like the source where no line is written back."""
    target = plan.target
    if plan.source is not target or target.translator is None or writes_back(plan):
        return target
    return target if plan.copies else type(target.__name__, (target,), {"__module__": __name__})


def writes_back(plan: Plan) -> bool:
    """Whether a program in a language of its own is written in that language line by line.

    Its lines are spelled anew where their blocks have changed, so no pass may change text,
    positions, or whose path it is: contours that are resolved have other moves.
    """
    same = plan.source is plan.target and getattr(plan.source.translator, "writes", False)
    if (
        not same
        or plan.whole
        or plan.text_passes
        or any(step.demands.resolves for step in plan.passes)
    ):
        return False
    return stamp_of(plan.passes, plan.context, plan.words) is None


def _spells_out(plan: Plan) -> bool:
    """Whether a program is written whole in the language of its target."""
    speller = getattr(plan.target.translator, "speller", None)
    return speller is not None and not plan.text_passes and plan.source is not plan.target
