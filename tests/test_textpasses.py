"""Passes that change text alone, and what the control takes of their output."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pytest
from gcxform_plugins.dialects.fanuc import Fanuc

import gcxform as gx


def test_a_sequence_number_that_the_control_cannot_hold_is_refused() -> None:
    pipeline = gx.Pipeline.parse("renumber start=1 step=1000 last=99999999", "grbl")
    program = b"G21\n" * 10_001
    assert pipeline.run(program[: 4 * 10_000]).text.endswith(b"N9999001G21\n")
    with pytest.raises(gx.InputError, match="GX219"):
        pipeline.run(program)


@dataclass(frozen=True)
class Shifted(gx.TextPass):
    """Gives every line another number, and says so to no jump."""

    name = "shifted"

    def asks(self, block: gx.Block) -> bool:
        return True

    def rewritten(self, blocks: Sequence[gx.Block], dialect: type[gx.Dialect]) -> list[str]:
        return [block.text.replace("N10", "N11") for block in blocks]


JUMPS = b"O1\nN10 G21\nIF[#500EQ1]GOTO 10\nM30\n"


@pytest.mark.parametrize(
    ("program", "passes"),
    [(JUMPS, False), (JUMPS.replace(b"GOTO 10", b"GOTO 11"), False), (b"N10 G21\nM30\n", True)],
)
def test_a_jump_that_would_lead_elsewhere_is_found(program: bytes, passes: bool) -> None:
    pipeline = gx.Pipeline(Fanuc, Fanuc, (Shifted(),))
    if passes:
        assert pipeline.run(program).text == b"N11 G21\nM30\n"
        return
    with pytest.raises(gx.VerificationError, match="GX603"):
        pipeline.run(program)
