"""Whether a step has done what it says of itself: the facts it ensures, and how far it deviates."""

from __future__ import annotations

from collections.abc import Mapping

from gcxform.contract.passes import Pass
from gcxform.diagnostics import VerificationError
from gcxform.toolpath.path import Toolpath

EQUAL = 1e-9  # mm, degrees; what the last bits of two sums may be apart


def check_ensured(step: Pass, after: Toolpath) -> None:
    """Raise VerificationError (GX602) where a path lacks what its step says that it has."""
    for fact in step.ensures:
        if not fact.check(after):
            message = f"{step.name} ensures {fact.name}, and the path does not have it"
            raise VerificationError.one("GX602", message)


def check_promised(step: Pass, measured: Mapping[str, float]) -> None:
    """Raise VerificationError (GX602) where a step measures more of a kind than it promises.

    No comparison of paths shows these figures (`Demands.deviates`), so nothing else would refuse.
    """
    bounds = {"deviation": (step.promise, "mm"), "angle": (step.demands.promise_angle, "degrees")}
    for kind, name in step.demands.deviates.items():
        bound, unit = bounds[kind]
        if name in measured and not measured[name] <= bound + EQUAL:
            message = f"{step.name} promises {bound:g} {unit}, and measures {measured[name]:.4g}"
            raise VerificationError.one("GX602", message)
