"""The vocabulary for plugin authors who write a dialect's code tables."""

from gcxform.modal.codes import (
    AXES,
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
    frame,
    inert,
)

__all__ = [
    "AXES",
    "CALL",
    "COMP",
    "CYCLE",
    "HOME",
    "ISO",
    "ISO_M",
    "LENGTH",
    "PROBE",
    "SHIFT",
    "SYNCHRONISED",
    "TRANSFORM",
    "barrier",
    "frame",
    "inert",
]
