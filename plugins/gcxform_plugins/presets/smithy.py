"""Mills of Smithy, as their maker's configurations in the samples of LinuxCNC have them.

The files are `configs/by_machine/smithy/*.ini` of LinuxCNC 2.9, `LINEAR_UNITS = inch`. Travels and
speeds hang on the drives, so that each set of drives is a preset. The axis A is an option and not
said here, nor are lathes, and the file for the 516, which calls itself a 622.
"""

from __future__ import annotations

from typing import ClassVar

import gcxform as gx
from gcxform_plugins.presets.inches import axis


class Mill1240(gx.MachinePreset):
    """Smithy 1240: travels and top speeds of X, Y and Z."""

    name = "smithy-1240"
    source = "LinuxCNC 2.9, by_machine/smithy/1240.ini"
    values: ClassVar = {
        "axis": {"X": axis(-21.8, 0.2, 5), "Y": axis(-11.8, 0.2, 5), "Z": axis(-11.8, 0.2, 5)}
    }


class Gecko1240(gx.MachinePreset):
    """Smithy 1240 with Gecko drives: travels and top speeds of X, Y and Z."""

    name = "smithy-1240-gecko"
    source = "LinuxCNC 2.9, by_machine/smithy/1240gecko.ini"
    values: ClassVar = {
        "axis": {"X": axis(-21.8, 0.2, 2), "Y": axis(-10.8, 0.2, 2), "Z": axis(-11.3, 0.2, 1.2)}
    }


class Gecko1034(gx.MachinePreset):
    """Smithy 1034 with Gecko drives: travels and top speeds of X, Y and Z."""

    name = "smithy-1034-gecko"
    source = "LinuxCNC 2.9, by_machine/smithy/1034gecko.ini"
    values: ClassVar = {
        "axis": {"X": axis(-14.7, 0.2, 2), "Y": axis(-7.7, 0.2, 2), "Z": axis(-9, 0.2, 1.2)}
    }


class Mill622(gx.MachinePreset):
    """Smithy 622: travels and top speeds of X, Y and Z."""

    name = "smithy-622"
    source = "LinuxCNC 2.9, by_machine/smithy/622.ini"
    values: ClassVar = {
        "axis": {"X": axis(-11.6, 0.2, 3), "Y": axis(-5.3, 0.2, 3), "Z": axis(-10.2, 0.2, 2)}
    }


class Gecko622(gx.MachinePreset):
    """Smithy 622 with Gecko drives: travels and top speeds of X, Y and Z."""

    name = "smithy-622-gecko"
    source = "LinuxCNC 2.9, by_machine/smithy/622gecko.ini"
    values: ClassVar = {
        "axis": {"X": axis(-10.8, 0.2, 1.5), "Y": axis(-5.05, 0.2, 1.5), "Z": axis(-9.8, 0.2, 0.8)}
    }
