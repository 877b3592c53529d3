"""Legs of arcs in a turned plane: around the arc, from where it begins to where it ends."""

from __future__ import annotations

import numpy as np
import pytest
from oracles import rs274, toolpaths
from oracles.canon import CanonProgram

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.toolpath.path import Form, Kind

HEAD = "G21 G90 G94 G17 F100\nG10 L2 P1 X1 Y2 R{}\nG0 X0 Y0 Z0\n"
ARCS = {
    "half a circle": "G18 G2 X10 Z0 I5 K0",
    "three quarters": "G18 G3 X5 Z5 I5 K0",
    "two turns and a rise": "G18 G2 X0 Z0 I5 P2 Y3 A20",
    "the other plane": "G19 G3 Y4 Z4 R4",
}


@pytest.mark.parametrize("name", ARCS)
def test_an_arc_is_inside_of_its_legs(name: str) -> None:
    program = f"{HEAD.format(30)}{ARCS[name]}\nM2\n".encode()
    plain = gx.read(program.replace(b"R30", b"R0"), "linuxcnc", start=toolpaths.START).path
    path = gx.read(program, "linuxcnc", start=toolpaths.START).path
    legs = np.flatnonzero(path.form == Form.TILTED)
    assert (path.kind[legs] == Kind.LINE).all()
    assert path.nth[legs].tolist() == list(range(len(legs)))
    first, second = (0, 2) if "G18" in ARCS[name] else (1, 2)
    start, end = path.local(path.start[:, :3]), path.local(path.end[:, :3])
    corner = np.vstack([start[legs], end[legs[-1:]]])
    away = (corner - plain.local(plain.centre)[-1])[:, [first, second]]
    a, b = away[:-1], away[1:]
    t = np.clip(-(a * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0, 1)
    nearest = np.linalg.norm(a + t[:, None] * (b - a), axis=1)
    radius = np.linalg.norm(away[0])
    assert nearest == pytest.approx(radius, abs=1e-9)
    assert end[-1] == pytest.approx(plain.local(plain.end[:, :3])[-1])
    assert path.end[-1, 3:] == pytest.approx(plain.end[-1, 3:])


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_linuxcnc_cuts_them() -> None:
    programs = [f"{HEAD.format(r)}{arc}\nM2\n".encode() for r in (30, -45) for arc in ARCS.values()]
    for program, canon in zip(programs, rs274.run_many(programs), strict=True):
        assert isinstance(canon, CanonProgram), f"{canon}\n{program.decode()}"
        assert toolpaths.difference(toolpaths.read(program), canon) == ""


FLAT = {
    "half a circle": ("G18 G2 X10 Z0 I5 K0", (5.0, 0.0), 0.0),
    "the other way": ("G18 G3 X10 Z0 I5 K0", (5.0, 0.0), 0.0),
    "three quarters, rising": ("G18 G3 X5 Z5 I5 K0 Y3", (5.0, 0.0), 3.0),
}


@pytest.mark.parametrize("name", FLAT)
def test_for_another_control_they_become_lines(name: str) -> None:
    """Turned back by hand, the lines lie on the circle, and go around it as the plain arc does."""
    from gcxform_plugins.passes.offsets import Offsets

    from gcxform.plugin.registry import default_registry

    kinds, (block, centre, rise) = default_registry().dialects, FLAT[name]
    text = f"{HEAD.format(30)}{block}\nM2\n".replace("X1 Y2 R30", "X0 Y0 R30")
    machine = {"work_offsets": {"G54": dict.fromkeys("XYZ", 0.0)}}
    plain = gx.read(text.replace(" R30", "").encode(), "linuxcnc", start=toolpaths.START).path
    pipeline = gx.Pipeline(
        kinds["linuxcnc"],
        kinds["grbl"],
        (Offsets(),),
        Reading(start=toolpaths.START, **machine),
        numbers=gx.NumberFormat(mm=4),
    )
    result = pipeline.run(text.encode())
    assert result.certificate.verified
    path = gx.read(result.text, "grbl", start=dict.fromkeys("XYZ", 0.0)).path
    x, y, z = path.end[path.kind == Kind.LINE].T[:3]
    turn = np.deg2rad(-30.0)
    there = np.column_stack([x * np.cos(turn) - y * np.sin(turn), z])
    aside = x * np.sin(turn) + y * np.cos(turn)
    away = there - centre
    assert np.abs(np.hypot(*away.T) - 5.0).max() < 2e-4
    angle = np.unwrap(np.arctan2(away[:, 1], away[:, 0]))
    swept = abs(angle[-1] - np.pi if angle[0] > 0 else angle[-1] + np.pi)
    assert swept == pytest.approx(plain.sweep[-1], abs=1e-3)
    assert np.abs(aside - rise * np.linspace(0, 1, len(x) + 1)[1:]).max() < 2e-4 + rise * 1e-3
    chord = np.hypot(*np.diff(there, axis=0).T).max()
    assert chord**2 / 8 / 5.0 < 0.0021, "the lines are within 2 um of the arc"
