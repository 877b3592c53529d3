"""Passes that change text alone, and what the control takes of their output."""

from __future__ import annotations

import pytest

import gcxform as gx


def test_a_sequence_number_that_the_control_cannot_hold_is_refused() -> None:
    pipeline = gx.Pipeline.parse("renumber start=1 step=1000 last=99999999", "grbl")
    program = b"G21\n" * 10_001
    assert pipeline.run(program[: 4 * 10_000]).text.endswith(b"N9999001G21\n")
    with pytest.raises(gx.InputError, match="GX219"):
        pipeline.run(program)
