"""Programs in Klartext for the tests of `heidenhain`."""

from __future__ import annotations

import gcxform as gx
from gcxform.contract.tip_codes import with_switches
from gcxform.machine.machine import Tool
from gcxform.plugin.registry import default_registry

DIALECT = default_registry().dialect("heidenhain")
SWITCHED = with_switches(DIALECT, {})
TOOLS = {n: Tool(length=10.0 * n, radius=1.0) for n in range(1, 9)}


def read(text, **reading):
    """Return the path, with the codes that follow the tip understood."""
    return gx.read(text.encode("latin-1"), SWITCHED, **reading).path


def program(*lines, unit="MM"):
    return "".join(f"{line}\n" for line in (f"BEGIN PGM A {unit}", *lines, f"END PGM A {unit}"))
