"""What stands behind a slash within a block goes with the switch of the control, and no more."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.modal.events import SWITCHED

PROGRAM = b"O1\nG21 G90 G94\nG0 X0. Y0. Z5. /M8\nX5. M1 /2M9\nM30\n"


@pytest.mark.parametrize(
    ("switch", "behind"),
    [("skip", []), ("execute", ["M8", "M9"]), ("", [f"{SWITCHED}M8", f"{SWITCHED}M9"])],
)
def test_the_switch_decides_on_what_is_behind_a_slash(switch: str, behind: list[str]):
    path = gx.read(PROGRAM, "fanuc", **({"block_delete": switch} if switch else {})).path
    done = [event.what for event in path.events]
    assert [what for what in done if what not in ("M1", "M30")] == behind
    assert "M1" in done
    assert path.end[-1, 0] == 5.0
