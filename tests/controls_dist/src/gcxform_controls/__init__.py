"""Controls as tables in a distribution of their own, written by the guide alone."""

import gcxform as gx
from gcxform_controls.carbide import Carbide
from gcxform_controls.mach import Mach
from gcxform_controls.osp import Osp


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    return [Carbide, Mach, Osp]
