"""Carbide Motion: a host in front of GRBL, which takes some codes and does nothing with them.

| what | Carbide Motion | known from |
|---|---|---|
| G54 to G59 | are taken and ignored: not read, for they would be missed | a list of users |
| G43, G49 | are taken and ignored: refused | a list of users |
| G10, G92 | the zero of the work is the host's: refused | a list of users |
| M6 | asks for the tool in a dialogue, and may probe it: positions are lost | a list of users |
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

from gcxform_plugins.dialects.grbl import Grbl

import gcxform as gx
from gcxform import vocabulary as v

IGNORED = "the host takes it and does nothing"
HOSTS = "the zero of the work is the host's"
GONE = ("G43.1", "G92.1", *(f"G{n}" for n in range(54, 60)))


class Carbide(Grbl):
    """Carbide Motion in front of GRBL 1.1."""

    name = "carbide"
    kin = "grbl"
    codes: ClassVar[Mapping[str, gx.Code]] = {
        **{name: code for name, code in Grbl.codes.items() if name not in GONE},
        "G49": v.barrier("tool-length", IGNORED),
        "G43": v.barrier("tool-length", IGNORED, "Z"),
        **{code: v.barrier("non-modal", HOSTS, "XYZLP") for code in ("G10", "G92")},
    }
    m_codes: ClassVar[Mapping[int, gx.MCode]] = {
        **Grbl.m_codes,
        6: gx.MCode("tool", loses_position=True),
    }
    differs: ClassVar[Mapping[str, str]] = dict.fromkeys(
        ("initial", "offset_rule.g10_offsets", "program_rule.resets_at_end"),
        "work offsets are ignored (list of users)",
    )
    program_rule = replace(
        Grbl.program_rule,
        resets_at_end={k: c for k, c in Grbl.program_rule.resets_at_end.items() if k != "frame"},
    )
    offset_rule = replace(Grbl.offset_rule, g10_offsets=())
