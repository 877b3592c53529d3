"""What is read fast is bit by bit what is read slowly: a state, a line at a time.

The slow road makes each state of the frame by its constructor, lets lark read each line, computes
each assignment alone, and reads each stretch that begins with an act on the frame by itself.
"""

from __future__ import annotations

import dataclasses
import random
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.toolpaths import HOMES, OFFSETS, OWN_TOOLS, START
from seeds_kit import LONG, shares

import gcxform as gx
from gcxform.modal import frame_state, reader
from gcxform.modal.expressions.assignments import _Run
from gcxform.modal.frames import tool_lengths, transforms, work_offsets
from gcxform.modal.meaning.tables import MeaningTable
from gcxform.modal.moves import passages
from gcxform.syntax.shapes import ShapeTable
from gcxform.testing.generate import Options
from gcxform.testing.shifts import ShiftingBuilder

COUNT = 100_000 if LONG else 120
CORPUS = Path(__file__).parents[3] / "shared" / "corpus" / "programs"
PROGRAMS = sorted(CORPUS.rglob("*.n*c"))[:: 1 if LONG else 40]
WORKS = ("G54", "G55", "G59.1", "G54")
RETURNS = (
    *(*WORKS, "G53 G0 Z{a}", "G53 G0 X-0 Z0", "G28 X{a} Z{b}", "G28 Y{a}", "G30 X{a} Y{b} Z0"),
    *("T{n} M6", "M6", "G43.1 Z{a}", "G43.1 X{a} Z-0", "G43.1", "G55 G1 X{a} Y-0", "G53 G1 Y{b}"),
)
"""Acts that hang on their own words alone: runs of them are read at once."""
ACTS = (
    *("G53 G0 Z{a}", "G28", "G28 X{a} Z{b}", "G30 Y{a}", "T{n} M6", "G43.1 Z{a}", "G43 H{n}"),
    *("G49", "G92 X{a}", "G92.1", "G92.2", "G92.3", "G10 L2 P{n} X{a} Y{b}", "G52 X{a}", "G52 X0"),
    *("G68 R30", "G69", "G16", "G15", "G20", "G21", "G91", "G90", "G7", "G8", "M2"),
    *("G10 L20 P{n} X{a}", "G38.2 Z{a} F50", "G98 G81 X{a} Y{b} Z-3 R1", "G80", "G59.3"),
)
"""What a stretch may begin with; most are drawn seldom, that programs are read to their ends."""


@contextmanager
def slowly() -> Iterator[None]:
    """Read on the slow road."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (frame_state, work_offsets, transforms, tool_lengths):
            patch.setattr(module, "replace", dataclasses.replace)
        patch.setattr(_Run, "_straight", lambda _: False)
        patch.setattr(reader, "new_table", by_lark)
        patch.setattr(passages, "FEW", sys.maxsize)
        yield


def by_lark(dialect: type[gx.Dialect]) -> MeaningTable:
    """Return a table of shapes in which no line has the outline of another."""
    return MeaningTable(ShapeTable(dialect.load_grammar()), dialect)


def found(text: bytes, name: str, **given: Any) -> object:
    """Return all that a program is read as, bit by bit; or what is said against it."""
    try:
        path = gx.read(text, name, **given).path
    except gx.GcxformError as error:
        return [str(each) for each in error.diagnostics]
    values = {each.name: getattr(path, each.name) for each in dataclasses.fields(path)}
    return {name: bits(value) for name, value in values.items()}


def bits(value: Any) -> object:
    """Return a value so that two are equal only if all their bits are."""
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if dataclasses.is_dataclass(value):
        return [bits(getattr(value, each.name)) for each in dataclasses.fields(value)]
    if isinstance(value, tuple):
        return [bits(each) for each in value]
    return repr(value)


def program(seed: int) -> bytes:
    """Return a program of short stretches, of a few works over and over."""
    pick = random.Random(seed)
    rare = 0.02 + 0.3 * (seed % 3 == 0)
    usual = RETURNS if seed % 4 in (1, 2) else WORKS
    lines = ["G21 G90 G17 F100", "G0 X0 Y0 Z0"]
    for _ in range(pick.randint(5, 60)):
        act = pick.choice(ACTS) if pick.random() < rare else pick.choice(usual)
        given = {key: round(pick.uniform(-9, 9), pick.randint(0, 4)) for key in "ab"}
        lines += [act.format(n=pick.randint(1, 3), **given)] * (pick.random() < 0.6)
        if pick.random() < 0.8:
            words = (f"{axis}{pick.uniform(-9, 9):.3f}" for axis in pick.sample("XYZA", 2))
            lines.append(f"G{pick.choice((0, 1))} {' '.join(words)}")
    return "\n".join([*lines, "M2", ""]).encode()


@shares(COUNT, 60)
def test_short_stretches_are_read_alike(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(passages, "FEW", 1)
    told: dict[str, Any] = {"start": START, "homes": HOMES, "tools": OWN_TOOLS}
    moved = 0
    for seed in seeds:
        places = {name: {"X": 5.0 * k, "Z": -0.0} for k, name in enumerate(OFFSETS)}
        given = {**told, "work_offsets": places if seed % 2 else OFFSETS}
        if seed % 5 == 0:
            text = ShiftingBuilder(random.Random(seed).randint, Options(max_blocks=30)).build()
        else:
            text = program(seed)
        fast = found(text, "linuxcnc", **given)
        with slowly():
            assert found(text, "linuxcnc", **given) == fast, text.decode("latin-1")
        moved += isinstance(fast, dict)
    assert moved > len(seeds) // 3


ENDING = {
    "steps": "G55 G1 X5 Y-0;G91 G1 X2;G54;G1 X1 Y1;G90 G1 X9",
    "a turn": "G10 L2 P2 R30;G55;G1 X5;G28 X1 Y1;G54;G1 X2 Y3",
    "a zero that is not known": "G1 X5;G56;G1 X1;G55;G1 X2;G54;G1 X1 Y1",
    "a place that counts from such a zero": "G56 G1 X1 Y1 Z1;G91 G1 X1;G90;G28 X5;G1 X3;G53 G0 X1",
    "a home that is not known": "G1 X5;G30.1;G30 A5;G1 X1 A2;G28 X1;G1 X2",
    "diameters": "G55 G1 X5;G7;G54;G1 X1 Y1;G53 G0 X1;G8;G55",
    "a cycle": "G55 G1 X5;G98 G81 X1 Y1 Z-3 R1;G54;X2;G53 G0 Z0;G80;G55 G1 X1",
    "a length of a tool that is not known": "G43 H9;G1 Z1;G55;G1 Z2;G43.1 Z3;G1 Z3;G54;G1 Z1",
    "a length of -0": "G43.1 Z0;G1 Z1;G43.1 Z3;G1 Z1;G43.1 Z-0;G1 Z2;G54;G1 X1",
    "a value that only the machine knows": "#1=#5061;G55 G1 X#1;G54;G53 G0 Y1;G1 Y2;G55;G1 X1",
    "a place at which the tool is not": "#1=#5061;G53 G0 X#1;G1 Y1;G54;G28 X#1;G1 Y5;G55",
}


@pytest.mark.parametrize("blocks", ENDING.values(), ids=ENDING)
def test_a_run_of_stretches_ends_where_more_counts_than_words(
    blocks: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(passages, "FEW", 1)
    text = "\n".join(("G21 G90 G17 F100", "G54 G0 X0 Y0 Z0", *blocks.split(";"), "M2", "")).encode()
    places = {"G54": {"X": 1.0}, "G55": {"X": 5.0, "Z": -0.25}}
    fast = found(text, "linuxcnc", start=START, homes=HOMES, work_offsets=places)
    assert isinstance(fast, dict)
    with slowly():
        assert found(text, "linuxcnc", start=START, homes=HOMES, work_offsets=places) == fast


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus beside the checkout is missing")
@pytest.mark.parametrize("file", PROGRAMS, ids=lambda file: file.name)
def test_real_programs_are_read_alike(file: Path) -> None:
    family = file.relative_to(CORPUS).parts[0]
    name = family if family in ("fanuc", "haas", "grbl", "linuxcnc") else "linuxcnc"
    text = file.read_bytes()[:200_000]
    fast = found(text, name)
    with slowly():
        assert found(text, name) == fast


def test_a_frame_that_is_kept_is_the_one_that_would_be_made() -> None:
    """Fields by which the frame of a work offset is told, each changed by itself."""
    other: dict[str, Any] = {
        "zeros": {"G54": (1.0, 2.0, 3.0)},
        "tool": (0.0, 0.0, 7.0),
        "preset": (0.5, 0.0, 0.0),
        "local": (0.0, 0.25, 0.0),
        "rotation": {"G54": 30.0},
        "adrift": {0: 1},
        "diameter": True,
        "polar": True,
        "following": True,
        "tip": " at the tip (1)",
        "tilt": " in G68.2 (1)",
        "work": "G55",
        "first": "G56",
    }
    state = frame_state.FrameState.at_start("XYZ", "G54", True, {"G54": {}, "G55": {"X": 9}}, {})
    for name, value in other.items():
        before = state.frame()
        changed = frame_state.replace(state, **{name: value})
        plainly = dataclasses.replace(state, **{name: value})
        assert repr(changed) == repr(plainly)
        assert changed.frame() == plainly.frame() != before, name
