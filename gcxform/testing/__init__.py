"""The kit for plugin authors: checks of passes and dialects, case files, strategies.

Strategies are in `gcxform.testing.strategies`, which needs hypothesis.
"""

from gcxform.testing.cases import (
    Case,
    Outcome,
    check_outcome,
    outcome,
    read_case,
    run_case,
)
from gcxform.testing.dialects import check_dialect
from gcxform.testing.kit import check_pass

__all__ = [
    "Case",
    "Outcome",
    "check_dialect",
    "check_outcome",
    "check_pass",
    "outcome",
    "read_case",
    "run_case",
]
