"""The first-party plugins: they come through the same door as anybody's.

Each thing is named with its place, so that a run imports what it uses.
"""

from __future__ import annotations

import gcxform as gx

HERE = "gcxform_plugins"


def _later(folder: str, places: dict[str, str]) -> list[gx.Later]:
    """Return what a folder has: names, and `module:Class` in the folder."""
    return [gx.Later(name, f"{HERE}.{folder}.{place}") for name, place in places.items()]


@gx.hookimpl
def gcxform_dialects() -> list[gx.Later]:
    """Return one class for each controller family."""
    places = {
        "fagor": "fagor.dialect:Fagor",
        "fanuc": "fanuc:Fanuc",
        "grbl": "grbl:Grbl",
        "haas": "haas:Haas",
        "heidenhain": "heidenhain.dialect:Heidenhain",
        "linuxcnc": "linuxcnc:LinuxCNC",
        "marlin": "marlin:Marlin",
        "siemens": "siemens.dialect:Siemens",
        "fluidnc": "controls.grbls:FluidNC",
        "grblhal": "controls.grbls:GrblHAL",
        "g2core": "controls.tinygs:G2core",
        "tinyg": "controls.tinygs:TinyG",
        "centroid": "controls.pc:Centroid",
        "mach3": "controls.pc:Mach3",
        "mach4": "controls.pc:Mach4",
        "masso": "controls.pc:Masso",
        "uccnc": "controls.pc:Uccnc",
        "planetcnc": "controls.pc:PlanetCnc",
        "edingcnc": "controls.pc:EdingCnc",
        "brother": "controls.industrial:Brother",
        "gsk": "controls.industrial:Gsk",
        "syntec": "controls.industrial:Syntec",
        "hurco": "controls.industrial:Hurco",
        "mazak": "controls.industrial:Mazak",
        "mitsubishi": "controls.industrial:Mitsubishi",
        "okuma": "controls.industrial:Okuma",
        "marlin2": "controls.printers:Marlin2",
        "klipper": "controls.printers:Klipper",
        "prusa": "controls.printers:Prusa",
        "rrf": "controls.printers:Rrf",
        "rrf-cnc": "controls.printers:RrfCnc",
        "smoothieware": "controls.printers:Smoothieware",
    }
    return _later("dialects", places)


@gx.hookimpl
def gcxform_passes() -> list[gx.Later]:
    """Return the passes on toolpaths, then those on text."""
    places = {
        "absolute": "absolute:Absolute",
        "cutter-comp": "cutter_comp.cutter_comp:CutterComp",
        "cycles": "cycles:ExpandCycles",
        "feed": "feed:FeedPass",
        "metric": "metric:Metric",
        "offsets": "offsets:Offsets",
        "plane": "plane:PlanePass",
        "repost": "rtcp.repost:Repost",
        "retarget": "rtcp.retarget:Retarget",
        "rtcp": "rtcp.rtcp:Rtcp",
        "segment": "segment:Segment",
        "to-tip": "rtcp.to_tip:ToTip",
        "volumetric": "volumetric.volumetric:Volumetric",
        "arcs": "arcs.arcs:Arcs",
        "renumber": "renumber:Renumber",
        "strip": "strip:Strip",
    }
    return _later("passes", places)


@gx.hookimpl
def gcxform_error_formats() -> list[gx.Later]:
    """Return the foreign tables of machine errors."""
    places = {
        "bcnc-probe": "bcnc:BcncProbe",
        "etalon": "etalon:Etalon",
        "isg-csv": "isg_csv:IsgCsv",
        "iso230-csv": "iso230_csv:Iso230Csv",
        "klipper-mesh": "klipper:KlipperMesh",
        "klipper-skew": "klipper:KlipperSkew",
        "lddm": "lddm:Lddm",
        "linuxcnc-comp": "linuxcnc_comp:LinuxCncComp",
        "renishaw-rtl": "renishaw_rtl:RenishawRtl",
        "siemens-cec": "siemens_cec:SiemensCec",
        "siemens-eec": "siemens_eec:SiemensEec",
        "xyz": "xyz:Xyz",
    }
    return _later("formats", places)


@gx.hookimpl
def gcxform_kinematics() -> list[gx.Later]:
    """Return the kinds of machines that files can name."""
    places = {
        "ac-trunnion": "trunnions:AcTrunnion",
        "bc-trunnion": "trunnions:BcTrunnion",
        "ab-trunnion": "trunnions:AbTrunnion",
        "ba-trunnion": "trunnions:BaTrunnion",
        "ca-fork": "forks:CaFork",
        "cb-fork": "forks:CbFork",
        "c-table-b-head": "mixed:CTableBHead",
        "c-table-a-head": "mixed:CTableAHead",
        "a-table-b-head": "mixed:ATableBHead",
        "nutating-head": "nutating:NutatingHead",
        "nutating-table": "nutating:NutatingTable",
        "a-table-nutating-head": "nutating:ATableNutatingHead",
        "a-table": "single:ATable",
        "b-table": "single:BTable",
        "c-table": "single:CTable",
    }
    return _later("kinematics", places)


@gx.hookimpl
def gcxform_machine_presets() -> list[gx.Later]:
    """Return the machines that files can be like."""
    places = {
        "tormach-pcnc-770": "tormach:Pcnc770",
        "tormach-pcnc-1100-series-ii": "tormach:Pcnc1100",
        "smithy-1240": "smithy:Mill1240",
        "smithy-622": "smithy:Mill622",
        "smithy-1240-gecko": "smithy:Gecko1240",
        "smithy-622-gecko": "smithy:Gecko622",
        "smithy-1034-gecko": "smithy:Gecko1034",
    }
    return _later("presets", places)


@gx.hookimpl
def gcxform_control_files() -> list[gx.Later]:
    """Return the controls whose kinematics and tool tables are read."""
    places = {
        "fanuc": "fanuc:FanucFiles",
        "linuxcnc": "linuxcnc.control:LinuxCncFiles",
        "siemens": "siemens:SiemensFiles",
    }
    return _later("controls", places)
