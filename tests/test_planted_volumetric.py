"""Wrong compensations, planted on purpose: the proof of the run has to see each of them.

Nothing here looks at what a fault does: a run with it has to end in a failed verification, and the
same run without it in a proof. Programs hold what is left to the machine (G53, G28, the start).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from gcxform_plugins.dialects.linuxcnc import LinuxCNC
from gcxform_plugins.passes.volumetric.forward import compensation
from gcxform_plugins.passes.volumetric.volumetric import Volumetric

import gcxform as gx
from gcxform.contract.options import ModelFile
from gcxform.diagnostics import InputError, VerificationError
from gcxform.emit.emitter import Emitter
from gcxform.errormodel.functions import AxisFunction, AxisFunctions
from gcxform.machine.machine import Machine
from gcxform.modal.state import Reading
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.run import Output, Run
from gcxform.syntax.source import Source

NODES = np.array([-500.0, -100.0, 0.0, 40.0, 100.0, 500.0])
MACHINE = Machine(
    file="machine.toml",
    work_offsets={
        "G54": {"X": 0.0, "Y": 0.0, "Z": 0.0},
        "G55": {"X": 60.0, "Y": -20.0, "Z": 5.0},
    },
    homes={"G28": {"X": 0.0, "Y": 0.0, "Z": 120.0}},
)
START = {"X": 3.0, "Y": 4.0, "Z": 60.0}
PROGRAM = """G21 G17 G90 G94
G53 G0 Z100
G0 X0 Y0
Z50
G1 X90 Y30 F200
G53 G0 Z110 X20
G0 X50 Y50 Z5
G1 Z-5
G2 X70 Y50 I10 J0
G28 Z20
G0 X10 Y10 Z10
G1 Z0
G0 Z30
G55
G0 X0 Y0 Z0
G1 X-90 Y40
M2
"""
FROM_START = "G21 G17 G90 G94\nG1 X60 Y20 F100\nM2\n"
FROM_G53 = "G21 G17 G90 G94\nG0 X0 Y0 Z0\nG53 G0 X50 Z-20\nG1 X10 F100\nM2\n"
FROM_HOME = "G21 G17 G90 G94\nG0 X50 Y10 Z0\nG28 X50 Z5\nG1 X50 F100\nM2\n"
INTO_G53 = "G21 G17 G90 G94\nG0 X0 Y0 Z0\nG53 G1 X50 F100\nM2\n"


LENGTHENED = "G21 G17 G90 G94\nG0 X0 Y0 Z0\nG43.1 Z20\n"


def model() -> AxisFunctions:
    """Return errors up to 60 um that depend on every axis."""
    random = np.random.default_rng(11)
    axes = [AxisFunction(NODES, random.uniform(-0.02, 0.02, (len(NODES), 3))) for _ in range(3)]
    return AxisFunctions(tuple(axes))


MODEL = ModelFile(Path("model.toml"), model(), "")


def run(step: gx.Pass, program: str) -> Certificate:
    """Return the certificate of a run from a start that is known."""
    reading = Reading(start=START)
    chain = gx.Pipeline(LinuxCNC, LinuxCNC, (step,), machine=MACHINE, reading=reading)
    return chain.run(program.encode()).certificate


def without_checks(patch) -> None:
    patch.setattr(compensation.Compensation, "_check_begins", lambda self, commands: None)


def changed(change):
    """Return a pass whose paths are changed after it has done its work."""

    @dataclass(frozen=True)
    class Changed(Volumetric):
        def apply(self, path, context):
            return change(super().apply(path, context), path)

    return Changed(model=MODEL)


def rows(path, which):
    """Return a path that is 50 um off at the ends of some rows."""
    end = path.end.copy(order="F")
    end[which, 0] += 0.05
    return path.replace(end=end)


def forward(**options) -> gx.Pass:
    """Return a pass whose way forward is that of a pass with other options, and its proof its own.

    So a mistake in one option of the work is a fault of the whole.
    """
    other = Volumetric(**{"model": MODEL, **options})

    @dataclass(frozen=True)
    class Wrong(Volumetric):
        def apply(self, path, context):
            return other.apply(path, context)

    return Wrong(model=MODEL)


def unlike(factor: float) -> ModelFile:
    """Return the model with its errors multiplied."""
    axes = [replace(axis, values=axis.values * factor) for axis in model().axes]
    return replace(MODEL, model=AxisFunctions(tuple(axes)))


def test_the_right_pass_is_proved_and_says_what_it_left():
    certificate = run(Volumetric(model=MODEL), PROGRAM)
    assert certificate.verified
    left = [line for line in certificate.not_checked if "points of the machine" in line]
    assert len(left) == 1
    assert left[0].endswith(": 4")  # G53 twice, G28 over its point and home
    assert 0.001 < float(left[0].split("up to ")[1].split(" mm")[0]) < 0.1


@pytest.mark.parametrize("program", [FROM_START, FROM_G53, FROM_HOME, INTO_G53])
def test_feed_moves_from_and_to_what_is_left_are_refused(program):
    with pytest.raises(InputError, match="GX317"):
        run(Volumetric(model=MODEL), program)


@pytest.mark.parametrize("program", [FROM_START, FROM_G53, FROM_HOME])
def test_without_that_refusal_the_proof_sees_it(program, monkeypatch):
    without_checks(monkeypatch)
    with pytest.raises(VerificationError, match="off, the budget"):
        run(Volumetric(model=MODEL), program)


@pytest.mark.parametrize("cut", ["G1 X50 F100", "F100 G2 X10 I5"])
def test_a_jump_in_the_tables_is_seen_by_the_proof_alone(cut, monkeypatch):
    """The tip is in the tables: behind another length it is elsewhere, and nothing has moved."""
    step, program = Volumetric(model=MODEL, part_origin=(0.0, 0.0, 0.0)), f"{LENGTHENED}{cut}\nM2\n"
    with pytest.raises(InputError, match="GX317"):
        run(step, program)
    without_checks(monkeypatch)
    with pytest.raises(VerificationError, match="off, the budget"):
        run(step, program)


LAST = 15  # line, from 0, of the last of the moves that cut

FAULTS = {
    "rapids are off": lambda: changed(
        lambda after, _: rows(after, (after.kind == 0) & (after.form == 0))
    ),
    "a cut is off": lambda: changed(
        lambda after, _: rows(after, (after.kind == 1) & (after.source == LAST))
    ),
    "nothing is compensated": lambda: changed(lambda _, before: before),
    "rapids are not compensated": lambda: forward(rapids="skip"),
    "lines are not cut": lambda: forward(split="none"),
    "arcs keep their centres": lambda: forward(arc_centres="nominal", split="none"),
    "the correction has the wrong sign": lambda: forward(model=unlike(-1.0)),
    "half of the correction": lambda: forward(model=unlike(0.5)),
    "a tenth too much": lambda: forward(model=unlike(1.1)),
    "the origin of the table is another": lambda: forward(table_origin=(9.0, 0.0, 0.0)),
    "a tolerance twenty times as large": lambda: forward(tolerance=0.02),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_way_forward_is_seen(fault):
    with pytest.raises(VerificationError, match="GX601"):
        run(FAULTS[fault](), PROGRAM)


@pytest.mark.parametrize(
    ("wrote", "writes"),
    [
        ("G53 G0 Z100", "G53 G0 Z100.05"),
        ("G53 G0 Z110 X20", "G53 G0 Z110 X20.05"),
        ("G53 G0 Z110 X20", "G53 G0 Z110"),
        ("G53 G0 Z110 X20", "G53 G0 Z110 X20 Y0"),
        ("G28 Z20", "G28 Z20.05"),
        ("G28 Z20", "G28 X20"),
        ("G28 Z20", "G53 G0 Z119.95"),
    ],
)
def test_what_is_left_to_the_machine_has_to_be_told_as_the_program_says(wrote, writes, monkeypatch):
    emit = Emitter.emit

    def emitted(*given):
        made = emit(*given)
        assert wrote.encode() in made.text
        return replace(made, text=made.text.replace(wrote.encode(), writes.encode()))

    monkeypatch.setattr(Emitter, "emit", emitted)
    with pytest.raises(VerificationError, match="GX601"):
        run(Volumetric(model=MODEL), PROGRAM)


def test_windows_know_where_the_axes_were_left():
    """A program in windows of a line or two is written as in one: `held` goes along."""
    reading = Reading(start=START)
    steps = (Volumetric(model=MODEL),)
    chain = gx.Pipeline(LinuxCNC, LinuxCNC, steps, machine=MACHINE, reading=reading)
    parts: list[bytes] = []
    run = Run(chain, Source.of_bytes(PROGRAM.encode()), "on")
    run.over(Output(parts.append, None), lambda size: None, 12)
    assert b"".join(parts) == chain.run(PROGRAM.encode()).text
    small = Run(chain, Source.of_bytes(FROM_G53.encode()), "on")
    with pytest.raises(InputError, match="GX317"):
        small.over(Output(parts.append, None), lambda size: None, 12)
