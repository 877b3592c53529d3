"""Every diagnostic code with its explanation: what `gcxform explain GX301` prints.

Codes are never reused. The hundreds say where a thing was found: 1 text, 2 meaning, 3 geometry,
4 machine and error-model files, 5 emission, 6 verification, 7 command line and pipeline,
8 plugins, 9 files.
"""

from __future__ import annotations

from gcxform.catalogue import flow, geometry, machines, reading, usage, writing

PARTS = (reading, flow, geometry, machines, writing, usage)
CATALOGUE: dict[str, tuple[str, str]] = dict(
    sorted(entry for part in PARTS for entry in part.CODES.items())
)
