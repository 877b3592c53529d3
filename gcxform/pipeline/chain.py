"""Whether a chain of passes fits together, decided by facts before any program is read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from gcxform.catalogue.remedies import either, put_before
from gcxform.contract.demands import Demands
from gcxform.contract.passes import Pass
from gcxform.diagnostics import UsageError
from gcxform.plugin.registry import default_registry
from gcxform.system.arrays import Flags
from gcxform.toolpath.facts import (
    AT_READING,
    AXIS_POSITIONS,
    COMPENSATED,
    NO_CYCLES,
    TIP_POSITIONS,
    Fact,
)
from gcxform.toolpath.path import Toolpath


def facts_at_reading(passes: Sequence[Pass]) -> frozenset[Fact]:
    """Return what a program is taken for: what the first pass requires that asks for it."""
    return frozenset(_first_asked(passes, choice) for choice in AT_READING)


def _first_asked(passes: Sequence[Pass], choice: Sequence[Fact]) -> Fact:
    asked = (fact for step in passes for fact in choice if fact in step.requires)
    return next(asked, choice[0])


def facts_after(passes: Sequence[Pass], first: int | None = None) -> frozenset[Fact]:
    """Return the facts that hold after the `first` steps of a chain, or after all."""
    facts = set(facts_at_reading(passes))
    for step in passes[:first]:
        facts = (facts - step.clears) | step.ensures
    return frozenset(facts)


def compensates(passes: Sequence[Pass]) -> bool:
    """Return whether a chain does no more to positions than to account for a machine's errors."""
    before, after = facts_at_reading(passes), facts_after(passes)
    moved = {TIP_POSITIONS, AXIS_POSITIONS}
    return before & moved == after & moved and (COMPENSATED in before) != (COMPENSATED in after)


def spared_by(passes: Sequence[Pass]) -> tuple[Callable[[Toolpath], Flags], ...]:
    """Return how passes say which rapids they leave to the machine."""
    return tuple(step.demands.spares for step in passes if step.demands.spares is not None)


def keeps_tip_codes(steps: Sequence[object]) -> bool:
    """Whether codes that follow the tip are read and stay: a step does so, and no other minds.

    Others turn no positions into those of something else, and resolve no contour or feed.
    """
    asked = [step.demands for step in steps if isinstance(step, Pass)]
    others = [each for each in asked if not each.keeps_tip_codes]
    bare = [replace(each, keeps_rows=True, promise_angle=0.0) for each in others]
    plain = all(each == Demands() for each in bare)
    moved = {TIP_POSITIONS, AXIS_POSITIONS}
    turned = any(moved & (s.ensures | s.clears) for s in steps if isinstance(s, Pass))
    return len(others) < len(asked) and plain and not turned


def expands_cycles(passes: Sequence[Pass]) -> bool:
    """Return whether all canned cycles become plain moves: by a pass, or to be compensated."""
    return compensates(passes) or any(NO_CYCLES in step.ensures for step in passes)


def check_chain(passes: Sequence[Pass]) -> None:
    """Raise UsageError where a pass requires a fact that the chain does not have there."""
    facts = set(facts_at_reading(passes))
    cleared: dict[Fact, tuple[int, str]] = {}
    _check_resolved(passes)
    for number, step in enumerate(passes, 1):
        for fact in sorted(step.requires - facts, key=lambda f: f.name):
            culprit = cleared.get(fact)
            who = f"step {culprit[0]}, {culprit[1]}," if culprit else ""
            why = f"which {who} has taken away" if culprit else "which no step before ensures"
            raise UsageError.one(
                "GX725",
                f"step {number}, {step.name}, requires {fact.name} ({fact.meaning}), {why}",
                hint=_mend(fact, culprit[1] if culprit else "", step.name),
            )
        for fact in step.clears:
            cleared[fact] = number, step.name
        facts = (facts - step.clears) | step.ensures


def _check_resolved(passes: Sequence[Pass]) -> None:
    """Raise UsageError for a step that changes the path before one that resolves it."""
    for number, step in enumerate(passes):
        if not step.demands.resolves:
            continue
        for other in passes[:number]:
            asked = other.demands
            exact = other.promise == 0 and asked.promise_angle == 0
            exact &= asked.feed_mode is None and asked.keeps_rows
            if not exact or type(other).undo is not Pass.undo or asked.resolves:
                message = f"{other.name} changes the path that {step.name} is proved against"
                raise UsageError.one("GX741", message, hint=put_before(step.name, other.name))


def _mend(fact: Fact, culprit: str, name: str) -> str:
    if culprit == name:
        return "leave one of the two out"
    if culprit:
        return put_before(name, culprit) + ", or leave one of the two out"
    makers = [
        p.name
        for p in default_registry().passes.values()
        if issubclass(p, Pass) and fact in p.ensures
    ]
    if makers:
        return either(*(put_before(maker, name) for maker in sorted(makers)))
    return f"no pass that is installed ensures {fact.name}"
