"""Stretches of canned cycles mean the same however many of them are read at once.

What is read at once are stretches that G80 ends. In windows of one line there is none of them, and
every call is followed by itself.
"""

from __future__ import annotations

from random import Random

import numpy as np
import pytest
from seeds_kit import some

from gcxform.modal.interpreter import Interpreter
from gcxform.modal.reader import WindowReader
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.toolpath.path import Toolpath

ZERO = dict.fromkeys("XYZ", 0.0)
OFFSETS = {"G54": ZERO, "G55": {"X": 5.0, "Y": -3.0, "Z": 1.0}}
CYCLES = ("G81", "G82 P{p}", "G83 Q{q}", "G73 Q{q}", "G89 P{p}", "G85", "G84", "G84 P{p}")
TAPPING = 2  # the last of them are refused outside G17
BETWEEN = ("G0 X{x}", "G0 X{x} Y{y} Z{z}", "G52 X{x} Y{y}", "G92.1", "G54", "G55")


def filled(random: Random, text: str) -> str:
    """Return a block with numbers."""
    numbers = {letter: random.randint(1, 12) / 2 for letter in "xyqp"}
    return text.format(**numbers, z=random.randint(15, 30), r=random.randint(1, 14))


def stretch(random: Random) -> list[str]:
    """Return the blocks of a stretch of one cycle, and often what ends it."""
    second, deep, plane = random.choice(("Y Z 17", "Y Z 17", "Y Z 17", "Z Y 18")).split()
    cycle = random.choice(CYCLES if plane == "17" else CYCLES[:-TAPPING])
    level = random.choice(("G98", "G99"))
    first = f"{level} X{{x}} {second}{{y}} {cycle} {deep}-3 R{{r}}"
    more = ["X{x}", "X{x} R{r}", "X{x} L2", f"{second}{{y}}"] + ["X{x} P{p}"] * ("P" in cycle)
    blocks = [f"G{plane}", f"G0 {deep}{{z}}", first]
    blocks += random.choices(more, k=random.randint(0, 4))
    if random.random() < 0.2:
        blocks += ["G91", f"X{{x}} {deep}-4 R-2 L3", "G90"]
    if random.random() < 0.8:
        blocks += ["G80", *random.choices(BETWEEN, k=random.randint(0, 2))]
    return [filled(random, block) for block in blocks]


def steps(random: Random) -> list[str]:
    """Return the blocks of a stretch in G91, and what ends it."""
    cycle, level = random.choice(CYCLES), random.choice(("G98", "G99"))
    more = ["X{x}", "X-{x} L2", "Y-{y}", "X{x} Y{y} R-1"]
    blocks = ["G17", "G0 Z{z}", "G91", f"{level} X{{x}} Y{{y}} {cycle} Z-4 R-2 L3"]
    blocks += random.choices(more, k=random.randint(0, 4))
    blocks += random.choice(([], ["G90 X{x} Z-3 R{r}", "X{x}"], ["G90 Y{y} Z-3 R{r}"]))
    blocks += ["G90 G80", "G0 X{x}"]  # which shows the level that is left behind
    return [filled(random, block) for block in blocks]


def program(random: Random) -> str:
    """Return a program of stretches: some end with G80, some run into one another."""
    lines = ["G21 G17 G90 F100 M3 S1", "G0 X0 Y0 Z20"]
    for _ in range(random.randint(3, 9)):
        lines += stretch(random) if random.random() < 0.7 else steps(random)
    return "\n".join([*lines, "G80", "M2"]) + "\n"


def read(windows: list[str]) -> list[Toolpath]:
    """Return the path of each window."""
    kind = default_registry().dialect("linuxcnc")
    reader = WindowReader(kind)
    start = Reading(start=ZERO, work_offsets=OFFSETS)
    interpreter = Interpreter(kind, start)
    paths = []
    for text in windows:
        window = reader.read(text.encode())
        paths.append(interpreter.interpret(window, reader.table).path)
    return paths


def told(paths: list[Toolpath]) -> tuple[np.ndarray, list[tuple[object, ...]]]:
    """Return rows as numbers, and events with the row they stand before."""
    rows, events, count = [], [], 0
    for path in paths:
        columns = (path.kind, path.form, path.nth, path.source, path.lost, path.feed)
        rows.append(np.column_stack([path.end, *columns]))
        events += [(e.row + count, e.what, e.values, e.line, e.within) for e in path.events]
        count += len(path)
    return np.vstack(rows), events


@pytest.mark.parametrize("seed", some(60))
def test_stretches_read_together_are_those_read_one_by_one(seed: int) -> None:
    text = program(Random(seed))
    whole, events = told(read([text]))
    lines, same_events = told(read(text.splitlines(keepends=True)))
    assert len(whole) > 10
    np.testing.assert_array_equal(whole, lines)
    assert events == same_events
