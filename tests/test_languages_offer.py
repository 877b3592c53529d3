"""What a language has no words for is refused with the pass that says it in others."""

from __future__ import annotations

import pytest

import gcxform as gx
from gcxform.catalogue.remedies import offers
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

LANGUAGES = ("siemens", "heidenhain", "fagor")
KNOWN = Reading(
    start={"X": 0.0, "Y": 0.0, "Z": 300.0},
    tools={1: Tool(length=100.0, radius=3.0), 21: Tool(radius=4.0)},
    control={"tool-length-axis": "Z"},
)
HEAD = "G21 G90 G94 G17 G54\nT1 M6\nS1000 M3\nG0 X-10. Y0.\n"
CONTOUR = "G41{} G1 X0. F100.\nX20.\nG40 X30.\n"


def offered(source: str, target: str, blocks: str) -> tuple[str, ...]:
    """Return the passes that the hint of a refusal offers."""
    here, there = map(default_registry().dialect, (source, target))
    made = Pipeline(here, there, (), KNOWN, inert=frozenset({"M6"}))
    with pytest.raises(gx.GcxformError) as refused:
        made.run(f"{HEAD}{blocks}M30\n".encode())
    (first, *_) = refused.value.diagnostics
    assert first.code == "GX501"
    return tuple(getattr(offer, "name", "") for offer in offers(first.hint))


@pytest.mark.parametrize("target", LANGUAGES)
def test_the_radius_of_another_tool(target: str) -> None:
    blocks = "G43 H1 Z5.\n" + CONTOUR.format(" D21")
    assert offered("fanuc", target, blocks) == ("cutter-comp",)


@pytest.mark.parametrize("target", ["siemens", "fagor"])
def test_a_radius_without_a_length(target: str) -> None:
    assert offered("linuxcnc", target, "G49\nZ5.\n" + CONTOUR.format("")) == ("cutter-comp",)


@pytest.mark.parametrize(
    ("blocks", "name"),
    [
        ("G18 G3 X10. Y3. I10. K0. F100.\n", "segment"),
        ("G55 G0 X0. Y0. Z5.\n", "offsets"),
    ],
)
def test_what_klartext_lacks(blocks: str, name: str) -> None:
    assert offered("linuxcnc", "heidenhain", f"G43 H1 Z5.\n{blocks}") == (name,)
