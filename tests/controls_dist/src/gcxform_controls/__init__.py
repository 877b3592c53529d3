"""More controls, each a table in a module of its own, written by the guide for dialects alone."""

import gcxform as gx
from gcxform_controls.fanuc_like import Brother, Mazak, Mitsubishi
from gcxform_controls.mach3 import Mach3
from gcxform_controls.okuma import Okuma


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    return [Okuma, Mach3, Mazak, Mitsubishi, Brother]
