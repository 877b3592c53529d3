"""Mills of Tormach, as the sample configurations of LinuxCNC have them (`inches.py`).

The files are `configs/by_machine/tormach/*.ini` of LinuxCNC 2.9, `LINEAR_UNITS = inch`. The axis A
is an option of these mills, and not said here; nor is G28, which each machine has in its variables.
"""

from __future__ import annotations

from typing import ClassVar

import gcxform as gx
from gcxform_plugins.presets.inches import axis


class Pcnc1100(gx.MachinePreset):
    """Tormach PCNC 1100 Series II: travels and top speeds of X, Y and Z."""

    name = "tormach-pcnc-1100-series-ii"
    source = "LinuxCNC 2.9, by_machine/tormach/pcnc-1100-seriesII.ini"
    values: ClassVar = {
        "axis": {"X": axis(0, 18, 1.5), "Y": axis(0, 9.5, 1.5), "Z": axis(-20, 0, 1.083)}
    }


class Pcnc770(gx.MachinePreset):
    """Tormach PCNC 770: travels and top speeds of X, Y and Z."""

    name = "tormach-pcnc-770"
    source = "LinuxCNC 2.9, by_machine/tormach/pcnc-770.ini"
    values: ClassVar = {
        "axis": {"X": axis(0, 14, 2.25), "Y": axis(0, 7.5, 2.25), "Z": axis(-13.25, 0, 1.666)}
    }
