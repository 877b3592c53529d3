"""Lines of a Fagor that are written again in a program of its own, where positions are others."""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from operator import itemgetter
from typing import Any

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.fagor.computing import COMPUTED, rule_of
from gcxform_plugins.dialects.fagor.drilling import DRILL, ENDS
from gcxform_plugins.dialects.fagor.places import code_of
from gcxform_plugins.dialects.fagor.programs import Programs
from gcxform_plugins.dialects.fagor.setting import counted, said_of
from gcxform_plugins.dialects.fagor.spelling import HEAD
from gcxform_plugins.dialects.fagor.structure import LOOPS, Part, Structure, StructureError, code
from gcxform_plugins.dialects.fagor.words_moved import blanked, line_moved, words_in

SAID = frozenset(("code", "numbered", "word", "incremental", "label", "colon", "comment"))
KINDS = SAID | {"expression", "assignment", "block_delete"}
DRILLS = re.compile(r"G[ \t]*0*81(?![0-9.])", re.IGNORECASE)


class InPlace(Programs):
    """Says what stands in the place of a line whose blocks have become others."""

    def changed_line(self, line: int, change: v.Change) -> str | None:
        """Return a line whose block became another; None where that is not known."""
        if not all(item.kind in KINDS for item in self.items(line)):
            return None
        text = self.lines[line]
        end = len(blanked(text).rstrip())
        made = line_moved(text[:end], words_in(text, [*self._placed(line)]), change)
        return None if made is None else made + text[end:]

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became; None for the holes of a cycle."""
        holes = any(first <= line <= last for first, last in self._holes)
        return None if self.reading.asides and holes else super().replaced(line, said)

    def _placed(self, line: int) -> Iterator[gx.Item]:
        """Yield the items of a line with their own places."""
        if not any(item.kind in COMPUTED for item in self.items(line)):
            yield from self.placed_items(line)
            return
        for node in self.tree_of(self.lines[line]).children:
            yield gx.Item(rule_of(node), (), (), (node.meta.start_pos, node.meta.end_pos))

    def headed(self, line: int, text: str) -> str:
        """Return a text with the number and the labels of a line: jumps may lead there."""
        head = HEAD.match(code(self.lines[line]))
        return f"{head[0].rstrip()} {text}" if head and head[0].strip() else text

    # --- what belongs together ---

    def in_main(self, line: int) -> bool:
        """Whether a line is of the program, and of no subroutine before it."""
        return self.begin <= line < self.own

    def loops(self) -> list[tuple[int, int]]:
        """Return the loops of the program, and the lines under a cycle, but for what ends it."""
        parts = (part for part in self._parts() if part.kind in LOOPS)
        return [*((part.first, part.last) for part in parts), *self._holes]

    def branches(self) -> list[tuple[int, ...]]:
        """Return the lines of $IF and of $SWITCH in the program."""
        parts = (part for part in self._parts() if part.kind not in LOOPS)
        return [(part.first, *(line for _, line in part.inner), part.last) for part in parts]

    def _parts(self) -> list[Part]:
        try:
            return Structure(self.lines, self.begin, self.own).parts
        except StructureError:
            return []

    @cached_property
    def _holes(self) -> list[tuple[int, int]]:
        """The first and the last line of holes that one cycle drills, in subroutines as well."""
        found, first = list[tuple[int, int]](), -1
        for line in range(self.own) if DRILLS.search(self._text) else ():
            codes = {code_of(item) or item.kind for item in self.items(line)}
            if first >= 0 and codes & {DRILL, "header", *ENDS}:
                found.append((first, line - 1))
                first = -1
            first = line if DRILL in codes else first
        return found if first < 0 else [*found, (first, self.own - 1)]

    # --- what a line does besides ---

    def margins(self) -> tuple[int, int]:
        """Return the first line that is no comment and no header, and the one behind the last."""
        said = ((k, code(self.lines[k]).strip()) for k in range(self.begin, self.own))
        first = next((k for k, text in said if text and text[0] != "%"), self.own)
        return first, self.own

    def sets(self, line: int, visit: int) -> list[str] | None:
        """Return what a line sets, as it says it; None where only a subroutine can say it."""
        items, text = self.items(line), self.lines[line]
        at = bisect_left(self.sharing, visit, key=itemgetter(0))
        shared = not at or self.sharing[at - 1][1]
        kinds = {item.kind for item in items}
        if "flow" in kinds:
            return self._counts_on(line, shared)
        nodes = self.tree_of(text).children if kinds & COMPUTED else ()
        return said_of(items, nodes, text, None if shared else self.made.get(visit, {}))

    def _counts_on(self, line: int, shared: bool) -> list[str] | None:
        """Return how $FOR or $ENDFOR counts, as a line."""
        parts = (each.at.get(line) for each in self._structures.values())
        part = next((each for each in parts if each is not None and each.kind == "FOR"), None)
        if part is None:
            return []
        return counted(self._head(part.first), self.lines[part.first], line == part.first, shared)

    def leaves(self) -> Mapping[str, Any]:
        """Return the parameters and variables that the program has set."""
        return dict(self.known)
