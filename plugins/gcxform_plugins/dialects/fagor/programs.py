"""Programs of a Fagor that are written for a Fagor again: what is not read stays as it stands.

A line that is kept is a block of its own, behind which no position is known, nor anything else that
it may have set. Where only the control knows where a program goes on, all that follows stays, and
no line may change that might be executed again.
"""

from __future__ import annotations

import re
import zlib
from collections.abc import Iterable, Iterator, Sequence
from copy import copy

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables
from gcxform_plugins.dialects.fagor.computing import rule_of
from gcxform_plugins.dialects.fagor.flow import Flow
from gcxform_plugins.dialects.fagor.lines import Lines
from gcxform_plugins.dialects.fagor.places import code_of
from gcxform_plugins.dialects.fagor.spelling import COUNTS, HEAD, STEPPED, spelled
from gcxform_plugins.dialects.fagor.structure import StructureError, code
from gcxform_plugins.dialects.shared.untouched_lines import KEEPABLE, KEEPS, KEPT

HANGS = re.compile(r"[Gg](?<![A-Za-z0-9_.][Gg])[ \t]*0*(?:8|36|37|38|39)(?![0-9.])")
"""Codes that take the direction of the move before them, or change the moves beside them."""
BEHIND = re.compile(r"(?<![A-Z0-9_.])G[ \t]*0*(?:36|37|38|39)(?![0-9.])", re.IGNORECASE)
MODAL = re.compile(
    r"(?<![A-Z0-9_.])G[ \t]*0*(?:8[1-9]|21[0-4]|41|42|33|63|45|77)(?![0-9.])|#MCALL|#SPLINE|#AKIMA"
    r"|#POLY|#HSC|G[ \t]*0*6[245](?![0-9.])",
    re.IGNORECASE,
)
"""Codes and statements with which the moves behind them are others than they say."""
FROM_HERE = re.compile(
    r"(?<![A-Z0-9_.])G[ \t]*0*(?:20|70|93|96|151|158|261)(?![0-9.])|#(?:TRAFO|CYL|FACE|RENAME|SET"
    r"|FREE|LINK|EXEC|EXBLK|PATH|MASTER)(?![A-Z])|#RPT|(?<![A-Z0-9_.])NR(?=[ \t]*[0-9P\[])",
    re.IGNORECASE,
)
"""What changes the meaning of all words behind it, or repeats lines."""
POLES = re.compile(r"(?<![A-Z0-9_.])G[ \t]*0*(?:30|17|18|19|5[3-9]|92|15[89])(?![0-9.])|\$", re.I)
"""What may leave the pole elsewhere."""
CALLS = re.compile(
    r"(?<![A-Z0-9_#$.])(?:LL?(?![A-Z])|#P?CALL|#MCALL|#MDOFF|#EXEC|#EXBLK)", re.IGNORECASE
)
SCALES = re.compile(r"(?<![A-Z0-9_.])G[ \t]*0*72(?![0-9.])|#SCALE", re.IGNORECASE)
"""What makes a contour larger than its words: how near lines are to an arc does not say there."""
LEAVES = re.compile(r"\$(?:GOTO|BREAK|CONTINUE)|#RET|(?<![A-Z0-9])M0*(?:2|17|29|30)(?![0-9])", re.I)
ZEROS = tables.WORK | {"G159"}
STATED = frozenset(("G0", "G1", "G2", "G3", "G17", "G18", "G19", "G90", "G91", "G94", "G95"))
STATE = (
    *("bars", "incremental", "following", "taken_away", "corners", "kinematics", "tool", "edge"),
    *(
        "in_spindle",
        "changing",
        "across",
        "long",
        "bare",
        "machine",
        "comp",
        "known",
        "doubtful",
        "at",
        "calls",
        "counting",
    ),
    *("gone", "pole", "polar", "plane", "turned", "untold"),
)
SAID = frozenset(("label", "colon", "comment", "code", "word", "incremental", "expression"))
NUMBER = re.compile(r"^N[0-9]+[ \t]+")
CODE = r"(?i)^(?:[^;(]|\([^)]*\))*?(?<![A-Z0-9_.])"
ARCS = re.compile(rf"{CODE}(?:G[ \t]*0*(?:[2389]|3[678])(?![0-9.])|(?<=#)(?:SPLINE|AKIMA|POLY))")
AGAINST = {
    "METRIC": re.compile(rf"{CODE}G[ \t]*0*70(?![0-9.])"),
    "LINEAR_ONLY": ARCS,
    "XY_ARCS": ARCS,
    "NO_CYCLES": re.compile(rf"{CODE}G[ \t]*0*8[1-9](?![0-9.])"),
    "WORKPIECE_FRAME": re.compile(rf"{CODE}G[ \t]*0*73[ \t]*[QIJ]"),
}


class Programs(Flow):
    """Executes a program, and keeps what it does not understand where that may stay.

    unsaid  what has to be said before the next move, as it may have been changed: G90, and a motion
    maybe   lines of a structure that is kept: they may be executed
    ran     lines that were executed, and not kept;  named: axes of the program
    frozen  lines of subroutines that what is kept may call
    gone    those that may stand anywhere;  scaled: contours may be larger than their words
    """

    writes = True
    speller = Lines
    kept = KEPT
    against = AGAINST
    stepped = STEPPED

    def __init__(self, *given: object) -> None:
        super().__init__(*given)
        self.kept_lines: list[tuple[int, str]] = []
        self.maybe = range(0)
        self.why = self.tied = self.modal = ""
        self.unsaid: set[str] = set()
        self.beside = self.scaled = False
        self.ran: set[int] = set()
        self.frozen: set[int] = set()
        self.gone: set[str] = set()
        self.named = tables.AXES & self.letters
        self.hangs = HANGS.search(self._text) is not None
        self.plainly = self.plainly and not (self.reading.stays and self.hangs)

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError."""
        if not self.reading.stays:
            return super().blocks(items)
        self.places.arrive()
        if self.line in self.maybe:
            return self._kept(items, self.why)
        before = {name: copy(getattr(self, name)) for name in STATE}
        try:
            self._check_beside(items)
            made = [*super().blocks(items)]
            self.ran.add(self.line)
            free = not (self.hangs or self.unsaid or self.modal or self.gone or self.scaled)
            self.plainly = self.plainly and free
            return made
        except gx.InputError as error:
            (found, *_) = error.diagnostics
            if found.code not in KEEPABLE:
                raise
            vars(self).update(before)
            self.places.next = self.line + 1
            return self._keep(items, found.message)

    def _check_beside(self, items: Sequence[gx.Item]) -> None:
        """Refuse to change what the lines beside it hang on. Raises InputError."""
        codes = {code_of(item) for item in items if item.kind == "code"}
        moved = any(self._moves(item) for item in items)
        if "G80" in codes or "G40" in codes:
            self.modal = ""
        if moved:
            self.unsaid -= {"motion"} if codes & {"G0", "G1", "G2", "G3"} else set()
        self.unsaid -= {"distance"} if codes & {"G90", "G91"} else set()
        if not moved:
            return
        beside, self.beside = self.beside, False
        if self.modal:
            self.refuse(f"moves behind {self.modal} are others than they say")
        if self.unsaid:
            self.refuse("whether G90 and which motion is in force is not known here")
        if self.scaled and any(item.name.lstrip()[:1] in {*"IJKRQ"} for item in items):
            self.refuse("an arc where coordinates may be scaled")
        if beside or (self.hangs and self._next_hangs()):
            self.refuse("the lines beside it hang on the direction of this move")

    def _moves(self, item: gx.Item) -> bool:
        if item.kind in ("word", "incremental", "ambiguous"):
            return item.name in tables.AXES | {*"IJKRQ"}
        if item.kind == "expression":
            return item.name.lstrip()[:1] in tables.AXES | {*"IJKRQ"}
        return False

    def _next_hangs(self) -> bool:
        """Whether the next line takes the direction of this one, or may do so."""
        for line in range(self.line + 1, len(self.lines)):
            text = code(self.lines[line]).strip()
            if text:
                flows = "$" in text or "#" in text or CALLS.search(text) is not None
                return flows or HANGS.search(text) is not None
        return False

    # --- what is kept ---

    def _keep(self, items: Sequence[gx.Item], why: str) -> list[str]:
        """Keep a line, or the structure that it begins, or all that follows."""
        text = code(self.lines[self.line])
        decides = "$" in text
        until = self._structure_to(text) if decides and not self.calls else -1
        if self.calls or FROM_HERE.search(text) or (decides and until < 0):
            return self._stop(items, why)
        if until >= 0:
            self.maybe, self.why = range(self.line, until + 1), why
        return self._kept(items, why)

    def _structure_to(self, text: str) -> int:
        """Return the last line of a structure that only the control decides on; -1 for others."""
        try:
            part = self.structure.at.get(self.line)
        except StructureError:
            return -1
        if part is None or part.first != self.line or self.line in self.ran:
            return -1
        inside = (code(self.lines[line]) for line in range(part.first, part.last + 1))
        return -1 if any(LEAVES.search(each) for each in inside) else part.last

    def _stop(self, items: Sequence[gx.Item], why: str) -> list[str]:
        """Keep all that follows: it is not executed here, so lines before may be again."""
        made = self._kept(items, why)
        self.tied = why
        self.calls = []
        self.at = len(self.lines)
        return made or [self._stays("")]

    def left_behind(self) -> range:
        """Return the lines behind the one from which all stay."""
        return range(self.kept_lines[-1][0] + 1 if self.tied else self.own, self.own)

    def _stays(self, text: str) -> str:
        return f"{KEPT} P{zlib.crc32(text.encode('latin-1')) & 0xFFFFF}"

    def _kept(self, items: Sequence[gx.Item], why: str) -> list[str]:
        """Return the block of a line that stays as it stands."""
        items = [item for item in items if item.kind not in ("header", "label", "colon")]
        if not [item for item in items if item.name != "N"]:
            return []
        text = code(self.lines[self.line])
        self.kept_lines.append((self.line, why))
        self._lose(items, text)
        said = [code_of(item) for item in items if code_of(item) in STATED]
        if self.line in self.maybe:  # it may be executed, or not
            said = []
        self.loses |= {*tables.AXES & set(self.dialect.axes), "F"}
        return [" ".join([*said, self._stays(text)])]

    def _lose(self, items: Sequence[gx.Item], text: str) -> None:
        """Forget what a line may have changed."""
        codes = {code_of(item) for item in items}
        self.places.lose()
        self.gone = set(self.named)
        self.bars, self.plainly = {}, False
        self.polar = None
        self.pole = None if POLES.search(text) or CALLS.search(text) else self.pole
        if CALLS.search(text):
            self.frozen |= {line for lines in self.local.values() for line in lines}
        opaque = CALLS.search(text) is not None or "$" in text or self.line in self.maybe
        opaque |= any(c[:1] == "M" and c not in tables.M_CODES for c in codes)
        if opaque or "=" in text:
            self.known = dict.fromkeys(self.known)
            self.doubtful = set()
        if opaque:
            self.unsaid = {"distance", "motion"}
        elif codes & {"G90", "G91"}:
            self.incremental = "G91" in codes
        modal = MODAL.search(text)
        self.modal = modal[0] if modal else self.modal
        if codes & {"G80", "G40"} and not modal:
            self.modal = ""
        self.beside = BEHIND.search(text) is not None
        self.scaled |= SCALES.search(text) is not None
        if opaque or any(item.name in ("T", "D") for item in items) or "M6" in codes:
            self.tool = self.edge = self.in_spindle = ""

    def _length(self, edge: str, item: gx.Item) -> str:
        """Return the block of D: for the same control no length need be known."""
        if not self.reading.stays:
            return super()._length(edge, item)
        self.places.lose()
        self.gone |= self.named & {*"XYZ"}
        self.loses |= {*"XYZ"}
        return f"{KEPT} P{edge}"

    def _relative(self, items: Sequence[gx.Item], words: list[str]) -> tuple[list[str], list[str]]:
        """Return the words of a block; steps from where an axis may stand anywhere are refused."""
        if self.reading.stays:
            codes = {code_of(item) for item in items}
            shifted = codes & ZEROS  # it may end G92 and its like as well, which are kept
            self.gone = set(self.named) if shifted or "M6" in codes else self.gone
            for item in items:
                steps = item.kind == "incremental" or (self.incremental and item.kind == "word")
                if steps and item.name in self.gone:
                    self.refuse(f"a step of {item.name}, which may stand anywhere", item)
            told = {item.name for item in items if item.kind == "word"}
            self.gone -= told if not self.incremental else set()
        return super()._relative(items, words)

    def preset(self, items: Sequence[gx.Item]) -> list[str] | None:
        """Return the blocks of what sets a pole or turns; for the same control a turn stays."""
        if self.reading.stays and any(code_of(item) == "G73" for item in items):
            self.refuse("G73: what the words are of changes with it")
        return super().preset(items)

    def _check(self, item: gx.Item) -> None:
        """Refuse an item that is not read; for the same control what changes where words count."""
        super()._check(item)
        code = code_of(item)
        if self.reading.stays and (code == "G53" or code in tables.COMP):
            self.refuse(f"{code}: where the words behind it count from is not known", item)

    def _statement(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a statement; for the same control coordinates that end stay."""
        item = next(item for item in items if item.kind == "statement")
        head = item.name.split()[0]
        if self.reading.stays and head in tables.OFF | {"#KIN"}:
            self.refuse(f"{head}: what the words are of changes with it", item)
        return super()._statement(items)

    def _tips(self, item: gx.Item, on: bool) -> str:
        """Return the code that follows the tip; for the same control the statement stays."""
        if self.reading.stays:
            self.refuse("#RTCP: what the words are of changes with it", item)
        return super()._tips(item, on)

    def _move(self, item: gx.Item) -> None:
        """Ask nothing of offsets and lengths where words are words of the same control again."""
        if not self.reading.stays:
            super()._move(item)

    # --- writing ---

    def spelled(self, line: int, blocks: Sequence[str]) -> str | None:
        """Return a line that stands for new blocks; None where that is not known."""
        return None if self.tied or line in self.frozen else spelled(self.lines[line], blocks)

    def replaced(self, line: int, said: Sequence[str]) -> str | None:
        """Return the lines that stand for what a line became, with its head and its comment.

        None for one that has more than blocks say: how near to a corner, a parameter that is set.
        """
        if self.tied or line in self.frozen or not self._says_all(line):
            return None
        text = self.lines[line]
        head, bare = HEAD.match(text), code(text).rstrip()
        behind = text[len(bare) :] if text.startswith(bare) else ""
        first, *more = [NUMBER.sub("", each.partition(";")[0].rstrip()) for each in said]
        blank = " " if head and head[0].strip() else ""
        return "\n".join([f"{head[0].rstrip() if head else ''}{blank}{first}{behind}", *more])

    def uncommented(self, text: str) -> str:
        """Return lines without comments: one may stand between the parts of a word."""
        return code(text)

    def _says_all(self, line: int) -> bool:
        """Whether blocks say all that a line does."""
        items = self.items(line)
        if not any(item.kind == "expression" for item in items):
            return all(map(_is_said, items))
        sets = [rule_of(node) == "assignment" for node in self.tree_of(self.lines[line]).children]
        return all(map(_is_said, items)) and not any(sets)

    def counts(self, line: str) -> bool:
        """Whether a line has a word that counts from where its axis stands."""
        return COUNTS.search(code(line)) is not None

    def closing(self) -> Iterator[str]:
        """Say which lines are kept."""
        if self.kept_lines:
            lines = sorted({line for line, _ in self.kept_lines})
            few = ", ".join(map(self._named, lines[:8])) + (" and more" if len(lines) > 8 else "")
            line, why = min(self.kept_lines)
            first = f"line {self._named(line)}: {why}"
            self.assumed[f"lines {few} ({len(lines)}) are kept {KEEPS.format(first)}"] = None
        return iter(())

    def _named(self, line: int) -> str:
        file, number = self.place_of(line)
        return str(number) if line < self.own else f"{number} of {file}"


def _is_said(item: gx.Item) -> bool:
    """Whether blocks say what an item does, or it stands at the head or behind the line."""
    return item.kind in SAID and code_of(item) not in ("G50", "G61")
