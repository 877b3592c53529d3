"""What is read fast is bit by bit what is read slowly: a state, a line at a time.

The slow road makes each state of the frame by its constructor, lets lark read each line, and
computes each assignment alone.
"""

from __future__ import annotations

import dataclasses
import random
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
from gcxform.syntax.shapes import ShapeTable
from gcxform.testing.generate import Options
from gcxform.testing.shifts import ShiftingBuilder

COUNT = 100_000 if LONG else 120
CORPUS = Path(__file__).parents[3] / "shared" / "corpus" / "programs"
PROGRAMS = sorted(CORPUS.rglob("*.n*c"))[:: 1 if LONG else 40]
WORKS = ("G54", "G55", "G59.1", "G54")
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
    lines = ["G21 G90 G17 F100", "G0 X0 Y0 Z0"]
    for _ in range(pick.randint(5, 60)):
        act = pick.choice(ACTS) if pick.random() < rare else pick.choice(WORKS)
        given = {key: round(pick.uniform(-9, 9), pick.randint(0, 4)) for key in "ab"}
        lines += [act.format(n=pick.randint(1, 3), **given)] * (pick.random() < 0.6)
        if pick.random() < 0.8:
            words = (f"{axis}{pick.uniform(-9, 9):.3f}" for axis in pick.sample("XYZA", 2))
            lines.append(f"G{pick.choice((0, 1))} {' '.join(words)}")
    return "\n".join([*lines, "M2", ""]).encode()


@shares(COUNT, 60)
def test_short_stretches_are_read_alike(seeds: range) -> None:
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
