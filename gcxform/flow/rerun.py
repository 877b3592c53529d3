"""What a run of a program finds out too late, so that the next run has to know it before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from gcxform.dialect.arithmetic import Key
from gcxform.values import dataclass


@dataclass(frozen=True, slots=True)
class Changes:
    """What a round of a loop may change: parameters, axes by letters, modes by groups.

    quirks  what the control notes of its loops, and counts wrong by
    """

    keys: frozenset[Key] = frozenset()
    letters: str = ""
    groups: frozenset[str] = frozenset()
    quirks: frozenset[int | str] = frozenset()

    def within(self, other: Changes) -> bool:
        """Whether all of it is in another."""
        return other.with_more(self) == other

    def with_more(self, other: Changes) -> Changes:
        """Return both together."""
        return Changes(
            self.keys | other.keys,
            "".join(sorted({*self.letters, *other.letters})),
            self.groups | other.groups,
            self.quirks | other.quirks,
        )


@dataclass(frozen=True, slots=True)
class Settled:
    """What a run has found out too late, so that the next one has to know it before.

    needed  parameters that end with the run, and whose assignments stay all the same
    loops   first and last lines that the machine repeats until it is content
    kept    the same of loops with an opening line: by that, with what a round changes
    alike   those of `kept` that are not found themselves, but written like one that was found;
            whether it was known of that one that it begins
    """

    needed: frozenset[Key] = frozenset()
    loops: frozenset[tuple[int, int]] = frozenset()
    kept: Mapping[int, Changes] = field(default_factory=dict)
    alike: Mapping[int, bool] = field(default_factory=dict)


class Again(Exception):  # noqa: N818 - it is no error
    """The program has to be run from its start once more, and this is known now."""

    def __init__(self, settled: Settled) -> None:
        super().__init__("again")
        self.settled = settled
