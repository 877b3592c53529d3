"""What the tests of stamps share: error models, machines, chains that write stamps."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import Any

import gcxform as gx

MODEL = """format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
order = "XYZ"
[X]
position = [-1000.0, 0.0, 1000.0]
EXX = [-0.1, 0.0, 0.2]
EYX = [0.0, 0.0, 0.0]
EZX = [0.0, 0.0, 0.0]
"""
MACHINE = """format = 1
kinematics = "ac-trunnion"
[axis.A]
point = [{a}, 0.0, -50.0]
[axis.C]
point = [0.0, 0.0, 0.0]
[tool.1]
length = 100.0
[axis.X]
[axis.Y]
[axis.Z]
[work-offset.G54]
X = 0.0
Y = 0.0
Z = 0.0
A = 0.0
C = 0.0
"""
VOLUMETRIC = "volumetric model=model.toml part-origin=0,0,0 tolerance=5um"
INVERSE = "volumetric model=model.toml part-origin=0,0,0 inverse=true tolerance=5um"
PLATE = b"%\nO1000 (PLATE)\nG21 G90 G17 G94\nG0 X0. Y0. Z5.\nG1 X100. F500.\nY50.\nM30\n%\n"
TIPS = (
    b"%\nG21 G90 G17 G94 G54\nT1 M6\nG43 H1\nG0 X0. Y0. Z50. A0. C0.\n"
    b"G1 X20. A10. C20. F500\nG1 X0. A0. C0.\nM30\n%\n"
)
LINE = re.compile(rb"[(;]GCXFORM (STAMP|SEAL) [0-9A-F]{12}[^\r\n]*(?:\r\n|\n|\r|$)")


def workplace(folder: Path) -> Path:
    """Put the models and machines into a folder."""
    (folder / "model.toml").write_text(MODEL)
    (folder / "set.toml").write_text(MACHINE.format(a="0.0"))
    (folder / "found.toml").write_text(MACHINE.format(a="0.05"))
    return folder


def pipeline(chain: str, folder: Path, dialect: str = "linuxcnc", **changes: Any) -> gx.Pipeline:
    """Return the pipeline of a chain; `machine` names a file of the folder."""
    from gcxform.pipeline.chain_text import parse_chain
    from gcxform.pipeline.file import OutputSpec, PipelineSpec
    from gcxform.plugin.registry import default_registry

    registry = default_registry()
    machine = changes.pop("machine", None)
    to = changes.pop("to", "")
    steps = tuple(parse_chain(chain, folder, registry))
    spec = PipelineSpec(passes=steps, output=OutputSpec())
    file = folder / machine if machine else None
    made = gx.Pipeline.of_spec(spec, registry, dialect, to, file)
    import dataclasses

    return dataclasses.replace(made, **changes)


def bare(text: bytes) -> bytes:
    """Return a text without the lines of stamps, found by other means than the package's."""
    return LINE.sub(b"", text)


def seal_of(text: bytes) -> str:
    """Return the seal that a text should have: SHA-256 of its lines but the seal, without CR."""
    lines = re.split(rb"(?<=\n)", text.replace(b"\r", b""))
    rest = b"".join(line for line in lines if b"GCXFORM SEAL" not in line)
    return hashlib.sha256(rest).hexdigest()[:12].upper()


def code(pipe: gx.Pipeline, text: bytes) -> str:
    """Return the code with which a pipeline refuses a program; empty if it does not."""
    try:
        pipe.run(text)
    except gx.InputError as error:
        return error.diagnostics[0].code
    return ""
