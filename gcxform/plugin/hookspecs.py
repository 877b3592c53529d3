"""The hooks of plugins: what a distribution can add to gcxform.

A plugin is a module named by an entry point of the group `gcxform.plugins`. Every hook takes no
argument and returns an iterable of what it adds; names have to be unique over all plugins. A thing
may be named instead, with its place, so that it is imported when it is used:
`gx.Later("shift", "acme_gx.shift:Shift")`.

    @gx.hookimpl
    def gcxform_passes() -> list[type[gx.Pass]]:
        return [Shift]
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Final

import pluggy

if TYPE_CHECKING:
    from gcxform.contract.passes import Pass, TextPass
    from gcxform.dialect.dialect import Dialect
    from gcxform.errormodel.formats import ErrorFormat
    from gcxform.machine.formats import ControlFiles
    from gcxform.machine.kinds import Kinematics
    from gcxform.machine.presets import MachinePreset
    from gcxform.plugin.contributions import Later
    from gcxform.toolpath.facts import Fact


PROJECT: Final = "gcxform"
GROUP: Final = "gcxform.plugins"

hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)
"""Marks a function of a plugin as the hook whose name it has."""


@hookspec
def gcxform_dialects() -> Iterable[type[Dialect] | Later]:
    """Return dialects: subclasses of `Dialect` with a name and a docstring."""
    raise NotImplementedError


@hookspec
def gcxform_passes() -> Iterable[type[Pass | TextPass] | Later]:
    """Return passes: frozen dataclasses on top of `Pass` or `TextPass`, with a name."""
    raise NotImplementedError


@hookspec
def gcxform_kinematics() -> Iterable[type[Kinematics] | Later]:
    """Return kinds of machines: subclasses of `Kinematics` with a name."""
    raise NotImplementedError


@hookspec
def gcxform_machine_presets() -> Iterable[type[MachinePreset] | Later]:
    """Return machines that files can be like: subclasses of `MachinePreset` with a source."""
    raise NotImplementedError


@hookspec
def gcxform_control_files() -> Iterable[type[ControlFiles] | Later]:
    """Return controls whose files are read: subclasses of `ControlFiles` with a name."""
    raise NotImplementedError


@hookspec
def gcxform_facts() -> Iterable[Fact | Later]:
    """Return facts that passes can require and ensure: instances of `Fact`."""
    raise NotImplementedError


@hookspec
def gcxform_error_formats() -> Iterable[type[ErrorFormat] | Later]:
    """Return file formats of error models: subclasses of `ErrorFormat` with a name."""
    raise NotImplementedError
