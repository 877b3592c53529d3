"""Sequence numbers of the programs in a text, by which jumps find their blocks."""

from __future__ import annotations

import re
from collections import Counter

SEQUENCE = re.compile(rb"[ \t]*(?:/[1-9]?)?[ \t]*[Nn][ \t]*0*([0-9]+)")
PROGRAM = re.compile(rb"^(?=[ \t]*[Oo:][ \t]*[0-9])", re.MULTILINE)
"""Where a program begins in a text of several, each of which numbers its own blocks."""


def sequence_numbers(text: bytes) -> Counter[int]:
    """Return how often each number stands in the program that has it most."""
    most = Counter[int]()
    for program in PROGRAM.split(text):
        found = map(SEQUENCE.match, program.splitlines())
        most |= Counter(int(each[1]) for each in found if each)
    return most
