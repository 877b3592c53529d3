"""What is known of the parameters that belong to the control: it alone knows their values."""

from __future__ import annotations

from dataclasses import field

from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class MachineParameters:
    """What is known of the parameters of a control whose values only the machine knows.

    outputs    those that a program may set without any effect on positions
    alarm      the one that stops the control with an alarm: nothing behind it is executed
    counters   those of them that only count or only keep what they are given, so that nothing is
               done when they are set
    lengths    entries of the table of tools, a hundred or two for each kind of number
    zeros      entries of the table of work offsets
    aliases    numbers that are other names of a program's own parameters, and how much higher
    signals    those that mean the same in any unit, mode and place: inputs, clocks, counters
    names      what is known of those that have names
    measured   those that do in any mode and place, in one unit: offsets, results of probes
    highest    the highest number; a higher one is an error
    motion     those that say which code of motion, or which canned cycle, is in force
    null       the parameter without a value (`gcxform/dialect/null.py`); None: there is none
    """

    outputs: tuple[range, ...] = ()
    alarm: int | None = None
    counters: tuple[range, ...] = ()
    lengths: tuple[range, ...] = ()
    zeros: tuple[range, ...] = ()
    aliases: tuple[tuple[range, int], ...] = ()
    signals: tuple[range, ...] = ()
    names: NamedParameters = field(default_factory=lambda: NamedParameters())
    measured: tuple[range, ...] = ()
    highest: int = 2**31
    motion: frozenset[int | str] = frozenset()
    null: int | None = None

    def tool_of(self, number: int) -> int:
        """Return the number of the tool that an entry of the table of tools belongs to."""
        of = next(each for each in self.lengths if number in each)
        return number - of.start + 1


@dataclass(frozen=True)
class NamedParameters:
    """What is known of parameters of a control that have names.

    signals    those that mean the same in any unit, mode and place
    given      how the names begin of those that do not change, or of which a user may say so
    hidden     those that have another value where calls and loops are written out
    """

    signals: frozenset[str] = frozenset()
    given: tuple[str, ...] = ()
    hidden: frozenset[str] = frozenset()


def among(key: int | str, numbers: tuple[range, ...]) -> bool:
    """Whether a parameter has one of some numbers."""
    return isinstance(key, int) and any(key in each for each in numbers)


FANUC = MachineParameters(
    outputs=(
        range(1100, 1200),
        range(3000, 3005),
        *(range(n, n + 1) for n in (3006, 3901, 3902)),
    ),
    alarm=3000,
    counters=(range(3001, 3003), range(3901, 3903)),
    lengths=(
        *(range(first, first + 200) for first in (2001, 2201, 2401, 2601)),
        *(range(first, first + 999) for first in (10001, 11001, 12001, 13001)),
    ),
    zeros=(range(5201, 5400), range(7001, 8000), range(14001, 20001)),
    signals=(range(1000, 1200), range(3000, 4000)),
    measured=(
        range(2001, 3000),
        range(5061, 5069),
        range(5201, 5400),
        range(7001, 8000),
        range(10001, 20001),
    ),
    motion=frozenset({4001, 4009, 4201, 4209}),
    null=0,
)
"""Fanuc 16i to 32i, as in manuals of macro B."""
