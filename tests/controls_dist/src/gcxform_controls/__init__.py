"""A control that gcxform has not, as a table in a module of its own, written by the guide alone."""

import gcxform as gx
from gcxform_controls.carbide import Carbide


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    return [Carbide]
