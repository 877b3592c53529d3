"""Lines of a SINUMERIK that are written again in a program of its own."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from itertools import pairwise

import gcxform as gx
from gcxform import vocabulary as v
from gcxform_plugins.dialects.siemens.axes_of_lines import words_of
from gcxform_plugins.dialects.siemens.computing import COMPUTED
from gcxform_plugins.dialects.siemens.cycles import HOLE, PATH, READ
from gcxform_plugins.dialects.siemens.frames import Frame, words_inside
from gcxform_plugins.dialects.siemens.going_along import HEAD, goes_along
from gcxform_plugins.dialects.siemens.going_along import bare as bare_line
from gcxform_plugins.dialects.siemens.learning import Learning
from gcxform_plugins.dialects.siemens.line import FRAMES
from gcxform_plugins.dialects.siemens.setting import DEFINES, SETTING, counted, said_of
from gcxform_plugins.dialects.siemens.spelling import spelled
from gcxform_plugins.dialects.siemens.structure import Part, Structure, StructureError, code
from gcxform_plugins.dialects.siemens.units import HEADER
from gcxform_plugins.dialects.siemens.words_moved import line_moved, words_in

STEPPED = re.compile(  # it begins with letters that may be looked for one by one
    r"[=Gg](?:(?<==)[ \t]*[Ii][Cc][ \t]*\("
    r"|(?<=[Gg])(?<![A-Za-z0-9_][Gg])[ \t]*0*91(?![0-9.]))"
)
MODAL = re.compile(r"(?<![A-Z0-9_])MCALL(?![A-Z0-9_])", re.IGNORECASE)
DRILLS = re.compile(rf"{MODAL.pattern}[ \t]*(?:{'|'.join(READ)})[ \t]*\(", re.IGNORECASE)
ENDS = re.compile(rf"{MODAL.pattern}[ \t]*$", re.IGNORECASE)
STEPPED_AT = re.compile(r"\((?<=[Cc \t]\()"), re.compile(r"91(?![0-9.])")
"""Of these it has one, which is found sooner."""
CALLED_CYCLE = re.compile(r"[A-Z_][A-Z0-9_]*", re.IGNORECASE)
NUMBER = re.compile(r"N[0-9]+[ \t]+")
GLUED = re.compile(r"[0-9.][A-Z]", re.IGNORECASE)
"""Words without a blank between: only the grammar tells them from names with a number in them."""
CODES = frozenset(("0", "1", "2", "3", "9", "17", "18", "19", "40", "60", "64", "90", "91", "94"))
"""G codes of which blocks say all that there is: not how near to a corner (G642), nor F (G71)."""
PLAIN = frozenset("NFMS")
PLACES = frozenset((*"XYZABCIJKF", "CR", "AR", "TURN", "I1", "J1", "K1", "CIP"))
"""Words of which they do, too; the second also where they are computed. Of a rotary axis they say
where it turns to: that it goes there, whichever way is shorter, the certificate says."""
KINDS = frozenset(("word", "value", "named", "function", "expression", "command"))


class InPlace(Learning):
    """Says what stands in the place of a line whose blocks have changed."""

    stepped = STEPPED_AT

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks; None where that is not known."""
        return spelled(self.lines[line], blocks)

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became, with its head and its comment.

        None for a line that has more than blocks say, and for steps: they would stay in force.
        """
        if not all(map(self._is_said, self.items(line))) or any(map(STEPPED.search, said)):
            return None
        text = self.lines[line]
        head, bare = HEAD.match(text), code(text, True).rstrip()
        first, *more = [each.partition(";")[0].rstrip() for each in said]
        start = head[0] if head else ""
        return "\n".join([f"{start}{NUMBER.sub('', first)}{text[len(bare) :]}", *more])

    def _is_said(self, item: gx.Item) -> bool:
        if item.kind in ("label", "comment"):
            return True
        if item.kind == "word" and item.name == "G":
            return (item.numbers[0].lstrip("0") or "0") in CODES
        plain = item.kind == "word" and item.name in PLAIN
        return plain or (item.kind in KINDS and item.name in PLACES)

    def changed_line(self, line: int, change: v.Change) -> str | None:
        """Return a line whose block became another; None where that is not known."""
        text = self.lines[line]
        bare = code(text, True).rstrip()
        computed: Sequence[gx.Item] = ()
        if any(item.kind in COMPUTED for item in self.items(line)):
            computed = [*words_of(self.tree_of(text), text)]
        elif GLUED.search(code(text)):
            computed = self.placed_items(line)
        made = line_moved(bare, words_in(bare, computed), change)
        return None if made is None else made + text[len(bare) :]

    def inside(
        self, frame: Frame, named: v.At, before: v.At, steps: bool, bends: bool
    ) -> v.At | None:
        """Return words as they count in a frame; None where that hangs on what is not known."""
        return words_inside(frame, named, before, steps, bends)

    def calls_behind(self, lines: Collection[int], block: v.BlockWords) -> bool:
        """Whether a block is the call of a cycle that a line of MCALL says, and none of these."""
        called = CALLED_CYCLE.search(" ".join(block.comments))
        if called is None or not {HOLE, PATH} & {*block.codes}:
            return False
        says = re.compile(rf"(?<![A-Z0-9_]){called[0]}[ \t]*\(", re.IGNORECASE)
        return not any(says.search(code(self.lines[line])) for line in lines)

    def margins(self) -> tuple[int, int]:
        """Return the first line that is no comment and no header, and the one behind the last."""
        says = (k for k in self.main if code(self.lines[k]).strip())
        first = next((k for k in says if not HEADER.fullmatch(self.lines[k])), self.main.stop)
        return first, self.main.stop

    def headed(self, line: int, text: str) -> str:
        """Return a text with the number and the label of a line: jumps may lead there."""
        head = HEAD.match(code(self.lines[line]))
        return f"{head[0].rstrip()} {text}" if head and head[0].strip() else text

    def loops(self) -> list[tuple[int, int]]:
        """Return the loops of the main program, and what MCALL of a cycle drills behind."""
        loops = [(part.first, part.last) for part in self._parts() if part.kind != "IF"]
        return [*loops, *self._holes_of_mcall()]

    def _holes_of_mcall(self) -> Iterator[tuple[int, int]]:
        """Yield the lines in which MCALL of a cycle that is read drills."""
        said = [line for line in self.main if MODAL.search(code(self.lines[line]))]
        for first, behind in pairwise([*said, self.main.stop]):
            if DRILLS.search(code(self.lines[first])):
                ends = behind < self.main.stop and ENDS.search(code(self.lines[behind]))
                yield first, behind - (not ends)

    def branches(self) -> list[tuple[int, ...]]:
        """Return the lines of IF with ELSE and ENDIF in the main program."""
        found = (part for part in self._parts() if part.kind == "IF")
        return [tuple(sorted({each.first, each.other, each.last} - {-1})) for each in found]

    def _parts(self) -> list[Part]:
        try:
            return Structure(self.lines, self.main.start, self.main.stop).parts
        except StructureError:
            return []

    def sets(self, line: int, visit: int) -> list[str] | None:
        """Return the assignments of a line, or the frame that it sets.

        None where variables are in them that the program has not, or that it defines there.
        """
        del visit
        items, own = self.items(line), self.is_own(line)
        flow = next((item.name for item in items if item.kind == "flow"), "")
        if flow:
            return None if own and DEFINES.match(flow) else self._counts_on(line, own)
        if not any(item.kind in SETTING or item.name in FRAMES for item in items):
            return []
        if goes_along(bare_line(self.lines[line])) is not None:
            return []  # its block says so
        text = code(self.lines[line])
        return said_of(text, [*words_of(self.tree_of(text), text)], own)

    def _counts_on(self, line: int, own: bool) -> list[str] | None:
        """Return how FOR or ENDFOR counts, as lines; None where that cannot be said."""
        parts = (each.at.get(line) for each in self._structures.values())
        part = next((each for each in parts if each is not None), None)
        if part is None or part.kind != "FOR":
            return []
        return counted(code(self.lines[part.first]), line == part.first, own)

    def leaves(self) -> dict[str, object]:
        """Return the R parameters: other programs may read them."""
        return {f"R{number}": value for number, value in self.r.items()}

    def counts(self, line: str) -> bool:
        """Whether a line has a word that counts from where its axis stands."""
        return STEPPED.search(code(line)) is not None
