"""HEIDENHAIN TNC 640 and iTNC 530 in Klartext."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.languages.heidenhain import Klartext


class Heidenhain(gx.Dialect):
    """HEIDENHAIN TNC 640 and iTNC 530, Klartext, mill: read only."""

    name = "heidenhain"
    axes = "XYZABCUVW"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G43": v.frame("tool-length", "length", "H"),
        "G52": v.frame("non-modal", "local", v.AXES),
        "G53": v.frame("non-modal", "machine"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True),
        128: gx.MCode("tip", barrier=v.FOLLOWING),
        129: gx.MCode("tip"),
    }
    translator = Klartext
    tip_switches: ClassVar[Mapping[str, str]] = {"tip-on": "M128", "tip-off": "M129"}
    turns_address = "P"
    arc_rule = gx.ArcRule(absolute=0.016)
