"""Wrong passes and a wrong writer under cutter compensation, each caught by the run that has them.

Every fault is tried twice: as it is, and with the check after each pass switched off, so that only
what reads the output again can find it. Faults of the text stand for those of the writer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gcxform as gx
from gcxform.emit.emitter import Emitter
from gcxform.machine.machine import Machine, Tool
from gcxform.plugin.registry import default_registry

Change = Callable[[gx.Toolpath], gx.Toolpath]
TOOLS = {1: Tool(radius=2.0), 2: Tool(radius=2.02), 3: Tool(radius=10.0)}

# Rows: 0 rapid, 1 entry, 2 Y20, 3 X10, 4 arc, 5 X30, 6 Y10, 7 exit, 8 free, 9 probing
PROGRAM = (
    "G21 G90 G17 G94 F200\nG0 X0 Y-10 Z0\nG41 D1 G1 X0 Y0\nY20\nX10\nG2 X20 I5\nG1 X30\nY10\n"
    "G40 X40\nX50\nG38.2 X60\nM2\n"
)
# Rows: 0 rapid, 1 X0 Y0.0004, 2 entry, 3 X60 Y0, 4 back at 5 degrees, 5 exit
NARROW = (
    "G21 G90 G17 G94 F200\nG0 X-10 Y0 Z0\nG1 Y0.0004\nG41 D1 G1 X0\nX60 Y0\nX0 Y5.249\n"
    "G40 X-10 Y15\nM2\n"
)
# A tool of 10 mm, at Y10 above a line that has 1 mm before it
# Rows: 0 rapid, 1 entry, 2 X1, 3 X50, 4 exit
SHORT = "G21 G90 G17 G94 F200\nG0 X0. Y-20. Z0.\nG41 D3 G1 Y0.\nX1.\nX50.\nG40 X70.\nM30\n"
# The tool of 2 mm has 5 um left between two corners
# Rows: 0 rapid, 1 entry, 2 X20, 3 Y4.005, 4 X10, 5 exit
CLOSE = "G21 G90 G17 G94 F200\nG0 X0 Y0 Z0\nG41 D1 G1 X10\nX20\nY4.005\nX10\nG40 X0\nM2\n"


def planted(change: Change) -> gx.Pass:
    """Return a pass that does this to a path, and says that it does nothing."""

    class Planted(gx.Pass):
        """A wrong pass."""

        name = "planted"

        def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
            return change(path) if len(path) else path

    return dataclass(frozen=True)(Planted)()


def run(program: str, dialect: str, change: Change, budget: float | None = None) -> gx.Result:
    kind = default_registry().dialect(dialect)
    machine = Machine(file=Path("mill.toml"), tools=TOOLS)
    numbers = replace(kind.numbers, mm=4, inch=5, feed=3)
    steps = (planted(change),)
    made = gx.Pipeline(kind, kind, steps, machine=machine, numbers=numbers, budget=budget)
    return made.run(program.encode())


def moved(row: int, axis: int, by: float, name: str = "end") -> Change:
    def change(path: gx.Toolpath) -> gx.Toolpath:
        column = np.array(getattr(path, name))
        column[row, axis] += by
        return path.replace(**{name: column})

    return change


def set_to(name: str, row: int, value: float) -> Change:
    def change(path: gx.Toolpath) -> gx.Toolpath:
        column = np.array(getattr(path, name))
        column[row] = value
        return path.replace(**{name: column})

    return change


def cut(row: int, *parts: tuple[float, ...]) -> Change:
    """Return a change by which a row goes by way of points (x, y)."""

    def change(path: gx.Toolpath) -> gx.Toolpath:
        counts = np.ones(len(path), np.int64)
        counts[row] += len(parts)
        which = np.repeat(np.arange(len(path)), counts)
        end, sweep = np.array(path.end[which]), np.array(path.sweep[which])
        end[row : row + len(parts), :2] = parts
        sweep[row : row + len(parts) + 1] /= len(parts) + 1
        nth = np.arange(len(which)) - (np.cumsum(counts) - counts)[which]
        return path.with_rows(counts, end=end, sweep=sweep, nth=nth)

    return change


def without(row: int) -> Change:
    def change(path: gx.Toolpath) -> gx.Toolpath:
        events = tuple(e.at(e.row - (e.row > row)) for e in path.events)
        return path.take(np.arange(len(path)) != row).replace(events=events)

    return change


def on_a_grid(path: gx.Toolpath) -> gx.Toolpath:
    return path.replace(end=np.round(path.end / 0.025) * 0.025 + 0.0, entry=path.entry.copy())


def shifted(path: gx.Toolpath) -> gx.Toolpath:
    """Move the contour and its arcs by 20 um, and nothing else."""
    end, centre = np.array(path.end), np.array(path.centre)
    end[path.side != 0, 0] += 0.02
    centre[path.side != 0, 0] += 0.02
    return path.replace(end=end, centre=centre)


def nearer(path: gx.Toolpath) -> gx.Toolpath:
    return moved(4, 1, -0.006)(moved(3, 1, -0.006)(path))


@dataclass(frozen=True)
class Fault:
    change: Change
    program: str = PROGRAM
    dialect: str = "linuxcnc"
    budget: float | None = None
    code: str = ""


FAULTS = {
    "an arc is cut": Fault(cut(4, (15.0, 25.0))),
    "a line is cut": Fault(cut(3, (5.0, 20.0))),
    "the entry is cut": Fault(cut(1, (0.0, -5.0))),
    "the exit is cut": Fault(cut(7, (35.0, 10.0))),
    "a corner is cut": Fault(cut(2, (0.0, 19.98), (0.02, 20.0))),
    "a contour is moved": Fault(shifted),
    "a contour is on a grid": Fault(on_a_grid, NARROW.replace("249", "257")),
    "a point is moved": Fault(moved(3, 0, 0.02)),
    "the depth of a point is moved": Fault(moved(3, 2, -0.02)),
    "an arc has another centre": Fault(moved(4, 1, 0.02, "centre")),
    "an arc goes the other way": Fault(set_to("kind", 4, 3)),
    "an arc goes round once more": Fault(set_to("sweep", 4, 3 * np.pi)),
    "a cut becomes a rapid": Fault(set_to("kind", 3, 0)),
    "a corner is left out": Fault(without(2)),
    "the entry begins nearer": Fault(moved(0, 1, 8.0)),
    "the entry begins aside": Fault(moved(0, 0, 0.02)),
    "the exit ends aside": Fault(moved(7, 0, 0.02)),
    "the target of a probe is shifted": Fault(moved(9, 0, 0.02)),
    "rounding shows at a narrow corner": Fault(
        moved(2, 1, 0.0005), NARROW, budget=0.003, code="GX351"
    ),
    "rounding shows where the entry ends beside the next move": Fault(
        moved(2, 1, 0.0005), SHORT, "fanuc", budget=0.003, code="GX351"
    ),
    "the tool no longer fits": Fault(nearer, CLOSE, budget=0.01, code="GX351"),
}


@pytest.mark.parametrize("alone", [False, True], ids=["run", "proof alone"])
@pytest.mark.parametrize("name", FAULTS)
def test_a_wrong_pass_is_caught(name: str, alone: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    fault = FAULTS[name]
    if alone:
        monkeypatch.setattr("gcxform.pipeline.run.check_compensated", lambda *_: None)
    assert run(fault.program, fault.dialect, lambda path: path).certificate.verified
    with pytest.raises((gx.VerificationError, gx.InputError)) as error:
        run(fault.program, fault.dialect, fault.change, fault.budget)
    wanted = (fault.code,) if fault.code else ("GX506", "GX601")
    assert error.value.diagnostics[0].code in (wanted if alone else ("GX233", "GX506"))


@pytest.mark.parametrize("window", [1, 20, 40, 80])
def test_a_fault_is_caught_across_windows(window: int, monkeypatch: pytest.MonkeyPatch) -> None:
    def change(path: gx.Toolpath) -> gx.Toolpath:
        here = np.flatnonzero(path.source == 3)
        return moved(int(here[0]), 1, 0.0005)(path) if len(here) else path

    monkeypatch.setattr("gcxform.pipeline.run.check_compensated", lambda *_: None)
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", window)
    assert run(NARROW, "linuxcnc", lambda path: path).certificate.verified
    with pytest.raises(gx.InputError) as error:
        run(NARROW, "linuxcnc", change, budget=0.003)
    assert error.value.diagnostics[0].code == "GX351"


WRITTEN = {
    "the side is swapped": (b"G41", b"G42"),
    "the radius is another": (b"D1", b"D2"),
    "compensation stays on": (b"G40 ", b""),
    "compensation does not begin": (b"G41 D1 ", b""),
    "compensation begins a move later": (b"G41 D1 G1 X0 Y0\nY20", b"G1 X0 Y0\nG41 D1 Y20"),
    "compensation ends a move early": (b"Y10\nG40 X40", b"G40 Y10\nX40"),
    "the plane is another": (b"G17", b"G18"),
    "a point is moved": (b"X30\nY10", b"X30.02\nY10"),
}


@pytest.mark.parametrize("name", WRITTEN)
def test_a_wrong_writer_is_caught(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    old, new = WRITTEN[name]
    emit = Emitter.emit

    def wrong(self: Emitter, *given: Any) -> Any:
        made = emit(self, *given)
        assert old in made.text
        return replace(made, text=made.text.replace(old, new, 1))

    monkeypatch.setattr(Emitter, "emit", wrong)
    with pytest.raises((gx.VerificationError, gx.InputError)):
        run(PROGRAM, "linuxcnc", lambda path: path)
