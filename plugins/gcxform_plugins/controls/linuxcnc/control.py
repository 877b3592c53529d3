"""The files of LinuxCNC that are read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import gcxform as gx
from gcxform.vocabulary import Machine, ProgramSettings, Tool
from gcxform_plugins.controls.linuxcnc.hal import read_hal
from gcxform_plugins.controls.linuxcnc.ini import read_ini
from gcxform_plugins.controls.linuxcnc.tools import read_tools


@dataclass(frozen=True)
class LinuxCncFiles(gx.ControlFiles):
    """LinuxCNC: kinematics as HAL or INI files set them, tool tables, and what INI files say."""

    units: Annotated[
        Literal["mm", "in"],
        gx.Option("the unit of the machine, which its HAL files do not say"),
    ]

    name: ClassVar[str] = "linuxcnc"
    file: ClassVar[str] = "HAL"

    def kinematics(self, path: Path) -> Machine:
        """Take over xyzac-trt-kins, xyzbc-trt-kins, 5axiskins or maxkins as HAL or INI files set them.

        Pins have to be set to numbers by setp, or by sets. Lengths of tools are not taken over.
        """  # noqa: E501 (one sentence is one line of help)
        return read_hal(path, self.units)

    @staticmethod
    def tools(path: Path, units: Literal["mm", "in"]) -> dict[int, Tool]:
        """Return the tools of a table."""
        return read_tools(path, units)

    @staticmethod
    def programs(path: Path) -> ProgramSettings:
        """Return what an INI file says of programs."""
        return read_ini(path)
