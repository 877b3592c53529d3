"""The vocabulary for plugin authors who write a dialect's code tables."""

from gcxform.modal.codes import (
    CALL,
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
    "inert",
]
