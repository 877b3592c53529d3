"""Zeros that programs set from where the axes stand, behind moves that were compensated.

LinuxCNC's interpreter runs the program and what was written for it: the model takes each end of the
second to the one of the first, and what both leave in G92 and in the work offsets is the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from gcxform_plugins.dialects.linuxcnc import LinuxCNC
from gcxform_plugins.passes.volumetric.volumetric import Volumetric
from oracles import rs274
from test_planted_volumetric import MODEL, NODES

import gcxform as gx
from gcxform.emit.emitter import Emitter
from gcxform.emit.presets import Presets
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading

ZEROS = {
    "G54": (6.35, -3.175, 12.7),
    "G55": (-19.05, 15.875, 4.445),
}  # mm, and few decimals in inches
OFFSETS = {work: dict(zip("XYZ", zero, strict=True)) for work, zero in ZEROS.items()}
MACHINE = Machine(file="machine.toml", work_offsets=OFFSETS)
BEGIN = "G21 G90 G94 G17 G54 G92.1\nG0 X1 Y2 Z3\n"
TABLE = "".join(
    f"G10 L2 P{n} X{x} Y{y} Z{z}\n" for n, (x, y, z) in enumerate(ZEROS.values(), start=1)
)
LEFT = ",".join(f"#{n}" for n in (5211, 5212, 5213, 5221, 5222, 5223, 5241, 5242, 5243))
NEAR = 1.6e-3  # mm: a cut may leave 1 um, and four decimals are written and printed, in inches too
CHAIN = gx.Pipeline(
    LinuxCNC,
    LinuxCNC,
    (Volumetric(model=MODEL, outside=gx.Outside.CLAMP),),
    machine=MACHINE,
    reading=Reading(start={"X": 0.0, "Y": 0.0, "Z": 0.0}),
)


def drawn(seed: int) -> str:
    """Return a program of moves and of blocks that set zeros, also in inches and diameters."""
    random = np.random.default_rng(seed)
    lines = list(_lines(random, bool(seed % 3 == 0)))
    begin = BEGIN.replace("G21", "G20") if seed % 4 == 1 else BEGIN
    return begin + "\n".join(lines) + "\nM2\n"


def _lines(random: np.random.Generator, diameters: bool) -> Iterator[str]:
    if diameters:
        yield "G7"
    for _ in range(14):
        axes = random.choice(["X", "Y", "Z", "XY", "YZ", "XYZ"])
        words = " ".join(f"{a}{random.integers(-30, 30) / 10}" for a in axes)
        kind = random.choice(["G92", "G10 L20 P1", "G10 L20 P2", "G10 L20 P0", "G52", "G0", "G1"])
        yield {"G0": f"G0 {words}", "G1": f"G1 {words} F100"}.get(kind, f"{kind} {words}")
        yield str(random.choice([f"G0 {words}", f"G1 F90 {words}", "G55", "G54", "G92.2", "G92.3"]))
        yield f"G0 X{random.integers(-9, 9)} Y{random.integers(-9, 9)}"
    yield f"G91 G1 F50 {words}\nG90 G0 Z1"


def ends(canon: rs274.CanonProgram) -> np.ndarray:
    """Return the ends (n, 3) of moves in the machine, mm."""
    return np.array([[move.machine[1][axis] for axis in "XYZ"] for move in canon.moves])


def left(program: bytes) -> bytes:
    """Return a program that says what it leaves in the control."""
    return TABLE.encode() + program.replace(b"\nM2\n", f"\nG21\n(DEBUG,{LEFT})\nM2\n".encode())


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
def test_linuxcnc_sets_the_zeros_of_the_source() -> None:
    sources = [drawn(seed).encode() for seed in range(10)]
    results = [CHAIN.run(source).text for source in sources]
    canons = rs274.run_many(
        left(each) for pair in zip(sources, results, strict=True) for each in pair
    )
    changed = 0
    for before, after, source, text in zip(
        canons[::2], canons[1::2], sources, results, strict=True
    ):
        assert isinstance(before, rs274.CanonProgram), f"{before}\n{source.decode()}"
        assert isinstance(after, rs274.CanonProgram), f"{after}\n{text.decode()}"
        assert [t for _, t in before.told] == [t for _, t in after.told], text.decode()
        commands = ends(after)
        goes = iter(commands + MODEL.model.error(np.clip(commands, NODES[0], NODES[-1])))
        for end in ends(before):  # others are where moves are cut
            assert any(np.abs(place - end).max() < NEAR for place in goes), text.decode()
        words = [line for line in source.splitlines() if line.startswith((b"G92 ", b"G10 "))]
        changed += sum(word not in text.splitlines() for word in words)
    assert changed > 30


@pytest.mark.parametrize(
    ("block", "zero"), [("G92 X5", "the zero of G92"), ("G10 L20 P2 X5", "the zero of G55")]
)
def test_a_zero_that_is_off_by_less_than_the_budget_is_seen(block, zero, monkeypatch) -> None:
    program = f"{BEGIN}{block}\nG0 X20\nM2\n"
    assert CHAIN.run(program.encode()).certificate.verified
    written = Presets._written
    monkeypatch.setattr(Presets, "_written", lambda *given: written(*given) + 1e-4)
    with pytest.raises(gx.GcxformError, match=rf"{zero} would be elsewhere"):
        CHAIN.run(program.encode())


def test_another_zero_than_that_of_the_source_is_seen(monkeypatch) -> None:
    """The words of axes may be others in the event; which work offset is set may not."""
    emit = Emitter.emit

    def other(*given: Any) -> Any:
        emitted = emit(*given)
        return replace(emitted, text=emitted.text.replace(b"P2", b"P3"))

    monkeypatch.setattr(Emitter, "emit", other)
    with pytest.raises(gx.GcxformError, match="G10 of the source became G10"):
        CHAIN.run(f"{BEGIN}G10 L20 P2 X5\nG0 X20\nM2\n".encode())


def test_what_has_more_decimals_than_are_written_is_refused() -> None:
    program = BEGIN + "G92 X5.00005\nG0 X20\nM2\n"
    with pytest.raises(gx.GcxformError, match=r"more decimals than are written"):
        CHAIN.run(program.encode())
    assert replace(CHAIN, numbers=gx.NumberFormat(mm=5)).run(program.encode()).certificate.verified
