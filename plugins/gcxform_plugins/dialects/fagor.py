"""Fagor 8065 and 8070: draft."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import ClassVar

import gcxform as gx
from gcxform import vocabulary as v


class Blocks(gx.Translator):
    """Turns blocks of a Fagor into blocks of words."""

    grammar = ("gcxform_grammars", "fagor")
    number = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)")
    signs = re.compile(rb"#(?:RTCP|TLC|CS|ACS|MCS)\b", re.IGNORECASE)

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the block, with what is incremental in a block of its own."""
        words = []
        for item in items:
            if item.kind == "statement":
                on = {"#RTCP ON": "M128", "#RTCP OFF": "M129"}.get(item.name)
                if on is None or len(items) > 1:
                    self.refuse(f"{item.name} is not resolved", item)
                return [on]
            if item.kind == "incremental":
                self.refuse("incremental", item)
            if item.kind != "percent":
                words.append(item.name + item.numbers[0])
        return [" ".join(words)]


class Fagor(gx.Dialect):
    """Fagor 8065 and 8070 mill: read only."""

    name = "fagor"
    axes = "XYZABCUVW"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **v.ISO,
        "G43": v.frame("tool-length", "length", "H"),
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **v.ISO_M,
        6: gx.MCode("tool", loses_position=True),
        128: gx.MCode("tip", barrier=v.FOLLOWING),
        129: gx.MCode("tip"),
    }
    translator = Blocks
    tip_switches: ClassVar[Mapping[str, str]] = {"tip-on": "M128", "tip-off": "M129"}
    spelled: ClassVar[Mapping[str, str]] = {"M128": "#RTCP ON", "M129": "#RTCP OFF"}
    g43_takes_spindle_tool = True
