"""Relatives of Fanuc, by what published post-processors for them write.

| what | Mazak EIA | Mitsubishi M700 | Brother C00 |
|---|---|---|---|
| dwell | P in ms | P in ms | P in s, with a point |
| G5 | P2, P0: smoothing, and no spline | as Fanuc | as Fanuc |
| G54.1 P | 1 to 48 | as Fanuc | 1 to 300 |
| coolant through the tool | | M88 | M494, M495 off |
| G100 | | | a tool change with moves: refused |
| G73, G83 | the pull is a parameter (F12) | as Fanuc | G83 cannot dwell |
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from gcxform_plugins.dialects.fanuc import Fanuc

import gcxform as gx
from gcxform import vocabulary as v

CHANGE = "it changes the tool and moves, in an order that is not known"


class Mazak(Fanuc):
    """Mazak EIA/ISO (Matrix, Smooth), as posts write for it."""

    name = "mazak"
    point_rule = replace(Fanuc.point_rule, dwell={"X": 1.0, "P": 0.001})


class Mitsubishi(Fanuc):
    """Mitsubishi M70, M700 and M800 (MELDAS), as posts write for it."""

    name = "mitsubishi"
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {**Fanuc.m_codes, 88: gx.MCode("coolant")}


class Brother(Fanuc):
    """Brother CNC-C00 and D00 (Speedio), as posts write for it."""

    name = "brother"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **Fanuc.codes,
        "G100": v.barrier("non-modal", CHANGE, "THSD"),
        **{code: v.barrier("cycle", v.SYNCHRONISED, "IJLRQ") for code in ("G77", "G78")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Fanuc.m_codes,
        494: gx.MCode("coolant"),
        495: gx.MCode("coolant", after=True),
    }
    point_rule = replace(Fanuc.point_rule, dwell={"P": 1.0})
    differs: ClassVar[Mapping[str, str]] = {
        "point_rule.dwell": "P is in seconds, with a point (post)"
    }
