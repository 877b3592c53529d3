"""Controls on a PC, milling: Mach3, Mach4, UCCNC, Masso, Centroid, PlanetCNC, EdingCNC.

*Post*: what published post-processors write (Autodesk's and FreeCAD's); *page*: the maker's own
page. What is only recalled is refused, or a setting.

| what | Mach3, Mach4 | UCCNC | Masso | Centroid CNC12 |
|---|---|---|---|---|
| I, J, K | a setting, until G90.1 or G91.1 (post) | from the start (post) | as UCCNC | as UCCNC |
| K0 of an arc in XY | refused | is nothing (post) | refused | refused |
| G4 P | seconds or ms, a setting: it stays | ms (post) | a setting: it stays | s (manual) |
| units at start | taken as G21 | taken as G21: posts write none | G21 | G20 (manual) |
| G10, G52, G92 | read | refused: no post writes them | refused | refused |
| G28, G30 | read | refused | G28 read | read |
| G28.1 | moves to the switches: refused | refused | refused | refused |
| G70, G71, G12, G13 | units, pockets: refused | refused | refused | refused |
| turning, scaling, mirrors | refused | refused | refused | refused |
| G50 | resets scales to 1 (lists of its codes) | refused | refused | refused |
| cycles | kept, in blocks with a code of their own | also; G33.1, G33.2 refused | kept | kept |
| more than six offsets | G59 P (post of Mach4): refused | none | none | none |
| M6, other M codes | run a macro that may move | as Mach3 | as Mach3 | as Mach3 |
| M98, G65 | refused | refused | M98 calls a file (page): refused | files: refused |
| M99 | refused | refused | refused | returns to another file (post): a subprogram |
| G49 H0 | refused | refused | refused | is G49 (post) |
| comments | `(`; Mach4 also `;`; `(MSG,` shows | `(` | `(` | `;` |
| G64 | blends | not known: refused | refused | G64 alone |

| what | PlanetCNC TNG | EdingCNC |
|---|---|---|
| known from | its post, which takes in Autodesk's for LinuxCNC | what people recall, and a note |
| I, J, K | from the start (post) | a setting, until G90.1 or G91.1 |
| G4 P | s (post) | it stays |
| G53 | read, alone or behind G0 (post) | behind G0 it may not be heard (a note): refused |
| work offsets | G54 to G59.3 (post) | G54 to G59 |
| tool length | G43 H (post) | refused |
| cycles | stay | stay |
| G10, G52, G92, G28, G30 | refused | refused |
| O-words, `gosub`, `#<name>`, `(dlg` | refused | refused |
| M6, other M codes | run a script that may move | as PlanetCNC |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v

SHIFTS = ("G10", "G52", "G92", "G92.1")
RECALLED = "it shifts the coordinates, in a way that no post for this control shows"
SWITCHES = "it moves to the switches"
UNIT = "it changes the unit on some controls, and cuts on others"
POCKET = "it cuts a pocket in a way of its own"
TELLS = ("MSG,", "PRINT,")
NOT_HEARD = "behind G0 it is not heard, as a note on a rework says"
LENGTHS = "it is recalled alone, and no post shows it"
SEMICOLON = ("gcxform_grammars", "centroid")
COMP = {code: gx.Code("cutter-comp", takes="D") for code in ("G41", "G42")}
DWELL_UNIT = "P counts seconds or milliseconds, as a setting says (post): it stays as it is"


def cycles(*numbers: int) -> Mapping[str, gx.Code]:
    """Return canned cycles: they stay as they are, and where they end is not known."""
    return {f"G{n}": v.cuts("PQRLIJK", "motion") for n in numbers}


STEPS = {f"G{n}": "its steps are not known: it stays" for n in (73, 74, 76, *range(81, 90))}


class Mach3(gx.Dialect):
    """Mach3 mill, as posts write for it."""

    name = "mach3"
    kin = "linuxcnc"
    axes = "XYZABC"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        **cycles(73, 76, 81, 82, 83, 84, 85, 86, 88, 89),
        **COMP,
        **{code: gx.Code("arc-distance") for code in ("G90.1", "G91.1")},
        **{code: v.inert("retract") for code in ("G98", "G99")},
        **{code: v.frame("non-modal", "home") for code in ("G28", "G30")},
        **{code: v.barrier("non-modal", UNIT) for code in ("G70", "G71")},
        **{code: v.barrier("non-modal", POCKET, "I") for code in ("G12", "G13")},
        **{code: v.barrier("non-modal", v.TRANSFORM) for code in ("G15", "G16", "G51")},
        "G50": v.frame("scaling", "no-scale"),
        **{code: v.barrier("non-modal", v.TRANSFORM, "RI") for code in ("G68", "G69")},
        "G4": v.inert("non-modal", "P"),
        "G95": gx.Code("feed-mode"),
        "G61": v.inert("path", act="exact-stop"),
        "G64": v.inert("path", act="blend"),
        "G10": v.frame("non-modal", "set-work", "XYZABCLP"),
        "G52": v.frame("non-modal", "local", "XYZABC"),
        "G92": v.frame("non-modal", "preset", "XYZABC"),
        "G92.1": v.frame("non-modal", "preset-clear"),
        "G28.1": v.barrier("non-modal", SWITCHES),
        "G31": v.barrier("non-modal", v.PROBE),
        "G53": v.frame("non-modal", "machine"),
        "G43": v.frame("tool-length", "length", "H"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True, act="change-tool"),
        **{code: gx.MCode("override") for code in (48, 49)},
        98: gx.MCode("stop", after=True, barrier=v.CALL, takes="PQL"),
        99: gx.MCode("stop", after=True, barrier=v.CALL),
    }
    settings: ClassVar[tuple[gx.Setting, ...]] = (
        gx.Setting("arc-centres", "how I, J and K count (IJ Mode)", ("incremental",)),
    )
    differs: ClassVar[Mapping[str, str]] = {**STEPS, "G4": DWELL_UNIT}
    text_rule = gx.TextRule(active_comments=("MSG,",), telling_comments=("MSG,",))
    block_rule = gx.BlockRule(unknown_m=gx.MCode("user", loses_position=True, takes="PQS"))
    arc_rule = gx.ArcRule(absolute=0.002, in_inch=2.54, centres_open=True)


class Mach4(Mach3):
    """Mach4 mill, as posts write for it."""

    name = "mach4"
    grammar = SEMICOLON
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Mach3.codes,
        "G65": v.barrier("non-modal", v.CALL, "ABCDEFHIJKLMPQRSTXYZ"),
        "G54.1": v.barrier("frame", "posts for it write G59 P", "P"),
    }
    text_rule = replace(Mach3.text_rule, comments="(;")


class Uccnc(Mach3):
    """UCCNC, as posts write for it."""

    name = "uccnc"
    grammar = ("gcxform_grammars", "uccnc")
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in Mach3.codes.items() if name not in ("G64", "G84")},
        **{code: v.barrier("motion", v.SYNCHRONISED, "KQ") for code in ("G33.1", "G33.2")},
        **{code: v.barrier("non-modal", RECALLED, "XYZABCLP") for code in SHIFTS},
        "G50": v.barrier("non-modal", v.TRANSFORM),
        **{code: v.barrier("non-modal", v.HOME, "XYZABC") for code in ("G28", "G30")},
        "G4": v.ISO["G4"],
    }
    chosen: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("G2", "G3"), "I, J and K count from the start of the arc, but after G90.1"
    )
    differs: ClassVar[Mapping[str, str]] = {
        **STEPS,
        "point_rule.dwell": "P of G4 is in ms (post)",
    }
    settings = ()
    text_rule = gx.TextRule()
    point_rule = gx.PointRule(dwell={"P": 0.001})
    arc_rule = gx.ArcRule(absolute=0.002, third="zero")


class Masso(Uccnc):
    """Masso G3, as posts write for it."""

    name = "masso"
    arc_rule = gx.ArcRule(absolute=0.002)
    grammar = Mach3.grammar
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{n: code for n, code in Uccnc.codes.items() if n not in ("G33.1", "G33.2")},
        "G4": Mach3.codes["G4"],
        "G28": Mach3.codes["G28"],
        **cycles(84),
    }
    differs: ClassVar[Mapping[str, str]] = {"G4": DWELL_UNIT, **Uccnc.differs}


class PlanetCnc(Uccnc):
    """PlanetCNC TNG, milling, as its post writes."""

    name = "planetcnc"
    grammar = SEMICOLON
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{n: code for n, code in Uccnc.codes.items() if n not in ("G33.1", "G33.2")},
        **cycles(84),
        **{f"G59.{n}": v.frame("frame", "work") for n in (1, 2, 3)},
        "G64": v.inert("path", "PQ", "PQ", act="blend"),
    }
    differs: ClassVar[Mapping[str, str]] = {
        **STEPS,
        "G64": "its P is a tolerance, as that of LinuxCNC (post)",
        "point_rule.dwell": "P of G4 is in s, as that of LinuxCNC (post)",
    }
    text_rule = gx.TextRule(comments="(;", active_comments=(*TELLS, "DLG"), telling_comments=TELLS)
    point_rule = gx.PointRule(dwell={"P": 1.0})
    arc_rule = gx.ArcRule(absolute=0.002)


class EdingCnc(Mach3):
    """EdingCNC (USBCNC), milling: what is recalled of it stays, or is refused."""

    name = "edingcnc"
    grammar = SEMICOLON
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Masso.codes,
        "G28": Uccnc.codes["G28"],
        "G43": v.barrier("tool-length", LENGTHS, "H"),
        "G53": v.barrier("non-modal", NOT_HEARD),
    }
    differs: ClassVar[Mapping[str, str]] = Masso.differs
    text_rule = gx.TextRule(comments="(;")
    arc_rule = gx.ArcRule(absolute=0.002, centres_open=True)


class Centroid(Uccnc):
    """Centroid CNC12, milling."""

    name = "centroid"
    arc_rule = gx.ArcRule(absolute=0.002)
    grammar = SEMICOLON
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{n: code for n, code in Uccnc.codes.items() if n not in ("G33.1", "G33.2")},
        **cycles(74, 84),
        "G28": Mach3.codes["G28"],
        "G30": v.frame("non-modal", "home", "P"),
        "G64": v.inert("path", act="blend"),
        "G65": v.barrier("non-modal", v.CALL, "ABCDEFHIJKLMPQRSTXYZ"),
        "G49": v.frame("tool-length", "no-length", "H"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Uccnc.m_codes,
        99: gx.MCode("stop", after=True, ends=True),
    }
    flow_rule = gx.FlowRule(m99_returns=True)
    initial: ClassVar[Mapping[str, str]] = {**gx.Dialect.initial, "units": "G20"}
    differs: ClassVar[Mapping[str, str]] = {
        **STEPS,
        "initial": "a program starts in G20 (list of Centroid's modal groups)",
        "point_rule.dwell": "P of G4 is in seconds (manual)",
    }
    text_rule = gx.TextRule(comments=";")
    point_rule = gx.PointRule()
