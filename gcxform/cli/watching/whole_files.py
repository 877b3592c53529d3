"""Which files of a folder are whole: nobody writes into them, and none grows any more.

Time is that of a clock that nobody sets: a change of the system's neither delays a file nor makes
one pass for whole.
"""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Callable, Iterator
from dataclasses import field
from pathlib import Path
from typing import Final, NamedTuple

from gcxform.cli.common.programs import is_program
from gcxform.system.alone import is_being_written
from gcxform.values import dataclass

BESIDE: Final = (".gcxform.txt", ".gcxform.json")
"""How the names of files end that are put beside programs."""


class Look(NamedTuple):
    """What a file is known by: another one, or the same written anew, has another."""

    inode: int
    size: int
    written: int

    @classmethod
    def at(cls, path: Path) -> Look | None:
        """Return what is there, None if it is no regular file, a link for example."""
        try:
            found = os.lstat(path)
        except OSError:
            return None
        regular = stat.S_ISREG(found.st_mode)
        return cls(found.st_ino, found.st_size, found.st_mtime_ns) if regular else None


@dataclass
class Settling:
    """Looks at a folder again and again; a file is whole that was the same for `rest` seconds.

    An empty file is never whole. Hidden files and temporary names are left out.
    """

    folder: Path
    rest: float
    clock: Callable[[], float] = time.monotonic
    seen: dict[str, tuple[Look, float]] = field(default_factory=dict)

    def whole(self) -> list[str]:
        """Return the files that are whole now, the one that was written first first.

        Raises OSError if the folder cannot be read.
        """
        now, found = self.clock(), dict(self._programs())
        self.seen = {
            name: (look, since if look == before else now)
            for name, look in found.items()
            for before, since in [self.seen.get(name, (None, now))]
        }
        rested = [
            (look.written, name)
            for name, (look, since) in self.seen.items()
            if look.size and now - since >= self.rest
        ]
        return [n for _, n in sorted(rested) if not is_being_written(self.folder / n)]

    @property
    def waits(self) -> bool:
        """Whether there is a file that may become whole."""
        return any(look.size for look, _ in self.seen.values())

    def _programs(self) -> Iterator[tuple[str, Look]]:
        for name in os.listdir(self.folder):
            look = Look.at(self.folder / name) if is_program(name) else None
            if look is not None and not name.endswith(BESIDE):
                yield name, look
