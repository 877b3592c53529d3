"""The first-party plugins: they come through the same door as anybody's."""

from __future__ import annotations

import gcxform as gx


@gx.hookimpl
def gcxform_dialects() -> list[type[gx.Dialect]]:
    """Return one class for each controller family."""
    from gcxform_plugins.dialects.controls import industrial, pc, printers
    from gcxform_plugins.dialects.controls.grbls import FluidNC, GrblHAL
    from gcxform_plugins.dialects.fagor.dialect import Fagor
    from gcxform_plugins.dialects.fanuc import Fanuc
    from gcxform_plugins.dialects.grbl import Grbl
    from gcxform_plugins.dialects.haas import Haas
    from gcxform_plugins.dialects.heidenhain.dialect import Heidenhain
    from gcxform_plugins.dialects.linuxcnc import LinuxCNC
    from gcxform_plugins.dialects.marlin import Marlin
    from gcxform_plugins.dialects.siemens.dialect import Siemens

    grown: list[type[gx.Dialect]] = [
        Fagor,
        Fanuc,
        Grbl,
        Haas,
        Heidenhain,
        LinuxCNC,
        Marlin,
        Siemens,
    ]
    grown += [FluidNC, GrblHAL, pc.Centroid, pc.Mach3, pc.Mach4, pc.Masso, pc.Uccnc]
    grown += [industrial.Brother, industrial.Gsk, industrial.Hurco, industrial.Mazak]
    grown += [industrial.Mitsubishi, industrial.Okuma]
    grown += [printers.Marlin2]
    return [*grown, printers.Klipper, printers.Prusa, printers.Rrf, printers.Smoothieware]


@gx.hookimpl
def gcxform_passes() -> list[type[gx.Pass | gx.TextPass]]:
    """Return the passes on toolpaths, then those on text."""
    from gcxform_plugins.passes.absolute import Absolute
    from gcxform_plugins.passes.arcs.arcs import Arcs
    from gcxform_plugins.passes.cutter_comp.cutter_comp import CutterComp
    from gcxform_plugins.passes.cycles import ExpandCycles
    from gcxform_plugins.passes.feed import FeedPass
    from gcxform_plugins.passes.metric import Metric
    from gcxform_plugins.passes.offsets import Offsets
    from gcxform_plugins.passes.plane import PlanePass
    from gcxform_plugins.passes.renumber import Renumber
    from gcxform_plugins.passes.rtcp.repost import Repost
    from gcxform_plugins.passes.rtcp.retarget import Retarget
    from gcxform_plugins.passes.rtcp.rtcp import Rtcp
    from gcxform_plugins.passes.rtcp.to_tip import ToTip
    from gcxform_plugins.passes.segment import Segment
    from gcxform_plugins.passes.strip import Strip
    from gcxform_plugins.passes.volumetric.volumetric import Volumetric

    return [
        Absolute,
        CutterComp,
        ExpandCycles,
        FeedPass,
        Metric,
        Offsets,
        PlanePass,
        Repost,
        Retarget,
        Rtcp,
        Segment,
        ToTip,
        Volumetric,
        Arcs,
        Renumber,
        Strip,
    ]


@gx.hookimpl
def gcxform_error_formats() -> list[type[gx.ErrorFormat]]:
    """Return the foreign tables of machine errors."""
    from gcxform_plugins.formats.bcnc import BcncProbe
    from gcxform_plugins.formats.etalon import Etalon
    from gcxform_plugins.formats.isg_csv import IsgCsv
    from gcxform_plugins.formats.iso230_csv import Iso230Csv
    from gcxform_plugins.formats.klipper import KlipperMesh, KlipperSkew
    from gcxform_plugins.formats.lddm import Lddm
    from gcxform_plugins.formats.linuxcnc_comp import LinuxCncComp
    from gcxform_plugins.formats.renishaw_rtl import RenishawRtl
    from gcxform_plugins.formats.siemens_cec import SiemensCec
    from gcxform_plugins.formats.siemens_eec import SiemensEec
    from gcxform_plugins.formats.xyz import Xyz

    return [
        BcncProbe,
        Etalon,
        IsgCsv,
        Iso230Csv,
        KlipperMesh,
        KlipperSkew,
        Lddm,
        LinuxCncComp,
        RenishawRtl,
        SiemensCec,
        SiemensEec,
        Xyz,
    ]


@gx.hookimpl
def gcxform_kinematics() -> list[type[gx.Kinematics]]:
    """Return the kinds of machines that files can name."""
    from gcxform_plugins.kinematics.forks import CaFork, CbFork
    from gcxform_plugins.kinematics.mixed import ATableBHead, CTableAHead, CTableBHead
    from gcxform_plugins.kinematics.nutating import ATableNutatingHead, NutatingHead, NutatingTable
    from gcxform_plugins.kinematics.single import ATable, BTable, CTable
    from gcxform_plugins.kinematics.trunnions import AbTrunnion, AcTrunnion, BaTrunnion, BcTrunnion

    return [
        AcTrunnion,
        BcTrunnion,
        AbTrunnion,
        BaTrunnion,
        CaFork,
        CbFork,
        CTableBHead,
        CTableAHead,
        ATableBHead,
        NutatingHead,
        NutatingTable,
        ATableNutatingHead,
        ATable,
        BTable,
        CTable,
    ]


@gx.hookimpl
def gcxform_machine_presets() -> list[type[gx.MachinePreset]]:
    """Return the machines that files can be like."""
    from gcxform_plugins.presets import smithy
    from gcxform_plugins.presets.tormach import Pcnc770, Pcnc1100

    mills = [smithy.Mill1240, smithy.Mill622]
    return [Pcnc770, Pcnc1100, *mills, smithy.Gecko1240, smithy.Gecko622, smithy.Gecko1034]


@gx.hookimpl
def gcxform_control_files() -> list[type[gx.ControlFiles]]:
    """Return the controls whose kinematics and tool tables are read."""
    from gcxform_plugins.controls.fanuc import FanucFiles
    from gcxform_plugins.controls.linuxcnc.control import LinuxCncFiles
    from gcxform_plugins.controls.siemens import SiemensFiles

    return [FanucFiles, LinuxCncFiles, SiemensFiles]
