"""The vocabulary for plugin authors who write a dialect's code tables."""

from gcxform.modal.arithmetic import MACRO_B, RS274
from gcxform.modal.codes import (
    CALL,
    COMP,
    CYCLE,
    HOME,
    ISO,
    ISO_M,
    LENGTH,
    PROBE,
    SHIFT,
    SYNCHRONISED,
    TRANSFORM,
    barrier,
    inert,
)

__all__ = [
    "CALL",
    "COMP",
    "CYCLE",
    "HOME",
    "ISO",
    "ISO_M",
    "LENGTH",
    "MACRO_B",
    "PROBE",
    "RS274",
    "SHIFT",
    "SYNCHRONISED",
    "TRANSFORM",
    "barrier",
    "inert",
]
