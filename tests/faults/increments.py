"""Faults of what numbers without a point are worth."""

from __future__ import annotations

from faults.mutation import Mutation

TESTS = "tests/test_increments.py"


def _fault(name: str, file: str, old: str, new: str) -> Mutation:
    return Mutation(f"increments: {name}", file, old, new, TESTS)


MUTATIONS = (
    _fault(
        "inches as mm", "gcxform/dialect/increments.py", "self.inch if inch else self.mm", "self.mm"
    ),
    _fault(
        "a length is scaled by the unit",
        "gcxform/dialect/increments.py",
        "_whole(INCH / length)",
        "_whole(1 / length)",
    ),
    _fault(
        "angles in inches are finer",
        "gcxform/dialect/increments.py",
        "10 * steps, steps, second",
        "10 * steps, 10 * steps, second",
    ),
    _fault(
        "IS-A is IS-B", "gcxform/dialect/increments.py", "2 + SYSTEMS.index", "3 + SYSTEMS.index"
    ),
    _fault(
        "IS-C dwells are known",
        "gcxform/dialect/increments.py",
        'if name == "IS-B" else None',
        "if name else None",
    ),
    _fault(
        "calculator input counts",
        "gcxform/modal/numbers_without_point.py",
        "np.ones(len(value)) if self._floats(address) else",
        "",
    ),
    _fault(
        "every line has the unit of mm",
        "gcxform/modal/numbers_without_point.py",
        "np.where(inch, inches, mm)\n\n",
        "np.where(inch, mm, mm)\n\n",
    ),
    _fault("G93 counts units", "gcxform/modal/numbers_without_point.py", "= INVERSE_TIME", "= 1.0"),
    _fault(
        "feeds in inches are mm",
        "gcxform/modal/numbers_without_point.py",
        "np.where(inch, inches, mm)[per_minute]",
        "mm",
    ),
    _fault(
        "feeds a minute count in any mode",
        "gcxform/modal/numbers_without_point.py",
        "counts[per_minute] = 1 / said",
        "counts[:] = 1 / said",
    ),
    _fault(
        "steps of feeds are units",
        "gcxform/modal/numbers_without_point.py",
        "counts[per_minute] = 1 / said",
        "counts[per_minute] = said",
    ),
)
