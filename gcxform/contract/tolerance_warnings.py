"""Tolerances that may be micrometres: a bare number is mm, and 5 of them are rarely meant."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from gcxform.config.quantities import LENGTH
from gcxform.contract.option_kinds import Argument
from gcxform.diagnostics import Diagnostic, Location, Severity

TOLERANCES: Final = ("tolerance", "chord-error", "deviation")
PLAUSIBLE: Final = 0.1  # mm; a tolerance above it that has no unit is asked about


def doubts_of(
    options: Mapping[str, object], where: Callable[[str], Location]
) -> Iterator[Diagnostic]:
    """Yield warnings about tolerances that are large, and written without a unit."""
    for key in TOLERANCES:
        value = options.get(key)
        size = LENGTH.of(f"{value} mm") if isinstance(value, Argument | int | float) else None
        if size is not None and size > PLAUSIBLE:
            message = f"{key} = {value} is {value} mm, which is much for a tolerance"
            hint = f'{key} = "{value} um" if it is {value} um, {key} = "{value} mm" if it is not'
            yield Diagnostic("GX748", message, where(key), hint, severity=Severity.WARNING)
